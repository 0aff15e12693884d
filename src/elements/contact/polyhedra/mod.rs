//! Convex polyhedra against each other: corners, edges and faces of both.
//!
//! The force follows from one number, how deep two are in each other ([`depth`]), which `overlap` finds from the solid they
//! have in common: N = k D (1 + d Ḋ) along −∂D by the motion of either body. So it is opposite on the two, and elastic contact
//! stores ½ k D². `pose` says where they lie and how far they are apart, `pair` what acts between two, `rubbing` their
//! friction and `memory` what it remembers, `update` goes from step to step, `tangent` is what the matrix sees of it, `steps` bounds the
//! steps. `pairs` are many against one, which `block` shows to the equations, `heap` many among themselves, with `heap_block` and
//! `heap_steps`.

mod block;
mod depth;
mod heap;
mod heap_block;
mod heap_steps;
mod memory;
mod overlap;
mod pair;
mod pairs;
mod pose;
mod rubbing;
mod steps;
mod tangent;
mod update;

pub use depth::{Depth, depth};
pub use heap::PolyhedronHeap;
pub use heap_steps::{heap_gap, heap_resultant, last_heap_gap, longest_heap_step, misses_heap};
pub use pair::{CarriedPolyhedron, TouchingPolyhedron};
pub use pairs::PolyhedronPairs;
pub use pose::PolyhedronPose;
pub use steps::{longest_pair_step, misses_pair};
