//! A scene as text.

use super::shapes::{PoseRecord, ShapeRecord, Stored};
use super::weight::{self, WeightRecord};
use super::{
    FORMAT, VERSION,
    loads::{self, LoadRecord},
    settlements::{self, SettlementRecord},
};
use crate::interrupt::poll;
use crate::scene::{Body, SceneOf};
use serde::Serialize;

/// The order of the fields is that of the file.
#[derive(Serialize)]
struct BodyRecord<'a> {
    name: &'a str,
    #[serde(flatten)]
    shape: ShapeRecord,
    #[serde(flatten)]
    pose: PoseRecord,
    #[serde(flatten)]
    weight: WeightRecord,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: Option<f64>,
    fixed: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    loads: Vec<LoadRecord<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    settlements: Vec<SettlementRecord<'a>>,
}

/// The scene as JSON, one body a line so that two versions compare well.
pub(crate) fn to_json<S: Stored>(scene: &SceneOf<S>) -> String {
    let tolerance = match scene.contact_tolerance() {
        Some(tolerance) => format!("  \"contact_tolerance\": {},\n", number(tolerance)),
        None => String::new(),
    };
    let bodies: Vec<String> = scene.bodies().iter().map(body_line).collect();
    let list = match bodies.is_empty() {
        true => "[]".to_owned(),
        false => format!("[\n{}\n  ]", bodies.join(",\n")),
    };
    let gravity: Vec<String> = scene.gravity().as_ref().iter().copied().map(number).collect();
    let loaded = scene.bodies().iter().any(|body| !body.loads().is_empty());
    let pairs: Vec<String> = loads::pairs(scene).iter().map(line).collect();
    let version = match scene.settling() {
        Some(_) => VERSION,
        None if loaded || !pairs.is_empty() => 2,
        None => 1,
    };
    let pairs = match pairs.is_empty() {
        true => String::new(),
        false => format!(",\n  \"pair_friction\": [\n{}\n  ]", pairs.join(",\n")),
    };
    format!(
        "{{\n  \"format\": \"{FORMAT}\",\n  \"version\": {version},\n  \"dimension\": {},\n  \
         \"gravity\": [{}],\n  \"friction\": {},\n{tolerance}  \"bodies\": {list}{pairs}\n}}\n",
        S::DIMENSION,
        gravity.join(", "),
        number(scene.friction()),
    )
}

/// Operations to write a body, about.
const BODY: usize = 4000;

fn body_line<S: Stored>(body: &Body<S>) -> String {
    poll(BODY);
    let (shape, pose) = S::record(body);
    let weight = weight::record(body);
    let (friction, fixed, loads) = (body.friction, body.fixed, body.loads().iter().map(loads::record).collect());
    let settlements = body.settlements().iter().map(settlements::record).collect();
    let record = BodyRecord { name: &body.name, shape, pose, weight, friction, fixed, loads, settlements };
    line(&record)
}

fn line(record: &impl Serialize) -> String {
    let text = serde_json::to_string(record).expect("a record of names and finite numbers");
    format!("    {text}")
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    serde_json::Number::from_f64(value).expect("a scene holds finite numbers only").to_string()
}
