//! Does a growing stack stand with one more block?
//!
//! Every block kept left the stack standing. So the stack stays put up in one solver, and each block that may come
//! next is put on it and taken off again. Only contacts of new blocks are looked for, and only they are formulated.

use super::placed::{Placed, Rule, scene_of};
use crate::{error::SceneError, formulate::Assembly};
use drystone_lcp::cone::{Columns, ConeSolver, Mark, Membership};
use std::ops::Range;

/// Components of a wrench in the plane: two forces and the torque.
const PLANE: [usize; 3] = [0, 1, 5];

/// The equilibrium problem of the blocks kept so far, all of which are put up, and of the block asked about last.
pub(super) struct Standing {
    ground: i64,
    solver: ConeSolver,
    standing: Mark,
    /// Blocks kept, and their generators.
    kept: usize,
    columns: usize,
}

/// What a block brings to the equilibrium problem.
struct Piece {
    columns: Columns,
    /// What its contacts have to bear.
    load: Vec<f64>,
    /// In which its imbalance is measured.
    unit: Vec<f64>,
}

/// Rows of the blocks that were kept from one place up to another.
fn rows(blocks: Range<usize>) -> Range<usize> {
    PLANE.len() * blocks.start..PLANE.len() * blocks.end
}

impl Standing {
    /// Nothing on a ground of this width.
    pub fn on(ground: i64) -> Self {
        let nothing = Columns::new(0, &[0], &[], &[]).expect("no entries");
        let mut solver = ConeSolver::new(nothing, &[], &[]).expect("no rows");
        Self { ground, standing: solver.mark(), solver, kept: 0, columns: 0 }
    }

    /// Finds what a block touches. None if it overlaps something.
    fn piece(&self, placed: &[Placed], block: &Placed) -> Result<Option<Piece>, SceneError> {
        let near: Vec<usize> = (0..placed.len()).filter(|&k| placed[k].is_near(block)).collect();
        let scene = scene_of(self.ground, near.iter().map(|&k| &placed[k]).chain([block]))?;
        let Ok(assembly) = Assembly::new(&scene) else { return Ok(None) };
        let own = near.len();
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for &generator in assembly.generators_on(own) {
            for wrench in assembly.wrenches(&assembly.generators()[generator]) {
                let block = near.get(wrench.block).copied().unwrap_or(self.kept);
                let values = PLANE.map(|component| wrench.value[component]);
                for (row, value) in rows(block..block + 1).zip(values).filter(|&(_, value)| value != 0.0) {
                    indices.push(row);
                    data.push(value);
                }
            }
            indptr.push(indices.len());
        }
        let columns = Columns::new(rows(0..self.kept + 1).end, &indptr, &indices, &data);
        Ok(Some(Piece {
            columns: columns.expect("blocks of finite size"),
            load: assembly.applied(own).iter().map(|load| -load).collect(),
            unit: assembly.balance_unit(own).collect(),
        }))
    }

    /// Puts a block in the place of the one asked about last, if that was not kept. False if it overlaps something.
    fn take(&mut self, placed: &[Placed], block: &Placed) -> Result<bool, SceneError> {
        let piece = self.piece(placed, block)?;
        self.solver.truncate(rows(0..self.kept).end, self.columns);
        let found = piece.is_some();
        if let Some(Piece { columns, load, unit }) = piece {
            self.solver.append(columns, &load, &unit).expect("blocks of finite size");
        }
        self.standing = self.solver.mark();
        Ok(found)
    }

    /// Puts the block asked about up.
    fn put_on(&mut self) -> Membership {
        self.solver.add_rows(&rows(self.kept..self.kept + 1).collect::<Vec<_>>());
        self.solver.decide()
    }

    /// Whether what is put up stands together with the block asked about; that is then taken off again.
    fn stands_with_it(&mut self) -> bool {
        let found = self.put_on();
        self.solver.roll_back(self.standing);
        found == Membership::Inside
    }
}

impl Rule for Standing {
    fn stands(&mut self, placed: &[Placed], block: &Placed) -> Result<bool, SceneError> {
        Ok(self.take(placed, block)? && self.stands_with_it())
    }

    fn stands_on_lower(&mut self, placed: &[Placed], block: &Placed) -> Result<bool, SceneError> {
        let higher = (0..placed.len()).filter(|&k| !placed[k].is_lower_than(block));
        self.solver.remove_rows(&higher.flat_map(|k| rows(k..k + 1)).collect::<Vec<_>>());
        let stands = self.stands_with_it();
        self.standing = self.solver.mark();
        Ok(stands)
    }

    fn keep(&mut self) {
        self.put_on();
        self.kept += 1;
        self.columns = self.solver.columns();
    }
}

#[cfg(test)]
mod tests {
    use super::{super::*, Standing};

    /// Put up anew before each block, at one pivot a block or more, the stack alone would take 20,000.
    #[test]
    fn the_stack_is_put_up_once() {
        let (blocks, seed) = (200, 1);
        let mut standing = Standing::on(ground_width(blocks));
        drop_blocks(blocks, seed, 0.0, &mut standing).unwrap();
        assert_eq!(standing.kept, blocks);
        let pivots = standing.solver.counts().pivots;
        assert!(pivots < 80 * blocks, "{pivots} pivots");
    }
}
