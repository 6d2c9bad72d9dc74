//! Contact dynamics of stacked rigid bodies, exact and with computation reuse.
//!
//! The data's way, and the reading order:
//!
//! ```text
//! scene -> geometry -> contact -> formulate -> drystone_lcp -> check | plan | simulate
//! ```
//!
//! - [`scene`]: gravity, friction and blocks, each checked when it is added. The built-in ones are
//!   in [`scenes`], and [`io`] reads and writes them as versioned JSON. [`bounds`]: which numbers they may hold.
//! - [`geometry`]: convex polygons, their poses, areas and moments.
//! - [`contact`]: which blocks touch, where and along which normal, with stable identities.
//! - [`formulate`]: the contacts as a complementarity problem, and its solution as forces and accelerations.
//! - [`mod@check`]: does it stand? - [`mod@strong`]: must it? - [`unsupported`]: what bears on nothing? - [`structure`]: and now, with this block more or less? - [`mod@plan`]: in which order does it come apart without falling?
//! - [`simulate`]: how does it move?
//!
//! Units are SI throughout: metres, kilograms, seconds, radians, newtons.

mod any_scene;
pub mod bounds;
pub mod canonical;
pub mod check;
mod checked;
pub mod contact;
mod crossover;
mod equilibrium;
pub mod error;
pub mod formulate;
pub mod geometry;
pub mod io;
mod judgement;
mod ladder;
pub mod limit;
pub mod load;
mod mass_properties;
mod nearby;
pub mod plan;
mod proof;
pub mod scene;
mod scene_in_space;
mod scene_loads;
mod scene_settlements;
pub mod scenes;
pub mod settle;
mod settlement;
pub mod simulate;
pub mod strong;
pub mod structure;
mod suggest;
mod takedown;
mod threads;
pub mod unsupported;

pub use any_scene::AnyScene;
pub use check::{Verdict, check};
pub use contact::{Contact, ContactId, ContactSet, Feature, find_contacts};
pub use drystone_lcp::interrupt;
pub use error::{FileError, InertiaFault, SceneError};
pub use load::{Load, LoadOptions};
pub use mass_properties::MassProperties;
pub use scene::{Body, BodyOptions, Scene, SceneOf};
pub use scene_in_space::SceneInSpace;
pub use settlement::Settlement;
pub use structure::Structure;

/// The first page of this crate; its example is run with the others.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct FirstPage;
