//! Rows that go: their columns leave the basis, and what they held or loaded feels it.

use super::{Basic, ConeSolver, basis::OUT, journal::Change};

impl ConeSolver {
    /// Takes rows out, and with them every column that touches one. The next answer starts from the columns that remain.
    /// Rows that are not present stay so.
    pub fn remove_rows(&mut self, rows: &[usize]) {
        self.catch_up();
        self.journal.lose_values();
        let rows: Vec<u32> =
            rows.iter().map(|&row| row as u32).filter(|&row| self.present.is_there[row as usize]).collect();
        for &row in &rows {
            self.journal.note(Change::Gone { row, group: self.basis.factor.group(row) });
            self.take_row(row);
            self.tally.count(self.present.rows.len());
        }
        // A row's own position first: its unit column always fits there if only newer blocks rest on the row.
        let own = rows.iter().copied().filter(|&row| self.basis.column_in(row).is_some());
        let mut positions: Vec<u32> = own.collect();
        let touching =
            rows.iter().flat_map(|&row| self.problem.g.columns_of(row)).map(|&(j, _)| self.basis.position[j as usize]);
        for position in touching.filter(|&position| position != OUT) {
            self.tally.count(positions.len());
            if !positions.contains(&position) {
                positions.push(position);
            }
        }
        let mut felt = Vec::new();
        if self.put_units(positions, &mut felt) {
            self.pass_on(&felt);
        } else {
            let mut remaining = self.basis.set(&self.present.rows);
            remaining.columns.retain(|&j| self.present.takes_part(j));
            remaining.units.fill(false); // whichever rows the columns leave over
            rows.iter().for_each(|&row| remaining.units[row as usize] = true);
            self.rebuild(&remaining);
            self.recompute_values();
        }
        self.values.forget(&rows);
    }

    /// A row is present no more.
    pub(super) fn take_row(&mut self, row: u32) {
        self.present.take(row, &self.problem.g);
        self.leave_group(row);
    }

    /// Puts unit columns into all of these positions, in an order in which that works. False if there is none, or an unlucky
    /// start.
    fn put_units(&mut self, mut positions: Vec<u32>, felt: &mut Vec<u32>) -> bool {
        while !positions.is_empty() {
            let before = positions.len();
            positions.retain(|&position| self.put_unit(position, felt).is_none());
            if positions.len() == before {
                return false;
            }
        }
        true
    }

    /// Puts the unit column of its row into a position, and notes the rows that feel that its column has gone. None if the
    /// basis would become singular.
    fn put_unit(&mut self, position: u32, felt: &mut Vec<u32>) -> Option<()> {
        let Some(left) = self.basis.column_in(position) else { return Some(()) };
        self.pivot.spike.clear();
        self.pivot.spike.set(position, 1.0);
        self.basis.factor.apply_operations(&mut self.pivot.spike);
        let replacement = self.basis.factor.replace(position, &self.pivot.spike)?;
        self.basis.note_accuracy(replacement, replacement.rate);
        self.counts.pivots += 1;
        self.distrust(position);
        self.take_out(left);
        self.journal.note(Change::Pivot { position, entered: Basic::Unit, left: Basic::Column(left) });
        self.basis.put(position, Basic::Unit);
        self.values.basic[position as usize] = 0.0;
        felt.extend(self.problem.g.column(left).iter().map(|&(row, _)| row));
        Some(())
    }
}
