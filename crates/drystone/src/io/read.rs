//! A scene from text.

use super::fields::{Fields, brief, wrong_type};
use super::shapes::Stored;
use super::unique::Unique;
use super::{FORMAT, VERSION, loads, settlements, weight};
use crate::any_scene::AnyScene;
use crate::error::{FileError, SceneError};
use crate::geometry::{Polygon, Solid};
use crate::interrupt::apart;
use crate::scene::{BodyOptions, SceneOf};
use serde_json::Value;

const SCENE_FIELDS: [&str; 8] =
    ["format", "version", "dimension", "gravity", "friction", "contact_tolerance", "bodies", "pair_friction"];

/// Fields of a body besides its shape, its place and its weight.
const BODY_FIELDS: [&str; 5] = ["name", "friction", "fixed", "loads", "settlements"];

/// What some editors write before the text.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Operations to parse a byte, about.
const PARSING: usize = 32;

/// Reads a scene from the text of a scene file. `file` is the name by which errors call it.
///
/// Every error is a [`SceneError::File`] that says file, place and fix; a body that is
/// well-formed but not valid is [`FileError::Invalid`] around the reason.
pub fn from_json(text: &str, file: &str) -> Result<AnyScene, SceneError> {
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    let owned = text.to_owned();
    let parsed = apart(PARSING * text.len(), move || serde_json::from_str::<Unique>(&owned));
    let Unique(document) = parsed.map_err(|error| syntax(file, text, &error))?;
    match dimension(file, &document)? {
        2 => read::<Polygon>(file, &document).map(AnyScene::Plane),
        _ => read::<Solid>(file, &document).map(AnyScene::Space),
    }
}

fn read<S: Stored>(file: &str, document: &Value) -> Result<SceneOf<S>, SceneError> {
    let head = Fields::of(file, "the scene".to_owned(), document, &SCENE_FIELDS)?;
    let gravity = S::vector(&head, "gravity")?.ok_or_else(|| head.missing("\"gravity\""))?;
    let friction = head.number("friction")?.ok_or_else(|| head.missing("\"friction\""))?;
    let mut scene = SceneOf::new(gravity, friction).map_err(|error| head.invalid(error))?;
    if let Some(tolerance) = head.number("contact_tolerance")? {
        scene = scene.with_contact_tolerance(tolerance).map_err(|error| head.invalid(error))?;
    }
    let bodies = head.required("bodies")?;
    let Value::Array(bodies) = bodies else {
        let place = "the scene: \"bodies\"".to_owned();
        return Err(wrong_type(file, place, bodies, "a list of bodies: [...]").into());
    };
    for (index, body) in bodies.iter().enumerate() {
        add_body(&mut scene, file, index, body)?;
    }
    loads::add_pairs(&mut scene, &head)?;
    Ok(scene)
}

/// Format, version and dimension come first: a file of another version has other fields.
fn dimension(file: &str, document: &Value) -> Result<u64, FileError> {
    let file = file.to_owned();
    let field = |name: &str| document.get(name);
    let found = |name: &str| field(name).map_or("missing".to_owned(), brief);
    if field("format").and_then(Value::as_str) != Some(FORMAT) {
        return Err(FileError::WrongFormat { file, found: found("format") });
    }
    if !field("version").and_then(Value::as_u64).is_some_and(|version| (1..=VERSION).contains(&version)) {
        let found = found("version");
        return Err(FileError::UnsupportedVersion { file, found, supported: VERSION });
    }
    match field("dimension").and_then(Value::as_u64) {
        Some(dimension @ 2..=3) => Ok(dimension),
        _ => Err(FileError::UnsupportedDimension { file, found: found("dimension") }),
    }
}

fn add_body<S: Stored>(scene: &mut SceneOf<S>, file: &str, index: usize, value: &Value) -> Result<(), SceneError> {
    let place = match value.get("name").and_then(Value::as_str) {
        Some(name) => format!("bodies[{index}] \"{name}\""),
        None => format!("bodies[{index}]"),
    };
    let allowed: Vec<&str> = BODY_FIELDS.iter().chain(&weight::FIELDS).chain(S::FIELDS).copied().collect();
    let body = Fields::of(file, place, value, &allowed)?;
    let plain = BodyOptions::default();
    let options = BodyOptions {
        name: body.string("name")?,
        density: body.number("density")?.unwrap_or(plain.density),
        friction: body.number("friction")?,
        fixed: body.flag("fixed")?.unwrap_or(plain.fixed),
        own: weight::own::<S>(&body)?,
    };
    let shape = S::shape(&body)?;
    let pose = S::pose(&body)?;
    let index = S::add(scene, shape, pose, options).map_err(|error| body.invalid(error))?;
    loads::add_loads(scene, &body, index, pose)?;
    settlements::add_settlements(scene, &body, index, pose)
}

fn syntax(file: &str, text: &str, error: &serde_json::Error) -> FileError {
    let (file, line, column) = (file.to_owned(), error.line(), error.column());
    if text.trim().is_empty() {
        return FileError::Empty { file };
    }
    if error.is_eof() {
        return FileError::Truncated { file, line, column };
    }
    let mut reason = error.to_string();
    // The parser appends the place, which is told apart already.
    if let Some(end) = reason.find(" at line ") {
        reason.truncate(end);
    }
    let wrong = text.lines().nth(line.saturating_sub(1)).unwrap_or_default();
    if wrong.contains("NaN") || wrong.contains("Infinity") {
        reason.push_str(" (JSON has no NaN or Infinity: give finite numbers)");
    }
    FileError::Syntax { file, line, column, reason }
}
