//! The displacement of least energy that is nearest to rest, and forces after it, by the interior-point method.
//!
//! (1) is a linear program (over round cones a cone program), and the method solves it as it is: forces and energy to rounding. But
//! its displacement is one of many where some cost nothing, as of a block that lies free on a floor without friction. Of these the one
//! nearest to rest, with masses for weights, is that of
//!
//! ```text
//! min 1/2 eps u' M u - u' F   over   G' u + c >= 0
//! ```
//!
//! for every eps that is small enough (Mangasarian and Meyer 1979): Gauss's principle with an offset. Whether it was is seen by the
//! energy. If not, steps from where it ended lead to the least (Rockafellar's proximal point method, 1976; it ends after few).

use crate::formulate::{BodySpace, Constrained};
use drystone_lcp::interior::{End, Found};

/// Eps times the largest displacement, of the acceleration of free fall: larger it takes more steps, smaller the displacement has less
/// digits. With 1e-2 a wall of 20 x 20 takes five steps, with 1e-3 two, with 1e-4 too few digits on round cones.
const SHARE: f64 = 1e-3;
/// Steps at most.
const MOST: usize = 10;
/// Energies that differ by less, of the work of the loads one by one, are the same; or of all loads times the largest displacement of a
/// support, where nothing follows it.
const SAME: f64 = 1e-9;
const NOTHING: f64 = 1e-13;

/// Blocks in the settled structure: displacements in place of accelerations.
pub(super) fn displacement(space: &BodySpace<'_>) -> Constrained {
    let largest = largest_offset(&space.clone().settled(1.0));
    if largest == 0.0 {
        let stays = space.solve();
        let found = Found { accelerations: vec![0.0; stays.found.accelerations.len()], ..stays.found };
        return space.constrained(found);
    }
    // The method's own unit is that of accelerations: the largest displacement becomes that of free fall.
    let unit = space.assembly().weighing() / largest;
    let once = space.clone().settled(unit);
    let mut after = once.problem().least_energy_while(&mut || true).expect("nobody stops it");
    after.accelerations.iter_mut().for_each(|a| *a /= unit);
    let load = &space.problem().load;
    let work = |u: &[f64]| load.iter().zip(u).map(|(load, u)| load * u).sum::<f64>();
    let terms = |u: &[f64]| load.iter().zip(u).map(|(load, u)| (load * u).abs()).sum::<f64>();
    let most = work(&after.accelerations);
    let rounding = NOTHING * largest * load.iter().map(|load| load.abs()).sum::<f64>();
    let eps = SHARE * unit;
    let space_of = space.clone().settled(eps);
    let (mut scaled, mut iterations) = (vec![0.0; load.len()], after.iterations);
    for _ in 0..MOST {
        let step = space_of.pulled_towards(&scaled).problem().solve();
        iterations += step.iterations;
        if step.end == End::OutOfMemory || !step.accelerations.iter().all(|a| a.is_finite()) {
            break;
        }
        scaled = step.accelerations;
        let u: Vec<f64> = scaled.iter().map(|a| a / eps).collect();
        if (work(&u) - most).abs() <= SAME * terms(&u) + rounding {
            return space.constrained(Found { accelerations: u, iterations, ..after });
        }
    }
    let accelerations = scaled.iter().map(|a| a / eps).collect();
    space.constrained(Found { accelerations, iterations, ..after })
}

/// The largest displacement that the settlements give a contact along an edge or axis of its cone.
fn largest_offset(space: &BodySpace<'_>) -> f64 {
    space.problem().offset.iter().fold(0.0_f64, |most, offset| most.max(offset.abs()))
}
