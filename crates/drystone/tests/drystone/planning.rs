//! The planner: the paper's counts, reuse against fresh solves, and orders checked from scratch.

use drystone::formulate::{Acceleration, Assembly, BlockSet, Generator};
use drystone::plan::{
    FromScratch, Limits, Monitor, Outcome, Plan, Progress, Quiet, Reuse, ReuseDantzig, StabilityTest, Stage, Test,
    TestOutcome, disassembly_graph, plan,
};
use drystone::{BodyOptions, Scene, Verdict, check::check_blocks, scenes};
use drystone_lcp::{Settings, Solver, Start, Status};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::{HashMap, HashSet};
use std::time::Duration;

/// Stacks of which some fall, some stand without an order, and some can be taken apart.
fn mixed(count: u64) -> impl Iterator<Item = Scene> {
    (0..count).filter_map(|seed| {
        let (blocks, friction) = (4 + seed as usize % 30, if seed % 3 == 0 { 0.4 } else { 0.0 });
        match seed % 4 {
            0 => scenes::random_stack(blocks, seed, friction).ok(),
            1 => scenes::random_stack_where(blocks.min(10), seed, friction, |_| true).ok(),
            _ => {
                let blocks = 4 + blocks % 6;
                let whole = |scene: &Scene| scene.bodies().len() <= blocks || drystone::check::stands(scene).unwrap();
                scenes::random_stack_where(blocks, seed, friction, whole).ok()
            }
        }
    })
}

/// This crate's stability tests.
const TESTS: [Test; 3] = [Test::Lcp, Test::Reuse, Test::ReuseDantzig];

fn planned(scene: &Scene, test: Test) -> Plan {
    plan(scene, test, Limits::default(), &mut Quiet).unwrap()
}

fn set_of(assembly: &Assembly, blocks: impl IntoIterator<Item = usize>) -> BlockSet {
    let mut set = BlockSet::empty(assembly.blocks());
    blocks.into_iter().for_each(|block| set.insert(block));
    set
}

fn movable(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), ..BodyOptions::default() }
}

/// A pier, a plank with its centre of mass beyond it, and the counterweight on the plank that holds it: together they
/// stand, but none of plank and counterweight can come first. `loose` squares stand beside them.
fn orderless(loose: usize) -> Scene {
    let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
    let ground = BodyOptions { fixed: true, ..movable("ground") };
    scene.add_box([0.0, -0.5], [100.0, 1.0], 0.0, ground).unwrap();
    scene.add_box([0.0, 0.5], [1.0, 1.0], 0.0, movable("pier")).unwrap();
    scene.add_box([0.6, 1.1], [2.0, 0.2], 0.0, movable("plank")).unwrap();
    scene.add_box([0.0, 1.6], [0.8, 0.8], 0.0, movable("counterweight")).unwrap();
    for k in 0..loose {
        scene.add_box([4.0 + 2.0 * k as f64, 0.5], [1.0, 1.0], 0.0, movable(&format!("loose {k}"))).unwrap();
    }
    scene
}

/// Structures with face contacts, corners, slanted joints and loops of forces, with friction and without.
fn varied() -> Vec<Scene> {
    vec![
        scenes::five_blocks(0.0).unwrap(),
        scenes::five_blocks(0.5).unwrap(),
        scenes::pyramid(4, 0.0).unwrap(),
        scenes::pyramid(4, 0.5).unwrap(),
        scenes::diamond(3, 0.0).unwrap(),
        scenes::arch(9, 0.2, 0.7).unwrap(),
        scenes::wall(4, 3, 3, 0.6).unwrap(),
        scenes::random_stack(20, 1, 0.0).unwrap(),
        scenes::random_stack(20, 2, 0.0).unwrap(),
        scenes::random_stack(20, 3, 0.3).unwrap(),
        scenes::random_stack(12, 4, 1.0).unwrap(),
        orderless(3),
    ]
}

