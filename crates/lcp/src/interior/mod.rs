//! How blocks begin to move, and the contact forces, by an interior-point method in body space.
//!
//! ```text
//! min 1/2 a' M a - a' F   over   s = J a in K*                                        (1)
//!
//! M a - J' f = F,   s = J a,   f in K,  s in K*,  f' s = 0                             (2)
//! ```
//!
//! (1) is Gauss's principle of least constraint (1829): of all accelerations that keep the contacts from closing, the blocks
//! take those nearest to free fall, M^-1 F. (2) are its optimality conditions, f the contact forces. `K` is a product of
//! cones, one for each contact point: magnitudes `f >= 0` along the edges of a pyramid, or Coulomb's round cone
//! `|f_t| <= mu f_n`. The answer exists always, and a is unique: a = 0 with forces is rest, anything else how it falls.
//!
//! *Which method.* Predictor and corrector (Mehrotra 1992) along the scaling of Nesterov and Todd (1997; formulas as in
//! Vandenberghe, The CVXOPT linear and quadratic cone program solvers, 2010). Eliminating s and f leaves in every iteration
//!
//! ```text
//! (M + J' (W^2 + delta I)^-1 J) da = r                                                 (3)
//! ```
//!
//! a matrix of one block for each body and one for each pair that touches, however many points or edges lie between:
//! `matrix.rs`. Its pattern is analysed once. The proximal term delta on the forces (Friedlander and Orban 2012; Schwan and
//! others, PIQP, 2023) makes structures with stresses of their own, where (2) has many f, the normal case.
//!
//! *When.* From nothing, or where friction must carry much: some ten to twenty iterations whatever the size. Where one block
//! comes or goes, [`cone`](crate::cone) is hundreds of times faster. What was measured: docs/theory/interior-point.md.

mod barrier;
mod block_cholesky;
mod blocks;
mod elastic;
mod layers;
mod matrix;
mod method;
mod metric;
mod nearby;
mod problem;
mod resting;
mod restoring;
mod scaled;
mod scaling;
mod solving;
mod supernodes;
mod walk;

pub use barrier::Barrier;
pub use layers::Layers;
pub use method::{End, Found};
pub use problem::{Cone, Gauss, Point};
pub use walk::Walked;
