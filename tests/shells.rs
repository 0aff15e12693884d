//! Shells: what every element must do, and the benchmarks of Sze, Liu & Lo (2004) and MacNeal & Harder (1985).

#[path = "shells/benchmarks.rs"]
mod benchmarks;
#[path = "shells/dynamics.rs"]
mod dynamics;
#[path = "shells/element.rs"]
mod element;
#[path = "shells/frequencies.rs"]
mod frequencies;
#[path = "shells/linear.rs"]
mod linear;
#[path = "shells/linear_beams.rs"]
mod linear_beams;
#[path = "shells/loads.rs"]
mod loads;
#[path = "shells/pressure.rs"]
mod pressure;
#[path = "shells/results.rs"]
mod results;
mod support;
#[path = "shells/symmetry.rs"]
mod symmetry;