/// Table I of Loomis and Balkcom (2006). From scratch every test of k blocks costs 2 k pivots, one for each of the two
/// points on which a block comes to rest; with reuse it costs 2. A column of N has N - 1 movable blocks and the
/// complete one is not among the tests: 2 (1 + ... + (N - 2)) = (N - 2) (N - 1), and 2 (N - 2).
#[test]
fn columns_and_the_pyramid_take_the_pivots_of_the_paper() {
    let structures = [
        (scenes::column(50, 0.0).unwrap(), 2352, 96),
        (scenes::column(80, 0.0).unwrap(), 6162, 156),
        (scenes::pyramid(13, 0.0).unwrap(), 8190, 180),
    ];
    for (scene, from_scratch, reuse) in structures {
        let lcp = planned(&scene, Test::Lcp);
        assert_eq!((lcp.outcome, lcp.pivots()), (Outcome::Found, from_scratch));
        for test in [Test::Reuse, Test::ReuseDantzig] {
            let plan = planned(&scene, test);
            assert_eq!((plan.outcome, &plan.order), (Outcome::Found, &lcp.order));
            assert!(plan.pivots() <= reuse, "{test:?}: {} pivots, the paper has {reuse}", plan.pivots());
        }
        assert_eq!(lcp.records.len(), lcp.order.len() - 1, "every proper sub-assembly on the way, once");
    }
}

/// The paper's random structure of 84 blocks is not published; on it reuse took 36 times fewer pivots.
#[test]
fn reuse_saves_thirty_fold_on_a_random_structure() {
    let scene = scenes::random_stack(84, 1, 0.0).unwrap();
    let lcp = planned(&scene, Test::Lcp);
    for test in [Test::Reuse, Test::ReuseDantzig] {
        let plan = planned(&scene, test);
        assert_eq!((plan.outcome, &plan.order), (Outcome::Found, &lcp.order));
        let [lcp, reuse] = [lcp.pivots(), plan.pivots()];
        assert!(lcp >= 30 * reuse, "{test:?}: {lcp} against {reuse}");
    }
}

/// Stacks on which a search that steps back one reason at a time makes more than 100,000 tests: some overhanging part
/// waits for its counterweight while all else is put up and taken down around it. Its collapses say at once that
/// it waits in vain. The bounds are a third above what it takes.
#[test]
fn what_waits_in_vain_is_noticed_early() {
    for (blocks, seed, most) in [(120, 24, 650), (200, 6, 1600), (250, 9, 500)] {
        let scene = scenes::random_stack(blocks, seed, 0.0).unwrap();
        let limits = Limits { tests: Some(most), ..Limits::default() };
        let plan = plan(&scene, Test::Reuse, limits, &mut Quiet).unwrap();
        assert_eq!(plan.outcome, Outcome::Found, "{blocks}, {seed}");
        verify(&scene, &plan);
    }
}

/// A scene of only some of the movable bodies, and all fixed ones.
fn without_the_others(scene: &Scene, keep: &[usize]) -> Scene {
    let mut part = Scene::new(scene.gravity(), scene.friction()).unwrap();
    for (index, body) in scene.bodies().iter().enumerate() {
        if body.fixed || keep.contains(&index) {
            let name = Some(body.name.clone());
            let options = BodyOptions {
                name,
                density: body.density,
                friction: body.friction,
                fixed: body.fixed,
                ..BodyOptions::default()
            };
            if let Some(size) = body.box_size {
                part.add_box(body.pose.position, size, body.pose.angle, options).unwrap();
            } else {
                let corners: Vec<[f64; 2]> = body.shape.vertices().iter().map(|v| v.to_array()).collect();
                part.add_placed_polygon(&corners, body.pose, options).unwrap();
            }
        }
    }
    part
}

/// A generator by what stays the same in every sub-assembly: the bodies' names, the feature, the side of the cone.
fn identity(assembly: &Assembly, generator: &Generator) -> String {
    let contact = &assembly.contacts()[generator.contact()];
    let [a, b] = contact.bodies.map(|body| &assembly.bodies()[body].name);
    let [nx, ny, _] = contact.normal;
    let side = generator.direction[1] * nx - generator.direction[0] * ny;
    format!("{a}, {b}, {}, {side:+.6}", contact.id.feature)
}

