//! A block's own mass, centre of mass and inertia in a scene file.

use super::fields::Fields;
use super::shapes::Stored;
use crate::error::FileError;
use crate::mass_properties::MassProperties;
use crate::scene::Body;
use serde::Serialize;

/// Fields of a body that say what it weighs.
pub(super) const FIELDS: [&str; 4] = ["density", "mass", "center_of_mass", "inertia"];

/// What is written of a body's weight, in the order of the file.
#[derive(Serialize)]
pub(super) struct WeightRecord {
    #[serde(skip_serializing_if = "Option::is_none")]
    density: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mass: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    center_of_mass: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    inertia: Option<InertiaRecord>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum InertiaRecord {
    Plane(f64),
    Space([[f64; 3]; 3]),
}

/// What a body says of its own weight.
///
/// # Errors
/// [`FileError`], also for a mass beside a density.
pub(super) fn own<S: Stored>(body: &Fields) -> Result<MassProperties, FileError> {
    let mass = body.number("mass")?;
    if let (Some(_), Some(density)) = (mass, body.get("density")) {
        return Err(body.wrong("\"density\" beside \"mass\"", density, "one of the two only"));
    }
    let center_of_mass = S::vector(body, "center_of_mass")?.map(|vector| {
        let mut center = [0.0; 3];
        center[..S::DIMENSION].copy_from_slice(vector.as_ref());
        center
    });
    let inertia = match S::DIMENSION {
        2 => body.number("inertia")?.map(|moment| {
            let mut tensor = [[0.0; 3]; 3];
            tensor[2][2] = moment;
            tensor
        }),
        _ => body.tensor("inertia")?,
    };
    Ok(MassProperties { mass, center_of_mass, inertia })
}

/// What is written of a body's weight.
pub(super) fn record<S: Stored>(body: &Body<S>) -> WeightRecord {
    let MassProperties { mass, center_of_mass, inertia } = body.own;
    WeightRecord {
        density: mass.is_none().then_some(body.density),
        mass,
        center_of_mass: center_of_mass.map(|center| center[..S::DIMENSION].to_vec()),
        inertia: inertia.map(|tensor| match S::DIMENSION {
            2 => InertiaRecord::Plane(tensor[2][2]),
            _ => InertiaRecord::Space(tensor),
        }),
    }
}
