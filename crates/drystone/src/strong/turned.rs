//! Loads turned: what a quarter turn of all velocities tells of a motion.
//!
//! Let R turn by a quarter, counter-clockwise. At a contact with the force f on the second body and the relative acceleration a there
//!
//! ```text
//! f' R a = -f_n a_t + f_t a_n = -f_n a_t                                              (1)
//! ```
//!
//! since no force is where it parts. Newton's law of each block times the turned acceleration of its centre of mass (m a' R a = 0), summed,
//! is with the virial V = sum f' d of the forces on a block, d from its centre of mass, and its angular acceleration alpha
//!
//! ```text
//! sum f_n a_t = sum F' R a + alpha V                                                  (2)
//! ```
//!
//! of which any multiple may be added to the power: for every l with |l| <= mu at all contacts
//!
//! ```text
//! a'M a = a'(F - l R'F) - l sum alpha V - sum f_n (mu |a_t| - l a_t)                  (3)
//! ```
//!
//! The last sum is not negative. So as far as blocks do not turn, a structure with friction must stand if it must without friction under loads
//! turned by some angle up to that of friction: a tilted wall as the same wall upright.
//!
//! *Where they turn*, alpha V is bounded by the least and greatest V of all solutions. A block that turns on a face lifts one end of
//! it: its turning is at most the parting there over the width, beyond how far what is below turns. That is linear in a.

use super::{
    branch::Branch,
    hinges::{Hinge, Turned},
    laws::Laws,
};

impl Turned {
    /// None where there are contacts without friction, or blocks that touch others in corners only.
    pub fn new(laws: &Laws<'_>) -> Option<Self> {
        if laws.points.iter().any(|point| point.friction <= 0.0) {
            return None;
        }
        let mut hinges = hinges(laws);
        let mut level = vec![usize::MAX; laws.size() / 3];
        for now in 0..level.len() {
            for hinge in &hinges {
                if hinge.below.is_none_or(|(below, _)| level[below] < now) && level[hinge.block] > now {
                    level[hinge.block] = now;
                }
            }
        }
        hinges.retain(|hinge| hinge.below.is_none_or(|(below, _)| level[below] < level[hinge.block]));
        level.iter().all(|&level| level < usize::MAX).then_some(Self { factor: 0.0, hinges })
    }

    /// The loads turned, of an unknown.
    pub fn load(&self, laws: &Laws<'_>, k: usize) -> f64 {
        match k % 3 {
            0 => laws.load[k] - self.factor * laws.load[k + 1],
            1 => laws.load[k] + self.factor * laws.load[k - 1],
            _ => laws.load[k],
        }
    }

    /// What `-l alpha V` is at most, for a block's turning counter-clockwise and clockwise by one.
    pub fn gains(&self, branch: &Branch, block: usize) -> [f64; 2] {
        let [least, most] = branch.virials[block].map(|virial| self.factor * virial);
        [(-least).max(-most).max(0.0), least.max(most).max(0.0)]
    }
}

/// What a force along the normal of a point and one along its tangent add to the virial of a block, in the unit of moments on it.
pub(super) fn virial(laws: &Laws<'_>, point: usize, block: usize) -> [f64; 2] {
    let lever = |row: &[(usize, f64)]| row.iter().find(|entry| entry.0 == 3 * block + 2).map_or(0.0, |entry| entry.1);
    let point = &laws.points[point];
    // The lever of the tangent is the distance along the normal, that of the normal less the distance along the tangent.
    [lever(&point.tangent), -lever(&point.normal)]
}

fn hinges(laws: &Laws<'_>) -> Vec<Hinge> {
    let problem = laws.space.problem();
    let mut hinges = Vec::new();
    for face in &laws.faces {
        let bodies = problem.points[face.points[0]].bodies;
        for (side, block) in bodies.into_iter().enumerate() {
            let Some(block) = block else { continue };
            // How fast a point parts where the block turns by one.
            let parts = |point: usize| -virial(laws, point, block)[1];
            let by_parting = |a: &&usize, b: &&usize| parts(**a).total_cmp(&parts(**b));
            let ends = (face.points.iter().max_by(by_parting), face.points.iter().min_by(by_parting));
            if let (Some(&most), Some(&least)) = ends
                && parts(most) > parts(least)
            {
                let width = parts(most) - parts(least);
                let ratio = |below: usize| laws.root_mass(3 * block + 2) / laws.root_mass(3 * below + 2);
                let below = bodies[1 - side].map(|below| (below, ratio(below)));
                hinges.push(Hinge { block, below, ends: [most, least], width });
            }
        }
    }
    hinges
}
