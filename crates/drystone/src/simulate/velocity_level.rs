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
//! speed that the edges are corrected for, see `friction.rs`. A cone has two edges in the plane; in space it is a pyramid
//! (`formulate/cones.rs`) and mu the coefficient at its edges. `v*` holds what turning does to a body in space, too.
//!
//! D. Stewart and J. Trinkle, "An implicit time-stepping scheme for rigid body dynamics with inelastic collisions and
//! Coulomb friction", 1996; M. Anitescu and F. Potra, "Formulating dynamic multi-rigid-body contact problems with friction
//! as solvable linear complementarity problems", 1997; the convex form without `s`: M. Anitescu, 2006.

use super::moving::{Moving, axes, components, is_zero, split, split_mut};
use crate::{
    contact::approach::{Approach, ApproachOf},
    formulate::Cones,
    geometry::{Numbers, Polygon, plus_times, product},
};
use drystone_lcp::{
    LcpError, Origin, Problem,
    cone::Columns,
    interior::{Cone, Gauss, Point},
};
use std::ops::Range;

/// Velocity of a body in the plane: m/s, m/s, rad/s.
pub type Velocity = [f64; 3];

/// The approaches of one step with their generators.
#[derive(Debug, Clone)]
pub struct VelocityLevel<S: Moving = Polygon> {
    approaches: Vec<ApproachOf<S>>,
    /// First row of every approach, and the number of rows.
    starts: Vec<usize>,
    /// Unit direction of every row, and its approach.
    directions: Vec<S::Vector>,
    approach_of: Vec<usize>,
    /// Coefficient at the cone's edges, and `sqrt(1 + mu^2)`, of every approach.
    edges: Vec<[f64; 2]>,
}

impl<S: Moving> VelocityLevel<S> {
    pub fn new(approaches: Vec<ApproachOf<S>>, cones: Cones, gravity: S::Vector) -> Self {
        Self::after(None, approaches, cones, gravity)
    }

    /// The same, with the cones' edges of approaches that were there before.
    pub fn after(before: Option<&Self>, approaches: Vec<ApproachOf<S>>, cones: Cones, gravity: S::Vector) -> Self {
        let mut starts = Vec::with_capacity(approaches.len() + 1);
        let mut directions = Vec::with_capacity(before.map_or(2 * approaches.len(), Self::len));
        let mut known = before.iter().flat_map(|before| before.approaches.iter().enumerate()).peekable();
        starts.push(0);
        for approach in &approaches {
            while known.next_if(|(_, old)| old.id < approach.id).is_some() {}
            match before.zip(known.next_if(|(_, old)| old.same_geometry(approach))) {
                Some((before, (old, _))) => directions.extend_from_slice(&before.directions[before.rows(old)]),
                None => directions.extend(S::edges(cones, approach.normal, approach.friction, gravity)),
            }
            starts.push(directions.len());
        }
        let edge = |approach: &ApproachOf<S>| {
            let friction = S::edge_friction(cones, approach.friction);
            [friction, friction.hypot(1.0)]
        };
        let edges = approaches.iter().map(edge).collect();
        let approach_of =
            (0..approaches.len()).flat_map(|k| std::iter::repeat_n(k, starts[k + 1] - starts[k])).collect();
        Self { approaches, starts, directions, approach_of, edges }
    }

