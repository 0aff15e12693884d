//! Shells: what every element must do, and the benchmarks of Sze, Liu & Lo (2004) and MacNeal & Harder (1985).

mod benchmarks;
mod boxes;
mod curved;
mod curved_linear;
mod curved_scenes;
mod dynamics;
mod element;
mod frequencies;
mod linear;
mod linear_beams;
mod loads;
mod membrane;
mod plastic_beams;
mod pressure;
mod results;
mod slivers;
mod stretched;
mod symmetry;
mod sze;
mod sze_tables;
mod torsion;
