//! Vectors and matrices of fixed size, rotations, quadrature rules.

pub mod convex;
pub mod cubic_curve;
pub mod curved_faces;
pub mod cylinder;
#[cfg(feature = "portable")]
mod elementary;
pub mod face_foot;
pub mod lanes;
pub mod number;
pub mod polyhedron;
pub mod quadrature;
pub mod quintic;
pub mod rotation;
pub mod turn;

/// Column vector of three numbers.
pub type Vec3 = nalgebra::Vector3<f64>;
/// Matrix of 3×3 numbers.
pub type Mat3 = nalgebra::Matrix3<f64>;
/// Column vector of six numbers: translation, then rotation.
pub type Vec6 = nalgebra::Vector6<f64>;
/// Matrix of 6×6 numbers over translations and rotations.
pub type Mat6 = nalgebra::Matrix6<f64>;

/// The largest length that is taken: its fifth power, a moment of inertia, and products of such are numbers yet.
pub const LARGEST_LENGTH: f64 = 1e30;

/// a b + c, rounded once where the target has such an instruction; a library call in its place would be slow.
#[inline(always)]
pub fn fma(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
}

/// The larger of two numbers, or `a` where `b` is not a number. It compiles to one instruction; `f64::max` handles NaN and compiles to
/// four.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The matrix of the vector product: `skew(a) b = a × b` (20).
#[inline]
pub fn skew(a: &Vec3) -> Mat3 {
    Mat3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}

/// The six components (a, b) of a translational and a rotational vector.
#[inline]
pub fn stack(a: &Vec3, b: &Vec3) -> Vec6 {
    Vec6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// The first three components: displacement, velocity, acceleration or force of a six-vector.
#[inline]
pub fn linear(a: &Vec6) -> Vec3 {
    Vec3::new(a[0], a[1], a[2])
}

/// The last three components: rotation, angular velocity or acceleration, or moment of a six-vector.
#[inline]
pub fn angular(a: &Vec6) -> Vec3 {
    Vec3::new(a[3], a[4], a[5])
}

/// A frame whose third axis is the given unit vector.
pub fn frame_along(axis: &Vec3) -> Mat3 {
    let x = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
    Mat3::from_columns(&[x, axis.cross(&x), *axis])
}
