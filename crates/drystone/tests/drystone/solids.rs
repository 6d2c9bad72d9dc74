//! Solids: measures known in closed form, contacts counted by hand, verdicts with an analytic limit.

use drystone::{
    BodyOptions, SceneError, SceneInSpace, check,
    contact::find_solid_contacts,
    formulate::{Assembly, BlockSet, Bound, Cones},
    geometry::{Polyhedron, PoseInSpace, Shape, Solid, SolidFault, Vector3},
    scenes,
};

const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

fn at(position: [f64; 3]) -> PoseInSpace {
    PoseInSpace { position, ..PoseInSpace::WORLD }
}

fn fixed(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), fixed: true, ..BodyOptions::default() }
}

fn scene(friction: f64) -> SceneInSpace {
    SceneInSpace::new(GRAVITY, friction).unwrap()
}

/// Turned by an angle about an axis of length one.
fn turned(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let (sin, cos) = (0.5 * angle).sin_cos();
    [cos, sin * axis[0], sin * axis[1], sin * axis[2]]
}

#[test]
fn a_cuboid_has_the_measures_of_a_cuboid() {
    let solid = Solid::cuboid([1.0, 2.0, 3.0]);
    let expected = [4.0 + 9.0, 1.0 + 9.0, 1.0 + 4.0].map(|squares: f64| 6.0 * squares / 12.0);
    assert!((solid.measure() - 6.0).abs() < 1e-14);
    assert!(solid.moments().iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-13));
    assert_eq!(solid.width(), 1.0);
    assert!((solid.radius() - 0.5 * 14.0_f64.sqrt()).abs() < 1e-15);
}

/// A corner of a cube with legs a, b, c has volume abc / 6, its centroid at a quarter of each leg, and
/// `int x^2 dV = a^2 V / 10` about the corner.
#[test]
fn a_corner_tetrahedron_has_the_measures_of_one() {
    let legs = [1.0, 2.0, 3.0];
    let corner = |k: usize| [0, 1, 2].map(|axis| if axis + 1 == k { legs[axis] } else { 0.0 });
    let (solid, centroid) = Solid::from_pieces(&[(0..4).map(corner).collect()]).unwrap();
    assert!((solid.measure() - 1.0).abs() < 1e-14);
    assert!(centroid.iter().zip(legs).all(|(found, leg)| (found - 0.25 * leg).abs() < 1e-15));
    let about_centroid = legs.map(|leg| leg * leg * (0.1 - 1.0 / 16.0));
    let trace: f64 = solid.moments().iter().sum();
    assert!((trace - 2.0 * about_centroid.iter().sum::<f64>()).abs() < 1e-13);
    let axes = solid.axes();
    assert!((axes[0].cross(axes[1]).dot(axes[2]).abs() - 1.0).abs() < 1e-14);
}

#[test]
fn the_hull_of_points_in_and_on_a_cube_is_the_cube() {
    let mut points = Polyhedron::cuboid([2.0; 3]).vertices().to_vec();
    points.push(Vector3::new(0.1, 0.2, 0.3));
    points.push(Vector3::new(1.0, 0.2, 0.3)); // within a face
    points.push(Vector3::new(1.0, 1.0, 0.3)); // within an edge
    let hull = Polyhedron::hull(&points).unwrap();
    assert_eq!((hull.vertices().len(), hull.faces().len(), hull.edges().len()), (8, 6, 12));
    assert_eq!(hull, Polyhedron::cuboid([2.0; 3]));
}

#[test]
fn what_is_no_solid_is_refused() {
    let flat = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(Solid::from_pieces(&[flat]).unwrap_err(), SolidFault::ZeroVolume);
    let three = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(Solid::from_pieces(&[three]).unwrap_err(), SolidFault::TooFewVertices { count: 3 });
    assert_eq!(Solid::from_pieces(&[]).unwrap_err(), SolidFault::NoPieces);
    let cube = Polyhedron::cuboid([1.0; 3]).vertices().iter().map(|v| v.to_array()).collect::<Vec<_>>();
    let other = cube.iter().map(|[x, y, z]| [x + 0.9, *y, *z]).collect::<Vec<_>>();
    let refused = scene(0.5).add_solid(&[cube, other], PoseInSpace::WORLD, BodyOptions::default());
    let Err(SceneError::BadSolid { fault: SolidFault::PiecesOverlap { depth, .. }, .. }) = refused else { panic!() };
    assert!((depth - 0.1).abs() < 1e-12);
}

