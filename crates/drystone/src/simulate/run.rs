//! Many steps, recorded.

use super::{
    error::StepFailure,
    moving::Moving,
    record::StepRecord,
    world::{ContactImpulse, World},
};
use crate::{geometry::Polygon, interrupt::Interrupt};

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// All steps were made.
    Finished,
    /// Somebody stopped it; the steps before are there.
    Interrupted,
    /// A step could not be made; those before it are there.
    Failed(StepFailure),
}

impl Ending {
    /// In one word, as users of other languages see it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Interrupted => "interrupted",
            Self::Failed(failure) => failure.name(),
        }
    }
}

/// What a run recorded: what each step did, and where the bodies were at its beginning, after every so many steps and at its end.
#[derive(Debug, Clone)]
pub struct Run<S: Moving = Polygon> {
    /// How it ended.
    pub ending: Ending,
    /// Moments at which bodies are recorded: the beginning, and one after each of some steps.
    pub moments: usize,
    /// The numbers of the places of all bodies, moment by moment in one row; see [`World::poses`].
    pub poses: Vec<f64>,
    /// Those of the velocities; see [`World::velocities`].
    pub velocities: Vec<f64>,
    /// What each step did.
    pub records: Vec<StepRecord>,
    /// The contacts that bore in the step before each moment but the first, if they were asked for.
    pub contacts: Vec<Vec<ContactImpulse<S::Vector>>>,
}

/// What is recorded of a run beside what its steps did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kept {
    /// The bodies after every so many steps, and after the last.
    pub every: usize,
    /// The impulses at the contacts, of the same steps.
    pub forces: bool,
}

impl Kept {
    /// Of every step.
    pub fn all(forces: bool) -> Self {
        Self { every: 1, forces }
    }
}

/// What is shown of the last step's impulses: the same of the next one, if this has the same.
struct Known<S: Moving> {
    own: Vec<ContactImpulse<S::Vector>>,
    still: Vec<bool>,
    bearing: Vec<ContactImpulse<S::Vector>>,
}

/// Makes steps and records them. `go_on` is asked before every step, with the number of steps made; a step that is stopped on the
/// way ends the run too.
pub fn run<S: Moving>(world: &mut World<S>, steps: usize, kept: Kept, mut go_on: impl FnMut(usize) -> bool) -> Run<S> {
    let mut run = Run {
        ending: Ending::Finished,
        moments: 0,
        poses: Vec::new(),
        velocities: Vec::new(),
        records: Vec::new(),
        contacts: Vec::new(),
    };
    let every = kept.every.max(1);
    let mut known: Option<Known<S>> = None;
    run.take_down(world, known.as_ref());
    for made in 0..steps {
        if !go_on(made) {
            run.ending = Ending::Interrupted;
            break;
        }
        let Some(made) = Interrupt::default().run(|| world.step()) else {
            run.ending = Ending::Interrupted;
            break;
        };
        match made {
            Ok(record) => run.records.push(record),
            Err(failure) => {
                run.ending = Ending::Failed(failure);
                break;
            }
        }
        // Of every step: the world may know them no longer if it is stopped within the next.
        if kept.forces {
            let (own, still) = (world.contact_impulses(), world.motionless().to_vec());
            let again = known.take().filter(|known| known.own == own && known.still == still);
            known = Some(again.unwrap_or_else(|| Known { bearing: world.bearing_impulses(), own, still }));
        }
        if run.records.len().is_multiple_of(every) {
            run.take_down(world, known.as_ref());
        }
    }
    if !run.records.len().is_multiple_of(every) {
        run.take_down(world, known.as_ref());
    }
    run
}

impl<S: Moving> Run<S> {
    /// Steps that are further from Coulomb's law than is asked for ([`StepRecord::exact`]).
    pub fn not_exact(&self) -> usize {
        self.records.iter().filter(|record| !record.exact).count()
    }

    fn take_down(&mut self, world: &World<S>, known: Option<&Known<S>>) {
        self.moments += 1;
        world.poses().for_each(|place| self.poses.extend_from_slice(place.as_ref()));
        world.velocities().iter().for_each(|velocity| self.velocities.extend_from_slice(velocity.as_ref()));
        self.contacts.extend(known.map(|known| known.bearing.clone()));
    }
}
