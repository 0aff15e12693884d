//! All tests of the crate in one program: each idea is a module, and generic code of the crate is compiled once for all.
//!
//! `cargo test --test all explicit::` runs one module. Who may import whom is held by `architecture`, a program of its own.

mod allocations;
mod auto_step;
mod cli;
mod commands;
mod compare;
mod contact;
mod decks;
mod determinism;
mod docs;
mod edges;
mod elements;
mod error_bars;
mod esdirk;
mod explicit;
mod extreme;
mod folders;
mod foreign_input;
mod inside_steps;
mod iterations;
mod joint_forces;
mod joints;
mod left_out;
mod linear;
mod massless;
mod materials;
mod mesh;
mod messages;
mod model;
mod modes;
mod order;
mod output;
mod paths;
mod plasticity;
mod plausibility;
mod properties;
mod records;
mod report;
mod resultants;
mod safety_cab;
mod schemes;
mod shells;
mod small_motions;
mod stability;
mod stages;
mod statics;
mod study;
mod sudden_loads;
mod sweep;
mod table_sizes;
mod turning;

mod scene;
mod structures;
mod support;
