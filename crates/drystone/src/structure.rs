//! A structure that is put up and taken down block by block, in any order; each question about it is answered from the
//! last one.

mod fall;
mod hard;
mod history;
mod putting_up;
mod state;

use crate::{
    check::{self, Verdict},
    crossover::from_interior_within,
    error::SceneError,
    formulate::{Assemble, Assembly, BlockRows, BlockSet, Push},
    interrupt::or_else,
    ladder::Ladder,
    limit::{Limit, limit_from},
    scene::SceneOf,
};
use drystone_lcp::{
    Counts, Status,
    cone::{ConeSolver, Membership},
};
use fall::{Fall, Motion};
use hard::Hard;
use history::History;
use putting_up::PuttingUp;
use std::sync::Arc;

/// The blocks of a scene that are there at the moment; fixed bodies always are.
///
/// Kept between questions: the contacts of the complete scene, the basis of the generators that hold the structure up,
/// and its factor. A verdict costs what the change reaches; see [`ConeSolver::decide`]. Blocks that are taken off in the order
/// opposite to that in which they came leave the state that was there before them. And as long as the blocks that came and
/// went leave the last collapse as it was (Lemma 1, `plan/collapse.rs`), the structure still falls, and the solver is not
/// asked.
///
/// An answer that is stopped on the way ([`interrupt`](crate::interrupt)) leaves the blocks as they are; the next one begins from
/// nothing.
///
/// ```
/// use drystone::{Structure, scenes};
///
/// let mut structure = Structure::new(&scenes::column(4, 0.0)?)?; // a fixed block and three that move
/// structure.add(0);
/// structure.add(1);
/// assert_eq!(structure.stands(), Some(true));
/// structure.remove(0);
/// assert_eq!(structure.stands(), Some(false));
/// # Ok::<(), drystone::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Structure {
    assembly: Arc<Assembly>,
    blocks: BlockSet,
    solver: ConeSolver,
    rows: BlockRows,
    /// Place of each block in the order from the supports upward.
    height: Vec<usize>,
    /// Blocks put up, and taken away, since the solver was last told.
    new: Vec<usize>,
    gone: Vec<usize>,
    history: History,
    /// Where pivots take too long: what is known in place of a basis. The solver is empty then.
    hard: Option<Hard>,
    /// It fell when that was last asked.
    fell: bool,
    /// Work of solvers that were given up for another.
    earlier: Counts,
}

impl Structure {
    /// Takes the contacts of the complete scene; no block that moves is there yet.
    ///
    /// # Errors
    /// [`SceneError::Overlap`].
    pub fn new<S: Assemble>(scene: &SceneOf<S>) -> Result<Self, SceneError> {
        Assembly::new(scene).map(Self::of)
    }

    /// The same of an assembly whose contacts are known.
    pub fn of(assembly: impl Into<Arc<Assembly>>) -> Self {
        let assembly = assembly.into();
        let mut height = vec![0; assembly.blocks()];
        assembly.upward().into_iter().enumerate().for_each(|(place, block)| height[block] = place);
        let (blocks, solver) = (BlockSet::empty(assembly.blocks()), assembly.equilibrium());
        Self {
            rows: assembly.equilibrium_rows(),
            assembly,
            blocks,
            solver,
            height,
            new: Vec::new(),
            gone: Vec::new(),
            history: History::default(),
            hard: None,
            fell: false,
            earlier: Counts::default(),
        }
    }

    /// The complete assembly.
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// The same, for what outlives the structure.
    pub fn shared_assembly(&self) -> Arc<Assembly> {
        Arc::clone(&self.assembly)
    }

    /// The movable blocks that are there.
    pub fn blocks(&self) -> &BlockSet {
        &self.blocks
    }

    /// Puts a movable block up where the scene has it; it may be there already.
    ///
    /// # Panics
    /// If there is no such block.
    pub fn add(&mut self, block: usize) {
        if !self.blocks.contains(block) {
            self.blocks.insert(block);
            come(block, &mut self.new, &mut self.gone);
        }
    }

    /// Takes a movable block away; it need not be there.
    ///
    /// # Panics
    /// If there is no such block.
    pub fn remove(&mut self, block: usize) {
        if self.blocks.contains(block) {
            self.blocks.remove(block);
            come(block, &mut self.gone, &mut self.new);
        }
    }

    /// Blocks that came and went since the last answer.
    pub fn pending(&self) -> usize {
        self.new.len() + self.gone.len()
    }

    /// Tells the solver what has come and gone: the new blocks from the supports upward.
    fn put_up(&mut self) {
        let Self { assembly, rows, solver, history, .. } = self;
        let mut gone = std::mem::take(&mut self.gone);
        if !gone.is_empty() {
            history.go_back(&mut gone, &self.blocks, solver);
            gone.drain(..).for_each(|block| solver.remove_rows(rows.of(block)));
        }
        let mut new = std::mem::take(&mut self.new);
        new.sort_unstable_by_key(|&block| self.height[block]);
        PuttingUp { assembly, rows, solver, history }.put_up(&mut new, &self.blocks);
        (self.new, self.gone) = (new, gone); // empty, with their room
    }

    /// Whether an equilibrium within the friction cones exists; None if the solver found no answer, or that it is
    /// [borderline](Self::is_borderline).
    pub fn stands(&mut self) -> Option<bool> {
        or_else(self, Self::decide, Self::begin_anew)
    }

    fn decide(&mut self) -> Option<bool> {
        if self.fell && self.fall().carries_over(&self.new, &self.gone) {
            return Some(false);
        }
        let found = self.ask(ConeSolver::decide);
        match found {
            Membership::Inside => Some(true),
            Membership::Outside => Some(false),
            _ if self.hard.is_some() => None,
            // The accelerations may tell what the forces do not.
            _ => {
                let verdict = self.by_equilibrium(found, Counts::default());
                (verdict.status == Status::Solved).then_some(verdict.stable)
            }
        }
    }

