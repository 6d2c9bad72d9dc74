//! The built-in scenes: what they are made of, derived from their definitions.

use drystone::{Body, Scene, SceneError, check, find_contacts, formulate::Cones, interrupt::Interrupt, scenes};
use serde_json::{Value, json};
use std::{
    collections::BTreeMap,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering::Relaxed},
    },
};

fn movable(scene: &Scene) -> Vec<&Body> {
    scene.bodies().iter().filter(|body| !body.fixed).collect()
}

fn contact_points(scene: &Scene) -> usize {
    let set = find_contacts(scene).unwrap();
    assert!(set.corner_touches.is_empty(), "{:?}", set.corner_touches);
    set.contacts.len()
}

fn stands(scene: &Scene, blocks: Option<&[&str]>) -> bool {
    let names: Option<Vec<String>> = blocks.map(|b| b.iter().map(|&n| n.to_owned()).collect());
    check(scene, names.as_deref()).unwrap().stable
}

#[test]
fn a_column_has_one_fixed_square_and_two_points_a_joint() {
    let scene = scenes::column(50, 0.0).unwrap();
    assert_eq!(scene.bodies().len(), 50);
    assert_eq!(movable(&scene).len(), 49);
    let set = find_contacts(&scene).unwrap();
    assert_eq!(set.contacts.len(), 2 * 49);
    for (k, pair) in set.contacts.chunks(2).enumerate() {
        let height = k as f64;
        assert_eq!([pair[0].point, pair[1].point], [[-0.5, height, 0.0], [0.5, height, 0.0]]);
        assert!(pair.iter().all(|c| c.normal == [0.0, 1.0, 0.0] && c.gap == 0.0));
    }
}

/// Joints of a pyramid: R squares on the ground, two below each of the others, and in a row of k
/// squares k - 1 sides; every joint is a face contact with two points.
fn pyramid_points(rows: usize) -> usize {
    let squares = rows * (rows + 1) / 2;
    let beds = rows + 2 * (squares - rows);
    let sides = squares - rows;
    2 * (beds + sides)
}

#[test]
fn a_pyramid_is_in_full_face_contact() {
    for (rows, squares) in [(1, 1), (4, 10), (13, 91)] {
        let scene = scenes::pyramid(rows, 0.0).unwrap();
        assert_eq!(movable(&scene).len(), squares);
        assert_eq!(contact_points(&scene), pyramid_points(rows));
    }
    // By hand for two rows: three squares, two beds of 2 below, two of 2 between, one side of 2.
    assert_eq!(pyramid_points(2), 10);
}

#[test]
fn five_blocks_fall_and_stand_as_documented() {
    let scene = scenes::five_blocks(0.0).unwrap();
    assert_eq!(scene.bodies().len(), 6);
    assert!(stands(&scene, None));
    let standing: [&[&str]; 5] =
        [&["1", "3", "5"], &["1", "2", "3"], &["1", "2", "3", "4"], &["1", "2", "3", "5"], &["2"]];
    for blocks in standing {
        assert!(stands(&scene, Some(blocks)), "{blocks:?}");
    }
    let falling: [&[&str]; 4] = [&["1", "3"], &["1", "3", "4", "5"], &["2", "3"], &["4"]];
    for blocks in falling {
        assert!(!stands(&scene, Some(blocks)), "{blocks:?}");
    }
}

#[test]
fn an_arch_meets_the_ground_at_both_springings() {
    let scene = scenes::arch(41, 0.2, 0.7).unwrap();
    assert_eq!(movable(&scene).len(), 41);
    // 40 joints between voussoirs and two springings, two points each.
    assert_eq!(contact_points(&scene), 2 * 42);
    // Twice the area of one trapezium: (outer^2 - inner^2) sin(pi / 41).
    let area = 0.5 * (1.1_f64.powi(2) - 0.9_f64.powi(2)) * (std::f64::consts::PI / 41.0).sin();
    for voussoir in movable(&scene) {
        assert!((voussoir.mass() - area).abs() < 1e-14);
    }
}

