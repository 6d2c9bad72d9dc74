//! Tests of the crate of bodies by topic, as its users call it, in one binary. They share a process: none may change its
//! environment, working folder or panic hook.

mod clear_path;
mod cone_walks;
mod contact_invariance;
mod contacts;
mod equilibrium;
mod far_from_origin;
mod forces_along;
mod geometry;
mod holds;
mod interior;
mod io;
mod mass_properties;
mod methods;
mod motion;
mod parted;
mod planning;
mod scene;
mod scenes;
mod seams;
mod settlement;
mod simulation;
mod simulation_acceleration;
mod simulation_in_space;
mod simulation_random;
mod simulation_reuse;
mod simulation_trouble;
mod solids;
mod strong;
mod structure;
mod surfaces;
mod truths;
