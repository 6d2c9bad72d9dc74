//! What can be wrong with a scene, each as a typed error that names the block and the fix.

use crate::{
    bounds::{Bounds, MOST_FACETS, Plain},
    geometry::{ShapeFault, SolidFault},
};
use thiserror::Error;

/// What is wrong with a tensor of inertia, and what to do about it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InertiaFault {
    /// Two halves that differ.
    #[error("the inertia is not symmetric: entry [{i}][{j}] is {upper}, but [{j}][{i}] is {lower}: give both the same")]
    NotSymmetric {
        /// Row.
        i: usize,
        /// Column.
        j: usize,
        /// Of row i and column j, kg m^2.
        upper: f64,
        /// Of row j and column i, kg m^2.
        lower: f64,
    },
    /// A moment that is not above zero.
    #[error("the inertia has the principal moments {a:.6e}, {b:.6e}, {c:.6e} kg m^2: each must be greater than zero")]
    NotPositive {
        /// Kg m^2.
        a: f64,
        /// Kg m^2.
        b: f64,
        /// Kg m^2.
        c: f64,
    },
    /// One moment above the sum of the others.
    #[error(
        "the inertia has the principal moments {a:.6e}, {b:.6e}, {c:.6e} kg m^2: of a rigid body none is greater than the \
         sum of the others; is it about the centre of mass?"
    )]
    Triangle {
        /// Kg m^2.
        a: f64,
        /// Kg m^2.
        b: f64,
        /// Kg m^2.
        c: f64,
    },
}

