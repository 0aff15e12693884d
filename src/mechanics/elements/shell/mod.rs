//! Shells of directors: triangles of three nodes and quadrilaterals of four, at large displacements and rotations.
//!
//! A point of the reference surface has a position x and a director d, both interpolated from the nodes, where
//! d_a = R_a D_a. Strains are Green's, linear through the thickness, less their values at t = 0:
//!   membrane ½ x,α·x,β    bending ½ (x,α·d,β + x,β·d,α)    shear x,α·d    drilling ½ (t₁·x,₂ − t₂·x,₁),
//! with t₁, t₂ tangents turning with the nodes. Drilling is the difference between their rotation about the normal and the rotation of the
//! surface (Hughes & Brezzi 1989); it vanishes in rigid motion and pure stretch. All are polynomials in positions and directors, hence
//! objective without a co-rotated frame. They are of second degree, except bending, measured by angles ([`arc`]), and the bulge of
//! [`edge`]s.
//!
//! An element that bends in its plane has curved sides. Nodes that drill curve the adjacent edges, and constant stress feels it: with
//! straight edges tapering quadrilaterals and triangles are twenty times too stiff. Only flat surfaces have such edges: on curved ones,
//! drilling by bending alone would lock thin shells, so edges stay straight. A few numbers describe the strain of an element,
//! [`plane_strains`]; in the plane they are products of slopes and the bulges of edges. The strain at an integration point is linear in
//! them: by stress modes for the quadrilateral ([`hybrid`]) and by Felippa's template for the triangle ([`deviatoric`]). Transverse shear
//! is taken at the middles of the edges (Dvorkin & Bathe 1984; Lee & Bathe 2004). With ε these numbers, energy is U(ε), the gradient Bᵀσ,
//! the Hessian BᵀCB + σ·∂²ε. A spatial rotation δθ changes a director by δθ × d.
//!
//! Where the material yields, the strain at a point follows from the same numbers as in the elastic element; only the layers need iteration
//! and history variables. Elements of six and nine nodes, with sides of second degree, stand in [`curved`]. Left out: change of thickness,
//! curvature in the volume element (h/R against 1), initial stress.

mod arc;
mod block;
mod camber;
mod curved;
mod deviatoric;
mod edge;
mod edge_bending;
mod edge_bubbles;
mod geometry;
mod heated;
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