/// Equation 8 of the paper, entry by entry: the problem of a scene with only those blocks is the principal
/// sub-problem of the complete one on their rows.
#[test]
fn the_problem_of_a_part_is_a_principal_part_of_the_problem() {
    let mut random = Pcg64::seed_from_u64(8);
    let mut largest = 0;
    for scene in varied() {
        let whole = Assembly::new(&scene).unwrap();
        for _ in 0..12 {
            let blocks: Vec<usize> = (0..whole.blocks()).filter(|_| random.random_range(0..3) > 0).collect();
            let bodies: Vec<usize> = blocks.iter().map(|&block| whole.body_index(block)).collect();
            let part = Assembly::new(&without_the_others(&scene, &bodies)).unwrap();
            let rows = whole.rows(&set_of(&whole, blocks));
            let identities: Vec<String> = rows.iter().map(|&j| identity(&whole, &whole.generators()[j])).collect();
            let expected: Vec<String> = part.generators().iter().map(|g| identity(&part, g)).collect();
            assert_eq!(identities, expected);
            assert_eq!(identities.iter().collect::<HashSet<_>>().len(), rows.len(), "identities are unique");
            let (principal, own) = (whole.problem().principal(&rows), part.problem());
            largest = largest.max(rows.len());
            for j in 0..rows.len() {
                close(principal.q()[j], own.q()[j], own.q()[j].abs());
                for i in 0..rows.len() {
                    let size = (own.m().get(i, i) * own.m().get(j, j)).sqrt();
                    close(principal.m().get(i, j), own.m().get(i, j), size);
                }
            }
        }
    }
    assert!(largest > 40);
}

/// Equal up to the rounding of a few sums. A polygon's centroid is computed again when it is added to a scene again.
fn close(a: f64, b: f64, size: f64) {
    assert!((a - b).abs() <= 1e-13 * size.max(1.0), "{a} and {b}");
}

/// Drives all tests along one walk through the disassembly graph, as the planner may: any block that is not there is
/// tested; on a standing sub-assembly the walk goes on or not; and at any time it steps back.
struct Walk<'a> {
    assembly: &'a Assembly,
    /// From scratch, and both ways of reuse.
    tests: [Box<dyn StabilityTest + 'a>; 3],
    placed: Vec<usize>,
    /// Of each test.
    pivots: [usize; 3],
    /// Sub-assemblies that fell and that stood.
    seen: [usize; 2],
}

impl<'a> Walk<'a> {
    fn new(assembly: &'a Assembly) -> Self {
        let tests: [Box<dyn StabilityTest + 'a>; 3] = [
            Box::new(FromScratch::new(assembly)),
            Box::new(Reuse::new(assembly)),
            Box::new(ReuseDantzig::new(assembly)),
        ];
        Self { assembly, tests, placed: Vec::new(), pivots: [0; 3], seen: [0; 2] }
    }

    fn step(&mut self, random: &mut Pcg64) {
        let missing: Vec<usize> = (0..self.assembly.blocks()).filter(|block| !self.placed.contains(block)).collect();
        if missing.is_empty() || !self.placed.is_empty() && random.random_range(0..4) == 0 {
            for _ in 0..random.random_range(1..=self.placed.len()) {
                self.placed.pop();
                self.tests.iter_mut().for_each(|test| test.backtrack());
            }
            return;
        }
        let added = missing[random.random_range(0..missing.len())];
        if self.stands(added) && random.random_range(0..5) > 0 {
            self.placed.push(added);
            self.tests.iter_mut().for_each(|test| test.descend());
        }
    }

    fn stands(&mut self, added: usize) -> bool {
        let set = set_of(self.assembly, self.placed.iter().copied().chain([added]));
        let fresh = check_blocks(self.assembly, &set);
        assert_eq!(fresh.status, Status::Solved);
        for (test, pivots) in self.tests.iter_mut().zip(&mut self.pivots) {
            let outcome = test.test(&set, added).unwrap();
            assert_eq!(outcome.stands, fresh.stable, "{set:?}");
            *pivots += outcome.pivots;
        }
        self.seen[usize::from(fresh.stable)] += 1;
        fresh.stable
    }
}

