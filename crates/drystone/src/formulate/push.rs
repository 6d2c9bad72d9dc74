//! The load that is added: forces and moments on blocks, or an acceleration of all.

use super::{Assemble, Assembly, BlockSet};
use crate::{bounds::PUSH, error::SceneError, load::check_gravity, scene::SceneOf};

/// `F1`: a wrench on each movable block, block after block, as [`Assembly::applied`] has them.
#[derive(Debug, Clone, PartialEq)]
pub struct Push {
    wrenches: Vec<f64>,
}

/// What a push is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct PushOf<V> {
    /// Block, force on its centroid (N, world axes) and moment beside it (N m, about the axes of the world; in the plane the last).
    pub forces: Vec<(String, V, [f64; 3])>,
    /// Added to gravity, m/s^2.
    pub gravity: Option<V>,
}

impl Push {
    /// A push on the blocks of a scene whose assembly this is, of which only those in the set are there.
    ///
    /// # Errors
    /// [`SceneError`] for an unknown block, one that is fixed or not there, and numbers out of bounds.
    pub fn new<S: Assemble>(
        assembly: &Assembly,
        scene: &SceneOf<S>,
        blocks: &BlockSet,
        of: &PushOf<S::Vector>,
    ) -> Result<Self, SceneError> {
        let size = assembly.components().len();
        let mut wrenches = vec![0.0; size * assembly.blocks()];
        let mut add = |block: usize, wrench: [f64; 6]| {
            let own = &mut wrenches[size * block..][..size];
            own.iter_mut().zip(assembly.components()).for_each(|(sum, &k)| *sum += wrench[k]);
        };
        if let Some(gravity) = of.gravity {
            check_gravity(&gravity)?;
            let [x, y, z] = S::in_space(gravity);
            for block in blocks.iter() {
                let mass = assembly.body(block).mass;
                add(block, [mass * x, mass * y, mass * z, 0.0, 0.0, 0.0]);
            }
        }
        for (name, force, moment) in &of.forces {
            let index = scene.index_of(name)?;
            let block = assembly.block_of(index).filter(|&block| blocks.contains(block));
            let block = block.ok_or_else(|| SceneError::NotMovable { name: name.clone() })?;
            for (axis, &value) in force.as_ref().iter().chain(moment).enumerate() {
                PUSH.check(format_args!("the push on \"{name}\": entry {axis}"), value)?;
            }
            let body = &scene.bodies()[index];
            let arm = S::in_space(S::turned(&body.pose, body.shape.centroid()));
            add(block, assembly.body(block).wrench_and_moment(S::in_space(*force), arm, *moment));
        }
        Ok(Self { wrenches })
    }

    /// A wrench on each block, in its six components.
    pub(crate) fn of_wrenches(assembly: &Assembly, on: impl Fn(usize) -> [f64; 6]) -> Self {
        let picked = |block: usize| {
            let wrench = on(block);
            assembly.components().iter().map(move |&k| wrench[k])
        };
        Self { wrenches: (0..assembly.blocks()).flat_map(picked).collect() }
    }

    /// What would press every contact of these blocks with a unit force along its normal, the other way.
    pub(crate) fn parting(assembly: &Assembly, blocks: &BlockSet) -> Self {
        let mut wrenches = vec![[0.0; 6]; assembly.blocks()];
        for contact in assembly.contacts() {
            let there = contact.bodies.map(|body| assembly.block_of(body));
            if there.iter().flatten().any(|&block| !blocks.contains(block)) {
                continue;
            }
            // The contact's force on its second body is the normal; it takes up the opposite of the push.
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let Some(block) = there[side] else { continue };
                let wrench = assembly.body(block).wrench(contact.normal.map(|n| sign * n), contact.point);
                (0..6).for_each(|k| wrenches[block][k] += wrench[k]);
            }
        }
        Self::of_wrenches(assembly, |block| wrenches[block])
    }

    /// `a` times this and `b` times another.
    pub(crate) fn plus(&self, a: f64, other: &Self, b: f64) -> Self {
        let both = self.wrenches.iter().zip(&other.wrenches);
        Self { wrenches: both.map(|(x, y)| a * x + b * y).collect() }
    }

    /// Some pushes together, each times a factor.
    pub(crate) fn sum(assembly: &Assembly, pushes: &[Self], factors: &[f64]) -> Self {
        let none = Self::of_wrenches(assembly, |_| [0.0; 6]);
        pushes.iter().zip(factors).fold(none, |sum, (push, factor)| sum.plus(1.0, push, *factor))
    }

    /// Weights sideways as weights: along gravity again, in the plane. The moments of weights are none.
    pub(crate) fn turned(&self, assembly: &Assembly, right: [f64; 3]) -> Self {
        let size = assembly.components().len();
        let down = [right[1], -right[0], 0.0];
        Self::of_wrenches(assembly, |block| {
            let own = self.on(block, size);
            let weight = own[0] * right[0] + own[1] * right[1];
            [weight * down[0], weight * down[1], 0.0, 0.0, 0.0, 0.0]
        })
    }

    /// All wrenches.
    pub fn wrenches(&self) -> &[f64] {
        &self.wrenches
    }

    /// The wrench on a block.
    pub fn on(&self, block: usize, size: usize) -> &[f64] {
        &self.wrenches[size * block..size * (block + 1)]
    }

    /// Whether it does not push at all.
    pub fn is_none(&self) -> bool {
        self.wrenches.iter().all(|&entry| entry == 0.0)
    }

    /// The push the other way.
    pub fn reversed(&self) -> Self {
        Self { wrenches: self.wrenches.iter().map(|entry| -entry).collect() }
    }
}

impl Assembly {
    /// The same under so much of a push more.
    pub(crate) fn pushed(&self, push: &Push, factor: f64) -> Self {
        let size = self.components().len();
        let wrench = |block: usize| {
            let mut wrench = [0.0; 6];
            let own = push.on(block, size).iter().zip(self.components());
            own.for_each(|(entry, &k)| wrench[k] = factor * entry);
            wrench
        };
        self.with_loads(wrench)
    }

    /// The same with one push for all load.
    pub(crate) fn only(&self, push: &Push, factor: f64) -> Self {
        self.unloaded().pushed(push, factor)
    }
}
