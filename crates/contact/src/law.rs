//! Coulomb's law at one contact: how far a velocity and an impulse are from it, and its natural map.

/// Sum of products.
#[inline(always)]
pub(crate) fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}

/// Length of the tangential part.
#[inline(always)]
pub(crate) fn tangential<const D: usize>(x: &[f64; D]) -> f64 {
    if D == 2 { x[1].abs() } else { (x[1] * x[1] + x[2] * x[2]).sqrt() }
}

/// Error of Coulomb's law, m/s: the length of the natural map `p - P(p - (u + mu |u_t| n))`, P the projection on the cone, zero if
/// and only if the law holds. Impulses count with the speed that they give at their own contact, by `weight` (1/kg). `u` holds the
/// offset in its normal component.
#[inline]
pub(crate) fn error<const D: usize>(friction: f64, u: &[f64; D], p: &[f64; D], weight: f64) -> f64 {
    let p = p.map(|p| p * weight);
    let mut z = p;
    z[0] -= u[0] + friction * tangential(u);
    for k in 1..D {
        z[k] -= u[k];
    }
    let point = project(friction, &z);
    let mut square = 0.0;
    for k in 0..D {
        square += (p[k] - point[k]).powi(2);
    }
    square.sqrt()
}

/// What a contact does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// It bears nothing.
    Parts,
    /// Its impulse is within the cone.
    Sticks,
    /// Its impulse is on the cone's edge.
    Slides,
}

impl Part {
    /// By the impulse that the contact would have if it stuck.
    #[inline(always)]
    pub fn of<const D: usize>(friction: f64, z: &[f64; D]) -> Self {
        if z[0] <= 0.0 {
            Self::Parts
        } else if friction > 0.0 && tangential(z) <= friction * z[0] {
            Self::Sticks
        } else {
            Self::Slides
        }
    }
}

/// The point of the cone `|t| <= mu n` that is nearest to z.
#[inline(always)]
fn project<const D: usize>(friction: f64, z: &[f64; D]) -> [f64; D] {
    let size = tangential(z);
    if size <= friction * z[0] {
        return *z;
    }
    if friction * size <= -z[0] {
        return [0.0; D];
    }
    let normal = (z[0] + friction * size) / (1.0 + friction * friction);
    let along = if size > 0.0 { friction / size } else { 0.0 };
    let mut point = [normal; D];
    for k in 1..D {
        point[k] = normal * along * z[k];
    }
    point
}
