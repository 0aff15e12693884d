//! The undeformed surface of a curved element.

use base::math::Vec3;
use base::math::curved_faces::CurvedFace;
use nalgebra::Matrix3;

/// A point of the undeformed surface.
#[derive(Clone, Copy)]
pub struct CurvedPoint {
    /// Area of a unit of r times a unit of s.
    pub area: f64,
    /// Components of x,r and x,s along the axes: those of the centre, turned into the tangent plane by the least rotation.
    pub jacobian: [[f64; 2]; 2],
    /// ∂(r, s)/∂(s₁, s₂) by rows of 1, 2.
    pub inverse: [[f64; 2]; 2],
}

impl CurvedPoint {
    /// ε₁, ε₂, γ₁₂ from ε_rr, ε_ss, γ_rs.
    pub fn along_axes(self) -> Matrix3<f64> {
        let [[a, b], [c, d]] = self.inverse;
        Matrix3::new(a * a, b * b, a * b, c * c, d * d, c * d, 2.0 * a * c, 2.0 * b * d, a * d + b * c)
    }

    /// ε_rr, ε_ss, γ_rs from ε₁, ε₂, γ₁₂.
    pub fn along_coordinates(self) -> Matrix3<f64> {
        let [[a, b], [c, d]] = self.jacobian;
        Matrix3::new(a * a, b * b, a * b, c * c, d * d, c * d, 2.0 * a * c, 2.0 * b * d, a * d + b * c)
    }
}

/// An undeformed curved element.
pub struct CurvedSurface<const N: usize> {
    /// Positions of the nodes from that of the first.
    pub X: [Vec3; N],
    /// Axes at the centre: two in the tangent plane, and the normal. The first lies along the longest way through the element.
    pub axes: [Vec3; 3],
}

impl<const N: usize> CurvedSurface<N> {
    /// The surface of an element with its nodes at `X`.
    pub fn new<K: CurvedFace<N>>(X: [Vec3; N]) -> Self {
        let centre = if K::CORNERS == 3 { [1.0 / 3.0; 2] } else { [0.0; 2] };
        let [a, b] = tangents::<K, N>(&X, centre);
        let normal = a.cross(&b).normalize();
        let longest =
            [b, a + b, a - b].into_iter().fold(a, |long, c| if c.norm() > 1.5 * long.norm() { c } else { long });
        let first = longest.normalize();
        CurvedSurface { X, axes: [first, normal.cross(&first), normal] }
    }

    /// The axes in the plane, turned by the least rotation until they are normal to `normal`.
    pub fn turned(&self, normal: &Vec3) -> [Vec3; 2] {
        let tilt = self.axes[2] + normal;
        // A surface that is turned over against its centre has no least rotation; its axes are those of the centre.
        let scale = (1.0 + self.axes[2].dot(normal)).max(1e-9).recip();
        [0, 1].map(|i| self.axes[i] - self.axes[i].dot(normal) * scale * tilt)
    }

    /// The point (r, s).
    pub fn point<K: CurvedFace<N>>(&self, at: [f64; 2]) -> CurvedPoint {
        let by = tangents::<K, N>(&self.X, at);
        let across = by[0].cross(&by[1]);
        let axes = self.turned(&across.try_normalize(0.0).unwrap_or(self.axes[2]));
        let J = by.map(|a| axes.map(|t| a.dot(&t)));
        let det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
        let inverse = [[J[1][1] / det, -J[0][1] / det], [-J[1][0] / det, J[0][0] / det]];
        CurvedPoint { area: across.norm(), jacobian: J, inverse }
    }

    /// The largest distance of a node from the plane through the corners' mean, along the normal at the centre.
    pub fn rise(&self) -> f64 {
        let heights = self.X.map(|x| x.dot(&self.axes[2]));
        let (low, high) = heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &z| (a.min(z), b.max(z)));
        high - low
    }
}

/// x,r and x,s at a point.
pub fn tangents<K: CurvedFace<N>, const N: usize>(x: &[Vec3; N], at: [f64; 2]) -> [Vec3; 2] {
    K::slopes(at).map(|by| (0..N).map(|a| by[a] * x[a]).sum())
}