    /// How it fell when that was last asked.
    fn fall(&self) -> Fall<'_> {
        let motion = match &self.hard {
            Some(hard) => Motion::Found(hard.falling()),
            None => Motion::Certified(&self.solver, &self.rows),
        };
        Fall { assembly: &self.assembly, motion }
    }

    /// Whether it stands: by pivots, or by the interior-point method where those are too hard.
    fn ask(&mut self, question: impl FnOnce(&mut ConeSolver) -> Membership) -> Membership {
        let found = self.effort_of_pivots().and_then(|effort| self.by_pivots(question, effort));
        let found = found.unwrap_or_else(|| self.by_interior_point());
        self.fell = found == Membership::Outside;
        found
    }

    /// How long pivots are made; None if they are too hard.
    fn effort_of_pivots(&self) -> Option<usize> {
        let ladder = Ladder::of(&self.assembly, self.blocks.len());
        match &self.hard {
            Some(hard) => hard.chance().map(|factors| ladder.effort_of_factors(factors)),
            None if self.new.len() == self.blocks.len() => Some(ladder.effort_of_interior_point()),
            None => Some(ladder.effort_of_a_change()),
        }
    }

    /// Tells the solver of the changes and asks it. None where this would take more than some effort: the solver is given up then.
    fn by_pivots(&mut self, question: impl FnOnce(&mut ConeSolver) -> Membership, effort: usize) -> Option<Membership> {
        if self.hard.is_some() {
            (self.new, self.gone) = (self.blocks.iter().collect(), Vec::new());
        }
        self.solver.limit_effort(self.solver.effort().saturating_add(effort));
        self.put_up();
        let found = question(&mut self.solver);
        let hard = found == Membership::PivotLimit && self.solver.is_exhausted();
        self.solver.limit_effort(usize::MAX);
        if hard {
            let hard = Hard::after(self.hard.take());
            self.begin_anew();
            self.hard = Some(hard);
            None
        } else {
            self.hard = None;
            Some(found)
        }
    }

    /// Begins where the last answer of the method ended. Where it proves nothing a solver decides that begins from its answer.
    fn by_interior_point(&mut self) -> Membership {
        let (new, _) = (std::mem::take(&mut self.new), std::mem::take(&mut self.gone));
        let stands = self.hard.as_mut().and_then(|hard| hard.stands(&self.assembly, &self.blocks, &new));
        match stands {
            Some(true) => Membership::Inside,
            Some(false) => Membership::Outside,
            None => self.by_crossover(),
        }
    }

    /// What a solver says that begins from the answer of the interior-point method. Borderline where that takes too long.
    fn by_crossover(&mut self) -> Membership {
        let effort = Ladder::of(&self.assembly, self.blocks.len()).effort_at_a_limit();
        let (found, mut solver) = from_interior_within(&self.assembly, &self.blocks, effort);
        if found == Membership::PivotLimit && solver.is_exhausted() {
            return Membership::Borderline;
        }
        solver.limit_effort(usize::MAX);
        (self.hard, self.solver, self.history) = (None, solver, History::default());
        found
    }

    fn by_equilibrium(&self, found: Membership, spent: Counts) -> Verdict {
        check::by_equilibrium(&self.assembly, &self.blocks, found, &self.solver, spent, &mut |_| true)
            .expect("nobody stops it")
    }

    /// Whether the last answer was neither: standing and falling are both within what is allowed, or neither is proved.
    pub fn is_borderline(&self) -> bool {
        self.solver.doubt().is_some() || self.hard.as_ref().is_some_and(Hard::is_undecided)
    }

    /// The verdict with all forces, or with the accelerations if it falls.
    pub fn check(&mut self) -> Verdict {
        or_else(self, Self::judge, Self::begin_anew)
    }

    /// The same blocks, of which the solver knows nothing yet: it was stopped somewhere.
    fn begin_anew(&mut self) {
        self.earlier = self.counts();
        self.solver = self.assembly.equilibrium();
        (self.new, self.gone) = (self.blocks.iter().collect(), Vec::new());
        (self.history, self.hard, self.fell) = (History::default(), None, false);
    }

    /// In which interval of t the structure can stand under t times a push beside its loads, from the basis that is there.
    pub fn limit(&mut self, push: &Push) -> Limit {
        or_else(self, |structure| structure.limit_of(push), Self::begin_anew)
    }

    fn limit_of(&mut self, push: &Push) -> Limit {
        let found = self.ask(ConeSolver::solve);
        let found = if self.hard.is_some() { Membership::PivotLimit } else { found };
        limit_from(&self.assembly, &self.blocks, push, found, &self.solver)
    }

    fn judge(&mut self) -> Verdict {
        let before = self.counts();
        let found = self.ask(ConeSolver::solve);
        let spent = self.counts() - before;
        match self.hard {
            Some(_) => check::by_interior_point(&self.assembly, &self.blocks, spent),
            None => self.by_equilibrium(found, spent),
        }
    }

    /// Work done so far.
    pub fn counts(&self) -> Counts {
        self.earlier + self.solver.counts()
    }

    /// Numbers stored in the factor.
    pub fn entries(&self) -> usize {
        self.hard.as_ref().map_or_else(|| self.solver.entries(), Hard::entries)
    }
}

/// A block comes to one list; if it was about to leave by the other, nothing happens.
fn come(block: usize, to: &mut Vec<usize>, from: &mut Vec<usize>) {
    match from.iter().position(|&other| other == block) {
        Some(place) => drop(from.remove(place)),
        None => to.push(block),
    }
}
