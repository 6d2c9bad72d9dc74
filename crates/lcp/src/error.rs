//! What can be wrong with the input. What can go wrong in a solve is a [`Status`](crate::Status).

/// Bad input to this crate. Every message names the offending entry and what to do about it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LcpError {
    /// `M` and `q` do not fit together.
    #[error("M is {rows} x {columns} but q has {q} entries: M must be square and as long as q")]
    Shape {
        /// Rows of `M`.
        rows: usize,
        /// Columns of `M`.
        columns: usize,
        /// Length of `q`.
        q: usize,
    },
    /// The compressed-column arrays of `M` do not describe a matrix.
    #[error("M is not a valid compressed-column matrix: {reason}")]
    Structure {
        /// What is wrong with the arrays.
        reason: String,
    },
    /// A NaN or an infinity in `M`.
    #[error("M[{row}, {column}] is {value}: every entry must be finite")]
    MatrixNotFinite {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// A NaN or an infinity in `q`.
    #[error("q[{index}] is {value}: every entry must be finite")]
    VectorNotFinite {
        /// Index of the entry.
        index: usize,
        /// The entry.
        value: f64,
    },
    /// Dantzig's method was given a matrix that is not symmetric.
    #[error(
        "M is not symmetric: M[{row}, {column}] = {value} but M[{column}, {row}] = {mirror}; \
         symmetrise it, or use Lemke's method"
    )]
    NotSymmetric {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// The entry.
        value: f64,
        /// Its mirror image.
        mirror: f64,
    },
    /// Dantzig's method met negative curvature: `M` is not positive semidefinite.
    #[error(
        "M is not positive semidefinite: scaled to a unit diagonal it has an eigenvalue of {eigenvalue:.1e} or less \
         (seen at index {index}); use Lemke's method, or write M with more digits if rounding did it"
    )]
    NotSemidefinite {
        /// Index of the row at which it was seen.
        index: usize,
        /// `y' M y / y' y` of the direction y found there, M scaled to a unit diagonal: the least eigenvalue is at most this.
        eigenvalue: f64,
    },
    /// A row that the complete problem does not have.
    #[error("row {row} is outside a problem with {n} rows")]
    RowOutOfRange {
        /// The row.
        row: usize,
        /// Rows of the complete problem.
        n: usize,
    },
    /// Values of `q` and the rows they are for differ in number.
    #[error("{values} values of q for {rows} rows: give one for each row")]
    ValuesForRows {
        /// Number of rows.
        rows: usize,
        /// Number of values.
        values: usize,
    },
    /// A snapshot was taken from another solver.
    #[error("the snapshot is one of another solver: restore it there, or solve its rows here")]
    ForeignSnapshot,
    /// `G`, the inverse masses and the load do not fit together.
    #[error(
        "G has {rows} rows but there are {inverse_masses} inverse masses and {loads} loads: give one of each for every row"
    )]
    GeneratorShape {
        /// Rows of `G`.
        rows: usize,
        /// Number of inverse masses.
        inverse_masses: usize,
        /// Length of the load.
        loads: usize,
    },
    /// An inverse mass that is negative or not finite.
    #[error("inverse mass [{row}] is {value}: it must be finite, and zero or more")]
    InverseMass {
        /// Row of `G`.
        row: usize,
        /// The entry.
        value: f64,
    },
    /// A NaN or an infinity in the load.
    #[error("h[{row}] is {value}: every entry must be finite")]
    LoadNotFinite {
        /// Row of `G`.
        row: usize,
        /// The entry.
        value: f64,
    },
    /// The origins given to [`Solver::follow`](crate::Solver::follow) do not fit the two problems.
    #[error("the origins do not fit: {reason}")]
    Origins {
        /// What is wrong with them.
        reason: String,
    },
    /// An entry between two rows that were said to be unchanged is another one.
    #[error("M[{row}, {column}] is {value:e} and was {before:e}: a row whose entries change has the origin `Moved`")]
    RowChanged {
        /// Row of the entry in the new problem.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// The entry.
        value: f64,
        /// What it was.
        before: f64,
    },
    /// A kept state does not belong to this problem.
    #[error("the state is not one of this problem: {reason}")]
    ForeignState {
        /// What does not fit.
        reason: String,
    },
    /// A start that cannot be used.
    #[error("the start cannot be used: {0}")]
    Start(#[from] StartError),
}

/// Why a start was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StartError {
    /// `indices` and `z` differ in length.
    #[error("{indices} indices but {values} values")]
    Length {
        /// Number of indices.
        indices: usize,
        /// Number of values.
        values: usize,
    },
    /// An index beyond the problem.
    #[error("index {index} is outside a problem with {n} rows")]
    OutOfRange {
        /// The index.
        index: usize,
        /// Rows of the problem.
        n: usize,
    },
    /// An index given twice.
    #[error("index {index} is given twice")]
    Repeated {
        /// The index.
        index: usize,
    },
    /// A negative or non-finite `z`.
    #[error("z[{index}] is {value}: a sub-problem's solution is finite and not negative")]
    Infeasible {
        /// Index in the complete problem.
        index: usize,
        /// The value.
        value: f64,
    },
    /// `w` is negative on a row of the sub-problem: `z` does not solve it.
    #[error("w[{index}] = {w:e} is negative there: z does not solve the sub-problem of this matrix and vector")]
    Violated {
        /// Index in the complete problem.
        index: usize,
        /// The value of `w`.
        w: f64,
    },
    /// Both `z` and `w` are positive on a row.
    #[error("z[{index}] = {z:e} and w[{index}] = {w:e} are both positive: the start is not complementary")]
    NotComplementary {
        /// Index in the complete problem.
        index: usize,
        /// The value of `z`.
        z: f64,
        /// The value of `w`.
        w: f64,
    },
    /// Rows with `z > 0` depend on one another, and M is not symmetric: Lemke's method has no basis to start from.
    #[error("the rows with z > 0 depend on one another: for an M that is not symmetric, start from a basic solution")]
    Dependent,
}