#[test]
fn reuse_answers_as_a_fresh_solve_on_every_walk() {
    let mut random = Pcg64::seed_from_u64(1);
    for scene in varied() {
        let assembly = Assembly::new(&scene).unwrap();
        let mut walk = Walk::new(&assembly);
        for _ in 0..300 {
            walk.step(&mut random);
        }
        assert!(walk.seen.iter().all(|&count| count > 10), "falling and standing: {:?}", walk.seen);
        let [scratch, reuse, dantzig] = walk.pivots;
        assert!(reuse.max(dantzig) < scratch, "{reuse} and {dantzig} pivots with reuse, {scratch} without");
    }
}

/// A sub-assembly that falls is as good a start as one that stands: Theorem 1 asks for a solution, not for rest. The
/// solver is driven by hand through adding blocks and going back, from a named start (with Theorem 1's bound on the
/// major cycles) and from a snapshot. Accelerations are unique (of all that forces in the cones give, they are the
/// nearest to zero in the metric of M), so they are compared with fresh ones.
#[test]
fn accelerations_do_not_depend_on_the_start() {
    let mut random = Pcg64::seed_from_u64(2);
    for scene in varied() {
        let assembly = Assembly::new(&scene).unwrap();
        let solver = || Solver::new(assembly.problem(), Settings::default()).unwrap();
        let (mut rolled, mut started) = (solver(), solver());
        let mut path = vec![(BlockSet::empty(assembly.blocks()), rolled.snapshot())];
        let mut falling = 0;
        for _ in 0..150 {
            let (current, state) = path.last().unwrap().clone();
            if current.len() == assembly.blocks() || path.len() > 1 && random.random_range(0..5) == 0 {
                path.truncate(random.random_range(1..path.len()));
                continue;
            }
            let missing: Vec<usize> = (0..assembly.blocks()).filter(|&block| !current.contains(block)).collect();
            let added = missing[random.random_range(0..missing.len())];
            let mut set = current.clone();
            set.insert(added);
            let fresh = check_blocks(&assembly, &set);
            falling += usize::from(!fresh.stable);
            let rows = assembly.rows_added(&set, added);

            rolled.restore(&state).unwrap();
            let indices = assembly.rows(&current);
            let z = indices.iter().map(|&j| rolled.z(j)).collect();
            rolled.add_rows(&rows).unwrap();
            same_accelerations(&assembly, &set, &mut rolled, &fresh);

            started.start_from(&Start { indices, z }).unwrap();
            started.add_rows(&rows).unwrap();
            let before = started.counts();
            same_accelerations(&assembly, &set, &mut started, &fresh);
            let cycles = (started.counts() - before).major_cycles;
            assert!(cycles <= rows.len(), "Theorem 1: {cycles} major cycles for {} more rows", rows.len());
            path.push((set, rolled.snapshot()));
        }
        assert!(falling > 10);
    }
}

/// Solves what is present in a solver and compares every acceleration with that of a fresh verdict.
fn same_accelerations(assembly: &Assembly, set: &BlockSet, solver: &mut Solver, fresh: &Verdict) {
    assert_eq!((solver.solve().unwrap(), fresh.status), (Status::Solved, Status::Solved));
    for (block, expected) in set.iter().zip(&fresh.accelerations) {
        let [x, y, _, _, _, turn] = assembly.acceleration(block, |j| solver.z(j));
        let (found, expected) = ([x, y, turn], expected.in_plane());
        let off = (0..3).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
        // A hundredth of the acceleration from which a block counts as falling.
        assert!(off <= 1e-9 * 9.81, "block {block} of {set:?}: {found:?}, fresh {expected:?}");
    }
}

