//! The text of a scene file is a scene or a typed error, and a scene is written as what reads back as itself.

#![no_main]

use drystone::io::from_json;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(scene) = from_json(text, "fuzz") else { return };
    let again = from_json(&scene.to_json(), "again").expect("what was written is read");
    assert!(again == scene, "{}", scene.to_json());
});
