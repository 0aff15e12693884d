//! All tests of the crate in one program: each idea is a module, and generic code of the crate is compiled once for all.
//!
//! `cargo test --test all solve::explicit::` runs one module. Who may import whom is held by `architecture`, a program of its own.

mod allocations;
mod command;
mod contact;
mod decks;
mod docs;
mod import;
mod linear;
mod mechanics;
mod mesh;
mod messages;
mod model;
mod properties;
mod remedies;
mod results;
mod scene;
mod solve;
mod structures;
mod study;
mod support;
mod sweep;
