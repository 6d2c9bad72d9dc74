//! Does a structure stand under each of many load cases: sums of a few loads, each times a factor?
//!
//! The loads under which it stands are a convex cone, and what proves a case proves others. Forces well inside the friction cones
//! at one case follow the factors linearly ([`Nearby`]), and hold all cases for which they stay inside. A mechanism brings down
//! all cases in which the loads do work in it, which is linear in the factors too. Only a case that neither tells is looked at by
//! itself, and adds one or the other.

use super::{
    centre::{Centre, Centres},
    fall::Fall,
    interior::end,
};
use crate::{
    check::check_blocks_while,
    formulate::{Assembly, BlockSet, Constrained, FrictionCone, Push},
    interrupt::poll,
    proof::proved,
    threads::at_once,
};
use drystone_lcp::{Status, interior::End};
use std::sync::Arc;

/// The answers.
#[derive(Debug, Clone)]
pub struct Cases {
    /// Of each case; None where neither is proved.
    pub stands: Vec<Option<bool>>,
    /// Cases that took a computation of their own.
    pub solved: usize,
}

/// A limit as near as this to a case does not say on which side it is.
const NEAR: f64 = 1e-6;

/// From this share of the way on a case is taken for one that stands, and forces are looked for; else a mechanism.
const LIKELY: f64 = 0.5;

/// Operations to look at a case, about.
const CASE: usize = 10_000;

/// For factors of the loads, case by case, beside the assembly's own loads. May be stopped, like any work of the caller's.
pub fn cases(
    assembly: &Assembly,
    blocks: &BlockSet,
    loads: &[Push],
    factors: &[Vec<f64>],
    cone: FrictionCone,
) -> Cases {
    let asked = Asked { assembly, blocks, loads, cone };
    let mut answering = Answering {
        asked,
        centres: Centres::new(assembly, blocks, loads, cone),
        falls: Vec::new(),
        stands: vec![None; factors.len()],
        solved: 0,
    };
    let none = vec![0.0; loads.len()];
    let own = asked.look(&none, None);
    answering.learn(&none, own);
    // Two of those that are not known yet are looked at together, on two threads if there are.
    let mut waiting = None;
    for (k, case) in factors.iter().enumerate() {
        poll(CASE);
        answering.stands[k] = answering.known(case);
        if answering.stands[k].is_some() {
            continue;
        }
        match waiting.take() {
            None => waiting = Some(k),
            Some(other) => answering.solve(&[other, k], factors),
        }
    }
    answering.solve(&Vec::from_iter(waiting), factors);
    Cases { stands: answering.stands, solved: answering.solved }
}

/// The question.
#[derive(Clone, Copy)]
struct Asked<'a> {
    assembly: &'a Assembly,
    blocks: &'a BlockSet,
    loads: &'a [Push],
    cone: FrictionCone,
}

/// What a computation tells of a case.
struct Told {
    stands: Option<bool>,
    /// Forces that hold it, as unknowns of the problem.
    forces: Option<Vec<f64>>,
    fall: Option<Fall>,
}

struct Answering<'a> {
    asked: Asked<'a>,
    /// None where the interior point method has no memory.
    centres: Option<Centres<'a>>,
    falls: Vec<Fall>,
    stands: Vec<Option<bool>>,
    solved: usize,
}

impl Answering<'_> {
    /// What the others tell of a case.
    fn known(&self, case: &[f64]) -> Option<bool> {
        if self.falls.iter().any(|fall| fall.brings_down(case)) {
            return Some(false);
        }
        self.centres.as_ref().is_some_and(|centres| centres.hold(case)).then_some(true)
    }

    /// Answers up to two cases.
    fn solve(&mut self, some: &[usize], factors: &[Vec<f64>]) {
        let (asked, centres) = (self.asked, &self.centres);
        let look =
            |k: usize| asked.look(&factors[k], centres.as_ref().and_then(|centres| centres.nearest(&factors[k])));
        let told = at_once(some.iter().copied(), look);
        for (&k, told) in some.iter().zip(told) {
            self.solved += 1;
            self.stands[k] = told.stands;
            self.learn(&factors[k], told);
        }
    }

    fn learn(&mut self, case: &[f64], told: Told) {
        self.falls.extend(told.fall);
        if let (Some(centres), Some(forces)) = (&mut self.centres, told.forces) {
            centres.keep(&self.asked.under(case), case.to_vec(), forces);
        }
    }
}

impl Asked<'_> {
    /// The assembly under the loads of a case.
    fn under(&self, case: &[f64]) -> Assembly {
        self.assembly.pushed(&Push::sum(self.assembly, self.loads, case), 1.0)
    }

    /// Looks at a case by itself, and from the centre that is nearest to it.
    fn look(&self, case: &[f64], nearest: Option<(f64, Arc<Centre>)>) -> Told {
        let by_limit = || nearest.as_ref().and_then(|(_, from)| self.towards(from, case));
        let likely = nearest.as_ref().is_none_or(|(share, _)| *share >= LIKELY);
        let told = match likely {
            true => self.by_interior_point(case).or_else(by_limit),
            false => by_limit().or_else(|| self.by_interior_point(case)),
        };
        let Some(told) = told else { return self.by_check(case) };
        let unexplained = told.stands == Some(false) && told.fall.is_none();
        let fall = if unexplained { by_limit().and_then(|told| told.fall) } else { told.fall };
        Told { fall, ..told }
    }

    /// By the limit on the way from a case under which it stands. None if that is too near to tell.
    fn towards(&self, from: &Centre, case: &[f64]) -> Option<Told> {
        let there = self.under(from.case());
        let way: Vec<f64> = case.iter().zip(from.case()).map(|(to, from)| to - from).collect();
        let way = Push::sum(self.assembly, self.loads, &way);
        let end = end(&there, self.blocks, &way, self.cone, 1.0, &mut 0).ok()?;
        let fall = Fall::new(self.assembly, &there, self.loads, &end)?;
        // What lies between two cases in which it stands stands as well.
        let stands = end.factor > 1.0 + NEAR;
        let falls = end.factor < 1.0 - NEAR && fall.brings_down(case);
        (stands || falls).then_some(Told { stands: Some(stands), forces: None, fall: Some(fall) })
    }

    /// By forces or a motion that the interior point method finds; None where it finds neither, as near a limit.
    fn by_interior_point(&self, case: &[f64]) -> Option<Told> {
        let under = self.under(case);
        let Constrained { motion, forces, found } = under.body_space(self.blocks, self.cone).solve();
        let sure = found.end == End::AtRest || under.is_round(self.cone);
        let proof = proved(&under, self.blocks, &motion, &forces, self.cone, sure);
        let forces = proof.stands.then_some(found.forces);
        (proof.stands || proof.falls()).then_some(Told { stands: Some(proof.stands), forces, fall: None })
    }

    /// By a verdict of its own, whatever it takes.
    fn by_check(&self, case: &[f64]) -> Told {
        let under = self.under(case);
        let found = check_blocks_while(&under, self.blocks, self.cone, &mut |_| true).expect("nobody stops it");
        let stands = (found.status == Status::Solved).then_some(found.stable);
        Told { stands, forces: None, fall: None }
    }
}
