//! The bytes of a snapshot are a world or a typed error, and a world makes a step or says why not.

#![no_main]

use drystone::{
    geometry::{Polygon, Solid},
    simulate::{World, snapshot_dimension},
};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match snapshot_dimension(bytes) {
        Ok(2) => drop(World::<Polygon>::restore(bytes).map(|mut world| world.step())),
        Ok(_) => drop(World::<Solid>::restore(bytes).map(|mut world| world.step())),
        Err(_) => {}
    }
});