#[test]
fn a_harmonic_stack_reaches_half_the_harmonic_number() {
    let scene = scenes::harmonic_stack(4, 1.0, 0.0).unwrap();
    let reach = movable(&scene)[3].vertices().iter().map(|v| v[0]).fold(0.0, f64::max);
    // H_4 / 2 = (1 + 1/2 + 1/3 + 1/4) / 2 = 25 / 24.
    assert!((reach - 25.0 / 24.0).abs() < 1e-15);
    assert_eq!(contact_points(&scene), 2 * 4);
}

#[test]
fn diamonds_and_inverted_triangles_have_their_rows() {
    for m in 1..=5 {
        let scene = scenes::diamond(m, 0.0).unwrap();
        assert_eq!(movable(&scene).len(), m * m);
        // Paterson and Zwick: balanced up to 4, not so at 5.
        assert_eq!(stands(&scene, None), m <= 4, "diamond of {m}");
    }
    for rows in 1..=4 {
        let scene = scenes::inverted_triangle(rows, 0.0).unwrap();
        assert_eq!(movable(&scene).len(), rows * (rows + 1) / 2);
        assert_eq!(stands(&scene, None), rows <= 2, "triangle of {rows}");
    }
}

#[test]
fn a_block_on_a_slope_keeps_both_its_contacts_at_any_inclination() {
    for degrees in -89..=89 {
        let scene = scenes::slope(f64::from(degrees), 0.5, 2.0, 0.7).unwrap();
        let set = find_contacts(&scene).unwrap();
        assert_eq!(set.contacts.len(), 2);
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        for (contact, along) in set.contacts.iter().zip([-1.0, 1.0]) {
            let miss = [contact.point[0] - along * cos, contact.point[1] - along * sin];
            assert!(miss[0].hypot(miss[1]) < 1e-14, "{degrees} degrees: {miss:?}");
        }
    }
}

#[test]
fn a_wall_is_bonded_whatever_its_seed() {
    for seed in [0, 1, 2] {
        let scene = scenes::wall(6, 5, seed, 0.6).unwrap();
        // Courses of 5 bricks, and of 4 and two halves.
        assert_eq!(movable(&scene).len(), 3 * 5 + 3 * 6);
        // On the ground 5 beds; between courses 10, for each of 4 + 5 joints begins a new one;
        // sides 4 and 5 a course.
        assert_eq!(contact_points(&scene), 2 * (5 + 5 * 10 + 3 * 4 + 3 * 5));
        assert!(stands(&scene, None));
    }
    assert_ne!(scenes::wall(6, 5, 1, 0.6).unwrap(), scenes::wall(6, 5, 2, 0.6).unwrap());
}

#[test]
fn ten_thousand_blocks_take_work_in_proportion() {
    let pairs = |rows, columns| {
        let scene = scenes::wall(rows, columns, 1, 0.6).unwrap();
        assert!(scene.bodies().len() > rows * columns);
        let set = find_contacts(&scene).unwrap();
        assert!(set.corner_touches.is_empty());
        // Every candidate touches but for boxes that meet only at a corner: there are none here.
        assert_eq!(set.contacts.len(), 2 * set.candidate_pairs);
        set.candidate_pairs
    };
    let small = pairs(10, 100);
    let large = pairs(100, 100);
    // A brick has six neighbours, and half of six pairs each.
    assert!(large < 3 * 10_100 && large < 11 * small, "{small} and {large} pairs");
}

#[test]
fn a_random_stack_is_the_same_for_the_same_seed_and_stands() {
    for seed in 1..=5 {
        let scene = scenes::random_stack(30, seed, 0.0).unwrap();
        assert_eq!(scene, scenes::random_stack(30, seed, 0.0).unwrap());
        assert_eq!(movable(&scene).len(), 30);
        assert!(stands(&scene, None), "seed {seed}");
    }
    let [one, two] = [1, 2].map(|seed| scenes::random_stack(30, seed, 0.0).unwrap());
    assert_ne!(one, two);
}

