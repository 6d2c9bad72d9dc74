//! Replacements taken back, the last first, and rows that come and go.

use super::{BasisFactor, Stage, Undo};

impl BasisFactor {
    /// Changes the number of rows; nothing before can be undone. New rows have their unit columns, and so must those that go.
    pub fn resize(&mut self, n: usize) {
        for position in self.stage.len()..n {
            self.stage.push(self.stages.len() as u32);
            self.stages.push(Stage::unit(position as u32));
            self.rows.push_list();
            self.work.push(0.0);
        }
        self.stage.truncate(n); // the stages stay behind, as those of replaced columns do
        self.readers.resize(n);
        self.writers.resize(n);
        self.group.resize(n, 0);
        self.forget();
    }

    /// Number of replacements made, to come back to with [`Self::undo_to`].
    pub fn mark(&self) -> usize {
        self.undo.len()
    }

    /// Nobody takes replacements back from here.
    pub fn forget(&mut self) {
        self.undo.clear();
    }

    /// Replaced columns that are still kept.
    pub fn left_behind(&self) -> usize {
        self.stages.len() - self.stage.len()
    }

    /// Takes back replacements, the last first.
    pub fn undo_to(&mut self, mark: usize) {
        while self.undo.len() > mark
            && let Some(Undo { position, stage, operation }) = self.undo.pop()
        {
            let p = position as usize;
            if operation && let Some(last) = self.operations.pop() {
                self.stored -= last.range().len();
                for (row, _) in self.terms.drain(last.start as usize..) {
                    self.readers.pop(row);
                }
                self.writers.pop(position);
            }
            let new = self.stage[p];
            self.unlink(new);
            self.above.truncate(self.stages[new as usize].start as usize);
            self.stages.pop();
            self.rows.pop_list();
            self.work.pop();
            self.link(stage);
            self.stage[p] = stage;
        }
    }

    /// Undoes [`Self::unlink`].
    fn link(&mut self, stage: u32) {
        self.stored += self.entries_of(stage);
        let Self { stages, above, rows, .. } = self;
        above[stages[stage as usize].range()].iter().for_each(|&(i, value)| rows.push(i, (stage, value)));
        for &(q, value) in rows.of(stage) {
            let column = &mut stages[q as usize];
            column.len += 1;
            above[column.range().end - 1] = (stage, value);
        }
    }
}
