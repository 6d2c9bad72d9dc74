//! From a scene to a plan: the check of the complete assembly, and the search.

use super::ahead::Ahead;
use super::clear_path::{Blocked, Moves, Paths};
use super::dead_end::{dead_end, until_stopped};
use super::found::{Found, check_alone};
use super::in_turn::{InTurn, first_turn};
use super::must_stand::MustStand;
use super::outcome::{Conditions, Limits, MOST_HANDS, Monitor, Outcome, Plan};
use super::reuse::Reuse;
use super::search::Clock;
use super::stability::{FromScratch, PlanError, ReuseDantzig, StabilityTest, Test};
use super::together::{search_units, units_of};
use super::touching::Touching;
use super::under_each::UnderEach;
use super::whole::{Checked, check_before_search, check_beside, check_beside_search};
use super::with_hands::search_with_hands;
use crate::{
    check::check_blocks,
    error::SceneError,
    formulate::{Assemble, Assembly, BlockSet},
    limit::accelerated,
    scene::SceneOf,
    strong::{Budget, strong},
};
use std::{
    sync::atomic::AtomicBool,
    time::{Duration, Instant},
};

/// Plans with one of this crate's tests.
///
/// # Errors
/// [`PlanError`] for an invalid scene or a test without an answer.
pub fn plan<S: Assemble>(
    scene: &SceneOf<S>,
    test: Test,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    plan_under(scene, test, &Conditions::default(), limits, monitor)
}

/// [`plan`] under further conditions. Where blocks are held, the equilibrium of [`Test::Reuse`] decides, whichever test is
/// named.
///
/// # Errors
/// As [`plan`], and [`SceneError::BadParameter`] for more than [`MOST_HANDS`] blocks held and for directions that are none.
pub fn plan_under<S: Assemble>(
    scene: &SceneOf<S>,
    test: Test,
    conditions: &Conditions,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let Some(assembly) = limits.interrupt(start).run(|| Assembly::new(scene)) else {
        return Ok(Plan::stopped(limits.stopped(start), start.elapsed()));
    };
    let mut plan = plan_assembly_under(scene, &assembly?, test, conditions, limits.after(start), monitor)?;
    plan.total = start.elapsed();
    Ok(plan)
}

/// [`plan`] of an assembly whose contacts are known.
///
/// # Errors
/// [`PlanError`] for a test without an answer.
pub fn plan_assembly(
    assembly: &Assembly,
    test: Test,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    with_named(assembly, test, limits, |test, limits| plan_with(assembly, test, limits, monitor))
}

/// [`plan_under`] of an assembly whose contacts are known; it is the scene's.
///
/// # Errors
/// As [`plan_under`].
pub fn plan_assembly_under<S: Assemble>(
    scene: &SceneOf<S>,
    assembly: &Assembly,
    test: Test,
    conditions: &Conditions,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    if conditions.margin != 0.0 {
        return plan_with_margin(scene, assembly, conditions, limits, monitor);
    }
    if conditions.strong {
        return plan_strong(scene, assembly, conditions, limits, monitor);
    }
    with_named(assembly, test, limits, |test, limits| {
        plan_with_under(scene, assembly, test, conditions, limits, monitor)
    })
}

fn refused(parameter: &str, found: String, expected: &str) -> SceneError {
    let (scene, parameter, expected) = ("plan".into(), parameter.into(), expected.into());
    SceneError::BadParameter { scene, parameter, found, expected }
}

/// [`plan_assembly_under`] by [`Test::Reuse`], where every structure must stand.
fn plan_strong<S: Assemble>(
    scene: &SceneOf<S>,
    assembly: &Assembly,
    conditions: &Conditions,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    if conditions.hold > 0 {
        return Err(refused("hold", conditions.hold.to_string(), "0 where every structure must stand").into());
    }
    let blocks = assembly.every_block();
    let whole = || strong(assembly, &blocks, Budget::default(), &mut |_| true).expect("nobody stops it").must_stand;
    plan_asking_more(scene, assembly, (whole, || MustStand::new(assembly)), conditions, limits, monitor)
}

