//! Faces of which it is known which slides faster, whatever the motion, and what friction takes of them together.
//!
//! Stones in a course lie side by side: the one downhill cannot be slower, where both lie on the same ground. So the sliding speeds of
//! such faces, `u_1 >= u_2 >= ...`, are in an order in every solution, and where one slides all faster ones do. With `T_k` the least of
//! `N_1 + ... + N_k` over all solutions in which face k slides, friction takes
//!
//! ```text
//! sum N_k u_k = sum (N_1 + ... + N_k) (u_k - u_k+1) >= sum T_k (u_k - u_k+1) = sum (T_k - T_k-1) u_k          (1)
//! ```
//!
//! (Abel's summation). Each `N_k` alone may be nothing, under the arching of its neighbours; the course as a whole bears its weight.

use super::{
    branch::{Branch, Way},
    laws::{ALIKE, Laws},
};
use crate::contact::Contact;

/// Faces of one fixed body, or under one block, in one direction and with one coefficient, as (1) needs.
struct Row {
    body: usize,
    normal: [f64; 3],
    friction: f64,
    /// Each with its place along the tangent.
    faces: Vec<(f64, usize)>,
}

/// Faces that may be in an order, by their place along the tangent.
pub(super) fn rows_of_faces(laws: &Laws<'_>) -> Vec<Vec<usize>> {
    let contacts: Vec<&Contact> = laws.space.contacts().collect();
    let mut rows: Vec<Row> = Vec::new();
    for (index, face) in laws.faces.iter().enumerate() {
        let contact = contacts[face.points[0]];
        let (body, normal) = (body_of(laws, contact), contact.normal);
        let alike = |other: &[f64; 3]| other.iter().zip(normal).all(|(a, b)| (a - b).abs() <= ALIKE);
        let place = contact.point[1] * normal[0] - contact.point[0] * normal[1];
        match rows.iter_mut().find(|row| row.body == body && row.friction == face.friction && alike(&row.normal)) {
            Some(row) => row.faces.push((place, index)),
            None => rows.push(Row { body, normal, friction: face.friction, faces: vec![(place, index)] }),
        }
    }
    let sorted = |Row { mut faces, .. }: Row| {
        faces.sort_by(|a, b| a.0.total_cmp(&b.0));
        faces.into_iter().map(|(_, index)| index).collect()
    };
    rows.into_iter().map(sorted).collect()
}

/// Whose row a face is in: the fixed body's, else the upper block's.
fn body_of(laws: &Laws<'_>, contact: &Contact) -> usize {
    let assembly = laws.space.assembly();
    let [first, second] = contact.bodies;
    let rises = contact.normal.iter().zip(assembly.gravity()).map(|(n, g)| n * g).sum::<f64>() < 0.0;
    match (assembly.block_of(first), assembly.block_of(second)) {
        (None, _) => first,
        (_, None) => second,
        _ if rises => second,
        _ => first,
    }
}

/// The longest of some chains, so that each face is in one at most.
pub(super) fn disjoint(mut chains: Vec<Vec<usize>>, faces: usize) -> Vec<Vec<usize>> {
    let mut taken = vec![false; faces];
    chains.sort_by_key(|chain| std::cmp::Reverse(chain.len()));
    chains.retain(|chain| {
        let free = chain.len() > 1 && chain.iter().all(|&face| !taken[face]);
        chain.iter().filter(|_| free).for_each(|&face| taken[face] = true);
        free
    });
    chains
}

/// The faces of a chain (the slowest first along the tangent) as they slide one way, the fastest first.
pub(super) fn fastest_first(chain: &[usize], way: Way) -> Vec<usize> {
    if way == 0 { chain.iter().rev().copied().collect() } else { chain.to_vec() }
}

/// What friction takes at least of the sliding of each face each way, over its coefficient: the factors in (1), or what the face bears
/// alone.
pub(super) fn bearings(laws: &Laws<'_>, branch: &Branch) -> Vec<[f64; 2]> {
    let mut all = branch.least.clone();
    for (chain, sums) in laws.chains.iter().zip(&branch.sums) {
        for (way, sums) in sums.iter().enumerate() {
            let mut before = 0.0;
            for (face, sum) in fastest_first(chain, way).into_iter().zip(sums) {
                let sum = sum.max(before + branch.least[face][way]);
                all[face][way] = sum - before;
                before = sum;
            }
        }
    }
    all
}
