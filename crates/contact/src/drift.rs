//! Impulses that drift: where contacts that bear cannot all close, each solve of the softened problem changes them by as much as the one
//! before, until one of them lets go or begins to slide. This goes there at once, as an active-set method does.

use crate::law::{Part, dot};

/// Impulses drift where no contact changes its state and the error stays, within a quarter.
pub(crate) const STAYS: std::ops::Range<f64> = 0.8..1.25;
/// The longest way, in changes.
const MOST: f64 = 1e4;
/// Where states are found anew: beyond the first change by a share, so that it happens.
pub(crate) const BEYOND: f64 = 1.001;

/// Continues the way from `before` to `p` to where the first contact changes its state, `beyond` times as far. `contacts` are coefficient and state of each.
pub(crate) fn follow<const D: usize>(
    before: &[[f64; D]],
    p: &mut [[f64; D]],
    contacts: impl Iterator<Item = (f64, Part)> + Clone,
    beyond: f64,
) {
    let change = |k: usize, p: &[f64; D]| -> [f64; D] { std::array::from_fn(|i| p[i] - before[k][i]) };
    let mut length = MOST;
    for (k, (friction, part)) in contacts.enumerate() {
        let d = change(k, &p[k]);
        if p[k][0] > 0.0 && d[0] < 0.0 {
            length = length.min(-p[k][0] / d[0]);
        }
        if part == Part::Sticks {
            length = length.min(way_to_the_edge(friction, &p[k], &d));
        }
    }
    if length <= 1.0 {
        return;
    }
    for (k, p) in p.iter_mut().enumerate() {
        let d = change(k, p);
        for i in 0..D {
            p[i] += beyond * length * d[i];
        }
    }
}

/// The smallest `a > 0` with `p + a d` on the friction cone's edge; infinite if there is none.
fn way_to_the_edge<const D: usize>(friction: f64, p: &[f64; D], d: &[f64; D]) -> f64 {
    // b(x, y) = x_t y_t - mu^2 x_n y_n is below zero within the cone.
    let b = |x: &[f64; D], y: &[f64; D]| dot(x, y) - (1.0 + friction * friction) * x[0] * y[0];
    let (square, half, constant) = (b(d, d), b(p, d), b(p, p));
    let root = half * half - square * constant;
    if constant >= 0.0 || root < 0.0 {
        return f64::INFINITY;
    }
    let q = -(half + half.signum() * root.sqrt());
    [q / square, constant / q].into_iter().filter(|a| *a > 0.0).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::{BEYOND, follow};
    use crate::law::Part;

    #[test]
    fn it_ends_where_the_first_contact_slides_or_lets_go() {
        let before = [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let there = |second: f64| {
            let mut p = [[1.0, 0.01, 0.0], [1.0 - second, 0.0, 0.0]];
            follow(&before, &mut p, [(0.5, Part::Sticks); 2].into_iter(), BEYOND);
            p
        };
        // The first one slides at 0.5, 49 more changes away.
        let p = there(0.001);
        assert!((p[0][1] - 0.5).abs() < 1e-3 && p[0][1] > 0.5 && p[1][0] > 0.9);
        // The second one lets go before, 9 changes away.
        let p = there(0.1);
        assert!(p[1][0] < 0.0 && p[1][0] > -1e-3 && p[0][1] < 0.11);
    }
}
