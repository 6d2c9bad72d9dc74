//! Bodies within surfaces: measures in closed form, contacts counted by hand, what is no closed surface.

use drystone::{
    BodyOptions, Feature, SceneError, SceneInSpace,
    contact::{find_solid_contacts, find_solid_overlaps},
    geometry::{PoseInSpace, Shape, Solid, SolidFault},
};

const SIDES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

type Mesh = (Vec<[f64; 3]>, Vec<[u32; 3]>);

fn cuboid(size: [f64; 3], at: [f64; 3]) -> Mesh {
    let corner = |k: usize| [0, 1, 2].map(|i| at[i] + size[i] * ((k >> i & 1) as f64 - 0.5));
    let triangles = SIDES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

fn added(scene: &mut SceneInSpace, (vertices, triangles): &Mesh, name: &str, fixed: bool) -> Result<usize, SceneError> {
    let options = BodyOptions { name: Some(name.into()), fixed, ..BodyOptions::default() };
    scene.add_surface(vertices, triangles, PoseInSpace::WORLD, options)
}

fn scene(meshes: &[Mesh]) -> SceneInSpace {
    let mut scene = SceneInSpace::new([0.0, 0.0, -9.81], 0.5).unwrap();
    for (k, mesh) in meshes.iter().enumerate() {
        added(&mut scene, mesh, &k.to_string(), k == 0).unwrap();
    }
    scene
}

#[test]
fn a_cuboid_within_a_surface_has_the_measures_of_one() {
    let (vertices, triangles) = cuboid([1.0, 2.0, 3.0], [5.0, 6.0, 7.0]);
    let (solid, centroid) = Solid::from_surface(&vertices, &triangles).unwrap();
    let same = Solid::cuboid([1.0, 2.0, 3.0]);
    assert!((solid.measure() - same.measure()).abs() < 1e-12);
    assert!(solid.moments().iter().zip(same.moments()).all(|(a, b)| (a - b).abs() < 1e-12));
    assert!(centroid.iter().zip([5.0, 6.0, 7.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    assert!((solid.width() - 1.0).abs() < 1e-12);
    assert_eq!(solid.surface().unwrap().flat_faces().count(), 6);
}

#[test]
fn what_is_no_closed_surface_is_refused() {
    let (vertices, triangles) = cuboid([1.0; 3], [0.0; 3]);
    let fault = |triangles: &[[u32; 3]]| Solid::from_surface(&vertices, triangles).unwrap_err();
    assert!(matches!(fault(&triangles[1..]), SolidFault::Open { .. }));
    assert_eq!(fault(&[]), SolidFault::NoTriangles);
    let reversed: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert_eq!(fault(&reversed), SolidFault::InsideOut);
    let mut beyond = triangles.clone();
    beyond[3] = [0, 1, 99];
    assert_eq!(fault(&beyond), SolidFault::NotATriangle { triangle: 3 });
    // A cuboid and another, turned over the same vertices, have no volume together.
    let both: Vec<[u32; 3]> = triangles.iter().chain(&reversed).copied().collect();
    assert_eq!(fault(&both), SolidFault::ZeroVolume);
    let mut far = vertices.clone();
    far[2][1] = f64::NAN;
    assert_eq!(Solid::from_surface(&far, &triangles).unwrap_err(), SolidFault::NotFinite { vertex: 2 });
}

/// Two boxes whose surfaces cross weigh what both enclose twice.
#[test]
fn a_surface_through_itself_is_refused() {
    let (mut vertices, mut triangles) = cuboid([1.0; 3], [0.0; 3]);
    let (more, others) = cuboid([1.0; 3], [0.5, 0.3, 0.2]);
    triangles.extend(others.iter().map(|triangle| triangle.map(|k| k + 8)));
    vertices.extend(more);
    assert!(matches!(Solid::from_surface(&vertices, &triangles), Err(SolidFault::ThroughItself { .. })));
}

#[test]
fn a_box_on_a_box_has_four_named_corners() {
    let scene = scene(&[cuboid([4.0, 4.0, 1.0], [0.0; 3]), cuboid([1.0; 3], [0.3, 0.0, 1.0])]);
    let found = find_solid_contacts(&scene).unwrap();
    assert_eq!(found.contacts.len(), 4);
    for contact in &found.contacts {
        assert!(matches!(contact.id.feature, Feature::Surfaces { pieces: [0, 0], .. }));
        assert!((contact.normal[2] - 1.0).abs() < 1e-12 && contact.gap.abs() < 1e-12);
    }
    let mut names: Vec<_> = found.contacts.iter().map(|contact| contact.id).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 4);
}

/// Boxes that share an edge only, across the floor's diagonal.
#[test]
fn an_edge_beside_an_edge_bears_nothing_and_is_listed() {
    let scene = scene(&[cuboid([1.0; 3], [0.0; 3]), cuboid([1.0; 3], [1.0, 0.0, 1.0])]);
    let found = find_solid_contacts(&scene).unwrap();
    assert!(found.contacts.is_empty());
    assert_eq!(found.corner_touches, [[0, 1]]);
}

#[test]
fn the_same_box_twice_overlaps() {
    let scene = scene(&[cuboid([1.0; 3], [0.0; 3]), cuboid([1.0; 3], [0.0; 3])]);
    assert_eq!(find_solid_overlaps(&scene).len(), 1);
}