    pub fn approaches(&self) -> &[ApproachOf<S>] {
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

    /// Coefficient at the edges of an approach's cone.
    pub fn friction(&self, approach: usize) -> f64 {
        self.edges[approach][0]
    }

    /// `A = G' M^-1 G` and q. `inverse_mass`: the diagonal of M^-1, zero for a fixed body.
    pub fn problem(&self, inverse_mass: &[S::Velocity], q: Vec<f64>) -> Result<Problem, LcpError> {
        Problem::from_generators_and_q(&self.generators(0..self.len(), inverse_mass)?, &flat(inverse_mass), q)
    }

    /// The same from the problem before it, of which only the rows that moved are made anew where the others are as they were.
    pub fn problem_after(
        &self,
        (before, last): (&Self, &Problem),
        inverse_mass: &[S::Velocity],
        q: Vec<f64>,
    ) -> Result<Problem, LcpError> {
        let origins = self.origins(before);
        let same_rows =
            before.len() == origins.len() && origins.iter().enumerate().all(|(row, origin)| origin.old() == Some(row));
        if !same_rows {
            return self.problem(inverse_mass, q);
        }
        let moved: Vec<bool> = origins.iter().map(|origin| matches!(origin, Origin::Moved(_))).collect();
        last.with_moved_generators(&self.generators(0..self.len(), inverse_mass)?, &moved, &flat(inverse_mass), q)
    }

    /// The columns of G for some rows, in order; nothing acts on fixed bodies.
    pub fn generators(
        &self,
        rows: impl ExactSizeIterator<Item = usize>,
        inverse_mass: &[S::Velocity],
    ) -> Result<Columns, LcpError> {
        let size = components::<S>();
        let mut indptr = Vec::with_capacity(rows.len() + 1);
        let (mut indices, mut data) =
            (Vec::with_capacity(2 * size * rows.len()), Vec::with_capacity(2 * size * rows.len()));
        indptr.push(0);
        for row in rows {
            let approach = &self.approaches[self.approach_of[row]];
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let body = approach.id.bodies[side];
                if !is_zero(&inverse_mass[body]) {
                    indices.extend(size * body..size * (body + 1));
                    data.extend(wrench::<S>(&approach.levers[side], &self.directions[row], sign).as_ref());
                }
            }
            indptr.push(indices.len());
        }
        Columns::new(size * inverse_mass.len(), &indptr, &indices, &data)
    }

    /// Gauss's principle for some approaches, with velocities in place of accelerations: `loads` is `-M v*` of every body,
    /// `bodies` are those that move.
    pub fn gauss(
        &self,
        approaches: &[usize],
        (loads, inverse_mass): (&[f64], &[S::Velocity]),
        bodies: &[usize],
    ) -> Gauss {
        let size = components::<S>();
        let mut problem = Gauss { size, ..Gauss::default() };
        let mut place = vec![None; inverse_mass.len()];
        for (k, &body) in bodies.iter().enumerate() {
            place[body] = Some(k);
            problem.inverse_mass.extend(inverse_mass[body].as_ref());
            problem.load.extend(loads[size * body..][..size].iter().map(|load| -load));
        }
        problem.points = approaches.iter().map(|&approach| self.point(approach, &place)).collect();
        problem
    }

    /// What each row of w has beside `G' v`: offsets `c` and sliding speeds `s`, one an approach, at the cone's edges.
    pub fn lifts(&self, c: &[f64], s: &[f64]) -> Vec<f64> {
        let lift = |k: usize| {
            let [friction, length] = self.edges[k];
            std::iter::repeat_n((c[k] + friction * s[k]) / length, self.rows(k).len())
        };
        (0..self.approaches.len()).flat_map(lift).collect()
    }

    /// An approach as a contact point of Gauss's principle, with the edges of its cone; `place` numbers the bodies that move.
    fn point(&self, approach: usize, place: &[Option<usize>]) -> Point {
        let axes = axes::<S>();
        let at = &self.approaches[approach];
        let along = |side: usize, axis: usize| {
            let mut row = [0.0; 6];
            if axis < axes {
                let mut unit = S::Vector::default();
                unit.as_mut()[axis] = 1.0;
                let wrench = wrench::<S>(&at.levers[side], &unit, [-1.0, 1.0][side]);
                row[..components::<S>()].copy_from_slice(wrench.as_ref());
            }
            row
        };
        let in_space = |direction: &S::Vector| {
            let mut edge = [0.0; 3];
            edge[..axes].copy_from_slice(direction.as_ref());
            edge
        };
        Point {
            bodies: at.id.bodies.map(|body| place[body]),
            jacobian: [0, 1].map(|side| [0, 1, 2].map(|axis| along(side, axis))),
            cone: Cone::Edges(self.directions[self.rows(approach)].iter().map(in_space).collect()),
        }
    }

    /// `A_ii`: the speed along a row's direction that a unit of its impulse gives, 1/kg.
    pub fn yielding(&self, row: usize, inverse_mass: &[S::Velocity]) -> f64 {
        let approach = &self.approaches[self.approach_of[row]];
        let of = |side: usize| {
            let wrench = wrench::<S>(&approach.levers[side], &self.directions[row], 1.0);
            let inverse = inverse_mass[approach.id.bodies[side]].as_ref();
            inverse.iter().zip(wrench.as_ref()).map(|(inverse, w)| inverse * w * w).sum::<f64>()
        };
        of(0) + of(1)
    }

