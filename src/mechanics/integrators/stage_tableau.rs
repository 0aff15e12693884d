//! Coefficients of a diagonally implicit Runge-Kutta scheme with an explicit first stage (ESDIRK). One number γ on the diagonal gives all
//! stages one matrix, and the last stage is the end of the step.

use super::coefficients::Coefficients;
use super::tableau::StageWeights;
use base::math::rotation::RotationUpdate;
use nalgebra::DMatrix;

/// Largest number of stages that a prediction goes through.
const MOST_EXTRAPOLATED: usize = 3;

/// The numbers of a scheme. Stages count from 0, the start of the step.
#[derive(Debug, PartialEq)]
pub struct StageTableau {
    /// Order of the scheme.
    pub order: usize,
    /// The diagonal γ.
    pub gamma: f64,
    /// Times of the stages after the first, as fractions of the step; the last is 1.
    pub c: &'static [f64],
    /// Weights of the rates of earlier stages in the motion of each stage after the first.
    pub a: &'static [StageWeights],
}

impl StageTableau {
    /// Number of stages, the first included.
    pub fn stages(&self) -> usize {
        self.c.len() + 1
    }

    /// The weight of the rate of a stage in the motion at the end of the step.
    pub fn weight_at_end(&self, stage: usize) -> f64 {
        if stage + 1 == self.stages() {
            return self.gamma;
        }
        let of_last = self.a.last().copied().unwrap_or(&[]);
        of_last.iter().find(|(of, _)| *of == stage).map_or(0.0, |(_, weight)| *weight)
    }

    /// The weights of the accelerations of earlier stages in the predicted one of a stage: the polynomial through them.
    pub fn extrapolation(&self, stage: usize) -> Vec<f64> {
        let time = |stage: usize| if stage == 0 { 0.0 } else { self.c[stage - 1] };
        let first = stage.saturating_sub(MOST_EXTRAPOLATED);
        let weight = |of: usize| {
            let others = (first..stage).filter(|other| *other != of && of >= first);
            let factor = |other: usize| (time(stage) - time(other)) / (time(of) - time(other));
            if of < first { 0.0 } else { others.map(factor).product() }
        };
        (0..stage).map(weight).collect()
    }

    /// Weights of the rates of all stages in the second derivative over the step, times Δt²: that of the parabola of best fit.
    pub fn second_derivative(&self) -> Vec<f64> {
        let times: Vec<f64> = std::iter::once(0.0).chain(self.c.iter().copied()).collect();
        let columns = DMatrix::from_fn(times.len(), 3, |stage, power| times[stage].powi(power as i32));
        // Rows of the pseudo-inverse are the coefficients of 1, c, c²; it exists, for the times differ.
        let fit = columns.pseudo_inverse(f64::EPSILON).unwrap_or_else(|_| DMatrix::zeros(3, times.len()));
        fit.row(2).iter().map(|weight| 2.0 * weight).collect()
    }

    /// Coefficients of every stage of a step of length Δt. In place of (v, a) the stages use (q*, q̇*)/(γΔt), which collect earlier stages:
    /// q̇ = (q − q*)/(γΔt), q̈ = (q̇ − q̇*)/(γΔt).
    pub fn coefficients(&self, dt: f64, rotation: RotationUpdate) -> Coefficients {
        let rate = 1.0 / (self.gamma * dt);
        let of_rate = [rate, -1.0, 0.0, 0.0];
        let of_acceleration = [rate * rate, -rate, -1.0, 0.0];
        Coefficients {
            instant: 1.0,
            rate: [rate, -1.0, 0.0],
            acceleration: of_acceleration,
            prediction: [dt, 0.5 * dt * dt, dt * dt * dt / 6.0],
            end: [[1.0, 0.0, 0.0, 0.0], of_rate, of_acceleration],
            turning: None,
            rotation,
        }
    }
}
