//! What a load takedown takes of a structure: loads, and normal forces at contact points.

use crate::{
    contact::Contact,
    formulate::{Assembly, Components},
    geometry::dot,
};

/// Blocks with their loads, and the points at which they touch. Wrenches have `size` numbers, 3 in the plane and 6 in space.
#[derive(Debug, Default)]
pub(crate) struct Stack {
    pub size: usize,
    /// Blocks from the supports upward.
    pub upward: Vec<usize>,
    /// Load on each block: N and N m, or N s and N m s in a step.
    pub loads: Vec<Components>,
    /// Unit in which the balance of each is measured.
    pub units: Vec<Components>,
    pub touching: Vec<Touching>,
}

/// A contact point.
#[derive(Debug)]
pub(crate) struct Touching {
    /// None for a fixed body.
    pub blocks: [Option<usize>; 2],
    /// Wrench on each of the two of a unit force along the normal, which pushes them apart.
    pub wrenches: [Components; 2],
    /// By how much the normal rises into the second body, as a share of its length.
    pub rise: f64,
}

impl Stack {
    /// The blocks and contact points of an assembly.
    pub fn of(assembly: &Assembly) -> Self {
        let gravity = assembly.gravity();
        let size = dot(gravity, gravity).sqrt();
        let components = assembly.components();
        let packed = |values: &mut dyn Iterator<Item = f64>| {
            let mut all = [0.0; 6];
            all.iter_mut().zip(values).for_each(|(entry, value)| *entry = value);
            all
        };
        let touching = |contact: &Contact| Touching {
            blocks: contact.bodies.map(|body| assembly.block_of(body)),
            wrenches: [(0, -1.0), (1, 1.0)].map(|(side, sign)| {
                let body = &assembly.bodies()[contact.bodies[side]];
                let wrench = body.wrench(contact.normal.map(|n| sign * n), contact.point);
                packed(&mut components.iter().map(|&k| wrench[k]))
            }),
            rise: -dot(contact.normal, gravity) / size,
        };
        Self {
            size: components.len(),
            upward: assembly.upward(),
            loads: (0..assembly.blocks()).map(|b| packed(&mut assembly.applied(b).iter().copied())).collect(),
            units: (0..assembly.blocks()).map(|b| packed(&mut assembly.balance_unit(b))).collect(),
            touching: assembly.contacts().iter().map(touching).collect(),
        }
    }

    /// The block at the other side of a contact point.
    pub fn other(&self, point: u32, block: usize) -> Option<usize> {
        self.touching[point as usize].blocks.into_iter().flatten().find(|&other| other != block)
    }

    /// The wrench on a block of a unit normal force at a contact point of its own.
    pub fn pushed(&self, point: u32, block: usize) -> &Components {
        let Touching { blocks, wrenches, .. } = &self.touching[point as usize];
        &wrenches[usize::from(blocks[1] == Some(block))]
    }
}