/// Every order is verified without the planner's solver state, and every "no order" by brute force over the complete
/// disassembly graph: which standing sub-assemblies can be reached one block at a time?
#[test]
fn orders_and_dead_ends_are_true() {
    let small = [
        scenes::five_blocks(0.0).unwrap(),
        scenes::five_blocks(0.6).unwrap(),
        scenes::pyramid(3, 0.0).unwrap(),
        scenes::diamond(3, 0.0).unwrap(),
        scenes::arch(5, 0.2, 0.7).unwrap(),
        scenes::arch(8, 0.25, 0.7).unwrap(),
        scenes::random_stack(9, 5, 0.0).unwrap(),
        scenes::random_stack(9, 6, 0.2).unwrap(),
        orderless(4),
    ];
    let mut ends = HashSet::new();
    for scene in &small {
        let reachable = reachable_by_brute_force(scene);
        let largest = reachable.iter().map(Vec::len).max().unwrap();
        let blocks = scene.bodies().iter().filter(|body| !body.fixed).count();
        for test in TESTS {
            let plan = planned(scene, test);
            ends.insert(plan.outcome);
            assert_eq!(plan.outcome == Outcome::Found, largest == blocks);
            assert_eq!(plan.reached.len(), largest);
            verify(scene, &plan);
        }
    }
    assert_eq!(ends, HashSet::from([Outcome::Found, Outcome::NoOrder]));
    for scene in varied() {
        verify(&scene, &planned(&scene, Test::Reuse));
    }
}

fn reachable_by_brute_force(scene: &Scene) -> HashSet<Vec<usize>> {
    let mut reachable = HashSet::from([Vec::new()]);
    // By size, so that what a sub-assembly is built from comes before it.
    for node in disassembly_graph(&Assembly::new(scene).unwrap()).unwrap() {
        let without = |k: usize| [&node.bodies[..k], &node.bodies[k + 1..]].concat();
        if node.stands && (0..node.bodies.len()).any(|k| reachable.contains(&without(k))) {
            reachable.insert(node.bodies);
        }
    }
    reachable
}

/// Checks from scratch every structure on the way up to what was reached, and every block said to fall next.
fn verify(scene: &Scene, plan: &Plan) {
    let assembly = Assembly::new(scene).unwrap();
    let block = |body: &usize| (0..assembly.blocks()).find(|&block| assembly.body_index(block) == *body).unwrap();
    let stands = |bodies: &[usize]| check_blocks(&assembly, &set_of(&assembly, bodies.iter().map(block))).stable;
    for size in 1..=plan.reached.len() {
        assert!(stands(&plan.reached[..size]), "the first {size} of {:?}", plan.reached);
    }
    match plan.outcome {
        Outcome::Found => {
            let upward: Vec<usize> = plan.order.iter().rev().copied().collect();
            assert_eq!((upward.len(), &upward), (assembly.blocks(), &plan.reached));
            assert_eq!(upward.iter().collect::<HashSet<_>>().len(), upward.len(), "every block once");
            assert!(plan.falls_next.is_empty());
        }
        Outcome::NoOrder => {
            assert!(plan.order.is_empty() && !plan.falls_next.is_empty());
            for &next in &plan.falls_next {
                assert!(!plan.reached.contains(&next) && !stands(&[&plan.reached[..], &[next]].concat()));
            }
        }
        outcome => panic!("{outcome:?} without limits"),
    }
}

#[test]
fn no_order_says_how_far_one_gets_and_what_falls_next() {
    for test in TESTS {
        let scene = orderless(0);
        let plan = planned(&scene, test);
        assert!(plan.whole.is_some_and(|whole| whole.stable));
        assert_eq!(plan.outcome, Outcome::NoOrder);
        assert_eq!(plan.order, [0; 0]);
        assert_eq!(plan.reached, [scene.index_of("pier").unwrap()]);
        assert_eq!(plan.falls_next, [scene.index_of("plank").unwrap()]);
    }
}

#[test]
fn what_falls_as_a_whole_is_not_searched() {
    let scene = scenes::diamond(5, 0.0).unwrap();
    let plan = planned(&scene, Test::Reuse);
    assert_eq!((plan.outcome, plan.records.len()), (Outcome::WholeFalls, 0));
    assert!(plan.whole.is_some_and(|whole| !whole.stable && !whole.falling.is_empty()));
    assert!(plan.order.is_empty() && plan.reached.is_empty() && plan.falls_next.is_empty());
}

