//! Load stepping: a static analysis is the scheme without rates.

use super::coefficients::Coefficients;
use base::math::rotation::RotationUpdate;

/// The coefficients of a load step: equilibrium at its end, no rates.
pub fn coefficients() -> Coefficients {
    Coefficients {
        instant: 1.0,
        rate: [0.0; 3],
        acceleration: [0.0; 4],
        prediction: [0.0; 3],
        end: [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4]],
        turning: None,
        rotation: RotationUpdate::Exponential,
    }
}
