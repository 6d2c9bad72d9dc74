//! One time step as a complementarity problem of impulses and velocities.
//!
//! With velocities `v`, applied wrenches `F` and impulses `p >= 0` along the generators `G` of all approaches, a step of
//! length h ends with the velocities
//!
//! ```text
//! v+ = v* + M^-1 G p,    v* = v + h M^-1 F,
//! w  = A p + q,    0 <= p  complementary to  w >= 0,    A = G' M^-1 G,
//! q  = G' v* + (c + mu s) / sqrt(1 + mu^2)        (a row for each edge of each friction cone)
//! ```
//!
//! `c` (an offset for each approach, m/s) lets a contact close just by the end of the step: `gap / h`. `s` is the sliding
//! speed that the edges are corrected for, see `friction.rs`.
//!
//! D. Stewart and J. Trinkle, "An implicit time-stepping scheme for rigid body dynamics with inelastic collisions and
//! Coulomb friction", 1996; M. Anitescu and F. Potra, "Formulating dynamic multi-rigid-body contact problems with friction
//! as solvable linear complementarity problems", 1997; the convex form without `s`: M. Anitescu, 2006.

use crate::{contact::approach::Approach, formulate::cone_edges};
use drystone_lcp::{LcpError, Origin, Problem, cone::Columns};
use std::ops::Range;

/// Velocity of a body: m/s, m/s, rad/s.
pub type Velocity = [f64; 3];

/// The approaches of one step with their generators.
#[derive(Debug, Clone)]
pub(super) struct VelocityLevel {
    approaches: Vec<Approach>,
    /// First row of every approach, and the number of rows.
    starts: Vec<usize>,
    /// Unit direction of every row.
    directions: Vec<[f64; 2]>,
    /// `sqrt(1 + mu^2)` of every approach.
    edge_lengths: Vec<f64>,
}

impl VelocityLevel {
    pub fn new(approaches: Vec<Approach>) -> Self {
        let mut starts = Vec::with_capacity(approaches.len() + 1);
        let mut directions = Vec::with_capacity(2 * approaches.len());
        starts.push(0);
        for approach in &approaches {
            directions.extend(cone_edges(approach.normal, approach.friction));
            starts.push(directions.len());
        }
        let edge_lengths = approaches.iter().map(|approach| approach.friction.hypot(1.0)).collect();
        Self { approaches, starts, directions, edge_lengths }
    }

    pub fn approaches(&self) -> &[Approach] {
        &self.approaches
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// Rows of one approach.
    pub fn rows(&self, approach: usize) -> Range<usize> {
        self.starts[approach]..self.starts[approach + 1]
    }

    /// `A = G' M^-1 G` and q. `inverse_mass`: the diagonal of M^-1, three entries a body, zero for a fixed one.
    pub fn problem(&self, inverse_mass: &[[f64; 3]], q: Vec<f64>) -> Result<Problem, LcpError> {
        Problem::from_generators_and_q(&self.generators(inverse_mass)?, inverse_mass.as_flattened(), q)
    }

    /// The same from the problem before it, of which only the rows that moved are made anew where the others are as they were.
    pub fn problem_after(
        &self,
        (before, last): (&Self, &Problem),
        inverse_mass: &[[f64; 3]],
        q: Vec<f64>,
    ) -> Result<Problem, LcpError> {
        let origins = self.origins(before);
        let same_rows =
            before.len() == origins.len() && origins.iter().enumerate().all(|(row, origin)| origin.old() == Some(row));
        if !same_rows {
            return self.problem(inverse_mass, q);
        }
        let moved: Vec<bool> = origins.iter().map(|origin| matches!(origin, Origin::Moved(_))).collect();
        last.with_moved_generators(&self.generators(inverse_mass)?, &moved, inverse_mass.as_flattened(), q)
    }

    fn generators(&self, inverse_mass: &[[f64; 3]]) -> Result<Columns, LcpError> {
        let mut indptr = Vec::with_capacity(self.len() + 1);
        let (mut indices, mut data) = (Vec::with_capacity(6 * self.len()), Vec::with_capacity(6 * self.len()));
        indptr.push(0);
        for (k, approach) in self.approaches.iter().enumerate() {
            for row in self.rows(k) {
                for (side, sign) in [(0, -1.0), (1, 1.0)] {
                    let body = approach.id.bodies[side];
                    if inverse_mass[body] != [0.0; 3] {
                        indices.extend([3 * body, 3 * body + 1, 3 * body + 2]);
                        data.extend(wrench(approach.arms[side], self.directions[row].map(|d| sign * d)));
                    }
                }
                indptr.push(indices.len());
            }
        }
        Columns::new(3 * inverse_mass.len(), &indptr, &indices, &data)
    }

    /// `q` for velocities without impulses `free`, offsets `c` and sliding speeds `s`, one an approach.
    pub fn q(&self, free: &[Velocity], c: &[f64], s: &[f64]) -> Vec<f64> {
        let mut q = Vec::with_capacity(self.len());
        for (k, approach) in self.approaches.iter().enumerate() {
            let [ux, uy] = relative_velocity(approach, free);
            let lift = (c[k] + approach.friction * s[k]) / self.edge_lengths[k];
            q.extend(self.rows(k).map(|row| {
                let [dx, dy] = self.directions[row];
                dx * ux + dy * uy + lift
            }));
        }
        q
    }

    /// `v+ = v* + M^-1 G p`.
    pub fn velocities(&self, free: &[Velocity], inverse_mass: &[[f64; 3]], p: impl Fn(usize) -> f64) -> Vec<Velocity> {
        let mut velocities = free.to_vec();
        for (k, approach) in self.approaches.iter().enumerate() {
            let impulse = self.impulse(k, &p);
            if impulse == [0.0; 2] {
                continue;
            }
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let body = approach.id.bodies[side];
                let change = wrench(approach.arms[side], impulse.map(|p| sign * p));
                (0..3).for_each(|axis| velocities[body][axis] += inverse_mass[body][axis] * change[axis]);
            }
        }
        velocities
    }

