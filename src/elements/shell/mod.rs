//! Shells of directors: triangles of three nodes and quadrilaterals of four, at large displacements and rotations.
//!
//! A point of the reference surface has a position x and a director d, both interpolated from the nodes, where
//! d_a = R_a D_a. Strains are Green's, linear through the thickness, less their values at t = 0:
//!   membrane ½ x,α·x,β    bending ½ (x,α·d,β + x,β·d,α)    shear x,α·d    drilling ½ (t₂·x,₁ − t₁·x,₂),
//! with t₁, t₂ in-plane axes that turn with the nodes: the difference between their rotation about the normal and that of
//! the surface (Hughes & Brezzi 1989), which vanishes in rigid motions and wherever the surface stretches without it.
//! All are polynomials in positions and directors, so they are objective, and no frame goes along: of second degree but for
//! bending, which [`arc`] takes by angles instead of chords.
//!
//! The strain of an element is described by a few numbers. In the plane they are the moments of strain with the stress modes
//! of Pian & Sumihara (1984), five for the quadrilateral (as in Wagner & Gruttmann 2005) and three for the triangle, the same
//! for membrane and bending; they cure in-plane bending and, in warped elements, membrane locking. Transverse shear is taken
//! at the middles of the edges (Dvorkin & Bathe 1984; Lee & Bathe 2004), drilling at each node. Together they are as many as
//! the element has modes of deformation. With ε these numbers, energy is U(ε), the gradient Bᵀσ, the Hessian BᵀCB + σ·∂²ε,
//! and ∂²ε is all but constant in positions and directors. A spatial rotation δθ changes a director by δθ × d.
//!
//! Where the material yields, the strain at a point of the element follows the stress modes of the elastic element, so that
//! only the layers themselves need iteration and history variables.
//! Drilling nodes do not curve the adjacent edges (Allman), though that would cure in-plane bending of distorted elements:
//! membrane forces would then load the rotations, about normals that differ from element to element, and in thin sheets
//! under tension nothing would resist them.
//! Left out: change of thickness, curvature in the volume element (h/R against 1), initial stress.

mod arc;
mod block;
mod geometry;
mod interpolation;
mod kinematics;
mod layers;
mod results;
mod section;
mod tangent;

pub use super::results::MOST_LAYERS;
pub use geometry::{Plate, ShellGeometry, faces, products, shares};
pub use interpolation::{Interpolation, Quadrilateral, Triangle};
pub use kinematics::{Quadrilaterals, Shells, Triangles};
pub use layers::LayerModel;
pub use section::ShellStiffness;

/// Stiffness of drilling, as a part of shear modulus times thickness. From a tenth to ten times of it the deflection of the
/// hemisphere changes by a factor of 1e-3. With less, nodes rotate about their normals by whole turns in large load steps, to
/// equilibria that are none of the surface's.
pub const DRILLING: f64 = 2e-2;
