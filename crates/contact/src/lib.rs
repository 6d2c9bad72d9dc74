//! One time step's contact problem, exactly: impulses on Coulomb's round cone, and the velocities at the end of the step.
//!
//! Given velocities without contacts `v*`, a mass matrix M, and contacts with Jacobian J, coefficients mu and offsets c, find
//!
//! ```text
//! v = v* + M^-1 J' p,    u = J v   (of each contact: u_n along its normal, u_t along its tangents)
//! 0 <= p_n  complementary to  u_n + c >= 0
//! |p_t| <= mu p_n,  and  p_t = -mu p_n u_t / |u_t|  where u_t is not zero
//! ```
//!
//! The cone is round, not a pyramid: a plate thrown in any direction slides on a straight line. This is the problem of the
//! collection FCLIB (Acary and others, 2014), and what Siconos, MuJoCo and other simulators solve in every step.
//!
//! Read in this order: [`Bodies`] and [`Contact`] (rigid bodies) or [`Matrices`] (any M), [`Settings`] (the one tolerance), [`Solution`]
//! and [`Status`]. The method: sweeps over the contacts find roughly who sticks, slides and parts; Newton's method on contacts that
//! give way less and less (an augmented Lagrangian) makes it exact. What was measured and what lost: docs/theory/step-solver.md.
//!
//! A puck of 2 kg on ice of coefficient .1 that moves at 3 m/s, 4 m/s along the two tangents and falls at .1 m/s in this step:
//!
//! ```
//! use drystone_contact::{Bodies, Contact, Settings, Status};
//!
//! let mut rows = [[0.0; 6]; 3];
//! (rows[0][2], rows[1][0], rows[2][1]) = (1.0, 1.0, 1.0); // the normal is z, and no lever turns it
//! let problem = Bodies {
//!     size: 6,
//!     inverse_mass: vec![0.5, 0.5, 0.5, 1.0, 1.0, 1.0],
//!     free: vec![3.0, 4.0, -0.1, 0.0, 0.0, 0.0],
//!     contacts: vec![Contact { bodies: [None, Some(0)], jacobian: [[[0.0; 6]; 3], rows], friction: 0.1, offset: 0.0 }],
//! };
//! let solution = problem.solve(None, &Settings::default())?;
//! assert_eq!(solution.status, Status::Solved);
//! // The normal impulse stops the fall, .2 N s; friction, .02 N s, takes .01 m/s from 5 m/s, in the direction of the motion.
//! let expected = [0.2, -0.012, -0.016];
//! assert!(solution.impulses.iter().zip(expected).all(|(p, q)| (p - q).abs() < 1e-9));
//! assert!((solution.velocities[0] - 2.994).abs() < 1e-9 && (solution.velocities[1] - 3.992).abs() < 1e-9);
//! # Ok::<(), drystone_contact::ContactError>(())
//! ```
#![allow(clippy::needless_range_loop)] // Loops over several small arrays at once.

mod active_set;
mod best;
mod cholesky;
mod drift;
mod error;
mod general;
mod islands;
mod law;
mod lemke;
mod local;
mod matrix;
mod method;
mod newton;
mod path;
mod place;
mod problem;
mod regions;
mod settings;
mod softened;
mod solution;
mod solving;
mod sweep;
mod system;
mod way;
mod wide;

pub use error::ContactError;
pub use general::Matrices;
pub use problem::{Bodies, Contact};
pub use settings::{MOST_FRICTION, RELATIVE_TOLERANCE, Settings};
pub use solution::{Counts, Solution, Status};