/// [`plan_assembly_under`] by [`Test::Reuse`], where every structure has to have a margin.
fn plan_with_margin<S: Assemble>(
    scene: &SceneOf<S>,
    assembly: &Assembly,
    conditions: &Conditions,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    if !(conditions.margin > 0.0 && conditions.margin.is_finite()) {
        return Err(refused("margin", conditions.margin.to_string(), "zero or more, over gravity").into());
    }
    if conditions.hold > 0 {
        return Err(refused("hold", conditions.hold.to_string(), "0 where there is a margin").into());
    }
    if conditions.strong {
        return Err(refused("strong", true.to_string(), "false where there is a margin").into());
    }
    let Some(cases) = limits.interrupt(start).run(|| accelerated(assembly, scene, conditions.margin)) else {
        return Ok(Plan::stopped(limits.stopped(start), start.elapsed()));
    };
    let (cases, blocks) = (cases?, assembly.every_block());
    let whole = || Some(cases.iter().all(|case| check_blocks(case, &blocks).stable));
    let asked = (whole, || UnderEach::new(&cases));
    let mut plan = plan_asking_more(scene, assembly, asked, conditions, limits.after(start), monitor)?;
    plan.total = start.elapsed();
    Ok(plan)
}

/// Plans where structures have to do more than to be able to stand: whether the complete one does, None if that is not decided, and
/// the test of the others, made if it does.
fn plan_asking_more<S: Assemble, T: StabilityTest>(
    scene: &SceneOf<S>,
    assembly: &Assembly,
    (whole, test): (impl FnOnce() -> Option<bool>, impl FnOnce() -> T),
    conditions: &Conditions,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let outcome = match limits.interrupt(start).run(whole) {
        None => return Ok(Plan::stopped(limits.stopped(start), start.elapsed())),
        Some(None) => Outcome::Undecided,
        Some(Some(false)) => Outcome::WholeFalls,
        Some(Some(true)) => {
            let mut plan = plan_with_under(scene, assembly, &mut test(), conditions, limits.after(start), monitor)?;
            plan.total = start.elapsed();
            return Ok(plan);
        }
    };
    let whole = Some(check_blocks(assembly, &assembly.every_block()));
    Ok(Plan { whole, ..Plan::stopped(outcome, start.elapsed()) })
}

/// Plans with a test by name, whose setting up counts, and within what that leaves of the limits.
fn with_named(
    assembly: &Assembly,
    test: Test,
    limits: Limits,
    plan: impl FnOnce(&mut dyn StabilityTest, Limits) -> Result<Plan, PlanError>,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let set_up = limits.interrupt(start).run(|| -> Box<dyn StabilityTest + '_> {
        match test {
            Test::Lcp => from_scratch(assembly, limits.threads()),
            Test::Reuse => Box::new(Reuse::new(assembly)),
            Test::ReuseDantzig => Box::new(ReuseDantzig::new(assembly)),
        }
    });
    let Some(mut test) = set_up else { return Ok(Plan::stopped(limits.stopped(start), start.elapsed())) };
    let setup = start.elapsed();
    let mut plan = plan(test.as_mut(), limits.after(start))?;
    plan.setup = setup;
    plan.total += setup;
    Ok(plan)
}

fn from_scratch(assembly: &Assembly, threads: usize) -> Box<dyn StabilityTest + '_> {
    match Some(threads).filter(|&threads| threads > 1).and_then(|threads| Ahead::new(assembly, threads)) {
        Some(ahead) => Box::new(ahead),
        None => Box::new(FromScratch::new(assembly)),
    }
}

/// Plans with any stability test.
///
/// # Errors
/// [`PlanError`] if the test gives no answer.
pub fn plan_with(
    assembly: &Assembly,
    test: &mut dyn StabilityTest,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    search_under(assembly, test, 0, None, limits, monitor)
}

