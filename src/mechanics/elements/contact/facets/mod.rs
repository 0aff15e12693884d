//! Contact with surfaces of facets: the faces of shells, beams by their radius, and balls among themselves.
//!
//! Two things touch where the distance d of a point from the middle of a facet is less than their reach, the radius of the point and
//! half the thickness of the facet. The force has the potential ½ k δ², δ = reach − d, d from the nearest point of the surface as it
//! is, and so gives back what was put in; it acts on the point and, by the shares of the nearest point, on the nodes of the facet, so
//! that linear and angular momentum are kept to rounding. Facets of one plane are one plane: nothing that slides over them feels
//! their edges. A point that has come through to the other side is still pushed back to its own.
//!
//! Lines that touch lines do so where they are nearest to each other, wherever that is on both; edges of solids do where they cross, for their
//! corners are points.
//!
//! `facet` is the geometry, `lines` that of two lines, `line_friction` how they rub, `crossing` edges whose ends touch for themselves, `mesh` how facets hang together, `scene` who may touch whom, `nearby` finds what is near, `touch` says which facets count, `found` is such a one, `balls` what is simpler of balls,
//! `facing` what tells on which side a point is, `pair` two of them, `force` what acts between them, `memory` and `update` what they remember, `tangent` the derivatives; `block` is what the equations
//! see, `steps` bounds the steps, `gap` is what is shown.

mod balls;
mod block;
mod crossing;
mod facet;
mod facing;
mod force;
mod found;
mod gap;
mod line_friction;
mod lines;
mod memory;
mod mesh;
mod nearby;
mod pair;
mod scene;
mod span;
mod steps;
mod surface;
mod tangent;
mod touch;
mod update;

pub use facet::{Facet, MOST_CORNERS};
pub use gap::{facet_gap, is_own};
pub use mesh::free_edges;
pub use scene::FacetTouchers;
pub use surface::FacetContacts;