#[test]
fn building_a_random_stack_can_be_stopped() {
    let asked = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&asked);
    let third = Interrupt::new(move || count.fetch_add(1, Relaxed) == 2);
    assert_eq!(third.run(|| scenes::random_stack(200, 1, 0.0)), None);
    assert_eq!(asked.load(Relaxed), 3);
}

#[test]
fn a_random_stack_has_overhangs_and_blocks_that_need_others() {
    // Some block must fall when some other one, not below it, is taken away: a counterweight.
    let scene = scenes::random_stack(84, 1, 0.0).unwrap();
    let all: Vec<&Body> = movable(&scene);
    let needed = |gone: &&Body| {
        let bottom = gone.pose.position[1];
        let rest: Vec<String> = all.iter().filter(|b| b.name != gone.name).map(|b| b.name.clone()).collect();
        let verdict = check(&scene, Some(&rest)).unwrap();
        let falls_below = |&i: &usize| scene.bodies()[i].pose.position[1] < bottom;
        verdict.falling.iter().any(falls_below)
    };
    assert!(all.iter().any(needed));
}

/// Blocks are tried on a stack that is put up once; the same stacks come from checking every one from scratch.
#[test]
fn a_random_stack_is_that_of_checks_from_scratch() {
    for (blocks, seeds) in [(1, 3), (12, 20), (40, 8), (100, 2)] {
        for seed in 0..seeds {
            let tried = scenes::random_stack(blocks, seed, 0.0);
            let checked = scenes::random_stack_where(blocks, seed, 0.0, |scene| stands(scene, None));
            assert_eq!(tried.ok(), checked.ok(), "{blocks}, {seed}");
        }
    }
}

#[test]
fn a_generator_that_finds_no_place_says_so() {
    let error = scenes::random_stack_where(5, 1, 0.0, |_| false).unwrap_err();
    assert!(matches!(error, SceneError::NotGenerated { .. }));
    assert!(error.to_string().contains("block 1 of 5"), "{error}");
}

fn parameters(pairs: &[(&str, Value)]) -> BTreeMap<String, Value> {
    pairs.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect()
}

#[test]
fn the_registry_builds_every_scene_with_its_defaults() {
    let names: Vec<&str> = scenes::catalogue().iter().map(|entry| entry.name).collect();
    assert!(names.is_sorted());
    for name in names {
        let scene = scenes::build(name, &BTreeMap::new()).unwrap();
        scene.assembly(Cones::default()).unwrap();
    }
    let given = parameters(&[("n", json!(7)), ("friction", json!(0.25))]);
    assert_eq!(scenes::build("column", &given).unwrap(), scenes::column(7, 0.25).unwrap().into());
    let whole = parameters(&[("n", json!(7.0))]);
    assert_eq!(scenes::build("column", &whole).unwrap(), scenes::column(7, 0.0).unwrap().into());
}

#[test]
fn the_registry_says_what_is_wrong() {
    let text = |name: &str, given: &[(&str, Value)]| scenes::build(name, &parameters(given)).unwrap_err().to_string();
    let unknown = text("pyramd", &[]);
    assert!(unknown.contains("did you mean \"pyramid\"?"), "{unknown}");
    let unknown = text("pyramid", &[("row", json!(3))]);
    assert!(unknown.contains("did you mean \"rows\"?"), "{unknown}");
    assert_eq!(text("pyramid", &[("rows", json!(0))]), "pyramid: rows is 0: give a whole number from 1 to 1000");
    assert_eq!(text("pyramid", &[("rows", json!(2.5))]), "pyramid: rows is 2.5: give a whole number from 1 to 1000");
    assert_eq!(
        text("pyramid", &[("rows", json!("many"))]),
        "pyramid: rows is \"many\": give a whole number from 1 to 1000"
    );
    assert_eq!(text("slope", &[("friction", json!(-1))]), "slope: friction is -1: give a number from 0 to 1000000");
    let nan = scenes::arch(10, f64::NAN, 0.7).unwrap_err();
    assert!(matches!(nan, SceneError::BadParameter { .. }), "{nan}");
}
