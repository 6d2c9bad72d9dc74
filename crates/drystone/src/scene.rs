//! A scene: gravity, friction and rigid blocks, each checked when it is added.

use crate::bounds::{ANGLE, COORDINATE, FRICTION, INERTIA, LENGTH, MASS, SLENDERNESS, TOLERANCE};
use crate::checked::positive;
use crate::error::SceneError;
use crate::geometry::{Polygon, Pose, Shape, Vector3};
use crate::interrupt::poll;
use crate::load::{Load, check_gravity};
use crate::mass_properties::{MassProperties, Weighed};
use crate::settlement::Settlement;
use crate::suggest::nearest;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Display;

/// How a block is called and what it is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyOptions {
    /// The block's name; without one it is "b" and its index.
    pub name: Option<String>,
    /// Mass per area, kg/m^2; in space per volume, kg/m^3.
    pub density: f64,
    /// The block's own coefficient of friction; without one the scene's counts.
    pub friction: Option<f64>,
    /// A fixed block bears any load and never moves.
    pub fixed: bool,
    /// What the block weighs apart from its shape; a mass of its own takes the place of the density.
    pub own: MassProperties,
}

impl Default for BodyOptions {
    fn default() -> Self {
        Self { name: None, density: 1.0, friction: None, fixed: false, own: MassProperties::default() }
    }
}

impl BodyOptions {
    /// The same for a shape whose centroid is the centre of mass.
    pub(crate) fn about_centroid(self) -> Self {
        Self { own: MassProperties { center_of_mass: None, ..self.own }, ..self }
    }
}

/// One rigid block.
#[derive(Debug, Clone, PartialEq)]
pub struct Body<S: Shape = Polygon> {
    /// Unique in the scene.
    pub name: String,
    /// In the body's frame: the centre of mass is the origin. It is the centroid unless another was given.
    pub shape: S,
    /// The sides, if the block was given as a box.
    pub box_size: Option<S::Vector>,
    /// Where the frame stands: `position` is the centre of mass in the world.
    pub pose: S::Pose,
    /// Mass per area, kg/m^2; in space per volume, kg/m^3. The mean of a block with a mass of its own; where pieces overlap, of
    /// the sum of their volumes.
    pub density: f64,
    /// The block's own coefficient of friction, if it has one.
    pub friction: Option<f64>,
    /// Whether the block is held in place.
    pub fixed: bool,
    /// What was given of its weight, in the body's frame: a centre of mass is its origin.
    pub(crate) own: MassProperties,
    weighed: Weighed,
    loads: Vec<Load<S::Vector>>,
    settlements: Vec<Settlement<S::Vector>>,
}

impl<S: Shape> Body<S> {
    /// Mass in kilograms (also of a fixed block, which never uses it).
    pub fn mass(&self) -> f64 {
        self.weighed.mass
    }

    /// Principal moments of inertia about the centre of mass, kg m^2: in the plane there is one.
    pub fn moments(&self) -> &[f64] {
        &self.weighed.moments
    }

    /// Permanent loads beside the weight.
    pub fn loads(&self) -> &[Load<S::Vector>] {
        &self.loads
    }

    /// Prescribed displacements of a fixed block, which add up.
    pub fn settlements(&self) -> &[Settlement<S::Vector>] {
        &self.settlements
    }

    /// Unit vectors of the principal axes in the body's frame, in the order of the moments; in the plane those of the frame.
    pub fn principal_axes(&self) -> [Vector3; 3] {
        self.weighed.axes
    }

    fn check_size(&self) -> Result<(), SceneError> {
        let (name, width, radius) = (&self.name, self.shape.width(), self.shape.radius());
        LENGTH.check(format_args!("block \"{name}\": the width"), width)?;
        LENGTH.check(format_args!("block \"{name}\": the distance of its corners from its centre"), radius)?;
        SLENDERNESS
            .check(format_args!("block \"{name}\": the distance of its corners from its centre"), radius / width)?;
        coordinates(format_args!("block \"{name}\": the centre of mass"), S::place(&self.pose).as_ref())
    }

    /// Bounds are for what moves; of a fixed block the mass need only be a number.
    fn check_mass(&self) -> Result<(), SceneError> {
        if self.fixed {
            return Ok(());
        }
        MASS.check(format_args!("block \"{}\": mass", self.name), self.mass())?;
        let check = |&moment| INERTIA.check(format_args!("block \"{}\": moment of inertia", self.name), moment);
        self.moments().iter().try_for_each(check)
    }
}

impl Body {
    /// Moment of inertia about the centre of mass, kg m^2.
    pub fn inertia(&self) -> f64 {
        self.weighed.moments[0]
    }

    /// The corners in the world, metres, counter-clockwise.
    pub fn vertices(&self) -> Vec<[f64; 2]> {
        let corners = self.shape.vertices().iter();
        corners.map(|&v| self.pose.transform(v).to_array()).collect()
    }
}

/// Blocks under gravity in the plane.
pub type Scene = SceneOf<Polygon>;

