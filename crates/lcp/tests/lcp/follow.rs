//! From one problem to the next while some bodies move: contacts between bodies that stay keep their rows, those of
//! bodies that move get other entries, and contacts come and go. Every answer is compared with a fresh solve.

use crate::{
    problems::random,
    verify::{RESIDUAL, SAME_W, assert_same_w, assert_solves},
};
use drystone_lcp::{Dantzig, LcpError, Method, Origin, Problem, Settings, Solver, SolverState, Status, cone::Columns};
use rand::{Rng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

/// A contact between two bodies (or one and the ground), with as many generators as it has wrenches on them.
#[derive(Debug, Clone)]
struct Contact {
    name: usize,
    bodies: [Option<usize>; 2],
    wrenches: Vec<[f64; 6]>,
}

struct Scene {
    bodies: usize,
    inverse_mass: Vec<f64>,
    velocity: Vec<f64>,
    contacts: Vec<Contact>,
    named: usize,
}

fn wrenches(rng: &mut Pcg64Mcg) -> Vec<[f64; 6]> {
    // Small whole numbers make ties and dependent rows, as face contacts do.
    let first: [f64; 6] = std::array::from_fn(|_| f64::from(rng.random_range(-2..=2_i32)));
    let second = if rng.random_bool(0.2) { first } else { std::array::from_fn(|k| first[k] + 0.5 * (k % 2) as f64) };
    vec![first, second]
}

impl Scene {
    fn new(rng: &mut Pcg64Mcg) -> Self {
        let bodies = rng.random_range(1..=12);
        let inverse_mass = (0..3 * bodies).map(|_| [0.5, 1.0, 6.0][rng.random_range(0..3)]).collect();
        let velocity = (0..3 * bodies).map(|_| rng.random_range(-1.0..1.0)).collect();
        let mut scene = Self { bodies, inverse_mass, velocity, contacts: Vec::new(), named: 0 };
        for _ in 0..2 * bodies {
            scene.touch(rng);
        }
        scene
    }

    fn touch(&mut self, rng: &mut Pcg64Mcg) {
        let a = rng.random_range(0..self.bodies);
        let b = Some(rng.random_range(0..self.bodies)).filter(|&b| b != a);
        self.named += 1;
        self.contacts.push(Contact { name: self.named, bodies: [Some(a), b], wrenches: wrenches(rng) });
    }

    /// Some bodies move, contacts come and go; the origins of the rows after it.
    fn change(&mut self, rng: &mut Pcg64Mcg) -> Vec<Origin> {
        let before: Vec<usize> = self.contacts.iter().map(|contact| contact.name).collect();
        let moving: Vec<bool> = (0..self.bodies).map(|_| rng.random_bool(0.3)).collect();
        let moves = |body: &Option<usize>| body.is_some_and(|body| moving[body]);
        let mut moved = Vec::new();
        for contact in &mut self.contacts {
            if contact.bodies.iter().any(moves) {
                let little = |value: &mut f64| *value += 0.02 * rng.random_range(-1.0..1.0);
                contact.wrenches.as_flattened_mut().iter_mut().for_each(little);
                moved.push(contact.name);
            }
        }
        if rng.random_bool(0.4) {
            self.contacts.retain(|_| rng.random_bool(0.9));
            (0..rng.random_range(0..3)).for_each(|_| self.touch(rng));
            self.contacts.shuffle(rng);
        }
        let body = rng.random_range(0..self.bodies);
        self.velocity[3 * body] += rng.random_range(-0.3..0.3);
        let origin = |contact: &Contact| match before.iter().position(|&name| name == contact.name) {
            None => [Origin::New; 2],
            Some(old) if moved.contains(&contact.name) => [Origin::Moved(2 * old), Origin::Moved(2 * old + 1)],
            Some(old) => [Origin::Same(2 * old), Origin::Same(2 * old + 1)],
        };
        self.contacts.iter().flat_map(origin).collect()
    }

    fn problem(&self) -> Problem {
        let (g, q) = self.generators();
        Problem::from_generators_and_q(&g, &self.inverse_mass, q).unwrap()
    }

    fn generators(&self) -> (Columns, Vec<f64>) {
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for contact in &self.contacts {
            for wrench in &contact.wrenches {
                for (side, body) in contact.bodies.iter().enumerate().filter_map(|(k, body)| Some((k, (*body)?))) {
                    indices.extend((0..3).map(|k| 3 * body + k));
                    data.extend_from_slice(&wrench[3 * side..3 * side + 3]);
                }
                indptr.push(indices.len());
            }
        }
        let g = Columns::new(3 * self.bodies, &indptr, &indices, &data).unwrap();
        let along = |j: usize| (indptr[j]..indptr[j + 1]).map(|p| data[p] * self.velocity[indices[p]]).sum();
        let q = (0..g.len()).map(along).collect();
        (g, q)
    }
}

fn all(problem: &Problem) -> Vec<usize> {
    (0..problem.len()).collect()
}

fn solved(solver: &mut Solver, context: &str) {
    solver.add_rows(&all(solver.problem())).unwrap();
    assert_eq!(solver.solve(), Ok(Status::Solved), "{context}");
    assert!(solver.residual() <= RESIDUAL, "{context}: {:e}", solver.residual());
}

#[test]
fn following_a_scene_in_motion_equals_fresh_solves_and_takes_fewer_pivots() {
    let mut rng = random(80);
    let (mut kept_pivots, mut fresh_pivots, mut kept_rows) = (0, 0, 0);
    for case in 0..200 {
        let mut scene = Scene::new(&mut rng);
        let mut solver = Solver::new(scene.problem(), Settings::default()).unwrap();
        solved(&mut solver, &format!("case {case}"));
        for step in 0..25 {
            let context = format!("case {case}, step {step}");
            let origins = scene.change(&mut rng);
            let before = solver.counts().pivots;
            kept_rows += solver.follow(scene.problem(), &origins).unwrap_or_else(|e| panic!("{context}: {e}"));
            solved(&mut solver, &context);
            kept_pivots += solver.counts().pivots - before;
            let problem = scene.problem();
            assert_eq!(solver.problem(), &problem, "{context}");
            let z: Vec<f64> = (0..problem.len()).map(|i| solver.z(i)).collect();
            assert_solves(&problem, &z, &context);
            let fresh = Dantzig.solve(&problem, None, &Settings::default()).unwrap();
            assert_same_w(&problem, &z, &fresh.z, SAME_W, &context);
            fresh_pivots += fresh.counts.pivots;
        }
    }
    assert!(2 * kept_pivots < fresh_pivots, "{kept_pivots} pivots against {fresh_pivots}");
    assert!(kept_rows > 0);
}

/// Products of generators that did not move are not made again, and every number is that of a fresh product.
#[test]
fn moved_generators_give_the_fresh_product_to_the_bit() {
    let mut rng = random(83);
    let mut in_place = 0;
    for case in 0..200 {
        let mut scene = Scene::new(&mut rng);
        for step in 0..10 {
            let before = scene.problem();
            let origins = scene.change(&mut rng);
            let (g, q) = scene.generators();
            let same_rows =
                before.len() == origins.len() && origins.iter().enumerate().all(|(i, o)| o.old() == Some(i));
            if same_rows {
                let moved: Vec<bool> = origins.iter().map(|origin| matches!(origin, Origin::Moved(_))).collect();
                let after = before.with_moved_generators(&g, &moved, &scene.inverse_mass, q).unwrap();
                assert_eq!(after, scene.problem(), "case {case}, step {step}");
                in_place += 1;
            }
        }
    }
    assert!(in_place > 500, "{in_place}");
}

/// Nothing has moved: no pivot, no row enters or leaves the factor, and the numbers are those of before.
#[test]
fn following_to_the_same_problem_costs_nothing() {
    let mut rng = random(81);
    for case in 0..50 {
        let scene = Scene::new(&mut rng);
        let mut solver = Solver::new(scene.problem(), Settings::default()).unwrap();
        solved(&mut solver, "first");
        let z: Vec<f64> = all(solver.problem()).iter().map(|&i| solver.z(i)).collect();
        let counts = solver.counts();
        let origins: Vec<Origin> = all(solver.problem()).into_iter().map(Origin::Same).collect();
        solver.follow(scene.problem(), &origins).unwrap();
        solved(&mut solver, "again");
        assert_eq!(solver.counts(), counts, "case {case}");
        assert_eq!(z, all(solver.problem()).iter().map(|&i| solver.z(i)).collect::<Vec<_>>(), "case {case}");
    }
}

/// A state written down and taken up goes on bit for bit, through dense and sparse factors.
#[test]
fn a_state_taken_up_goes_on_bit_for_bit() {
    let mut rng = random(82);
    for case in 0..60 {
        let mut scene = Scene::new(&mut rng);
        let mut solver = Solver::new(scene.problem(), Settings::default()).unwrap();
        solved(&mut solver, "first");
        for _ in 0..rng.random_range(0..6) {
            let origins = scene.change(&mut rng);
            solver.follow(scene.problem(), &origins).unwrap();
            solved(&mut solver, "on the way");
        }
        let written = serde_json::to_string(&solver.state()).unwrap();
        let state: SolverState = serde_json::from_str(&written).unwrap();
        assert_eq!(state, solver.state(), "case {case}");
        let mut twin = Solver::from_state(scene.problem(), Settings::default(), &state).unwrap();
        for step in 0..10 {
            let origins = scene.change(&mut rng);
            for each in [&mut solver, &mut twin] {
                each.follow(scene.problem(), &origins).unwrap();
                solved(each, "after it");
            }
            assert_eq!(solver.state(), twin.state(), "case {case}, step {step}");
        }
    }
}

/// What is refused changes nothing.
#[test]
fn origins_that_do_not_fit_are_refused() {
    let make = |m: &[f64]| Problem::from_dense(m, vec![-1.0, -1.0]).unwrap();
    let mut solver = Solver::new(make(&[2.0, 1.0, 1.0, 2.0]), Settings::default()).unwrap();
    solved(&mut solver, "two rows");
    let other = make(&[2.0, 0.5, 0.5, 2.0]);
    let mut refused = |origins: &[Origin]| solver.follow(other.clone(), origins).unwrap_err();
    assert!(matches!(refused(&[Origin::New]), LcpError::Origins { .. }));
    assert!(matches!(refused(&[Origin::Same(0), Origin::Moved(0)]), LcpError::Origins { .. }));
    assert_eq!(refused(&[Origin::New, Origin::Moved(2)]), LcpError::RowOutOfRange { row: 2, n: 2 });
    let changed = refused(&[Origin::Same(0), Origin::Same(1)]);
    assert!(matches!(changed, LcpError::RowChanged { row: 1, column: 0, .. }), "{changed}");
    assert_eq!(solver.solve(), Ok(Status::Solved));
    assert!((solver.z(0) - 1.0 / 3.0).abs() < 1e-12);
    let state = solver.state();
    let larger = Problem::from_dense(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], vec![0.0; 3]).unwrap();
    assert!(matches!(Solver::from_state(larger, Settings::default(), &state), Err(LcpError::ForeignState { .. })));
}
