//! Checks of an answer from `M` and `q` alone: nothing the solver says about itself is trusted.

use drystone_lcp::{Block, Dantzig, Lemke, Method, Problem, Settings, Solution, Status};

/// Contract of the crate: the residual of a solved problem, in its own scale.
pub const RESIDUAL: f64 = 1e-9;

/// `w` is unique for a symmetric semidefinite M. Two approximate solutions with residual r differ in w by at most about
/// sqrt(r) in the problem's own scale (their difference d has d' M d <= 2 n r), and r is near 1e-15 in practice.
pub const SAME_W: f64 = 1e-7;

/// Factor that brings row i to a unit diagonal.
fn unit(problem: &Problem, i: usize) -> f64 {
    let diagonal = problem.m().get(i, i);
    if diagonal > 0.0 { diagonal.sqrt().recip() } else { 1.0 }
}

/// The larger of the largest entries of q and z, scaled to a unit diagonal.
pub fn own_scale(problem: &Problem, z: &[f64]) -> f64 {
    (0..problem.len())
        .map(|i| (problem.q()[i] * unit(problem, i)).abs().max(z[i] / unit(problem, i)))
        .fold(0.0, f64::max)
}

/// `M z + q` by the definition, and the sum of the sizes of its terms.
fn image(problem: &Problem, z: &[f64]) -> Vec<f64> {
    let mut w = problem.q().to_vec();
    for (j, zj) in z.iter().enumerate() {
        let (rows, values) = problem.m().column(j);
        for (&i, value) in rows.iter().zip(values) {
            w[i] += value * zj;
        }
    }
    w
}

/// Panics unless `z >= 0`, `w >= 0` and `z` or `w` is zero in every pair, to the contract's tolerance.
pub fn assert_solves(problem: &Problem, z: &[f64], context: &str) {
    assert_eq!(z.len(), problem.len(), "{context}");
    let w = image(problem, z);
    let tolerance = RESIDUAL * own_scale(problem, z);
    for i in 0..problem.len() {
        let (zs, ws) = (z[i] / unit(problem, i), w[i] * unit(problem, i));
        assert!(z[i] >= 0.0, "{context}: z[{i}] = {}", z[i]);
        assert!(ws >= -tolerance, "{context}: w[{i}] = {ws:e} with tolerance {tolerance:e}");
        assert!(zs.min(ws) <= tolerance, "{context}: pair {i} is ({zs:e}, {ws:e}) with tolerance {tolerance:e}");
    }
}

/// Panics unless y proves that no `z >= 0` has `M z + q >= 0`: `y >= 0`, `M' y <= 0`, `q' y < 0`. Tolerance: of
/// the unit-diagonal problem, and small against the progress `q' y`, without which it would prove nothing.
pub fn assert_certificate(problem: &Problem, y: &[f64], context: &str) {
    let n = problem.len();
    assert_eq!(y.len(), n, "{context}");
    let scaled: Vec<f64> = (0..n).map(|i| y[i] / unit(problem, i)).collect();
    let size = scaled.iter().fold(0.0, |size: f64, y| size.max(y.abs()));
    let q_size = (0..n).map(|i| (problem.q()[i] * unit(problem, i)).abs()).fold(0.0, f64::max);
    let progress: f64 = (0..n).map(|i| y[i] * problem.q()[i]).sum::<f64>() / (size * q_size);
    assert!(y.iter().all(|&y| y >= 0.0), "{context}: y = {y:?}");
    assert!(progress < 0.0, "{context}: q' y = {progress:e} in its own scale");
    for j in 0..n {
        let (rows, values) = problem.m().column(j);
        let rise: f64 = rows.iter().zip(values).map(|(&i, value)| value * y[i]).sum::<f64>() * unit(problem, j) / size;
        assert!(rise <= RESIDUAL && rise <= 1e-3 * -progress, "{context}: (M' y)[{j}] = {rise:e}, q' y = {progress:e}");
    }
}

/// Panics unless the statuses are `Solved` or `NoSolution` and hold what they say.
pub fn assert_answer(problem: &Problem, solution: &Solution, context: &str) {
    match solution.status {
        Status::Solved => {
            assert_solves(problem, &solution.z, context);
            assert!(solution.residual <= RESIDUAL, "{context}: reported residual {:e}", solution.residual);
            assert!(solution.ray.is_none(), "{context}");
        }
        Status::NoSolution => {
            let ray = solution.ray.as_ref().unwrap_or_else(|| panic!("{context}: no certificate"));
            assert_certificate(problem, ray, context);
        }
        status => panic!("{context}: {status:?} with residual {:e}, {:?}", solution.residual, solution.counts),
    }
}

/// Panics unless two vectors w agree in the problem's own scale.
pub fn assert_same_w(problem: &Problem, z: &[f64], expected: &[f64], tolerance: f64, context: &str) {
    let (w, other) = (image(problem, z), image(problem, expected));
    let scale = own_scale(problem, z).max(own_scale(problem, expected));
    for i in 0..problem.len() {
        let difference = (w[i] - other[i]).abs() * unit(problem, i);
        assert!(difference <= tolerance * scale, "{context}: w[{i}] {} and {}, scale {scale:e}", w[i], other[i]);
    }
}

/// The methods that are compared with Dantzig's.
pub const OTHERS: [&dyn Method; 2] = [&Lemke, &Block];

/// Solves by every method, checks the answers, and that they are the same answer. Returns Dantzig's.
pub fn solve_by_all(problem: &Problem, context: &str) -> Solution {
    let solve = |method: &dyn Method| {
        let context = format!("{context}, {}", method.name());
        let solution = method.solve(problem, None, &Settings::default()).unwrap_or_else(|e| panic!("{context}: {e}"));
        assert_answer(problem, &solution, &context);
        solution
    };
    let dantzig = solve(&Dantzig);
    let counts = dantzig.counts;
    // A row driven to feasibility is guarded from then on. A major cycle ends with a pivot, or, rarely, without.
    assert!(counts.major_cycles <= problem.len(), "{context}: {counts:?}");
    assert!(
        (counts.minor_cycles..=counts.minor_cycles + counts.major_cycles).contains(&counts.pivots),
        "{context}: {counts:?}"
    );
    for method in OTHERS {
        let other = solve(method);
        assert_eq!(dantzig.status, other.status, "{context}, {}", method.name());
        if dantzig.status == Status::Solved {
            assert_same_w(problem, &dantzig.z, &other.z, SAME_W, &format!("{context}, {}", method.name()));
        }
    }
    dantzig
}
