//! A scene as text.

use super::{FORMAT, VERSION};
use crate::scene::{Body, Scene};
use serde::Serialize;

/// The order of the fields is that of the file.
#[derive(Serialize)]
struct BodyRecord<'a> {
    name: &'a str,
    #[serde(flatten)]
    shape: ShapeRecord,
    position: [f64; 2],
    angle: f64,
    density: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: Option<f64>,
    fixed: bool,
}

#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum ShapeRecord {
    Box { size: [f64; 2] },
    Polygon { vertices: Vec<[f64; 2]> },
}

/// The scene as JSON, one body a line so that two versions compare well.
pub fn to_json(scene: &Scene) -> String {
    let tolerance = match scene.contact_tolerance() {
        Some(tolerance) => format!("  \"contact_tolerance\": {},\n", number(tolerance)),
        None => String::new(),
    };
    let bodies: Vec<String> = scene.bodies().iter().map(body_line).collect();
    let list = match bodies.is_empty() {
        true => "[]".to_owned(),
        false => format!("[\n{}\n  ]", bodies.join(",\n")),
    };
    let [x, y] = scene.gravity().map(number);
    format!(
        "{{\n  \"format\": \"{FORMAT}\",\n  \"version\": {VERSION},\n  \"dimension\": 2,\n  \
         \"gravity\": [{x}, {y}],\n  \"friction\": {},\n{tolerance}  \"bodies\": {list}\n}}\n",
        number(scene.friction()),
    )
}

fn body_line(body: &Body) -> String {
    let shape = match body.box_size {
        Some(size) => ShapeRecord::Box { size },
        None => ShapeRecord::Polygon { vertices: body.shape.vertices().iter().map(|v| v.to_array()).collect() },
    };
    let record = BodyRecord {
        name: &body.name,
        shape,
        position: body.pose.position,
        angle: body.pose.angle,
        density: body.density,
        friction: body.friction,
        fixed: body.fixed,
    };
    let text = serde_json::to_string(&record).expect("a record of names and finite numbers");
    format!("    {text}")
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    serde_json::Number::from_f64(value).expect("a scene holds finite numbers only").to_string()
}
