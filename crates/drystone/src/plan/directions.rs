//! Directions in which blocks may leave along a straight line.

use crate::formulate::Assembly;
use crate::geometry::{Piece, Sweeping, cross, dot, unit};

/// Two directions whose cosine is this close to one are the same: the angle is 1e-6.
const SAME: f64 = 1e-12;

/// At contacts of a surface of many triangles two directions whose cosine is this close to one are the same: the angle is 0.1. What
/// lies between them is looked for along faces.
const SAME_OF_MANY: f64 = 5e-3;

/// Faces whose normals are this near to parallel guide alike: the angle is 1e-4, far above the rounding of coordinates in
/// files, and too small to matter within a contact tolerance on the way of a block of common size.
const ALIKE: f64 = 5e-9;

/// Most normals that a block's ways along faces are made of. Of k of them come up to k (k + 1) directions.
const MOST_NORMALS: usize = 16;

/// For each block the directions to try: those given, against gravity, along the axes, along and across its contacts.
/// `fine` says which bodies have surfaces of many triangles.
pub(super) fn at_contacts(assembly: &Assembly, given: &[[f64; 3]], fine: impl Fn(usize) -> bool) -> Vec<Vec<[f64; 3]>> {
    let up = unit(assembly.gravity().map(|g| -g));
    let axes: &[[f64; 3]] = match assembly.in_plane() {
        true => &[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        false => &[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    };
    let both = |way: [f64; 3]| [way, way.map(|x| -x)];
    let of_all = given.iter().copied().chain(up).chain(axes.iter().copied().flat_map(both));
    let of_all = of_all.fold(Vec::new(), with_new);
    let mut directions = vec![of_all; assembly.blocks()];
    for generator in assembly.generators() {
        let contact = &assembly.contacts()[generator.contact()];
        let normal = contact.normal;
        let same = if contact.bodies.into_iter().any(&fine) { SAME_OF_MANY } else { SAME };
        let ways = across(assembly, normal).into_iter().chain([normal]).flat_map(both);
        for block in generator.blocks() {
            let list = std::mem::take(&mut directions[block]);
            directions[block] = ways.clone().fold(list, |list, way| with_new_by(same, list, way));
        }
    }
    directions
}

/// Unit vectors square to a contact's normal: in the plane one, in space one that is level and one that is steepest.
fn across(assembly: &Assembly, normal: [f64; 3]) -> Vec<[f64; 3]> {
    if assembly.in_plane() {
        return vec![[-normal[1], normal[0], 0.0]];
    }
    let level = unit(cross(normal, assembly.gravity())).or_else(|| unit(cross(normal, [1.0, 0.0, 0.0])));
    level.into_iter().flat_map(|level| [level, cross(normal, level)]).collect()
}

/// Directions without those that come again.
pub(super) fn merged<'a>(directions: impl Iterator<Item = &'a [f64; 3]>) -> Vec<[f64; 3]> {
    directions.copied().fold(Vec::new(), with_new)
}

fn with_new(list: Vec<[f64; 3]>, direction: [f64; 3]) -> Vec<[f64; 3]> {
    with_new_by(SAME, list, direction)
}

fn with_new_by(same: f64, mut list: Vec<[f64; 3]>, direction: [f64; 3]) -> Vec<[f64; 3]> {
    if !list.iter().any(|&known| dot(known, direction) > 1.0 - same) {
        list.push(direction);
    }
    list
}

/// Adds to a body's directions those along its faces and those of pieces near it: a body between faces glides along two of
/// them, square to both normals, whether it touches them or has clearance; it leaves a face along the normal.
///
/// Its own faces come first, then those of others, the largest before smaller ones, up to [`MOST_NORMALS`] that are not
/// parallel.
pub(super) fn along_faces(list: &mut Vec<[f64; 3]>, swept: &[Sweeping], body: usize, in_plane: bool) {
    let own = &swept[body];
    let others = swept.iter().enumerate().filter(|&(other, _)| other != body).flat_map(|(_, swept)| swept.pieces());
    let near = others.filter(|other| own.is_near(other));
    let mut normals = Vec::new();
    add_normals(&mut normals, own.pieces().iter());
    add_normals(&mut normals, near);
    let upright = [0.0, 0.0, 1.0];
    let across = |k: usize| {
        let others = if in_plane { vec![upright] } else { normals[..k].to_vec() };
        others.into_iter().filter_map(|other| unit(cross(other, normals[k]))).collect::<Vec<_>>()
    };
    let along: Vec<[f64; 3]> = (0..normals.len()).flat_map(across).collect();
    let ways = along.into_iter().chain(normals.iter().copied()).flat_map(|way| [way, way.map(|x| -x)]);
    *list = ways.fold(std::mem::take(list), with_new);
}

/// Adds the normals of faces that are not parallel to those there, the ones of the largest faces first.
fn add_normals<'a>(normals: &mut Vec<[f64; 3]>, pieces: impl Iterator<Item = &'a Piece>) {
    let mut faces: Vec<([f64; 3], f64)> = pieces.flat_map(Piece::faces).collect();
    faces.sort_by(|a, b| b.1.total_cmp(&a.1)); // stable: equal ones stay in the order of the scene
    for (normal, _) in faces {
        if normals.len() == MOST_NORMALS {
            return;
        }
        if !normals.iter().any(|&known| dot(known, normal).abs() > 1.0 - ALIKE) {
            normals.push(normal);
        }
    }
}
