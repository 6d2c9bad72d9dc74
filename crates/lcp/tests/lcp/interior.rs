//! The interior-point method on random bodies and contacts: against Dantzig's method on A, and by (2) itself.

use drystone_lcp::{
    Dantzig, Method, Problem, Settings, Status,
    cone::{Columns, ConeSolver, Greatest, Membership},
    interior::{Cone, End, Gauss, Layers, Point},
};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// Bodies of so many unknowns, each touching some others or the ground, with normals within a half space.
fn random(seed: u64, size: usize, bodies: usize, points: usize, friction: Option<f64>) -> Gauss {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| random.random_range(low..high);
    let mut problem = Gauss { size, ..Gauss::default() };
    for _ in 0..bodies {
        for k in 0..size {
            problem.inverse_mass.push(between(0.5, 2.0));
            problem.load.push(if k == 1 { -between(5.0, 15.0) } else { between(-1.0, 1.0) });
        }
    }
    let directions = if size == 3 { 2 } else { 3 };
    for _ in 0..points {
        let second = between(0.0, bodies as f64) as usize;
        let first = between(-1.0, bodies as f64);
        let first = (first >= 0.0).then_some(first as usize).filter(|&first| first != second);
        let mut rows = || {
            let mut jacobian = [[0.0; 6]; 3];
            jacobian[..directions].iter_mut().for_each(|row| row[..size].fill_with(|| between(-1.0, 1.0)));
            jacobian
        };
        let jacobian = [rows(), rows()];
        let cone = match friction {
            Some(friction) => Cone::Round { friction },
            None => {
                let edge = |sign: f64| [1.0, 0.5 * sign, if size == 3 { 0.0 } else { 0.3 * sign }];
                Cone::Edges(vec![edge(1.0), edge(-1.0)])
            }
        };
        problem.points.push(Point { bodies: [first, Some(second)], jacobian, cone });
    }
    problem
}

/// The generators of pyramids as columns: (rows, values) of each.
fn generators(problem: &Gauss) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for point in &problem.points {
        let Cone::Edges(edges) = &point.cone else { panic!("pyramids only") };
        for edge in edges {
            let mut sides: Vec<_> = point.bodies.iter().zip(&point.jacobian).collect();
            sides.sort_by_key(|side| *side.0);
            for (body, jacobian) in sides {
                let Some(body) = body else { continue };
                rows.extend(problem.size * body..problem.size * (body + 1));
                let along = |k: usize| -> f64 { edge.iter().zip(jacobian).map(|(edge, row)| edge * row[k]).sum() };
                values.extend((0..problem.size).map(along));
            }
            starts.push(rows.len());
        }
    }
    (starts, rows, values)
}

#[test]
fn accelerations_are_those_of_dantzigs_method() {
    for seed in 0..60 {
        let size = if seed % 2 == 0 { 3 } else { 6 };
        let problem = random(seed, size, 6, 4 + seed as usize / 4, None);
        let found = problem.solve();
        assert_eq!((found.end == End::Stalled, found.iterations < 60), (false, true), "seed {seed}: {found:?}");
        let (starts, rows, values) = generators(&problem);
        let n = starts.len() - 1;
        let mut dense = vec![vec![0.0; n]; problem.load.len()];
        for j in 0..n {
            (starts[j]..starts[j + 1]).for_each(|k| dense[rows[k]][j] += values[k]);
        }
        let inverse = &problem.inverse_mass;
        let entry = |i: usize, j: usize| (0..dense.len()).map(|r| dense[r][i] * inverse[r] * dense[r][j]).sum::<f64>();
        let matrix: Vec<f64> = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
        let q = (0..n).map(|i| (0..dense.len()).map(|r| dense[r][i] * inverse[r] * problem.load[r]).sum()).collect();
        let answer = Dantzig.solve(&Problem::from_dense(&matrix, q).unwrap(), None, &Settings::default()).unwrap();
        assert_eq!(answer.status, Status::Solved, "seed {seed}");
        for r in 0..dense.len() {
            let force: f64 = (0..n).map(|j| dense[r][j] * answer.z[j]).sum();
            let acceleration = inverse[r] * (problem.load[r] + force);
            assert!((acceleration - found.accelerations[r]).abs() < 1e-8, "seed {seed}, row {r}");
        }
    }
}

