//! Named problems of the literature: `tests/data/lcp/*.json`, each with its source and its answer.

use crate::verify::{assert_certificate, assert_solves};
use drystone_lcp::{Block, Dantzig, LcpError, Lemke, Method, Problem, Settings, Status};
use serde::Deserialize;
use std::{fs, path::PathBuf};

/// `w = M z + q` with the outcome that each method must have; the block method has Dantzig's.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
struct Named {
    #[serde(rename = "M")]
    m: Vec<Vec<f64>>,
    q: Vec<f64>,
    dantzig: Expected,
    lemke: Expected,
    /// First entries of the solution, where those are unique.
    #[serde(default)]
    z: Vec<f64>,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Expected {
    Solved,
    NoSolution,
    RayTermination,
    NotSymmetric,
    NotSemidefinite,
}

fn named() -> Vec<(String, Named)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/lcp");
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let read = |path: PathBuf| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let problem = serde_json::from_str(&fs::read_to_string(path).unwrap());
        (name.clone(), problem.unwrap_or_else(|error| panic!("{name}: {error}")))
    };
    files.into_iter().map(read).collect()
}

fn solve(method: &dyn Method, name: &str, named: &Named) {
    let context = format!("{name}, {}", method.name());
    let problem = Problem::from_dense(&named.m.concat(), named.q.clone()).unwrap();
    let expected = if method.name() == "lemke" { &named.lemke } else { &named.dantzig };
    let outcome = match method.solve(&problem, None, &Settings::default()) {
        Err(LcpError::NotSymmetric { .. }) => Expected::NotSymmetric,
        Err(LcpError::NotSemidefinite { .. }) => Expected::NotSemidefinite,
        Err(error) => panic!("{context}: {error}"),
        Ok(solution) => match solution.status {
            Status::Solved => {
                assert_solves(&problem, &solution.z, &context);
                for (i, (z, expected)) in solution.z.iter().zip(&named.z).enumerate() {
                    assert!(
                        (z - expected).abs() <= 1e-9 * expected.max(1.0),
                        "{context}: z[{i}] = {z}, not {expected}"
                    );
                }
                Expected::Solved
            }
            Status::NoSolution => {
                assert_certificate(&problem, &solution.ray.unwrap(), &context);
                Expected::NoSolution
            }
            Status::RayTermination => Expected::RayTermination,
            status => panic!("{context}: {status:?}, residual {:e}", solution.residual),
        },
    };
    assert_eq!(outcome, *expected, "{context}");
}

#[test]
fn named_problems_by_every_method() {
    let all = named();
    assert!(all.len() >= 20, "found only {} problems", all.len());
    for (name, problem) in &all {
        solve(&Dantzig, name, problem);
        solve(&Block, name, problem);
        solve(&Lemke, name, problem);
    }
}
