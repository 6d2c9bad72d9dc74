//! Anderson's method: a fixed point from the differences of iterates.
//!
//! D. Anderson, "Iterative procedures for nonlinear integral equations", 1965; H. Walker and P. Ni, "Anderson acceleration for
//! fixed-point iterations", 2011.

/// Differences of iterates that are remembered.
const MEMORY: usize = 10;
/// An error larger than the least one by this factor means that the active set has changed.
const SETBACK: f64 = 10.0;
/// A difference that is this small a share of its size after the others are taken out says nothing new.
const DEPENDENT: f64 = 1e-8;

/// Finds a fixed point `s = t(s)`, `s >= 0`.
#[derive(Debug, Default)]
pub(super) struct FixedPoint {
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Changes of t, and of t - s, from one iterate to the next; the latest last.
    differences: Vec<(Vec<f64>, Vec<f64>)>,
    least_error: f64,
}

impl FixedPoint {
    pub fn new() -> Self {
        Self { least_error: f64::INFINITY, ..Self::default() }
    }

    /// The next s after `t = t(s)` was found with this error.
    pub fn next(&mut self, s: &[f64], t: &[f64], error: f64) -> Vec<f64> {
        let rest = difference(t, s);
        if error > SETBACK * self.least_error {
            // The active set has changed, or the step was too long: begin again from here.
            self.differences.clear();
            self.last = None;
        }
        self.least_error = self.least_error.min(error);
        if let Some((old_t, old_rest)) = self.last.replace((t.to_vec(), rest.clone())) {
            self.differences.push((difference(t, &old_t), difference(&rest, &old_rest)));
            if self.differences.len() > MEMORY {
                self.differences.remove(0);
            }
        }
        self.accelerate(t, rest).into_iter().map(|s| s.max(0.0)).collect()
    }

    /// t less the combination of its changes that would have brought t - s closest to zero, by Gram and Schmidt.
    fn accelerate(&self, t: &[f64], mut rest: Vec<f64>) -> Vec<f64> {
        let mut next = t.to_vec();
        let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        for (change_t, change) in self.differences.iter().rev() {
            let (mut image, mut direction) = (change_t.clone(), change.clone());
            let size = norm(&direction);
            for (known_image, known) in &basis {
                let share = dot(&direction, known);
                subtract(&mut direction, share, known);
                subtract(&mut image, share, known_image);
            }
            let left = norm(&direction);
            if left <= DEPENDENT * size || left == 0.0 {
                continue;
            }
            direction.iter_mut().chain(&mut image).for_each(|x| *x /= left);
            let share = dot(&rest, &direction);
            subtract(&mut rest, share, &direction);
            subtract(&mut next, share, &image);
            basis.push((image, direction));
        }
        next
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn subtract(a: &mut [f64], share: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= share * b);
}

#[cfg(test)]
mod tests {
    use super::FixedPoint;

    /// A linear map of n dimensions is at its fixed point after n + 1 differences at most.
    #[test]
    fn a_linear_map_takes_a_few_iterates() {
        let map = |s: &[f64]| vec![1.0 + 0.3 * s[0] - 0.2 * s[1], 2.0 + 0.6 * s[0] + 0.1 * s[1]];
        let mut point = FixedPoint::new();
        let mut s = vec![0.0, 0.0];
        for solves in 1.. {
            let t = map(&s);
            let error = (t[0] - s[0]).abs().max((t[1] - s[1]).abs());
            if error < 1e-12 {
                assert!(solves <= 5, "{solves} solves");
                break;
            }
            s = point.next(&s, &t, error);
        }
    }

    /// |1 - 2 s| has the fixed point 1/3 with slope 2 there: plain iteration never finds it.
    #[test]
    fn a_map_that_expands_is_caught() {
        let mut point = FixedPoint::new();
        let mut s = vec![0.3];
        for _ in 0..30 {
            let t = vec![f64::abs(1.0 - 2.0 * s[0])];
            s = point.next(&s, &t, (t[0] - s[0]).abs());
        }
        assert!((s[0] - 1.0 / 3.0).abs() < 1e-9, "{}", s[0]);
    }
}
