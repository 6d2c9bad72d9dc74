//! Random planning scenes in the manner of the paper's Fig. 7.

mod placed;
mod standing;

use super::builder::Builder;
use super::entry::{SceneEntry, friction, integer, seed};
use crate::error::SceneError;
use crate::interrupt::poll;
use crate::scene::Scene;
use placed::{Placed, Rule, STEPS, lay_ground, scene_of};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use standing::Standing;

/// Widths are drawn evenly between these, heights are one of two, in steps.
const WIDTHS: std::ops::RangeInclusive<i64> = 512..=2560;
const HEIGHTS: [i64; 2] = [512, 1024];

/// A block's centre of mass is at least this far within its supports, in steps (1/32 m): no block
/// stands or falls by rounding alone.
const MARGIN: i64 = 32;

/// Places looked at for every block drawn; the lowest of the wanted kind is taken.
const PLACES: usize = 8;

/// Blocks drawn in search of one that needs a counterweight, before any that stands will do.
const SEARCH: usize = 8;

/// Blocks drawn for one place in the stack before giving up.
const ATTEMPTS: usize = 500;

pub(super) const ENTRY: SceneEntry = SceneEntry {
    name: "random_stack",
    summary: "blocks of mixed sizes with overhangs and counterweights: the order matters",
    parameters: &[
        integer("blocks", 84, [1, 1000], "movable blocks"),
        seed(1, "start of the pseudo-random sequence"),
        friction(0.0),
    ],
    make: |g| random_stack(g.size(0), g.integer(1), g.number(2)).map(Into::into),
};

/// A stack of `blocks` axis-aligned blocks on a fixed ground, the same for the same `seed`.
///
/// Blocks are dropped one by one; one is kept only where the stack then stands without friction
/// (whatever `friction` the scene gets). So at least one stable order exists, but the numbers do
/// not tell it: they go up level by level, whereas some overhanging block bears its load only once
/// its counterweight lies.
pub fn random_stack(blocks: usize, seed: u64, friction: f64) -> Result<Scene, SceneError> {
    ENTRY.check(&[blocks as f64, seed as f64, friction])?;
    drop_blocks(blocks, seed, friction, &mut Standing::on(ground_width(blocks)))
}

/// The same with another rule: `accept` sees the frictionless stack with the new block on it (the
/// blocks numbered as they were dropped) and says whether to keep it.
pub fn random_stack_where(
    blocks: usize,
    seed: u64,
    friction: f64,
    accept: impl FnMut(&Scene) -> bool,
) -> Result<Scene, SceneError> {
    ENTRY.check(&[blocks as f64, seed as f64, friction])?;
    drop_blocks(blocks, seed, friction, &mut Accepting { ground: ground_width(blocks), accept })
}

fn drop_blocks(blocks: usize, seed: u64, friction: f64, rule: &mut dyn Rule) -> Result<Scene, SceneError> {
    let mut random = Pcg64::seed_from_u64(seed);
    let ground = ground_width(blocks);
    let mut skyline = Skyline::level(ground);
    let mut placed: Vec<Placed> = Vec::with_capacity(blocks);
    while placed.len() < blocks {
        let seek_counterweighted = random.random_range(0..2) == 0;
        let found = find_place(&mut random, &skyline, ground, &placed, seek_counterweighted, rule)?;
        let Some(block) = found else { return Err(gave_up(placed.len(), blocks)) };
        skyline.raise(&block);
        placed.push(block);
    }
    // Level by level, each from the left.
    placed.sort_by_key(|block| (block.bottom, block.left));
    let mut builder = Builder::new(friction)?;
    lay_ground(&mut builder, ground)?;
    placed.iter().try_for_each(|block| block.add_to(&mut builder))?;
    Ok(builder.finish())
}

/// Draws blocks until one stays.
fn find_place(
    random: &mut Pcg64,
    skyline: &Skyline,
    ground: i64,
    placed: &[Placed],
    seek_counterweighted: bool,
    rule: &mut dyn Rule,
) -> Result<Option<Placed>, SceneError> {
    for attempt in 0..ATTEMPTS {
        poll(PLACES * skyline.0.len());
        let Some(block) = draw(random, skyline, ground) else { continue };
        let must_lean = seek_counterweighted && attempt < SEARCH;
        if rule.stands(placed, &block)? && !(must_lean && rule.stands_on_lower(placed, &block)?) {
            rule.keep();
            return Ok(Some(block));
        }
    }
    Ok(None)
}