/// Two cubes, the upper one shifted and turned: the shared polygon of two squares turned by 45 degrees is an octagon.
#[test]
fn a_face_on_a_face_shares_the_whole_polygon() {
    for (angle, shift, corners) in [(0.0, 0.0, 4), (0.0, 0.3, 4), (std::f64::consts::FRAC_PI_4, 0.0, 8)] {
        let mut scene = scene(0.5);
        scene.add_cuboid(at([0.0; 3]), [1.0; 3], fixed("below")).unwrap();
        let pose = PoseInSpace { position: [shift, 0.0, 1.0], orientation: turned([0.0, 0.0, 1.0], angle) };
        scene.add_cuboid(pose, [1.0; 3], BodyOptions::default()).unwrap();
        let set = find_solid_contacts(&scene).unwrap();
        assert_eq!(set.contacts.len(), corners, "{angle} {shift}: {set:?}");
        assert!(set.contacts.iter().all(|c| c.normal == [0.0, 0.0, 1.0] && c.gap.abs() < 1e-15));
        assert!(check(&scene, None).unwrap().stable);
    }
}

#[test]
fn corners_edges_and_crossing_edges_touch() {
    let down = 0.5 * 2.0_f64.sqrt();
    // On an edge: two points; on an edge across an edge: one; an edge along an edge: two.
    let on_edge = turned([0.0, 1.0, 0.0], std::f64::consts::FRAC_PI_4);
    let mut scene = scene(0.5);
    scene.add_cuboid(at([0.0, 0.0, -0.5]), [4.0, 4.0, 1.0], fixed("ground")).unwrap();
    let options = BodyOptions { name: Some("roof".into()), ..BodyOptions::default() };
    scene.add_cuboid(PoseInSpace { position: [0.0, 0.0, down], orientation: on_edge }, [1.0; 3], options).unwrap();
    assert_eq!(find_solid_contacts(&scene).unwrap().contacts.len(), 2);

    let across = turned([1.0, 0.0, 0.0], std::f64::consts::FRAC_PI_4);
    let pose = PoseInSpace { position: [0.0, 0.0, 3.0 * down], orientation: across };
    scene.add_cuboid(pose, [1.0; 3], BodyOptions::default()).unwrap();
    let set = find_solid_contacts(&scene).unwrap();
    assert_eq!(set.contacts.len(), 3);
    let last = set.contacts.last().unwrap();
    assert!((last.point[2] - 2.0 * down).abs() < 1e-14 && (last.normal[2] - 1.0).abs() < 1e-14);

    let mut beside = self::scene(0.5);
    beside.add_cuboid(at([0.0; 3]), [1.0; 3], fixed("one")).unwrap();
    beside.add_cuboid(at([1.0, 0.0, 1.0]), [1.0; 3], BodyOptions::default()).unwrap();
    let set = find_solid_contacts(&beside).unwrap();
    assert_eq!((set.contacts.len(), set.corner_touches.len()), (2, 0));
    for (contact, y) in set.contacts.iter().zip([-0.5, 0.5]) {
        assert!(contact.id.feature.at_borders(), "{}", contact.id);
        assert_eq!(contact.point, [0.5, y, 0.5]);
        let half = 0.5_f64.sqrt();
        assert!((0..3).all(|k| (contact.normal[k] - [half, 0.0, half][k]).abs() < 1e-14), "{:?}", contact.normal);
    }
}

/// A tip on the seam of two pieces: they share a face there, so it meets a flat face, from whichever piece it is seen.
#[test]
fn a_seam_of_two_pieces_is_no_edge() {
    let half = |x: f64| -> Vec<[f64; 3]> {
        Polyhedron::cuboid([1.0; 3]).vertices().iter().map(|v| [v.x + x, v.y, v.z - 0.5]).collect()
    };
    let mut scene = scene(0.5);
    let table = BodyOptions { fixed: true, ..BodyOptions::default() };
    scene.add_solid(&[half(-0.5), half(0.5)], PoseInSpace::WORLD, table).unwrap();
    // Its centroid is above the tip.
    let tip = vec![[0.0; 3], [0.2, 0.0, 0.5], [-0.1, 0.1, 0.5], [-0.1, -0.1, 0.5]];
    scene.add_solid(&[tip], PoseInSpace::WORLD, BodyOptions::default()).unwrap();
    let set = find_solid_contacts(&scene).unwrap();
    let [contact] = &set.contacts[..] else { panic!("{set:?}") };
    assert!((contact.normal[2] - 1.0).abs() < 1e-12, "{contact:?}");
    assert!(check(&scene, None).unwrap().stable);
}

