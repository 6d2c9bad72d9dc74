//! A block's own mass, centre of mass and inertia, apart from its shape.

use crate::bounds::COORDINATE;
use crate::checked::{finite, positive};
use crate::error::{InertiaFault, SceneError};
use crate::geometry::{OWN_AXES, Shape, Vector3, principal};

/// Entries (i, j) and (j, i) of a tensor of inertia may differ by this share of the largest entry: the rounding of a tensor
/// that was turned, with room. Their mean is taken.
const SYMMETRIC: f64 = 1e-9;

/// The largest principal moment may exceed the sum of the others by this share of it. No body has such moments, but files
/// give them with three or four digits, and for a thin plate the two sides are equal. Nothing else depends on the bound.
const ROUNDED: f64 = 1e-3;

/// What a block weighs, apart from its shape. What is left out follows from the shape and its density.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MassProperties {
    /// Kilograms. Without an inertia of its own the block has its shape's, scaled to this mass.
    pub mass: Option<f64>,
    /// In the frame in which the shape is given (of a box, that of its middle and its sides), metres. In the plane z is unused.
    pub center_of_mass: Option<[f64; 3]>,
    /// About the centre of mass, along the axes of the frame in which the shape is given, kg m^2. In the plane only the last
    /// entry is used.
    pub inertia: Option<[[f64; 3]; 3]>,
}

/// Mass, and principal moments and axes about the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Weighed {
    pub mass: f64,
    /// One in the plane, three in space, kg m^2.
    pub moments: Vec<f64>,
    /// In the body's frame; those of the frame in the plane.
    pub axes: [Vector3; 3],
}

impl MassProperties {
    /// The centre of mass if there is one, all its numbers within bounds.
    pub(crate) fn checked_center(&self, name: &str) -> Result<Option<[f64; 3]>, SceneError> {
        for (axis, &value) in self.center_of_mass.iter().flatten().enumerate() {
            COORDINATE.check(format_args!("block \"{name}\": center_of_mass[{axis}]"), value)?;
        }
        Ok(self.center_of_mass)
    }

    /// What a block of such a shape and density weighs.
    pub(crate) fn weigh<S: Shape>(&self, name: &str, shape: &S, density: f64) -> Result<Weighed, SceneError> {
        let density = match self.mass {
            Some(mass) => {
                positive(format_args!("block \"{name}\": mass"), mass)?;
                mass / shape.measure()
            }
            None => density,
        };
        let mass = self.mass.unwrap_or(density * shape.measure());
        positive(format_args!("block \"{name}\": mass"), mass)?;
        let (moments, axes) = match self.inertia {
            Some(tensor) => own_inertia(name, tensor, shape.moments().len())?,
            None => (shape.moments().iter().map(|moment| density * moment).collect(), shape.axes()),
        };
        for &moment in &moments {
            positive(format_args!("block \"{name}\": moment of inertia"), moment)?;
        }
        Ok(Weighed { mass, moments, axes })
    }
}

/// Principal moments and axes of a tensor that is checked.
fn own_inertia(name: &str, tensor: [[f64; 3]; 3], count: usize) -> Result<(Vec<f64>, [Vector3; 3]), SceneError> {
    let place = |i: usize, j: usize| match count {
        1 => format!("block \"{name}\": inertia"),
        _ => format!("block \"{name}\": inertia[{i}][{j}]"),
    };
    if count == 1 {
        positive(&place(2, 2), tensor[2][2])?;
        return Ok((vec![tensor[2][2]], OWN_AXES));
    }
    for (i, row) in tensor.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            finite(place(i, j), entry)?;
        }
    }
    let bad = |fault: InertiaFault| SceneError::BadInertia { body: name.to_owned(), fault };
    let largest = tensor.iter().flatten().fold(0.0_f64, |most, entry| entry.abs().max(most));
    for [i, j] in [[0, 1], [0, 2], [1, 2]] {
        let (upper, lower) = (tensor[i][j], tensor[j][i]);
        if (upper - lower).abs() > SYMMETRIC * largest {
            return Err(bad(InertiaFault::NotSymmetric { i, j, upper, lower }));
        }
    }
    let mean = |i: usize, j: usize| 0.5 * tensor[i][j] + 0.5 * tensor[j][i];
    let (moments, axes) = principal([0, 1, 2].map(|i| [0, 1, 2].map(|j| mean(i, j))));
    let [a, b, c] = moments;
    if moments.iter().any(|moment| *moment <= 0.0) {
        return Err(bad(InertiaFault::NotPositive { a, b, c }));
    }
    let most = a.max(b).max(c);
    if 2.0 * most - (a + b + c) > ROUNDED * most {
        return Err(bad(InertiaFault::Triangle { a, b, c }));
    }
    Ok((moments.to_vec(), axes))
}
