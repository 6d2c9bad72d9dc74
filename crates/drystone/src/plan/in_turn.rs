//! Two searches in turn: the paper's, and where that takes long a balanced one.
//!
//! Both are complete and skip nothing that is not lost, so either answer is right; the orders differ. The second begins at
//! an exact count of tests: the plan is the same on every machine, and what the first finds until then is the order of
//! the paper's search (Lemma 3). From then on each has its turn, the next ones twice as long, so that together they make
//! about four times the tests of the better one at most.

use super::balanced::Balanced;
use super::candidates::Upward;
use super::clear_path::Paths;
use super::learned::{Bounds, Learned};
use super::memory::Memory;
use super::onward::Onward;
use super::outcome::{Limits, Outcome, TestRecord};
use super::search::{Clock, Search};
use super::stability::{PlanError, StabilityTest};
use super::touching::Touching;
use super::visited::Visited;
use crate::formulate::Assembly;
use std::mem::{swap, take};

/// Tests of the first turn, in all and for each block: a few seconds on a thousand blocks. A search that never steps back
/// makes one for each.
const FIRST_TURN: usize = 20_000;
const FOR_EACH_BLOCK: usize = 20;

/// Tests of the first turn on so many blocks.
pub(super) fn first_turn(blocks: usize) -> usize {
    FIRST_TURN.max(FOR_EACH_BLOCK * blocks)
}

/// What the searches with nothing held need, and what they have found.
pub(super) struct InTurn<'a> {
    assembly: &'a Assembly,
    touching: &'a Touching,
    paths: Option<&'a Paths<'a>>,
    turn: usize,
    /// The test of the balanced search.
    pub onward: fn(&'a Assembly) -> Box<dyn StabilityTest + 'a>,
    /// The largest sub-assembly put up.
    pub best: Vec<usize>,
    pub records: Vec<TestRecord>,
    pub shortcuts: usize,
}

impl<'a> InTurn<'a> {
    /// `turn` is the number of tests of the first turn.
    pub fn new(assembly: &'a Assembly, touching: &'a Touching, paths: Option<&'a Paths<'a>>, turn: usize) -> Self {
        Self {
            assembly,
            touching,
            paths,
            turn,
            onward: |assembly| Box::new(Onward::new(assembly)),
            best: Vec::new(),
            records: Vec::new(),
            shortcuts: 0,
        }
    }

    /// Searches until there is an answer, or no more time.
    pub fn run(&mut self, test: &mut dyn StabilityTest, clock: &mut Clock<'_>) -> Result<Outcome, PlanError> {
        let (mut upward, mut memory) = (Upward::new(self.touching), memory_for(self.touching, clock.limits, test));
        let learns = clock.limits.shortcuts && test.explains();
        let mut first = Search::new(self.touching, self.paths, memory.as_mut(), &mut upward);
        let turn = if learns { self.turn } else { usize::MAX };
        let ended = take_turn(&mut first, test, clock, turn);
        let ended = ended.unwrap_or_else(|| self.go_on_in_turn(&mut first, test, clock));
        (self.best, self.records) = (take(&mut first.best), take(&mut first.records));
        if matches!(ended, Ok(Outcome::NoOrder)) {
            first.take_down(test);
        }
        self.shortcuts += memory.shortcuts();
        ended
    }

    /// The balanced search, and from time to time the first again.
    fn go_on_in_turn(
        &mut self,
        first: &mut Search<'_>,
        test: &mut dyn StabilityTest,
        clock: &mut Clock<'_>,
    ) -> Result<Outcome, PlanError> {
        let mut memory = Learned::new(self.touching, Bounds { patience: 0, ..Bounds::default() });
        let (mut balanced, mut onward) = (Balanced::new(self.touching), (self.onward)(self.assembly));
        let mut second = Search::new(self.touching, self.paths, &mut memory, &mut balanced);
        let mut turn = self.turn;
        let ended = loop {
            hand_over(first, &mut second);
            let ended = take_turn(&mut second, onward.as_mut(), clock, turn);
            hand_over(&mut second, first);
            turn = match ended {
                None => turn.saturating_mul(2),
                // Numerical trouble: the first goes on alone, on a basis of its own.
                Some(Err(PlanError::NoAnswer { .. })) => usize::MAX,
                Some(ended) => break ended,
            };
            if let Some(ended) = take_turn(first, test, clock, turn) {
                break ended;
            }
        };
        self.shortcuts += memory.shortcuts();
        ended
    }
}

/// Lets a search make so many more tests. None if it wants to go on.
pub(super) fn take_turn(
    search: &mut Search<'_>,
    test: &mut dyn StabilityTest,
    clock: &mut Clock<'_>,
    turn: usize,
) -> Option<Result<Outcome, PlanError>> {
    let (limits, whole_falls) = (clock.limits, clock.whole_falls);
    let end = search.records.len().saturating_add(turn);
    let tests = Some(limits.tests.map_or(end, |most| most.min(end)));
    let (start, interrupt) = (clock.start, clock.interrupt.clone());
    let limits_of_turn = Limits { tests, ..limits };
    let mut clock = Clock { limits: limits_of_turn, start, monitor: clock.monitor, interrupt, whole_falls };
    let ended = search.run(test, &mut clock);
    let goes_on = matches!(ended, Ok(Outcome::TestLimit)) && limits.tests.is_none_or(|most| end < most);
    (!goes_on).then_some(ended)
}

/// What was found so far goes from one search to the other.
fn hand_over(from: &mut Search<'_>, to: &mut Search<'_>) {
    swap(&mut from.best, &mut to.best);
    swap(&mut from.records, &mut to.records);
}

/// What a search remembers with such a test.
pub(super) fn memory_for<'a>(touching: &'a Touching, limits: Limits, test: &dyn StabilityTest) -> Box<dyn Memory + 'a> {
    match limits.shortcuts && test.explains() {
        true => Box::new(Learned::new(touching, Bounds::default())),
        false => Box::new(Visited::default()),
    }
}
