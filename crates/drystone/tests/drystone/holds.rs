//! Orders for which blocks are held: every structure checked afresh with the held blocks fixed, and brute force over all
//! structures and all holds of small scenes.

use drystone::plan::{Conditions, Limits, Outcome, Plan, PlanError, Quiet, Test, plan, plan_under};
use drystone::{BodyOptions, Scene, SceneError, check, scenes};
use std::collections::{HashMap, HashSet};

fn held_plan(scene: &Scene, hold: usize) -> Plan {
    plan_under(scene, Test::Reuse, &Conditions { hold, ..Conditions::default() }, Limits::default(), &mut Quiet)
        .unwrap()
}

/// Whether what is left of a scene with only these movable bodies stands when some of them are fixed.
fn stands(scene: &Scene, keep: &[usize], held: &[usize]) -> bool {
    let mut part = Scene::new(scene.gravity(), scene.friction()).unwrap();
    for (index, body) in scene.bodies().iter().enumerate().filter(|(index, body)| body.fixed || keep.contains(index)) {
        let fixed = body.fixed || held.contains(&index);
        let options = BodyOptions {
            name: Some(body.name.clone()),
            density: body.density,
            friction: body.friction,
            fixed,
            ..BodyOptions::default()
        };
        let corners: Vec<[f64; 2]> = body.shape.vertices().iter().map(|v| v.to_array()).collect();
        part.add_placed_polygon(&corners, body.pose, options).unwrap();
    }
    check(&part, None).unwrap().stable
}

/// Every structure on the way stands with its held blocks fixed, and the hands can move as they have to.
fn verify(scene: &Scene, plan: &Plan, hands: usize) {
    let mut before: &[usize] = &[];
    for (placed, held) in plan.held.iter().enumerate() {
        let (structure, added) = (&plan.reached[..=placed], plan.reached[placed]);
        assert!(held.len() <= hands && held.iter().all(|block| structure.contains(block)));
        assert!(stands(scene, structure, held), "{} blocks with {held:?} held", placed + 1);
        let new = held.iter().filter(|&&block| block != added && !before.contains(&block)).count();
        assert!(before.len() + new <= hands, "{before:?}, then {held:?}");
        before = held;
    }
    assert_eq!(plan.held.len(), plan.reached.len());
    if plan.outcome == Outcome::Found {
        assert!(plan.held.last().is_none_or(Vec::is_empty));
    }
}

fn grips(plan: &Plan) -> usize {
    let mut before: &[usize] = &[];
    let mut grips = 0;
    for held in &plan.held {
        grips += held.iter().filter(|block| !before.contains(block)).count();
        before = held;
    }
    grips
}

/// Whether there is an order, by all structures with all holds; blocks are put up where they touch something.
fn brute_force(scene: &Scene, hands: usize) -> bool {
    let movable: Vec<usize> = (0..scene.bodies().len()).filter(|&body| !scene.bodies()[body].fixed).collect();
    let contacts = drystone::find_contacts(scene).unwrap().contacts;
    let of = |mask: usize| -> Vec<usize> {
        movable.iter().enumerate().filter(|(k, _)| mask >> k & 1 == 1).map(|(_, &body)| body).collect()
    };
    let touches = |block: usize, mask: usize| {
        let there = of(mask);
        contacts.iter().any(|contact| {
            let [a, b] = contact.bodies;
            let other = if a == movable[block] { b } else { a };
            (a == movable[block] || b == movable[block]) && (scene.bodies()[other].fixed || there.contains(&other))
        })
    };
    let mut known: HashMap<(usize, usize), bool> = HashMap::new();
    let mut seen = HashSet::from([(0, 0)]);
    let mut next = vec![(0usize, 0usize)];
    let whole = (1 << movable.len()) - 1;
    while let Some((mask, held)) = next.pop() {
        if mask == whole {
            return true;
        }
        for block in (0..movable.len()).filter(|block| mask >> block & 1 == 0).filter(|&block| touches(block, mask)) {
            let with = mask | 1 << block;
            for after in (0..=whole).filter(|after| after & !with == 0 && after.count_ones() as usize <= hands) {
                let moved = held | after & !(1 << block);
                if moved.count_ones() as usize > hands || with == whole && after != 0 || seen.contains(&(with, after)) {
                    continue;
                }
                let stand = known.entry((with, after)).or_insert_with(|| stands(scene, &of(with), &of(after)));
                if *stand && seen.insert((with, after)) {
                    next.push((with, after));
                }
            }
        }
    }
    false
}

