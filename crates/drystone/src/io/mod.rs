//! Scenes as versioned JSON.
//!
//! ```json
//! {
//!   "format": "drystone-scene", "version": 1, "dimension": 2,
//!   "gravity": [0.0, -9.81], "friction": 0.5,
//!   "bodies": [
//!     {"name": "ground", "box": {"size": [4.0, 1.0]}, "position": [0.0, -0.5], "fixed": true},
//!     {"name": "wedge", "polygon": {"vertices": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]}}
//!   ]
//! }
//! ```
//!
//! Lengths are metres, angles radians, densities kg/m^2. A body has a "box" or a "polygon" in its
//! own frame, which stands at "position", turned by "angle" (counter-clockwise). In space, which is
//! "dimension" 3, points have three coordinates, densities are in kg/m^3, the shape is a "box" or
//! a "solid" of convex pieces (`{"pieces": [{"vertices": [[x, y, z], ...]}, ...]}`), and a unit quaternion
//! "orientation" (w, x, y, z) takes the place of the angle. A body may say "mass" (kg) instead of "density", and its own
//! "center_of_mass" (m) and "inertia" (kg m^2 about it; in space three rows), both in the frame of the shape. Left out are:
//! name (see [`BodyOptions`](crate::BodyOptions)), position (the origin), angle (0), density (1),
//! friction (the scene's), fixed (false), and the scene's contact_tolerance (see
//! [`contact`](crate::contact)). `docs/scene.schema.json` is the format's JSON Schema.
//!
//! From version 2 on a body may have "loads" (`{"name", "force" (N, world axes), "at" (m, in the frame of the shape), "moment"
//! (N m)}`), and the scene a "pair_friction" (`{"bodies": ["a", "b"], "friction"}`) that goes before the friction of bodies.
//!
//! From version 3 on a fixed body may have "settlements" (`{"displacement" (m, world axes), "rotation" (rad; in space three), "at" (m,
//! in the frame of the shape)}`).
//!
//! Numbers are written with as many digits as they need to come back bit for bit.

mod fields;
mod file;
mod loads;
mod read;
mod settlements;
mod shapes;
mod turning;
mod unique;
mod weight;
mod write;

pub use file::{load, save};
pub use read::from_json;
pub(crate) use write::to_json;

/// What a scene file's "format" says.
pub const FORMAT: &str = "drystone-scene";

/// The newest version: 2 had no settlements, 1 no loads and no friction of pairs either. What is written of a scene is the oldest
/// that holds it.
pub const VERSION: u64 = 3;
