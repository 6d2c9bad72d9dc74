//! Settlements of supports in a scene file: from version 3 on.

use super::{
    fields::Fields,
    shapes::Stored,
    turning::{Turning, turning},
};
use crate::{
    error::SceneError,
    geometry::{Numbers, minus_of},
    scene::SceneOf,
    settlement::Settlement,
};
use serde::Serialize;
use serde_json::Value;

/// A settlement as it is written.
#[derive(Serialize)]
pub(super) struct SettlementRecord<'a> {
    displacement: &'a [f64],
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<Turning>,
    at: &'a [f64],
}

/// What is written of a settlement.
pub(super) fn record<V: Numbers>(settlement: &Settlement<V>) -> SettlementRecord<'_> {
    let displacement = settlement.displacement.as_ref();
    let rotation = Turning::of(settlement.rotation, displacement.len());
    SettlementRecord { displacement, rotation, at: settlement.at.as_ref() }
}

/// Reads the settlements of the body that was added last, whose frame stands in the file at `frame`.
pub(super) fn add_settlements<S: Stored>(
    scene: &mut SceneOf<S>,
    body: &Fields,
    index: usize,
    frame: S::Pose,
) -> Result<(), SceneError> {
    let Some(settlements) = body.get("settlements") else { return Ok(()) };
    let Value::Array(settlements) = settlements else {
        return Err(body.wrong("\"settlements\"", settlements, "a list of settlements: [...]").into());
    };
    let pose = scene.bodies()[index].pose;
    // Where the file's frame has its origin, seen from the body's own, the centre of mass.
    let origin = S::seen_from(&frame, S::place(&pose));
    for (k, settlement) in settlements.iter().enumerate() {
        let place = format!("{}: \"settlements\"[{k}]", body.place);
        let fields = Fields::of(body.file, place, settlement, &["displacement", "rotation", "at"])?;
        let displacement = S::vector(&fields, "displacement")?.unwrap_or_default();
        let rotation = turning::<S>(&fields, "rotation")?;
        let at = match S::vector(&fields, "at")? {
            Some(at) => minus_of(at, &origin),
            None => scene.bodies()[index].shape.centroid(),
        };
        let added = scene.push_settlement(index, Settlement { displacement, rotation, at });
        added.map_err(|error| fields.invalid(error))?;
    }
    Ok(())
}
