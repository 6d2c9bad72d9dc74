//! The natural map at one contact, and its derivative.
//!
//! ```text
//! F(p, u) = p - P(z),    z = p - E(u),    E(u) = u + mu |u_t| n,    dF = (I - DP) dp + DP E' du
//! ```
//!
//! with P the projection on Coulomb's cone and everything in m/s: impulses count with the speed that they give at their own contact. The
//! shift by `mu |u_t|` is De Saxcé's; with it F = 0 is Coulomb's law.

use crate::law::{Part, Projection, dot, project, tangential};

#[derive(Debug, Clone, Copy)]
pub(crate) struct Map<const D: usize> {
    projection: Projection<D>,
    /// What a Newton step has to undo. Of a contact that sticks without `mu |u_t|`: both mean that u becomes zero, and so E' is one.
    pub value: [f64; D],
    /// `mu u_t / |u_t|`; the first entry is zero.
    lift: [f64; D],
    /// Unit tangent square to the friction of what slides.
    around: [f64; D],
}

impl<const D: usize> Map<D> {
    /// The map, and the square of F.
    pub fn at(friction: f64, u: &[f64; D], p: &[f64; D]) -> (Self, f64) {
        let speed = tangential(u);
        let mut z = *p;
        for k in 0..D {
            z[k] -= u[k];
        }
        z[0] -= friction * speed;
        let projection = project(friction, &z);
        let mut value = *p;
        let mut square = 0.0;
        for k in 0..D {
            value[k] -= projection.point[k];
            square += value[k] * value[k];
        }
        let (mut lift, mut around) = ([0.0; D], [0.0; D]);
        match projection.part {
            Part::Slides => {
                let size = tangential(&z);
                for k in 1..D {
                    // Where it only begins to slide, against the friction.
                    lift[k] = if speed > 0.0 {
                        friction * u[k] / speed
                    } else {
                        -friction * z[k] / size.max(f64::MIN_POSITIVE)
                    };
                }
                if D == 3 && size > 0.0 {
                    around[1] = -z[2] / size;
                    around[2] = z[1] / size;
                }
            }
            Part::Sticks => value[0] -= friction * speed,
            Part::Parts => {}
        }
        (Self { projection, value, lift, around }, square)
    }

    /// Whether a motion changes the impulse.
    pub fn bears(&self) -> bool {
        self.projection.part != Part::Parts
    }

    /// `E' u`.
    #[inline(always)]
    pub fn lifted(&self, u: &[f64; D]) -> [f64; D] {
        let mut lifted = *u;
        lifted[0] += dot(&self.lift, u);
        lifted
    }

    /// `DP x`.
    #[inline(always)]
    pub fn projected(&self, x: &[f64; D]) -> [f64; D] {
        match self.projection.part {
            Part::Parts => [0.0; D],
            Part::Sticks => *x,
            Part::Slides => self.in_directions(x, [0.0, 1.0, self.projection.beta]),
        }
    }

    /// `(I - DP + eps)^-1 x`.
    #[inline(always)]
    pub fn divided(&self, x: &[f64; D], eps: f64) -> [f64; D] {
        match self.projection.part {
            Part::Parts => x.map(|x| x / (1.0 + eps)),
            Part::Sticks => x.map(|x| x / eps),
            Part::Slides => {
                let factors = [1.0 / (1.0 + eps), 1.0 / eps, 1.0 / (1.0 - self.projection.beta + eps)];
                self.in_directions(x, factors)
            }
        }
    }

    /// `(I - DP + eps)^-1 DP E'`: what a motion takes from the impulse.
    pub fn weight(&self, eps: f64) -> [[f64; D]; D] {
        let mut weight = [[0.0; D]; D];
        for j in 0..D {
            let mut unit = [0.0; D];
            unit[j] = 1.0;
            let column = self.divided(&self.projected(&self.lifted(&unit)), eps);
            for i in 0..D {
                weight[i][j] = column[i];
            }
        }
        weight
    }

    /// Multiplies what is along the cone's edge by the second factor, around its axis by the third, and the rest by the first.
    #[inline(always)]
    fn in_directions(&self, x: &[f64; D], [rest, along, around]: [f64; 3]) -> [f64; D] {
        let edge = (along - rest) * dot(&self.projection.edge, x);
        let turn = (around - rest) * dot(&self.around, x);
        let mut y = [0.0; D];
        for k in 0..D {
            y[k] = rest * x[k] + edge * self.projection.edge[k] + turn * self.around[k];
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::Map;

    /// Against differences, where the map is smooth.
    #[test]
    fn the_derivative_is_that_of_the_map() {
        let cases = [
            ([0.1, 0.3, -0.2], [1.0, -0.4, 0.5]),   // slides
            ([-0.02, 0.01, 0.02], [1.0, 0.1, 0.2]), // sticks
            ([2.0, 0.1, 0.3], [0.5, 0.1, 0.0]),     // parts
        ];
        for (u, p) in cases {
            let (map, _) = Map::at(0.6, &u, &p);
            let value = |u: &[f64; 3], p: &[f64; 3]| {
                let speed = u[1].hypot(u[2]);
                let z = [p[0] - u[0] - 0.6 * speed, p[1] - u[1], p[2] - u[2]];
                let point = crate::law::project(0.6, &z).point;
                [0, 1, 2].map(|k| p[k] - point[k])
            };
            let h = 1e-6;
            for j in 0..3 {
                let (mut more, mut less) = ((u, p), (u, p));
                more.0[j] += h;
                less.0[j] -= h;
                let slope: [f64; 3] = {
                    let (a, b) = (value(&more.0, &p), value(&less.0, &p));
                    [0, 1, 2].map(|k| (a[k] - b[k]) / (2.0 * h))
                };
                let mut unit = [0.0; 3];
                unit[j] = 1.0;
                // What sticks takes the shift out of its value: its derivative is that of p - P(p - u).
                let shift = if map.lift == [0.0; 3] && map.bears() { 0.6 * u[j] / u[1].hypot(u[2]) } else { 0.0 };
                let found = map.projected(&map.lifted(&unit));
                for k in 0..3 {
                    let expected = slope[k] - if k == 0 && j > 0 { shift } else { 0.0 };
                    assert!((found[k] - expected).abs() < 1e-8, "{u:?} {p:?}: {found:?} {slope:?}");
                }
                let (mut more, mut less) = (p, p);
                more[j] += h;
                less[j] -= h;
                let (a, b) = (value(&u, &more), value(&u, &less));
                let kept = map.projected(&unit);
                for k in 0..3 {
                    assert!((unit[k] - kept[k] - (a[k] - b[k]) / (2.0 * h)).abs() < 1e-8);
                }
            }
        }
    }

    #[test]
    fn dividing_undoes() {
        let (map, _) = Map::at(0.6, &[0.1, 0.3, -0.2], &[1.0, -0.4, 0.5]);
        let x = [0.3, -0.7, 0.2];
        let divided = map.divided(&x, 1e-3);
        let kept = map.projected(&divided);
        for k in 0..3 {
            assert!((1.001 * divided[k] - kept[k] - x[k]).abs() < 1e-12);
        }
    }
}
