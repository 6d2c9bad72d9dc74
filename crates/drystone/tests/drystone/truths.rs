//! Truths that need no peer: answers known in closed form, each with its source or its derivation.
//!
//! What is asserted, and what is not. The formulation is the convex (maximum dissipation) one: over the generators of
//! the friction cones, `0 <= f` complementary to `G' a >= 0` with `a = M^-1 (F + G f)`. These are the conditions of
//! the least kinetic energy of acceleration `a' M a / 2` over all forces in the cones, so
//!
//! - *whether* `a = 0` can be reached is exact Coulomb statics: [`Verdict::stable`] and the forces of a structure that
//!   stands are asserted with friction and without;
//! - without friction the conditions are those of rigid, frictionless contact, so accelerations are asserted too;
//! - with friction, a block that *slides* does not accelerate as Coulomb's law says. Its force lies on one edge of the
//!   cone, and complementarity lets the contact part at `a_n = mu |a_t|` instead of 0. On a slope of angle s this
//!   gives `a_t = g (sin s - mu cos s) / (1 + mu^2)`, where Coulomb's law has no denominator. Such accelerations say
//!   which way things go and that they go; their size is asserted nowhere.

use drystone::{BodyOptions, Scene, Verdict, check, scenes};
use std::f64::consts::PI;

const G: f64 = 9.81;

fn verdict(scene: &Scene) -> Verdict {
    let verdict = check(scene, None).unwrap();
    assert_eq!(verdict.status.name(), "solved");
    assert!(verdict.residual <= 1e-9, "residual {:e}", verdict.residual);
    verdict
}

/// Within a billionth of a limit it may be borderline, which is not standing.
fn stands(scene: &Scene) -> bool {
    let verdict = check(scene, None).unwrap();
    assert!(matches!(verdict.status.name(), "solved" | "borderline"));
    verdict.stable
}

