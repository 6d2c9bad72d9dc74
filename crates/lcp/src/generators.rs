//! The problem of generators: forces `G f` with `f >= 0` on bodies of known mass.

use crate::{cone::Columns, error::LcpError, interrupt::poll, matrix::SparseColumns, problem::Problem};

impl Problem {
    /// `M = G' W G` and `q = -G' W h`: of all `f >= 0` the solution's `G f` is the nearest to `h` in the norm of W.
    ///
    /// For contacts, `G` (rows x n) holds the wrenches of unit forces, W the inverse masses and inverse moments of
    /// inertia of the bodies (its diagonal, one a row; zero for what cannot move), and `-h` the applied wrench: then `w` is the
    /// acceleration along each generator, and `w = 0` where the forces balance the loads. Equation 8 of Loomis
    /// and Balkcom, Computation reuse for rigid-body dynamics (2006).
    ///
    /// # Errors
    /// [`LcpError::GeneratorShape`], [`LcpError::InverseMass`], [`LcpError::LoadNotFinite`]; as [`Self::new`] if a
    /// product is too large for a number.
    pub fn from_generators(g: &Columns, inverse_mass: &[f64], h: &[f64]) -> Result<Self, LcpError> {
        require_fit(g, inverse_mass, h)?;
        let along = |j: usize| -> f64 {
            let column = g.column(j as u32).iter();
            column.map(|&(row, value)| value * inverse_mass[row as usize] * h[row as usize]).sum()
        };
        Self::of_gram(gram(g, inverse_mass)?, (0..g.len()).map(|j| -along(j)).collect())
    }

    /// `M = G' W G` with any `q` (n): generators as in [`Self::from_generators`] under loads given along each of them.
    ///
    /// # Errors
    /// [`LcpError::GeneratorShape`], [`LcpError::InverseMass`]; as [`Self::new`] for `q`.
    pub fn from_generators_and_q(g: &Columns, inverse_mass: &[f64], q: Vec<f64>) -> Result<Self, LcpError> {
        require_weights(g, inverse_mass, g.rows())?;
        Self::of_gram(gram(g, inverse_mass)?, q)
    }

    /// The same where only the generators in `moved` (n) are other than those of this problem, with entries in the rows that
    /// they had. Every number is the one that [`Self::from_generators_and_q`] gives, to the bit; products of two generators
    /// that did not move are not made again.
    ///
    /// # Errors
    /// As [`Self::from_generators_and_q`].
    pub fn with_moved_generators(
        &self,
        g: &Columns,
        moved: &[bool],
        inverse_mass: &[f64],
        q: Vec<f64>,
    ) -> Result<Self, LcpError> {
        if !self.is_gram() || moved.len() != self.len() || g.len() != self.len() {
            return Self::from_generators_and_q(g, inverse_mass, q);
        }
        require_weights(g, inverse_mass, g.rows())?;
        let mut m = self.m().clone();
        let mut products = Products::new(g, inverse_mass);
        for j in (0..g.len()).filter(|&j| moved[j]) {
            products.multiply(j);
            if !m.replace_symmetrically(j, &products.reached, &products.sum) {
                return Self::from_generators_and_q(g, inverse_mass, q);
            }
        }
        Self::of_gram(m.finite()?, q)
    }
}

/// `G' W G`, symmetric to the last bit.
fn gram(g: &Columns, inverse_mass: &[f64]) -> Result<SparseColumns, LcpError> {
    let n = g.len();
    let most = (0..n).flat_map(|j| g.column(j as u32)).map(|&(row, _)| g.columns_of(row).len()).sum();
    let mut indptr = Vec::with_capacity(n + 1);
    let (mut indices, mut data) = (Vec::with_capacity(most), Vec::with_capacity(most));
    indptr.push(0);
    let mut products = Products::new(g, inverse_mass);
    for j in 0..n {
        products.multiply(j);
        indices.extend_from_slice(&products.reached);
        data.extend(products.reached.iter().map(|&i| products.sum[i]));
        indptr.push(indices.len());
    }
    SparseColumns::sorted(indptr, indices, data)
}

/// Operations for an entry of a column, sorting included, about.
const SORTED: usize = 16;

/// One column of `G' W G` at a time.
struct Products<'a> {
    g: &'a Columns,
    inverse_mass: &'a [f64],
    /// The column (n), where it may differ from zero.
    sum: Vec<f64>,
    /// Where that is, ascending.
    reached: Vec<usize>,
    /// The column for which each entry was begun last.
    begun: Vec<usize>,
}

impl<'a> Products<'a> {
    fn new(g: &'a Columns, inverse_mass: &'a [f64]) -> Self {
        let n = g.len();
        Self { g, inverse_mass, sum: vec![0.0; n], reached: Vec::new(), begun: vec![usize::MAX; n] }
    }

    fn multiply(&mut self, j: usize) {
        self.reached.clear();
        for &(row, value) in self.g.column(j as u32) {
            let weight = self.inverse_mass[row as usize];
            for &(i, other) in self.g.columns_of(row) {
                let i = i as usize;
                if std::mem::replace(&mut self.begun[i], j) != j {
                    self.sum[i] = 0.0;
                    self.reached.push(i);
                }
                // The two values first: the product is then the same for [i, j] and [j, i].
                self.sum[i] += other * value * weight;
            }
        }
        self.reached.sort_unstable();
        poll(SORTED * self.reached.len());
    }
}

fn require_fit(g: &Columns, inverse_mass: &[f64], h: &[f64]) -> Result<(), LcpError> {
    require_weights(g, inverse_mass, h.len())?;
    match h.iter().position(|value| !value.is_finite()) {
        Some(row) => Err(LcpError::LoadNotFinite { row, value: h[row] }),
        None => Ok(()),
    }
}

fn require_weights(g: &Columns, inverse_mass: &[f64], loads: usize) -> Result<(), LcpError> {
    let inverse_masses = inverse_mass.len();
    if inverse_masses != g.rows() || loads != g.rows() {
        return Err(LcpError::GeneratorShape { rows: g.rows(), inverse_masses, loads });
    }
    match inverse_mass.iter().position(|value| !value.is_finite() || *value < 0.0) {
        Some(row) => Err(LcpError::InverseMass { row, value: inverse_mass[row] }),
        None => Ok(()),
    }
}
