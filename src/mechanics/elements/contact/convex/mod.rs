//! Convex solids against each other: boxes and hulls with corners, edges and faces, cylinders, capsules and spheres.
//!
//! The force follows from one number, how deep two are in each other ([`depth`]): N = k D (1 + d Ḋ) along −∂D by the motion of either
//! body. So it is opposite on the two, and elastic contact stores ½ k D². `pose` says where two lie, and with `axes` how far they are
//! apart; `touch` is the depth wherever they are, by the `volume` of the solid that two polyhedra have in common (`overlap`), or a `cylinder` and a
//! polyhedron (by what of faces lies in its `bore`) or `two_cylinders`, or along the `segment` about which one of the two is round (`swept`). `pair` is what acts between two, `rubbing` their friction and `memory` what it remembers, `update` goes from step to step, `tangent` is what the matrix sees of it, `steps` bounds the
//! steps. `block` are many against one, `heap` many among themselves, with `heap_block` and
//! `heap_gap`.

mod axes;
mod block;
mod bore;
mod cylinder;
mod depth;
mod heap;
mod heap_block;
mod heap_gap;
mod memory;
mod overlap;
mod pair;
mod pose;
mod rim;
mod rubbing;
mod segment;
mod steps;
mod swept;
mod tangent;
mod touch;
mod two_cylinders;
mod update;
mod volume;

pub use block::ConvexPairs;
pub use depth::Depth;
pub use heap::ConvexHeap;
pub use heap_gap::heap_gap;
pub use pair::{CarriedConvex, ConvexBody};
pub use pose::ConvexPose;
pub use touch::depth;
