//! One contact that gives way: its impulse as a function of the velocity there.
//!
//! Near a reference impulse r, with `eps` of the contact's own yielding, and everything in m/s (impulses count with the speed that they
//! give at their own contact), the impulse is the augmented Lagrangian's of Alart and Curnier:
//!
//! ```text
//! z = r - u / eps,    p_n = max(0, z_n),    p_t = z_t cut to the length mu p_n
//! ```
//!
//! It is Coulomb's law for the velocity `u + eps (p - r)`: exactly the law itself where p = r. De Saxcé's shift by `mu |u_t|` is not
//! in it, which has a kink where a contact sticks.

use crate::law::{Part, tangential};

/// Impulse of a softened contact, and its derivative `dp = -N du / eps`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Softened<const D: usize> {
    pub part: Part,
    pub p: [f64; D],
    /// mu, of what slides.
    friction: f64,
    /// Of what slides: unit tangent along `z_t`; the first entry is zero.
    along: [f64; D],
    /// Of what slides: share of a turn of `z_t` that the impulse makes.
    turns: f64,
}

impl<const D: usize> Softened<D> {
    #[inline(always)]
    pub fn at(friction: f64, z: &[f64; D]) -> Self {
        Self::with(Part::of(friction, z), friction, z)
    }

    /// The same where it is known what the contact does.
    #[inline(always)]
    pub fn with(part: Part, friction: f64, z: &[f64; D]) -> Self {
        let (mut p, mut along, mut turns) = (*z, [0.0; D], 0.0);
        match part {
            Part::Parts => p = [0.0; D],
            Part::Sticks => {}
            Part::Slides => {
                let (size, limit) = (tangential(z), friction * z[0]);
                for k in 1..D {
                    along[k] = if size > 0.0 { z[k] / size } else { 0.0 };
                    p[k] = limit * along[k];
                }
                if D == 3 && size > 0.0 {
                    turns = limit.max(0.0) / size;
                }
            }
        }
        Self { part, p, friction, along, turns }
    }

    /// N; not symmetric where the contact slides. None where it parts.
    #[inline(always)]
    pub fn derivative(&self) -> Option<[[f64; D]; D]> {
        let mut n = [[0.0; D]; D];
        match self.part {
            Part::Parts => return None,
            Part::Sticks => (0..D).for_each(|k| n[k][k] = 1.0),
            Part::Slides => {
                n[0][0] = 1.0;
                for i in 1..D {
                    n[i][0] = self.friction * self.along[i];
                    for j in 1..D {
                        let one = if i == j { 1.0 } else { 0.0 };
                        n[i][j] = self.turns * (one - self.along[i] * self.along[j]);
                    }
                }
            }
        }
        Some(n)
    }
}

#[cfg(test)]
mod tests {
    use super::Softened;
    use crate::law::{Part, error};

    const CASES: [([f64; 3], Part); 4] = [
        ([1.0, 0.3, -0.2], Part::Sticks),
        ([1.0, 0.9, -0.5], Part::Slides),
        ([0.2, -3.0, 1.0], Part::Slides),
        ([-0.1, 0.5, 0.5], Part::Parts),
    ];

    /// Against differences.
    #[test]
    fn the_derivative_is_that_of_the_impulse() {
        for (z, part) in CASES {
            let found = Softened::at(0.6, &z);
            assert_eq!(found.part, part);
            let n = found.derivative().unwrap_or_default();
            let h = 1e-6;
            for j in 0..3 {
                let (mut more, mut less) = (z, z);
                more[j] += h;
                less[j] -= h;
                let (more, less) = (Softened::at(0.6, &more).p, Softened::at(0.6, &less).p);
                for i in 0..3 {
                    assert!((n[i][j] - (more[i] - less[i]) / (2.0 * h)).abs() < 1e-8, "{z:?}: {n:?}");
                }
            }
        }
    }

    /// With the velocity that yielding leaves the impulse obeys Coulomb's law.
    #[test]
    fn it_is_the_law_of_a_contact_that_gives_way() {
        let (eps, reference) = (0.1, [0.5, 0.1, 0.0]);
        for (z, _) in CASES {
            let p = Softened::at(0.6, &z).p;
            // z = r - u / eps, so u + eps (p - r) = eps (p - z).
            let left = [0, 1, 2].map(|k| eps * (p[k] - z[k]));
            let u = [0, 1, 2].map(|k| eps * (reference[k] - z[k]));
            assert!(error(0.6, &left, &p, 1.0) < 1e-15, "{z:?}");
            assert!((0..3).all(|k| (u[k] + eps * (p[k] - reference[k]) - left[k]).abs() < 1e-15));
        }
    }

    #[test]
    fn without_friction_nothing_sticks() {
        let found = Softened::at(0.0, &[1.0, 0.0, 0.0]);
        assert_eq!(found.part, Part::Slides);
        assert_eq!(found.derivative(), Some([[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]));
    }
}