/// Small stacks that stand as a whole, whatever their parts do.
fn small() -> impl Iterator<Item = Scene> {
    (0..900u64).filter_map(|seed| {
        let (blocks, friction) = (4 + seed as usize % 3, if seed % 3 == 0 { 0.4 } else { 0.0 });
        let whole = |scene: &Scene| scene.bodies().len() <= blocks || drystone::check::stands(scene).unwrap();
        scenes::random_stack_where(blocks, seed, friction, whole).ok()
    })
}

/// Two planks that overhang a fixed pier on either side, and the weight across both that keeps them.
fn two_planks() -> Scene {
    let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
    let named = |name: &str, fixed| BodyOptions { name: Some(name.into()), fixed, ..BodyOptions::default() };
    scene.add_box([0.0, 0.5], [1.0, 1.0], 0.0, named("pier", true)).unwrap();
    scene.add_box([-0.81, 1.1], [1.58, 0.2], 0.0, named("left", false)).unwrap();
    scene.add_box([0.81, 1.1], [1.58, 0.2], 0.0, named("right", false)).unwrap();
    scene.add_box([0.0, 1.7], [0.9, 1.0], 0.0, named("weight", false)).unwrap();
    scene
}

#[test]
fn the_hand_that_brings_the_weight_keeps_it_until_the_other_plank_is_there() {
    let scene = two_planks();
    assert_eq!(held_plan(&scene, 0).outcome, Outcome::NoOrder);
    let plan = held_plan(&scene, 1);
    verify(&scene, &plan, 1);
    // The weight, held, keeps the first plank from tipping.
    assert_eq!((plan.outcome, plan.reached), (Outcome::Found, vec![1, 3, 2]));
    assert_eq!(plan.held, [vec![1], vec![3], vec![]]);
    let plan = held_plan(&scene, 2);
    verify(&scene, &plan, 2);
    assert_eq!((plan.outcome, grips(&plan)), (Outcome::Found, 2));
}

#[test]
fn an_arch_goes_up_with_one_hand() {
    for voussoirs in [5, 12, 20, 41] {
        let scene = scenes::arch(voussoirs, 0.2, 0.7).unwrap();
        assert_eq!(held_plan(&scene, 0).outcome, Outcome::NoOrder);
        let plan = held_plan(&scene, 1);
        assert_eq!(plan.outcome, Outcome::Found);
        verify(&scene, &plan, 1);
        assert!(grips(&plan) > 0);
    }
}

#[test]
fn nothing_is_held_where_there_is_an_order_without() {
    for scene in [scenes::five_blocks(0.0).unwrap(), scenes::pyramid(4, 0.0).unwrap(), scenes::column(6, 0.0).unwrap()]
    {
        let (bare, held) = (plan(&scene, Test::Reuse, Limits::default(), &mut Quiet).unwrap(), held_plan(&scene, 2));
        assert_eq!((bare.order, bare.records.len()), (held.order.clone(), held.records.len()));
        assert!(held.held.iter().all(Vec::is_empty));
    }
}

#[test]
fn brute_force_finds_an_order_where_the_search_does() {
    let mut seen = [0; 4];
    for scene in small() {
        for hands in [1, 2] {
            let plan = held_plan(&scene, hands);
            verify(&scene, &plan, hands);
            match plan.outcome {
                Outcome::Undecided => seen[3] += 1,
                Outcome::Found if grips(&plan) == 0 => seen[0] += 1,
                outcome => {
                    assert_eq!(outcome == Outcome::Found, brute_force(&scene, hands));
                    seen[if outcome == Outcome::Found { 1 } else { 2 }] += 1;
                }
            }
        }
    }
    println!("without a hold, with holds, without an order, undecided: {seen:?}");
    assert!(seen[1] > 20 && seen[3] == 0, "{seen:?}");
}

#[test]
fn more_hands_than_are_allowed_are_an_error() {
    let scene = scenes::column(3, 0.0).unwrap();
    let many = Conditions { hold: 9, ..Conditions::default() };
    let error = plan_under(&scene, Test::Reuse, &many, Limits::default(), &mut Quiet).unwrap_err();
    assert!(matches!(error, PlanError::Scene(SceneError::BadParameter { .. })));
}
