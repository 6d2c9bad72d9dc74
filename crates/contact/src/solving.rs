//! From the caller's problem to its own unknowns, island by island, and back.

use crate::{
    best::Goal,
    error::ContactError,
    islands::islands,
    method,
    problem::Bodies,
    settings::Settings,
    solution::{Counts, Solution, Status},
    system::{State, System},
};

impl Bodies {
    /// Solves it. `start`: impulses to begin from, contact after contact, such as those of the step before.
    ///
    /// # Errors
    /// [`ContactError`] for bad input. A problem without a solution, or one that was not found, is a [`Status`].
    pub fn solve(&self, start: Option<&[f64]>, settings: &Settings) -> Result<Solution, ContactError> {
        self.check()?;
        if self.size == 3 { self.run::<3, 2>(start, settings) } else { self.run::<6, 3>(start, settings) }
    }

    fn run<const B: usize, const D: usize>(
        &self,
        start: Option<&[f64]>,
        settings: &Settings,
    ) -> Result<Solution, ContactError> {
        let root: Vec<f64> = self.inverse_mass.iter().map(|x| x.sqrt()).collect();
        let y: Vec<f64> = self.free.iter().zip(&root).map(|(v, root)| v / root).collect();
        let mut system = System::<B, D>::new(y.chunks_exact(B).map(|y| std::array::from_fn(|k| y[k])).collect());
        for contact in &self.contacts {
            let sides = (0..2).filter_map(|side| {
                let body = contact.bodies[side]?;
                let rows =
                    std::array::from_fn(|d| std::array::from_fn(|k| contact.jacobian[side][d][k] * root[B * body + k]));
                Some((body, rows))
            });
            system.push(contact.friction, contact.offset, sides);
        }
        let solved = solve(&system, start, settings)?;
        // What no contact moves keeps its bits.
        let gained = solved.y.iter().flatten().zip(system.free.iter().flatten()).map(|(y, free)| y - free);
        let velocities = self.free.iter().zip(gained.zip(&root)).map(|(v, (gained, root))| v + gained * root);
        let velocities = velocities.collect();
        Ok(answer(solved, velocities))
    }
}

/// With velocities in the caller's unknowns.
pub(crate) fn answer<const B: usize>(solved: Solved<B>, velocities: Vec<f64>) -> Solution {
    let Solved { impulses, error, tolerance, counts, .. } = solved;
    // What overflows proves nothing.
    let solved = error <= tolerance && error.is_finite();
    let status = if solved { Status::Solved } else { Status::Limit };
    Solution { impulses, velocities, error, tolerance, status, counts }
}

/// What is found in the problem's own unknowns.
pub(crate) struct Solved<const B: usize> {
    pub y: Vec<[f64; B]>,
    pub impulses: Vec<f64>,
    pub error: f64,
    pub tolerance: f64,
    pub counts: Counts,
}

/// Solves island by island.
pub(crate) fn solve<const B: usize, const D: usize>(
    system: &System<B, D>,
    start: Option<&[f64]>,
    settings: &Settings,
) -> Result<Solved<B>, ContactError> {
    let mut state = system.state();
    if let Some(start) = start {
        if start.len() != D * system.len() {
            return Err(ContactError::Start { found: start.len(), expected: D * system.len() });
        }
        crate::problem::all_finite("start", start)?;
        for (k, p) in start.chunks_exact(D).enumerate() {
            state.p[k] = system.turned(k, &std::array::from_fn(|i| p[i]), false);
        }
    }
    let fastest = (0..system.len()).map(|k| speed(system, k)).fold(0.0, f64::max);
    let tolerance = settings.tolerance.unwrap_or(settings.relative_tolerance * fastest.max(settings.scale));
    // No tolerance is a share of a speed that overflows.
    let (mut counts, mut worst) = (Counts::default(), if fastest.is_finite() { 0.0_f64 } else { f64::INFINITY });
    let mut place = vec![0; system.free.len()];
    for (contacts, chunks) in islands(system) {
        chunks.iter().enumerate().for_each(|(at, &chunk)| place[chunk] = at as u32);
        let part = system.part(&contacts, &chunks, &place);
        let mut own = State {
            y: part.free.clone(),
            p: contacts.iter().map(|&k| state.p[k]).collect(),
            alpha: vec![0.0; contacts.len()],
        };
        let error = method::solve(&part, &mut own, Goal::new(tolerance, settings.scale), settings, &mut counts);
        worst = if error <= worst { worst } else { error };
        counts.islands += 1;
        contacts.iter().zip(&own.p).for_each(|(&k, p)| state.p[k] = *p);
        chunks.iter().zip(&own.y).for_each(|(&chunk, y)| state.y[chunk] = *y);
    }
    let impulses = (0..system.len()).flat_map(|k| system.turned(k, &state.p[k], true)).collect();
    Ok(Solved { y: state.y, impulses, error: worst, tolerance, counts })
}

/// Relative speed at a contact without impulses, without its offset.
fn speed<const B: usize, const D: usize>(system: &System<B, D>, k: usize) -> f64 {
    let mut u = system.relative(k, &system.free);
    u[0] -= system.offsets[k];
    u.iter().map(|x| x * x).sum::<f64>().sqrt()
}
