//! Boxes against a box: corners, edges and faces of both.
//!
//! The force follows from one number, how deep the boxes are in each other ([`depth`]), which `overlap` finds from the solid they
//! have in common: N = k D (1 + d Ḋ) along −∂D by the motion of either body. So it is opposite on the two, and elastic contact
//! stores ½ k D². `pose` says where the boxes lie and how far they are apart, `pair` what acts between them, `rubbing` their
//! friction and `memory` what it remembers, `update` goes from step to step, `block` is what the equations see, `steps` bounds the
//! steps.

mod block;
mod depth;
mod memory;
mod overlap;
mod pair;
mod pose;
mod rubbing;
mod steps;
mod update;

pub use depth::{Depth, depth};
pub use pair::{BoxPairs, TouchingBox};
pub use pose::BoxPose;
pub use steps::{longest_pair_step, misses_pair};
