//! The equilibrium solver behind `check` and the reuse test, where it once went wrong.

use drystone::{check, scenes};

/// Joints of a thin arch are nearly parallel, so bases along it are ill conditioned: with a worn-out factor the
/// infeasibility rose and fell between the same two bases until the pivot limit.
#[test]
fn thin_arches_take_a_number_of_pivots_in_proportion() {
    for voussoirs in [41, 61, 71, 75, 81, 101] {
        for thickness in [0.05, 0.08, 0.1, 0.12, 0.2] {
            let scene = scenes::arch(voussoirs, thickness, 1.0).unwrap();
            let verdict = check(&scene, None).unwrap();
            let what = format!("{voussoirs} voussoirs of {thickness}: {:?}", verdict.counts);
            assert_eq!(verdict.stable, thickness > 0.11, "{what}");
            assert!(verdict.counts.pivots <= 20 * voussoirs, "{what}");
        }
    }
}

/// Side contacts with friction make a pyramid as redundant as it gets; it stands whatever its size.
#[test]
fn a_large_pyramid_with_friction_stands() {
    for friction in [0.0, 0.5] {
        let verdict = check(&scenes::pyramid(40, friction).unwrap(), None).unwrap();
        assert!(verdict.stable && verdict.residual <= 1e-9, "{:?}", verdict.counts);
    }
}

/// The whole structure's weight reaches the ground, and each of its blocks is balanced to a billionth of its own.
#[test]
fn forces_balance_every_block_of_a_tall_column() {
    let verdict = check(&scenes::column(1000, 0.5).unwrap(), None).unwrap();
    assert!(verdict.stable);
    let bottom: f64 = verdict.forces.iter().filter(|(c, _)| c.bodies[0] == 0).map(|(_, force)| force.normal).sum();
    assert!((bottom / (999.0 * 9.81) - 1.0).abs() < 1e-9, "{bottom}");
    assert!(verdict.accelerations.iter().flat_map(|a| a.in_plane()).all(|a| a.abs() < 1e-8));
}