    /// `q` for velocities without impulses `free`, offsets `c` and sliding speeds `s`, one an approach.
    pub fn q(&self, free: &[S::Velocity], c: &[f64], s: &[f64]) -> Vec<f64> {
        let mut q = Vec::with_capacity(self.len());
        for (k, approach) in self.approaches.iter().enumerate() {
            let u = relative_velocity::<S>(approach, free);
            let [friction, length] = self.edges[k];
            let lift = (c[k] + friction * s[k]) / length;
            q.extend(self.directions[self.rows(k)].iter().map(|direction| product(direction, &u) + lift));
        }
        q
    }

    /// `v+ = v* + M^-1 G p`.
    pub fn velocities(
        &self,
        free: &[S::Velocity],
        inverse_mass: &[S::Velocity],
        p: impl Fn(usize) -> f64,
    ) -> Vec<S::Velocity> {
        let mut velocities = free.to_vec();
        for (k, approach) in self.approaches.iter().enumerate() {
            let impulse = self.impulse(k, &p);
            if !is_zero(&impulse) {
                push::<S>(approach, &impulse, inverse_mass, &mut velocities);
            }
        }
        velocities
    }

    /// Impulse on the second body of an approach in world axes, N s.
    pub fn impulse(&self, approach: usize, p: impl Fn(usize) -> f64) -> S::Vector {
        let add = |sum, row: usize| plus_times(sum, p(row), &self.directions[row]);
        self.rows(approach).fold(S::Vector::default(), add)
    }

    /// Speeds of the second body of an approach relative to the first: along the normal, and of sliding, m/s.
    pub fn opening_and_sliding(&self, approach: usize, velocities: &[S::Velocity]) -> [f64; 2] {
        let Approach { normal, .. } = &self.approaches[approach];
        let u = relative_velocity::<S>(&self.approaches[approach], velocities);
        let edges = &self.directions[self.rows(approach)];
        [product(normal, &u), S::sliding_speed(edges, normal, self.friction(approach), &u)]
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

/// One number after the other.
fn flat<V: Numbers>(values: &[V]) -> Vec<f64> {
    values.iter().flat_map(|value| value.as_ref()).copied().collect()
}

/// Force, and moment about each turning, of `sign` times a force that acts where the levers are of.
pub(super) fn wrench<S: Moving>(levers: &S::Levers, force: &S::Vector, sign: f64) -> S::Velocity {
    let mut wrench = S::Velocity::default();
    let (along, moment) = split_mut::<S>(&mut wrench);
    along.iter_mut().zip(force.as_ref()).for_each(|(entry, f)| *entry = sign * f);
    moment.iter_mut().zip(levers.as_ref()).for_each(|(entry, lever)| *entry = sign * product(lever, force));
    wrench
}

/// Gives the second body of an approach an impulse, and the first its opposite.
pub(super) fn push<S: Moving>(
    approach: &ApproachOf<S>,
    impulse: &S::Vector,
    inverse_mass: &[S::Velocity],
    velocities: &mut [S::Velocity],
) {
    for (side, sign) in [(0, -1.0), (1, 1.0)] {
        let body = approach.id.bodies[side];
        let change = wrench::<S>(&approach.levers[side], impulse, sign);
        let per_mass = inverse_mass[body].as_ref().iter().zip(change.as_ref());
        velocities[body].as_mut().iter_mut().zip(per_mass).for_each(|(v, (mass, p))| *v += mass * p);
    }
}

/// Velocity of the second body relative to the first at the point, m/s, in world axes.
pub(super) fn relative_velocity<S: Moving>(approach: &ApproachOf<S>, velocities: &[S::Velocity]) -> S::Vector {
    let of = |side: usize| {
        let (along, turning) = split::<S>(&velocities[approach.id.bodies[side]]);
        let mut velocity = S::Vector::default();
        velocity.as_mut().copy_from_slice(&along[..axes::<S>()]);
        let levers = approach.levers[side].as_ref();
        turning.iter().zip(levers).fold(velocity, |sum, (turning, lever)| plus_times(sum, *turning, lever))
    };
    plus_times(of(1), -1.0, &of(0))
}

/// The same in the plane along the normal and along the tangent (the normal turned a quarter counter-clockwise).
pub(super) fn normal_and_tangential(approach: &Approach, velocities: &[Velocity]) -> [f64; 2] {
    in_frame(approach, relative_velocity::<Polygon>(approach, velocities))
}

/// A vector of the plane along the normal and along the tangent.
pub(super) fn in_frame(approach: &Approach, [x, y]: [f64; 2]) -> [f64; 2] {
    let [nx, ny] = approach.normal;
    [x * nx + y * ny, y * nx - x * ny]
}
