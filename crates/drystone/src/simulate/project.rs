//! Overlaps that are left at the end of a step are taken back in the places alone, not in the velocities.
//!
//! The step's problem is linear in the turn of the bodies, so a corner on a turning face may end the step within the other
//! block by about (turn in one step)^2 of its arm. The shortest way out, in the metric of the masses, is a complementarity problem
//! of its own:
//!
//! ```text
//! w = N' M^-1 N l + gap,    0 <= l  complementary to  w >= 0,    x <- x + M^-1 N l
//! ```
//!
//! over the normals N of all approaches of bodies that moved; motionless ones are held. What a body gains in height by it is
//! taken from its kinetic energy, so that a step never adds energy.

use super::velocity_level::Velocity;
use crate::{contact::approach::Approach, geometry::Pose, scene::Scene};
use drystone_lcp::{Counts, Problem, Settings, Solver, Status, cone::Columns};

/// Overlaps are taken back when they are deeper than this share of the pair's contact tolerance.
pub(super) const ALLOWED: f64 = 0.5;

/// Times the problem is linearised anew. Each leaves a square of what the last one moved, so two are the rule.
pub(super) const ROUNDS: usize = 10;

/// Share of its own entry of the matrix by which each contact gives way where bodies are jammed.
const COMPLIANCE: f64 = 1e-3;

/// Moves bodies apart so that no gap of the approaches is negative, to first order. `inverse_mass` is zero for what is
/// held. Where bodies are jammed between others there may be no such motion; each contact then gives way a little, which
/// leaves a share of the overlap. Returns the change of every place.
pub(super) fn way_out(
    approaches: &[&Approach],
    inverse_mass: &[[f64; 3]],
    counts: &mut Counts,
) -> Option<Vec<[f64; 3]>> {
    part(approaches, inverse_mass, 0.0, counts).or_else(|| part(approaches, inverse_mass, COMPLIANCE, counts))
}

fn part(
    approaches: &[&Approach],
    inverse_mass: &[[f64; 3]],
    compliance: f64,
    counts: &mut Counts,
) -> Option<Vec<[f64; 3]>> {
    let mut weights = inverse_mass.as_flattened().to_vec();
    let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
    for approach in approaches {
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let body = approach.id.bodies[side];
            if inverse_mass[body] != [0.0; 3] {
                let ([nx, ny], [rx, ry]) = (approach.normal, approach.arms[side]);
                indices.extend([3 * body, 3 * body + 1, 3 * body + 2]);
                data.extend([sign * nx, sign * ny, sign * (rx * ny - ry * nx)]);
            }
        }
        if compliance > 0.0 {
            // A coordinate of the contact's own, as if something soft were in between.
            let own: f64 =
                (indptr[indptr.len() - 1]..data.len()).map(|p| data[p] * data[p] * weights[indices[p]]).sum();
            indices.push(weights.len());
            data.push(1.0);
            weights.push(compliance * own);
        }
        indptr.push(indices.len());
    }
    let gaps = approaches.iter().map(|approach| approach.gap).collect();
    let g = Columns::new(weights.len(), &indptr, &indices, &data).ok()?;
    let problem = Problem::from_generators_and_q(&g, &weights, gaps).ok()?;
    let mut solver = Solver::new(problem, Settings::default()).ok()?;
    solver.add_rows(&(0..approaches.len()).collect::<Vec<_>>()).ok()?;
    let status = solver.solve();
    *counts = *counts + solver.counts();
    if status != Ok(Status::Solved) {
        return None;
    }
    let mut change = vec![[0.0; 3]; inverse_mass.len()];
    for row in 0..approaches.len() {
        for p in (indptr[row]..indptr[row + 1]).filter(|&p| indices[p] < 3 * inverse_mass.len()) {
            let (body, axis) = (indices[p] / 3, indices[p] % 3);
            change[body][axis] += inverse_mass[body][axis] * data[p] * solver.z(row);
        }
    }
    Some(change)
}

/// Changes the places, and takes the potential energy gained from the motion of the bodies that were moved.
pub(super) fn shift(scene: &mut Scene, velocities: &mut [Velocity], change: &[[f64; 3]]) {
    let [gx, gy] = scene.gravity();
    let (mut gained, mut kinetic) = (0.0, 0.0);
    let moved: Vec<usize> = (0..change.len()).filter(|&i| change[i] != [0.0; 3]).collect();
    for &i in &moved {
        let body = &scene.bodies()[i];
        let ([vx, vy, turning], [dx, dy, turn]) = (velocities[i], change[i]);
        gained -= body.mass() * (gx * dx + gy * dy);
        kinetic += 0.5 * body.mass() * (vx * vx + vy * vy) + 0.5 * body.inertia() * turning * turning;
        let Pose { position: [x, y], angle } = body.pose;
        scene.set_pose(i, Pose { position: [x + dx, y + dy], angle: angle + turn });
    }
    if gained > 0.0 && kinetic > 0.0 {
        let left = (1.0 - gained / kinetic).max(0.0).sqrt();
        moved.iter().for_each(|&i| velocities[i].iter_mut().for_each(|v| *v *= left));
    }
}
