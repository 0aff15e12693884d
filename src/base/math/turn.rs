//! Rotations given by three numbers, one for each global axis: the components of one rotation vector, or angles of a sequence.

use super::{Vec3, rotation};
use nalgebra::Quaternion;

/// Definition of three rotations about the global axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RotationAngles {
    /// They are the components of one rotation vector.
    #[default]
    Vector,
    /// They are angles of rotations one after the other, about these axes: the first is fixed in space, and each turns those after it.
    Sequence([usize; 3]),
}

/// A rotation and its rates, global components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// The rotation from the body to space.
    pub rotation: Quaternion<f64>,
    /// Angular velocity.
    pub omega: Vec3,
    /// Angular acceleration.
    pub alpha: Vec3,
}

impl RotationAngles {
    /// The rotation of three angles.
    pub fn rotation(self, u: &Vec3) -> Quaternion<f64> {
        self.turn(&[*u, Vec3::zeros(), Vec3::zeros()]).rotation
    }

    /// The rotation of three angles with their first and second derivatives in time.
    pub fn turn(self, [u, v, a]: &[Vec3; 3]) -> Turn {
        match self {
            RotationAngles::Vector => {
                let (omega, alpha) = rotation::rates(u, v, a);
                Turn { rotation: rotation::exp(u), omega, alpha }
            }
            RotationAngles::Sequence(axes) => {
                let rest = Turn { rotation: Quaternion::identity(), omega: Vec3::zeros(), alpha: Vec3::zeros() };
                axes.into_iter().rev().fold(rest, |inner, i| {
                    let about = |angle: f64| Vec3::ith(i, angle);
                    let own = rotation::exp(&about(u[i]));
                    let R = rotation::matrix(&own);
                    let carried = R * inner.omega;
                    Turn {
                        rotation: own * inner.rotation,
                        omega: about(v[i]) + carried,
                        alpha: about(a[i]) + R * inner.alpha + about(v[i]).cross(&carried),
                    }
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [RotationAngles; 7] = [
        RotationAngles::Vector,
        RotationAngles::Sequence([0, 1, 2]),
        RotationAngles::Sequence([0, 2, 1]),
        RotationAngles::Sequence([1, 0, 2]),
        RotationAngles::Sequence([1, 2, 0]),
        RotationAngles::Sequence([2, 0, 1]),
        RotationAngles::Sequence([2, 1, 0]),
    ];

    fn at(t: f64) -> [Vec3; 3] {
        [
            Vec3::new(2.0 * t.sin(), 0.7 * t * t, 1.0 - 3.0 * t),
            Vec3::new(2.0 * t.cos(), 1.4 * t, -3.0),
            Vec3::new(-2.0 * t.sin(), 1.4, 0.0),
        ]
    }

    #[test]
    fn rates_are_the_derivatives_of_the_rotation() {
        let h = 1e-3;
        for angles in ALL {
            for t in [0.0, 0.4, 1.7] {
                let turn = angles.turn(&at(t));
                let spin = |k: f64| {
                    let later = angles.turn(&at(t + k * h));
                    (rotation::log(&(later.rotation * turn.rotation.conjugate())), later.omega)
                };
                let ([(a, wa), (b, wb)], [(c, wc), (d, wd)]) = ([spin(-2.0), spin(-1.0)], [spin(1.0), spin(2.0)]);
                let omega = (8.0 * (c - b) - (d - a)) / (12.0 * h);
                let alpha = (8.0 * (wc - wb) - (wd - wa)) / (12.0 * h);
                // The differences are of fourth order: h⁴ is 1e-12, times fifth derivatives up to some hundred.
                assert!((turn.omega - omega).amax() < 1e-8, "{angles:?} {t}: {} {omega}", turn.omega);
                assert!((turn.alpha - alpha).amax() < 1e-8, "{angles:?} {t}: {} {alpha}", turn.alpha);
            }
        }
    }

    #[test]
    fn a_sequence_turns_each_axis_with_those_before_it() {
        let u = Vec3::new(0.3, -0.8, 2.1);
        let one = |axis: usize| rotation::matrix(&rotation::exp(&Vec3::ith(axis, u[axis])));
        for angles in ALL {
            let RotationAngles::Sequence([i, j, k]) = angles else { continue };
            let R = rotation::matrix(&angles.turn(&[u, Vec3::zeros(), Vec3::zeros()]).rotation);
            assert!((R - one(i) * one(j) * one(k)).amax() < 1e-15, "{angles:?}"); // rounding
        }
    }
}
