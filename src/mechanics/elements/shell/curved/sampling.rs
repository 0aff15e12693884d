//! Where the strains of a curved element are taken, and how they are interpolated between these places.

use super::surface::CurvedSurface;
use crate::elements::shell::geometry::Plate;
use crate::elements::shell::plane_strains::PointStrains;
use base::math::curved_faces::CurvedFace;

/// The places where strains are taken: V slopes of the surface, P products of them, Q transverse shears.
pub struct Sampling<const N: usize, const V: usize, const P: usize, const Q: usize> {
    /// The slopes v_i = Σ slopes[i][a] x_a.
    pub slopes: [[f64; N]; V],
    /// Which slopes are multiplied: ½ v_i·v_i or v_i·v_j.
    pub pairs: [[usize; 2]; P],
    /// Shears v·d, by the coefficients of the nodes in the slope v and in the director d.
    pub shears: [[[f64; N]; 2]; Q],
}

/// How strains follow from those that are taken: P in the plane, Q transverse shears.
pub trait CurvedStrains<const N: usize, const V: usize, const P: usize, const Q: usize>: CurvedFace<N> {
    /// The sampling places of an element, chosen by its shape.
    fn sampling(surface: &CurvedSurface<N>, thickness: f64) -> &'static Sampling<N, V, P, Q>;
    /// Strains at the integration points, of the membrane from products of slopes, and of bending likewise.
    fn strains(surface: &CurvedSurface<N>, plate: &Plate) -> Vec<PointStrains<P, P>>;
    /// The coefficients of the shears in those along r and s at a point.
    fn shear(at: [f64; 2]) -> [[f64; Q]; 2];
}
