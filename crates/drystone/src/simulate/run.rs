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

/// What a run recorded. Places and velocities have one entry more than there are steps: the first is the beginning.
#[derive(Debug, Clone)]
pub struct Run<S: Moving = Polygon> {
    /// How it ended.
    pub ending: Ending,
    /// Place of every body; see [`World::poses`].
    pub poses: Vec<Vec<S::Place>>,
    /// Velocity of every body; see [`World::velocities`].
    pub velocities: Vec<Vec<S::Velocity>>,
    /// What each step did.
    pub records: Vec<StepRecord>,
    /// The contacts that bore in each step, if they were asked for.
    pub contacts: Vec<Vec<ContactImpulse<S::Vector>>>,
}

/// What is shown of the last step's impulses: the same of the next one, if this has the same.
struct Known<S: Moving> {
    own: Vec<ContactImpulse<S::Vector>>,
    still: Vec<bool>,
    bearing: Vec<ContactImpulse<S::Vector>>,
}

/// Makes steps and records them, with the impulses at the contacts if `forces` says so. `go_on` is asked before every
/// step, with the number of steps made; a step that is stopped on the way ends the run too.
pub fn run<S: Moving>(
    world: &mut World<S>,
    steps: usize,
    forces: bool,
    mut go_on: impl FnMut(usize) -> bool,
) -> Run<S> {
    let mut run = Run {
        ending: Ending::Finished,
        poses: Vec::new(),
        velocities: Vec::new(),
        records: Vec::new(),
        contacts: Vec::new(),
    };
    run.take_down(world);
    let mut known: Option<Known<S>> = None;
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
        run.take_down(world);
        if forces {
            let (own, still) = (world.contact_impulses(), world.motionless().to_vec());
            let again = known.take().filter(|known| known.own == own && known.still == still);
            let now = again.unwrap_or_else(|| Known { bearing: world.bearing_impulses(), own, still });
            run.contacts.push(now.bearing.clone());
            known = Some(now);
        }
    }
    run
}

impl<S: Moving> Run<S> {
    /// Steps that are further from Coulomb's law than is asked for ([`StepRecord::exact`]).
    pub fn not_exact(&self) -> usize {
        self.records.iter().filter(|record| !record.exact).count()
    }

    fn take_down(&mut self, world: &World<S>) {
        self.poses.push(world.poses().collect());
        self.velocities.push(world.velocities());
    }
}
