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
    let point = project(friction, &z).point;
    let mut square = 0.0;
    for k in 0..D {
        square += (p[k] - point[k]).powi(2);
    }
    square.sqrt()
}

/// In which part of space the argument of a projection on the cone lies, and with it what a contact does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// In the polar cone: the projection is zero.
    Parts,
    /// In the cone.
    Sticks,
    /// Outside of both.
    Slides,
}

/// The projection `P(z)` on the cone `|t| <= mu n`, with its derivative `g g' + beta e e'`, `e` square to `g` and to the normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Projection<const D: usize> {
    pub part: Part,
    pub point: [f64; D],
    /// Of what slides: unit vector along the cone's edge.
    pub edge: [f64; D],
    /// Of what slides: share of a turn of `z_t` that the projection makes.
    pub beta: f64,
}

#[inline(always)]
pub(crate) fn project<const D: usize>(friction: f64, z: &[f64; D]) -> Projection<D> {
    let size = tangential(z);
    if size <= friction * z[0] {
        return Projection { part: Part::Sticks, point: *z, edge: [0.0; D], beta: 0.0 };
    }
    if friction * size <= -z[0] {
        return Projection { part: Part::Parts, point: [0.0; D], edge: [0.0; D], beta: 0.0 };
    }
    let square = 1.0 + friction * friction;
    let length = square.sqrt();
    let normal = (z[0] + friction * size) / square;
    let (mut point, mut edge) = ([normal; D], [1.0 / length; D]);
    let along = if size > 0.0 { friction / size } else { 0.0 };
    for k in 1..D {
        point[k] = normal * along * z[k];
        edge[k] = along * z[k] / length;
    }
    let beta = if D > 2 && size > 0.0 { friction * normal / size } else { 0.0 };
    Projection { part: Part::Slides, point, edge, beta }
}
