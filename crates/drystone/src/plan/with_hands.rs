//! The search with blocks held, after one that found that there is no order without.
//!
//! A first search keeps few holds of every sub-assembly. Where it finds no order, or makes many tests, a second one keeps them
//! all: only that one can say that there is none.

use super::candidates::Upward;
use super::clear_path::Paths;
use super::dead_end::{dead_end, put_up, until_stopped};
use super::found::Found;
use super::grips::fewest_grips;
use super::holding::{FEW, Holding};
use super::in_turn::{memory_for, take_turn};
use super::outcome::Outcome;
use super::search::{Clock, Search};
use super::stability::PlanError;
use super::touching::Touching;
use crate::{formulate::Assembly, interrupt::Interrupt};
use std::time::{Duration, Instant};

/// Tests of the first search, at least and for each block. One that steps back little makes a few for each block.
const FIRST: usize = 1000;
const FOR_EACH_BLOCK: usize = 20;

/// Time for putting up once more what was found when a search is stopped: less than what anybody waits for after Ctrl-C.
const LATE: Duration = Duration::from_millis(200);

/// Searches on from what was found without a hold, and tells what it finds there.
///
/// # Errors
/// [`PlanError`] for a test without an answer.
pub(super) fn search_with_hands(
    assembly: &Assembly,
    touching: &Touching,
    paths: Option<&Paths<'_>>,
    hands: usize,
    clock: &mut Clock<'_>,
    found: &mut Found,
) -> Result<(), PlanError> {
    let turn = FIRST.max(FOR_EACH_BLOCK * assembly.blocks());
    let few = Held { assembly, touching, paths, hands, most: FEW };
    if !few.search(turn, clock, found)? {
        Held { most: usize::MAX, ..few }.search(usize::MAX, clock, found)?;
    }
    Ok(())
}

/// A search with so many hands that keeps at most so many holds of a sub-assembly.
struct Held<'a> {
    assembly: &'a Assembly,
    touching: &'a Touching,
    paths: Option<&'a Paths<'a>>,
    hands: usize,
    most: usize,
}

impl<'a> Held<'a> {
    fn test(&self) -> Holding<'a> {
        Holding::new(self.assembly, self.hands, self.most)
    }

    /// Searches for so many tests. False if that gave no answer, so that a search which keeps more holds has to.
    fn search(&self, turn: usize, clock: &mut Clock<'_>, found: &mut Found) -> Result<bool, PlanError> {
        let Ok(mut test) = clock.run(|| Ok(self.test())) else {
            found.outcome = clock.stopped();
            return Ok(true);
        };
        let mut memory = memory_for(self.touching, clock.limits, &test);
        let mut upward = Upward::new(self.touching);
        let mut search = Search::new(self.touching, self.paths, memory.as_mut(), &mut upward);
        search.records = std::mem::take(&mut found.records);
        let ended = take_turn(&mut search, &mut test, clock, turn);
        let Search { best, records, .. } = search;
        found.records = records;
        if best.len() > found.reached.len() {
            found.reached = best;
        }
        found.shortcuts += memory.shortcuts();
        found.outcome = match ended {
            None => return Ok(false),
            Some(Err(PlanError::Interrupted)) => clock.stopped(),
            Some(Ok(Outcome::NoOrder)) if test.left_out() > 0 => return Ok(false),
            Some(Ok(Outcome::NoOrder)) if test.undecided() > 0 => Outcome::Undecided,
            Some(ended) => ended?,
        };
        self.tell(test, clock, found)?;
        Ok(true)
    }

    /// What is held on the way, and where there is no order what falls next.
    fn tell(&self, mut test: Holding<'a>, clock: &Clock<'_>, found: &mut Found) -> Result<(), PlanError> {
        found.falls_next = match found.outcome {
            Outcome::Found => Vec::new(),
            Outcome::NoOrder | Outcome::Undecided => {
                test = self.test();
                until_stopped(clock.run(|| dead_end(&mut test, self.touching, self.paths, &mut found.reached)))?
            }
            outcome => {
                let mut again = None;
                let put_up = || put_up(again.insert(self.test()), self.touching, &found.reached);
                match outcome {
                    Outcome::TestLimit => clock.run(put_up).map(drop),
                    // Who stopped the search would stop this too.
                    _ => Interrupt::at(Instant::now() + LATE).instead(put_up).transpose().map(drop),
                }
                .or_else(|error| until_stopped(Err(error)))?;
                found.reached.truncate(again.as_ref().map_or(0, |test| test.way().count()));
                match again {
                    Some(put_up) => test = put_up,
                    None => return Ok(()),
                }
                Vec::new()
            }
        };
        found.held = fewest_grips(test.way(), self.hands);
        // The complete assembly stands with nothing held, and was not put up.
        found.held.resize(found.reached.len(), Vec::new());
        Ok(())
    }
}
