//! Forces that balance without any load, and on which settling supports do work.
//!
//! ```text
//! G f = 0,   c' f = -1,   f >= 0
//! ```
//!
//! with c as in `settle`: one more row of the equilibrium. Such forces prove that no displacement u has `G' u + c >= 0`, for that would
//! give `0 = u' G f >= -c' f = 1` (Farkas).

use super::{Assembly, BlockSet, Generator};
use drystone_lcp::cone::{Columns, ConeSolver, Membership};

impl Assembly {
    /// Whether blocks are squeezed by the supports that settle, with such forces along the generators if they are.
    pub(crate) fn squeeze(&self, blocks: &BlockSet) -> (Membership, ConeSolver) {
        let components = self.components();
        let last = components.len() * self.blocks();
        let opened: Vec<f64> = self.generators().iter().map(|generator| self.opened_by_supports(generator)).collect();
        let largest = opened.iter().fold(f64::MIN_POSITIVE, |most, c| most.max(c.abs()));
        let (starts, rows, values) = self.compressed(self.generators().iter());
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for (j, c) in opened.iter().enumerate() {
            let own = starts[j]..starts[j + 1];
            indices.extend_from_slice(&rows[own.clone()]);
            data.extend_from_slice(&values[own]);
            indices.push(last);
            data.push(c / largest);
            indptr.push(indices.len());
        }
        let columns = Columns::new(last + 1, &indptr, &indices, &data)
            .expect("a validated scene has finite positions and directions");
        let unit = |(block, k): (usize, usize)| if k < 3 { 1.0 } else { self.body(block).radius };
        let of_all = (0..self.blocks()).flat_map(|block| components.iter().map(move |&k| (block, k)));
        let units: Vec<f64> = of_all.map(unit).chain([1.0]).collect();
        let mut work = vec![0.0; last + 1];
        work[last] = -1.0;
        let mut solver = ConeSolver::new(columns, &work, &units).expect("the numbers are finite");
        let rows = self.equilibrium_rows();
        blocks.iter().for_each(|block| solver.add_rows(rows.of(block)));
        solver.add_rows(&[last]);
        (solver.solve(), solver)
    }

    /// How far the settlements of supports open a contact along a generator, metres.
    fn opened_by_supports(&self, generator: &Generator) -> f64 {
        let contact = &self.contacts()[generator.contact()];
        let along = |(body, sign): (usize, f64)| {
            let part = &self.bodies()[body];
            let wrench = part.wrench(generator.direction.map(|x| sign * x), contact.point);
            wrench.iter().zip(&part.settlement).map(|(force, moved)| force * moved).sum::<f64>()
        };
        contact.bodies.into_iter().zip([-1.0, 1.0]).map(along).sum()
    }
}
