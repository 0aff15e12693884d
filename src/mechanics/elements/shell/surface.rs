//! The undeformed surface of an element: axes, slopes, integration points.

use super::camber::Camber;
use super::interpolation::Interpolation;
use super::nodal_vectors::{NodalVectors, sum};
use base::math::Vec3;
use nalgebra::Vector2;
use std::array::from_fn;

/// An integration point of the undeformed surface.
#[derive(Clone, Copy)]
pub struct SurfacePoint<const V: usize> {
    /// Area that belongs to it.
    pub weight: f64,
    /// Coefficients of the slopes v in x,₁ and x,₂, along the axes of the centre rotated into the tangent plane by the least
    /// rotation.
    pub slopes: [[f64; V]; 2],
    /// ∂(ξ, η)/∂(s₁, s₂) by rows of 1, 2.
    pub inverse: [[f64; 2]; 2],
    /// (ξ, η).
    pub at: [f64; 2],
}

/// An undeformed element.
pub struct ElementSurface<const N: usize, const V: usize> {
    /// Positions of the nodes from that of the first.
    pub X: [Vec3; N],
    /// Axes at the centre: two in the tangent plane, and the normal.
    pub axes: [Vec3; 3],
    /// The slopes v_i = Σ slopes[i][a] x_a: x,₁ and x,₂ at the centre and, in the quadrilateral, the bilinear part, divided by `size`. They
    /// are of the order of one whatever the shape of the element, and so are products of them.
    pub slopes: [[f64; N]; V],
    /// S of [`super::arc`] by those slopes.
    pub arc: [[f64; 2]; 2],
    /// By those slopes too.
    pub camber: Camber<f64>,
    /// Integration points.
    pub points: [SurfacePoint<V>; N],
    /// Area.
    pub area: f64,
}

/// Axes at the centre: two in the tangent plane, and the normal. The first lies along the longest way through the element, so
/// that strains of slivers keep their digits.
fn axes<K: Interpolation<N, V, P>, const N: usize, const V: usize, const P: usize>(v: &[Vec3; V]) -> [Vec3; 3] {
    let [a, b] = K::slopes(K::CENTRE).map(|s| sum(&s, v));
    let normal = a.cross(&b).normalize();
    let longest = [b, a + b, a - b].into_iter().fold(a, |long, c| if c.norm() > 1.5 * long.norm() { c } else { long });
    let first = longest.normalize();
    [first, normal.cross(&first), normal]
}

/// Slopes along two tangents `t`: J_αi = x,α·t_i and its inverse.
fn jacobian(tangents: &[Vec3; 2], t: &[Vec3; 2]) -> [[[f64; 2]; 2]; 2] {
    let J = tangents.map(|a| t.map(|t| a.dot(&t)));
    let det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    [J, [[J[1][1] / det, -J[0][1] / det], [-J[1][0] / det, J[0][0] / det]]]
}

impl<const N: usize, const V: usize> ElementSurface<N, V> {
    /// The surface of an element with its corners at `X`.
    pub fn new<K: Interpolation<N, V, P>, const P: usize>(X: [Vec3; N]) -> Self {
        let v = NodalVectors::slopes(&K::SLOPES, &X);
        let axes = axes::<K, N, V, P>(&v);
        let centre = K::slopes(K::CENTRE).map(|s| sum(&s, &v));
        let [J, inverse] = jacobian(&centre, &[axes[0], axes[1]]);
        let size = centre[0].norm().max(centre[1].norm());
        let slopes = from_fn(|i| {
            from_fn(|a| match i {
                0 | 1 => inverse[i][0] * K::SLOPES[0][a] + inverse[i][1] * K::SLOPES[1][a],
                _ => K::SLOPES[i][a] / size,
            })
        });
        let arc =
            from_fn(|i| from_fn(|j| (0..4).map(|k| J[k / 2][i] * K::ARC[k / 2][k % 2] * J[k % 2][j]).sum::<f64>()));
        let mut surface = ElementSurface {
            X,
            axes,
            slopes,
            arc,
            camber: Camber::new::<K, N, V, P>(&J, &inverse),
            points: [SurfacePoint { weight: 0.0, slopes: [[0.0; V]; 2], inverse: [[0.0; 2]; 2], at: [0.0; 2] }; N],
            area: 0.0,
        };
        surface.points = K::POINTS.map(|at| surface.point::<K, P>(at));
        surface.points.iter_mut().for_each(|p| p.weight *= K::AREA / N as f64);
        surface.area = surface.points.iter().map(|p| p.weight).sum();
        surface
    }

    /// The point (ξ, η), with the area of a unit of ξ times a unit of η.
    pub fn point<K: Interpolation<N, V, P>, const P: usize>(&self, at: [f64; 2]) -> SurfacePoint<V> {
        let v = NodalVectors::slopes(&K::SLOPES, &self.X);
        let axes = &self.axes;
        let centre = K::slopes(K::CENTRE).map(|s| sum(&s, &v));
        let [J, _] = jacobian(&centre, &[axes[0], axes[1]]);
        let size = centre[0].norm().max(centre[1].norm());
        let by_coordinates = K::slopes(at);
        let [a, b] = by_coordinates.map(|s| sum(&s, &v));
        let area = a.cross(&b);
        let [_, inverse] = jacobian(&[a, b], &self.tangents(&area.normalize()));
        let slopes = inverse.map(|i| {
            let by: [f64; V] = from_fn(|k| i[0] * by_coordinates[0][k] + i[1] * by_coordinates[1][k]);
            from_fn(|k| match k {
                0 | 1 => by[0] * J[0][k] + by[1] * J[1][k],
                _ => by[k] * size,
            })
        });
        SurfacePoint { weight: area.norm(), slopes, inverse, at }
    }

    /// The axes in the plane, turned by the least rotation until they are normal to `normal`.
    pub fn tangents(&self, normal: &Vec3) -> [Vec3; 2] {
        let tilt = self.axes[2] + normal;
        [0, 1].map(|i| self.axes[i] - self.axes[i].dot(normal) / (1.0 + self.axes[2].dot(normal)) * tilt)
    }

    /// A point in the plane of the axes, from the first node.
    pub fn flat(&self, x: &Vec3) -> Vector2<f64> {
        Vector2::new(x.dot(&self.axes[0]), x.dot(&self.axes[1]))
    }
}
