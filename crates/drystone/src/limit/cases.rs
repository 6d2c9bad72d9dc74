//! Does a structure stand under each of many load cases: sums of a few loads, each times a factor?
//!
//! The loads under which it stands are a convex cone, and what proves a case proves others. Forces well inside the friction cones
//! at one case follow the factors linearly ([`Barrier::changes`]), and hold all cases for which they stay inside. A mechanism brings down
//! all cases in which the loads do work in it, which is linear in the factors too. Only a case that neither tells is looked at by
//! itself, and adds one or the other: forces follow the loads towards it until they hold it, or a mechanism stops them ([`Barrier::walk`]).

use super::{
    centre::{Centre, Centres},
    fall::Fall,
    interior::{Known, Side},
};
use crate::{
    check::check_blocks_while,
    formulate::{Assembly, BlockSet, Constrained, FrictionCone, Push},
    geometry::length,
    interrupt::poll,
    judgement::CLOSING,
    proof::{closing, proved},
    threads::at_once,
};
#[cfg(doc)]
use drystone_lcp::interior::Barrier;
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
    let open = factors.iter().enumerate().map(|(index, case)| Open { index, case, nearest: None });
    let mut answering = Answering {
        asked,
        centres: Centres::new(assembly, blocks, loads, cone),
        open: open.collect(),
        stands: vec![None; factors.len()],
        solved: 0,
    };
    let none = vec![0.0; loads.len()];
    let own = asked.look(&none, None);
    answering.learn(&none, own);
    while !answering.open.is_empty() {
        poll(CASE * answering.open.len());
        answering.solve();
    }
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

/// A case of which nothing is known yet.
struct Open<'a> {
    index: usize,
    case: &'a [f64],
    /// The centre whose forces, changed, hold the largest share of the way to it.
    nearest: Option<(f64, Arc<Centre>)>,
}

impl Open<'_> {
    fn share(&self) -> f64 {
        self.nearest.as_ref().map_or(0.0, |(share, _)| *share)
    }
}

struct Answering<'a> {
    asked: Asked<'a>,
    /// None where the interior point method has no memory.
    centres: Option<Centres<'a>>,
    open: Vec<Open<'a>>,
    stands: Vec<Option<bool>>,
    solved: usize,
}

impl Answering<'_> {
    /// Answers the two cases that are nearest to what is known to stand, on two threads if there are: of these most take little,
    /// and those further away are often told by them.
    fn solve(&mut self) {
        let mut some = Vec::new();
        for _ in 0..self.open.len().min(2) {
            let next =
                (0..self.open.len()).rev().max_by(|&a, &b| self.open[a].share().total_cmp(&self.open[b].share()));
            some.push(self.open.remove(next.expect("there is one")));
        }
        let (asked, centres) = (self.asked, &self.centres);
        let look = |open: &Open<'_>| match (centres, &open.nearest) {
            (Some(centres), Some((_, from))) => asked.by_walk(centres, from, open.case),
            _ => None,
        };
        let told = at_once(&some, |open| look(open).unwrap_or_else(|| asked.look(open.case, open.nearest.as_ref())));
        for (open, told) in some.iter().zip(told) {
            self.solved += 1;
            self.stands[open.index] = told.stands;
            self.learn(open.case, told);
        }
    }

    /// What a case tells of those that are open.
    fn learn(&mut self, case: &[f64], told: Told) {
        let stands = &mut self.stands;
        if let Some(fall) = told.fall {
            self.open.retain(|open| {
                let falls = fall.brings_down(open.case);
                stands[open.index] = falls.then_some(false);
                !falls
            });
        }
        let (Some(centres), Some(forces)) = (&mut self.centres, told.forces) else { return };
        let Some(centre) = centres.keep(&self.asked.under(case), case.to_vec(), forces) else { return };
        self.open.retain_mut(|open| {
            let share = centre.share(open.case, open.share());
            if open.nearest.is_none() || share > open.share() {
                open.nearest = Some((share, Arc::clone(&centre)));
            }
            let holds = centres.hold(&centre, open.case, share);
            stands[open.index] = holds.then_some(true);
            !holds
        });
    }
}

impl Asked<'_> {
    /// The assembly under the loads of a case.
    fn under(&self, case: &[f64]) -> Assembly {
        self.assembly.pushed(&Push::sum(self.assembly, self.loads, case), 1.0)
    }

    /// By forces that follow the loads from a case under which it stands, or a mechanism that stops them on the way. None where
    /// that leads nowhere, or ends too near to tell.
    fn by_walk(&self, centres: &Centres<'_>, from: &Centre, case: &[f64]) -> Option<Told> {
        let (space, walked) = (centres.space(), centres.walk(from, case)?);
        let (motion, forces) = (space.motion(&walked.motion), space.forces(&walked.forces));
        if walked.share == 1.0 {
            let under = self.under(case);
            let proof = proved(&under, self.blocks, &[], &forces, self.cone, true);
            let stands = proof.stands && centres.inside(&walked.forces);
            return stands.then_some(Told { stands: Some(true), forces: Some(walked.forces), fall: None });
        }
        let closing = closing(self.assembly, &motion, &forces, self.cone);
        let there: Vec<f64> =
            case.iter().zip(from.case()).map(|(to, from)| from + walked.share * (to - from)).collect();
        let size = forces.iter().map(|force| length(force.force)).sum();
        let fall = Fall::new(self.assembly, &self.under(&there), self.loads, &motion, closing, size);
        let falls = closing <= CLOSING && walked.bound < 1.0 - NEAR && fall.brings_down(case);
        falls.then_some(Told { stands: Some(false), forces: None, fall: Some(fall) })
    }

    /// Looks at a case by itself, and from the centre that is nearest to it.
    fn look(&self, case: &[f64], nearest: Option<&(f64, Arc<Centre>)>) -> Told {
        let by_limit = || nearest.and_then(|(_, from)| self.towards(from, case));
        let likely = nearest.is_none_or(|(share, _)| *share >= LIKELY);
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
        let (blocks, cone, known) = (self.blocks, self.cone, Known::well());
        let end = Side { assembly: &there, blocks, push: &way, cone, sign: 1.0, known }.end(&mut 0).ok()?;
        let fall = Fall::of_end(self.assembly, &there, self.loads, &end)?;
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
