//! Quaternions as four numbers (w, x, y, z), for the kernels of the beam.

use base::math::number::{LaneVec3, Number};

/// A quaternion (w, x, y, z).
pub type Quat<T = f64> = [T; 4];

/// a·b of all four numbers.
#[inline(always)]
pub fn dot<T: Number>(a: &Quat<T>, b: &Quat<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// The vector part.
#[inline(always)]
pub fn vector<T: Number>(q: &Quat<T>) -> LaneVec3<T> {
    LaneVec3([q[1], q[2], q[3]])
}

/// The quaternion product a b.
#[inline(always)]
pub fn multiply<T: Number>(a: &Quat<T>, b: &Quat<T>) -> Quat<T> {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// v q for a vector v.
#[inline(always)]
pub fn left<T: Number>(LaneVec3([x, y, z]): &LaneVec3<T>, q: &Quat<T>) -> Quat<T> {
    [
        -(*x * q[1]) - *y * q[2] - *z * q[3],
        *x * q[0] + *y * q[3] - *z * q[2],
        *y * q[0] - *x * q[3] + *z * q[1],
        *x * q[2] - *y * q[1] + *z * q[0],
    ]
}

/// q v for a vector v.
#[inline(always)]
pub fn right<T: Number>(q: &Quat<T>, LaneVec3([x, y, z]): &LaneVec3<T>) -> Quat<T> {
    [
        -(q[1] * *x) - q[2] * *y - q[3] * *z,
        q[0] * *x + q[2] * *z - q[3] * *y,
        q[0] * *y - q[1] * *z + q[3] * *x,
        q[0] * *z + q[1] * *y - q[2] * *x,
    ]
}

/// q e_i.
#[inline(always)]
pub fn right_unit<T: Number>(q: &Quat<T>, i: usize) -> Quat<T> {
    let [w, x, y, z] = *q;
    match i {
        0 => [-x, w, z, -y],
        1 => [-y, -z, w, x],
        _ => [-z, y, -x, w],
    }
}

/// a b̄: scalar and vector part.
#[inline(always)]
pub fn times_conjugate<T: Number>(a: &Quat<T>, b: &Quat<T>) -> (T, LaneVec3<T>) {
    let c = multiply(a, &[b[0], -b[1], -b[2], -b[3]]);
    (c[0], vector(&c))
}

/// ∂q/∂δθ_i = ½ e_i q.
#[inline(always)]
pub fn rotation_columns<T: Number>(q: &Quat<T>) -> [Quat<T>; 3] {
    let half = T::splat(0.5);
    let [w, x, y, z] = [half * q[0], half * q[1], half * q[2], half * q[3]];
    [[-x, w, -z, y], [-y, z, w, -x], [-z, -y, x, w]]
}

/// Columns of the rotation matrix of p/|p|; `inv` is 1/|p|².
#[inline(always)]
pub fn rotation<T: Number>(p: &Quat<T>, inv: T) -> [LaneVec3<T>; 3] {
    let [w, x, y, z] = *p;
    let (one, s) = (T::splat(1.0), T::splat(2.0) * inv);
    [
        LaneVec3([one - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)]),
        LaneVec3([s * (x * y - w * z), one - s * (x * x + z * z), s * (y * z + w * x)]),
        LaneVec3([s * (x * z + w * y), s * (y * z - w * x), one - s * (x * x + y * y)]),
    ]
}
