//! Unilateral contact: points, with a radius or without, that touch a surface carried by a node.
//!
//! A penalty spring pushes out what is inside, f = k δ (1 + d δ̇) n, δ from the exact distance ([`surfaces`]), d from what an
//! impact gives back ([`restitution`]); friction is a spring that slips ([`friction`]). All of it is written in the frame of
//! the surface, in p = Rᵀ(x − x_s) and in the rotation φ of what touches relative to that frame, and so is objective. With
//! F and M the force and moment on the point,
//!
//! ```text
//!  F = N n − T,   M = r n × T,   virtual work F·δp + M·δφ,   δp = Rᵀ(δx − δx_s + (x − x_s) × δθ_s),   δφ = Rᵀ(δθ − δθ_s)
//! ```
//!
//! which gives the forces on both sides, in balance, and the tangent. A point between nodes is a weighted sum of theirs, and
//! its force and moment go to them by the same weights. Closed forms do for these surfaces: normals and curvature are
//! exact, nothing is iterated, and a general collision library would bring neither.
//!
//! `surfaces` find the closest point, each in a file of its own, `kinematics` where a point lies against the surface and how it moves, `force`
//! what acts on it, `tangent` the derivatives of that; `block` shows it to the equations, and `steps` bounds the steps. `corners` says
//! which nodes of a mesh press a solid that lies on it; `multipliers` put numbers of their own in the place of springs where a load step
//! asks for no depth. `convex` is what boxes, hulls and capsules do to each other, `facets` what shells and balls do to all that touches them.
//!
//! These files serve all three: `pair_block` is what the equations see of any block of pairs; `law` and `restitution` are the normal force,
//! `friction` the force along the surface; `history` is the memory of a pair, and `normal_motion` writes it; `near_lists` and `grid` find
//! what is near, `segments` the nearest points of two lines; `gap` is the distance of what does not touch.

mod block;
pub mod convex;
mod corners;
pub mod facets;
mod force;
pub mod friction;
mod gap;
mod grid;
mod history;
mod kinematics;
mod law;
mod multipliers;
mod near_lists;
mod nearest_corner;
mod normal_motion;
mod pair_block;
mod point;
pub mod restitution;
mod segments;
mod slip;
mod steps;
pub mod surface;
pub mod surfaces;
mod tangent;
mod update;

pub use convex::{ConvexBody, ConvexHeap, ConvexPairs};
pub use facets::{Facet, FacetContacts, FacetTouchers};
pub use gap::{least_gap, pair_gap};
pub use kinematics::Contacts;
pub use law::ContactLaw;
pub use pair_block::{PairAction, PairBlock, PairSide};
pub use point::{ContactPoint, MOST_NODES, TouchKind};
pub use surface::Surface;
pub use surfaces::SurfaceShape;
pub use surfaces::kind::ClosestPoint;
pub use surfaces::sight::{Toucher, passing_width};