/// A rule from outside, which sees every stack as a scene.
struct Accepting<F> {
    ground: i64,
    accept: F,
}

impl<F: FnMut(&Scene) -> bool> Rule for Accepting<F> {
    fn stands(&mut self, placed: &[Placed], block: &Placed) -> Result<bool, SceneError> {
        Ok((self.accept)(&scene_of(self.ground, placed.iter().chain([block]))?))
    }

    fn stands_on_lower(&mut self, placed: &[Placed], block: &Placed) -> Result<bool, SceneError> {
        let lower = placed.iter().filter(|other| other.is_lower_than(block));
        Ok((self.accept)(&scene_of(self.ground, lower.chain([block]))?))
    }
}

/// Draws a block and the place it is dropped at: half the time one that overhangs, if there is
/// such a place, and of these the lowest. None if it would tip over wherever it was tried.
fn draw(random: &mut Pcg64, skyline: &Skyline, ground: i64) -> Option<Placed> {
    let width = random.random_range(WIDTHS);
    let height = HEIGHTS[random.random_range(0..HEIGHTS.len())];
    let want_overhang = random.random_range(0..2) == 0;
    let mut best: Option<(bool, Placed)> = None;
    for _ in 0..PLACES {
        let left = random.random_range(-width / 2..=ground - width / 2);
        let (bottom, [from, to]) = skyline.rest(left, left + width);
        let middle = left + width / 2;
        if middle < from + MARGIN || middle > to - MARGIN {
            continue;
        }
        let wanted = (4 * (to - from) < 3 * width) == want_overhang;
        let better = |(had, old): (bool, Placed)| (wanted, -bottom) > (had, -old.bottom);
        if best.is_none_or(better) {
            best = Some((wanted, Placed { left, bottom, width, height }));
        }
    }
    best.map(|(_, block)| block)
}

/// The upper outline of the stack: pieces (left, right, top) from left to right, in steps.
struct Skyline(Vec<[i64; 3]>);

impl Skyline {
    fn level(width: i64) -> Self {
        Self(vec![[0, width, 0]])
    }

    /// Where a block from `left` to `right` comes to rest: its height, and the first and last
    /// place where something bears it. Beside the ground there is nothing to rest on.
    fn rest(&self, left: i64, right: i64) -> (i64, [i64; 2]) {
        let below = || self.0.iter().filter(|[l, r, _]| *l < right && *r > left);
        let bottom = below().map(|[_, _, top]| *top).max().unwrap_or(0);
        let mut bearing = [right, left];
        for [l, r, _] in below().filter(|[_, _, top]| *top == bottom) {
            bearing = [bearing[0].min(*l).max(left), bearing[1].max(*r).min(right)];
        }
        (bottom, bearing)
    }

    /// Lays a block on top. What lies under an overhang is closed off for good.
    fn raise(&mut self, block: &Placed) {
        let (left, right) = (block.left, block.left + block.width);
        let mut pieces = vec![[left, right, block.bottom + block.height]];
        for &[l, r, top] in &self.0 {
            pieces.extend([[l, r.min(left), top], [l.max(right), r, top]].iter().filter(|p| p[0] < p[1]));
        }
        pieces.sort_unstable();
        self.0 = pieces;
    }
}

/// Makes a stack about four fifths as high as wide: blocks cover 1.125 m^2 on average.
fn ground_width(blocks: usize) -> i64 {
    let metres = (1.25 * (1.125 * blocks as f64).sqrt()).max(3.0);
    (metres * STEPS) as i64
}

fn gave_up(placed: usize, blocks: usize) -> SceneError {
    SceneError::NotGenerated {
        scene: ENTRY.name.to_owned(),
        reason: format!(
            "no place was found for block {} of {blocks} in {ATTEMPTS} attempts: take another seed",
            placed + 1
        ),
    }
}
