//! Shells of directors: triangles of three nodes and quadrilaterals of four, at large displacements and rotations.
//!
//! A point of the reference surface has a position x and a director d, both interpolated from the nodes, where
//! d_a = R_a D_a. Strains are Green's, linear through the thickness, less their values at t = 0:
//!   membrane ½ x,α·x,β    bending ½ (x,α·d,β + x,β·d,α)    shear x,α·d    drilling ½ (t₁·x,₂ − t₂·x,₁),
//! with t₁, t₂ tangents that turn with the nodes: the difference between their rotation about the normal and that of the
//! surface (Hughes & Brezzi 1989), which vanishes in rigid motions and wherever the surface stretches without it. All are
//! polynomials in positions and directors, so they are objective, and no frame goes along: of second degree but for bending,
//! which [`arc`] takes by angles instead of chords, and for the bulge of [`edge`]s.
//!
//! An element that bends in its plane has curved sides. Nodes that drill curve the adjacent edges, and constant stress feels it:
//! with straight edges tapering quadrilaterals and triangles are twenty times too stiff. That is for flat surfaces: where they
//! are curved, drilling by bending alone would lock thin shells, and edges stay straight. The strain of an element is
//! described by a few numbers, [`plane_strains`]: in the plane products of slopes and the bulges of edges, from which the strain at
//! its integration points follows linearly, by the stress modes of a [`hybrid`] for the quadrilateral and by Felippa's
//! template for the triangle, [`deviatoric`]. Transverse shear is taken at the middles of the edges (Dvorkin & Bathe 1984; Lee &
//! Bathe 2004). With ε these numbers, energy is U(ε), the gradient Bᵀσ, the Hessian BᵀCB + σ·∂²ε. A spatial rotation δθ changes a
//! director by δθ × d.
//!
//! Where the material yields, the strain at a point of the element follows from the same numbers as in the elastic element, so that
//! only the layers themselves need iteration and history variables.
//! Elements of six and nine nodes, with sides of second degree, stand in [`curved`].
//! Left out: change of thickness, curvature in the volume element (h/R against 1), initial stress.

mod arc;
mod block;
mod camber;
mod curved;
mod deviatoric;
mod edge;
mod edge_bending;
mod edge_bubbles;
mod geometry;
mod hybrid;
mod in_plane;
mod integrals;
mod interpolation;
mod lane_matrix;
mod layers;
mod nodal_vectors;
mod pack;
mod plane_strains;
mod results;
mod rolled_edges;
mod section;
mod stretch;
mod surface;
mod tangent;

pub use super::results::MOST_LAYERS;
pub use crate::elements::pressure::MOST_NODES;
pub use base::math::curved_faces::{NineNodes, SixNodes};
pub use curved::{CurvedQuadrilaterals, CurvedShells, CurvedTriangles};
pub use geometry::{FLAT, Plate, SLENDER, ShellGeometry};
pub use integrals::{faces, lumped_shares, products, shares};
pub use interpolation::{Interpolation, Quadrilateral, Triangle};
pub use layers::LayerModel;
pub use pack::{Quadrilaterals, Shells, Triangles};
pub use plane_strains::PlaneStrains;
pub use results::result_axes;
pub use section::ShellStiffness;

/// Stiffness of drilling that strains do not feel, as a part of shear modulus times thickness: of the mean over an element, and of
/// nodes by turns. From a fifth to five times of it the deflection of the hemisphere changes by 4e-4 and −1.7e-3. With less, nodes
/// rotate about their normals by whole turns in large load steps, to equilibria that are none of the surface's.
pub const DRILLING: f64 = 2e-2;
