use super::{Bearings, LEFT};
use crate::formulate::Components;
use drystone_lcp::cone::{Columns, ConeSolver, Membership};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// Whether the cone solver, which shares nothing with them, finds forces.
fn borne(columns: &[Components], load: &Components, size: usize) -> bool {
    let indptr: Vec<usize> = (0..=columns.len()).map(|j| j * size).collect();
    let indices: Vec<usize> = columns.iter().flat_map(|_| 0..size).collect();
    let data: Vec<f64> = columns.iter().flat_map(|column| column[..size].iter().copied()).collect();
    let against: Vec<f64> = load[..size].iter().map(|load| -load).collect();
    let matrix = Columns::new(size, &indptr, &indices, &data).unwrap();
    let mut solver = ConeSolver::new(matrix, &against, &vec![1.0; size]).unwrap();
    solver.add_rows(&(0..size).collect::<Vec<_>>());
    let found = solver.solve();
    let left = |row: usize| columns.iter().enumerate().map(|(j, column)| column[row] * solver.f(j)).sum::<f64>();
    found == Membership::Inside && (0..size).all(|row| (left(row) + load[row]).abs() <= LEFT * largest(load))
}

fn largest(load: &Components) -> f64 {
    load.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()))
}

/// Joints under a block, whose normals differ by about `tilt`, with points along each.
fn columns(random: &mut Pcg64, size: usize, tilt: f64) -> Vec<Components> {
    let mut at = |spread: f64| random.random_range(-spread..=spread);
    let mut columns = Vec::new();
    for _ in 0..3 {
        let (nx, ny) = (at(tilt), if size == 6 { at(tilt) } else { 0.0 });
        let (x, y) = (at(1.0), at(1.0));
        for (dx, dy) in [(0.0, 0.0), (0.4, 0.0), (0.0, 0.3), (0.4, 0.3)] {
            let (px, py, pz) = (x + dx, y + dy, -0.5);
            columns.push(match size {
                3 => [nx, 1.0, px - pz * nx, 0.0, 0.0, 0.0],
                _ => [nx, ny, 1.0, py - pz * ny, pz * nx - px, px * ny - py * nx],
            });
        }
    }
    columns
}

/// In the plane and in space, with normals that are parallel, nearly so, and not; loads that some points bear, and others.
#[test]
fn a_load_is_borne_where_pivots_find_forces() {
    let mut random = Pcg64::seed_from_u64(1);
    let mut found = [0; 2];
    for case in 0..4000 {
        let size = if case % 2 == 0 { 3 } else { 6 };
        let tilt = [0.0, 1e-9, 1e-6, 1e-3, 0.5][case / 2 % 5];
        let columns = columns(&mut random, size, tilt);
        let load: Components = if case % 3 == 0 {
            let mut load = [0.0; 6];
            load[size / 3] = -1.0;
            load[size - 1] = if size == 3 { random.random_range(-1.0..1.0) } else { 0.0 };
            load
        } else {
            let mut load = [0.0; 6];
            for column in &columns {
                let force: f64 = random.random_range(-0.5_f64..1.0).max(0.0);
                load.iter_mut().zip(column).for_each(|(load, entry)| *load -= force * entry);
            }
            load
        };
        let units = vec![1.0; size];
        let forces = Bearings::new(columns.iter(), &units).balance(&load);
        // Where normals are nearly parallel these are the more accurate.
        let agree = forces.is_some() == borne(&columns, &load, size) || tilt == 1e-9 && forces.is_some();
        assert!(agree, "case {case}: {size} equations, normals apart {tilt}, {forces:?}");
        found[usize::from(forces.is_some())] += 1;
        let Some(forces) = forces else { continue };
        let left = |row: usize| columns.iter().zip(&forces).map(|(column, force)| column[row] * force).sum::<f64>();
        assert!(forces.iter().all(|force| *force >= 0.0));
        assert!((0..size).all(|row| (left(row) + load[row]).abs() <= LEFT * largest(&load)));
    }
    assert!(found.iter().all(|&count| count > 500), "{found:?}");
}
