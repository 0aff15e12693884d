//! Unilateral contact: points, with a radius or without, that touch a surface carried by a node.
//!
//! A penalty spring pushes points out, f = k δ (1 + d δ̇) n, with δ from the exact distance ([`surfaces`]) and d from the restitution
//! ([`restitution`]). Friction is a spring that slips ([`friction`]). The equations use p = Rᵀ(x − x_s) and the relative rotation φ in the
//! frame of the surface, and are therefore objective. With F and M the force and moment on the point,
//!
//! ```text
//!  F = N n − T,   M = r n × T,   virtual work F·δp + M·δφ,   δp = Rᵀ(δx − δx_s + (x − x_s) × δθ_s),   δφ = Rᵀ(δθ − δθ_s)
//! ```
//!
//! which gives the forces on both sides, in balance, and the tangent. A point between nodes is a weighted sum of theirs, and
//! its force and moment go to them by the same weights. Closed forms do for these surfaces: normals and curvature are
//! exact, nothing is iterated, and a general collision library would bring neither.
//!
//! Points against a surface:
//! - `surfaces` find the closest point, one file per shape; `kinematics` computes position and motion of a point against it.
//! - `force` computes the force on a point, `tangent` its derivatives.
//! - `block` is the element block, `steps` limits the step length.
//! - `corners` selects the nodes of a mesh that press on a solid; `multipliers` replaces springs in load steps without penetration.
//!
//! `convex` holds contact between boxes, hulls, cylinders and capsules; `facets` contact with shells, beams and balls. All three share
//! - `pair_block`, the interface of a block of pairs;
//! - `law` and `restitution`, the normal force, and `friction`, the tangential force;
//! - `history`, the memory of a pair, written by `normal_motion`;
//! - `near_lists` and `grid`, the search, `segments`, the nearest points of two lines, and `gap`, the distance.

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
