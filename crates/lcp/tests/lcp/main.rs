//! Tests of the solver crate by topic, in one binary. Answers are checked from `M` and `q` alone (`verify`).

mod bad_input;
mod block;
mod brute_force;
mod contact;
mod copies;
mod cycling;
mod doubt;
mod follow;
mod growing;
mod interior;
mod lemke_reuse;
mod masked;
mod problems;
mod random;
mod reuse;
mod sequences;
mod textbook;
mod verify;
mod worst_case;
