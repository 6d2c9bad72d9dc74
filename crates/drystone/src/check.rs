//! Does it stand, with which contact forces, and if not, what falls?

mod collapse;
mod elastic;
mod interior;
mod takedown;

use crate::{
    contact::Contact,
    crossover::or_from_interior,
    equilibrium::{Effort, equilibrium_of, equilibrium_while},
    error::SceneError,
    formulate::{Acceleration, Assemble, Assembly, BlockSet, ContactForce, FrictionCone, Moving},
    judgement::{CLOSING_AS_SOLVED, Judgement, judge, moving_blocks, proves_fall},
    ladder::{FEW_ROWS, Ladder},
    scene::SceneOf,
};
use drystone_lcp::{
    Counts, Settings, Solver, Status,
    cone::{ConeSolver, Doubt, Membership},
};

pub use crate::{equilibrium::GoOn, judgement::AT_REST};

/// The answer for an assembly or a sub-assembly.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// How the solver ended; anything but solved means that `stable` is not decided (and false). Borderline: neither
    /// standing nor falling is proved, see `doubt`.
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
    /// Iterations of the interior-point method: matrices factored.
    pub iterations: usize,
    /// Residual of the complementarity problem, in its own scale.
    pub residual: f64,
    /// The accelerations are those along a virtual motion in which it falls, not those with which it begins to: the
    /// complementarity problem could not be solved to an accuracy that tells.
    pub virtual_motion: bool,
    /// Whether the forces are those of least norm ([`canonical_forces`](crate::canonical::canonical_forces)) already.
    pub least_norm: bool,
    /// Of a borderline verdict: how near it is to standing, and to falling.
    pub doubt: Option<Doubt>,
}

/// Checks a scene, or the sub-assembly of the named bodies; fixed bodies are always there.
///
/// # Errors
/// [`SceneError`] for overlapping blocks and unknown names.
pub fn check<S: Assemble>(scene: &SceneOf<S>, blocks: Option<&[String]>) -> Result<Verdict, SceneError> {
    let assembly = Assembly::new(scene)?;
    Ok(check_while(&assembly, blocks, Route::Equilibrium, FrictionCone::Pyramid, &mut |_| true)?
        .expect("nobody stops it"))
}

/// How a verdict is reached. All routes give the same one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// Contact forces that balance the loads, by pivots as long as these are no slower than the interior-point method;
    /// accelerations only if there are none.
    Equilibrium,
    /// The complementarity problem in any case, by Dantzig's method from scratch; with pyramids only.
    Complementarity,
    /// Gauss's principle in any case, by the interior-point method.
    InteriorPoint,
}