#[test]
fn nothing_to_move_is_a_plan_of_nothing() {
    let plan = planned(&scenes::column(1, 0.0).unwrap(), Test::Reuse);
    assert_eq!((plan.outcome, plan.order.len(), plan.records.len()), (Outcome::Found, 0, 0));
}

#[test]
fn a_spent_budget_hands_back_the_best_so_far() {
    let scene = orderless(8);
    let tests = Limits { tests: Some(5), ..Limits::default() };
    let plan = plan(&scene, Test::Reuse, tests, &mut Quiet).unwrap();
    assert_eq!((plan.outcome, plan.records.len()), (Outcome::TestLimit, 5));
    let standing = plan.records.iter().filter(|record| record.outcome.stands).map(|record| record.size).max();
    assert_eq!(Some(plan.reached.len()), standing);
    assert!(plan.order.is_empty() && plan.falls_next.is_empty());

    let time = Limits { time: Some(Duration::ZERO), ..Limits::default() };
    let plan = drystone::plan::plan(&scene, Test::Reuse, time, &mut Quiet).unwrap();
    assert_eq!((plan.outcome, plan.records.len()), (Outcome::TimeLimit, 0));
}

/// Stops a search after some tests, and keeps what it was told.
struct Stop {
    after: usize,
    told: Vec<Progress>,
}

impl Monitor for Stop {
    fn go_on(&mut self, progress: Progress) -> bool {
        if progress.stage == Stage::Whole {
            return true;
        }
        self.told.push(progress);
        progress.tests < self.after
    }
}

#[test]
fn a_monitor_is_told_before_every_test_and_can_stop_the_search() {
    let mut stop = Stop { after: 7, told: Vec::new() };
    let plan = plan(&orderless(8), Test::Reuse, Limits::default(), &mut stop).unwrap();
    assert_eq!((plan.outcome, plan.records.len()), (Outcome::Interrupted, 7));
    assert!(!plan.reached.is_empty() && plan.order.is_empty());
    for (k, (told, record)) in stop.told.iter().zip(&plan.records).enumerate() {
        assert_eq!((told.tests, told.placed, told.blocks), (k, record.size - 1, 11));
    }
    assert_eq!(stop.told.len(), 8);
}

/// Tests of the first search's first turn, in which it finds nothing here.
const FIRST_TURN: usize = 20_000;

/// Checks from scratch some of the structures on the way up to what was reached.
fn verify_some(scene: &Scene, plan: &Plan) {
    let assembly = Assembly::new(scene).unwrap();
    let block: HashMap<usize, usize> =
        (0..assembly.blocks()).map(|block| (assembly.body_index(block), block)).collect();
    for size in (1..=plan.reached.len()).step_by(27) {
        let set = set_of(&assembly, plan.reached[..size].iter().map(|body| block[body]));
        assert!(set.len() == size && check_blocks(&assembly, &set).stable, "the first {size}");
    }
}

#[test]
fn a_thousand_blocks_that_lean_on_one_another_have_an_order() {
    let scene = scenes::random_stack(1000, 1, 0.0).unwrap();
    let plan = planned(&scene, Test::Reuse);
    assert_eq!((plan.outcome, plan.order.len()), (Outcome::Found, 1000));
    assert!((FIRST_TURN..25_000).contains(&plan.records.len()), "{} tests", plan.records.len());
    verify_some(&scene, &plan);
    assert!(plan.reached.iter().eq(plan.order.iter().rev()));
}

