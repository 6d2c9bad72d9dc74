//! Does it stand, with which contact forces, and if not, what falls?

use crate::{
    contact::Contact,
    error::SceneError,
    formulate::{Acceleration, Assemble, Assembly, BlockSet, Components, ContactForce},
    geometry::length,
    scene::SceneOf,
    structure::put_up,
};
use drystone_lcp::{
    Counts, Settings, Solver, Status,
    cone::{ConeSolver, Membership},
};

/// A block is at rest while its acceleration stays below this share of gravity; turning counts by the speed of the
/// block's corner furthest from its centre of mass. Rounding in a stack of some hundred blocks leaves 1e-12; a block that
/// overhangs an edge by a hundred-millionth of its width has about 1e-8.
pub const AT_REST: f64 = 1e-9;

/// The answer for an assembly or a sub-assembly.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// How the solver ended; anything but solved means that `stable` is not decided (and false).
    pub status: Status,
    /// An equilibrium exists within the friction cones (without friction this is also sufficient to stand).
    pub stable: bool,
    /// Indices of the movable bodies that were checked, ascending.
    pub checked: Vec<usize>,
    /// Acceleration of each of them.
    pub accelerations: Vec<Acceleration>,
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
pub fn check<S: Assemble>(scene: &SceneOf<S>, blocks: Option<&[String]>) -> Result<Verdict, SceneError> {
    let assembly = Assembly::new(scene)?;
    Ok(check_while(&assembly, blocks, Route::Equilibrium, &mut |_| true)?.expect("nobody stops it"))
}

/// How a verdict is reached. Both routes give the same one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// Contact forces that balance the loads; accelerations by the complementarity problem only if there are none.
    Equilibrium,
    /// The complementarity problem in any case, by Dantzig's method from scratch.
    Complementarity,
}

/// [`check`] by a route of choice, unless it is stopped; None then.
///
/// # Errors
/// [`SceneError::UnknownName`].
pub fn check_while(
    assembly: &Assembly,
    blocks: Option<&[String]>,
    route: Route,
    go_on: &mut GoOn<'_>,
) -> Result<Option<Verdict>, SceneError> {
    let set = match blocks {
        None => BlockSet::full(assembly.blocks()),
        Some(names) => {
            let mut set = BlockSet::empty(assembly.blocks());
            assembly.named(names)?.into_iter().for_each(|block| set.insert(block));
            set
        }
    };
    Ok(match route {
        Route::Equilibrium => check_blocks_while(assembly, &set, go_on),
        Route::Complementarity => complementarity_while(assembly, &set, Counts::default(), go_on),
    })
}

/// Whether a scene stands, and nothing else.
///
/// # Errors
/// [`SceneError::Overlap`] if blocks overlap.
pub fn stands<S: Assemble>(scene: &SceneOf<S>) -> Result<bool, SceneError> {
    let assembly = Assembly::new(scene)?;
    Ok(equilibrium_of(&assembly, &BlockSet::full(assembly.blocks())).0 == Membership::Inside)
}

/// Asked many times, with the blocks put up so far, whether to go on.
pub type GoOn<'a> = dyn FnMut(usize) -> bool + 'a;

/// Looks for contact forces that hold a sub-assembly, putting it up block by block from the supports. None if stopped.
fn equilibrium_while(assembly: &Assembly, blocks: &BlockSet, go_on: &mut GoOn<'_>) -> Option<(Membership, ConeSolver)> {
    let mut equilibrium = assembly.equilibrium();
    let upward = assembly.upward().into_iter().filter(|&block| blocks.contains(block));
    let mut placed = 0;
    let before = |_: &mut ConeSolver, _| {
        placed += 1;
        go_on(placed - 1)
    };
    put_up(&mut equilibrium, &assembly.equilibrium_rows(), upward, before).then(|| (equilibrium.solve(), equilibrium))
}

fn equilibrium_of(assembly: &Assembly, blocks: &BlockSet) -> (Membership, ConeSolver) {
    equilibrium_while(assembly, blocks, &mut |_| true).expect("nobody stops it")
}

/// Checks a sub-assembly from scratch: equilibrium first, and the accelerations only if there is none.
pub fn check_blocks(assembly: &Assembly, blocks: &BlockSet) -> Verdict {
    check_blocks_while(assembly, blocks, &mut |_| true).expect("nobody stops it")
}

/// [`check_blocks`], unless it is stopped; None then.
pub fn check_blocks_while(assembly: &Assembly, blocks: &BlockSet, go_on: &mut GoOn<'_>) -> Option<Verdict> {
    let (found, equilibrium) = equilibrium_while(assembly, blocks, go_on)?;
    if found == Membership::Inside {
        let (counts, residual) = (equilibrium.counts(), equilibrium.residual());
        let magnitude = |j| assembly.magnitude(&equilibrium, j);
        return Some(verdict(assembly, blocks, magnitude, Status::Solved, counts, residual));
    }
    complementarity_while(assembly, blocks, equilibrium.counts(), go_on)
}

