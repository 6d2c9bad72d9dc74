//! Scene files: exact round trips, errors that say file, place and fix, whole writes.

use drystone::geometry::Pose;
use drystone::{AnyScene, BodyOptions, FileError, Scene, SceneError, io, scenes};
use proptest::prelude::*;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

const SOURCE: &str = "wall.json";

fn text_of(scene: &Scene) -> String {
    AnyScene::from(scene.clone()).to_json()
}

fn error_of(text: &str) -> FileError {
    match io::from_json(text, SOURCE) {
        Err(SceneError::File(error)) => error,
        other => panic!("{other:?}"),
    }
}

/// A file with the given bodies.
fn with_bodies(bodies: &str) -> String {
    format!(
        r#"{{"format": "drystone-scene", "version": 1, "dimension": 2,
            "gravity": [0, -9.81], "friction": 0.5, "bodies": [{bodies}]}}"#
    )
}

/// The same in space.
fn with_solids(bodies: &str) -> String {
    with_bodies(bodies).replace("\"dimension\": 2", "\"dimension\": 3").replace("[0, -9.81]", "[0, 0, -9.81]")
}

/// A new folder of this test's own.
fn folder(test: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("drystone-{}-{test}", std::process::id()));
    fs::create_dir_all(&path).unwrap();
    path
}

#[test]
fn every_built_in_scene_comes_back_as_it_was() {
    for entry in scenes::catalogue() {
        let scene = scenes::build(entry.name, &BTreeMap::new()).unwrap();
        let text = scene.to_json();
        let again = io::from_json(&text, SOURCE).unwrap();
        assert_eq!(again, scene, "{}", entry.name);
        assert_eq!(again.to_json(), text);
    }
}

#[test]
fn all_fields_come_back() {
    let mut scene = Scene::new([0.1, -9.0], 0.3).unwrap().with_contact_tolerance(1e-5).unwrap();
    let options = BodyOptions {
        name: Some("\"quoted\" \u{fc}ber\n".into()),
        density: 2400.0,
        friction: Some(0.0),
        fixed: true,
        ..BodyOptions::default()
    };
    scene.add_box([-0.0, 1.0 / 3.0], [1e-3 / 3.0, 1e4 / 7.0], 1e-17, options).unwrap();
    scene.add_polygon(&[[1e6, 0.1], [1e6 + 1.0, 0.3], [1e6, 1.7]], BodyOptions::default()).unwrap();
    let text = text_of(&scene);
    let again = io::from_json(&text, SOURCE).unwrap();
    assert_eq!(again, AnyScene::from(scene.clone()));
    assert_eq!(again.to_json(), text, "also the sign of zero");
}

#[test]
fn an_empty_scene_comes_back() {
    let scene = Scene::new([0.0, 0.0], 0.0).unwrap();
    assert_eq!(io::from_json(&text_of(&scene), SOURCE).unwrap(), scene.into());
}

proptest! {
    /// Numbers of every size and a polygon anywhere, at any angle, survive bit for bit.
    #[test]
    fn any_polygon_comes_back_bit_for_bit(
        x in -1e9..1e9_f64, y in -1e3..1e3_f64, angle in -10.0..10.0_f64,
        width in 1e-3..1e3_f64, slant in 0.01..1.0_f64, density in 1e-9..1e9_f64,
    ) {
        let corners = [[0.0, 0.0], [width, slant], [0.7 * width, slant + width], [0.0, 0.9 * width]];
        let options = BodyOptions { density, ..BodyOptions::default() };
        let frame = Pose { position: [x, y], angle };
        let mut scene = Scene::new([0.0, -9.81], 0.5).unwrap();
        scene.add_placed_polygon(&corners, frame, options.clone()).unwrap();
        scene.add_polygon(&corners.map(|[a, b]| [x + a, y + b]), options).ok();
        let again = io::from_json(&text_of(&scene), SOURCE).unwrap();
        prop_assert_eq!(again, AnyScene::from(scene.clone()));
    }
}

#[test]
fn fields_left_out_take_their_defaults() {
    let text = with_bodies(r#"{"box": {"size": [1, 2]}}, {"box": {"size": [1, 1]}}"#);
    let scene = io::from_json(&text, SOURCE).unwrap().in_plane().unwrap();
    let body = &scene.bodies()[0];
    assert_eq!((body.name.as_str(), body.density, body.friction), ("b0", 1.0, None));
    assert_eq!(body.pose, Pose { position: [0.0, 0.0], angle: 0.0 });
    assert!(!body.fixed);
    assert_eq!(scene.bodies()[1].name, "b1");
}

#[test]
fn a_polygon_given_off_its_centroid_stands_where_the_file_says() {
    let text = with_bodies(
        r#"{"polygon": {"vertices": [[0, 0], [2, 0], [2, 2], [0, 2]]},
            "position": [10, 0], "angle": 1.5707963267948966}"#,
    );
    let scene = io::from_json(&text, SOURCE).unwrap().in_plane().unwrap();
    let body = &scene.bodies()[0];
    // The centroid (1, 1) turned by a quarter is (-1, 1).
    assert!((body.pose.position[0] - 9.0).abs() < 1e-15 * 10.0);
    assert!((body.pose.position[1] - 1.0).abs() < 1e-15);
    assert_eq!(body.mass(), 4.0);
}

