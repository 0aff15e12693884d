//! stub
use super::Mat3;
use nalgebra::Quaternion;
pub fn matrix(_: &Quaternion<f64>) -> Mat3 {
    Mat3::identity()
}