/// Solves the complementarity problem from scratch; `spent` is work done before.
pub(crate) fn solve_complementarity(assembly: &Assembly, blocks: &BlockSet, spent: Counts) -> Verdict {
    complementarity_while(assembly, blocks, spent, &mut |_| true).expect("nobody stops it")
}

/// [`solve_complementarity`], unless it is stopped; None then.
fn complementarity_while(
    assembly: &Assembly,
    blocks: &BlockSet,
    spent: Counts,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    let mut solver = Solver::new(assembly.problem(), Settings::default())
        .expect("A = G' M^-1 G is symmetric with a positive diagonal");
    solver.add_rows(&assembly.rows(blocks)).expect("rows of this assembly's problem");
    let size = blocks.len();
    let status = match solver.solve_while(&mut || go_on(size)) {
        Ok(solved) => solved?,
        Err(_) => Status::NumericalTrouble,
    };
    let mut found = verdict(assembly, blocks, |j| solver.z(j), status, spent + solver.counts(), solver.residual());
    found.stable = status == Status::Solved && stands_under(assembly, blocks, |j| solver.z(j));
    Some(found)
}

/// Reads a verdict from the magnitudes of the generators.
pub(crate) fn verdict(
    assembly: &Assembly,
    blocks: &BlockSet,
    f: impl Fn(usize) -> f64,
    status: Status,
    counts: Counts,
    residual: f64,
) -> Verdict {
    // Each is asked for by both blocks and by the contact.
    let magnitudes: Vec<f64> = (0..assembly.generators().len()).map(f).collect();
    let f = |generator: usize| magnitudes[generator];
    let accelerations: Vec<(usize, Components)> =
        blocks.iter().map(|block| (block, assembly.acceleration(block, f))).collect();
    let falls = accelerations.iter().filter(|(block, acceleration)| !at_rest(assembly, *block, acceleration));
    let falling: Vec<usize> = falls.map(|&(block, _)| assembly.body_index(block)).collect();
    Verdict {
        status,
        stable: status == Status::Solved && falling.is_empty(),
        checked: blocks.iter().map(|block| assembly.body_index(block)).collect(),
        accelerations: accelerations.into_iter().map(|(block, value)| assembly.in_world(block, value)).collect(),
        falling,
        forces: assembly
            .contact_forces(&assembly.rows(blocks), f)
            .into_iter()
            .map(|force| (assembly.contacts()[force.contact].clone(), force))
            .collect(),
        counts,
        residual,
    }
}

/// Accelerations below this share of gravity do not decide alone: the complementarity solver lets contacts open by
/// 1e-11 of its scale, and what is left of a motion whose power is that small has the square root of it.
const DOUBTFUL: f64 = 1e-4;

/// Whether a sub-assembly stands, by the forces of a complementarity solver; in doubt by an equilibrium.
pub(crate) fn stands_under(assembly: &Assembly, blocks: &BlockSet, f: impl Fn(usize) -> f64) -> bool {
    let fastest = moving_blocks(assembly, blocks, f)
        .map(|(block, acceleration)| severity(assembly, block, &acceleration))
        .fold(0.0, f64::max);
    fastest == 0.0 || fastest < DOUBTFUL && equilibrium_of(assembly, blocks).0 == Membership::Inside
}

/// The blocks of a sub-assembly that are not at rest under the solver's forces, with their accelerations.
pub(crate) fn moving_blocks<'a>(
    assembly: &'a Assembly,
    blocks: &'a BlockSet,
    f: impl Fn(usize) -> f64 + 'a,
) -> impl Iterator<Item = (usize, Components)> + 'a {
    let accelerated = blocks.iter().map(move |block| (block, assembly.acceleration(block, &f)));
    accelerated.filter(move |(block, acceleration)| !at_rest(assembly, *block, acceleration))
}

fn at_rest(assembly: &Assembly, block: usize, acceleration: &Components) -> bool {
    severity(assembly, block, acceleration) <= AT_REST
}

/// Largest acceleration of a point of a block, as a share of gravity (of 1 m/s^2 without gravity).
fn severity(assembly: &Assembly, block: usize, acceleration: &Components) -> f64 {
    let [x, y, z, turning @ ..] = *acceleration;
    let gravity = Some(length(assembly.gravity())).filter(|&gravity| gravity > 0.0).unwrap_or(1.0);
    length([x, y, z]).max(length(turning) * assembly.body(block).radius) / gravity
}
