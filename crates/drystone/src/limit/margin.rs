//! How far a structure is from falling: the least horizontal acceleration that brings it down, the tilt, the friction that it needs.
//!
//! The accelerations a (in g, horizontal) with which a structure can stand are a convex set: loads are linear in a. In the plane it
//! is an interval. In space each question along a direction gives two points of its boundary, and for each the line of the
//! mechanism, which the set does not cross: the set lies between the hull of the points and the polygon of the lines.

use super::{
    ends::{End, Limit},
    greatest,
    interior::{Known, greatest as proved},
    limit_known,
    region::{Region, Support},
};
use crate::{
    check::check_blocks_while,
    error::SceneError,
    formulate::{Assemble, Assembly, BlockSet, FrictionCone, Push},
    geometry::{cross, dot, length, unit},
    scene::SceneOf,
};
use drystone_lcp::Status;

/// What permanent loads do while a structure is accelerated or tilted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loads {
    /// They keep their direction.
    Stay,
    /// They are weights: they turn with gravity, and an acceleration acts on them as on masses.
    Turn,
}

/// How far a structure is from falling.
#[derive(Debug, Clone)]
pub struct Margin {
    /// Solved, or how a solver stopped without an answer.
    pub status: Status,
    /// The least horizontal acceleration that brings it down, over gravity; infinite if none does. Zero if it falls anyway.
    pub acceleration: f64,
    /// The direction of the force that this is on every block: horizontal, of length one. Zero if it falls anyway.
    pub direction: [f64; 3],
    /// The tilt that brings it down, radians; none where it is not known.
    pub tilt: Option<f64>,
    /// Forces and mechanism there.
    pub end: End,
    /// Two horizontal unit vectors, in the plane the same twice, and the boundary of the accelerations over gravity along them, counter-clockwise.
    pub axes: [[f64; 3]; 2],
    /// See [`Self::axes`].
    pub boundary: Vec<[f64; 2]>,
    /// Questions asked: load factors found.
    pub questions: usize,
}

/// Most questions for a boundary.
const MOST: usize = 200;

/// Lines of the boundary are as near as the nearest if they are no farther than this beside it: the first of them is the answer.
const NEARLY: f64 = 1e-6;

/// What is asked of a margin.
#[derive(Debug, Clone, Copy)]
pub struct Asked {
    /// The friction cones.
    pub cone: FrictionCone,
    /// What permanent loads do.
    pub loads: Loads,
    /// How far the boundary may be off, in space, over gravity.
    pub tolerance: f64,
}

/// The margin of a sub-assembly of these blocks.
///
/// # Errors
/// [`SceneError::NoGravity`]; [`SceneError::LoadAcross`] for loads that are to turn and are not along gravity.
pub fn margin<S: Assemble>(
    assembly: &Assembly,
    scene: &SceneOf<S>,
    blocks: &BlockSet,
    asked: Asked,
) -> Result<Margin, SceneError> {
    let down = unit_of(assembly)?;
    let axes = horizontal(down, assembly.in_plane());
    let pushes = [
        sideways(assembly, scene, blocks, axes[0], asked.loads)?,
        sideways(assembly, scene, blocks, axes[1], asked.loads)?,
    ];
    let mut probing = Probing {
        assembly,
        blocks,
        cone: asked.cone,
        axes,
        pushes,
        known: Known::within(asked.tolerance),
        questions: 0,
    };
    let mut margin = if assembly.in_plane() { probing.in_plane() } else { probing.in_space(asked.tolerance) };
    margin.tilt = match asked.loads {
        _ if margin.status != Status::Solved => None,
        Loads::Stay if scene.bodies().iter().any(|body| !body.loads().is_empty()) => {
            assembly.in_plane().then(|| probing.tilt(&margin))
        }
        _ => Some(margin.acceleration.atan()),
    };
    margin.questions = probing.questions;
    Ok(margin)
}

pub(super) fn unit_of(assembly: &Assembly) -> Result<[f64; 3], SceneError> {
    let gravity = assembly.gravity();
    let size = length(gravity);
    if size > 0.0 { Ok(gravity.map(|g| g / size)) } else { Err(SceneError::NoGravity) }
}

