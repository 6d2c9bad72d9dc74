//! Forces of the intermediate structures of an order: each balances its loads, and is what a fresh check decides.

use drystone::{
    Scene,
    check::check_blocks,
    formulate::{Assembly, BlockSet, ContactForce},
    plan::{Course, Limits, Quiet, StructureForces, Test, WhichForces, forces_along, plan},
    scenes,
};

fn structures(assembly: &Assembly, order: &[usize]) -> Vec<StructureForces> {
    let mut every = Vec::new();
    forces_along(
        assembly,
        &Course { order, ..Course::default() },
        |_| true,
        |structure| {
            every.push(structure);
            true
        },
    )
    .unwrap();
    every
}

/// Movable blocks of a scene in an order in which it can be put up.
fn assembly_order(scene: &Scene, assembly: &Assembly) -> Vec<usize> {
    let bodies = plan(scene, Test::Reuse, Limits::default(), &mut Quiet).unwrap().order;
    assert_eq!(bodies.len(), assembly.blocks(), "this scene has an order");
    let block = |body: &usize| (0..assembly.blocks()).find(|&block| assembly.body_index(block) == *body).unwrap();
    bodies.iter().rev().map(block).collect()
}

/// Force (N) and moment about the centroid (N m) that are missing to rest, from points and vectors alone.
fn imbalance(assembly: &Assembly, block: usize, forces: &[ContactForce]) -> f64 {
    let [cx, cy, _] = assembly.body(block).center;
    let mut total = assembly.applied(block).to_vec();
    for force in forces {
        let contact = &assembly.contacts()[force.contact];
        for (body, sign) in contact.bodies.into_iter().zip([-1.0, 1.0]) {
            if body == assembly.body_index(block) {
                let ([x, y, _], [fx, fy, _]) = (contact.point, force.force.map(|f| sign * f));
                let wrench = [fx, fy, (x - cx) * fy - (y - cy) * fx];
                total.iter_mut().zip(wrench).for_each(|(total, part)| *total += part);
            }
        }
    }
    total.into_iter().fold(0.0, |worst, part| worst.max(part.abs()))
}

#[test]
fn every_structure_of_a_plan_is_in_balance() {
    for scene in [
        scenes::column(6, 0.0).unwrap(),
        scenes::pyramid(4, 0.5).unwrap(),
        scenes::five_blocks(0.5).unwrap(),
        scenes::wall(4, 3, 3, 0.6).unwrap(),
        scenes::random_stack(20, 1, 0.0).unwrap(),
        scenes::random_stack(20, 3, 0.3).unwrap(),
    ] {
        let assembly = Assembly::new(&scene).unwrap();
        let order = assembly_order(&scene, &assembly);
        for (placed, structure) in structures(&assembly, &order).into_iter().enumerate() {
            assert_eq!(structure.blocks, placed + 1);
            let forces = structure.forces.expect("every structure of a plan stands");
            for &block in &order[..=placed] {
                let weight = assembly.applied(block)[1].abs();
                assert!(imbalance(&assembly, block, &forces) <= 1e-8 * weight.max(1.0));
            }
            for force in &forces {
                let friction = assembly.contacts()[force.contact].friction;
                assert!(force.normal >= -1e-12 && force.tangential.abs() <= friction * force.normal + 1e-9);
            }
        }
    }
}

/// Rows of a diamond put up one over the other: from some row on it falls, as a fresh check says.
#[test]
fn what_falls_has_no_forces() {
    let scene = scenes::diamond(5, 0.0).unwrap();
    let assembly = Assembly::new(&scene).unwrap();
    let order = assembly.upward();
    let mut present = BlockSet::empty(assembly.blocks());
    let found = structures(&assembly, &order);
    for (&block, structure) in order.iter().zip(&found) {
        present.insert(block);
        assert_eq!(structure.forces.is_some(), check_blocks(&assembly, &present).stable, "{} blocks", structure.blocks);
    }
    assert!(found.iter().any(|structure| structure.forces.is_none()));
}

#[test]
fn only_what_is_wanted_is_shown_until_enough() {
    let scene = scenes::column(8, 0.0).unwrap();
    let assembly = Assembly::new(&scene).unwrap();
    let order = assembly_order(&scene, &assembly);
    let mut shown = Vec::new();
    forces_along(
        &assembly,
        &Course { order: &order, forces: WhichForces::Any, ..Course::default() },
        |placed| placed % 2 == 1,
        |structure| {
            shown.push(structure.blocks);
            shown.len() < 3
        },
    )
    .unwrap();
    assert_eq!(shown, [1, 3, 5]);
}

/// The hand that holds the upper of two blocks carries it, and nothing presses on the lower; a hand on the lower one carries both,
/// and the ground nothing.
#[test]
fn hands_bear_what_contacts_do_not() {
    let assembly = Assembly::new(&scenes::column(3, 0.5).unwrap()).unwrap(); // a fixed block and two that move
    let weight = -assembly.applied(0)[1];
    for (held, by_hand, pressed) in [(1, weight, [weight, 0.0]), (0, 2.0 * weight, [0.0, weight])] {
        let holds = [vec![], vec![held]];
        let mut last = None;
        let course = Course { order: &[0, 1], held: &holds, ..Course::default() };
        forces_along(&assembly, &course, |placed| placed == 2, |structure| last.replace(structure).is_none()).unwrap();
        let StructureForces { forces, hands, .. } = last.unwrap();
        let (block, [x, y, z, a, b, c]) = hands[0];
        assert_eq!((hands.len(), block), (1, held));
        assert!((y - by_hand).abs() < 1e-9 && [x, z, a, b, c].iter().all(|none| none.abs() < 1e-9), "{hands:?}");
        let mut found = [0.0; 2];
        for force in forces.unwrap() {
            found[assembly.contacts()[force.contact].bodies[0]] += force.normal;
        }
        assert!(found.iter().zip(pressed).all(|(found, pressed)| (found - pressed).abs() < 1e-9), "{found:?}");
    }
}