#[test]
fn round_cones_obey_the_conditions_of_optimality() {
    for seed in 0..60 {
        let friction = [0.05, 0.5, 3.0][seed as usize % 3];
        let problem = random(seed, 6, 5, 3 + seed as usize / 3, Some(friction));
        let found = problem.solve();
        assert_ne!(found.end, End::Stalled, "seed {seed}");
        let mut balance: Vec<f64> = (0..problem.load.len())
            .map(|r| found.accelerations[r] / problem.inverse_mass[r] - problem.load[r])
            .collect();
        let largest = found.forces.iter().fold(1.0_f64, |largest, f| largest.max(f.abs()));
        for (k, point) in problem.points.iter().enumerate() {
            let f = &found.forces[3 * k..3 * k + 3];
            let mut u = [0.0; 3];
            for (body, jacobian) in point.bodies.iter().zip(&point.jacobian) {
                let Some(body) = body else { continue };
                for row in 0..3 {
                    for entry in 0..6 {
                        u[row] += jacobian[row][entry] * found.accelerations[6 * body + entry];
                        balance[6 * body + entry] -= jacobian[row][entry] * f[row];
                    }
                }
            }
            assert!(f[1].hypot(f[2]) <= friction * f[0] * (1.0 + 1e-12) + 1e-12, "seed {seed}: outside the cone");
            assert!(u[0] >= friction * u[1].hypot(u[2]) - 1e-8, "seed {seed}: outside the dual cone");
            let power: f64 = (0..3).map(|row| f[row] * u[row]).sum();
            assert!(power.abs() <= 1e-8 * largest, "seed {seed}: {power:e}");
        }
        assert!(balance.iter().all(|b| b.abs() <= 1e-9 * largest), "seed {seed}: {balance:?}");
    }
}

