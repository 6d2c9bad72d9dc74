//! A small symmetric problem is answered by every method or refused, and an answer is what it says.

#![no_main]

use drystone_lcp::{Block, Dantzig, Lemke, Method, Problem, Settings, Status, residual};
use libfuzzer_sys::fuzz_target;

/// Few rows meet more cases in a second than many.
const MOST_ROWS: usize = 6;

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, rest)) = bytes.split_first() else { return };
    let n = 1 + usize::from(first) % MOST_ROWS;
    let numbers: Vec<f64> =
        rest.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect();
    if numbers.len() < n * (n + 1) / 2 + n {
        return;
    }
    let (q, lower) = numbers.split_at(n);
    let entry = |i: usize, j: usize| lower[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
    let m: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
    let Ok(problem) = Problem::from_dense(&m, q.to_vec()) else { return };
    let settings = Settings::default();
    for method in [&Dantzig as &dyn Method, &Block, &Lemke] {
        let Ok(answer) = method.solve(&problem, None, &settings) else { continue };
        if answer.status == Status::Solved {
            assert!(answer.z.iter().all(|&z| z >= 0.0), "{}: {answer:?}", method.name());
            let residual = residual(&problem, &answer.z);
            assert!(residual <= settings.residual, "{}: {residual:e}, {answer:?}", method.name());
        }
        if answer.status == Status::NoSolution {
            let ray = answer.ray.as_ref().expect("no solution comes with a proof");
            let progress: f64 = ray.iter().zip(problem.q()).map(|(y, q)| y * q).sum();
            assert!(ray.iter().all(|&y| y >= 0.0) && progress < 0.0, "{}: {ray:?}", method.name());
        }
    }
});
