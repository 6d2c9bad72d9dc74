//! Does a growing stack stand with one more block?
//!
//! Every block kept left the stack standing. So the stack is put up once, in that order, and each block that may come
//! next is tried on it and taken off again. Only contacts of new blocks are looked for.

use super::{Placed, Rule, scene_of};
use crate::{
    error::SceneError,
    formulate::{Assembly, BlockRows, Components},
    structure::put_up,
};
use drystone_lcp::cone::{Columns, ConeSolver, Mark, Membership};

/// Components of a wrench in the plane.
const PLANE: [usize; 3] = [0, 1, 5];

/// The equilibrium problem of the blocks kept so far, and of those that may come next.
pub(super) struct Standing {
    ground: i64,
    kept: Vec<Piece>,
    /// None for a block that overlaps others.
    next: Vec<Option<Piece>>,
    trial: Option<Trial>,
}

/// What a block brings to the equilibrium problem.
#[derive(Clone)]
struct Piece {
    /// Generators as wrenches on blocks by the order in which they were kept; None for the block itself.
    generators: Vec<Vec<(Option<usize>, Components)>>,
    load: Vec<f64>,
    /// In which its imbalance is measured.
    unit: Vec<f64>,
}

/// A solver with room for some more blocks, after the stack was put up in it.
struct Trial {
    bare: ConeSolver,
    solver: ConeSolver,
    standing: Mark,
    rows: BlockRows,
    /// Place among the blocks of each block that may come next.
    places: Vec<usize>,
}

impl Standing {
    /// Nothing on a ground of this width.
    pub fn on(ground: i64) -> Self {
        Self { ground, kept: Vec::new(), next: Vec::new(), trial: None }
    }

    /// Finds what a block touches. None if it overlaps something.
    fn piece(&self, placed: &[Placed], block: &Placed) -> Result<Option<Piece>, SceneError> {
        let near: Vec<usize> = (0..placed.len()).filter(|&k| placed[k].is_near(block)).collect();
        let scene = scene_of(self.ground, near.iter().map(|&k| &placed[k]).chain([block]))?;
        let Ok(assembly) = Assembly::new(&scene) else { return Ok(None) };
        let own = near.len();
        let wrenches = |j: &usize| {
            let wrenches = assembly.generators()[*j].wrenches.iter();
            wrenches.map(|wrench| (near.get(wrench.block).copied(), wrench.value)).collect()
        };
        Ok(Some(Piece {
            generators: assembly.generators_on(own).iter().map(wrenches).collect(),
            load: assembly.applied(own).to_vec(),
            unit: assembly.balance_unit(own).collect(),
        }))
    }

    /// The problem of the blocks kept and all that may come next, with the stack put up.
    fn put_up(&self) -> Trial {
        let pieces: Vec<&Piece> = self.kept.iter().chain(self.next.iter().flatten()).collect();
        let rows = BlockRows::of_components(&PLANE, pieces.len());
        let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
        for (own, piece) in pieces.iter().enumerate() {
            for generator in &piece.generators {
                for &(block, value) in generator {
                    let entries = rows.of(block.unwrap_or(own)).iter().zip(PLANE.map(|k| value[k]));
                    for (&row, value) in entries.filter(|&(_, value)| value != 0.0) {
                        indices.push(row);
                        data.push(value);
                    }
                }
                indptr.push(indices.len());
            }
        }
        let balance: Vec<f64> = pieces.iter().flat_map(|piece| piece.load.iter().map(|load| -load)).collect();
        let units: Vec<f64> = pieces.iter().flat_map(|piece| &piece.unit).copied().collect();
        let columns = Columns::new(PLANE.len() * pieces.len(), &indptr, &indices, &data);
        let bare = columns.and_then(|columns| ConeSolver::new(columns, &balance, &units));
        let bare = bare.expect("blocks of finite size");
        let mut solver = bare.clone();
        put_up(&mut solver, &rows, 0..self.kept.len(), |_| true);
        solver.solve();
        let mut own = self.kept.len()..;
        let places = self.next.iter().map(|piece| match piece {
            Some(_) => own.next().unwrap_or_default(),
            None => usize::MAX,
        });
        Trial { places: places.collect(), rows, standing: solver.mark(), solver, bare }
    }
}

impl Rule for Standing {
    fn expect(&mut self, placed: &[Placed], next: &[Option<Placed>]) -> Result<(), SceneError> {
        let pieces = next.iter().map(|block| match block {
            Some(block) => self.piece(placed, block),
            None => Ok(None),
        });
        self.next = pieces.collect::<Result<_, _>>()?;
        self.trial = Some(self.put_up());
        Ok(())
    }

    fn stands(&mut self, _placed: &[Placed], _block: &Placed, index: usize) -> Result<bool, SceneError> {
        let Some(trial) = self.trial.as_mut().filter(|_| self.next[index].is_some()) else { return Ok(false) };
        trial.solver.add_rows(trial.rows.of(trial.places[index]));
        let found = trial.solver.solve();
        trial.solver.roll_back(trial.standing);
        Ok(found == Membership::Inside)
    }

    fn stands_on_lower(&mut self, placed: &[Placed], block: &Placed, index: usize) -> Result<bool, SceneError> {
        let Some(trial) = self.trial.as_ref().filter(|_| self.next[index].is_some()) else { return Ok(false) };
        let mut solver = trial.bare.clone();
        put_up(&mut solver, &trial.rows, (0..placed.len()).filter(|&k| placed[k].is_lower_than(block)), |_| true);
        solver.decide();
        solver.add_rows(trial.rows.of(trial.places[index]));
        Ok(solver.solve() == Membership::Inside)
    }

    fn keep(&mut self, index: usize) {
        let own = self.kept.len();
        self.kept.extend(self.next[index].take().map(|mut piece| {
            piece.generators.iter_mut().flatten().for_each(|(block, _)| *block = Some(block.unwrap_or(own)));
            piece
        }));
    }
}
