//! The forces of an island in which something slides: a complementarity problem whose matrix is not symmetric.
//!
//! What a variable pushes and what its row measures differ where a contact slides, so `M = W' M^-1 G` with W other than G.
//! Per contact, in impulses `p = h f` and velocities at the end of the step `u = u' + h a` (h times Baraff's conditions):
//!
//! ```text
//! slides at u_t' (1 row):   p_n >= 0  complementary to  u_n + c >= 0,    the force is p_n (n - mu sign(u_t') t)
//! rests (4 rows):           p_n >= 0  complementary to  u_n + c >= 0
//!                           p_1 >= 0  complementary to  u_t + s >= 0,    the force is p_n n + (p_1 - p_2) t
//!                           p_2 >= 0  complementary to  s - u_t >= 0
//!                           s   >= 0  complementary to  mu p_n - p_1 - p_2 >= 0
//! no friction (1 row):      as sliding, with mu = 0
//! ```
//!
//! The four rows say that s = |u_t| and, where it is not zero, that friction is on the edge of the cone that opposes it: Baraff's
//! `|f_t| <= mu f_n`, `a_t f_t <= 0`, `a_t (mu f_n - |f_t|) = 0`. Principal pivoting needs symmetry, so Lemke's method solves it. Where all
//! contacts rest it always finds a solution (Pang and Trinkle); a sliding contact with
//! `n' A (n - mu sign(u_t') t) <= 0` may leave none: Painlevé's paradox.
//!
//! Friction slows a sliding contact to zero and not beyond. One that would reverse within the step is taken for a resting
//! one, and the island solved again; each does so once at most. So may what slides slowly, if there are no forces else.
//!
//! D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies", 1994; the rows of a resting contact:
//! J.-S. Pang and J. Trinkle, "Complementarity formulations and existence of solutions of dynamic multi-rigid-body contact
//! problems with Coulomb friction", 1996.

use crate::{
    contact::{ContactId, candidates::CandidateContact},
    geometry::Polygon,
    simulate::{
        formulate::contact_problem::{ContactProblem, Velocity, normal_and_tangential, push, wrench},
        record::Inconsistent,
        solve::{ActiveRows, FRICTION_ACCEPTED},
    },
};
use drystone_lcp::{Counts, LcpError, Lemke, Method, Problem, Settings, Solution, Start, Status};
use std::mem;

/// A contact slides if it is faster than this, m/s (above 1 m/s, than this share of the fastest body). Ten times what may be left of
/// the speed of one that rests. The choice does not show: what is taken for sliding and would reverse, rests.
pub const SLIDES: f64 = 10.0 * FRICTION_ACCEPTED;

/// What a contact does at the beginning of a step, after collisions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mode {
    /// It does not slide; friction is what it takes to keep it so, within the cone.
    Rests,
    /// It slides along the tangent in this direction, +1 or -1; friction opposes it.
    Slides(f64),
}

/// What a step gives to an island.
pub struct Island<'a> {
    pub contacts: &'a ContactProblem,
    /// Its contacts, by number.
    pub members: Vec<usize>,
    /// What each of them does.
    pub modes: Vec<Mode>,
    /// Velocities at the beginning of the step, and without contacts at its end.
    pub started: &'a [Velocity],
    pub free: &'a [Velocity],
    pub offsets: &'a [f64],
    pub inverse_mass: &'a [[f64; 3]],
    /// What bore in the step before, to start from; nothing without reuse.
    pub previous: &'a ActiveRows,
    /// What slides more slowly may be stopped within the step by forces, m/s.
    pub slow: f64,
}

/// An island that was solved.
pub struct Found {
    pub members: Vec<usize>,
    pub motion: IslandMotion,
    pub residual: f64,
    pub work: Work,
    /// Which rows of each member have forces.
    pub active: Vec<(ContactId, Vec<bool>)>,
}

/// How an island moves.
pub struct IslandMotion {
    /// Along the normal and the tangent of every member, N s.
    pub impulses: Vec<[f64; 2]>,
    /// Of all bodies; those of other islands are free here.
    pub velocities: Vec<Velocity>,
}

