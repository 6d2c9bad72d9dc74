//! One time step as a complementarity problem of impulses and velocities.
//!
//! With velocities `v`, applied wrenches `F` and impulses `p >= 0` along the generators `G` of all contacts, a step of
//! length h ends with the velocities
//!
//! ```text
//! v+ = v* + M^-1 G p,    v* = v + h M^-1 F,
//! w  = A p + q,    0 <= p  complementary to  w >= 0,    A = G' M^-1 G,
//! q  = G' v* + (c + mu s) / sqrt(1 + mu^2)        (a row for each edge of each friction cone)
//! ```
//!
//! `c` (an offset for each contact, m/s) lets a contact close just by the end of the step: `gap / h`. `s` is the sliding
//! speed that the edges are corrected for, see `solve/pivots.rs`. A cone has two edges in the plane; in space it is a pyramid
//! (`formulate/cones.rs`) and mu the coefficient at its edges. `v*` holds what turning does to a body in space, too.
//!
//! D. Stewart and J. Trinkle, "An implicit time-stepping scheme for rigid body dynamics with inelastic collisions and
//! Coulomb friction", 1996; M. Anitescu and F. Potra, "Formulating dynamic multi-rigid-body contact problems with friction
//! as solvable linear complementarity problems", 1997; the convex form without `s`: M. Anitescu, 2006.

use crate::{
    contact::candidates::{CandidateContact, CandidateOf},
    formulate::Cones,
    geometry::{Numbers, Polygon, plus_times, product},
    simulate::kinematics::{Kinematics, axes, components, is_zero, split, split_mut},
};
use drystone_lcp::{
    LcpError, Origin, Problem,
    cone::Columns,
    interior::{Cone, Gauss, Point},
};
use std::ops::Range;

/// Velocity of a body in the plane: m/s, m/s, rad/s.
pub type Velocity = [f64; 3];

/// The contacts of one step with their generators.
#[derive(Debug, Clone)]
pub struct ContactProblem<S: Kinematics = Polygon> {
    candidates: Vec<CandidateOf<S>>,
    /// First row of every contact, and the number of rows.
    starts: Vec<usize>,
    /// Unit direction of every row, and its contact.
    directions: Vec<S::Vector>,
    candidate_of: Vec<usize>,
    /// Coefficient at the cone's edges, and `sqrt(1 + mu^2)`, of every contact.
    edges: Vec<[f64; 2]>,
}

impl<S: Kinematics> ContactProblem<S> {
    pub fn new(candidates: Vec<CandidateOf<S>>, cones: Cones, gravity: S::Vector) -> Self {
        Self::after(None, candidates, cones, gravity)
    }

    /// The same, with the cones' edges of contacts that were there before.
    pub fn after(before: Option<&Self>, candidates: Vec<CandidateOf<S>>, cones: Cones, gravity: S::Vector) -> Self {
        let mut starts = Vec::with_capacity(candidates.len() + 1);
        let mut directions = Vec::with_capacity(before.map_or(2 * candidates.len(), Self::len));
        let mut known = before.iter().flat_map(|before| before.candidates.iter().enumerate()).peekable();
        starts.push(0);
        for candidate in &candidates {
            while known.next_if(|(_, old)| old.id < candidate.id).is_some() {}
            match before.zip(known.next_if(|(_, old)| old.same_geometry(candidate))) {
                Some((before, (old, _))) => directions.extend_from_slice(&before.directions[before.rows(old)]),
                None => directions.extend(S::edges(cones, candidate.normal, candidate.friction, gravity)),
            }
            starts.push(directions.len());
        }
        let edge = |candidate: &CandidateOf<S>| {
            let friction = S::edge_friction(cones, candidate.friction);
            [friction, friction.hypot(1.0)]
        };
        let edges = candidates.iter().map(edge).collect();
        let candidate_of =
            (0..candidates.len()).flat_map(|k| std::iter::repeat_n(k, starts[k + 1] - starts[k])).collect();
        Self { candidates, starts, directions, candidate_of, edges }
    }

