//! What forces and a motion prove, computed anew from bodies and contact points: nothing here is shared with a solver.

use crate::{
    contact::Contact,
    formulate::{Assembly, BlockSet, Components, ContactForce, FrictionCone},
    geometry::{cross, dot, length, minus},
    judgement::{CLOSING, MARGIN, ROUNDING, at_rest_under, severity},
};

/// Accelerations of blocks under contact forces, ascending.
pub(crate) fn accelerations_under(
    assembly: &Assembly,
    blocks: &BlockSet,
    forces: &[ContactForce],
) -> Vec<(usize, Components)> {
    let mut wrenches = vec![[0.0; 6]; assembly.blocks()];
    for force in forces {
        let contact = &assembly.contacts()[force.contact];
        for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let body = contact.bodies[side];
            if let Some(block) = assembly.block_of(body) {
                let wrench = assembly.bodies()[body].wrench(force.force.map(|f| sign * f), contact.point);
                (0..6).for_each(|k| wrenches[block][k] += wrench[k]);
            }
        }
    }
    let acceleration = |block: usize| {
        let mut acceleration = [0.0; 6];
        let own = assembly.applied(block).iter().zip(assembly.inverse_mass(block));
        for (&k, (load, inverse)) in assembly.components().iter().zip(own) {
            acceleration[k] = (load + wrenches[block][k]) * inverse;
        }
        (block, acceleration)
    };
    blocks.iter().map(acceleration).collect()
}

/// The largest force on each block, N.
fn largest_on_blocks(assembly: &Assembly, forces: &[ContactForce]) -> Vec<f64> {
    let mut largest = vec![0.0_f64; assembly.blocks()];
    for force in forces {
        for block in assembly.contacts()[force.contact].bodies.into_iter().filter_map(|body| assembly.block_of(body)) {
            largest[block] = largest[block].max(length(force.force));
        }
    }
    largest
}

/// The largest imbalance that forces leave of a block, as a share of its own load or of the largest force on it.
pub(crate) fn imbalance(assembly: &Assembly, blocks: &BlockSet, forces: &[ContactForce]) -> f64 {
    let largest = largest_on_blocks(assembly, forces);
    let share = |(block, acceleration): &(usize, Components)| {
        let own = assembly.unit_of_acceleration(*block);
        let in_loads = (largest[*block] * assembly.inverse_mass(*block)[0] / own).max(1.0);
        severity(assembly, *block, acceleration) / in_loads
    };
    accelerations_under(assembly, blocks, forces).iter().map(share).fold(0.0, f64::max)
}

/// The blocks that are not at rest with these accelerations, where these forces act.
pub(crate) fn moving(
    assembly: &Assembly,
    accelerations: &[(usize, Components)],
    forces: &[ContactForce],
) -> Vec<(usize, Components)> {
    let largest = largest_on_blocks(assembly, forces);
    let moves = |&&(block, ref acceleration): &&(usize, Components)| {
        !at_rest_under(assembly, block, severity(assembly, block, acceleration), largest[block])
    };
    accelerations.iter().filter(moves).copied().collect()
}

/// How far blocks fall with these accelerations: the power of the loads in them, as a multiple of what rounding, and contacts that
/// close by rounding, could make of the forces. None at all where a contact closes.
pub(crate) fn power_of_fall(
    assembly: &Assembly,
    accelerations: &[(usize, Components)],
    forces: &[ContactForce],
    cone: FrictionCone,
) -> f64 {
    let mut of = vec![None; assembly.blocks()];
    accelerations.iter().for_each(|(block, acceleration)| of[*block] = Some(acceleration));
    let fastest = assembly.fastest(accelerations);
    let (mut power, mut bound) = (0.0, 0.0);
    for (block, acceleration) in accelerations {
        for (&k, load) in assembly.components().iter().zip(assembly.applied(*block)) {
            power += load * acceleration[k];
            bound += ROUNDING * (load * acceleration[k]).abs();
        }
    }
    for force in forces {
        let contact = &assembly.contacts()[force.contact];
        let (relative, size) = relative_motion(assembly, contact, of_blocks(assembly, &of));
        let closing = -opening(assembly, contact, relative, cone);
        if closing > CLOSING * fastest {
            return 0.0;
        }
        bound += length(force.force) * (ROUNDING * size + closing.max(0.0));
    }
    if power > 0.0 { power / bound } else { 0.0 }
}

/// What the forces and the motion of the interior-point method prove.
pub(crate) struct Proved {
    /// Accelerations under the forces alone.
    pub under: Vec<(usize, Components)>,
    /// The forces hold every block.
    pub stands: bool,
    /// The blocks that move, and the power of the motion beside its rounding; none where it stands.
    pub falling: Vec<(usize, Components)>,
    pub power: f64,
}

impl Proved {
    /// The motion is one in which it falls.
    pub fn falls(&self) -> bool {
        !self.falling.is_empty() && self.power > MARGIN
    }
}

/// Reads an answer of the interior-point method on `blocks`, of which those that are held are left out; `sure` if its forces may
/// be taken for those of a structure at rest.
pub(crate) fn proved(
    assembly: &Assembly,
    blocks: &BlockSet,
    motion: &[(usize, Components)],
    forces: &[ContactForce],
    cone: FrictionCone,
    sure: bool,
) -> Proved {
    let under = accelerations_under(assembly, blocks, forces);
    let stands = sure && moving(assembly, &under, forces).is_empty();
    let falling = if stands { Vec::new() } else { moving(assembly, motion, forces) };
    let power = if stands { 0.0 } else { power_of_fall(assembly, motion, forces, cone) };
    Proved { under, stands, falling, power }
}

