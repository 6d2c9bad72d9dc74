//! Rows that go: their columns leave the basis, and what they held or loaded feels it.

use super::{Basic, Change, ConeSolver, OUT};

impl ConeSolver {
    /// Takes rows out, and with them every column that touches one. The next answer starts from the columns that remain.
    /// Rows that are not present stay so.
    pub fn remove_rows(&mut self, rows: &[usize]) {
        self.catch_up();
        self.lose_values();
        let rows: Vec<u32> = rows.iter().map(|&row| row as u32).filter(|&row| self.present[row as usize]).collect();
        for &row in &rows {
            self.note(Change::Gone { row, group: self.factor.group(row) });
            self.take_row(row);
            self.tally.count(self.rows.len());
        }
        // A row's own position first: its unit column always fits there if only newer blocks rest on the row.
        let own = rows.iter().copied().filter(|&row| self.column_in(row).is_some());
        let mut positions: Vec<u32> = own.collect();
        let touching = rows.iter().flat_map(|&row| self.g.columns_of(row)).map(|&(j, _)| self.position[j as usize]);
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
            let mut remaining = self.basis_set();
            remaining.columns.retain(|&j| self.missing[j as usize] == 0);
            remaining.units.fill(false); // whichever rows the columns leave over
            rows.iter().for_each(|&row| remaining.units[row as usize] = true);
            self.rebuild(&remaining);
            self.recompute_values();
        }
        self.forget_values(&rows);
    }

    /// The unit columns of rows that are absent have no value: rounding may touch them later, and must not find them out of
    /// balance.
    pub(super) fn forget_values(&mut self, rows: &[u32]) {
        rows.iter().for_each(|&row| self.x[row as usize] = 0.0);
    }

    /// A row is present no more.
    pub(super) fn take_row(&mut self, row: u32) {
        self.present[row as usize] = false;
        for &(j, _) in self.g.columns_of(row) {
            self.missing[j as usize] += 1;
        }
        if let Some(place) = self.rows.iter().rposition(|&other| other == row) {
            self.rows.remove(place);
        }
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
        let Some(left) = self.column_in(position) else { return Some(()) };
        self.spike.clear();
        self.spike.set(position, 1.0);
        self.factor.apply_operations(&mut self.spike);
        let replacement = self.factor.replace(position, &self.spike)?;
        self.note_accuracy(replacement, replacement.rate);
        self.counts.pivots += 1;
        self.distrust(position);
        self.take_out(left);
        self.note(Change::Pivot { position, entered: Basic::Unit, left: Basic::Column(left) });
        self.put(position, Basic::Unit);
        self.x[position as usize] = 0.0;
        felt.extend(self.g.column(left).iter().map(|&(row, _)| row));
        Some(())
    }
}
