//! Convex solids against each other: boxes and hulls with corners, edges and faces, cylinders, capsules and spheres.
//!
//! The force follows from the depth of overlap alone ([`depth`]): N = k D (1 + d Ḋ) along −∂D by the motion of either body. So it is
//! opposite on the two, and elastic contact stores ½ k D².
//!
//! - `pose` holds the positions of two solids, `axes` computes their distance.
//! - `touch` computes the depth: by the common `volume` of two polyhedra (`overlap`), by a `cylinder` and a polyhedron (`bore`), by
//!   `two_cylinders`, or along the `segment` of a round solid (`swept`).
//! - `pair` computes the force of a pair, `rubbing` its friction with its `memory`.
//! - `update` advances the history, `tangent` linearizes the force, `steps` limits the step length.
//! - `block` holds many solids against one, `heap` many among themselves, with `heap_block` and `heap_gap`.

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