    /// Impulse on the second body of an approach in world axes, N s.
    pub fn impulse(&self, approach: usize, p: impl Fn(usize) -> f64) -> [f64; 2] {
        self.rows(approach).fold([0.0; 2], |[x, y], row| {
            let [dx, dy] = self.directions[row];
            [x + dx * p(row), y + dy * p(row)]
        })
    }

    /// Where each row comes from in the problem before it. Both lists of approaches are in the order of identities.
    pub fn origins(&self, before: &Self) -> Vec<Origin> {
        let mut origins = Vec::with_capacity(self.len());
        for (k, old) in self.matches(before) {
            match old {
                Some(old) if before.approaches[old].same_geometry(&self.approaches[k]) => {
                    origins.extend(before.rows(old).map(Origin::Same));
                }
                Some(old) if before.rows(old).len() == self.rows(k).len() => {
                    origins.extend(before.rows(old).map(Origin::Moved));
                }
                _ => origins.extend(self.rows(k).map(|_| Origin::New)),
            }
        }
        origins
    }

    /// Each approach with its number in the list before.
    pub fn matches<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = (usize, Option<usize>)> + 'a {
        let mut old = 0;
        self.approaches.iter().enumerate().map(move |(k, approach)| {
            while before.approaches.get(old).is_some_and(|known| known.id < approach.id) {
                old += 1;
            }
            (k, before.approaches.get(old).filter(|known| known.id == approach.id).map(|_| old))
        })
    }
}

/// Force and moment about the centroid of a force that acts at the end of `arm`.
pub(super) fn wrench([rx, ry]: [f64; 2], [fx, fy]: [f64; 2]) -> [f64; 3] {
    [fx, fy, rx * fy - ry * fx]
}

/// Velocity of the second body relative to the first at the corner, m/s, in world axes.
fn relative_velocity(approach: &Approach, velocities: &[Velocity]) -> [f64; 2] {
    let of = |side: usize| {
        let [vx, vy, turning] = velocities[approach.id.bodies[side]];
        let [rx, ry] = approach.arms[side];
        [vx - turning * ry, vy + turning * rx]
    };
    let ([ax, ay], [bx, by]) = (of(0), of(1));
    [bx - ax, by - ay]
}

/// The same along the normal and along the tangent (the normal turned a quarter counter-clockwise).
pub(super) fn normal_and_tangential(approach: &Approach, velocities: &[Velocity]) -> [f64; 2] {
    let ([ux, uy], [nx, ny]) = (relative_velocity(approach, velocities), approach.normal);
    [ux * nx + uy * ny, uy * nx - ux * ny]
}