/// The least value for which `holds`, within `width`, by bisection.
fn least(mut low: f64, mut high: f64, width: f64, holds: impl Fn(f64) -> bool) -> f64 {
    assert!(!holds(low) && holds(high), "the limit is not between {low} and {high}");
    while high - low > width {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

fn fixed(name: &str) -> BodyOptions {
    BodyOptions { fixed: true, ..named(name) }
}

fn named(name: &str) -> BodyOptions {
    BodyOptions { name: Some(name.into()), ..BodyOptions::default() }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected} within {tolerance:e}");
}

/// Least thickness of a semicircular arch of mean radius 1 with radial joints, sliding excluded by high friction:
/// 0.1075 (M. Milankovitch, "Theorie der Druckkurven", Zeitschrift für Mathematik und Physik 55, 1907; J. Heyman, "The
/// stone skeleton", 1966, has 0.106). With 41 voussoirs hinges can form at 42 joints only: 0.1073.
#[test]
fn an_arch_stands_from_the_thickness_of_milankovitch() {
    let thinnest = |n: usize, friction| least(0.05, 0.2, 1e-5, |t| stands(&scenes::arch(n, t, friction).unwrap()));
    close(thinnest(41, 1.0), 0.1073, 1e-3);
    close(thinnest(61, 1.0), 0.1075, 1e-3);
    // At such a friction sliding decides nothing: more of it changes nothing.
    close(thinnest(41, 1.0), thinnest(41, 5.0), 2e-5);
}

/// Least friction at which every joint of an arch can hold by itself, wherever its thrust passes. Voussoirs weigh
/// the same, so the part from the crown to a joint at angle t from it weighs t (in suitable units) and exerts the
/// thrust H there. The joint's normal force is H cos t + t sin t, its shear t cos t - H sin t inward. With
/// mu = tan(phi), no sliding inward means H >= t cot(t + phi); no sliding outward at the springing means H <= mu pi / 2.
fn joint_friction(voussoirs: usize) -> f64 {
    let half = 0.5 * PI;
    let joints: Vec<f64> =
        (0..voussoirs).map(|k| half - PI * k as f64 / voussoirs as f64).filter(|&t| t > 0.0).collect();
    let needed = |mu: f64| joints.iter().map(|t| t / (t + mu.atan()).tan()).fold(0.0, f64::max);
    least(0.1, 0.7, 1e-9, |mu| needed(mu) <= mu * half)
}

/// Many voussoirs: G. Cocchetti and E. Rizzi, "Analytical and numerical analysis on the collapse modes of
/// least-thickness circular masonry arches at decreasing friction", Frattura ed Integrità Strutturale 51 (2020),
/// table 3: no equilibrium below 0.309215, and from a thickness of 0.2006 on the limit is sliding alone. At 0.2 a hinge
/// at the haunches takes part, if it can open at a joint, which asks for hardly more. The cones grow with mu, so the
/// limit is one number.
#[test]
fn a_thick_arch_slides_below_a_friction_of_about_031() {
    close(joint_friction(10_001), 0.309215, 1e-6);
    let limit = |n, thickness| least(0.1, 0.7, 1e-7, |mu| stands(&scenes::arch(n, thickness, mu).unwrap()));
    for voussoirs in [10, 20, 41] {
        close(limit(voussoirs, 0.25), joint_friction(voussoirs), 1e-6);
    }
    for voussoirs in [41, 61] {
        let friction = limit(voussoirs, 0.2);
        assert!((0.309..=0.315).contains(&friction), "{voussoirs} voussoirs: {friction}");
    }
}

/// M. Paterson and U. Zwick, "Overhang", American Mathematical Monthly 116 (2009), section 2.
#[test]
fn frictionless_diamonds_stand_up_to_four_and_inverted_triangles_up_to_two() {
    for m in 1..=5 {
        assert_eq!(stands(&scenes::diamond(m, 0.0).unwrap()), m <= 4, "diamond of {m}");
    }
    for rows in 1..=6 {
        assert_eq!(stands(&scenes::inverted_triangle(rows, 0.0).unwrap()), rows <= 2, "triangle of {rows} rows");
    }
}

/// The top i blocks have their common centre of mass i / 2 blocks of weight behind the edge they lie on when the i-th
/// from the top extends 1 / (2 i) over the next: H_n / 2 in all, and any factor above 1 puts it beyond every edge.
/// Friction cannot help: all loads and normals are vertical.
#[test]
fn a_harmonic_stack_stands_up_to_its_limit_and_no_further() {
    for n in [1, 2, 3, 5, 10, 20, 40] {
        for friction in [0.0, 0.7] {
            let at = |factor| stands(&scenes::harmonic_stack(n, factor, friction).unwrap());
            assert!(at(0.999), "{n} blocks, mu {friction}");
            assert!(!at(1.001), "{n} blocks, mu {friction}");
        }
        // Exactly at the limit the balance is met with every reaction at its edge.
        assert!(stands(&scenes::harmonic_stack(n, 1.0, 0.0).unwrap()), "{n} blocks");
    }
}

/// Along the slope m g sin(s) is to be borne by at most mu m g cos(s). The block is wide enough not to topple.
#[test]
fn a_block_on_a_slope_slides_where_its_tangent_exceeds_the_friction() {
    for degrees in [-50.0, -20.0, 5.0, 15.0, 30.0, 45.0, 60.0_f64] {
        let tangent = degrees.to_radians().tan().abs();
        let limit = least(0.0, 3.0, 1e-8, |mu| stands(&scenes::slope(degrees, mu, 4.0, 1.0).unwrap()));
        close(limit, tangent, 1e-6);
    }
    assert!(stands(&scenes::slope(0.0, 0.0, 1.0, 1.0).unwrap()));
}

/// The weight's line of action leaves the base of width w, seen from height h / 2, at tan(s) = w / h. Friction
/// 10 keeps the block from sliding.
#[test]
fn a_block_on_a_slope_topples_where_its_weight_leaves_its_base() {
    for (width, height) in [(1.0, 2.0), (1.0, 1.0), (0.3, 0.9), (2.0, 1.0)] {
        let falls = |degrees| !stands(&scenes::slope(degrees, 10.0, width, height).unwrap());
        let limit: f64 = least(1.0, 80.0, 1e-7, falls);
        close(limit.to_radians().tan(), width / height, 1e-6);
        assert!(!falls(1.0 - limit) && falls(-1.0 - limit), "the mirror image of {width} x {height}");
    }
}

/// A beam of 3 kg on two fixed wedges, touched by their apexes at `left` and `right` of its centre.
fn beam_on_wedges(left: f64, right: f64, friction: f64) -> Scene {
    let mut scene = Scene::new([0.0, -G], friction).unwrap();
    for (name, x) in [("left", left), ("right", right)] {
        scene.add_polygon(&[[x - 0.2, 0.0], [x + 0.2, 0.0], [x, 1.0]], fixed(name)).unwrap();
    }
    scene.add_box([0.0, 1.25], [6.0, 0.5], 0.0, named("beam")).unwrap();
    scene
}

/// Moments about one support give the other's share: N_left (right - left) = W right, with the supports'
/// places measured from the centre of mass. Both points are at one height, so friction forces take no part.
#[test]
fn two_supports_share_a_weight_by_the_law_of_the_lever() {
    for friction in [0.0, 0.6] {
        for (left, right) in [(-1.0, 1.0), (-2.5, 0.5), (-0.125, 2.0), (0.0, 1.5)] {
            let answer = verdict(&beam_on_wedges(left, right, friction));
            assert!(answer.stable);
            let weight = 3.0 * G;
            let expected = [weight * right / (right - left), -weight * left / (right - left)];
            assert_eq!(answer.forces.len(), 2);
            for ((contact, force), expected) in answer.forces.iter().zip(expected) {
                assert_eq!(contact.normal, [0.0, 1.0, 0.0], "from the wedge into the beam");
                close(force.normal, expected, 1e-7 * weight);
                close(force.force[1], expected, 1e-7 * weight);
            }
            close(answer.forces.iter().map(|(_, force)| force.tangential).sum(), 0.0, 1e-7 * weight);
        }
    }
    assert!(!stands(&beam_on_wedges(0.01, 1.5, 0.6)), "both supports on one side of the centre of mass");
}

/// On a slope of angle s the two corners of a block w x h bear W (cos(s) / 2 -+ sin(s) h / (2 w)), the lower one more
/// (moments about the other corner), and together W sin(s) along the slope, which pulls the block uphill.
#[test]
fn the_corners_of_a_block_on_a_slope_share_its_weight() {
    let (degrees, width, height) = (20.0_f64, 2.0, 1.5);
    let (sin, cos) = degrees.to_radians().sin_cos();
    let answer = verdict(&scenes::slope(degrees, 0.8, width, height).unwrap());
    assert!(answer.stable);
    let weight = width * height * G;
    let mut uphill = 0.0;
    for (contact, force) in &answer.forces {
        let below = contact.point[0] < 0.0; // the plane rises to the right, the block stands at its origin
        let lever = if below { 1.0 } else { -1.0 } * sin * height / (2.0 * width);
        close(force.normal, weight * (cos / 2.0 + lever), 1e-7 * weight);
        assert!(force.tangential.abs() <= 0.8 * force.normal + 1e-7 * weight);
        // The normal turned by 90 degrees counter-clockwise points downhill.
        uphill -= force.tangential;
    }
    assert_eq!(answer.forces.len(), 2);
    close(uphill, weight * sin, 1e-7 * weight);
}

/// What a structure at rest exerts on the fixed bodies is its weight (Newton's second and third laws).
#[test]
fn the_supports_bear_the_whole_weight() {
    let standing = [
        scenes::pyramid(6, 0.0).unwrap(),
        scenes::pyramid(6, 0.5).unwrap(),
        scenes::random_stack(30, 3, 0.0).unwrap(),
        scenes::random_stack(30, 3, 0.4).unwrap(),
        scenes::arch(15, 0.2, 0.7).unwrap(),
        scenes::wall(6, 5, 4, 0.6).unwrap(),
        scenes::diamond(4, 0.0).unwrap(),
        scenes::slope(20.0, 0.5, 1.0, 1.0).unwrap(),
    ];
    for scene in &standing {
        let answer = verdict(scene);
        assert!(answer.stable);
        let weight: f64 = scene.bodies().iter().filter(|body| !body.fixed).map(|body| body.mass() * G).sum();
        let mut borne = [0.0; 2];
        for (contact, force) in &answer.forces {
            let [a, b] = contact.bodies.map(|body| scene.bodies()[body].fixed);
            // The force on the second body; the first feels its opposite.
            let sign = f64::from(u8::from(b)) - f64::from(u8::from(a));
            borne = [0, 1].map(|k| borne[k] + sign * force.force[k]);
        }
        close(borne[0], 0.0, 1e-7 * weight);
        close(borne[1], -weight, 1e-7 * weight);
    }
}

/// Contacts only push, and within the friction cone.
#[test]
fn contact_forces_lie_in_their_cones() {
    for scene in [scenes::arch(15, 0.2, 0.4).unwrap(), scenes::wall(5, 5, 9, 0.3).unwrap()] {
        let answer = verdict(&scene);
        let largest = answer.forces.iter().map(|(_, force)| force.normal).fold(0.0, f64::max);
        for (contact, force) in &answer.forces {
            assert!(force.normal >= 0.0);
            assert!(force.tangential.abs() <= contact.friction * force.normal + 1e-12 * largest);
        }
    }
}

/// Nothing touches it: its acceleration is gravity's, to the bit (m g / m with m a power of two).
#[test]
fn a_block_in_the_air_falls_freely() {
    for gravity in [[0.0, -G], [1.5, -3.0], [0.0, 2.0]] {
        let mut scene = Scene::new(gravity, 0.5).unwrap();
        scene.add_box([0.0, -0.5], [8.0, 1.0], 0.0, fixed("ground")).unwrap();
        scene.add_box([0.0, 3.0], [1.0, 2.0], 0.3, named("apple")).unwrap();
        let answer = verdict(&scene);
        assert!(!answer.stable);
        assert_eq!(answer.falling, [1]);
        assert_eq!(answer.accelerations[0].in_plane(), [gravity[0], gravity[1], 0.0]);
    }
}

/// Without gravity nothing has a reason to move.
#[test]
fn without_gravity_everything_rests() {
    let mut scene = Scene::new([0.0, 0.0], 0.0).unwrap();
    scene.add_box([0.0, 3.0], [1.0, 2.0], 0.3, named("apple")).unwrap();
    assert!(stands(&scene));
}

/// Without friction a block on a slope accelerates along it by g sin(s), and no other way.
#[test]
fn a_block_on_ice_accelerates_by_the_slope() {
    for degrees in [-35.0, 1.0, 10.0, 35.0_f64] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let answer = verdict(&scenes::slope(degrees, 0.0, 4.0, 1.0).unwrap());
        assert!(!answer.stable);
        let [ax, ay, turn] = answer.accelerations[0].in_plane();
        close(ax, -G * sin * cos, 1e-9 * G);
        close(ay, -G * sin * sin, 1e-9 * G);
        close(turn, 0.0, 1e-9 * G);
    }
}