/// Blocks under gravity, in the plane ([`Polygon`]) or in space ([`Solid`](crate::geometry::Solid)). Lengths are metres,
/// masses kilograms, angles radians.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneOf<S: Shape> {
    pub(crate) gravity: S::Vector,
    friction: f64,
    /// Coefficients of pairs, the lower index first, that have their own.
    pub(crate) pairs: BTreeMap<[usize; 2], f64>,
    contact_tolerance: Option<f64>,
    bodies: Vec<Body<S>>,
    index: HashMap<String, usize>,
}

/// Operations to take a body in, about.
const BODY: usize = 4000;

impl<S: Shape> SceneOf<S> {
    /// An empty scene. `gravity` in m/s^2; `friction` is the coefficient of every block without
    /// one of its own. [`crate::bounds`] says how large and how small they may be.
    pub fn new(gravity: S::Vector, friction: f64) -> Result<Self, SceneError> {
        check_gravity(&gravity)?;
        check_friction("the scene's friction", friction)?;
        let (pairs, index) = (BTreeMap::new(), HashMap::new());
        Ok(Self { gravity, friction, pairs, contact_tolerance: None, bodies: Vec::new(), index })
    }

    /// The same scene with one contact tolerance, in metres, for every pair of blocks, instead of
    /// the default that [`crate::contact`] derives from the blocks' sizes.
    pub fn with_contact_tolerance(mut self, tolerance: f64) -> Result<Self, SceneError> {
        TOLERANCE.check_positive("the scene's contact_tolerance", tolerance)?;
        self.contact_tolerance = Some(tolerance);
        Ok(self)
    }

    /// Moves a block.
    pub(crate) fn set_pose(&mut self, index: usize, pose: S::Pose) {
        self.bodies[index].pose = pose;
    }

    /// The loads of a block, to change them.
    pub(crate) fn loads_mut(&mut self, index: usize) -> &mut Vec<Load<S::Vector>> {
        &mut self.bodies[index].loads
    }

    /// The settlements of a block, to change them.
    pub(crate) fn settlements_mut(&mut self, index: usize) -> &mut Vec<Settlement<S::Vector>> {
        &mut self.bodies[index].settlements
    }

    /// Takes a block out; those after it move up by one.
    pub(crate) fn remove(&mut self, index: usize) {
        self.bodies.remove(index);
        let up = |i: usize| if i > index { i - 1 } else { i };
        let left = self.pairs.iter().filter(|(pair, _)| !pair.contains(&index));
        self.pairs = left.map(|(pair, friction)| (pair.map(up), *friction)).collect();
        self.index = self.bodies.iter().enumerate().map(|(k, body)| (body.name.clone(), k)).collect();
    }

    /// Adds a block whose place and shape are checked; the shape is about its own centre of mass, if it has one.
    pub(crate) fn push(
        &mut self,
        name: String,
        shape: S,
        box_size: Option<S::Vector>,
        pose: S::Pose,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        poll(BODY);
        let BodyOptions { density, friction, fixed, own, .. } = options;
        positive(format_args!("block \"{name}\": density"), density)?;
        if let Some(friction) = friction {
            check_friction(format_args!("block \"{name}\": friction"), friction)?;
        }
        let weighed = own.weigh(&name, &shape, density)?;
        let density = own.mass.map_or(density, |mass| mass / shape.measure());
        let own = MassProperties { center_of_mass: own.center_of_mass.map(|_| [0.0; 3]), ..own };
        let (loads, settlements) = (Vec::new(), Vec::new());
        let body = Body { name, shape, box_size, pose, density, friction, fixed, own, weighed, loads, settlements };
        body.check_size()?;
        body.check_mass()?;
        let index = self.bodies.len();
        self.index.insert(body.name.clone(), index);
        self.bodies.push(body);
        Ok(index)
    }

    /// The given name if it is free, or a default one: "b" and the index, with a dash and a number
    /// behind it when a block has been given just that name.
    pub(crate) fn free_name(&self, options: &BodyOptions) -> Result<String, SceneError> {
        if let Some(name) = &options.name {
            return match self.index.get(name) {
                Some(&index) => Err(SceneError::DuplicateName { name: name.clone(), index }),
                None if name.is_empty() => Err(SceneError::EmptyName),
                None => Ok(name.clone()),
            };
        }
        let plain = format!("b{}", self.bodies.len());
        let mut name = plain.clone();
        let mut attempt = 2;
        while self.index.contains_key(&name) {
            name = format!("{plain}-{attempt}");
            attempt += 1;
        }
        Ok(name)
    }

    /// Every block, in the order they were added.
    pub fn bodies(&self) -> &[Body<S>] {
        &self.bodies
    }

    /// Index of the block with this name.
    pub fn index_of(&self, name: &str) -> Result<usize, SceneError> {
        self.index.get(name).copied().ok_or_else(|| SceneError::UnknownName {
            name: name.to_owned(),
            nearest: nearest(name, self.bodies.iter().map(|body| body.name.as_str())),
        })
    }

