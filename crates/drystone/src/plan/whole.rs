//! The check of the complete assembly, before the search or beside it.

use super::in_turn::InTurn;
use super::outcome::{Limits, Outcome, Progress, Stage};
use super::search::Clock;
use super::stability::{PlanError, StabilityTest};
use crate::{
    check::{Verdict, check_blocks, check_blocks_while},
    formulate::{Assembly, BlockSet, FrictionCone},
    interrupt::Interrupt,
};
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{RecvTimeoutError, channel},
    },
    thread,
    time::{Duration, Instant},
};

/// Fewest blocks for which the check runs on a thread of its own: what takes less than a millisecond is not worth one.
const WORTH_A_THREAD: usize = 200;

/// Time between two looks at the clock while only the check is waited for.
const PERIOD: Duration = Duration::from_millis(10);

/// What check and search have found.
pub(super) struct Checked {
    /// None if it was not waited for.
    pub whole: Option<Verdict>,
    /// Of the check.
    pub time: Duration,
    pub searched: Result<Outcome, PlanError>,
}

/// Stops a thread, at the latest when nobody is there any more who could.
#[derive(Debug, Default)]
pub(super) struct Stop {
    flag: Arc<AtomicBool>,
}

impl Stop {
    /// For the thread.
    pub fn interrupt(&self) -> Interrupt {
        let flag = Arc::clone(&self.flag);
        Interrupt::new(move || flag.load(Ordering::Relaxed))
    }

    pub fn stop(&self) {
        self.flag.store(true, Ordering::Relaxed);
    }
}

impl Drop for Stop {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Whether the check runs beside the search.
pub(super) fn check_beside(limits: Limits, blocks: usize) -> bool {
    blocks >= WORTH_A_THREAD && limits.threads() > 1
}

/// The check, and if the whole stands the search.
pub(super) fn check_before_search(
    assembly: &Assembly,
    search: &mut InTurn<'_>,
    test: &mut dyn StabilityTest,
    clock: &mut Clock<'_>,
) -> Checked {
    let blocks = assembly.blocks();
    let (begin, mut stopped) = (Instant::now(), Outcome::WholeFalls);
    let interrupt = clock.interrupt.clone();
    let mut go_on = |placed| match clock.stops(Progress { stage: Stage::Whole, tests: 0, placed, blocks }) {
        None => true,
        Some(outcome) => {
            stopped = outcome;
            false
        }
    };
    let whole =
        interrupt.run(|| check_blocks_while(assembly, &BlockSet::full(blocks), FrictionCone::Pyramid, &mut go_on));
    let whole = whole.unwrap_or_else(|| {
        stopped = clock.stopped();
        None
    });
    let time = begin.elapsed();
    let searched = match &whole {
        Some(whole) if whole.stable => search.run(test, clock),
        _ => Ok(stopped),
    };
    Checked { whole, time, searched }
}

/// The check on a thread of its own, and at the same time the search as if the whole stood. It ends when the check
/// finds that it does not; the caller then forgets what it did, so that the plan is the same.
pub(super) fn check_beside_search(
    assembly: &Assembly,
    search: &mut InTurn<'_>,
    test: &mut dyn StabilityTest,
    clock: &mut Clock<'_>,
) -> Checked {
    let (blocks, stop, whole_falls) = (assembly.blocks(), Stop::default(), clock.whole_falls);
    let interrupt = stop.interrupt();
    let check = || {
        let begin = Instant::now();
        let whole = interrupt.run(|| check_blocks(assembly, &BlockSet::full(blocks)));
        whole_falls.store(whole.as_ref().is_some_and(|whole| !whole.stable), Ordering::Relaxed);
        (whole, begin.elapsed())
    };
    thread::scope(|scope| {
        let stop = stop; // whatever ends this scope stops the thread as well
        let (tell, told) = channel();
        scope.spawn(|| {
            let tell = tell;
            tell.send(check()).ok() // there is someone to tell until it is told
        });
        let mut searched = search.run(test, clock);
        let progress = Progress { stage: Stage::Whole, tests: search.records.len(), placed: blocks, blocks };
        loop {
            if matches!(searched, Ok(Outcome::TimeLimit | Outcome::Interrupted) | Err(PlanError::Interrupted)) {
                stop.stop();
            }
            match told.recv_timeout(PERIOD) {
                Ok((whole, time)) => return Checked { whole, time, searched },
                Err(RecvTimeoutError::Disconnected) => unreachable!("the check sends its verdict or panics"),
                Err(RecvTimeoutError::Timeout) => match clock.stops(progress) {
                    Some(outcome) if outcome != Outcome::WholeFalls => searched = Ok(outcome),
                    _ => {}
                },
            }
        }
    })
}