#[test]
fn an_offset_lets_contacts_close_so_fast() {
    // One body above the ground, pulled down at 10: it may close at 3.
    let mut jacobian = [[[0.0; 6]; 3]; 2];
    jacobian[1][0][1] = 1.0;
    let point = Point { bodies: [None, Some(0)], jacobian, cone: Cone::Edges(vec![[1.0, 0.0, 0.0]]) };
    let problem = Gauss {
        size: 3,
        inverse_mass: vec![0.5; 3],
        load: vec![0.0, -20.0, 0.0],
        points: vec![point],
        offset: vec![3.0],
        ..Gauss::default()
    };
    let found = problem.solve();
    assert!((found.accelerations[1] + 3.0).abs() < 1e-10, "{found:?}");
    assert!((found.forces[0] - 14.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn a_basis_of_what_is_at_rest_leaves_the_equilibrium_solver_no_pivot() {
    let mut rested = 0;
    for seed in 0..80 {
        let size = if seed % 2 == 0 { 3 } else { 6 };
        let problem = random(seed, size, 4, 40, None);
        let found = problem.solve();
        if found.end != End::AtRest {
            continue;
        }
        rested += 1;
        let basis = problem.basis(&found.forces, |_| false).expect("forces of least cost");
        let (starts, rows, values) = generators(&problem);
        let columns = Columns::new(problem.load.len(), &starts, &rows, &values).unwrap();
        let loads: Vec<f64> = problem.load.iter().map(|load| -load).collect();
        let mut solver = ConeSolver::new(columns, &loads, &vec![10.0; loads.len()]).unwrap();
        solver.add_rows(&(0..loads.len()).collect::<Vec<_>>());
        solver.start_from(basis.iter().copied());
        assert_eq!(solver.solve(), Membership::Inside, "seed {seed}");
        assert_eq!((solver.counts().pivots, basis.len()), (0, loads.len()), "seed {seed}");
    }
    assert!(rested > 20, "{rested} of 80 are at rest");
}

/// Forces of a problem hold one with other loads, changed in few steps, or are not found: never others.
#[test]
fn forces_nearby_hold_bodies_under_other_loads() {
    let mut near = 0;
    for seed in 0..40 {
        let mut problem = random(seed, if seed % 2 == 0 { 3 } else { 6 }, 6, 60, None);
        let held = problem.solve();
        if held.end != End::AtRest {
            continue;
        }
        problem.load.iter_mut().step_by(3).for_each(|load| *load *= 1.2);
        let Some(found) = problem.rest_near(&held.forces) else { continue };
        assert!(found.iterations < 7 && found.forces.iter().all(|&f| f > 0.0));
        for (left, load) in imbalance(&problem, &found.forces).iter().zip(&problem.load) {
            assert!(left.abs() <= 1e-9 * (1.0 + load.abs()), "{left} of {load}");
        }
        near += 1;
    }
    assert!(near > 5, "{near}");
    assert!(random(1, 6, 3, 20, Some(0.5)).rest_near(&[1.0; 60]).is_none());
    let mut apart = random(1, 3, 3, 10, None);
    apart.points.clear();
    assert!(apart.rest_near(&[]).is_none());
}

/// What forces on pyramids leave of the loads.
fn imbalance(problem: &Gauss, forces: &[f64]) -> Vec<f64> {
    let (starts, rows, values) = generators(problem);
    let mut left = problem.load.clone();
    for (j, force) in forces.iter().enumerate() {
        (starts[j]..starts[j + 1]).for_each(|k| left[rows[k]] += force * values[k]);
    }
    left
}

#[test]
fn nothing_to_touch_falls_freely_and_no_body_is_no_trouble() {
    let free = Gauss { size: 3, inverse_mass: vec![1.0; 3], load: vec![0.0, -9.81, 0.0], ..Gauss::default() };
    assert!(free.solve().accelerations.iter().zip(&free.load).all(|(a, load)| (a - load).abs() < 1e-12));
    assert!(Gauss { size: 6, ..Gauss::default() }.solve().accelerations.is_empty());
}

/// A layer for each pair of bodies, between which all points of the pair are.
fn layers(problem: &Gauss, seed: u64) -> Layers {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut pairs: Vec<[Option<usize>; 2]> = problem.points.iter().map(|point| point.bodies).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let of = |point: &Point| pairs.binary_search(&point.bodies).expect("a pair");
    let mut row = || std::array::from_fn(|k| if k < problem.size { random.random_range(-1.0..1.0) } else { 0.0 });
    Layers {
        of: problem.points.iter().map(of).collect(),
        jacobian: problem.points.iter().map(|_| [row(), row(), row()]).collect(),
        stiffness: (0..pairs.len() * problem.size).map(|k| 0.5 + (k as f64 * 0.37).fract()).collect(),
    }
}

/// What forces do: to the bodies, body after body, and to the layers.
fn wrenches(problem: &Gauss, layers: &Layers, forces: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let size = problem.size;
    let (mut bodies, mut between) = (vec![0.0; problem.load.len()], vec![0.0; layers.stiffness.len()]);
    let mut next = 0;
    for (index, point) in problem.points.iter().enumerate() {
        let own = next..next + point.cone.unknowns();
        next = own.end;
        let force = point.cone.force(&forces[own]);
        for (row, f) in (0..3).zip(force) {
            for k in 0..size {
                between[layers.of[index] * size + k] += layers.jacobian[index][row][k] * f;
                for (body, rows) in point.bodies.iter().zip(&point.jacobian) {
                    body.iter().for_each(|body| bodies[body * size + k] += rows[row][k] * f);
                }
            }
        }
    }
    (bodies, between)
}

/// Random bodies that some forces within the cones hold: the loads are theirs.
fn held(seed: u64, size: usize, friction: Option<f64>) -> (Gauss, Layers) {
    let mut problem = random(seed, size, 6, 30, friction);
    let layers = layers(&problem, seed);
    let some: Vec<f64> = problem
        .points
        .iter()
        .enumerate()
        .flat_map(|(k, point)| match point.cone {
            // Of every third point nothing, of every third as much aside as there may be.
            Cone::Round { friction } => [[0.0; 3], [1.0, friction, 0.0], [1.0, 0.1, 0.1]][k % 3].to_vec(),
            Cone::Edges(_) => [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]][k % 3].to_vec(),
        })
        .collect();
    problem.load = wrenches(&problem, &layers, &some).0.iter().map(|load| -load).collect();
    (problem, layers)
}

/// What forces inside their cones hold is held in few steps, the last of which is the least change that balances the loads.
#[test]
fn what_stands_is_held_to_rounding_in_few_steps() {
    let mut most = [0; 3];
    for seed in 0..60 {
        let kind = seed as usize % 3;
        let (size, friction) = [(3, None), (6, None), (6, Some(0.5))][kind];
        let (mut problem, layers) = held(seed, size, friction);
        let some: Vec<f64> = match friction {
            Some(_) => [1.0, 0.1, 0.2].repeat(problem.points.len()),
            None => [1.0, 0.5].repeat(problem.points.len()),
        };
        problem.load = wrenches(&problem, &layers, &some).0.iter().map(|load| -load).collect();
        let found = problem.solve();
        assert_eq!(found.end, End::AtRest, "seed {seed}");
        most[kind] = most[kind].max(found.iterations);
        for (wrench, load) in wrenches(&problem, &layers, &found.forces).0.iter().zip(&problem.load) {
            assert!((wrench + load).abs() < 1e-10, "seed {seed}: {wrench} {load}");
        }
        let mut forces = &found.forces[..];
        for point in &problem.points {
            let (own, rest) = forces.split_at(point.cone.unknowns());
            forces = rest;
            match point.cone {
                Cone::Edges(_) => assert!(own.iter().all(|&f| f > 0.0), "seed {seed}: {own:?}"),
                Cone::Round { friction } => assert!(own[1].hypot(own[2]) < friction * own[0], "seed {seed}: {own:?}"),
            }
        }
    }
    assert_eq!(most, [6, 6, 6]);
}

/// (4) has no better forces: with the multipliers y and `u = Q W` no cone has a force along which the norm falls, and what bears
/// is square to its motion.
#[test]
fn forces_of_least_norm_obey_the_conditions_of_optimality() {
    for seed in 0..24 {
        let (size, friction) = [(3, None), (6, None), (6, Some(0.5))][seed as usize % 3];
        let (problem, layers) = held(seed, size, friction);
        let found = problem.least_norm(&layers);
        let (bodies, between) = wrenches(&problem, &layers, &found.forces);
        for (wrench, load) in bodies.iter().zip(&problem.load) {
            assert!((wrench + load).abs() < 1e-9, "seed {seed}: {wrench} {load}");
        }
        let (y, u) = found.accelerations.split_at(problem.load.len());
        // The unit of the motions is not known: that of the layers tells.
        let work: f64 = between.iter().zip(&layers.stiffness).map(|(w, stiffness)| w * w / stiffness).sum();
        let unit = between.iter().zip(u).map(|(w, u)| w * u).sum::<f64>() / work;
        for ((w, u), stiffness) in between.iter().zip(u).zip(&layers.stiffness) {
            assert!((w / stiffness * unit - u).abs() < 1e-8 * unit, "seed {seed}");
        }
        let (mut next, scale) = (0, unit * (1.0 + y.iter().fold(0.0_f64, |most, y| most.max((y / unit).abs()))));
        for (index, point) in problem.points.iter().enumerate() {
            let own = &found.forces[next..next + point.cone.unknowns()];
            next += own.len();
            let motion: [f64; 3] = std::array::from_fn(|row| {
                let along = |rows: &[[f64; 6]; 3], motion: &[f64]| -> f64 {
                    rows[row].iter().zip(motion).map(|(x, v)| x * v).sum()
                };
                let of_bodies = point.bodies.iter().zip(&point.jacobian);
                let moved =
                    of_bodies.map(|(body, rows)| body.map_or(0.0, |body| along(rows, &y[body * size..][..size])));
                moved.sum::<f64>() + along(&layers.jacobian[index], &u[layers.of[index] * size..][..size])
            });
            let power: f64 = point.cone.force(own).iter().zip(&motion).map(|(f, v)| f * v).sum();
            assert!(power.abs() < 1e-9 * scale, "seed {seed}: {power:e} of {scale:e}");
            let least = match &point.cone {
                Cone::Edges(edges) => {
                    let rate = |edge: &[f64; 3]| edge.iter().zip(&motion).map(|(d, v)| d * v).sum::<f64>();
                    edges.iter().map(rate).fold(f64::INFINITY, f64::min)
                }
                Cone::Round { friction } => motion[0] - friction * motion[1].hypot(motion[2]),
            };
            assert!(least > -1e-8 * scale, "seed {seed}: closes by {least:e} of {scale:e}");
        }
    }
}

/// Random joints, rigid: how a wrench on a layer acts on the two bodies is the same for all points of a pair.
fn rigid(seed: u64, size: usize, friction: Option<f64>) -> (Gauss, Layers, Vec<[[[f64; 6]; 6]; 2]>) {
    let mut problem = random(seed, size, 5, 40, friction);
    let layers = layers(&problem, seed);
    let mut random = Pcg64::seed_from_u64(seed);
    let mut matrix = || [[0.0; 6]; 6].map(|row: [f64; 6]| row.map(|_| random.random_range(-1.0..1.0)));
    let joints: Vec<_> = (0..layers.stiffness.len() / size).map(|_| [matrix(), matrix()]).collect();
    for (index, point) in problem.points.iter_mut().enumerate() {
        for (jacobian, joint) in point.jacobian.iter_mut().zip(&joints[layers.of[index]]) {
            let along = |row: &[f64; 6], k: usize| (0..size).map(|j| row[j] * joint[j][k]).sum();
            let row = |row| std::array::from_fn(|k| if k < size { along(&row, k) } else { 0.0 });
            *jacobian = layers.jacobian[index].map(row);
        }
    }
    (problem, layers, joints)
}

/// Of all wrenches with the same effect on the bodies those of elastic layers have the least norm: square, in its sense, to
/// what any others have more.
#[test]
fn layers_that_neither_part_nor_slide_bear_the_least_of_all_wrenches() {
    for seed in 0..60 {
        let (size, friction) = [(3, None), (6, None), (6, Some(0.5))][seed as usize % 3];
        let (mut problem, layers, joints) = rigid(seed, size, friction);
        let mut random = Pcg64::seed_from_u64(seed + 1);
        let forces: usize = problem.points.iter().map(|point| point.cone.unknowns()).sum();
        let any: Vec<f64> = (0..forces).map(|_| random.random_range(-1.0..1.0)).collect();
        let (bodies, others) = wrenches(&problem, &layers, &any);
        problem.load = bodies.iter().map(|wrench| -wrench).collect();
        let elastic = problem.elastic(&layers).expect("every body is held");
        let mut left = problem.load.clone();
        let mut of_layer = vec![None; joints.len()];
        layers.of.iter().zip(&problem.points).for_each(|(&layer, point)| of_layer[layer] = Some(point.bodies));
        for ((wrench, joint), bodies) in elastic.iter().zip(&joints).zip(&of_layer) {
            for (joint, body) in joint.iter().zip(bodies.unwrap_or_default()) {
                let Some(body) = body else { continue };
                for (row, w) in joint.iter().zip(wrench) {
                    (0..size).for_each(|k| left[body * size + k] += w * row[k]);
                }
            }
        }
        assert!(left.iter().all(|left| left.abs() < 1e-9), "seed {seed}: {left:?}");
        let least: Vec<f64> = elastic.iter().flat_map(|wrench| wrench[..size].to_vec()).collect();
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter().zip(b).zip(&layers.stiffness).map(|((a, b), stiffness)| a * b / stiffness).sum()
        };
        let norm = product(&others, &others);
        assert!((product(&others, &least) - product(&least, &least)).abs() < 1e-9 * norm, "seed {seed}");
        assert!(product(&least, &least) < 0.9 * norm, "seed {seed}");
    }
}

#[test]
fn what_layers_bear_does_not_change_with_points_that_add_no_wrench() {
    for seed in 0..8 {
        let (problem, layers) = held(seed, 3, None);
        let (mut more, mut thicker) = (problem.clone(), layers.clone());
        // Half way between two points of one pair: its forces are halves of theirs.
        for k in 0..problem.points.len() {
            let Some(other) = (0..k).find(|&other| layers.of[other] == layers.of[k]) else { continue };
            let half = |a: f64, b: f64| 0.5 * (a + b);
            let rows = |a: &[[f64; 6]; 3], b: &[[f64; 6]; 3]| -> [[f64; 6]; 3] {
                std::array::from_fn(|row| std::array::from_fn(|c| half(a[row][c], b[row][c])))
            };
            let (a, b) = (&problem.points[k], &problem.points[other]);
            let jacobian = [0, 1].map(|side| rows(&a.jacobian[side], &b.jacobian[side]));
            more.points.push(Point { jacobian, ..a.clone() });
            thicker.of.push(layers.of[k]);
            thicker.jacobian.push(rows(&layers.jacobian[k], &layers.jacobian[other]));
        }
        assert!(more.points.len() > problem.points.len());
        let before = wrenches(&problem, &layers, &problem.least_norm(&layers).forces).1;
        let after = wrenches(&more, &thicker, &more.least_norm(&thicker).forces).1;
        let largest = before.iter().fold(0.0_f64, |largest, w| largest.max(w.abs()));
        for (before, after) in before.iter().zip(&after) {
            assert!((before - after).abs() < 1e-9 * largest, "seed {seed}: {before} {after}");
        }
    }
}

/// `max t` with `G f + F + t F1 = 0`: pivots and the interior-point method find the same, and the motion of either proves it.
#[test]
fn the_greatest_factor_of_a_push_is_that_of_the_simplex_method() {
    let (mut limited, mut unlimited, mut iterations) = (0, 0, [0; 2]);
    for seed in 0..120 {
        let mut problem = random(seed, 3, 4, 14, None);
        let (starts, rows, values) = generators(&problem);
        let columns = Columns::new(problem.load.len(), &starts, &rows, &values).unwrap();
        let h: Vec<f64> = problem.load.iter().map(|load| -load).collect();
        let mut solver = ConeSolver::new(columns, &h, &vec![1.0; h.len()]).unwrap();
        solver.add_rows(&(0..h.len()).collect::<Vec<_>>());
        let push: Vec<(usize, f64)> = (0..h.len()).map(|row| (row, ((row * 7 + 3) % 5) as f64 - 2.0)).collect();
        let load = solver.add_load(&push).unwrap();
        if solver.solve() != Membership::Inside {
            continue;
        }
        let Greatest::Limited(factor) = solver.greatest(load) else {
            unlimited += 1;
            continue;
        };
        limited += 1;
        problem.push = push.iter().map(|entry| entry.1).collect();
        let found = problem.greatest_while(&mut || true).unwrap();
        assert!((found.factor - factor).abs() <= 1e-8 * factor.abs().max(1.0), "{seed}: {} {factor}", found.factor);
        // Where less is asked it ends earlier, with forces that hold: before the factor, but for what they leave.
        let within = problem.greatest_within(1e-4, &mut || true).unwrap();
        let before = (factor - within.factor) / factor.abs().max(1.0);
        assert!(before > -1e-8 && before <= 1e-4, "{seed}: {before}");
        [found.iterations, within.iterations].into_iter().enumerate().for_each(|(k, more)| iterations[k] += more);
        // The certificate of the pivots: y' G <= 0, y' (h - t d) = 0, y' d < 0.
        let y = solver.certificate();
        let along = |of: &dyn Fn(usize) -> f64| -> f64 { y.iter().map(|(row, y)| y * of(*row)).sum() };
        let (by_loads, by_push) = (along(&|row| h[row]), along(&|row| push[row].1));
        assert!(by_push < 0.0 && (by_loads - factor * by_push).abs() <= 1e-9 * by_push.abs() * factor.abs().max(1.0));
    }
    assert!(limited > 15 && unlimited > 0, "{limited} {unlimited}");
    assert!(10 * iterations[1] < 8 * iterations[0], "{iterations:?}");
}