/// [`plan_under`] with any stability test; `assembly` is the scene's.
///
/// # Errors
/// As [`plan_under`].
pub fn plan_with_under<S: Assemble>(
    scene: &SceneOf<S>,
    assembly: &Assembly,
    test: &mut dyn StabilityTest,
    conditions: &Conditions,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    if conditions.hold > MOST_HANDS {
        let expected = format!("at most {MOST_HANDS} blocks held at a time");
        return Err(refused("hold", conditions.hold.to_string(), &expected).into());
    }
    let Some(clear) = &conditions.clear_path else {
        return search_under(assembly, test, conditions.hold, None, limits, monitor);
    };
    let paths = Paths::new(scene, assembly, clear)?;
    search_ways_out(assembly, test, (conditions.hold, clear.together), paths, limits, monitor)
}

/// Searches with the directions at contacts, and where there is no order with them, again with those along faces, which
/// are many more. What is locked with these may leave in groups.
fn search_ways_out(
    assembly: &Assembly,
    test: &mut dyn StabilityTest,
    (hands, together): (usize, usize),
    mut paths: Paths<'_>,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let groups = limits.interrupt(start).run(|| {
        if paths.locked().is_empty() {
            return None;
        }
        paths.try_faces();
        (together > 1).then(|| paths.groups(together)).flatten().filter(|groups| !groups.is_empty())
    });
    match groups {
        None => return Ok(Plan::stopped(limits.stopped(start), start.elapsed())),
        Some(None) => {}
        Some(Some(groups)) => {
            return plan_in_groups(assembly, test, hands, paths, &groups, limits.after(start), monitor);
        }
    }
    let limits = limits.after(start);
    let first = search_under(assembly, test, hands, Some(&paths), limits, monitor)?;
    let blocked = !first.blocked.is_empty() && matches!(first.outcome, Outcome::NoOrder | Outcome::Undecided);
    if !blocked || !paths.try_faces() {
        return Ok(first);
    }
    let left = Limits {
        tests: limits.tests.map(|most| most.saturating_sub(first.records.len())),
        time: limits.time.map(|most| most.saturating_sub(first.total)),
        ..limits
    };
    let mut second = search_under(assembly, test, hands, Some(&paths), left, monitor)?;
    second.records.splice(..0, first.records);
    second.shortcuts += first.shortcuts;
    second.total += first.total;
    second.whole_time += first.whole_time;
    Ok(second)
}

fn search_under(
    assembly: &Assembly,
    test: &mut dyn StabilityTest,
    hands: usize,
    paths: Option<&Paths<'_>>,
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let whole_falls = AtomicBool::new(false);
    let mut clock = Clock::new(limits, monitor, &whole_falls);
    let touching = Touching::new(assembly);
    let locked = match paths.map(|paths| clock.run(|| Ok(paths.locked()))).transpose() {
        Err(PlanError::Interrupted) => return Ok(Plan::stopped(clock.stopped(), start.elapsed())),
        locked => locked?.filter(|locked| !locked.is_empty()),
    };
    let mut found = match &locked {
        Some(_) => check_alone(assembly, &clock, Outcome::Locked),
        None => search_unheld(assembly, &touching, paths, test, hands, &mut clock)?,
    };
    if found.outcome == Outcome::NoOrder && hands > 0 {
        search_with_hands(assembly, &touching, paths, hands, &mut clock, &mut found)?;
    }
    if found.is_undecided() {
        found.outcome = Outcome::Undecided;
    }
    let alone: Vec<Vec<usize>> = (0..assembly.blocks()).map(|block| vec![block]).collect();
    Ok(told(assembly, found, &alone, paths, locked, start.elapsed()))
}

/// Plans with groups of blocks that leave together.
fn plan_in_groups(
    assembly: &Assembly,
    test: &mut dyn StabilityTest,
    hands: usize,
    mut paths: Paths<'_>,
    groups: &[Vec<usize>],
    limits: Limits,
    monitor: &mut dyn Monitor,
) -> Result<Plan, PlanError> {
    let start = Instant::now();
    let whole_falls = AtomicBool::new(false);
    let mut clock = Clock::new(limits, monitor, &whole_falls);
    let units = units_of(groups, assembly.blocks());
    paths.join(&units);
    let mut found = search_units(assembly, &units, &paths, test, hands, &mut clock)?;
    if found.is_undecided() {
        found.outcome = Outcome::Undecided;
    }
    Ok(told(assembly, found, &units, Some(&paths), None, start.elapsed()))
}

