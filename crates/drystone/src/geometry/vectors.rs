//! Vectors as they stand in contacts, wrenches and directions: of three numbers, and of as many as the dimension asks for.

use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// A fixed count of numbers: `[f64; 2]`, `[f64; 3]`, `[f64; 6]`.
pub trait Numbers:
    Copy + Debug + Default + PartialEq + AsRef<[f64]> + AsMut<[f64]> + Serialize + DeserializeOwned + Send + Sync + 'static
{
}

impl<T> Numbers for T where
    T: Copy
        + Debug
        + Default
        + PartialEq
        + AsRef<[f64]>
        + AsMut<[f64]>
        + Serialize
        + DeserializeOwned
        + Send
        + Sync
        + 'static
{
}

/// A cross product this short, of unit vectors, is that of parallel ones.
const PARALLEL: f64 = 1e-9;

/// Scalar product.
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along another one, if that is not all but zero.
pub(crate) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length > PARALLEL).then(|| a.map(|x| x / length))
}

/// The difference.
pub(crate) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Length of a vector. In the plane, where z is 0, that of the two others to the bit.
pub(crate) fn length([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).hypot(z)
}

/// Scalar product, in any dimension.
pub(crate) fn product<V: Numbers>(a: &V, b: &V) -> f64 {
    a.as_ref().iter().zip(b.as_ref()).map(|(a, b)| a * b).sum()
}

/// `a + share b`, in any dimension.
pub(crate) fn plus_times<V: Numbers>(mut a: V, share: f64, b: &V) -> V {
    a.as_mut().iter_mut().zip(b.as_ref()).for_each(|(a, b)| *a += share * b);
    a
}

/// The difference, in any dimension.
pub(crate) fn minus_of<V: Numbers>(a: V, b: &V) -> V {
    plus_times(a, -1.0, b)
}

/// Length, in any dimension.
pub(crate) fn norm(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |length: f64, x| length.hypot(*x))
}
