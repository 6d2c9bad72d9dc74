//! The interior-point method against the other routes, and the work that it saves.

use drystone::{
    Scene, Structure,
    check::{Route, Verdict, check_blocks, check_while},
    formulate::{Assembly, Cones, FrictionCone},
    scene::{BodyOptions, SceneOf},
    scenes,
    simulate::{Options, World},
};
use drystone_lcp::Status;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

fn by<S: drystone::formulate::Assemble>(scene: &SceneOf<S>, route: Route, cone: FrictionCone) -> Verdict {
    let assembly = Assembly::with_cones(scene, Cones::default()).unwrap();
    check_while(&assembly, None, route, cone, &mut |_| true).unwrap().unwrap()
}

/// A wall under gravity that leans by a share k of g.
fn leaning(rows: usize, k: f64) -> Scene {
    let upright = scenes::wall(rows, rows, 0, 0.5).unwrap();
    let mut scene = Scene::new([9.81 * k, -9.81], 0.5).unwrap();
    for body in upright.bodies() {
        let options = BodyOptions { name: Some(body.name.clone()), fixed: body.fixed, ..BodyOptions::default() };
        scene.add_polygon(&body.vertices(), options).unwrap();
    }
    scene
}

#[test]
fn every_route_gives_the_same_verdict_and_the_same_falling_blocks() {
    let mut scenes =
        vec![scenes::diamond(6, 0.0).unwrap(), scenes::pyramid(8, 0.0).unwrap(), scenes::column(9, 0.3).unwrap()];
    scenes.extend([0.2, 0.45, 0.6, 0.9].map(|k| leaning(5, k)));
    scenes.extend((0..12).map(|seed| scenes::random_stack(30, seed, 0.4).unwrap()));
    let mut fell = 0;
    for scene in &scenes {
        let [lcp, inner, pivots] = [Route::Complementarity, Route::InteriorPoint, Route::Equilibrium]
            .map(|route| by(scene, route, FrictionCone::Pyramid));
        assert_eq!((lcp.stable, &lcp.falling), (inner.stable, &inner.falling));
        assert_eq!((lcp.stable, &lcp.falling), (pivots.stable, &pivots.falling));
        fell += usize::from(!lcp.stable);
        for (a, b) in lcp.accelerations.iter().zip(&inner.accelerations) {
            let apart = a.in_plane().iter().zip(b.in_plane()).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
            assert!(apart < 1e-7, "{apart:e}");
        }
    }
    assert!((3..scenes.len()).contains(&fell), "{fell} of {} fall", scenes.len());
}

#[test]
fn what_pivots_would_climb_for_is_left_to_the_interior_point() {
    // From nothing these took 4,492 and 26,501 pivots.
    for k in [0.2, 0.38] {
        let verdict = by(&leaning(15, k), Route::Equilibrium, FrictionCone::Pyramid);
        assert!(verdict.stable && verdict.iterations < 20, "{k}: {} iterations", verdict.iterations);
        assert_eq!(verdict.counts.pivots, 0, "{k}");
    }
    // What bears straight takes neither.
    let upright = by(&leaning(15, 0.0), Route::Equilibrium, FrictionCone::Pyramid);
    assert_eq!((upright.stable, upright.iterations, upright.counts.pivots), (true, 0, 0));
}

#[test]
fn a_structure_goes_on_from_the_interior() {
    let scene = leaning(10, 0.3);
    let mut structure = Structure::new(&scene).unwrap();
    (0..structure.assembly().blocks()).for_each(|block| structure.add(block));
    assert_eq!(structure.stands(), Some(true));
    let pivots = structure.counts().pivots;
    assert!(pivots < 1000, "{pivots}");
    // In any order, the answers are those of a check from nothing.
    for block in [104, 50, 99, 7, 51, 103] {
        structure.remove(block);
        let names: Vec<String> =
            structure.blocks().iter().map(|block| structure.assembly().body(block).name.clone()).collect();
        let fresh =
            check_while(structure.assembly(), Some(&names), Route::Complementarity, FrictionCone::Pyramid, &mut |_| {
                true
            });
        assert_eq!(structure.stands(), Some(fresh.unwrap().unwrap().stable), "without {block}");
    }
}

/// Too hard for pivots, its answers begin at forces: those of a check from nothing whatever comes and goes, also when it is taken up
/// from its bytes, and no pivots but where these are tried again.
#[test]
fn a_structure_too_hard_for_pivots_goes_on_from_forces() {
    let scene = leaning(14, 0.3);
    let assembly = Assembly::new(&scene).unwrap();
    let blocks = assembly.blocks();
    let mut structure = Structure::of(assembly.clone());
    (0..blocks).for_each(|block| structure.add(block));
    assert_eq!(structure.stands(), Some(true));
    let mut random = Pcg64::seed_from_u64(3);
    let (mut verdicts, mut without_pivots) = ([0, 0], 0);
    for step in 0..60 {
        // Mostly the upper half, so that it stands now and then.
        let block = random.random_range(if step % 10 == 9 { 0..blocks } else { blocks / 2..blocks });
        if structure.blocks().contains(block) {
            structure.remove(block)
        } else {
            structure.add(block)
        }
        if step % 7 == 0 {
            structure = Structure::from_bytes(assembly.clone(), &structure.to_bytes()).unwrap();
        }
        let before = structure.counts().pivots;
        let stands = structure.stands();
        without_pivots += usize::from(structure.counts().pivots == before);
        let fresh = check_blocks(&assembly, structure.blocks());
        assert_eq!(stands, Some(fresh.stable), "step {step}");
        if step % 12 == 0 {
            let verdict = structure.check();
            assert_eq!((verdict.stable, &verdict.falling), (fresh.stable, &fresh.falling), "step {step}");
            assert!(verdict.residual < 1e-9);
        }
        verdicts[usize::from(fresh.stable)] += 1;
        if !fresh.stable && random.random_range(0..3) > 0 {
            structure.add(block);
        }
    }
    assert!(verdicts.iter().all(|&verdicts| verdicts > 10), "{verdicts:?}");
    assert!(without_pivots > 30, "{without_pivots} of 60");
}

/// The nearer to its limit the slower a wall falls: contacts may close by rounding beside that only.
#[test]
fn a_wall_within_a_millionth_of_its_limit_is_decided() {
    let limit = 0.370_969_159_803_044; // of `drystone.limit`, to 1e-12
    for share in [-1e-2, -1e-4, -1e-6, 1e-6, 1e-4, 1e-2] {
        let verdict = by(&leaning(40, limit * (1.0 + share)), Route::Equilibrium, FrictionCone::Pyramid);
        assert_eq!((verdict.status, verdict.stable), (Status::Solved, share < 0.0), "{share:e}");
        assert_eq!(verdict.counts.pivots, 0, "{share:e}");
    }
}

#[test]
fn a_world_at_rest_begins_from_the_interior() {
    let mut world = World::new(leaning(12, 0.35), Options::default()).unwrap();
    let record = world.step().unwrap();
    assert!(record.counts.pivots < 600, "{} pivots", record.counts.pivots);
    assert!(record.motionless.iter().all(|&still| still));
}

#[test]
fn a_world_that_falls_at_once_begins_from_what_bears() {
    // From nothing the first step took 2,915 pivots.
    let mut world = World::new(leaning(10, 0.6), Options::default()).unwrap();
    let record = world.step().unwrap();
    assert!(record.counts.pivots < 700, "{} pivots", record.counts.pivots);
    assert!(record.residual < 1e-9 && record.friction_error < 1e-6, "{record:?}");
    assert!(record.motionless.contains(&false));
}
