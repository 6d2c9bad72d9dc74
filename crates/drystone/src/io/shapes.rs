//! What differs between the files of planar and of spatial scenes: shapes and poses.

use super::fields::{Fields, wrong_type};
use crate::error::{FileError, SceneError};
use crate::geometry::{Polygon, Pose, PoseInSpace, Shape, Solid};
use crate::scene::{Body, BodyOptions, SceneOf};
use serde::Serialize;
use serde_json::Value;

/// Shapes that a scene file can hold.
pub(crate) trait Stored: Shape {
    /// Fields of a body that say its shape and its place.
    const FIELDS: &'static [&'static str];
    /// 2 or 3.
    const DIMENSION: usize;

    /// A vector in a field.
    ///
    /// # Errors
    /// [`FileError`].
    fn vector(fields: &Fields, field: &str) -> Result<Option<Self::Vector>, FileError>;

    /// The frame of a body.
    ///
    /// # Errors
    /// [`FileError`].
    fn pose(body: &Fields) -> Result<Self::Pose, FileError>;

    /// What a body says of its shape.
    ///
    /// # Errors
    /// [`FileError`].
    fn shape(body: &Fields) -> Result<Described<Self>, FileError>;

    /// Adds a body of that shape to a scene.
    ///
    /// # Errors
    /// [`SceneError`].
    fn add(
        scene: &mut SceneOf<Self>,
        shape: Described<Self>,
        pose: Self::Pose,
        options: BodyOptions,
    ) -> Result<usize, SceneError>;

    /// The shape and the place of a body, in the order of the file.
    fn record(body: &Body<Self>) -> (ShapeRecord, PoseRecord);
}

/// A shape as a file describes it.
pub(crate) enum Described<S: Stored> {
    /// By its sides.
    Box(S::Vector),
    /// By its corners; in the plane one list of them.
    Pieces(Vec<Vec<S::Vector>>),
    /// By a closed surface; in space only.
    Surface(Vec<[f64; 3]>, Vec<[u32; 3]>),
}

/// A shape as it is written.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ShapeRecord {
    /// By its sides.
    Box {
        /// Metres.
        size: Vec<f64>,
    },
    /// By its corners.
    Polygon {
        /// Metres.
        vertices: Vec<[f64; 2]>,
    },
    /// By its convex pieces.
    Solid {
        /// Corners of each.
        pieces: Vec<PieceRecord>,
    },
    /// By its surface.
    Surface {
        /// Metres.
        vertices: Vec<[f64; 3]>,
        /// Three vertices each.
        triangles: Vec<[u32; 3]>,
    },
}

/// A convex piece as it is written.
#[derive(Serialize)]
pub(crate) struct PieceRecord {
    vertices: Vec<[f64; 3]>,
}

/// A place as it is written.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum PoseRecord {
    /// In the plane.
    Plane {
        /// Metres.
        position: [f64; 2],
        /// Radians.
        angle: f64,
    },
    /// In space.
    Space {
        /// Metres.
        position: [f64; 3],
        /// Unit quaternion (w, x, y, z).
        orientation: [f64; 4],
    },
}

impl Stored for Polygon {
    const FIELDS: &'static [&'static str] = &["box", "polygon", "position", "angle"];
    const DIMENSION: usize = 2;

    fn vector(fields: &Fields, field: &str) -> Result<Option<[f64; 2]>, FileError> {
        fields.numbers(field)
    }

    fn pose(body: &Fields) -> Result<Pose, FileError> {
        let position = body.numbers("position")?.unwrap_or([0.0; 2]);
        Ok(Pose { position, angle: body.number("angle")?.unwrap_or(0.0) })
    }

    fn shape(body: &Fields) -> Result<Described<Self>, FileError> {
        either(body, "polygon", |value| {
            let shape = part(body, "polygon", value, "vertices")?;
            let vertices = shape.points("vertices")?;
            Ok(vec![vertices.ok_or_else(|| shape.missing("\"vertices\""))?])
        })
    }

    fn add(
        scene: &mut SceneOf<Self>,
        shape: Described<Self>,
        pose: Pose,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        match shape {
            Described::Box(size) => scene.add_box(pose.position, size, pose.angle, options),
            Described::Pieces(pieces) => scene.add_placed_polygon(&pieces.concat(), pose, options),
            Described::Surface(..) => Err(SceneError::NotInSpace),
        }
    }

    fn record(body: &Body) -> (ShapeRecord, PoseRecord) {
        let shape = match body.box_size {
            Some(size) => ShapeRecord::Box { size: size.to_vec() },
            None => ShapeRecord::Polygon { vertices: body.shape.vertices().iter().map(|v| v.to_array()).collect() },
        };
        (shape, PoseRecord::Plane { position: body.pose.position, angle: body.pose.angle })
    }
}