/// Horizontal axes: to the right of who stands upright in the plane; in space the world's x axis made horizontal, and the one a
/// quarter turn counter-clockwise from it, seen from above.
pub(super) fn horizontal(down: [f64; 3], in_plane: bool) -> [[f64; 3]; 2] {
    let [x, y, _] = down;
    if in_plane {
        let right = [-y, x, 0.0];
        return [right; 2];
    }
    let level = |axis: [f64; 3]| unit([0, 1, 2].map(|k| axis[k] - dot(axis, down) * down[k]));
    let first = level([1.0, 0.0, 0.0]).or_else(|| level([0.0, 1.0, 0.0])).unwrap_or([1.0, 0.0, 0.0]);
    [first, cross(down.map(|x| -x), first)]
}

/// Every weight sideways; of loads along gravity too if they turn.
pub(super) fn sideways<S: Assemble>(
    assembly: &Assembly,
    scene: &SceneOf<S>,
    blocks: &BlockSet,
    axis: [f64; 3],
    loads: Loads,
) -> Result<Push, SceneError> {
    const ACROSS: f64 = 1e-9;
    let size = length(assembly.gravity());
    let down = unit_of(assembly)?;
    let mut wrenches = vec![[0.0; 6]; assembly.blocks()];
    for block in blocks.iter() {
        let part = assembly.body(block);
        let mut sum = part.wrench(axis.map(|x| part.mass * size * x), part.center);
        let body = &scene.bodies()[assembly.body_index(block)];
        for load in body.loads().iter().filter(|_| loads == Loads::Turn) {
            let force = S::in_space(load.force);
            let along = dot(force, down);
            let across = length([0, 1, 2].map(|k| force[k] - along * down[k]));
            if across > ACROSS * along.abs() || load.moment != [0.0; 3] {
                return Err(SceneError::LoadAcross { name: load.name.clone() });
            }
            let at = S::in_space(S::in_world(&body.pose, load.at));
            let more = part.wrench(axis.map(|x| along * x), at);
            (0..6).for_each(|k| sum[k] += more[k]);
        }
        wrenches[block] = sum;
    }
    Ok(Push::of_wrenches(assembly, |block| wrenches[block]))
}

struct Probing<'a> {
    assembly: &'a Assembly,
    blocks: &'a BlockSet,
    cone: FrictionCone,
    axes: [[f64; 3]; 2],
    pushes: [Push; 2],
    /// How well the ends have to be known.
    known: Known,
    questions: usize,
}