/// A plan of what was found of units, told in bodies.
fn told(
    assembly: &Assembly,
    found: Found,
    units: &[Vec<usize>],
    paths: Option<&Paths<'_>>,
    locked: Option<BlockSet>,
    total: Duration,
) -> Plan {
    let (moves, blocked) = paths.map_or_else(Default::default, |paths| ways(paths, &found, locked));
    let bodies = |blocks: &[usize]| -> Vec<usize> { blocks.iter().map(|&b| assembly.body_index(b)).collect() };
    let of_units = |some: &[usize]| -> Vec<usize> { some.iter().flat_map(|&unit| bodies(&units[unit])).collect() };
    let reached = of_units(&found.reached);
    let each = |(moves, &unit): (Moves, &usize)| vec![moves; units[unit].len()];
    let together = found.reached.iter().filter(|&&unit| units[unit].len() > 1);
    Plan {
        outcome: found.outcome,
        order: if found.outcome == Outcome::Found { reached.iter().rev().copied().collect() } else { Vec::new() },
        groups: together.map(|&unit| bodies(&units[unit])).collect(),
        moves: moves.into_iter().zip(&found.reached).flat_map(each).collect(),
        reached,
        blocked,
        held: found.held.iter().map(|held| bodies(held)).collect(),
        falls_next: of_units(&found.falls_next),
        records: found.records,
        shortcuts: found.shortcuts,
        setup: Duration::ZERO,
        total,
        whole: found.whole,
        whole_time: found.whole_time,
    }
}

/// By which moves each unit reached leaves, and what is in the way of those that cannot come next.
fn ways(paths: &Paths<'_>, found: &Found, locked: Option<BlockSet>) -> (Vec<Moves>, Vec<Blocked>) {
    let units = paths.units();
    let mut there = BlockSet::empty(units);
    let mut moves = Vec::new();
    for &unit in &found.reached {
        moves.extend(paths.way_out(unit, &there));
        there.insert(unit);
    }
    let blocked = match (found.outcome, locked) {
        (Outcome::Locked, Some(locked)) => paths.blocked(locked.iter(), &locked),
        (Outcome::NoOrder | Outcome::Undecided, _) => {
            paths.blocked((0..units).filter(|&unit| !there.contains(unit)), &there)
        }
        _ => Vec::new(),
    };
    (moves, blocked)
}

/// The search with nothing held, and the check of the whole.
fn search_unheld(
    assembly: &Assembly,
    touching: &Touching,
    paths: Option<&Paths<'_>>,
    test: &mut dyn StabilityTest,
    hands: usize,
    clock: &mut Clock<'_>,
) -> Result<Found, PlanError> {
    let blocks = assembly.blocks();
    // The other search knows the assembly's own loads only.
    let turn = if test.anew().is_some() { usize::MAX } else { first_turn(blocks) };
    let mut search = InTurn::new(assembly, touching, paths, turn);
    let Checked { whole, time: whole_time, searched } = if check_beside(clock.limits, blocks) {
        check_beside_search(assembly, &mut search, test, clock)
    } else {
        check_before_search(assembly, &mut search, test, clock)
    };
    let InTurn { best: mut reached, mut records, mut shortcuts, .. } = search;
    let outcome = match (&whole, searched) {
        (Some(whole), _) if !whole.stable => Outcome::WholeFalls,
        (_, Err(PlanError::Interrupted)) => clock.stopped(),
        (_, ended) => ended?,
    };
    let falls_next = match outcome {
        Outcome::WholeFalls => {
            // Whatever a search beside the check has done was in vain.
            (reached, records, shortcuts) = (Vec::new(), Vec::new(), 0);
            Vec::new()
        }
        // With hands the search goes on from here.
        Outcome::NoOrder if hands == 0 => {
            let mut again = test.anew().unwrap_or_else(|| Box::new(Reuse::new(assembly)));
            until_stopped(clock.run(|| dead_end(again.as_mut(), touching, paths, &mut reached)))?
        }
        _ => Vec::new(),
    };
    let held = vec![Vec::new(); reached.len()];
    Ok(Found { outcome, reached, held, falls_next, records, shortcuts, whole, whole_time })
}
