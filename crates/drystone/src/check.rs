//! Does it stand, with which contact forces, and if not, what falls?

use crate::{
    contact::Contact,
    error::SceneError,
    formulate::{Assembly, BlockSet, ContactForce},
    scene::Scene,
};
use drystone_lcp::{Counts, Settings, Solver, Status};

/// A block counts as standing while its acceleration stays below this share of gravity; turning counts by the
/// speed of the block's corner furthest from its centroid. Rounding in a stack of some hundred blocks leaves 1e-12; a
/// block that tips over an edge it overhangs by a millionth of its width has about 1e-6.
pub const STANDS: f64 = 1e-7;

/// The answer for an assembly or a sub-assembly.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// How the solver ended; anything but solved means that `stable` is not decided (and false).
    pub status: Status,
    /// An equilibrium exists within the friction cones (without friction this is also sufficient to stand).
    pub stable: bool,
    /// Indices of the movable bodies that were checked, ascending.
    pub checked: Vec<usize>,
    /// Acceleration of each of them: m/s^2, m/s^2, rad/s^2.
    pub accelerations: Vec<[f64; 3]>,
    /// Those that do not stay at rest.
    pub falling: Vec<usize>,
    /// Force at every contact point between checked or fixed bodies.
    pub forces: Vec<(Contact, ContactForce)>,
    /// Work done.
    pub counts: Counts,
    /// Residual of the complementarity problem, in its own scale.
    pub residual: f64,
}

/// Checks a scene, or the sub-assembly of the named bodies; fixed bodies are always there.
///
/// # Errors
/// [`SceneError`] for overlapping blocks and unknown names.
pub fn check(scene: &Scene, blocks: Option<&[String]>) -> Result<Verdict, SceneError> {
    let assembly = Assembly::new(scene)?;
    let set = match blocks {
        None => BlockSet::full(assembly.blocks()),
        Some(names) => named_blocks(scene, &assembly, names)?,
    };
    Ok(check_blocks(&assembly, &set))
}

fn named_blocks(scene: &Scene, assembly: &Assembly, names: &[String]) -> Result<BlockSet, SceneError> {
    let mut set = BlockSet::empty(assembly.blocks());
    let bodies = names.iter().map(|name| scene.index_of(name)).collect::<Result<Vec<_>, _>>()?;
    for block in 0..assembly.blocks() {
        if bodies.contains(&assembly.body_index(block)) {
            set.insert(block);
        }
    }
    Ok(set)
}

/// Checks a sub-assembly from scratch.
pub fn check_blocks(assembly: &Assembly, blocks: &BlockSet) -> Verdict {
    let rows = assembly.rows(blocks);
    let mut solver = Solver::new(assembly.problem(), Settings::default())
        .expect("A = G' M^-1 G is symmetric with a positive diagonal");
    solver.add_rows(&rows);
    let status = solver.solve().unwrap_or(Status::NumericalTrouble);
    verdict(assembly, blocks, &rows, &solver, status)
}

/// Reads a verdict from a solver that holds the solution of a sub-assembly.
fn verdict(assembly: &Assembly, blocks: &BlockSet, rows: &[usize], solver: &Solver, status: Status) -> Verdict {
    let f = |j: usize| solver.z(j);
    let accelerations = assembly.accelerations(blocks, f);
    let falling: Vec<usize> = blocks
        .iter()
        .zip(&accelerations)
        .filter(|&(block, acceleration)| !at_rest(assembly, block, acceleration))
        .map(|(block, _)| assembly.body_index(block))
        .collect();
    Verdict {
        status,
        stable: status == Status::Solved && falling.is_empty(),
        checked: blocks.iter().map(|block| assembly.body_index(block)).collect(),
        accelerations,
        falling,
        forces: assembly
            .contact_forces(rows, f)
            .into_iter()
            .map(|force| (assembly.contacts()[force.contact].clone(), force))
            .collect(),
        counts: solver.counts(),
        residual: solver.residual(),
    }
}

/// Whether every block of a sub-assembly is at rest under the solver's forces.
pub(crate) fn all_at_rest(assembly: &Assembly, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> bool {
    blocks.iter().all(|block| at_rest(assembly, block, &assembly.acceleration(block, &f)))
}

fn at_rest(assembly: &Assembly, block: usize, acceleration: &[f64; 3]) -> bool {
    let [gx, gy] = assembly.gravity();
    let [ax, ay, alpha] = *acceleration;
    let radius = assembly.body(block).polygon.vertices().iter().fold(0.0_f64, |radius, v| radius.max(v.length()));
    ax.hypot(ay).max(alpha.abs() * radius) <= STANDS * gx.hypot(gy)
}
