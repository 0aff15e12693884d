//! Quaternions as four numbers (w, x, y, z), for the kernels of the beam.

use crate::math::{Mat3, Vec3};

/// A quaternion (w, x, y, z).
pub type Quat = [f64; 4];

/// a·b of all four numbers.
#[inline(always)]
pub fn dot(a: &Quat, b: &Quat) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// The quaternion product a b.
#[inline(always)]
pub fn multiply(a: &Quat, b: &Quat) -> Quat {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// v q for a vector v.
#[inline(always)]
pub fn left(v: &Vec3, q: &Quat) -> Quat {
    multiply(&[0.0, v.x, v.y, v.z], q)
}

/// q v for a vector v.
#[inline(always)]
pub fn right(q: &Quat, v: &Vec3) -> Quat {
    multiply(q, &[0.0, v.x, v.y, v.z])
}

/// q e_i.
#[inline(always)]
pub fn right_unit(q: &Quat, i: usize) -> Quat {
    let [w, x, y, z] = *q;
    match i {
        0 => [-x, w, z, -y],
        1 => [-y, -z, w, x],
        _ => [-z, y, -x, w],
    }
}

/// a b̄: scalar and vector part.
#[inline(always)]
pub fn times_conjugate(a: &Quat, b: &Quat) -> (f64, Vec3) {
    let c = multiply(a, &[b[0], -b[1], -b[2], -b[3]]);
    (c[0], Vec3::new(c[1], c[2], c[3]))
}

/// ∂q/∂δθ_i = ½ e_i q.
#[inline(always)]
pub fn rotation_columns(q: &Quat) -> [Quat; 3] {
    let [w, x, y, z] = q.map(|c| 0.5 * c);
    [[-x, w, -z, y], [-y, z, w, -x], [-z, -y, x, w]]
}

/// Rotation matrix of p/|p|; `inv` is 1/|p|².
#[inline(always)]
pub fn rotation(p: &Quat, inv: f64) -> Mat3 {
    let [w, x, y, z] = *p;
    let s = 2.0 * inv;
    Mat3::new(
        1.0 - s * (y * y + z * z),
        s * (x * y - w * z),
        s * (x * z + w * y),
        s * (x * y + w * z),
        1.0 - s * (x * x + z * z),
        s * (y * z - w * x),
        s * (x * z - w * y),
        s * (y * z + w * x),
        1.0 - s * (x * x + y * y),
    )
}