/// [`check`] by a route and with friction cones of choice, unless it is stopped; None then.
///
/// # Errors
/// [`SceneError::UnknownName`].
pub fn check_while(
    assembly: &Assembly,
    blocks: Option<&[String]>,
    route: Route,
    cone: FrictionCone,
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
        Route::Equilibrium => check_blocks_while(assembly, &set, cone, go_on),
        Route::Complementarity => complementarity_while(assembly, &set, None, Counts::default(), go_on),
        Route::InteriorPoint => interior::check(assembly, &set, cone, Counts::default(), go_on),
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

/// Checks a sub-assembly from scratch: equilibrium first, and the accelerations only if there is none.
pub fn check_blocks(assembly: &Assembly, blocks: &BlockSet) -> Verdict {
    check_blocks_while(assembly, blocks, FrictionCone::Pyramid, &mut |_| true).expect("nobody stops it")
}

/// Most rows for which the complementarity problem tells the accelerations of what falls, where blocks differ so widely that accelerations are
/// refined to more than 64 bits, which takes a basis: the pivots for as many rows take a second or two.
const FEW_IF_WIDE: usize = 2_000;

fn few(assembly: &Assembly) -> usize {
    if assembly.is_wide() { FEW_IF_WIDE } else { FEW_ROWS }
}

/// [`check_blocks`] with friction cones of choice, unless it is stopped; None then.
pub fn check_blocks_while(
    assembly: &Assembly,
    blocks: &BlockSet,
    cone: FrictionCone,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    let ladder = Ladder::of(assembly, blocks.len());
    if let Some(stands) = takedown::check(assembly, blocks) {
        return Some(stands);
    }
    if ladder.elastic_first()
        && let Some(stands) = elastic::check(assembly, blocks, cone)
    {
        return Some(stands);
    }
    if !ladder.pivots_next() {
        return interior::check(assembly, blocks, cone, Counts::default(), go_on);
    }
    let (found, equilibrium) = equilibrium_while(assembly, blocks, Effort::FromNothing, go_on)?;
    let spent = equilibrium.counts();
    match found {
        // What stands within pyramids stands within the round cones around them.
        Membership::Inside => Some(held(assembly, blocks, &equilibrium, spent)),
        Membership::PivotLimit => interior::check(assembly, blocks, cone, spent, go_on),
        _ if assembly.is_round(cone) => interior::check(assembly, blocks, cone, spent, go_on),
        _ => by_equilibrium(assembly, blocks, found, &equilibrium, spent, go_on),
    }
}

/// The verdict that an equilibrium solver has come to, with all its forces up to date; the accelerations of what falls are
/// those of the complementarity problem. `spent` is the work done for it. None if stopped.
pub(crate) fn by_equilibrium(
    assembly: &Assembly,
    blocks: &BlockSet,
    found: Membership,
    equilibrium: &ConeSolver,
    spent: Counts,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    match found {
        Membership::Inside => Some(held(assembly, blocks, equilibrium, spent)),
        // Accelerations, and the forces under them, may prove what multipliers and simplex' forces do not.
        Membership::Borderline => {
            let moved = complementarity_while(assembly, blocks, None, spent, go_on)?;
            let falls_perhaps = equilibrium.doubt().is_some_and(|doubt| doubt.is_at_a_limit());
            let decided = moved.status == Status::Solved && !(moved.stable && falls_perhaps);
            Some(if decided { moved } else { held(assembly, blocks, equilibrium, spent) })
        }
        Membership::Outside => {
            let moved = match assembly.rows(blocks).len() > few(assembly) {
                true => Some(interior::by_interior_point(assembly, blocks, FrictionCone::Pyramid, spent, go_on)?),
                false => None,
            };
            match moved {
                Some(moved) if moved.status == Status::Solved && !moved.stable => Some(moved),
                _ => complementarity_while(assembly, blocks, Some(equilibrium), spent, go_on),
            }
        }
        _ => complementarity_while(assembly, blocks, None, spent, go_on),
    }
}

/// Solves the complementarity problem from scratch; `fell` is an equilibrium solver that has found that the sub-assembly falls,
/// `spent` is work done before.
fn complementarity_while(
    assembly: &Assembly,
    blocks: &BlockSet,
    fell: Option<&ConeSolver>,
    spent: Counts,
    go_on: &mut GoOn<'_>,
) -> Option<Verdict> {
    let mut solver = Solver::new(assembly.problem(), Settings::default())
        .expect("A = G' M^-1 G is symmetric with a positive diagonal");
    solver.add_rows(&assembly.rows(blocks)).expect("rows of this assembly's problem");
    let size = blocks.len();
    let status = match solver.solve_while(&mut || go_on(size)) {
        // A = G' M^-1 G and q = -G' M^-1 F have a solution always: a ray is made of rounding, beside masses of 1e13 to one.
        Ok(Some(Status::NoSolution)) | Err(_) => Status::NumericalTrouble,
        Ok(solved) => solved?,
    };
    let counts = spent + solver.counts();
    let moving = assembly.moving(blocks, |j| solver.z(j));
    let found = verdict(assembly, blocks, &moving, status, counts, solver.residual());
    let fallen = |found: Verdict, equilibrium: &ConeSolver| {
        let proved = status == Status::Solved
            && !found.falling.is_empty()
            && proves_fall(assembly, blocks, &moving, CLOSING_AS_SOLVED);
        if proved {
            Verdict { stable: false, ..found }
        } else {
            collapse::verdict(assembly, blocks, found, equilibrium)
        }
    };
    let judgement = match (fell, status) {
        (Some(equilibrium), _) => return Some(fallen(found, equilibrium)),
        (None, Status::Solved) => judge(assembly, blocks, &moving),
        (None, _) => Judgement::by_equilibrium(assembly, blocks),
    };
    Some(match or_from_interior(judgement, assembly, blocks) {
        Judgement::Stands => found,
        Judgement::Falls => Verdict { stable: false, ..found },
        Judgement::ByEquilibrium(Membership::Outside, equilibrium) => fallen(found, &equilibrium),
        Judgement::ByEquilibrium(Membership::Inside | Membership::Borderline, equilibrium) => {
            held(assembly, blocks, &equilibrium, counts)
        }
        Judgement::ByEquilibrium(..) => {
            let status = if status == Status::Solved { Status::NumericalTrouble } else { status };
            Verdict { status, stable: false, falling: Vec::new(), ..found }
        }
    })
}

/// The verdict on what is held up by the forces of an equilibrium solver, for certain or borderline.
fn held(assembly: &Assembly, blocks: &BlockSet, equilibrium: &ConeSolver, counts: Counts) -> Verdict {
    let moving = assembly.moving_under(blocks, |j| assembly.magnitude(equilibrium, j));
    let held = verdict(assembly, blocks, &moving, Status::Solved, counts, equilibrium.residual());
    let doubt = equilibrium.doubt();
    let status = if doubt.is_some() { Status::Borderline } else { Status::Solved };
    Verdict { status, stable: doubt.is_none(), falling: Vec::new(), doubt, ..held }
}

/// Reads a verdict from the magnitudes of the generators and the accelerations under them.
fn verdict(
    assembly: &Assembly,
    blocks: &BlockSet,
    under: &Moving,
    status: Status,
    counts: Counts,
    residual: f64,
) -> Verdict {
    let moving = moving_blocks(assembly, under);
    let falling: Vec<usize> = moving.iter().map(|&(block, _)| assembly.body_index(block)).collect();
    Verdict {
        status,
        stable: status == Status::Solved && falling.is_empty(),
        checked: blocks.iter().map(|block| assembly.body_index(block)).collect(),
        accelerations: under.motion.iter().map(|&(block, value)| assembly.in_world(block, value)).collect(),
        falling,
        forces: assembly
            .contact_forces(&assembly.rows(blocks), |j| under.forces[j])
            .into_iter()
            .map(|force| (assembly.contacts()[force.contact].clone(), force))
            .collect(),
        counts,
        iterations: 0,
        residual,
        virtual_motion: false,
        least_norm: false,
        doubt: None,
    }
}
