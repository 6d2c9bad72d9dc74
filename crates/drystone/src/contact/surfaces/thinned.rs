//! Few points of many: those that the others' wrenches are sums of, within a stated error.
//!
//! A point with its normal n, at q from the middle of all in units of their size, is left out if there are points that are kept within
//! [`NEAR`] of it and shares of these, one in sum, that make up both n and q within [`SHARE`]. Then so is its wrench (n, q x n),
//! and that of a force that leans from n: what is lost by taking products of shares is the spread of the points, below the square of
//! [`NEAR`].

use super::point::{Mixed, SurfacePoint};
use crate::{geometry::Vector3, interrupt::poll};
use std::{collections::HashSet, hash::BuildHasherDefault};

/// Points of a pair of bodies that are not thinned out.
const MANY: usize = 500;

/// Points that are looked at one by one: of more those in one cell are one first, the cells as large as it takes.
const MOST: usize = 20_000;

/// What a kept point and a point that is left out may differ by, in normal (radians) and place (of the size), to have a share in it.
const NEAR: f64 = 0.2;

/// What the shares may miss the normal and the place by.
const SHARE: f64 = 0.02;

/// Rounds of the search for shares.
const ROUNDS: usize = 200;

/// Kept points that are looked at for shares: the nearest.
const BESIDE: usize = 64;

/// A normal and a place.
type Lifted = [f64; 6];

/// The points that are kept, in their order.
pub(super) fn thinned(points: Vec<SurfacePoint>) -> Vec<SurfacePoint> {
    if points.len() <= MANY {
        return points;
    }
    let lifted = lift(&points);
    let chosen = apart(&lifted);
    let mut kept: Vec<usize> = Vec::new();
    for k in spread(chosen.len()) {
        let point = chosen[k];
        if !is_made_up(&lifted[point], kept.iter().map(|&other| &lifted[other])) {
            kept.push(point);
        }
    }
    kept.sort_unstable();
    kept.into_iter().map(|k| points[k]).collect()
}

fn lift(points: &[SurfacePoint]) -> Vec<Lifted> {
    let middle = points.iter().map(|p| p.point).sum::<Vector3>() / points.len() as f64;
    let size = points.iter().fold(f64::MIN_POSITIVE, |size, p| size.max(p.point.distance(middle)));
    let lift = |p: &SurfacePoint| {
        let at = (p.point - middle) / size;
        [p.normal.x, p.normal.y, p.normal.z, at.x, at.y, at.z]
    };
    points.iter().map(lift).collect()
}

/// One point of each cell, the cells as small as leaves no more than [`MOST`].
fn apart(lifted: &[Lifted]) -> Vec<usize> {
    let mut cell = 0.5 * SHARE;
    loop {
        let mut taken: HashSet<[i64; 6], BuildHasherDefault<Mixed>> = HashSet::default();
        let new = |&k: &usize| {
            poll(100);
            taken.insert(lifted[k].map(|x| (x / cell).round() as i64))
        };
        let found: Vec<usize> = (0..lifted.len()).filter(new).collect();
        if found.len() <= MOST {
            return found;
        }
        cell *= 2.0;
    }
}

/// The numbers below a count in an order that goes all over them from the start: multiples of a number near the golden section of
/// the count that shares no factor with it.
fn spread(count: usize) -> impl Iterator<Item = usize> {
    let shares_none = |step: &usize| {
        let (mut a, mut b) = (*step, count);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    let step = ((0.618 * count as f64) as usize + 1..).find(shares_none).unwrap_or(1);
    (0..count).map(move |k| k * step % count)
}

/// Whether shares of points near it make a point up: whether the point of the hull of the differences that is nearest to zero is
/// within [`SHARE`] of it (Frank and Wolfe's method with pairwise steps; S. Lacoste-Julien and M. Jaggi, 2015).
fn is_made_up<'a>(point: &Lifted, kept: impl Iterator<Item = &'a Lifted>) -> bool {
    let mut near: Vec<(f64, Lifted)> = kept
        .map(|other| [0, 1, 2, 3, 4, 5].map(|k| other[k] - point[k]))
        .map(|off| (product(&off, &off), off))
        .filter(|near| near.0 <= NEAR * NEAR)
        .collect();
    poll(8 * near.len());
    if near.len() > BESIDE {
        near.select_nth_unstable_by(BESIDE, |a, b| a.0.total_cmp(&b.0));
        near.truncate(BESIDE);
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(_, mut rest)) = near.first() else { return false };
    let mut shares = vec![0.0; near.len()];
    shares[0] = 1.0;
    for _ in 0..ROUNDS {
        poll(14 * near.len());
        let size = product(&rest, &rest).sqrt();
        if size <= SHARE {
            return true;
        }
        let along: Vec<f64> = near.iter().map(|(_, off)| product(&rest, off)).collect();
        let least = (0..near.len()).min_by(|&i, &j| along[i].total_cmp(&along[j])).unwrap_or(0);
        // All differences are that far from zero along the rest.
        if along[least] > SHARE * size {
            return false;
        }
        let with_share = (0..near.len()).filter(|&k| shares[k] > 0.0);
        let most = with_share.max_by(|&i, &j| along[i].total_cmp(&along[j])).unwrap_or(least);
        let way = [0, 1, 2, 3, 4, 5].map(|k| near[least].1[k] - near[most].1[k]);
        let square = product(&way, &way);
        if square == 0.0 {
            return false;
        }
        let step = (-product(&rest, &way) / square).clamp(0.0, shares[most]);
        shares[most] -= step;
        shares[least] += step;
        rest.iter_mut().zip(way).for_each(|(rest, way)| *rest += step * way);
    }
    false
}

fn product(a: &Lifted, b: &Lifted) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