    /// Acceleration of gravity, m/s^2.
    pub fn gravity(&self) -> S::Vector {
        self.gravity
    }

    /// The coefficient of friction of a block without one of its own.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// The one contact tolerance for every pair, metres, if the scene sets it.
    pub fn contact_tolerance(&self) -> Option<f64> {
        self.contact_tolerance
    }

    /// Coefficient of friction between two blocks: the pair's own if it has one, else the smaller of theirs. A contact then
    /// never claims more grip than either of its surfaces allows, so a verdict errs on the safe side.
    pub fn pair_friction(&self, a: usize, b: usize) -> f64 {
        if let Some(&friction) = self.pairs.get(&[a.min(b), a.max(b)]) {
            return friction;
        }
        let own = |i: usize| self.bodies[i].friction.unwrap_or(self.friction);
        own(a).min(own(b))
    }
}

impl Scene {
    /// Adds a rectangle with the given centre and size (width, height), turned by `angle`.
    /// Returns the block's index.
    pub fn add_box(
        &mut self,
        center: [f64; 2],
        size: [f64; 2],
        angle: f64,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        let name = self.free_name(&options)?;
        for axis in 0..2 {
            COORDINATE.check(format_args!("block \"{name}\": center[{axis}]"), center[axis])?;
            LENGTH.check_positive(format_args!("block \"{name}\": size[{axis}]"), size[axis])?;
        }
        ANGLE.check(format_args!("block \"{name}\": angle"), angle)?;
        let frame = Pose { position: center, angle };
        let shape = Polygon::rectangle(size);
        match options.own.checked_center(&name)? {
            None | Some([0.0, 0.0, _]) => self.push(name, shape, Some(size), frame, options.about_centroid()),
            Some(own) => {
                let corners: Vec<[f64; 2]> = shape.vertices().iter().map(|v| v.to_array()).collect();
                self.push_about(name, &corners, frame, own, options)
            }
        }
    }

    /// Adds a convex polygon by its corners in the world, in order round it, in metres. Corners on
    /// a straight line are merged. Returns the block's index.
    pub fn add_polygon(&mut self, vertices: &[[f64; 2]], options: BodyOptions) -> Result<usize, SceneError> {
        let frame = Pose { position: [0.0, 0.0], angle: 0.0 };
        self.add_placed_polygon(vertices, frame, options)
    }

    /// Adds a convex polygon by its corners in a frame, and that frame's pose. The body's own
    /// frame keeps the angle and moves its origin to the centroid.
    pub fn add_placed_polygon(
        &mut self,
        vertices: &[[f64; 2]],
        frame: Pose,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        let name = self.free_name(&options)?;
        coordinates(format_args!("block \"{name}\": position"), &frame.position)?;
        ANGLE.check(format_args!("block \"{name}\": angle"), frame.angle)?;
        within_reach(&name, vertices)?;
        if let Some(own) = options.own.checked_center(&name)? {
            return self.push_about(name, vertices, frame, own, options);
        }
        let (polygon, centroid) =
            Polygon::from_vertices(vertices).map_err(|fault| SceneError::BadShape { body: name.clone(), fault })?;
        let position = frame.transform(centroid.into()).to_array();
        self.push(name, polygon, None, Pose { position, ..frame }, options)
    }

    /// Adds a polygon with a centre of mass of its own; both are given in the frame.
    fn push_about(
        &mut self,
        name: String,
        vertices: &[[f64; 2]],
        frame: Pose,
        [x, y, _]: [f64; 3],
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        let polygon =
            Polygon::about(vertices, [x, y]).map_err(|fault| SceneError::BadShape { body: name.clone(), fault })?;
        let position = frame.transform([x, y].into()).to_array();
        self.push(name, polygon, None, Pose { position, ..frame }, options)
    }
}

/// Refuses coordinates of a place that are out of bounds.
pub(crate) fn coordinates(place: impl Display, values: &[f64]) -> Result<(), SceneError> {
    let mut numbered = values.iter().enumerate();
    numbered.try_for_each(|(axis, &value)| COORDINATE.check(format_args!("{place}[{axis}]"), value))
}

/// The same for corners; what is no number is left to the shape, which numbers it too.
pub(crate) fn within_reach<const N: usize>(name: &str, vertices: &[[f64; N]]) -> Result<(), SceneError> {
    let far = |vertex: &[f64; N]| vertex.iter().all(|x| x.is_finite()) && !vertex.iter().all(|&x| COORDINATE.hold(x));
    match vertices.iter().position(far) {
        Some(vertex) => coordinates(format_args!("block \"{name}\": vertex {vertex}"), &vertices[vertex]),
        None => Ok(()),
    }
}

pub(crate) fn check_friction(place: impl Display, value: f64) -> Result<(), SceneError> {
    if value < 0.0 {
        return Err(SceneError::NegativeFriction { place: place.to_string(), value });
    }
    FRICTION.check(place, value)
}
