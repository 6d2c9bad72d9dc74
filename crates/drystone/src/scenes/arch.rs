//! The semicircular masonry arch.

use super::builder::Builder;
use super::entry::{SceneEntry, friction, integer, number};
use crate::error::SceneError;
use crate::scene::Scene;
use std::f64::consts::PI;

pub(super) const ENTRY: SceneEntry = SceneEntry {
    name: "arch",
    summary: "a semicircular arch of mean radius 1 with radial joints",
    parameters: &[
        integer("voussoirs", 20, [2, 10_000], "blocks along the half circle"),
        number("thickness", 0.2, [1e-3, 1.9], "radial thickness, metres"),
        friction(0.7),
    ],
    make: |given| arch(given.size(0), given.number(1), given.number(2)).map(Into::into),
};

/// A semicircular arch of mean radius 1 m on level ground. The joints are radial; every voussoir
/// is a trapezium with its corners on the inner and the outer circle, numbered from the right.
///
/// Under its own weight it stands only if thick enough, whatever the friction: 0.1075 m for many
/// voussoirs (M. Milankovitch, "Theorie der Druckkurven", 1907; J. Heyman, "The stone skeleton",
/// 1966, has the approximate 0.106).
pub fn arch(voussoirs: usize, thickness: f64, friction: f64) -> Result<Scene, SceneError> {
    ENTRY.check(&[voussoirs as f64, thickness, friction])?;
    let inner = 1.0 - 0.5 * thickness;
    let outer = 1.0 + 0.5 * thickness;
    let mut builder = Builder::new(friction)?;
    builder.ground("ground", -outer - 0.25, outer + 0.25, 0.25)?;
    let joint = |k: usize| direction(k, voussoirs);
    for k in 0..voussoirs {
        let [from, to] = [joint(k), joint(k + 1)];
        let corners = [from.map(|x| inner * x), from.map(|x| outer * x), to.map(|x| outer * x), to.map(|x| inner * x)];
        builder.polygon(&corners)?;
    }
    Ok(builder.finish())
}

/// Unit vector along the k-th of `n` + 1 joints; the first and the last are exactly level.
fn direction(k: usize, n: usize) -> [f64; 2] {
    match k {
        0 => [1.0, 0.0],
        _ if k == n => [-1.0, 0.0],
        _ => {
            let (sin, cos) = (PI * k as f64 / n as f64).sin_cos();
            [cos, sin]
        }
    }
}
