//! A problem given by matrices: any symmetric positive definite M, as of articulated or deformable bodies.

use crate::{
    cholesky::Cholesky,
    error::ContactError,
    problem::{all_finite, check_law},
    settings::Settings,
    solution::Solution,
    solving::{Solved, answer, solve},
    system::System,
};
use drystone_lcp::{SparseColumns, cone::Columns, interrupt::poll};
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::amd},
};

/// One step's contact problem by its matrices.
#[derive(Debug, Clone)]
pub struct Matrices {
    /// Components of a contact's impulse: 2 in the plane, 3 in space.
    pub dimension: usize,
    /// M (n, n), symmetric positive definite.
    pub mass: SparseColumns,
    /// `J'` (n, dimension contacts): rows of J as columns, contact after contact, the normal first, then tangents square to it and to
    /// one another.
    pub jacobian: Columns,
    /// mu of every contact, not negative; what is above [`MOST_FRICTION`](crate::MOST_FRICTION) counts as that.
    pub friction: Vec<f64>,
    /// `v*` (n,), the velocities without contacts.
    pub free: Vec<f64>,
    /// c of every contact: how fast it may close, m/s.
    pub offsets: Vec<f64>,
}

/// Share of an entry of M by which the one across the diagonal may differ: what sums in another order make of them.
const SYMMETRIC: f64 = 1e-9;
/// Unknowns of a chunk.
const CHUNK: [usize; 2] = [3, 6];
/// Unknowns coupled by M from which on their order is sought.
const LARGE: usize = 32;

impl Matrices {
    /// Solves it. `start`: impulses to begin from, contact after contact, such as those of the step before.
    ///
    /// # Errors
    /// [`ContactError`] for bad input. A problem without a solution, or one that was not found, is a [`Status`](crate::Status).
    pub fn solve(&self, start: Option<&[f64]>, settings: &Settings) -> Result<Solution, ContactError> {
        self.check()?;
        if self.dimension == 2 {
            self.run::<{ CHUNK[0] }, 2>(start, settings)
        } else {
            self.run::<{ CHUNK[1] }, 3>(start, settings)
        }
    }

    fn check(&self) -> Result<(), ContactError> {
        if self.dimension != 2 && self.dimension != 3 {
            return Err(ContactError::Dimension { dimension: self.dimension });
        }
        let (n, contacts) = (self.mass.len(), self.friction.len());
        let lengths = [
            ("free", self.free.len(), n),
            ("a row of J", self.jacobian.rows(), n),
            ("J (its rows)", self.jacobian.len(), self.dimension * contacts),
            ("offset", self.offsets.len(), contacts),
        ];
        if let Some(&(what, found, expected)) = lengths.iter().find(|(_, found, expected)| found != expected) {
            return Err(ContactError::Length { what, found, expected });
        }
        all_finite("free", &self.free)?;
        self.check_symmetry()?;
        (0..contacts).try_for_each(|k| check_law(k, self.friction[k], self.offsets[k]))
    }

    fn check_symmetry(&self) -> Result<(), ContactError> {
        for column in 0..self.mass.len() {
            let (rows, values) = self.mass.column(column);
            for (&row, &value) in rows.iter().zip(values) {
                let (others, mirrored) = self.mass.column(row);
                let other = others.binary_search(&column).map_or(0.0, |at| mirrored[at]);
                if (value - other).abs() > SYMMETRIC * value.abs().max(other.abs()) {
                    let reason = format!("entry [{row}, {column}] is {value}, entry [{column}, {row}] is {other}");
                    return Err(ContactError::MassMatrix { reason });
                }
            }
        }
        Ok(())
    }

    fn run<const B: usize, const D: usize>(
        &self,
        start: Option<&[f64]>,
        settings: &Settings,
    ) -> Result<Solution, ContactError> {
        let parts = self.parts()?;
        // Where each unknown is: its part, and its place there; and where each part begins.
        let mut place = vec![(0, 0); self.free.len()];
        let (mut begins, mut end) = (Vec::with_capacity(parts.len()), 0_usize);
        for (index, part) in parts.iter().enumerate() {
            let size = part.unknowns.len();
            part.unknowns.iter().enumerate().for_each(|(at, &unknown)| place[unknown] = (index, at));
            // Small ones share a chunk: a body whose M is diagonal is one.
            if end % B + size > B {
                end = end.next_multiple_of(B);
            }
            begins.push(end);
            end += size;
        }
        let mut free = vec![[0.0; B]; end.div_ceil(B)];
        for (part, begin) in parts.iter().zip(&begins) {
            let mut y: Vec<f64> = part.unknowns.iter().map(|&unknown| self.free[unknown]).collect();
            part.factor.times_transpose(&mut y);
            y.iter().enumerate().for_each(|(at, y)| free[(begin + at) / B][(begin + at) % B] = *y);
        }
        let mut system = System::<B, D>::new(free);
        for k in 0..self.friction.len() {
            let sides = self.sides::<B, D>(k, &parts, &place, &begins);
            system.push(self.friction[k], self.offsets[k], sides.into_iter());
        }
        let solved = solve(&system, start, settings)?;
        let velocities = self.velocities(&solved, &system.free, &parts, &begins);
        Ok(answer(solved, velocities))
    }