/// A block on a slope holds up to tan(angle) = mu: arctan 0.84 is 40.03 degrees. Whichever way the slope looks, the first
/// edge of each cone points down it.
#[test]
fn a_slope_holds_up_to_the_angle_of_friction() {
    for facing in [0.0_f64, 0.3, 1.1, 2.9] {
        for (degrees, stands) in [(39.0_f64, true), (40.0, true), (40.06, false), (41.0, false)] {
            let (sin, cos) = facing.sin_cos();
            let tilt = turned([sin, cos, 0.0], degrees.to_radians());
            let frame = PoseInSpace { position: [0.3, -0.2, 0.1], orientation: tilt };
            let placed = |height: f64| PoseInSpace {
                position: frame.transform(Vector3::new(0.0, 0.0, height)).to_array(),
                ..frame
            };
            let mut scene = scene(0.84);
            scene.add_cuboid(placed(-0.5), [4.0, 4.0, 1.0], fixed("slope")).unwrap();
            scene.add_cuboid(placed(0.25), [1.0, 1.0, 0.5], BodyOptions::default()).unwrap();
            assert_eq!(check(&scene, None).unwrap().stable, stands, "{degrees} degrees, facing {facing}");
        }
    }
}

#[test]
fn a_pyramid_of_cubes_stands_and_an_overhang_falls() {
    let mut scene = scene(0.0);
    scene.add_cuboid(at([0.0, 0.0, -0.5]), [20.0, 20.0, 1.0], fixed("ground")).unwrap();
    for layer in 0..5 {
        let side = 5 - layer;
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let place = |k: i32| f64::from(k) - 0.5 * f64::from(side - 1);
            let position = [place(i), place(j), f64::from(layer) + 0.5];
            scene.add_cuboid(at(position), [1.0; 3], BodyOptions::default()).unwrap();
        }
    }
    let verdict = check(&scene, None).unwrap();
    assert!(verdict.stable && verdict.residual <= 1e-9);
    let weight = 55.0 * 9.81;
    let on_ground = verdict.forces.iter().filter(|(contact, _)| contact.bodies[0] == 0);
    assert!((on_ground.map(|(_, force)| force.normal).sum::<f64>() - weight).abs() < 1e-9);

    let overhang = BodyOptions { name: Some("overhang".into()), ..BodyOptions::default() };
    scene.add_cuboid(at([0.51, 0.0, 5.5]), [1.0; 3], overhang).unwrap();
    let verdict = check(&scene, None).unwrap();
    assert_eq!((verdict.stable, verdict.falling.len()), (false, 1));
}

/// The pyramids bracket the cone: at an angle between facets the inscribed one slides earlier, the circumscribed one later.
#[test]
fn cones_bracket_coulomb() {
    // Gravity pulls the block equally down the slope; a wall cannot, so the pull is turned by a second direction of gravity.
    let edges = |bound| Cones { facets: 4, bound }.edges([0.0, 0.0, 1.0], 0.5, [0.0, 0.0, -9.81]);
    for bound in [Bound::Inscribed, Bound::Circumscribed] {
        let expected = if bound == Bound::Inscribed { 0.5 } else { 0.5 * 2.0_f64.sqrt() };
        assert!(edges(bound).iter().all(|[x, y, z]| (x.hypot(*y) / z - expected).abs() < 1e-15));
    }
}

