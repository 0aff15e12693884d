//! Contact with surfaces of facets: the faces of shells, beams by their radius, and balls among themselves.
//!
//! The distance d from a point to the middle surface of a facet is compared with their reach, the radius plus half the thickness. They
//! touch for d below the reach. The force has the potential ½ k δ², δ = reach − d, with d from the nearest point of the deformed surface,
//! and is thus conservative. It acts on the point and, by the shares of the nearest point, on the nodes of the facet; linear and angular
//! momentum are conserved to rounding. Facets of one plane are one plane: nothing that slides over them feels their edges. A point that has
//! come through to the other side is still pushed back to its own. In a load step a point that crosses a shallow fold stays on the plane of its
//! facet until the end of the step, so that the iteration meets no kink.
//!
//! Two lines touch between their nearest points, anywhere along both. Edges of solids touch only where they cross, because their corners
//! are separate points.
//!
//! - Geometry: `facet`, `lines`, `mesh` (connectivity), `facing` (sides).
//! - Search: `scene` (pairs that may touch), `nearby`, `touch` (facets that count), `found` (one of them), `balls`.
//! - Forces: `pair`, `force`, `line_friction`, `crossing` (edges with separate ends), `tangent`.
//! - History: `memory`, `update`.
//! - Interfaces: `block` (element block), `steps` (limits on the step length), `gap` (output).

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