/// A scene that cannot be built, read or put into contact.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A NaN or an infinity where a finite number is needed.
    #[error("{place} is {value}: give a finite number")]
    NotFinite {
        /// The block and the quantity.
        place: String,
        /// The offending value.
        value: f64,
    },
    /// A density, a box side or a tolerance that is not above zero.
    #[error("{place} is {value}: it must be greater than zero")]
    NotPositive {
        /// The block and the quantity.
        place: String,
        /// The offending value.
        value: f64,
    },
    /// A number that is too large or too small for what is computed from it; see [`crate::bounds`].
    #[error("{place} is {}{}: it must be {bounds}: {}", Plain(*.value), .bounds.unit, .bounds.advice)]
    OutOfBounds {
        /// The block and the quantity.
        place: String,
        /// The offending value.
        value: f64,
        /// What is allowed.
        bounds: Bounds,
    },
    /// A coefficient of friction below zero.
    #[error("{place} is {value}: a coefficient of friction is zero (no friction) or more")]
    NegativeFriction {
        /// The scene or the block.
        place: String,
        /// The offending value.
        value: f64,
    },
    /// A polygon that is not the outline of a convex block.
    #[error("block \"{body}\": {fault}")]
    BadShape {
        /// The block's name.
        body: String,
        /// What is wrong with the polygon, and the fix.
        fault: ShapeFault,
    },
    /// Corners that do not make a solid.
    #[error("block \"{body}\": {fault}")]
    BadSolid {
        /// The block's name.
        body: String,
        /// What is wrong with it, and the fix.
        fault: SolidFault,
    },
    /// Moments that no rigid body has.
    #[error("block \"{body}\": {fault}")]
    BadInertia {
        /// The block's name.
        body: String,
        /// What is wrong with them, and the fix.
        fault: InertiaFault,
    },
    /// An orientation that is no rotation.
    #[error("block \"{body}\": the orientation is zero: give a quaternion (w, x, y, z), for instance (1, 0, 0, 0)")]
    ZeroOrientation {
        /// The block's name.
        body: String,
    },
    /// Something that is only there for the plane.
    #[error("this scene is in space: polygons, extrusion and simulation take one in the plane (dimension 2)")]
    NotInPlane,
    /// Something that is only there for space.
    #[error("this scene is in the plane: polyhedra and solids take one in space (dimension 3)")]
    NotInSpace,
    /// A friction cone with less than three edges, or with more than are of use.
    #[error("facets is {facets}: a cone in space has 3 to {MOST_FACETS}")]
    BadFacets {
        /// What was asked for.
        facets: usize,
    },
    /// Two blocks with the same name.
    #[error("the name \"{name}\" is already that of block number {index}: names must differ")]
    DuplicateName {
        /// The name given twice.
        name: String,
        /// Index of the block that has it.
        index: usize,
    },
    /// An empty name.
    #[error("a block's name is empty: leave the name out to get \"b0\", \"b1\", ...")]
    EmptyName,
    /// A name that no block has.
    #[error("no block is named \"{name}\"{}", suggestion(.nearest))]
    UnknownName {
        /// The name asked for.
        name: String,
        /// The existing name closest to it, if any is close.
        nearest: Option<String>,
    },
    /// A margin without gravity.
    #[error("there is no gravity, of which a margin is a share: give the scene one (with_gravity)")]
    NoGravity,
    /// A load that is to turn with gravity and is not along it.
    #[error(
        "the load \"{name}\" is no weight, a force along gravity without a moment: let loads stay (loads=\"stay\")"
    )]
    LoadAcross {
        /// The load.
        name: String,
    },
    /// A push on a body that cannot move.
    #[error("\"{name}\" is fixed, or not among the blocks that are there: push one that can move")]
    NotMovable {
        /// The body.
        name: String,
    },
    /// The settlement of a body that is no support.
    #[error("\"{name}\" is not fixed: only supports settle; give it fixed=True, or push it (add_load)")]
    NotSupport {
        /// The body.
        name: String,
    },
    /// Two loads with the same name.
    #[error("there is a load named \"{name}\" already: names of loads must differ")]
    DuplicateLoad {
        /// The name given twice.
        name: String,
    },
    /// No face of a block looks in a direction, or two do alike.
    #[error(
        "block \"{body}\": no one face looks in the direction {direction:?}: give the outward normal of the face \
         (add_load takes any force)"
    )]
    NoFace {
        /// The block.
        body: String,
        /// What was asked for.
        direction: Vec<f64>,
    },
    /// The friction of a block with itself.
    #[error("the friction of a pair is that of two blocks, not of \"{name}\" twice")]
    FrictionOfOne {
        /// The block.
        name: String,
    },
    /// Two blocks occupy the same place by more than the contact tolerance.
    #[error(
        "blocks \"{a}\" and \"{b}\" overlap by {depth:.3e} m, more than the contact tolerance of \
         {tolerance:.3e} m: move them apart (scene.parted() does), or raise the scene's contact_tolerance if the depth \
         is mere rounding; a picture of the scene (scene.draw, or drystone scene FILE -o x.svg) shows where"
    )]
    Overlap {
        /// Name of the block with the lower index.
        a: String,
        /// Name of the other block.
        b: String,
        /// The shortest way to part them, metres.
        depth: f64,
        /// The pair's contact tolerance, metres.
        tolerance: f64,
    },
    /// A built-in scene that does not exist.
    #[error("no built-in scene is called \"{name}\"{} (there are {known})", suggestion(.nearest))]
    UnknownScene {
        /// The name asked for.
        name: String,
        /// The closest built-in name, if any is close.
        nearest: Option<String>,
        /// Every built-in name.
        known: String,
    },
    /// A parameter that the built-in scene does not take.
    #[error(
        "the scene \"{scene}\" has no parameter \"{parameter}\"{}; it takes {known}",
        suggestion(.nearest)
    )]
    UnknownParameter {
        /// The built-in scene.
        scene: String,
        /// The parameter asked for.
        parameter: String,
        /// The closest parameter, if any is close.
        nearest: Option<String>,
        /// Every parameter of the scene.
        known: String,
    },
    /// A parameter of a built-in scene outside its range or of the wrong type.
    #[error("{scene}: {parameter} is {found}: give {expected}")]
    BadParameter {
        /// The built-in scene.
        scene: String,
        /// The parameter.
        parameter: String,
        /// What was given.
        found: String,
        /// What is accepted.
        expected: String,
    },
    /// A generator that did not find a structure within its attempts.
    #[error("{scene}: {reason}")]
    NotGenerated {
        /// The built-in scene.
        scene: String,
        /// What was tried, and what to change.
        reason: String,
    },
    /// A scene file that cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// What is wrong with a scene file: the file, the place in it and the fix.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file could not be opened or read.
    #[error("{file}: cannot be read: {reason}")]
    Read {
        /// The file.
        file: String,
        /// The operating system's words.
        reason: String,
    },
    /// The file could not be written; an existing one is left as it was.
    #[error("{file}: cannot be written: {reason}; an existing file is unchanged")]
    Write {
        /// The file.
        file: String,
        /// The operating system's words.
        reason: String,
    },
    /// There is no text at all.
    #[error("{file}: it is empty: give a scene, as Scene.save and drystone scene write it")]
    Empty {
        /// The file.
        file: String,
    },
    /// The text ends in the middle of the scene.
    #[error("{file}: the file ends early, at line {line} column {column}: it was cut short, copy it again")]
    Truncated {
        /// The file.
        file: String,
        /// Line of the end, from 1.
        line: usize,
        /// Column of the end, from 1.
        column: usize,
    },
    /// The text is not JSON.
    #[error("{file}: not valid JSON at line {line} column {column}: {reason}")]
    Syntax {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What the parser expected.
        reason: String,
    },
    /// The JSON is not a drystone scene.
    #[error("{file}: \"format\" is {found}: a scene file says \"drystone-scene\"")]
    WrongFormat {
        /// The file.
        file: String,
        /// What stands there.
        found: String,
    },
    /// A version this library does not know.
    #[error(
        "{file}: \"version\" is {found}, and this library reads versions up to {supported}: \
         update drystone, or save the scene as one of these"
    )]
    UnsupportedVersion {
        /// The file.
        file: String,
        /// The file's version.
        found: String,
        /// The newest version that can be read.
        supported: u64,
    },
    /// A dimension this library does not know.
    #[error("{file}: \"dimension\" is {found}: give 2 for the plane or 3 for space")]
    UnsupportedDimension {
        /// The file.
        file: String,
        /// The file's dimension.
        found: String,
    },
    /// A field that the format does not have.
    #[error("{file}: {place}: unknown field \"{field}\"{}; allowed are {allowed}", suggestion(.nearest))]
    UnknownField {
        /// The file.
        file: String,
        /// The block or part of the file.
        place: String,
        /// The field.
        field: String,
        /// The closest allowed field, if any is close.
        nearest: Option<String>,
        /// Every field allowed there.
        allowed: String,
    },
    /// A field that must be there and is not.
    #[error("{file}: {place}: the field {field} is missing: add it")]
    MissingField {
        /// The file.
        file: String,
        /// The block or part of the file.
        place: String,
        /// The field or fields.
        field: String,
    },
    /// A value of the wrong kind.
    #[error("{file}: {place} is {found}: give {expected}")]
    WrongType {
        /// The file.
        file: String,
        /// The block and field.
        place: String,
        /// What stands there.
        found: String,
        /// What must stand there.
        expected: String,
    },
    /// Well-formed, but not a valid scene.
    #[error("{file}: {place}: {error}")]
    Invalid {
        /// The file.
        file: String,
        /// The block or part of the file.
        place: String,
        /// What is wrong with it.
        error: Box<SceneError>,
    },
}

fn suggestion(nearest: &Option<String>) -> String {
    match nearest {
        Some(name) => format!(": did you mean \"{name}\"?"),
        None => String::new(),
    }
}