    /// `v* + L^-T (y - y*)`: what no contact moves keeps its bits.
    fn velocities<const B: usize>(
        &self,
        solved: &Solved<B>,
        free: &[[f64; B]],
        parts: &[Part],
        begins: &[usize],
    ) -> Vec<f64> {
        let mut velocities = self.free.clone();
        for (part, &begin) in parts.iter().zip(begins) {
            let gained = |at: usize| solved.y[at / B][at % B] - free[at / B][at % B];
            let mut change: Vec<f64> = (begin..begin + part.unknowns.len()).map(gained).collect();
            part.factor.backward(&mut change);
            part.unknowns.iter().zip(&change).for_each(|(&unknown, change)| velocities[unknown] += change);
        }
        velocities
    }

    /// Rows of a contact on the chunks that it touches: `J L^-T`.
    fn sides<const B: usize, const D: usize>(
        &self,
        contact: usize,
        parts: &[Part],
        place: &[(usize, usize)],
        begins: &[usize],
    ) -> Vec<(usize, [[f64; B]; D])> {
        let mut touched: Vec<usize> = (0..D)
            .flat_map(|d| self.jacobian.column((D * contact + d) as u32))
            .map(|&(unknown, _)| place[unknown as usize].0)
            .collect();
        touched.sort_unstable();
        touched.dedup();
        let mut sides: Vec<(usize, [[f64; B]; D])> = Vec::new();
        for index in touched {
            let (part, begin) = (&parts[index], begins[index]);
            poll(8 * D * part.unknowns.len());
            for d in 0..D {
                let mut row = vec![0.0; part.unknowns.len()];
                for &(unknown, value) in self.jacobian.column((D * contact + d) as u32) {
                    let (own, at) = place[unknown as usize];
                    if own == index {
                        row[at] = value;
                    }
                }
                part.factor.forward(&mut row);
                for (at, x) in row.into_iter().enumerate().filter(|(_, x)| *x != 0.0) {
                    let (chunk, at) = ((begin + at) / B, (begin + at) % B);
                    let side = match sides.binary_search_by_key(&chunk, |side| side.0) {
                        Ok(side) => side,
                        Err(side) => {
                            sides.insert(side, (chunk, [[0.0; B]; D]));
                            side
                        }
                    };
                    sides[side].1[d][at] = x;
                }
            }
        }
        sides
    }

    /// What M couples, each with its factor.
    fn parts(&self) -> Result<Vec<Part>, ContactError> {
        let n = self.mass.len();
        let mut parent: Vec<usize> = (0..n).collect();
        for column in 0..n {
            for &row in self.mass.column(column).0 {
                let (a, b) = (root(&mut parent, column), root(&mut parent, row));
                parent[a.max(b)] = a.min(b);
            }
        }
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); n];
        (0..n).for_each(|unknown| members[root(&mut parent, unknown)].push(unknown));
        let mut place = vec![0; n];
        let made = members.into_iter().filter(|members| !members.is_empty()).map(|members| {
            let unknowns = if members.len() > LARGE { self.ordered(members, &mut place)? } else { members };
            unknowns.iter().enumerate().for_each(|(at, &unknown)| place[unknown] = at);
            let row = |&unknown: &usize| -> Vec<(u32, f64)> {
                let (others, values) = self.mass.column(unknown);
                let below = others.iter().zip(values).filter(|&(&other, _)| place[other] <= place[unknown]);
                below.map(|(&other, &value)| (place[other] as u32, value)).collect()
            };
            let rows: Vec<_> = unknowns.iter().map(row).collect();
            let reason = || format!("a pivot is not positive among the unknowns that M couples with {}", unknowns[0]);
            let factor = Cholesky::new(&rows).ok_or_else(|| ContactError::MassMatrix { reason: reason() })?;
            Ok(Part { unknowns, factor })
        });
        made.collect()
    }

    /// Unknowns in an order of elimination of little fill: approximate minimum degree.
    fn ordered(&self, members: Vec<usize>, place: &mut [usize]) -> Result<Vec<usize>, ContactError> {
        let count = members.len();
        members.iter().enumerate().for_each(|(at, &unknown)| place[unknown] = at);
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for &unknown in &members {
            rows.extend(self.mass.column(unknown).0.iter().map(|&row| place[row]));
            let begun = starts[starts.len() - 1];
            rows[begun..].sort_unstable();
            starts.push(rows.len());
        }
        let (mut order, mut inverse) = (vec![0; count], vec![0; count]);
        let pattern = SymbolicSparseColMatRef::new_checked(count, count, &starts, None, &rows);
        let memory = || ContactError::MassMatrix { reason: "there is no memory for its factor".into() };
        let mut buffer = MemBuffer::try_new(amd::order_scratch::<usize>(count, rows.len())).map_err(|_| memory())?;
        let stack = MemStack::new(&mut buffer);
        amd::order(&mut order, &mut inverse, pattern, amd::Control::default(), stack).map_err(|_| memory())?;
        Ok(order.into_iter().map(|at| members[at]).collect())
    }
}

/// Unknowns that M couples, in the order of elimination.
struct Part {
    unknowns: Vec<usize>,
    factor: Cholesky,
}

fn root(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}
