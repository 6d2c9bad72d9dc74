//! Steps a drystone scene in Rapier, in double precision and without sleeping, and says how long each step took.
//!
//! ```text
//! rapier-benchmark SCENE.json DT STEPS EVERY
//! ```
//!
//! prints JSON: `step_seconds`, one number a step, of `PhysicsWorld::step` alone; and `frames`, the state of every body at
//! the beginning and after each EVERY steps: x, y (m), angle (rad) and their rates. Rapier's settings are its own but for the
//! time step, the friction and the sleeping.

use rapier2d_f64::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, Vector};
use serde::{Deserialize, Serialize};
use std::{collections::HashMap, error::Error, time::Instant};

/// What is needed of a scene file.
#[derive(Deserialize)]
struct Scene {
    gravity: [f64; 2],
    friction: f64,
    bodies: Vec<Body>,
    /// At the beginning, by name: m/s, m/s, rad/s.
    #[serde(default)]
    velocities: HashMap<String, [f64; 3]>,
}

#[derive(Deserialize)]
struct Body {
    name: String,
    #[serde(flatten)]
    shape: Shape,
    position: [f64; 2],
    angle: f64,
    density: f64,
    #[serde(default)]
    friction: Option<f64>,
    fixed: bool,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Shape {
    Box { size: [f64; 2] },
    Polygon { vertices: Vec<[f64; 2]> },
}

/// x, y, angle and their rates.
type State = [f64; 6];

#[derive(Serialize)]
struct Answer {
    version: &'static str,
    step_seconds: Vec<f64>,
    frames: Vec<Vec<State>>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, dt, steps, every] = arguments.as_slice() else {
        return Err("usage: rapier-benchmark SCENE.json DT STEPS EVERY".into());
    };
    let scene: Scene = serde_json::from_str(&std::fs::read_to_string(file)?)?;
    let answer = run(&scene, dt.parse()?, steps.parse()?, every.parse()?)?;
    serde_json::to_writer(std::io::stdout().lock(), &answer)?;
    Ok(())
}

fn run(scene: &Scene, dt: f64, steps: usize, every: usize) -> Result<Answer, String> {
    let (mut world, handles) = world(scene, dt)?;
    let mut answer = Answer {
        version: rapier2d_f64::VERSION,
        step_seconds: Vec::with_capacity(steps),
        frames: vec![states(&world, &handles)],
    };
    for made in 1..=steps {
        let begun = Instant::now();
        world.step();
        answer.step_seconds.push(begun.elapsed().as_secs_f64());
        if made % every == 0 {
            answer.frames.push(states(&world, &handles));
        }
    }
    Ok(answer)
}

fn world(scene: &Scene, dt: f64) -> Result<(PhysicsWorld, Vec<RigidBodyHandle>), String> {
    let mut world = PhysicsWorld { gravity: Vector::from_array(scene.gravity), ..PhysicsWorld::new() };
    world.integration_parameters.dt = dt;
    let mut place = |body: &Body| -> Result<RigidBodyHandle, String> {
        let builder = if body.fixed { RigidBodyBuilder::fixed() } else { RigidBodyBuilder::dynamic() };
        let builder = builder.translation(Vector::from_array(body.position)).rotation(body.angle).can_sleep(false);
        let [vx, vy, turning] = scene.velocities.get(&body.name).copied().unwrap_or_default();
        let builder = builder.linvel(Vector::from_array([vx, vy])).angvel(turning);
        let collider = body.shape.collider().ok_or_else(|| format!("{} is not convex", body.name))?;
        let collider = collider
            .density(body.density)
            .friction(body.friction.unwrap_or(scene.friction))
            .restitution(0.0);
        Ok(world.insert(builder, collider).0)
    };
    let handles = scene.bodies.iter().map(&mut place).collect::<Result<_, _>>()?;
    Ok((world, handles))
}

impl Shape {
    fn collider(&self) -> Option<ColliderBuilder> {
        match self {
            Self::Box { size: [width, height] } => Some(ColliderBuilder::cuboid(0.5 * width, 0.5 * height)),
            Self::Polygon { vertices } => {
                ColliderBuilder::convex_polyline(vertices.iter().copied().map(Vector::from_array).collect())
            }
        }
    }
}

fn states(world: &PhysicsWorld, handles: &[RigidBodyHandle]) -> Vec<State> {
    let state = |&handle: &RigidBodyHandle| {
        let body = &world.bodies[handle];
        let ([x, y], [vx, vy]) = (body.translation().to_array(), body.linvel().to_array());
        [x, y, body.rotation().angle(), vx, vy, body.angvel()]
    };
    handles.iter().map(state).collect()
}
