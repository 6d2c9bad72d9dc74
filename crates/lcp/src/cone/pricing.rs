//! Which column enters: the one that lowers the infeasibility fastest.

use super::{columns::Columns, sparse_vector::SparseVector};
use crate::interrupt::Tally;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Finds entering columns among those that touch a row with a multiplier.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Pricing {
    seen: Vec<bool>,
    touched: Vec<u32>,
    preferred: Range<u32>,
    #[serde(skip)]
    effort: usize,
    #[serde(skip)]
    tally: Tally,
}

/// Rates within this share of the best count as equal, so that rounding does not decide between symmetric columns.
const EQUAL: f64 = 1e-9;

/// Where more than the so manieth part of all rows have multipliers, all columns are looked at one after the other: nearly
/// every one touches such a row.
const DENSE: usize = 8;

/// Operations to look at a column, about.
const COLUMN: usize = 8;

impl Pricing {
    pub fn new(columns: usize) -> Self {
        Self { seen: vec![false; columns], touched: Vec::new(), preferred: 0..0, effort: 0, tally: Tally::default() }
    }

    /// Operations so far, about.
    pub fn effort(&self) -> usize {
        self.effort
    }

    fn count(&mut self, operations: usize) {
        self.effort += operations;
        self.tally.count(operations);
    }

    /// Makes room for so many columns.
    pub fn resize(&mut self, columns: usize) {
        self.seen.resize(columns, false);
    }

    /// As long as one of these columns helps no other enters, except by least index.
    pub fn prefer(&mut self, columns: Range<u32>) {
        self.preferred = columns;
    }

    /// The allowed column with the largest `y' g`, or with the least index if `least_index`, among those above
    /// `floor`; the least index among equals, and a preferred one before any other.
    pub fn entering(
        &mut self,
        g: &Columns,
        y: &SparseVector,
        allowed: impl Fn(u32) -> bool,
        floor: f64,
        least_index: bool,
    ) -> Option<u32> {
        let rate = |j: u32| -> f64 { g.column(j).iter().map(|&(row, value)| value * y.get(row)).sum() };
        let mut best = Best { floor, least_index, found: None };
        let preferred = if least_index { 0..0 } else { self.preferred.clone() };
        if DENSE * y.index().len() > g.rows() {
            self.count(COLUMN * g.len());
            let others = (0..preferred.start).chain(preferred.end..g.len() as u32);
            best.of_all(preferred.filter(|&j| allowed(j)), rate);
            best.of_all_if_none(others.filter(|&j| allowed(j)), rate);
        } else {
            self.touch(g, y, allowed);
            self.count(COLUMN * self.touched.len());
            best.of_all(self.touched.iter().copied().filter(|j| preferred.contains(j)), rate);
            best.of_all_if_none(self.touched.iter().copied().filter(|j| !preferred.contains(j)), rate);
            self.touched.clear();
        }
        best.found.map(|(j, _)| j)
    }

    /// Lists the allowed columns in the rows that have a multiplier.
    fn touch(&mut self, g: &Columns, y: &SparseVector, allowed: impl Fn(u32) -> bool) {
        for (row, value) in y.iter() {
            if value != 0.0 {
                for &(j, _) in g.columns_of(row) {
                    if allowed(j) && !std::mem::replace(&mut self.seen[j as usize], true) {
                        self.touched.push(j);
                    }
                }
            }
        }
        self.touched.iter().for_each(|&j| self.seen[j as usize] = false);
    }
}

/// The best column so far, with its rate.
struct Best {
    floor: f64,
    least_index: bool,
    found: Option<(u32, f64)>,
}

impl Best {
    fn of_all(&mut self, columns: impl Iterator<Item = u32>, rate: impl Fn(u32) -> f64) {
        for j in columns {
            let rate = rate(j);
            let better =
                self.found.is_none_or(|(k, top)| match self.least_index || (rate - top).abs() <= EQUAL * top {
                    true => j < k,
                    false => rate > top,
                });
            if rate > self.floor && better {
                self.found = Some((j, rate));
            }
        }
    }

    fn of_all_if_none(&mut self, columns: impl Iterator<Item = u32>, rate: impl Fn(u32) -> f64) {
        if self.found.is_none() {
            self.of_all(columns, rate);
        }
    }
}
