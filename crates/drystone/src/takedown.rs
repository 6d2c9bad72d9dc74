//! Load takedown: a proof of standing, block by block, for structures that bear by straight pressure.
//!
//! ```text
//! G_b x = -F_b,   x >= 0      own load of block b, on its bearings                      (1)
//! G_b x = n_c,    x >= 0      a unit normal force n_c of a block above, at a point c    (2)
//! ```
//!
//! A *bearing* of a block is a contact point below it whose normal force the body there takes up: a fixed body takes up any; a
//! block does if (2) has a solution on its own bearings. A block *bears* if (1) has one. Each of these is a small problem of its
//! own, solved once, from the supports upward.
//!
//! *Lemma.* Let S stand, and let b bear, with all blocks in S that its load passes through on the way to fixed bodies. Then S
//! with b stands. *Proof.* Follow b's load down: (1) gives forces on its bearings, (2) for each of these forces on the bearings of the
//! block below, and so on; blocks below are fewer each time. All of them are normal forces, not negative, and balance the load
//! of b. Cones are convex: added to the forces that hold S they hold S with b.
//!
//! So a plan of a wall needs no test for each block, and a wall of thousands of blocks no factor. What leans on friction, or is
//! held down by what lies on it, does not bear in this sense; other methods decide then. Engineers call the same way of following
//! loads from the top to the ground a load takedown. docs/theory/load-takedown.md

use crate::{
    contact::Contact,
    formulate::{Assembly, BlockSet, Components, ContactForce},
    geometry::dot,
    interrupt::poll,
};
use drystone_lcp::cone::{Columns, ConeSolver, Membership};

/// Normal forces at contact points: (contact, N).
type Passed = Vec<(u32, f64)>;

/// How each block of an assembly passes loads on to those below it.
#[derive(Debug)]
pub(crate) struct Takedown {
    /// Blocks from the supports upward.
    upward: Vec<usize>,
    /// Of each block that bears: (1).
    own: Vec<Option<Passed>>,
    /// Of each contact point: (2) on the block below, for 1 N; None where that takes up nothing there.
    through: Vec<Option<Passed>>,
    /// Of each block the blocks below its bearings.
    below: Vec<Vec<usize>>,
    /// Of each block its bearings, ascending.
    bearings: Vec<Vec<u32>>,
}

/// Most that rounding may leave of a load: a hundredth of what counts as rest, so that a load may pass many blocks.
const LEFT: f64 = 1e-11;

/// A bearing's normal rises by more than this share of its length: what stands beside a block bears nothing of it.
const RISES: f64 = 1e-3;

/// Operations of a small problem, about.
const SMALL: usize = 1 << 12;

impl Takedown {
    /// Solves (1) and (2) for all blocks.
    pub fn new(assembly: &Assembly) -> Self {
        Self::unless(assembly, |_| false).expect("nothing ends it")
    }

    /// The same if all blocks of a sub-assembly bear; None as soon as one does not.
    pub fn of_bearing(assembly: &Assembly, blocks: &BlockSet) -> Option<Self> {
        Self::unless(assembly, |block| blocks.contains(block))
    }

    /// None as soon as a block does not bear of which `needed` says that it has to.
    fn unless(assembly: &Assembly, needed: impl Fn(usize) -> bool) -> Option<Self> {
        let (blocks, contacts) = (assembly.blocks(), assembly.contacts());
        let upward = assembly.upward();
        let mut place = vec![0; blocks];
        upward.iter().enumerate().for_each(|(k, &block)| place[block] = k);
        // Points under each block, and those on it.
        let (mut under, mut on) = (vec![Vec::new(); blocks], vec![Vec::new(); blocks]);
        for (index, contact) in contacts.iter().enumerate() {
            if let Some((upper, lower)) = stacked(assembly, contact, &place) {
                under[upper].push(index as u32);
                lower.into_iter().for_each(|lower| on[lower].push(index as u32));
            }
        }
        let mut found = Self {
            own: vec![None; blocks],
            through: vec![None; contacts.len()],
            below: vec![Vec::new(); blocks],
            bearings: vec![Vec::new(); blocks],
            upward,
        };
        for k in 0..blocks {
            let block = found.upward[k];
            poll(SMALL * (1 + on[block].len()));
            found.settle(assembly, block, &under[block], &on[block]);
            if found.own[block].is_none() && needed(block) {
                return None;
            }
        }
        Some(found)
    }

    /// Solves the problems of a block, those below it being solved.
    fn settle(&mut self, assembly: &Assembly, block: usize, under: &[u32], on: &[u32]) {
        let contacts = assembly.contacts();
        let lower = |contact: u32| other(assembly, &contacts[contact as usize], block);
        let bears = |&contact: &u32| lower(contact).is_none() || self.through[contact as usize].is_some();
        let bearings: Vec<u32> = under.iter().copied().filter(bears).collect();
        let columns: Vec<Components> = bearings.iter().map(|&c| pushed(assembly, c, block, 1.0)).collect();
        let mut load = [0.0; 6];
        assembly.components().iter().zip(assembly.applied(block)).for_each(|(&k, applied)| load[k] = *applied);
        let solve = |load: &Components| -> Option<Passed> {
            let forces = balanced(assembly, block, &columns, load)?;
            let used = bearings.iter().zip(forces).filter(|(_, force)| *force > 0.0);
            Some(used.map(|(&contact, force)| (contact, force)).collect())
        };
        self.own[block] = solve(&load);
        if self.own[block].is_some() {
            for &contact in on {
                self.through[contact as usize] = solve(&pushed(assembly, contact, block, 1.0));
            }
        }
        let mut below: Vec<usize> = bearings.iter().filter_map(|&contact| lower(contact)).collect();
        below.sort_unstable();
        below.dedup();
        (self.below[block], self.bearings[block]) = (below, bearings);
    }

