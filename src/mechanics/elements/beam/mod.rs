//! Geometrically exact, shear-flexible beam (Simo-Reissner) with N nodes on a straight, stress-free axis.
//!
//! Strains in the undeformed section axes: Γ = Rᵀ r′ − r₀′ and κ = axial(Rᵀ R′) (Simo & Vu-Quoc 1986), R measured from the undeformed
//! state. The Lagrange polynomials of the N Lobatto points interpolate positions and rotation quaternions, p = Σ N_a q_a, and R = R(p/|p|).
//! The interpolation is frame-invariant and independent of the path. It has no singularities up to a bend of half a turn, and is polynomial
//! except for |p|². Integration by N − 1 Gauss points prevents locking and makes it a mixed method. End nodes converge as h^(2N−2), and for
//! N ≥ 3 small loads at nodes give exact nodal displacements. For N = 2 the shear flexibility is raised by h²/12EI (MacNeal 1978). The
//! small-strain stiffness is then that of the exact beam in the corotating mean frame of its ends.
//!
//! All derivatives are taken in the eleven numbers z = (p, p′, r′) of a Gauss point, with energy U(z) = ½ ε·C·ε, gradient g = Bᵀσ and
//! Hessian H = BᵀCB + σ·∂²ε. Nodes enter linearly through the shape functions; a spatial rotation δθ of node a changes its quaternion by ½
//! δθ q_a. Left out: warping of the section, initial curvature.

mod block;
mod build;
mod composite;
mod fibre_lanes;
mod fibre_sum;
mod fibres;
mod heated;
mod hessian;
mod kinematics;
mod lane_section;
mod quaternion;
mod section;
mod shape;
mod tangent;
mod varied;

pub use build::{BeamGeometry, BeamSetting, FibreModel, elastic_beams};
pub use composite::FibreGroup;
pub use fibre_sum::FibreSum;
pub use section::BeamStiffness;
pub use shape::{IntegrationRule, MOST_POINTS, cubic_deflection};

/// Polynomial order of the elements where the deck does not give it. Measured by `scripts/speed.py --orders`: orders 3 and 4 need the same
/// time for a given error within a factor of two; below an error of 1e-2, orders 1 and 2 need far longer.
pub const DEFAULT_ORDER: usize = 3;
