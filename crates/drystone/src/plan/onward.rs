//! Collapses carried on to the blocks that are not there.
//!
//! By Lemma 1 (`collapse.rs`) a collapse holds as long as no block comes that touches a moving one. Most such blocks would
//! not be in its way: what lies on a beam rises with it.
//!
//! *Lemma 4 (the collapse carried on).* Let v move some of *all* blocks, there or not, and let A be blocks at rest such
//! that v closes no contact of the complete assembly but some of those with A. Every sub-assembly without a block of A in
//! which the loads do work falls. *Proof.* Let the moving blocks that are there move by v. Every contact of the
//! sub-assembly is one of the complete assembly and none with A, so none is closed. ∎
//!
//! The motion is looked for in the solver that has found that a sub-assembly falls. The blocks that it would run into are
//! put in without their weight. If all still falls, the new motion takes them along; if not, they *prop* the structure and are
//! A. What comes out at the end, mostly with no A at all, is a balance that every structure must keep:
//! `sum F_b' v_b <= 0` over its blocks.

use super::collapse::Collapse;
use super::stability::{PlanError, StabilityTest, TestOutcome, by_accelerations};
use crate::{
    equilibrium::collapse_motion,
    formulate::{Assembly, BlockRows, BlockSet, Components},
};
use drystone_lcp::cone::{ConeSolver, Mark, Membership};

/// How fast a contact may close and count as at rest, relative to the fastest motion: rounding of the multipliers. In a motion
/// whose work counts (`nogood.rs`) it is a millionth of that.
const CLOSING: f64 = 1e-9;

/// Work of a load, relative to the largest, that is rounding.
const NO_WORK: f64 = 1e-9;

/// Equilibrium as in [`Reuse`](super::Reuse), with collapses that are carried on.
#[derive(Debug)]
pub struct Onward<'a> {
    assembly: &'a Assembly,
    solver: ConeSolver,
    rows: BlockRows,
    /// States of the current sub-assembly and its ancestors, the current one last.
    path: Vec<Mark>,
    at_current: bool,
    fell: Option<Collapse>,
}

/// The blocks that move, and how.
type Motion = Vec<(usize, Components)>;

impl<'a> Onward<'a> {
    /// Takes the generators of the complete assembly; the current sub-assembly is empty.
    pub fn new(assembly: &'a Assembly) -> Self {
        let mut solver = assembly.equilibrium_with_loads();
        let path = vec![solver.mark()];
        Self { assembly, solver, rows: assembly.equilibrium_rows(), path, at_current: true, fell: None }
    }

    /// Blocks outside a set into which the blocks of the set would run.
    fn in_the_way(&self, motion: &Motion, set: &BlockSet) -> Vec<usize> {
        let fastest = motion.iter().fold(0.0_f64, |fastest, moving| fastest.max(self.speed(moving)));
        let mut blocks = Vec::new();
        for (block, velocity) in motion {
            for &generator in self.assembly.generators_on(*block) {
                let generator = &self.assembly.generators()[generator];
                let Some(other) = generator.blocks().find(|&block| !set.contains(block)) else { continue };
                let own = self.assembly.wrenches(generator).filter(|wrench| wrench.block == *block);
                let opening: f64 =
                    own.flat_map(|wrench| wrench.value.into_iter().zip(velocity)).map(|(w, v)| w * v).sum();
                if opening < -CLOSING * fastest {
                    blocks.push(other);
                }
            }
        }
        blocks.sort_unstable();
        blocks.dedup();
        blocks
    }

    /// Of the fastest point of a block, or a little more, m/s.
    fn speed(&self, (block, velocity): &(usize, Components)) -> f64 {
        let radius = self.assembly.body(*block).radius;
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
        largest(&velocity[..3]).max(radius * largest(&velocity[3..]))
    }

    /// Puts blocks in without their weight if it falls with them, too.
    fn falls_with(&mut self, blocks: &[usize]) -> bool {
        let before = self.solver.mark();
        blocks.iter().for_each(|&block| self.solver.add_rows(self.rows.of(block)));
        let falls = self.solver.decide() == Membership::Outside;
        if !falls {
            self.solver.roll_back(before);
        }
        falls
    }

    /// How a sub-assembly that was just found to fall does so among all blocks (Lemma 4).
    fn carry_on(&mut self, fallen: &BlockSet) -> Collapse {
        let (mut known, mut motion, mut props) =
            (fallen.clone(), collapse_motion(self.assembly, &self.solver), Vec::new());
        loop {
            let in_the_way = self.in_the_way(&motion, &known);
            let Some(&first) = in_the_way.first() else { break };
            // If it does not fall with all of them, some of them prop it: they are tried one by one.
            let together = self.falls_with(&in_the_way);
            let tried = if together { &in_the_way[..] } else { &in_the_way[..1] };
            if together || tried.len() < in_the_way.len() && self.falls_with(tried) {
                motion = collapse_motion(self.assembly, &self.solver);
            } else {
                props.push(first);
            }
            tried.iter().for_each(|&block| known.insert(block));
        }
        let work = |(block, velocity): &(usize, Components)| {
            let components = self.assembly.components().iter().zip(self.assembly.applied(*block));
            (*block, components.map(|(&k, load)| load * velocity[k]).sum())
        };
        let mut moving: Vec<(usize, f64)> = motion.iter().map(work).collect();
        let most = moving.iter().fold(0.0_f64, |most, (_, work)| most.max(work.abs()));
        moving.retain(|(_, work)| work.abs() > NO_WORK * most);
        Collapse::carried_on(moving, props)
    }
}

impl StabilityTest for Onward<'_> {
    fn test(&mut self, blocks: &BlockSet, added: usize) -> Result<TestOutcome, PlanError> {
        if !self.at_current
            && let Some(&current) = self.path.last()
        {
            self.solver.roll_back(current);
        }
        self.at_current = false;
        let before = self.solver.counts().pivots;
        self.solver.add_rows(self.rows.of(added));
        self.solver.add_rows(&[self.assembly.load_row(added)]);
        // The last test before the structure is complete brings all forces up to date, and checks them.
        let last = blocks.len() + 1 == self.assembly.blocks();
        let found = if last { self.solver.solve() } else { self.solver.decide() };
        let outcome = match TestOutcome::sure(found, &self.solver, 0) {
            Some(outcome) => outcome,
            None => {
                let tested = by_accelerations(self.assembly, blocks)?;
                self.fell = tested.collapse;
                tested.outcome
            }
        };
        if found == Membership::Outside {
            self.fell = Some(self.carry_on(blocks));
        }
        Ok(TestOutcome { pivots: self.solver.counts().pivots - before, ..outcome })
    }

    fn explains(&self) -> bool {
        true
    }

    fn collapse(&self) -> Option<Collapse> {
        self.fell.clone()
    }

    fn descend(&mut self) {
        self.path.push(self.solver.mark());
        self.at_current = true;
    }

    fn backtrack(&mut self) {
        self.path.pop();
        self.at_current = false;
    }
}