/// A plank over the edge of a pier, without friction: its centre of mass d beyond the edge, radius of gyration k. The
/// edge's upward force N gives m a = N - m g and I alpha = -N d, and the plank stays on the edge: a + alpha (-d) = 0,
/// so N = m g / (1 + d^2 / k^2).
#[test]
fn a_plank_tips_over_the_edge_of_its_pier() {
    let (length, height, beyond) = (2.0, 0.25, 0.25);
    let mut scene = Scene::new([0.0, -G], 0.0).unwrap();
    scene.add_box([-1.0, -0.5], [2.0, 1.0], 0.0, fixed("pier")).unwrap();
    scene.add_box([beyond, 0.5 * height], [length, height], 0.0, named("plank")).unwrap();
    let answer = verdict(&scene);
    assert_eq!((answer.stable, &answer.falling[..]), (false, &[1][..]));
    let gyration_squared = (length * length + height * height) / 12.0;
    let reaction = length * height * G / (1.0 + beyond * beyond / gyration_squared);
    let pushed: f64 = answer.forces.iter().map(|(_, force)| force.normal).sum();
    close(pushed, reaction, 1e-9 * reaction);
    let [ax, ay, turn] = answer.accelerations[0].in_plane();
    close(ax, 0.0, 1e-9 * G);
    close(ay, reaction / (length * height) - G, 1e-9 * G);
    close(turn, ay / beyond, 1e-9 * G);
}

/// A block that slides is not stable, however little it lacks, and moves downhill; by how much is not asserted (see the
/// top of this file).
#[test]
fn a_sliding_block_does_not_stand() {
    for (degrees, friction) in [(30.0, 0.3), (-30.0, 0.3), (60.0, 1.5), (20.0, 0.36)] {
        let answer = verdict(&scenes::slope(degrees, friction, 6.0, 1.0).unwrap());
        assert!(!answer.stable);
        assert_eq!(answer.falling, [1]);
        let [ax, _, _] = answer.accelerations[0].in_plane();
        assert!(ax * degrees < 0.0, "{degrees} degrees: {ax}");
    }
}
