//! A mechanism, and the cases that it brings down.

use super::ends::End;
use crate::{
    formulate::{Acceleration, Assembly, Components, Push},
    geometry::length,
    judgement::{MARGIN, ROUNDING},
};

/// The power of all loads in a mechanism, in which contacts open or stay closed.
#[derive(Debug)]
pub(super) struct Fall {
    /// Of the own loads, and of each load that has a factor.
    own: f64,
    of_loads: Vec<f64>,
    /// What rounding, and contacts that close by rounding, could make of the forces under the own loads, and under each of the others.
    rounding: f64,
    rounding_of_loads: Vec<f64>,
}

impl Fall {
    /// Of the end of a limit of `there`; None if it has no mechanism.
    pub fn of_end(assembly: &Assembly, there: &Assembly, loads: &[Push], end: &End) -> Option<Self> {
        if end.motion.is_empty() {
            return None;
        }
        let own = |(body, v): &(usize, Acceleration)| Some((assembly.block_of(*body)?, along(assembly, *body, v)));
        let motion: Vec<(usize, Components)> = end.motion.iter().filter_map(own).collect();
        let forces = end.forces.iter().map(|(_, force)| length(force.force)).sum();
        Some(Self::new(assembly, there, loads, &motion, end.closing, forces))
    }

    /// Of a motion in which a contact closes by so much, of its fastest point. `forces` are the sizes of all that hold `there`, N.
    pub fn new(
        assembly: &Assembly,
        there: &Assembly,
        loads: &[Push],
        motion: &[(usize, Components)],
        closing: f64,
        forces: f64,
    ) -> Self {
        let size = assembly.components().len();
        let fastest = assembly.fastest(motion);
        let motion: Vec<(usize, Components)> =
            motion.iter().map(|(block, v)| (*block, v.map(|x| x / fastest))).collect();
        let power = |on: &dyn Fn(usize) -> Vec<f64>, part: &dyn Fn(f64) -> f64| -> f64 {
            let of = |(block, v): &(usize, Components)| {
                let terms = on(*block).into_iter().zip(assembly.components());
                terms.map(|(load, &k)| part(load * v[k])).sum::<f64>()
            };
            motion.iter().map(of).sum()
        };
        let applied = |block: usize| assembly.applied(block).to_vec();
        let pushed = |push: &Push| power(&|block| push.on(block, size).to_vec(), &|term| term);
        // What closes, and the forces that hold it there; forces grow as the loads do.
        let closes = (ROUNDING + closing) * forces;
        let total = |on: &dyn Fn(usize) -> Vec<f64>| -> f64 { (0..assembly.blocks()).flat_map(on).map(f64::abs).sum() };
        let at_end = total(&|block| there.applied(block).to_vec());
        let share = |load: f64| if at_end > 0.0 { closes * load / at_end } else { closes };
        let rounded = |on: &dyn Fn(usize) -> Vec<f64>| ROUNDING * power(on, &f64::abs) + share(total(on));
        Self {
            own: power(&applied, &|term| term),
            of_loads: loads.iter().map(pushed).collect(),
            rounding: MARGIN * rounded(&applied),
            rounding_of_loads: loads.iter().map(|push| MARGIN * rounded(&|b| push.on(b, size).to_vec())).collect(),
        }
    }

    /// Whether the loads do work in it.
    pub fn brings_down(&self, case: &[f64]) -> bool {
        let sum = |own: f64, each: &[f64], part: fn(f64) -> f64| -> f64 {
            own + case.iter().zip(each).map(|(factor, of_load)| part(*factor) * of_load).sum::<f64>()
        };
        sum(self.own, &self.of_loads, |x| x) > sum(self.rounding, &self.rounding_of_loads, f64::abs)
    }
}

/// A body's velocity along its own axes.
fn along(assembly: &Assembly, body: usize, velocity: &Acceleration) -> Components {
    let [x, y, z] = velocity.linear;
    let [a, b, c] = assembly.bodies()[body].along_axes(velocity.angular);
    [x, y, z, a, b, c]
}
