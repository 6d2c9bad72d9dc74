//! Permanent loads of bodies and the friction of pairs in a scene file: both from version 2 on.

use super::fields::{Fields, wrong_type};
use super::shapes::Stored;
use super::turning::{Turning, turning};
use crate::error::{FileError, SceneError};
use crate::geometry::{Numbers, minus_of};
use crate::load::Load;
use crate::scene::SceneOf;
use serde::Serialize;
use serde_json::Value;

/// A load as it is written.
#[derive(Serialize)]
pub(super) struct LoadRecord<'a> {
    name: &'a str,
    force: &'a [f64],
    at: &'a [f64],
    #[serde(skip_serializing_if = "Option::is_none")]
    moment: Option<Turning>,
}

/// What is written of a load.
pub(super) fn record<V: Numbers>(load: &Load<V>) -> LoadRecord<'_> {
    let moment = Turning::of(load.moment, load.force.as_ref().len());
    LoadRecord { name: &load.name, force: load.force.as_ref(), at: load.at.as_ref(), moment }
}

/// A pair with a coefficient of friction of its own, as it is written.
#[derive(Serialize)]
pub(super) struct PairRecord<'a> {
    bodies: [&'a str; 2],
    friction: f64,
}

/// What is written of the friction of pairs.
pub(super) fn pairs<S: Stored>(scene: &SceneOf<S>) -> Vec<PairRecord<'_>> {
    let name = |i: usize| scene.bodies()[i].name.as_str();
    scene.pair_frictions().map(|(pair, friction)| PairRecord { bodies: pair.map(name), friction }).collect()
}

/// Reads the loads of the body that was added last, whose frame stands in the file at `frame`.
pub(super) fn add_loads<S: Stored>(
    scene: &mut SceneOf<S>,
    body: &Fields,
    index: usize,
    frame: S::Pose,
) -> Result<(), SceneError> {
    let Some(loads) = body.get("loads") else { return Ok(()) };
    let Value::Array(loads) = loads else {
        return Err(body.wrong("\"loads\"", loads, "a list of loads: [...]").into());
    };
    let pose = scene.bodies()[index].pose;
    // Where the file's frame has its origin, seen from the body's own, the centre of mass.
    let origin = S::seen_from(&frame, S::place(&pose));
    for (k, load) in loads.iter().enumerate() {
        let place = format!("{}: \"loads\"[{k}]", body.place);
        let load = Fields::of(body.file, place, load, &["name", "force", "at", "moment"])?;
        let force = S::vector(&load, "force")?.unwrap_or_default();
        let at = match S::vector(&load, "at")? {
            Some(at) => minus_of(at, &origin),
            None => scene.bodies()[index].shape.centroid(),
        };
        let moment = turning::<S>(&load, "moment")?;
        let added = scene.push_load(index, load.string("name")?, force, at, moment);
        added.map_err(|error| load.invalid(error))?;
    }
    Ok(())
}

/// Reads the friction of pairs.
pub(super) fn add_pairs<S: Stored>(scene: &mut SceneOf<S>, head: &Fields) -> Result<(), SceneError> {
    let Some(pairs) = head.get("pair_friction") else { return Ok(()) };
    let Value::Array(pairs) = pairs else {
        return Err(head.wrong("\"pair_friction\"", pairs, "a list of pairs: [...]").into());
    };
    for (k, pair) in pairs.iter().enumerate() {
        let place = format!("the scene: \"pair_friction\"[{k}]");
        let pair = Fields::of(head.file, place, pair, &["bodies", "friction"])?;
        let names = pair.required("bodies")?;
        let (a, b) = two_names(&pair, names)?;
        let friction = pair.number("friction")?.ok_or_else(|| pair.missing("\"friction\""))?;
        scene.set_friction(a, b, friction).map_err(|error| pair.invalid(error))?;
    }
    Ok(())
}

fn two_names<'a>(pair: &Fields, names: &'a Value) -> Result<(&'a str, &'a str), FileError> {
    let found = names.as_array().and_then(|names| match names.as_slice() {
        [a, b] => a.as_str().zip(b.as_str()),
        _ => None,
    });
    let place = || format!("{}: \"bodies\"", pair.place);
    found.ok_or_else(|| wrong_type(pair.file, place(), names, "two names: [\"a\", \"b\"]"))
}
