//! What a step asks of solids. Bodies turn about their principal axes, so that M is diagonal.

use super::kinematics::{Kinematics, masses};
use crate::{
    any_scene::AnyScene,
    error::SceneError,
    formulate::Cones,
    geometry::{PoseInSpace, Solid, Vector3, cross, dot},
    io,
    scene::{Body, SceneOf},
};

impl Kinematics for Solid {
    type Place = [f64; 7];

    fn place_of(pose: &PoseInSpace) -> [f64; 7] {
        let PoseInSpace { position: [x, y, z], orientation: [a, b, c, d] } = *pose;
        [x, y, z, a, b, c, d]
    }

    fn advanced(body: &Body<Self>, [vx, vy, vz, a, b, c]: &[f64; 6], seconds: f64) -> PoseInSpace {
        let [x, y, z] = body.pose.position;
        let [first, second, third] = body.principal_axes();
        PoseInSpace {
            position: [x + seconds * vx, y + seconds * vy, z + seconds * vz],
            orientation: body.pose.turned(seconds * (*a * first + *b * second + *c * third)).orientation,
        }
    }

    fn undisturbed(body: &Body<Self>, velocity: &[f64; 6], seconds: f64) -> [f64; 6] {
        let [vx, vy, vz, a, b, c] = *velocity;
        let [.., ia, ib, ic] = masses(body);
        let [a, b, c] = spin([ia, ib, ic], [a, b, c], seconds);
        [vx, vy, vz, a, b, c]
    }

    fn to_own_axes(body: &Body<Self>, [vx, vy, vz, a, b, c]: &[f64; 6]) -> [f64; 6] {
        let turning = Vector3::new(*a, *b, *c);
        let [a, b, c] = world_axes(body).map(|axis| axis.dot(turning));
        [*vx, *vy, *vz, a, b, c]
    }

    fn to_world_axes(body: &Body<Self>, [vx, vy, vz, a, b, c]: &[f64; 6]) -> [f64; 6] {
        let [first, second, third] = world_axes(body);
        let turning = *a * first + *b * second + *c * third;
        [*vx, *vy, *vz, turning.x, turning.y, turning.z]
    }

    fn edges(cones: Cones, normal: [f64; 3], friction: f64, gravity: [f64; 3]) -> Vec<[f64; 3]> {
        cones.edges(normal, friction, gravity)
    }

    fn edge_friction(cones: Cones, friction: f64) -> f64 {
        cones.at_edges(friction)
    }

    /// An edge is `(n + mu t) / sqrt(1 + mu^2)`, so `mu t . u = sqrt(1 + mu^2) edge . u - n . u`.
    fn sliding_speed(edges: &[[f64; 3]], normal: &[f64; 3], edge_friction: f64, u: &[f64; 3]) -> f64 {
        if edge_friction == 0.0 {
            return 0.0;
        }
        let (length, opening) = (edge_friction.hypot(1.0), dot(*normal, *u));
        let against = edges.iter().map(|edge| (opening - length * dot(*edge, *u)) / edge_friction);
        against.fold(0.0, f64::max)
    }

    fn immovable(scene: &SceneOf<Self>) -> Option<String> {
        let found = scene.bodies().iter().find(|body| body.shape.surface().is_some());
        found.map(|body| body.name.clone())
    }

    fn of_any(scene: AnyScene) -> Result<SceneOf<Self>, SceneError> {
        scene.in_space()
    }

    fn to_json(scene: &SceneOf<Self>) -> String {
        io::to_json(scene)
    }
}

/// The principal axes in the world.
fn world_axes(body: &Body<Solid>) -> [Vector3; 3] {
    body.principal_axes().map(|axis| body.pose.rotate(axis))
}

/// Newton's iterations for a free turn. Three are the rule; a body that turns by more than a radian in the step takes more.
const MOST_ITERATIONS: usize = 50;

/// Euler's equations `I w' + w x I w = 0` about the principal axes by the implicit midpoint rule,
///
/// ```text
/// I (w+ - w) + h m x I m = 0,    m = (w + w+) / 2,
/// ```
///
/// which keeps the kinetic energy `w' I w / 2` and the length of the angular momentum `I w` whatever the step.
fn spin(inertia: [f64; 3], start: [f64; 3], seconds: f64) -> [f64; 3] {
    let momentum = |w: [f64; 3]| [0, 1, 2].map(|k| inertia[k] * w[k]);
    let mut end = start;
    for _ in 0..MOST_ITERATIONS {
        let middle = [0, 1, 2].map(|k| 0.5 * (start[k] + end[k]));
        let gyration = cross(middle, momentum(middle));
        let rest = [0, 1, 2].map(|k| inertia[k] * (end[k] - start[k]) + seconds * gyration[k]);
        if rest == [0.0; 3] {
            break;
        }
        // Columns of the derivative: I + h/2 (m x I . - I m x .).
        let column = |k: usize| {
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            let (of_momentum, of_velocity) = (cross(middle, momentum(unit)), cross(momentum(middle), unit));
            [0, 1, 2].map(|j| inertia[k] * unit[j] + 0.5 * seconds * (of_momentum[j] - of_velocity[j]))
        };
        let next = solved([column(0), column(1), column(2)], rest).map(|change| [0, 1, 2].map(|k| end[k] - change[k]));
        match next.filter(|next| next.iter().all(|x| x.is_finite()) && *next != end) {
            Some(next) => end = next,
            None => break,
        }
    }
    // Where the iteration has not converged the step still gives no energy.
    let energy = |w: [f64; 3]| dot(w, momentum(w));
    let (before, after) = (energy(start), energy(end));
    let share = if after > before { (before / after).sqrt() } else { 1.0 };
    end.map(|x| x * share)
}

/// Cramer's rule for three columns.
fn solved([a, b, c]: [[f64; 3]; 3], right: [f64; 3]) -> Option<[f64; 3]> {
    let across = cross(b, c);
    let determinant = dot(a, across);
    let of = |x: f64| x / determinant;
    (determinant != 0.0).then(|| [of(dot(right, across)), of(dot(a, cross(right, c))), of(dot(a, cross(b, right)))])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_free_turn_keeps_energy_and_momentum() {
        let inertia = [1.0, 2.0, 3.5];
        let mut w = [0.3, -4.0, 0.7];
        let energy = |w: [f64; 3]| (0..3).map(|k| 0.5 * inertia[k] * w[k] * w[k]).sum::<f64>();
        let momentum = |w: [f64; 3]| (0..3).map(|k| (inertia[k] * w[k]).powi(2)).sum::<f64>().sqrt();
        let (e, l) = (energy(w), momentum(w));
        let mut turned_over = false;
        for _ in 0..20_000 {
            w = spin(inertia, w, 1.0 / 240.0);
            assert!((energy(w) - e).abs() < 1e-10 * e && (momentum(w) - l).abs() < 1e-10 * l, "{w:?}");
            turned_over |= w[1] > 0.5;
        }
        // About the middle axis no turn is steady: the axis flips over (Poinsot; Dzhanibekov's nut).
        assert!(turned_over);
    }

    #[test]
    fn nothing_turns_of_itself() {
        assert_eq!(spin([1.0, 2.0, 3.0], [0.0; 3], 0.1), [0.0; 3]);
        assert_eq!(spin([2.0; 3], [1.0, 2.0, 3.0], 0.1), [1.0, 2.0, 3.0]);
        assert_eq!(spin([1.0, 2.0, 3.0], [0.0, 5.0, 0.0], 0.1), [0.0, 5.0, 0.0]);
    }
}
