//! Scenes for the tests, and Coulomb's law written down again.

use drystone_contact::{Bodies, Contact, Solution};

/// A contact of bodies that turn about the world's axes: `normal` and two tangents at `point`, from the first into the second.
pub fn in_space(
    centers: &[[f64; 3]],
    [a, b]: [Option<usize>; 2],
    point: [f64; 3],
    normal: [f64; 3],
    friction: f64,
    offset: f64,
) -> Contact {
    let axis = if normal[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let t = unit(cross(normal, axis));
    let frame = [normal, t, cross(normal, t)];
    let rows = |body: Option<usize>, sign: f64| {
        let mut rows = [[0.0; 6]; 3];
        let Some(body) = body else { return rows };
        let lever = [0, 1, 2].map(|k| point[k] - centers[body][k]);
        for (row, d) in rows.iter_mut().zip(frame) {
            let moment = cross(lever, d);
            for k in 0..3 {
                row[k] = sign * d[k];
                row[3 + k] = sign * moment[k];
            }
        }
        rows
    };
    Contact { bodies: [a, b], jacobian: [rows(a, -1.0), rows(b, 1.0)], friction, offset }
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / length)
}

/// Relative velocity at a contact.
pub fn relative(problem: &Bodies, contact: &Contact, velocities: &[f64]) -> Vec<f64> {
    let size = problem.size;
    let along = |d: usize| {
        let of = |side: usize| {
            let row = &contact.jacobian[side][d];
            contact.bodies[side].map_or(0.0, |body| (0..size).map(|k| row[k] * velocities[size * body + k]).sum())
        };
        of(0) + of(1)
    };
    (0..problem.dimension()).map(along).collect()
}

/// Largest departure from each condition alone, m/s; impulses as the speed that they give at their own contact.
pub fn departure(problem: &Bodies, solution: &Solution) -> f64 {
    let d = problem.dimension();
    let mut worst = momentum(problem, solution);
    for (k, contact) in problem.contacts.iter().enumerate() {
        let u = relative(problem, contact, &solution.velocities);
        let square = |side: usize, body: usize| -> f64 {
            let row = &contact.jacobian[side][0];
            (0..problem.size).map(|i| row[i] * row[i] * problem.inverse_mass[problem.size * body + i]).sum()
        };
        let yields: f64 = (0..2).filter_map(|side| Some(square(side, contact.bodies[side]?))).sum();
        let p: Vec<f64> = solution.impulses[d * k..d * (k + 1)].iter().map(|p| p * yields).collect();
        let length = |x: &[f64]| x[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
        let (friction, speed) = (length(&p), length(&u));
        let open = u[0] + contact.offset;
        worst = worst.max(-open).max(-p[0]).max(p[0].min(open)).max(friction - contact.friction * p[0]);
        if speed > 0.0 {
            // The power that friction takes is all that it can, so far as it slides.
            let power: f64 = p[1..].iter().zip(&u[1..]).map(|(p, u)| p * u).sum::<f64>() / speed;
            worst = worst.max(speed.min(power + contact.friction * p[0]));
        }
    }
    worst
}

/// `M (v - v*) - J' p`, by the mass.
fn momentum(problem: &Bodies, solution: &Solution) -> f64 {
    let (size, d) = (problem.size, problem.dimension());
    let mut left: Vec<f64> = solution.velocities.iter().zip(&problem.free).map(|(v, free)| v - free).collect();
    for (k, contact) in problem.contacts.iter().enumerate() {
        for side in 0..2 {
            let Some(body) = contact.bodies[side] else { continue };
            for i in 0..size {
                let given: f64 = (0..d).map(|j| contact.jacobian[side][j][i] * solution.impulses[d * k + j]).sum();
                left[size * body + i] -= given * problem.inverse_mass[size * body + i];
            }
        }
    }
    left.iter().fold(0.0, |worst, x| worst.max(x.abs()))
}

/// `v' M v / 2`.
pub fn energy(problem: &Bodies, velocities: &[f64]) -> f64 {
    velocities.iter().zip(&problem.inverse_mass).map(|(v, inverse)| 0.5 * v * v / inverse).sum()
}

/// Cubes of 1 m on top of each other, of these masses, each with the four corners of a face below it; the lowest on the ground.
/// `v*` are those of a step of 1/240 s from rest.
pub fn tower(masses: &[f64], friction: f64, slope: [f64; 2]) -> Bodies {
    let centers: Vec<[f64; 3]> = (0..masses.len()).map(|k| [0.0, 0.0, k as f64 + 0.5]).collect();
    let fall = 9.81 / 240.0;
    let [sin, cos] = [slope[0].sin(), slope[0].cos()];
    let mut problem = Bodies { size: 6, ..Bodies::default() };
    for (k, mass) in masses.iter().enumerate() {
        problem.inverse_mass.extend([1.0 / mass, 1.0 / mass, 1.0 / mass, 6.0 / mass, 6.0 / mass, 6.0 / mass]);
        let along = fall * sin;
        problem.free.extend([along * slope[1].cos(), along * slope[1].sin(), -fall * cos, 0.0, 0.0, 0.0]);
        for [x, y] in [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] {
            let bodies = [k.checked_sub(1), Some(k)];
            problem.contacts.push(in_space(&centers, bodies, [x, y, k as f64], [0.0, 0.0, 1.0], friction, 0.0));
        }
    }
    problem
}