    /// Whether a block bears, if all blocks below its bearings do (`carried` says so) on the way to fixed bodies.
    pub fn bears(&self, block: usize, carried: impl Fn(usize) -> bool) -> bool {
        self.own[block].is_some() && self.below[block].iter().all(|&below| carried(below))
    }

    /// Forces that hold a sub-assembly, of all contact points between its blocks; None if some block does not bear in it.
    pub fn forces(&self, assembly: &Assembly, blocks: &BlockSet) -> Option<Vec<ContactForce>> {
        let mut carried = BlockSet::empty(assembly.blocks());
        for &block in self.upward.iter().filter(|&&block| blocks.contains(block)) {
            if !self.bears(block, |below| carried.contains(below)) {
                return None;
            }
            carried.insert(block);
        }
        let contacts = assembly.contacts();
        let mut along = vec![0.0; contacts.len()];
        let mut on: Vec<Vec<usize>> = vec![Vec::new(); assembly.blocks()];
        for &block in self.upward.iter().rev().filter(|&&block| blocks.contains(block)) {
            pass(self.own[block].as_ref()?, 1.0, &mut along);
            // What blocks above have passed on is complete.
            for contact in std::mem::take(&mut on[block]) {
                let force = along[contact];
                if force > 0.0 {
                    pass(self.through[contact].as_ref()?, force, &mut along);
                }
            }
            for &contact in &self.bearings[block] {
                if let Some(lower) = other(assembly, &contacts[contact as usize], block) {
                    on[lower].push(contact as usize);
                }
            }
        }
        let between = |contact: &Contact| {
            contact.bodies.iter().filter_map(|&body| assembly.block_of(body)).all(|block| blocks.contains(block))
        };
        let there = contacts.iter().zip(along).enumerate().filter(|(_, (contact, _))| between(contact));
        Some(there.map(|(index, (_, along))| assembly.normal_force(index, along)).collect())
    }
}

fn pass(passed: &Passed, force: f64, along: &mut [f64]) {
    passed.iter().for_each(|&(contact, share)| along[contact as usize] += share * force);
}

/// The block above a contact point, and the one below unless that is a fixed body. None if they are side by side, or nothing
/// that moves is above.
fn stacked(assembly: &Assembly, contact: &Contact, place: &[usize]) -> Option<(usize, Option<usize>)> {
    let blocks = contact.bodies.map(|body| assembly.block_of(body));
    let rise = -dot(contact.normal, assembly.gravity()); // of the normal, into the second body
    let [lower, upper] = if rise > 0.0 { blocks } else { [blocks[1], blocks[0]] };
    let steep = rise.abs() > RISES * dot(assembly.gravity(), assembly.gravity()).sqrt();
    let upper = upper.filter(|_| steep)?;
    lower.is_none_or(|lower| place[lower] < place[upper]).then_some((upper, lower))
}

/// The block at the other side of a contact.
fn other(assembly: &Assembly, contact: &Contact, block: usize) -> Option<usize> {
    contact.bodies.iter().filter_map(|&body| assembly.block_of(body)).find(|&other| other != block)
}

/// The wrench of a normal force on a block at a contact point of its own.
fn pushed(assembly: &Assembly, contact: u32, block: usize, force: f64) -> Components {
    let contact = &assembly.contacts()[contact as usize];
    let second = assembly.body_index(block) == contact.bodies[1];
    assembly.body(block).wrench(contact.normal.map(|n| if second { force * n } else { -force * n }), contact.point)
}

/// Magnitudes of columns that balance a load on a block.
fn balanced(assembly: &Assembly, block: usize, columns: &[Components], load: &Components) -> Option<Vec<f64>> {
    let rows = assembly.components();
    let units: Vec<f64> = assembly.balance_unit(block).collect();
    let size = rows.iter().zip(&units).fold(0.0_f64, |size, (&k, unit)| size.max(load[k].abs() / unit));
    if size == 0.0 {
        return Some(vec![0.0; columns.len()]);
    }
    let (mut indptr, mut indices, mut data) = (vec![0], Vec::new(), Vec::new());
    for column in columns {
        for (row, &k) in rows.iter().enumerate().filter(|&(_, &k)| column[k] != 0.0) {
            indices.push(row);
            data.push(column[k]);
        }
        indptr.push(indices.len());
    }
    let h: Vec<f64> = rows.iter().map(|&k| -load[k] / size).collect();
    let columns_of = Columns::new(rows.len(), &indptr, &indices, &data).ok()?;
    let mut solver = ConeSolver::new(columns_of, &h, &units).ok()?;
    solver.add_rows(&(0..rows.len()).collect::<Vec<_>>());
    if solver.solve() != Membership::Inside {
        return None;
    }
    let forces: Vec<f64> = (0..columns.len()).map(|j| solver.f(j) * size).collect();
    let left = |(&k, unit): (&usize, &f64)| -> bool {
        let sum: f64 = columns.iter().zip(&forces).map(|(column, force)| column[k] * force).sum();
        (sum + load[k]).abs() <= LEFT * size * unit
    };
    rows.iter().zip(&units).all(left).then_some(forces)
}