/// Turning and shifting a scene with its gravity changes no verdict, and forces turn along.
#[test]
fn a_turned_scene_has_the_same_verdict() {
    let motion = PoseInSpace { position: [3.0, -7.0, 11.0], orientation: turned([0.6, 0.0, 0.8], 0.7) };
    for shift in [0.2, 0.49, 0.51, 0.8] {
        let verdicts = [PoseInSpace::WORLD, motion].map(|motion| {
            let gravity = motion.rotate(Vector3::from_array(GRAVITY)).to_array();
            let mut scene = SceneInSpace::new(gravity, 0.6).unwrap();
            let placed =
                |p: [f64; 3]| PoseInSpace { position: motion.transform(Vector3::from_array(p)).to_array(), ..motion };
            scene.add_cuboid(placed([0.0, 0.0, 0.0]), [1.0; 3], fixed("base")).unwrap();
            scene.add_cuboid(placed([shift, 0.0, 1.0]), [1.0; 3], BodyOptions::default()).unwrap();
            check(&scene, None).unwrap()
        });
        assert_eq!(verdicts[0].stable, shift < 0.5);
        assert_eq!(verdicts[0].stable, verdicts[1].stable, "{shift}: {verdicts:#?}");
    }
}

#[test]
fn a_part_is_a_principal_part_in_space_too() {
    let mut scene = scene(0.4);
    scene.add_cuboid(at([0.0, 0.0, -0.5]), [9.0, 9.0, 1.0], fixed("ground")).unwrap();
    for k in 0..6 {
        scene.add_cuboid(at([0.1 * f64::from(k), 0.0, 0.5 + f64::from(k)]), [1.0; 3], BodyOptions::default()).unwrap();
    }
    let assembly = Assembly::new(&scene).unwrap();
    let mut set = BlockSet::empty(assembly.blocks());
    for block in assembly.upward() {
        set.insert(block);
        let verdict = drystone::check::check_blocks(&assembly, &set);
        let complementarity = drystone::check::check_while(
            &assembly,
            Some(&set.iter().map(|b| assembly.body(b).name.clone()).collect::<Vec<_>>()),
            drystone::check::Route::Complementarity,
            drystone::formulate::FrictionCone::Pyramid,
            &mut |_| true,
        );
        let complementarity = complementarity.unwrap().unwrap();
        assert_eq!((verdict.stable, verdict.stable), (complementarity.stable, set.len() <= 6));
        assert!(verdict.residual <= 1e-9 && complementarity.residual <= 1e-9);
    }
}

/// The verdict of a planar scene and of the same with a thickness, on random stacks of which some have lost blocks.
#[test]
fn an_extruded_scene_has_the_planar_verdict() {
    let mut seen = [0, 0];
    for seed in 0..200 {
        let friction = [0.0, 0.2, 0.5][seed as usize % 3];
        let scene = scenes::random_stack(4 + seed as usize % 14, seed, friction).unwrap();
        let solid = scenes::extruded(&scene, 0.7).unwrap();
        let names: Vec<String> =
            scene.bodies().iter().filter(|body| !body.fixed).map(|body| body.name.clone()).collect();
        // A third of the blocks is left out, a different one each time.
        let some: Vec<String> = names
            .iter()
            .enumerate()
            .filter(|(k, _)| !(k + seed as usize).is_multiple_of(3))
            .map(|(_, n)| n.clone())
            .collect();
        for part in [&names, &some] {
            let planar = check(&scene, Some(part)).unwrap();
            let spatial = check(&solid, Some(part)).unwrap();
            assert_eq!((planar.stable, &planar.falling), (spatial.stable, &spatial.falling), "seed {seed}, {part:?}");
            seen[usize::from(planar.stable)] += 1;
        }
    }
    assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
}

/// Arches lean, their voussoirs are no boxes, and their thrust needs friction.
#[test]
fn an_extruded_arch_has_the_planar_verdict() {
    for (voussoirs, thickness, friction) in [(21, 0.2, 0.6), (21, 0.09, 0.6), (21, 0.2, 0.2), (41, 0.109, 0.7)] {
        let scene = scenes::arch(voussoirs, thickness, friction).unwrap();
        let solid = scenes::extruded(&scene, 0.5).unwrap();
        assert_eq!(check(&scene, None).unwrap().stable, check(&solid, None).unwrap().stable, "{voussoirs} {thickness}");
    }
}

/// Flat, thin and slanted pieces: the hull of a tetrahedron is itself whatever its proportions.
#[test]
fn thin_pieces_are_no_flat_ones() {
    for thickness in [1.0, 1e-2, 1e-3, 1e-5, 1e-7] {
        let corners =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, thickness]].map(Vector3::from_array);
        let hull = Polyhedron::hull(&corners).unwrap();
        assert_eq!((hull.vertices(), hull.faces().len()), (&corners[..], 4), "{thickness}");
    }
    let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1e-9]].map(Vector3::from_array);
    assert_eq!(Polyhedron::hull(&flat).unwrap_err(), SolidFault::ZeroVolume);
}