#[test]
fn a_budget_and_a_monitor_hold_for_both_searches() {
    let scene = scenes::random_stack(500, 14, 0.0).unwrap();
    let first = Limits { tests: Some(FIRST_TURN), ..Limits::default() };
    let first = plan(&scene, Test::Reuse, first, &mut Quiet).unwrap();
    assert_eq!((first.outcome, first.records.len()), (Outcome::TestLimit, FIRST_TURN));

    let mut stop = Stop { after: FIRST_TURN + 1100, told: Vec::new() };
    let stopped = plan(&scene, Test::Reuse, Limits::default(), &mut stop).unwrap();
    assert_eq!((stopped.outcome, stopped.records.len()), (Outcome::Interrupted, FIRST_TURN + 1100));
    assert!(stop.told.iter().map(|told| told.tests).is_sorted());
    assert!(stopped.reached.len() > first.reached.len() && stopped.order.is_empty());
    let answers = |plan: &Plan| plan.records[..FIRST_TURN].iter().map(|r| (r.size, r.outcome)).collect::<Vec<_>>();
    assert_eq!(answers(&stopped), answers(&first));
    verify_some(&scene, &stopped);
}

/// Stops the check of the whole at its nth question.
struct StopWhole(usize);

impl Monitor for StopWhole {
    fn go_on(&mut self, progress: Progress) -> bool {
        assert_eq!((progress.stage, progress.tests), (Stage::Whole, 0), "stopped before the search");
        self.0 -= 1;
        self.0 > 0
    }
}

/// A monitor is asked for every block, as long as pivots are made.
#[test]
fn the_check_of_the_whole_can_be_stopped() {
    for (scene, after) in [(orderless(8), 5), (scenes::diamond(5, 0.0).unwrap(), 10)] {
        let plan = plan(&scene, Test::Reuse, Limits::default(), &mut StopWhole(after)).unwrap();
        assert_eq!((plan.outcome, plan.records.len(), plan.whole.is_none()), (Outcome::Interrupted, 0, true));
        let time = Limits { time: Some(Duration::ZERO), ..Limits::default() };
        let plan = drystone::plan::plan(&scene, Test::Reuse, time, &mut Quiet).unwrap();
        assert_eq!((plan.outcome, plan.whole.is_none()), (Outcome::TimeLimit, true));
    }
}

/// Everything but the clock.
fn timeless(plan: &Plan) -> impl PartialEq + std::fmt::Debug + '_ {
    let records: Vec<(usize, TestOutcome)> = plan.records.iter().map(|record| (record.size, record.outcome)).collect();
    let bits = |accelerations: &[Acceleration]| {
        accelerations.iter().map(|a| a.in_plane().map(f64::to_bits)).collect::<Vec<_>>()
    };
    let forces: Vec<_> =
        plan.whole.iter().flat_map(|whole| &whole.forces).map(|(_, force)| force.force.map(f64::to_bits)).collect();
    let accelerations = plan.whole.as_ref().map(|whole| bits(&whole.accelerations));
    let ends = (plan.outcome, &plan.order, &plan.reached, &plan.falls_next, plan.shortcuts);
    (ends, records, accelerations, forces)
}

#[test]
fn the_plan_is_the_same_on_any_number_of_threads() {
    let mut ends: HashMap<Outcome, usize> = HashMap::new();
    let large = [(220, 3), (230, 4), (250, 9)].map(|(blocks, seed)| scenes::random_stack(blocks, seed, 0.0).unwrap());
    let checked_beside = large.into_iter().chain([scenes::diamond(15, 0.0).unwrap(), orderless(220)]);
    for scene in mixed(300).chain(varied()).chain(checked_beside) {
        for test in TESTS {
            let on = |threads| {
                let limits = Limits { tests: Some(400), threads: Some(threads), ..Limits::default() };
                plan(&scene, test, limits, &mut Quiet).unwrap()
            };
            let alone = on(1);
            for threads in [2, 8] {
                assert_eq!(timeless(&on(threads)), timeless(&alone), "{test:?} on {threads} threads");
            }
            *ends.entry(alone.outcome).or_default() += 1;
        }
    }
    for outcome in [Outcome::Found, Outcome::NoOrder, Outcome::WholeFalls] {
        assert!(ends.get(&outcome).is_some_and(|&count| count > 20), "{ends:?}");
    }
}

#[test]
fn the_same_scene_gives_the_same_plan_to_the_bit() {
    for scene in varied() {
        for test in TESTS {
            let [first, again] = [planned(&scene, test), planned(&scene, test)];
            assert_eq!(timeless(&first), timeless(&again));
        }
    }
}