/// What it took.
#[derive(Debug, Default)]
pub struct Work {
    pub solves: usize,
    pub counts: Counts,
}

/// One solve for given modes, with the first row of every member.
struct Attempt {
    starts: Vec<usize>,
    problem: Problem,
    solution: Solution,
}

/// One row: what is measured and what the variable pushes, each a wrench on the two bodies of a member.
struct Row {
    measured: Pair,
    pushed: Pair,
    constant: f64,
}

/// Two bodies, each with a wrench.
type Pair = [(usize, [f64; 3]); 2];

/// Rows of a resting contact with friction, and their places in it.
const RESTING_ROWS: usize = 4;
const ALONG: usize = 1;
const AGAINST: usize = 2;
const SPEED: usize = 3;

/// A solve may take as many pivots a row. One or two are the rule; a path of more is lost in degenerate corners, and another
/// attempt gets further.
const PIVOTS_PER_ROW: usize = 10;

impl Island<'_> {
    /// Solves for the velocities at the end of the step. None if it came down to resting contacts alone and was not solved
    /// here: then another method may.
    ///
    /// # Errors
    /// [`Inconsistent`] where no forces were found.
    pub fn solve(mut self) -> Result<Option<Found>, Inconsistent> {
        let mut work = Work::default();
        loop {
            let attempt = self.attempt(&mut work)?;
            if attempt.solution.status == Status::Solved {
                let motion = self.motion(&attempt);
                if self.stop_reversed(&motion) {
                    continue;
                }
                return Ok(Some(self.found(&attempt, motion, work)));
            }
            if self.stop_slow() {
                continue;
            }
            if self.modes.iter().all(|mode| *mode == Mode::Rests) {
                return Ok(None);
            }
            let refused = self.inconsistent(&attempt);
            return self.solve_as_resting(refused, work);
        }
    }

    /// The last resort: with resting contacts alone Lemke's method finds a solution. Where it has what slid slide on, that
    /// obeys the law of sliding too; where it stops it at once, these are no forces.
    fn solve_as_resting(mut self, refused: Inconsistent, mut work: Work) -> Result<Option<Found>, Inconsistent> {
        let slid = mem::replace(&mut self.modes, vec![Mode::Rests; self.members.len()]);
        let attempt = self.attempt(&mut work)?;
        let motion = self.motion(&attempt);
        let slides_on = |(member, mode): (usize, &Mode)| match mode {
            Mode::Slides(sign) if motion.impulses[member][0] > 0.0 => {
                sign * self.sliding(member, &motion.velocities) > SLIDES
            }
            _ => true,
        };
        if attempt.solution.status == Status::Solved && slid.iter().enumerate().all(slides_on) {
            return Ok(Some(self.found(&attempt, motion, work)));
        }
        Err(refused)
    }

    /// # Errors
    /// [`Inconsistent`] if the matrix is not finite.
    fn attempt(&self, work: &mut Work) -> Result<Attempt, Inconsistent> {
        let (rows, starts) = self.rows();
        let solved = self.problem(&rows, &starts).and_then(|problem| {
            let start = self.start(&starts).and_then(|active| Start::from_active(&problem, &active));
            let limit = PIVOTS_PER_ROW * (problem.len() + 10);
            let settings = Settings { pivot_limit: Some(limit), ..Settings::default() };
            let solution = match Lemke.solve(&problem, start.as_ref(), &settings) {
                // Its positive rows depend on one another.
                Err(LcpError::Start(_)) => Lemke.solve(&problem, None, &settings)?,
                solution => solution?,
            };
            Ok(Attempt { starts, problem, solution })
        });
        let contact = self.candidate(0).id;
        let attempt = solved.map_err(|_| Inconsistent { contact, status: Status::NumericalTrouble.name() })?;
        work.counts = work.counts + attempt.solution.counts;
        work.solves += 1;
        Ok(attempt)
    }

    /// The rows that had forces in the step before, where the contacts that have rows of the same kind are known.
    fn start(&self, starts: &[usize]) -> Option<Vec<usize>> {
        let known = |member: usize| {
            let first = starts[member];
            let kind = |rows: &&[bool]| rows.len() == starts[member + 1] - first;
            let rows = self.previous.of(self.candidate(member).id).filter(kind).unwrap_or_default();
            rows.iter().enumerate().filter(|(_, bears)| **bears).map(move |(k, _)| first + k)
        };
        Some((0..self.members.len()).flat_map(known).collect::<Vec<_>>()).filter(|rows| !rows.is_empty())
    }

    fn motion(&self, attempt: &Attempt) -> IslandMotion {
        let impulses = self.impulses(&attempt.starts, &attempt.solution.z);
        IslandMotion { velocities: self.velocities(&impulses), impulses }
    }

    fn found(self, attempt: &Attempt, motion: IslandMotion, work: Work) -> Found {
        let rows = |member: usize| attempt.starts[member]..attempt.starts[member + 1];
        let bears = |member: usize| rows(member).map(|row| attempt.solution.z[row] > 0.0).collect();
        let active = (0..self.members.len()).map(|member| (self.candidate(member).id, bears(member))).collect();
        Found { members: self.members, motion, residual: attempt.solution.residual, work, active }
    }

    /// Sliding speed of a member, with its sign, m/s.
    fn sliding(&self, member: usize, velocities: &[Velocity]) -> f64 {
        normal_and_tangential(self.candidate(member), velocities)[1]
    }

    fn candidate(&self, member: usize) -> &CandidateContact {
        &self.contacts.candidates()[self.members[member]]
    }

    /// The rows, and the first one of every member.
    fn rows(&self) -> (Vec<Row>, Vec<usize>) {
        let (mut rows, mut starts) = (Vec::new(), vec![0]);
        for member in 0..self.members.len() {
            let candidate = self.candidate(member);
            let [nx, ny] = candidate.normal;
            let [u_n, u_t] = normal_and_tangential(candidate, self.free);
            let wrenches = |force: [f64; 2]| {
                let on = |side: usize, sign: f64| {
                    (candidate.id.bodies[side], wrench::<Polygon>(&candidate.levers[side], &force, sign))
                };
                [on(0, -1.0), on(1, 1.0)]
            };
            let mut row = |measured: [f64; 2], pushed: [f64; 2], constant: f64| {
                rows.push(Row { measured: wrenches(measured), pushed: wrenches(pushed), constant });
            };
            let (normal, tangent, against, nothing) = ([nx, ny], [-ny, nx], [ny, -nx], [0.0; 2]);
            let closing = u_n + self.offsets[self.members[member]];
            match self.modes[member] {
                Mode::Slides(sign) => {
                    let drag = candidate.friction * sign;
                    row(normal, [nx + drag * ny, ny - drag * nx], closing);
                }
                Mode::Rests => {
                    row(normal, normal, closing);
                    if candidate.friction > 0.0 {
                        row(tangent, tangent, u_t);
                        row(against, against, -u_t);
                        row(nothing, nothing, 0.0);
                    }
                }
            }
            starts.push(rows.len());
        }
        (rows, starts)
    }

    fn problem(&self, rows: &[Row], starts: &[usize]) -> Result<Problem, LcpError> {
        let n = rows.len();
        let mut m = vec![0.0; n * n];
        for (j, column) in rows.iter().enumerate() {
            for (i, row) in rows.iter().enumerate() {
                m[i * n + j] = self.between(&row.measured, &column.pushed);
            }
        }
        for (member, start) in starts.windows(2).enumerate() {
            let (first, count) = (start[0], start[1] - start[0]);
            if count == RESTING_ROWS {
                let (along, against, speed) = (first + ALONG, first + AGAINST, first + SPEED);
                for side in [along, against] {
                    m[side * n + speed] = 1.0;
                    m[speed * n + side] = -1.0;
                }
                m[speed * n + first] = self.candidate(member).friction;
            }
        }
        Problem::from_dense(&m, rows.iter().map(|row| row.constant).collect())
    }

    /// Speed measured by one wrench that a unit of the other gives.
    fn between(&self, measured: &Pair, pushed: &Pair) -> f64 {
        let mut speed = 0.0;
        for (body, along) in measured {
            for (_, by) in pushed.iter().filter(|(other, _)| other == body) {
                speed += (0..3).map(|axis| along[axis] * self.inverse_mass[*body][axis] * by[axis]).sum::<f64>();
            }
        }
        speed
    }

    /// Along the normal and the tangent.
    fn impulses(&self, starts: &[usize], z: &[f64]) -> Vec<[f64; 2]> {
        let of = |member: usize| {
            let first = starts[member];
            let tangential = match self.modes[member] {
                Mode::Slides(sign) => -sign * self.candidate(member).friction * z[first],
                Mode::Rests if starts[member + 1] - first == RESTING_ROWS => z[first + ALONG] - z[first + AGAINST],
                Mode::Rests => 0.0,
            };
            [z[first], tangential]
        };
        (0..self.members.len()).map(of).collect()
    }

    fn velocities(&self, impulses: &[[f64; 2]]) -> Vec<Velocity> {
        let mut velocities = self.free.to_vec();
        for (member, &[p_n, p_t]) in impulses.iter().enumerate() {
            let candidate = self.candidate(member);
            let [nx, ny] = candidate.normal;
            let impulse = [p_n * nx - p_t * ny, p_n * ny + p_t * nx];
            push::<Polygon>(candidate, &impulse, self.inverse_mass, &mut velocities);
        }
        velocities
    }

    /// Takes sliding contacts that bear and have come to slide the other way for resting ones. Whether there are any.
    fn stop_reversed(&mut self, motion: &IslandMotion) -> bool {
        let reversed = |&member: &usize| {
            let bears = motion.impulses[member][0] > 0.0 && self.candidate(member).friction > 0.0;
            matches!(self.modes[member], Mode::Slides(sign) if bears && sign * self.sliding(member, &motion.velocities) < 0.0)
        };
        let members: Vec<usize> = (0..self.members.len()).filter(reversed).collect();
        self.stop(&members)
    }

    /// Takes slowly sliding contacts for resting ones. Whether there are any.
    fn stop_slow(&mut self) -> bool {
        let slow =
            |&member: &usize| self.modes[member] != Mode::Rests && self.sliding(member, self.started).abs() < self.slow;
        let members: Vec<usize> = (0..self.members.len()).filter(slow).collect();
        self.stop(&members)
    }

    fn stop(&mut self, members: &[usize]) -> bool {
        members.iter().for_each(|&member| self.modes[member] = Mode::Rests);
        !members.is_empty()
    }

    /// The contact to blame: one that sinks in whatever the others do, which is a proof that there are no forces; else, of the
    /// sliding ones, that with the largest part in the ray on which the method ended.
    fn inconsistent(&self, Attempt { starts, problem, solution }: &Attempt) -> Inconsistent {
        let members = 0..self.members.len();
        if let Some(member) = members.clone().find(|&member| sinks(problem, starts[member])) {
            return Inconsistent { contact: self.candidate(member).id, status: Status::NoSolution.name() };
        }
        let blame = |member: usize| {
            let part = solution.ray.as_ref().map_or(0.0, |ray| ray[starts[member]]);
            (matches!(self.modes[member], Mode::Slides(_)) && part > 0.0, part)
        };
        let by_blame = |&a: &usize, &b: &usize| {
            let ((a_slides, a_part), (b_slides, b_part)) = (blame(a), blame(b));
            a_slides.cmp(&b_slides).then(a_part.total_cmp(&b_part))
        };
        let member = members.max_by(by_blame).unwrap_or(0);
        Inconsistent { contact: self.candidate(member).id, status: solution.status.name() }
    }
}

/// Whether `w` of a row is negative for every `z >= 0`.
fn sinks(problem: &Problem, row: usize) -> bool {
    problem.q()[row] < 0.0 && (0..problem.len()).all(|column| problem.m().get(row, column) <= 0.0)
}
