//! Orders in which every block leaves along a straight line, against brute force over all structures with ways out that are
//! found by many small steps.

use drystone::geometry::PoseInSpace;
use drystone::plan::{ClearPath, Conditions, Limits, Outcome, Plan, Quiet, Test, plan_under};
use drystone::{BodyOptions, Scene, SceneInSpace, check::check_blocks, formulate::Assembly, formulate::BlockSet};
use parry2d_f64::{math::Pose, query::contact, shape::ConvexPolygon};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn cleared(scene: &Scene, shortcuts: bool, hold: usize) -> Plan {
    let conditions = Conditions { hold, clear_path: Some(ClearPath::default()), ..Conditions::default() };
    plan_under(scene, Test::Reuse, &conditions, Limits { shortcuts, ..Limits::default() }, &mut Quiet).unwrap()
}

/// The part of a convex polygon on the left of the line through a point.
fn left_of(corners: &[[f64; 2]], point: [f64; 2], along: [f64; 2]) -> Vec<[f64; 2]> {
    let side = |[x, y]: [f64; 2]| along[0] * (y - point[1]) - along[1] * (x - point[0]);
    let mut part = Vec::new();
    for (k, &a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        if side(a) >= 0.0 {
            part.push(a);
        }
        if (side(a) > 0.0) != (side(b) > 0.0) && side(a) != 0.0 && side(b) != 0.0 {
            let t = side(a) / (side(a) - side(b));
            part.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    part
}

/// A slab on the ground, some with a wall on either side that leans over it, cut into pieces by lines at random.
fn cut_slab(seed: u64) -> Option<Scene> {
    let mut random = Pcg64::seed_from_u64(seed);
    let (width, lean) = (2.0, random.random_range(0.0..0.6));
    let mut pieces = vec![vec![[-width, 0.0], [width, 0.0], [width - lean, 1.0], [lean - width, 1.0]]];
    for _ in 0..random.random_range(2..4) {
        let point = [random.random_range(-1.5..1.5), random.random_range(0.2..0.8)];
        let angle: f64 = random.random_range(0.0..std::f64::consts::PI);
        let along = [angle.cos(), angle.sin()];
        let parts = |piece: &Vec<[f64; 2]>| [left_of(piece, point, along), left_of(piece, point, along.map(|x| -x))];
        pieces = pieces.iter().flat_map(parts).filter(|piece| piece.len() > 2).collect();
    }
    let mut scene = Scene::new([0.0, -9.81], 0.7).unwrap().with_contact_tolerance(1e-6).unwrap();
    let fixed = || BodyOptions { fixed: true, ..BodyOptions::default() };
    scene.add_box([0.0, -0.5], [12.0, 1.0], 0.0, fixed()).unwrap();
    if !seed.is_multiple_of(8) {
        scene.add_polygon(&[[width, 0.0], [4.0, 0.0], [4.0, 1.0], [width - lean, 1.0]], fixed()).unwrap();
    }
    if seed % 8 > 1 {
        scene.add_polygon(&[[-4.0, 0.0], [-width, 0.0], [lean - width, 1.0], [-4.0, 1.0]], fixed()).unwrap();
    }
    for piece in &pieces {
        scene.add_polygon(piece, BodyOptions::default()).ok()?;
    }
    drystone::check(&scene, None).ok().filter(|verdict| verdict.stable && pieces.len() <= 7).map(|_| scene)
}

/// Whether a body, moved by small steps, comes deeper into another than rounding explains.
fn meets(scene: &Scene, body: usize, other: usize, [dx, dy]: [f64; 2]) -> bool {
    let shape = |index: usize| {
        let corners = scene.bodies()[index].vertices().into_iter().map(drystone::geometry::Vector::from_array);
        ConvexPolygon::from_convex_polyline(corners.collect()).unwrap()
    };
    let (a, b) = (shape(body), shape(other));
    let depth = |t: f64| {
        let moved = Pose::translation(t * dx, t * dy);
        contact(&moved, &a, &Pose::IDENTITY, &b, 0.03).unwrap().map_or(-1.0, |contact| -contact.dist)
    };
    // What is grazed falls between the steps: where they are near, more of them.
    (0..300).map(|step| 0.04 * f64::from(step)).any(|t| {
        let deep = depth(t);
        deep > 1e-5 || deep > -0.03 && (-20..20).any(|fine| depth((t + 0.001 * f64::from(fine)).max(0.0)) > 1e-5)
    })
}

/// Against gravity, along the axes, along and across the contacts of a body, its faces and those near it.
fn directions(scene: &Scene, body: usize) -> Vec<[f64; 2]> {
    let contacts = drystone::find_contacts(scene).unwrap().contacts;
    let own = contacts.iter().filter(|contact| contact.bodies.contains(&body));
    let normals = own.map(|contact| contact.normal).chain([[0.0, 1.0, 0.0]]).map(|[x, y, _]| [x, y]);
    let near = (0..scene.bodies().len()).filter(|&other| is_near(scene, body, other));
    let faces: Vec<[f64; 2]> = near.flat_map(|other| along_faces(scene, other)).collect();
    let mut ways: Vec<[f64; 2]> = Vec::new();
    for [x, y] in normals.chain(faces).flat_map(|[x, y]| [[x, y], [-x, -y], [-y, x], [y, -x]]) {
        if !ways.iter().any(|[a, b]| (a - x).hypot(b - y) < 1e-9) {
            ways.push([x, y]);
        }
    }
    ways
}

/// Unit vectors along the sides of a body.
fn along_faces(scene: &Scene, body: usize) -> Vec<[f64; 2]> {
    let corners = scene.bodies()[body].vertices();
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).map(|([ax, ay], [bx, by])| [bx - ax, by - ay]);
    sides.map(|[x, y]| [x / x.hypot(y), y / x.hypot(y)]).collect()
}

/// Whether another body is no farther away than a body is wide, by circles about the means of their corners.
fn is_near(scene: &Scene, body: usize, other: usize) -> bool {
    let circle = |index: usize| {
        let corners = scene.bodies()[index].vertices();
        let mean = [0, 1].map(|k| corners.iter().map(|corner| corner[k]).sum::<f64>() / corners.len() as f64);
        (mean, corners.iter().map(|[x, y]| (x - mean[0]).hypot(y - mean[1])).fold(0.0, f64::max))
    };
    let (([ax, ay], radius), ([bx, by], other_radius)) = (circle(body), circle(other));
    (ax - bx).hypot(ay - by) <= 3.0 * radius + other_radius
}

/// Whether there is an order, by all structures.
fn brute_force(scene: &Scene) -> bool {
    let assembly = Assembly::new(scene).unwrap();
    let blocks = assembly.blocks();
    let fixed: Vec<usize> = (0..scene.bodies().len()).filter(|&body| scene.bodies()[body].fixed).collect();
    // For each block and direction without a fixed body in the way: the blocks in the way.
    let ways: Vec<Vec<usize>> = (0..blocks)
        .map(|block| {
            let body = assembly.body_index(block);
            let open = directions(scene, body).into_iter();
            let open = open.filter(|&way| !fixed.iter().any(|&other| meets(scene, body, other, way)));
            let stops = |way, other: &usize| *other != block && meets(scene, body, assembly.body_index(*other), way);
            open.map(|way| (0..blocks).filter(|other| stops(way, other)).map(|other| 1 << other).sum()).collect()
        })
        .collect();
    let mut reachable = vec![false; 1 << blocks];
    reachable[0] = true;
    for mask in 1usize..1 << blocks {
        let mut set = BlockSet::empty(blocks);
        (0..blocks).filter(|block| mask >> block & 1 == 1).for_each(|block| set.insert(block));
        let comes = |block: usize| {
            let rest = mask & !(1 << block);
            reachable[rest] && ways[block].iter().any(|stops| stops & rest == 0)
        };
        reachable[mask] = set.iter().any(comes) && check_blocks(&assembly, &set).stable;
    }
    reachable[(1 << blocks) - 1]
}

#[test]
fn brute_force_finds_an_order_where_the_search_does() {
    let mut seen = [0; 3];
    for scene in (0..48).filter_map(cut_slab) {
        let plan = cleared(&scene, true, 0);
        let without = cleared(&scene, false, 0);
        assert_eq!((plan.outcome, &plan.order), (without.outcome, &without.order));
        assert_eq!(plan.outcome == Outcome::Found, brute_force(&scene), "{plan:?}");
        seen[match plan.outcome {
            Outcome::Found => 0,
            Outcome::Locked => 1,
            _ => 2,
        }] += 1;
        verify(&scene, &plan);
        assert!(plan.outcome != Outcome::Locked || plan.blocked.len() > 1 || plan.falls_next.is_empty());
    }
    println!("found, locked, no order: {seen:?}");
    assert!(seen[0] > 20 && seen[1] > 5, "{seen:?}");
}

/// What is taken away passes what remains.
fn verify(scene: &Scene, plan: &Plan) {
    let fixed = (0..scene.bodies().len()).filter(|&body| scene.bodies()[body].fixed);
    let fixed: Vec<usize> = fixed.collect();
    assert_eq!(plan.moves.len(), plan.reached.len());
    for (placed, (&body, moves)) in plan.reached.iter().zip(&plan.moves).enumerate() {
        let [([x, y, _], _)] = moves[..] else { panic!("one move") };
        let there = plan.reached[..placed].iter().chain(&fixed);
        assert!(!there.into_iter().any(|&other| meets(scene, body, other, [x, y])));
    }
    for blocked in &plan.blocked {
        for (way, by) in &blocked.ways {
            assert!(by.iter().all(|&other| meets(scene, blocked.body, other, [way[0], way[1]])));
            assert!(!by.is_empty());
        }
    }
}

/// A tongue of two pieces, wide below and narrow above, in a groove of the same form that runs along y: it can only be pulled
/// out lengthwise, and not while a cube stands at either end. One that can be lifted has to go first.
#[test]
fn in_space_a_tongue_leaves_along_its_groove() {
    let at = |position| PoseInSpace { position, ..PoseInSpace::WORLD };
    let named = |name: &str, fixed| BodyOptions { name: Some(name.into()), fixed, ..BodyOptions::default() };
    let corner = |low: [f64; 3], high: [f64; 3], k: usize| [0, 1, 2].map(|a| [low[a], high[a]][k >> a & 1]);
    let brick = |low, high| (0..8).map(|k| corner(low, high, k)).collect::<Vec<_>>();
    let closed_by = |fixed_ends: [bool; 2]| {
        let mut scene = SceneInSpace::new([0.0, 0.0, -9.81], 0.5).unwrap();
        scene.add_cuboid(at([0.0, 0.0, -0.5]), [20.0, 20.0, 1.0], named("ground", true)).unwrap();
        for (name, side) in [("left", -1.0), ("right", 1.0)] {
            let between = |a: f64, b: f64| [f64::min(side * a, side * b), f64::max(side * a, side * b)];
            let ([l0, l1], [u0, u1]) = (between(1.0, 2.0), between(0.5, 2.0));
            let pieces = [brick([l0, -2.0, 0.0], [l1, 2.0, 1.0]), brick([u0, -2.0, 1.0], [u1, 2.0, 2.0])];
            scene.add_solid(&pieces, PoseInSpace::WORLD, named(name, true)).unwrap();
        }
        let tongue = [brick([-1.0, -2.0, 0.0], [1.0, 2.0, 1.0]), brick([-0.5, -2.0, 1.0], [0.5, 2.0, 2.0])];
        scene.add_solid(&tongue, PoseInSpace::WORLD, named("tongue", false)).unwrap();
        for (name, y, fixed) in [("front", -2.5, fixed_ends[0]), ("back", 2.5, fixed_ends[1])] {
            scene.add_cuboid(at([0.0, y, 0.5]), [1.0; 3], named(name, fixed)).unwrap();
        }
        let conditions = Conditions { hold: 0, clear_path: Some(ClearPath::default()), ..Conditions::default() };
        plan_under(&scene, Test::Reuse, &conditions, Limits::default(), &mut Quiet).unwrap()
    };
    let plan = closed_by([true, true]);
    assert_eq!((plan.outcome, plan.blocked.len()), (Outcome::Locked, 1));
    assert!(plan.blocked[0].ways.iter().all(|(_, by)| !by.is_empty()));
    let plan = closed_by([true, false]);
    assert_eq!((plan.outcome, plan.order.as_slice()), (Outcome::Found, &[5, 3][..]));
    let directions: Vec<[f64; 3]> = plan.moves.iter().map(|moves| moves[0].0).collect();
    assert_eq!(directions, [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
}