/// How fast a contact that has a force closes in a motion, of its fastest point; none that only opens.
pub(crate) fn closing(
    assembly: &Assembly,
    motion: &[(usize, Components)],
    forces: &[ContactForce],
    cone: FrictionCone,
) -> f64 {
    let mut of = vec![None; assembly.blocks()];
    motion.iter().for_each(|(block, velocity)| of[*block] = Some(velocity));
    let closes = |force: &ContactForce| {
        let contact = &assembly.contacts()[force.contact];
        -opening(assembly, contact, relative_motion(assembly, contact, of_blocks(assembly, &of)).0, cone)
    };
    let most = forces.iter().map(closes).fold(0.0, f64::max);
    if most > 0.0 { most / assembly.fastest(motion) } else { 0.0 }
}

/// The fastest point of what Newton's and Euler's law leaves unexplained of the accelerations of blocks, m/s^2.
pub(crate) fn unbalanced(
    assembly: &Assembly,
    blocks: &BlockSet,
    motion: &[(usize, Components)],
    forces: &[ContactForce],
) -> f64 {
    let under = accelerations_under(assembly, blocks, forces);
    let left = |((block, a), (_, b)): (&(usize, Components), &(usize, Components))| {
        assembly.speed(*block, &std::array::from_fn(|k| a[k] - b[k]))
    };
    motion.iter().zip(&under).map(left).fold(0.0, f64::max)
}

/// The largest error of Coulomb's law and of complementarity at a contact, for blocks at rest that begin to move, m/s^2: the
/// length of the natural map `r f - P(r f - (a + mu |a_t| n))`, P onto the cone, r the mean inverse mass at the contact.
pub(crate) fn law_error(assembly: &Assembly, motion: &[(usize, Components)], forces: &[ContactForce]) -> f64 {
    let mut of = vec![None; assembly.blocks()];
    motion.iter().for_each(|(block, a)| of[*block] = Some(a));
    let error = |force: &ContactForce| {
        let contact = &assembly.contacts()[force.contact];
        let (relative, _) = relative_motion(assembly, contact, of_blocks(assembly, &of));
        let (mu, inverse) = (contact.friction, inverse_mass_at(assembly, contact));
        let [forced, moved] = [force.force.map(|f| inverse * f), relative];
        let across = |v: [f64; 3]| minus(v, contact.normal.map(|n| n * dot(v, contact.normal)));
        let towards: [f64; 3] = std::array::from_fn(|k| forced[k] - moved[k]);
        let normal = dot(towards, contact.normal) - mu * length(across(moved));
        let tangent = across(towards);
        let size = length(tangent);
        let (n, share) = if size <= mu * normal {
            (normal, 1.0)
        } else if mu * size <= -normal {
            (0.0, 0.0)
        } else {
            let n = (normal + mu * size) / (1.0 + mu * mu);
            (n, mu * n / size)
        };
        length(std::array::from_fn(|k| forced[k] - n * contact.normal[k] - share * tangent[k]))
    };
    forces.iter().map(error).fold(0.0, f64::max)
}

/// The mean over the directions of the acceleration that a unit force at a contact gives along itself, 1/kg.
fn inverse_mass_at(assembly: &Assembly, contact: &Contact) -> f64 {
    let axes = if assembly.in_plane() { 2 } else { 3 };
    let mut sum = 0.0;
    for body in contact.bodies {
        let Some(block) = assembly.block_of(body) else { continue };
        for axis in 0..axes {
            let wrench = assembly.bodies()[body].wrench(std::array::from_fn(|k| f64::from(k == axis)), contact.point);
            let own = assembly.components().iter().zip(assembly.inverse_mass(block));
            sum += own.map(|(&k, inverse)| wrench[k] * wrench[k] * inverse).sum::<f64>();
        }
    }
    sum / axes as f64
}

/// The motions of bodies where only blocks move.
fn of_blocks<'a>(assembly: &Assembly, of: &[Option<&'a Components>]) -> impl Fn(usize) -> Option<&'a Components> {
    |body| assembly.block_of(body).and_then(|block| of[block])
}

/// Motion of the second body of a contact relative to the first, at the point, and the sum of the sizes of its parts; `of` is that of
/// a body.
pub(crate) fn relative_motion<'a>(
    assembly: &Assembly,
    contact: &Contact,
    of: impl Fn(usize) -> Option<&'a Components>,
) -> ([f64; 3], f64) {
    let (mut relative, mut size) = ([0.0; 3], 0.0);
    for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
        let Some(velocity) = of(contact.bodies[side]) else { continue };
        let body = &assembly.bodies()[contact.bodies[side]];
        let [x, y, z, turning @ ..] = *velocity;
        let turned = cross(body.in_world(turning), minus(contact.point, body.center));
        (0..3).for_each(|k| relative[k] += sign * ([x, y, z][k] + turned[k]));
        size += length([x, y, z]) + length(turned);
    }
    (relative, size)
}

/// The least rate of a unit force within a contact's cone in a relative motion: negative where they sink into each other.
pub(crate) fn opening(assembly: &Assembly, contact: &Contact, relative: [f64; 3], cone: FrictionCone) -> f64 {
    if !assembly.is_round(cone) {
        return assembly.directions(contact).into_iter().map(|d| dot(d, relative)).fold(f64::INFINITY, f64::min);
    }
    let normal = dot(contact.normal, relative);
    let across = length([0, 1, 2].map(|k| relative[k] - normal * contact.normal[k]));
    (normal - contact.friction * across) / contact.friction.hypot(1.0)
}