#[test]
fn solids_come_back() {
    let text = with_solids(
        r#"{"solid": {"pieces": [{"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0.1, 0.1]]}]},
            "position": [3, 4, 5], "orientation": [1, 2, 3, 4]}, {"box": {"size": [1, 2, 3]}}"#,
    );
    let scene = io::from_json(&text, SOURCE).unwrap();
    let written = scene.to_json();
    let again = io::from_json(&written, SOURCE).unwrap();
    assert_eq!(again, scene);
    assert_eq!(again.to_json(), written);
    let solid = &scene.in_space().unwrap().bodies()[0].clone();
    assert!((solid.mass() - 1.0 / 6.0).abs() < 1e-15);
    let turned = solid.pose.transform(drystone::geometry::Vector3::splat(-0.25));
    assert!(turned.distance(drystone::geometry::Vector3::new(3.0, 4.0, 5.0)) < 1e-14);
}

#[test]
fn a_mistyped_field_is_named_with_its_body_and_the_right_one() {
    let bodies = r#"{"box": {"size": [1, 1]}},
        {"name": "lintel", "box": {"size": [1, 1]}, "fricton": 0.2}"#;
    let error = error_of(&with_bodies(bodies));
    assert!(matches!(&error, FileError::UnknownField { field, .. } if field == "fricton"));
    let text = error.to_string();
    assert!(
        text.starts_with("wall.json: bodies[1] \"lintel\": unknown field \"fricton\": did you mean \"friction\"?"),
        "{text}"
    );
    let error = error_of(&with_bodies(r#"{"box": {"sizes": [1, 1]}}"#)).to_string();
    assert!(error.contains("bodies[0]: \"box\": unknown field \"sizes\""), "{error}");
    let whole = with_bodies("").replace("\"gravity\"", "\"gravty\"");
    assert!(error_of(&whole).to_string().contains("did you mean \"gravity\"?"));
}

#[test]
fn missing_and_mistaken_values_are_named() {
    let cases = [
        (r#"{"name": "a"}"#, "bodies[0] \"a\": the field \"box\" or \"polygon\" is missing"),
        (r#"{"box": {}}"#, "bodies[0]: \"box\": the field \"size\" is missing"),
        (r#"{"box": {"size": [1]}}"#, "bodies[0]: \"box\": \"size\" is [1]: give two numbers"),
        (r#"{"box": {"size": [1, 1]}, "fixed": 1}"#, "bodies[0]: \"fixed\" is 1: give true or false"),
        (r#"{"box": {"size": [1, 1]}, "polygon": {"vertices": []}}"#, "\"polygon\" beside \"box\""),
        (r#"{"box": {"size": [1, 1]}, "friction": null}"#, "\"friction\" is null: give a number"),
        ("3", "bodies[0] is 3: give an object"),
        (
            r#"{"name": "a", "box": {"size": [1, -1]}}"#,
            "bodies[0] \"a\": block \"a\": size[1] is -1: it must be greater than zero",
        ),
        (
            r#"{"polygon": {"vertices": [[0, 0], [1, 1], [2, 2]]}}"#,
            "bodies[0]: block \"b0\": the polygon has zero area",
        ),
    ];
    for (body, expected) in cases {
        let text = error_of(&with_bodies(body)).to_string();
        assert!(text.starts_with("wall.json: ") && text.contains(expected), "{text}");
    }
    let twice = r#"{"name": "a", "box": {"size": [1, 1]}}"#;
    let text = error_of(&with_bodies(&format!("{twice}, {twice}"))).to_string();
    assert!(text.contains("bodies[1] \"a\": the name \"a\" is already that of block"), "{text}");
}

#[test]
fn another_format_version_or_dimension_is_refused_first() {
    let good = with_bodies("");
    let newer = good.replace("\"version\": 1", "\"version\": 99").replace("\"friction\"", "\"mu\"");
    assert!(matches!(error_of(&newer), FileError::UnsupportedVersion { supported: 3, .. }));
    let hyperspace = good.replace("\"dimension\": 2", "\"dimension\": 4");
    assert!(matches!(error_of(&hyperspace), FileError::UnsupportedDimension { .. }));
    let mixed = good.replace("\"dimension\": 2", "\"dimension\": 3");
    assert!(matches!(error_of(&mixed), FileError::WrongType { .. }));
    for text in ["[]", "{}", "3", r#"{"format": "something"}"#] {
        assert!(matches!(error_of(text), FileError::WrongFormat { .. }), "{text}");
    }
}

#[test]
fn a_file_cut_anywhere_is_an_error() {
    let text = text_of(&scenes::five_blocks(0.0).unwrap());
    let document = text.trim_end();
    for end in 1..document.len() {
        let error = error_of(&document[..end]);
        assert!(matches!(error, FileError::Truncated { .. }), "cut at {end}: {error}");
    }
}

#[test]
fn a_byte_order_mark_before_the_text_is_no_error() {
    let text = text_of(&scenes::five_blocks(0.0).unwrap());
    assert_eq!(io::from_json(&format!("\u{feff}{text}"), "marked").unwrap().to_json(), text);
}

#[test]
fn an_empty_file_is_said_to_be_empty() {
    for text in ["", " \n\n"] {
        assert!(matches!(error_of(text), FileError::Empty { .. }), "{}", error_of(text));
    }
}

#[test]
fn text_that_is_not_json_tells_the_place() {
    let text = with_bodies("").replace("0.5", "NaN");
    let error = error_of(&text);
    assert!(matches!(error, FileError::Syntax { line: 2, .. }), "{error:?}");
    assert!(error.to_string().contains("give finite numbers"), "{error}");
    let elsewhere = error_of("<html>\nNaN");
    assert!(!elsewhere.to_string().contains("give finite numbers"), "{elsewhere}");
    // JSON allows it, a double does not.
    assert!(matches!(error_of(&text.replace("NaN", "1e999")), FileError::Syntax { .. }));
}

#[test]
fn a_field_given_twice_is_refused() {
    for (once, twice) in
        [("\"friction\": 0.5", "\"friction\": 0.1, \"friction\": 0.5"), ("\"box\"", "\"box\": 1, \"box\"")]
    {
        let text = with_bodies(r#"{"box": {"size": [1.0, 1.0]}}"#);
        assert!(text.contains(once), "{text}");
        let error = error_of(&text.replacen(once, twice, 1));
        assert!(error.to_string().contains("is given twice"), "{error}");
    }
}

#[test]
fn saving_replaces_a_file_and_leaves_nothing_else() {
    let folder = folder("replace");
    let path = folder.join("scene.json");
    let scene = scenes::five_blocks(0.0).unwrap();
    fs::write(&path, "old").unwrap();
    io::save(&scene.clone().into(), &path).unwrap();
    assert_eq!(io::load(&path).unwrap(), scene.clone().into());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_failed_save_leaves_nothing_half_written() {
    let folder = folder("fail");
    // The name is taken by a folder that is not empty, so the last step must fail.
    let path = folder.join("scene.json");
    fs::create_dir_all(path.join("inside")).unwrap();
    let error = io::save(&scenes::five_blocks(0.0).unwrap().into(), &path).unwrap_err();
    assert!(matches!(&error, SceneError::File(FileError::Write { .. })), "{error}");
    assert!(path.join("inside").is_dir());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    let nowhere = folder.join("missing").join("scene.json");
    assert!(io::save(&scenes::five_blocks(0.0).unwrap().into(), nowhere).is_err());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = io::load("no/such/file.json").unwrap_err().to_string();
    assert!(error.starts_with("no/such/file.json: cannot be read"), "{error}");
}

/// The names under "properties", sorted as the map has them.
fn properties(schema: &Value) -> Vec<String> {
    schema["properties"].as_object().unwrap().keys().cloned().collect()
}

/// The fields that the reader allows in a place, as its error for an unknown one lists them.
fn allowed(text: &str) -> Vec<String> {
    let FileError::UnknownField { allowed, .. } = error_of(text) else { panic!("{text}") };
    let mut names: Vec<String> = allowed.split(", ").map(str::to_owned).collect();
    names.sort();
    names
}

#[test]
fn the_schema_knows_the_fields_that_are_read_and_written() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene.schema.json");
    let schema: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let bodies = [&schema["$defs"]["body"], &schema["$defs"]["bodyInSpace"]];
    let top = with_bodies("").replacen('{', r#"{"other": 0,"#, 1);
    assert_eq!(allowed(&top), properties(&schema));
    for (body, shapes, dimension) in [(bodies[0], ["box", "polygon"], 2), (bodies[1], ["box", "solid"], 3)] {
        let text = |of: &str| if dimension == 2 { with_bodies(of) } else { with_solids(of) };
        assert_eq!(allowed(&text(r#"{"other": 0}"#)), properties(body));
        for shape in shapes {
            let text = text(&format!(r#"{{"{shape}": {{"other": 0}}}}"#));
            assert_eq!(allowed(&text), properties(&body["properties"][shape]));
        }
    }
    let required = |document: &Value| {
        let names = schema["required"].as_array().unwrap();
        names.iter().all(|name| document.get(name.as_str().unwrap()).is_some())
    };
    for entry in scenes::catalogue() {
        let scene = scenes::build(entry.name, &BTreeMap::new()).unwrap();
        let document: Value = serde_json::from_str(&scene.to_json()).unwrap();
        assert!(required(&document));
        for name in document.as_object().unwrap().keys() {
            assert!(properties(&schema).contains(name), "{name}");
        }
        for one in document["bodies"].as_array().unwrap() {
            for name in one.as_object().unwrap().keys() {
                assert!(properties(bodies[scene.dimension() - 2]).contains(name), "{name}");
            }
        }
    }
}