/// The corners of random cuboids, prisms and points on spheres, shuffled, moved, thinned and rounded to single precision.
#[test]
fn random_hulls_are_closed_and_hold_their_points() {
    use rand::{Rng, SeedableRng};
    let mut random = rand_pcg::Pcg64::seed_from_u64(7);
    for case in 0..3000 {
        let count = random.random_range(4..40);
        let scale = [1.0, 10f64.powi(-random.random_range(0..5)), 1.0];
        let single = case % 3 == 0;
        let mut points: Vec<Vector3> = (0..count)
            .map(|k| match case % 4 {
                0 => Vector3::new(random.random(), random.random(), random.random()),
                1 => {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(k / 2) / f64::from(count)).sin_cos();
                    Vector3::new(cos, sin, f64::from(k % 2))
                }
                2 => Vector3::new(
                    random.random::<f64>() - 0.5,
                    random.random::<f64>() - 0.5,
                    random.random::<f64>() - 0.5,
                )
                .normalize(),
                _ => Vector3::new(
                    f64::from(random.random_range(0..3)),
                    f64::from(random.random_range(0..3)),
                    f64::from(random.random_range(0..3)),
                ),
            })
            .collect();
        let turn = PoseInSpace { position: [3.0, -2.0, 5.0], orientation: turned([0.6, 0.0, 0.8], random.random()) };
        for v in &mut points {
            *v = turn.transform(Vector3::new(v.x * scale[0], v.y * scale[1], v.z * scale[2]));
            if single {
                *v = Vector3::new(f64::from(v.x as f32), f64::from(v.y as f32), f64::from(v.z as f32));
            }
        }
        match Polyhedron::hull(&points) {
            // Euler's formula: a closed surface without holes.
            Ok(hull) => assert_eq!(hull.vertices().len() + hull.faces().len(), hull.edges().len() + 2, "case {case}"),
            Err(fault) => assert_eq!(fault, SolidFault::ZeroVolume, "case {case}"),
        }
    }
}

/// Two cubes one on the other, shifted along an edge, so that sides of the shared face lie on sides: however the pair is turned, the
/// four corners are found, and nothing else.
#[test]
fn sides_on_sides_lose_no_corner() {
    for k in 0..600 {
        let share = |factor: f64| (f64::from(k) * factor).fract();
        let (shift, angle) = (0.1 + 0.8 * share(0.618_033_988_749_895), f64::from(k % 24) * 15.0_f64.to_radians());
        let axis = match k % 3 {
            0 => [0.0, 1.0, 0.0],
            1 => [1.0, 0.0, 0.0],
            _ => Vector3::new(share(0.754_877_666), share(0.569_840_290), 0.3).normalize().to_array(),
        };
        let frame = PoseInSpace { position: [3.0 * share(0.381_966), 0.7, -0.2], orientation: turned(axis, angle) };
        let cube = |y: f64, z: f64| {
            let corners = Polyhedron::cuboid([1.0; 3]).vertices().iter().map(|v| [v.x, v.y + y, v.z + z]).collect();
            vec![corners]
        };
        let mut pair = scene(0.5);
        pair.add_solid(&cube(0.0, 0.0), frame, fixed("below")).unwrap();
        pair.add_solid(&cube(shift, 1.0), frame, BodyOptions::default()).unwrap();
        let contacts = find_solid_contacts(&pair).unwrap().contacts;
        let mut found: Vec<[i64; 2]> = contacts
            .iter()
            .map(|contact| {
                let from = Vector3::from_array(contact.point) - Vector3::from_array(frame.position);
                let along = |axis: [f64; 3]| (1e6 * frame.rotate(Vector3::from_array(axis)).dot(from)).round() as i64;
                [along([1.0, 0.0, 0.0]), along([0.0, 1.0, 0.0])]
            })
            .collect();
        found.sort_unstable();
        let low = (1e6 * (shift - 0.5)).round() as i64;
        let half = 500_000;
        assert_eq!(found, [[-half, low], [-half, half], [half, low], [half, half]], "{k}: {shift} {angle}");
    }
}
