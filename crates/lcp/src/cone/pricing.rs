//! Which column enters: the one that lowers the infeasibility fastest.

use super::{columns::Columns, sparse_vector::SparseVector};
use std::ops::Range;

/// Finds entering columns among those that touch a row with a multiplier.
#[derive(Debug, Clone)]
pub(super) struct Pricing {
    seen: Vec<bool>,
    touched: Vec<u32>,
    preferred: Range<u32>,
}

/// Rates within this share of the best count as equal, so that rounding does not decide between symmetric columns.
const EQUAL: f64 = 1e-9;

impl Pricing {
    pub fn new(columns: usize) -> Self {
        Self { seen: vec![false; columns], touched: Vec::new(), preferred: 0..0 }
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
        for (row, value) in y.iter() {
            if value != 0.0 {
                for &(j, _) in g.columns_of(row) {
                    if allowed(j) && !std::mem::replace(&mut self.seen[j as usize], true) {
                        self.touched.push(j);
                    }
                }
            }
        }
        let mut best: Option<(u32, f64)> = None;
        let preferred = |j: u32| !least_index && self.preferred.contains(&j);
        for &j in &self.touched {
            self.seen[j as usize] = false;
            let rate: f64 = g.column(j).iter().map(|&(row, value)| value * y.get(row)).sum();
            let better = best.is_none_or(|(k, top)| match (preferred(j), preferred(k)) {
                (true, false) => true,
                (false, true) => false,
                _ if least_index || (rate - top).abs() <= EQUAL * top => j < k,
                _ => rate > top,
            });
            if rate > floor && better {
                best = Some((j, rate));
            }
        }
        self.touched.clear();
        best.map(|(j, _)| j)
    }
}
