//! Work done: exact, machine independent, what the tests gate on.

use serde::{Deserialize, Serialize};

/// Counts of one solve, or of a [`Solver`](crate::Solver) since it was made. A block exchange of [`Block`](crate::Block) is a
/// major cycle, and every row that it moves a pivot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Major cycles: rows driven to feasibility. Each ends with one pivot; with none when it ends on a ray, or when its
    /// minor cycles alone made the row feasible.
    pub major_cycles: usize,
    /// Minor cycles: pivots inside a major cycle, before the one that ends it.
    pub minor_cycles: usize,
    /// All pivots; what Table I of Loomis and Balkcom counts.
    pub pivots: usize,
    /// Times the active block was factored from scratch because updates had lost accuracy.
    pub refactorisations: usize,
    /// Rows put into the factor of the active block and taken out of it. [`Solver`](crate::Solver) only.
    pub factor_rows: usize,
    /// Stored numbers of the factor read by triangular solves, both ways; of [`ConeSolver`](crate::cone::ConeSolver) those
    /// of the upper triangle.
    pub entries_solved: usize,
}

impl std::ops::Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            major_cycles: self.major_cycles + other.major_cycles,
            minor_cycles: self.minor_cycles + other.minor_cycles,
            pivots: self.pivots + other.pivots,
            refactorisations: self.refactorisations + other.refactorisations,
            factor_rows: self.factor_rows + other.factor_rows,
            entries_solved: self.entries_solved + other.entries_solved,
        }
    }
}

impl std::ops::Sub for Counts {
    type Output = Self;

    fn sub(self, earlier: Self) -> Self {
        Self {
            major_cycles: self.major_cycles - earlier.major_cycles,
            minor_cycles: self.minor_cycles - earlier.minor_cycles,
            pivots: self.pivots - earlier.pivots,
            refactorisations: self.refactorisations - earlier.refactorisations,
            factor_rows: self.factor_rows - earlier.factor_rows,
            entries_solved: self.entries_solved - earlier.entries_solved,
        }
    }
}
