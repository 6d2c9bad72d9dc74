//! The methods of the paper's section VI on the planner's tests: the same verdicts as Dantzig's, and less work with reuse.

use drystone::formulate::{Assembly, BlockSet};
use drystone::plan::{
    ByBlocks, ByLemke, FromScratch, Limits, Outcome, PlanError, Quiet, Recorder, Replay, Reuse, ReuseDantzig,
    StabilityTest, Step, TestOutcome, plan_with, replay,
};
use drystone::{BodyOptions, Scene, scenes};

fn recorded(assembly: &Assembly) -> (Outcome, Vec<Step>) {
    let limits = Limits { shortcuts: false, tests: Some(300), ..Limits::default() };
    let mut test = Recorder::new(FromScratch::new(assembly));
    let plan = plan_with(assembly, &mut test, limits, &mut Quiet).unwrap();
    let steps = test.into_steps();
    let tests = steps.iter().filter(|step| matches!(step, Step::Test { .. })).count();
    assert_eq!(tests, plan.records.len());
    (plan.outcome, steps)
}

/// By every method; none may fail.
fn replayed<'a>(assembly: &'a Assembly, steps: &[Step], context: &str) -> Vec<(&'static str, Replay)> {
    let tests: [(&'static str, Box<dyn StabilityTest + 'a>); 7] = [
        ("dantzig", Box::new(FromScratch::new(assembly))),
        ("reuse-dantzig", Box::new(ReuseDantzig::new(assembly))),
        ("reuse", Box::new(Reuse::new(assembly))),
        ("block", Box::new(ByBlocks::new(assembly, false))),
        ("reuse-block", Box::new(ByBlocks::new(assembly, true))),
        ("lemke", Box::new(ByLemke::new(assembly, false))),
        ("reuse-lemke", Box::new(ByLemke::new(assembly, true))),
    ];
    let put = |(name, mut test): (&'static str, Box<dyn StabilityTest + 'a>)| {
        let found = replay(steps, test.as_mut()).unwrap();
        assert_eq!((found.wrong, found.unanswered), (0, 0), "{context}, {name}: {found:?}");
        (name, found)
    };
    tests.into_iter().map(put).collect()
}

fn pivots(found: &[(&str, Replay)], name: &str) -> usize {
    found.iter().find(|(other, _)| *other == name).expect("one of the methods").1.pivots
}

/// A pier, a plank that tips off it, and the counterweight that holds the plank: none of the two can come first, and the
/// search finds that out for every set of the `loose` squares beside them.
fn orderless(loose: usize) -> Scene {
    let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
    let mut add = |centre: [f64; 2], size: [f64; 2], fixed: bool| {
        scene.add_box(centre, size, 0.0, BodyOptions { fixed, ..BodyOptions::default() }).unwrap();
    };
    add([0.0, -0.5], [100.0, 1.0], true);
    add([0.0, 0.5], [1.0, 1.0], false);
    add([0.6, 1.1], [2.0, 0.2], false);
    add([0.0, 1.6], [0.8, 0.8], false);
    (0..loose).for_each(|k| add([4.0 + 2.0 * k as f64, 0.5], [1.0, 1.0], false));
    scene
}

/// Searches that step back, whose tests stand and fall.
fn varied() -> Vec<Scene> {
    vec![
        scenes::five_blocks(0.5).unwrap(),
        scenes::diamond(3, 0.0).unwrap(),
        scenes::arch(7, 0.2, 0.7).unwrap(),
        scenes::wall(4, 3, 3, 0.6).unwrap(),
        scenes::random_stack(30, 1, 0.0).unwrap(),
        scenes::random_stack(30, 2, 0.0).unwrap(),
        scenes::random_stack(20, 3, 0.3).unwrap(),
        scenes::random_stack(12, 4, 1.0).unwrap(),
        orderless(6),
    ]
}

#[test]
fn every_method_gives_the_verdicts_of_dantzigs() {
    let (mut stand, mut fall, mut back) = (0, 0, 0);
    for (case, scene) in varied().iter().enumerate() {
        let assembly = Assembly::new(scene).unwrap();
        let (_, steps) = recorded(&assembly);
        stand += steps.iter().filter(|step| matches!(step, Step::Test { stands: true, .. })).count();
        fall += steps.iter().filter(|step| matches!(step, Step::Test { stands: false, .. })).count();
        back += steps.iter().filter(|step| matches!(step, Step::Backtrack)).count();
        replayed(&assembly, &steps, &format!("case {case}"));
    }
    assert!(stand > 50 && fall > 50 && back > 10, "{stand} stand, {fall} fall, {back} steps back");
}

/// A block of a column needs two contact forces: two pivots by Dantzig's method and by blocks; one more by Lemke's, for the
/// artificial variable.
#[test]
fn with_reuse_the_work_falls() {
    let scene = scenes::column(30, 0.0).unwrap();
    let assembly = Assembly::new(&scene).unwrap();
    let (outcome, steps) = recorded(&assembly);
    assert_eq!(outcome, Outcome::Found);
    let found = replayed(&assembly, &steps, "column");
    let tests = found[0].1.tests;
    assert_eq!(tests, 28);
    assert_eq!(pivots(&found, "reuse-dantzig"), 2 * tests);
    assert_eq!(pivots(&found, "reuse-block"), 2 * tests);
    assert_eq!(pivots(&found, "reuse-lemke"), 3 * tests);
    for friction in [0.0, 0.5] {
        let scene = scenes::pyramid(7, friction).unwrap();
        let assembly = Assembly::new(&scene).unwrap();
        let found = replayed(&assembly, &recorded(&assembly).1, &format!("pyramid, friction {friction}"));
        for (cold, warm) in [("dantzig", "reuse-dantzig"), ("block", "reuse-block"), ("lemke", "reuse-lemke")] {
            let [cold, warm] = [pivots(&found, cold), pivots(&found, warm)];
            assert!(4 * warm < cold, "friction {friction}: {warm} with reuse, {cold} from scratch");
        }
    }
}

/// A test that never answers, and one that always says yes.
struct Careless {
    answers: bool,
}

impl StabilityTest for Careless {
    fn test(&mut self, blocks: &BlockSet, _added: usize) -> Result<TestOutcome, PlanError> {
        if self.answers {
            return Ok(TestOutcome { stands: true, borderline: false, pivots: 1 });
        }
        Err(PlanError::NoAnswer { blocks: blocks.len(), reason: "it does not try".into() })
    }
}

#[test]
fn failures_are_counted() {
    let scene = scenes::random_stack(12, 4, 1.0).unwrap();
    let assembly = Assembly::new(&scene).unwrap();
    let (_, steps) = recorded(&assembly);
    let falls = steps.iter().filter(|step| matches!(step, Step::Test { stands: false, .. })).count();
    let wrong = replay(&steps, &mut Careless { answers: true }).unwrap();
    assert_eq!((wrong.wrong, wrong.unanswered, wrong.pivots), (falls, 0, wrong.tests));
    let silent = replay(&steps, &mut Careless { answers: false }).unwrap();
    assert_eq!((silent.wrong, silent.unanswered, silent.pivots), (0, silent.tests, 0));
}