impl Stored for Solid {
    const FIELDS: &'static [&'static str] = &["box", "solid", "surface", "position", "orientation"];
    const DIMENSION: usize = 3;

    fn vector(fields: &Fields, field: &str) -> Result<Option<[f64; 3]>, FileError> {
        fields.numbers(field)
    }

    fn pose(body: &Fields) -> Result<PoseInSpace, FileError> {
        let PoseInSpace { position, orientation } = PoseInSpace::WORLD;
        Ok(PoseInSpace {
            position: body.numbers("position")?.unwrap_or(position),
            orientation: body.numbers("orientation")?.unwrap_or(orientation),
        })
    }

    fn shape(body: &Fields) -> Result<Described<Self>, FileError> {
        if let Some(value) = body.get("surface") {
            return surface(body, value);
        }
        either(body, "solid", |value| {
            let solid = part(body, "solid", value, "pieces")?;
            let pieces = solid.required("pieces")?;
            let place = format!("{}: \"solid\": \"pieces\"", body.place);
            let Value::Array(pieces) = pieces else {
                return Err(wrong_type(body.file, place, pieces, "a list of pieces: [...]"));
            };
            let corners = |(k, piece): (usize, &Value)| {
                let piece = Fields::of(body.file, format!("{place}[{k}]"), piece, &["vertices"])?;
                piece.points("vertices")?.ok_or_else(|| piece.missing("\"vertices\""))
            };
            pieces.iter().enumerate().map(corners).collect()
        })
    }

    fn add(
        scene: &mut SceneOf<Self>,
        shape: Described<Self>,
        pose: PoseInSpace,
        options: BodyOptions,
    ) -> Result<usize, SceneError> {
        match shape {
            Described::Box(size) => scene.add_cuboid(pose, size, options),
            Described::Pieces(pieces) => scene.add_solid(&pieces, pose, options),
            Described::Surface(vertices, triangles) => scene.add_surface(&vertices, &triangles, pose, options),
        }
    }

    fn record(body: &Body<Self>) -> (ShapeRecord, PoseRecord) {
        let pieces = body.shape.pieces().iter();
        let piece = |vertices: &[crate::geometry::Vector3]| PieceRecord {
            vertices: vertices.iter().map(|v| v.to_array()).collect(),
        };
        let shape = match (body.box_size, body.shape.surface()) {
            (Some(size), _) => ShapeRecord::Box { size: size.to_vec() },
            (None, Some(surface)) => ShapeRecord::Surface {
                vertices: surface.vertices().iter().map(|v| v.to_array()).collect(),
                triangles: surface.triangles().to_vec(),
            },
            (None, None) => ShapeRecord::Solid { pieces: pieces.map(|p| piece(p.vertices())).collect() },
        };
        let PoseInSpace { position, orientation } = body.pose;
        (shape, PoseRecord::Space { position, orientation })
    }
}

/// A closed surface, if the body has no other shape.
fn surface(body: &Fields, value: &Value) -> Result<Described<Solid>, FileError> {
    if let Some((other, value)) = ["box", "solid"].into_iter().find_map(|other| Some((other, body.get(other)?))) {
        let place = format!("{}: \"{other}\" beside \"surface\"", body.place);
        return Err(wrong_type(body.file, place, value, "one of the two only"));
    }
    let place = format!("{}: \"surface\"", body.place);
    let shape = Fields::of(body.file, place, value, &["vertices", "triangles"])?;
    let vertices = shape.points("vertices")?.ok_or_else(|| shape.missing("\"vertices\""))?;
    let triangles = shape.indices("triangles")?.ok_or_else(|| shape.missing("\"triangles\""))?;
    Ok(Described::Surface(vertices, triangles))
}

/// The one of "box" and another shape that a body has.
fn either<S: Stored>(
    body: &Fields,
    other: &str,
    pieces: impl FnOnce(&Value) -> Result<Vec<Vec<S::Vector>>, FileError>,
) -> Result<Described<S>, FileError> {
    match (body.get("box"), body.get(other)) {
        (Some(value), None) => {
            let shape = part(body, "box", value, "size")?;
            let size = S::vector(&shape, "size")?;
            size.map(Described::Box).ok_or_else(|| shape.missing("\"size\""))
        }
        (None, Some(value)) => pieces(value).map(Described::Pieces),
        (None, None) if S::DIMENSION == 3 => Err(body.missing("\"box\", \"solid\" or \"surface\"")),
        (None, None) => Err(body.missing(&format!("\"box\" or \"{other}\""))),
        (Some(_), Some(value)) => {
            let place = format!("{}: \"{other}\" beside \"box\"", body.place);
            Err(wrong_type(body.file, place, value, "one of the two only"))
        }
    }
}

/// An object in a field of a body, with one field of its own.
fn part<'a>(body: &Fields<'a>, field: &str, value: &'a Value, only: &str) -> Result<Fields<'a>, FileError> {
    Fields::of(body.file, format!("{}: \"{field}\"", body.place), value, &[only])
}
