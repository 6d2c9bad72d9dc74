//! From a scene to a plan: the check of the complete assembly, and the search.

use super::ahead::Ahead;
use super::dead_end::dead_end;
use super::learned::{Bounds, Learned};
use super::memory::Memory;
use super::outcome::{Limits, Monitor, Outcome, Plan};
use super::search::{Clock, Search};
use super::stability::{FromScratch, PlanError, Reuse, ReuseDantzig, StabilityTest, Test};
use super::touching::Touching;
use super::visited::Visited;
use super::whole::{Checked, check_before_search, check_beside, check_beside_search};
use crate::{
    formulate::{Assemble, Assembly},
    scene::SceneOf,
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
    let start = Instant::now();
    let mut plan = plan_assembly(&Assembly::new(scene)?, test, limits, monitor)?;
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
    let setup = Instant::now();
    let mut test: Box<dyn StabilityTest + '_> = match test {
        Test::Lcp => from_scratch(assembly, limits.threads()),
        Test::Reuse => Box::new(Reuse::new(assembly)),
        Test::ReuseDantzig => Box::new(ReuseDantzig::new(assembly)),
    };
    let setup = setup.elapsed();
    let mut plan = plan_with(assembly, test.as_mut(), limits, monitor)?;
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
    let start = Instant::now();
    let whole_falls = AtomicBool::new(false);
    let mut clock = Clock { limits, start, monitor, whole_falls: &whole_falls };
    let touching = Touching::new(assembly);
    let mut memory: Box<dyn Memory + '_> = match limits.shortcuts && test.explains() {
        true => Box::new(Learned::new(&touching, Bounds::default())),
        false => Box::new(Visited::default()),
    };
    let mut search = Search::new(&touching, memory.as_mut());
    let Checked { whole, time: whole_time, searched } = if check_beside(limits, assembly.blocks()) {
        check_beside_search(assembly, &mut search, test, &mut clock)
    } else {
        check_before_search(assembly, &mut search, test, &mut clock)
    };
    let Search { best: mut reached, mut records, .. } = search;
    let outcome = match (&whole, searched) {
        (Some(whole), _) if !whole.stable => Outcome::WholeFalls,
        (_, Err(PlanError::Interrupted)) => Outcome::Interrupted,
        (_, ended) => ended?,
    };
    let mut shortcuts = memory.shortcuts();
    let falls_next = match outcome {
        Outcome::WholeFalls => {
            // Whatever a search beside the check has done was in vain.
            (reached, records, shortcuts) = (Vec::new(), Vec::new(), 0);
            Vec::new()
        }
        Outcome::NoOrder => dead_end(assembly, &touching, &mut reached)?,
        _ => Vec::new(),
    };
    let bodies = |blocks: &[usize]| -> Vec<usize> { blocks.iter().map(|&b| assembly.body_index(b)).collect() };
    Ok(Plan {
        outcome,
        order: if outcome == Outcome::Found { bodies(&reached).into_iter().rev().collect() } else { Vec::new() },
        reached: bodies(&reached),
        falls_next: bodies(&falls_next),
        records,
        shortcuts,
        setup: Duration::ZERO,
        total: start.elapsed(),
        whole,
        whole_time,
    })
}