    pub fn candidates(&self) -> &[CandidateOf<S>] {
        &self.candidates
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// Rows of one contact.
    pub fn rows(&self, candidate: usize) -> Range<usize> {
        self.starts[candidate]..self.starts[candidate + 1]
    }

    /// Coefficient at the edges of a contact's cone.
    pub fn friction(&self, candidate: usize) -> f64 {
        self.edges[candidate][0]
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
            let candidate = &self.candidates[self.candidate_of[row]];
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let body = candidate.id.bodies[side];
                if !is_zero(&inverse_mass[body]) {
                    indices.extend(size * body..size * (body + 1));
                    data.extend(wrench::<S>(&candidate.levers[side], &self.directions[row], sign).as_ref());
                }
            }
            indptr.push(indices.len());
        }
        Columns::new(size * inverse_mass.len(), &indptr, &indices, &data)
    }

    /// Gauss's principle for some contacts, with velocities in place of accelerations: `loads` is `-M v*` of every body,
    /// `bodies` are those that move.
    pub fn gauss(
        &self,
        candidates: &[usize],
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
        problem.points = candidates.iter().map(|&candidate| self.point(candidate, &place)).collect();
        problem
    }

    /// What each row of w has beside `G' v`: offsets `c` and sliding speeds `s`, one a contact, at the cone's edges.
    pub fn lifts(&self, c: &[f64], s: &[f64]) -> Vec<f64> {
        let lift = |k: usize| {
            let [friction, length] = self.edges[k];
            std::iter::repeat_n((c[k] + friction * s[k]) / length, self.rows(k).len())
        };
        (0..self.candidates.len()).flat_map(lift).collect()
    }

    /// A contact as a contact point of Gauss's principle, with the edges of its cone; `place` numbers the bodies that move.
    fn point(&self, candidate: usize, place: &[Option<usize>]) -> Point {
        let axes = axes::<S>();
        let at = &self.candidates[candidate];
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
            cone: Cone::Edges(self.directions[self.rows(candidate)].iter().map(in_space).collect()),
        }
    }

    /// `A_ii`: the speed along a row's direction that a unit of its impulse gives, 1/kg.
    pub fn yielding(&self, row: usize, inverse_mass: &[S::Velocity]) -> f64 {
        let candidate = &self.candidates[self.candidate_of[row]];
        let of = |side: usize| {
            let wrench = wrench::<S>(&candidate.levers[side], &self.directions[row], 1.0);
            let inverse = inverse_mass[candidate.id.bodies[side]].as_ref();
            inverse.iter().zip(wrench.as_ref()).map(|(inverse, w)| inverse * w * w).sum::<f64>()
        };
        of(0) + of(1)
    }

    /// `q` for velocities without impulses `free`, offsets `c` and sliding speeds `s`, one a contact.
    pub fn q(&self, free: &[S::Velocity], c: &[f64], s: &[f64]) -> Vec<f64> {
        let mut q = Vec::with_capacity(self.len());
        for (k, candidate) in self.candidates.iter().enumerate() {
            let u = relative_velocity::<S>(candidate, free);
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
        for (k, candidate) in self.candidates.iter().enumerate() {
            let impulse = self.impulse(k, &p);
            if !is_zero(&impulse) {
                push::<S>(candidate, &impulse, inverse_mass, &mut velocities);
            }
        }
        velocities
    }

    /// Impulse on the second body of a contact in world axes, N s.
    pub fn impulse(&self, candidate: usize, p: impl Fn(usize) -> f64) -> S::Vector {
        let add = |sum, row: usize| plus_times(sum, p(row), &self.directions[row]);
        self.rows(candidate).fold(S::Vector::default(), add)
    }

    /// Speeds of the second body of a contact relative to the first: along the normal, and of sliding, m/s.
    pub fn opening_and_sliding(&self, candidate: usize, velocities: &[S::Velocity]) -> [f64; 2] {
        let CandidateContact { normal, .. } = &self.candidates[candidate];
        let u = relative_velocity::<S>(&self.candidates[candidate], velocities);
        let edges = &self.directions[self.rows(candidate)];
        [product(normal, &u), S::sliding_speed(edges, normal, self.friction(candidate), &u)]
    }

    /// Where each row comes from in the problem before it. Both lists of contacts are in the order of identities.
    pub fn origins(&self, before: &Self) -> Vec<Origin> {
        let mut origins = Vec::with_capacity(self.len());
        for (k, old) in self.matches(before) {
            match old {
                Some(old) if before.candidates[old].same_geometry(&self.candidates[k]) => {
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

    /// Each contact with its number in the list before.
    pub fn matches<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = (usize, Option<usize>)> + 'a {
        let mut old = 0;
        self.candidates.iter().enumerate().map(move |(k, candidate)| {
            while before.candidates.get(old).is_some_and(|known| known.id < candidate.id) {
                old += 1;
            }
            (k, before.candidates.get(old).filter(|known| known.id == candidate.id).map(|_| old))
        })
    }
}

/// One number after the other.
fn flat<V: Numbers>(values: &[V]) -> Vec<f64> {
    values.iter().flat_map(|value| value.as_ref()).copied().collect()
}

/// Force, and moment about each turning, of `sign` times a force that acts where the levers are of.
pub fn wrench<S: Kinematics>(levers: &S::Levers, force: &S::Vector, sign: f64) -> S::Velocity {
    let mut wrench = S::Velocity::default();
    let (along, moment) = split_mut::<S>(&mut wrench);
    along.iter_mut().zip(force.as_ref()).for_each(|(entry, f)| *entry = sign * f);
    moment.iter_mut().zip(levers.as_ref()).for_each(|(entry, lever)| *entry = sign * product(lever, force));
    wrench
}

/// Gives the second body of a contact an impulse, and the first its opposite.
pub fn push<S: Kinematics>(
    candidate: &CandidateOf<S>,
    impulse: &S::Vector,
    inverse_mass: &[S::Velocity],
    velocities: &mut [S::Velocity],
) {
    for (side, sign) in [(0, -1.0), (1, 1.0)] {
        let body = candidate.id.bodies[side];
        let change = wrench::<S>(&candidate.levers[side], impulse, sign);
        let per_mass = inverse_mass[body].as_ref().iter().zip(change.as_ref());
        velocities[body].as_mut().iter_mut().zip(per_mass).for_each(|(v, (mass, p))| *v += mass * p);
    }
}

/// Velocity of the second body relative to the first at the point, m/s, in world axes.
pub fn relative_velocity<S: Kinematics>(candidate: &CandidateOf<S>, velocities: &[S::Velocity]) -> S::Vector {
    let of = |side: usize| {
        let (along, turning) = split::<S>(&velocities[candidate.id.bodies[side]]);
        let mut velocity = S::Vector::default();
        velocity.as_mut().copy_from_slice(&along[..axes::<S>()]);
        let levers = candidate.levers[side].as_ref();
        turning.iter().zip(levers).fold(velocity, |sum, (turning, lever)| plus_times(sum, *turning, lever))
    };
    plus_times(of(1), -1.0, &of(0))
}

/// The same in the plane along the normal and along the tangent (the normal turned a quarter counter-clockwise).
pub fn normal_and_tangential(candidate: &CandidateContact, velocities: &[Velocity]) -> [f64; 2] {
    in_frame(candidate, relative_velocity::<Polygon>(candidate, velocities))
}

/// A vector of the plane along the normal and along the tangent.
pub fn in_frame(candidate: &CandidateContact, [x, y]: [f64; 2]) -> [f64; 2] {
    let [nx, ny] = candidate.normal;
    [x * nx + y * ny, y * nx - x * ny]
}
