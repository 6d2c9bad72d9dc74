//! Loads, gravity and the friction of pairs, said to a scene.

use crate::{
    bounds::{COORDINATE, PUSH},
    checked::finite,
    error::SceneError,
    geometry::{Face, Shape, minus_of, norm, plus_times, product},
    load::{Load, LoadOptions, check_gravity},
    scene::{SceneOf, check_friction},
};

/// A face looks where it is asked for if its normal is within 45 degrees of there.
const LOOKS: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Normals that differ by less are those of one plane, radians; and distances along a normal, in the block's radius.
const SAME: f64 = 1e-6;

/// Cosines that differ by less are equal: rounding.
const EQUAL: f64 = 1e-12;

impl<S: Shape> SceneOf<S> {
    /// Adds a permanent load to a block and returns its name. On a fixed one it has no effect.
    ///
    /// # Errors
    /// [`SceneError`] for an unknown block, a name that another load has, numbers out of bounds.
    pub fn add_load(&mut self, body: &str, options: LoadOptions<S::Vector>) -> Result<String, SceneError> {
        let index = self.index_of(body)?;
        let LoadOptions { name, force, at, moment } = options;
        let body = &self.bodies()[index];
        let at = match at {
            None => body.shape.centroid(),
            Some(at) => {
                for (axis, &x) in at.as_ref().iter().enumerate() {
                    COORDINATE.check(format_args!("a load on \"{}\": at[{axis}]", body.name), x)?;
                }
                S::seen_from(&body.pose, at)
            }
        };
        self.push_load(index, name, force, at, moment)
    }

    /// The same with the point in the block's frame.
    pub(crate) fn push_load(
        &mut self,
        index: usize,
        name: Option<String>,
        force: S::Vector,
        at: S::Vector,
        moment: [f64; 3],
    ) -> Result<String, SceneError> {
        let body = &self.bodies()[index].name;
        for (axis, &value) in force.as_ref().iter().enumerate() {
            PUSH.check(format_args!("a load on \"{body}\": force[{axis}]"), value)?;
        }
        for (axis, &value) in at.as_ref().iter().enumerate() {
            COORDINATE.check(format_args!("a load on \"{body}\": at[{axis}]"), value)?;
        }
        for (axis, &value) in moment.iter().enumerate() {
            PUSH.check(format_args!("a load on \"{body}\": moment[{axis}]"), value)?;
        }
        let name = self.free_load_name(name)?;
        self.loads_mut(index).push(Load { name: name.clone(), force, at, moment });
        Ok(name)
    }

    /// Adds the resultant of a pressure (N/m^2; in the plane N/m) on the face of a block that looks in a direction: of the faces
    /// whose normals are nearest to it, within 45 degrees, the outermost.
    ///
    /// # Errors
    /// As [`Self::add_load`]; [`SceneError::NoFace`] if no face looks there, or two do alike.
    pub fn add_pressure(
        &mut self,
        body: &str,
        direction: S::Vector,
        pressure: f64,
        name: Option<String>,
    ) -> Result<String, SceneError> {
        let index = self.index_of(body)?;
        finite(format_args!("the pressure on \"{body}\""), pressure)?;
        for (axis, &value) in direction.as_ref().iter().enumerate() {
            finite(format_args!("the pressure on \"{body}\": direction[{axis}]"), value)?;
        }
        let no_face = || SceneError::NoFace { body: body.to_owned(), direction: direction.as_ref().to_vec() };
        let face = self.face(index, direction).ok_or_else(no_face)?;
        let force = plus_times(S::Vector::default(), -pressure * face.area, &face.normal);
        self.push_load(index, name, force, face.middle, [0.0; 3])
    }

    /// The face of a block that looks in a direction.
    fn face(&self, index: usize, direction: S::Vector) -> Option<Face<S::Vector>> {
        let body = &self.bodies()[index];
        let length = norm(direction.as_ref());
        let faces: Vec<Face<S::Vector>> = body.shape.faces();
        let looks = |face: &Face<S::Vector>| product(&S::turned(&body.pose, face.normal), &direction) / length;
        let best = faces.iter().map(looks).fold(f64::NEG_INFINITY, f64::max);
        if best.is_nan() || best < LOOKS {
            return None;
        }
        let nearest = faces.iter().find(|face| looks(face) >= best - EQUAL)?.normal;
        let along = |face: &&Face<S::Vector>| norm(minus_of(face.normal, &nearest).as_ref()) <= SAME;
        if faces.iter().any(|face| looks(face) >= best - EQUAL && !along(&face)) {
            return None;
        }
        let height = |face: &Face<S::Vector>| product(&face.middle, &nearest);
        let top = faces.iter().filter(along).map(height).fold(f64::NEG_INFINITY, f64::max);
        let outermost = |face: &&Face<S::Vector>| height(face) >= top - SAME * body.shape.radius();
        let (mut area, mut middle) = (0.0, S::Vector::default());
        for face in faces.iter().filter(along).filter(outermost) {
            area += face.area;
            middle = plus_times(middle, face.area, &face.middle);
        }
        let middle = plus_times(S::Vector::default(), area.recip(), &middle);
        Some(Face { normal: S::turned(&body.pose, nearest), area, middle })
    }

    /// The given name if no load has it, or a default one.
    fn free_load_name(&self, name: Option<String>) -> Result<String, SceneError> {
        let all = || self.bodies().iter().flat_map(|body| body.loads());
        let taken = |name: &str| all().any(|load| load.name == name);
        match name {
            Some(name) if name.is_empty() => Err(SceneError::EmptyName),
            Some(name) if taken(&name) => Err(SceneError::DuplicateLoad { name }),
            Some(name) => Ok(name),
            None => {
                let free = |number: &usize| !taken(&format!("load {number}"));
                let number = (all().count() + 1..).find(free).unwrap_or_default();
                Ok(format!("load {number}"))
            }
        }
    }

    /// The same bodies and loads under another gravity, m/s^2.
    ///
    /// # Errors
    /// [`SceneError`] for numbers out of bounds.
    pub fn with_gravity(mut self, gravity: S::Vector) -> Result<Self, SceneError> {
        check_gravity(&gravity)?;
        self.gravity = gravity;
        Ok(self)
    }

    /// Gives a pair of blocks a coefficient of friction of its own, whatever those of the two are.
    ///
    /// # Errors
    /// [`SceneError`] for an unknown block, one block twice, a coefficient out of bounds.
    pub fn set_friction(&mut self, a: &str, b: &str, friction: f64) -> Result<(), SceneError> {
        let (i, j) = (self.index_of(a)?, self.index_of(b)?);
        if i == j {
            return Err(SceneError::FrictionOfOne { name: a.to_owned() });
        }
        check_friction(format_args!("the friction of \"{a}\" and \"{b}\""), friction)?;
        self.pairs.insert([i.min(j), i.max(j)], friction);
        Ok(())
    }

    /// Pairs of blocks, the lower index first, that have a coefficient of friction of their own.
    pub fn pair_frictions(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        self.pairs.iter().map(|(pair, friction)| (*pair, *friction))
    }

    /// The largest coefficient of friction that any contact can have.
    pub fn largest_friction(&self) -> f64 {
        let own = self.bodies().iter().map(|body| body.friction.unwrap_or(self.friction()));
        own.chain(self.pairs.values().copied()).fold(0.0, f64::max)
    }
}
