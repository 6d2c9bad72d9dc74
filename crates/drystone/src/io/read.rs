//! A scene from text.

use super::fields::{Fields, brief, wrong_type};
use super::{FORMAT, VERSION};
use crate::error::{FileError, SceneError};
use crate::geometry::Pose;
use crate::scene::{BodyOptions, Scene};
use serde_json::Value;

const SCENE_FIELDS: [&str; 7] =
    ["format", "version", "dimension", "gravity", "friction", "contact_tolerance", "bodies"];

const BODY_FIELDS: [&str; 8] = ["name", "box", "polygon", "position", "angle", "density", "friction", "fixed"];

/// Reads a scene from the text of a scene file. `file` is the name by which errors call it.
///
/// Every error is a [`SceneError::File`] that says file, place and fix; a body that is
/// well-formed but not valid is [`FileError::Invalid`] around the reason.
pub fn from_json(text: &str, file: &str) -> Result<Scene, SceneError> {
    let document: Value = serde_json::from_str(text).map_err(|error| syntax(file, text, &error))?;
    check_header(file, &document)?;
    let head = Fields::of(file, "the scene".to_owned(), &document, &SCENE_FIELDS)?;
    let gravity = head.pair("gravity")?.ok_or_else(|| head.missing("\"gravity\""))?;
    let friction = head.number("friction")?.ok_or_else(|| head.missing("\"friction\""))?;
    let mut scene = Scene::new(gravity, friction).map_err(|error| invalid(&head, error))?;
    if let Some(tolerance) = head.number("contact_tolerance")? {
        scene = scene.with_contact_tolerance(tolerance).map_err(|error| invalid(&head, error))?;
    }
    let bodies = head.required("bodies")?;
    let Value::Array(bodies) = bodies else {
        let place = "the scene: \"bodies\"".to_owned();
        return Err(wrong_type(file, place, bodies, "a list of bodies: [...]").into());
    };
    for (index, body) in bodies.iter().enumerate() {
        add_body(&mut scene, file, index, body)?;
    }
    Ok(scene)
}

/// Format, version and dimension come first: a file of another version has other fields.
fn check_header(file: &str, document: &Value) -> Result<(), FileError> {
    let file = file.to_owned();
    let field = |name: &str| document.get(name);
    let found = |name: &str| field(name).map_or("missing".to_owned(), brief);
    if field("format").and_then(Value::as_str) != Some(FORMAT) {
        return Err(FileError::WrongFormat { file, found: found("format") });
    }
    if field("version").and_then(Value::as_u64) != Some(VERSION) {
        let found = found("version");
        return Err(FileError::UnsupportedVersion { file, found, supported: VERSION });
    }
    if field("dimension").and_then(Value::as_u64) != Some(2) {
        return Err(FileError::UnsupportedDimension { file, found: found("dimension") });
    }
    Ok(())
}

fn add_body(scene: &mut Scene, file: &str, index: usize, value: &Value) -> Result<(), SceneError> {
    let place = match value.get("name").and_then(Value::as_str) {
        Some(name) => format!("bodies[{index}] \"{name}\""),
        None => format!("bodies[{index}]"),
    };
    let body = Fields::of(file, place, value, &BODY_FIELDS)?;
    let frame =
        Pose { position: body.pair("position")?.unwrap_or([0.0, 0.0]), angle: body.number("angle")?.unwrap_or(0.0) };
    let plain = BodyOptions::default();
    let options = BodyOptions {
        name: body.string("name")?,
        density: body.number("density")?.unwrap_or(plain.density),
        friction: body.number("friction")?,
        fixed: body.flag("fixed")?.unwrap_or(plain.fixed),
    };
    let added = match read_shape(&body)? {
        Shape::Box(size) => scene.add_box(frame.position, size, frame.angle, options),
        Shape::Polygon(vertices) => scene.add_placed_polygon(&vertices, frame, options),
    };
    added.map_err(|error| invalid(&body, error))?;
    Ok(())
}

enum Shape {
    Box([f64; 2]),
    Polygon(Vec<[f64; 2]>),
}

fn read_shape(body: &Fields) -> Result<Shape, FileError> {
    let part = |field: &str, value| {
        Fields::of(
            body.file,
            format!("{}: \"{field}\"", body.place),
            value,
            match field {
                "box" => &["size"],
                _ => &["vertices"],
            },
        )
    };
    match (body.get("box"), body.get("polygon")) {
        (Some(value), None) => {
            let shape = part("box", value)?;
            let size = shape.pair("size")?;
            size.map(Shape::Box).ok_or_else(|| shape.missing("\"size\""))
        }
        (None, Some(value)) => {
            let shape = part("polygon", value)?;
            let vertices = shape.pairs("vertices")?;
            vertices.map(Shape::Polygon).ok_or_else(|| shape.missing("\"vertices\""))
        }
        (None, None) => Err(body.missing("\"box\" or \"polygon\"")),
        (Some(_), Some(value)) => {
            let place = format!("{}: \"polygon\" beside \"box\"", body.place);
            Err(wrong_type(body.file, place, value, "one of the two only"))
        }
    }
}

fn invalid(fields: &Fields, error: SceneError) -> SceneError {
    let (file, place) = (fields.file.to_owned(), fields.place.clone());
    FileError::Invalid { file, place, error: Box::new(error) }.into()
}

fn syntax(file: &str, text: &str, error: &serde_json::Error) -> FileError {
    let (file, line, column) = (file.to_owned(), error.line(), error.column());
    if error.is_eof() {
        return FileError::Truncated { file, line, column };
    }
    let mut reason = error.to_string();
    // The parser appends the place, which is told apart already.
    if let Some(end) = reason.find(" at line ") {
        reason.truncate(end);
    }
    if text.contains("NaN") || text.contains("Infinity") {
        reason.push_str(" (JSON has no NaN or Infinity: give finite numbers)");
    }
    FileError::Syntax { file, line, column, reason }
}
