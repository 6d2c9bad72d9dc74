//! Principal moments and axes of a tensor of inertia.

use super::Vector3;
use faer::{Mat, Side};

/// Products of inertia below this share of the moments are rounding: the body's own axes are principal then, and wrenches
/// along them have fewer entries.
const ALIGNED: f64 = 1e-13;

/// The axes of a body's own frame.
pub(crate) const OWN_AXES: [Vector3; 3] = [Vector3::X, Vector3::Y, Vector3::Z];

/// Principal moments and axes of a symmetric tensor; of the two halves the lower one is read.
pub(crate) fn principal(tensor: [[f64; 3]; 3]) -> ([f64; 3], [Vector3; 3]) {
    let diagonal = [tensor[0][0], tensor[1][1], tensor[2][2]];
    let largest = diagonal.into_iter().fold(0.0, f64::max);
    let aligned = (diagonal, OWN_AXES);
    let products = [tensor[1][0], tensor[2][0], tensor[2][1]];
    if products.iter().all(|product| product.abs() <= ALIGNED * largest) {
        return aligned;
    }
    let tensor = Mat::from_fn(3, 3, |i, j| tensor[i][j]);
    let Ok(eigen) = tensor.self_adjoint_eigen(Side::Lower) else { return aligned };
    let axis = |k: usize| Vector3::new(eigen.U()[(0, k)], eigen.U()[(1, k)], eigen.U()[(2, k)]);
    ([0, 1, 2].map(|k| eigen.S()[k]), [axis(0), axis(1), axis(2)])
}