impl Probing<'_> {
    fn along(&mut self, [c, s]: [f64; 2]) -> Limit {
        self.questions += 1;
        let push = self.pushes[0].plus(c, &self.pushes[1], s);
        limit_known(self.assembly, self.blocks, &push, self.cone, self.known)
    }

    /// A margin of none: it falls under its own loads, if it does.
    fn fallen(&self, found: &Limit) -> Option<Margin> {
        let falls = |end: &End| Some(self.margin(0.0, [0.0; 2], end.clone()));
        match found.status {
            Status::NoSolution => falls(&found.upper),
            Status::Solved if found.upper.factor < 0.0 => falls(&found.upper),
            Status::Solved if found.lower.factor > 0.0 => falls(&found.lower),
            Status::Solved => None,
            status => Some(Margin { status, acceleration: f64::NAN, ..self.margin(0.0, [0.0; 2], End::unknown()) }),
        }
    }

    fn margin(&self, acceleration: f64, [a, b]: [f64; 2], end: End) -> Margin {
        let direction = [0, 1, 2].map(|k| a * self.axes[0][k] + b * self.axes[1][k]);
        let (axes, boundary, tilt) = (self.axes, Vec::new(), None);
        Margin { status: Status::Solved, acceleration, direction, tilt, end, axes, boundary, questions: 0 }
    }

    fn in_plane(&mut self) -> Margin {
        let found = self.along([1.0, 0.0]);
        if let Some(fallen) = self.fallen(&found) {
            return fallen;
        }
        let (right, left) = (found.upper.factor, -found.lower.factor);
        let boundary = vec![[-left, 0.0], [right, 0.0]];
        let margin = match right <= left {
            true => self.margin(right, [1.0, 0.0], found.upper),
            false => self.margin(left, [-1.0, 0.0], found.lower),
        };
        Margin { boundary, ..margin }
    }

    fn in_space(&mut self, tolerance: f64) -> Margin {
        let mut region = Region::new();
        let mut ends: Vec<(Support, End)> = Vec::new();
        let mut next = vec![[1.0, 0.0], [0.0, 1.0]];
        while let Some(direction) = next.pop() {
            let found = self.along(direction);
            if let Some(fallen) = self.fallen(&found) {
                return fallen;
            }
            for (end, sign) in [(found.upper, 1.0), (found.lower, -1.0)] {
                let toward = direction.map(|x| sign * x);
                let support = self.support(&end, toward, (sign * end.factor).max(0.0));
                region.add(support);
                ends.push((support, end));
            }
            if next.is_empty() && self.questions < MOST {
                next.extend(region.worst(tolerance));
            }
        }
        let least = ends.iter().map(|(support, _)| support.distance()).fold(f64::INFINITY, f64::min);
        let near = |(support, _): &&(Support, End)| support.distance() <= least + NEARLY * least.min(1.0);
        let (support, end) = ends.iter().find(near).expect("two directions are asked about at least").clone();
        let (support, end) = self.known_well(&support).unwrap_or((support, end));
        let margin = match support.distance().is_finite() {
            true => self.margin(support.distance(), support.normal, end),
            false => self.margin(f64::INFINITY, [0.0; 2], end),
        };
        Margin { boundary: region.boundary(), ..margin }
    }

    /// A support of the boundary again, as well as it can be known, where it was known to the tolerance only: it is the answer.
    fn known_well(&mut self, support: &Support) -> Option<(Support, End)> {
        if !support.distance().is_finite() || !self.known.is_loose() {
            return None;
        }
        self.known = Known::well();
        let found = self.along(support.toward());
        let end = (found.status == Status::Solved).then_some(found.upper)?;
        Some((self.support(&end, support.toward(), end.factor.max(0.0)), end))
    }

    /// The boundary's point towards a direction, and its line: the powers of the two pushes in the mechanism are its normal.
    fn support(&self, end: &End, toward: [f64; 2], far: f64) -> Support {
        let size = self.assembly.components().len();
        let power = |push: &Push| -> f64 {
            let of = |(body, velocity): &(usize, crate::formulate::Acceleration)| {
                let Some(block) = self.assembly.block_of(*body) else { return 0.0 };
                let turning = self.assembly.body(block).along_axes(velocity.angular);
                let [x, y, z] = velocity.linear;
                let [a, b, c] = turning;
                let components = [x, y, z, a, b, c];
                let wrench = push.on(block, size).iter().zip(self.assembly.components());
                wrench.map(|(entry, &k)| entry * components[k]).sum::<f64>()
            };
            end.motion.iter().map(of).sum()
        };
        Support::new(toward, far, self.pushes.each_ref().map(power))
    }

    /// The tilt at which it falls where loads keep their direction, in the plane: the sine of the angle is the load factor of weights
    /// sideways under weights times its cosine.
    fn tilt(&mut self, margin: &Margin) -> f64 {
        const ANGLE: f64 = 1e-10;
        let down = self.pushes[0].turned(self.assembly, self.axes[0]);
        let sides = [1.0, -1.0].map(|sign| {
            let mut over = |angle: f64| {
                self.questions += 1;
                let tilted = self.assembly.pushed(&down, angle.cos() - 1.0);
                let push = self.pushes[0].plus(sign, &self.pushes[0], 0.0);
                greatest(&tilted, self.blocks, &push, self.cone).map_or(-1.0, |most| (most - angle.sin()).min(1e3))
            };
            if margin.acceleration == 0.0 {
                0.0
            } else {
                super::root::falling(&mut over, [0.0, std::f64::consts::FRAC_PI_2], ANGLE)
            }
        });
        sides[0].min(sides[1])
    }
}

/// The least multiple of every coefficient of friction with which a structure stands: infinite if it stands with none up to 1e6.
pub fn least_friction(assembly: &Assembly, blocks: &BlockSet, cone: FrictionCone) -> f64 {
    const MULTIPLE: f64 = 1e-9;
    const MOST_MULTIPLE: f64 = 1e6;
    let pulling = Push::parting(assembly, blocks);
    // What stands can be pressed less, and what falls would have to be pressed more, at every contact.
    let mut lacking = |multiple: f64| {
        let scaled = assembly.with_friction(multiple);
        let stands = || check_blocks_while(&scaled, blocks, cone, &mut |_| true).expect("nobody stops it").stable;
        match proved(&scaled, blocks, &pulling, cone) {
            Some(most) if multiple > 0.0 => -most.clamp(-1e3, 1e3),
            _ => f64::from(i8::from(!stands())),
        }
    };
    if blocks.is_empty() || lacking(0.0) <= 0.0 {
        return 0.0;
    }
    let mut high = 1.0;
    while lacking(high) > 0.0 {
        high *= 10.0;
        if high > MOST_MULTIPLE {
            return f64::INFINITY;
        }
    }
    super::root::falling(&mut lacking, [0.0, high], MULTIPLE)
}
