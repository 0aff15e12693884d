//! Stub: replaced at merge.
use super::{Mat3, Vec3};
use nalgebra::{Quaternion, UnitQuaternion};

pub fn log(q: &Quaternion<f64>) -> Vec3 {
    let q = if q.w < 0.0 { -q } else { *q };
    let v = Vec3::new(q.i, q.j, q.k);
    let s = v.norm();
    if s < 1e-8 { 2.0 / q.w * v } else { (2.0 * s.atan2(q.w) / s) * v }
}

pub fn matrix(q: &Quaternion<f64>) -> Mat3 {
    *UnitQuaternion::new_unchecked(*q).to_rotation_matrix().matrix()
}
