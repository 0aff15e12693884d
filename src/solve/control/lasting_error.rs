//! The lasting part of the errors of steps. A vibration of amplitude `A` at the end of a run of length T has the phase error φ A, φ = c ω³
//! Δt² T, but never much more than `A`. A Butterworth filter of third order over time, with its corner at φ = 1, gives `φ A/√(1 + φ²)`:
//! modes long out of phase count by their amplitude.

use base::math::Vec6;
use base::snapshot::keep;

/// The filtered errors by node, over c Δt³: a filter of first order and one of second order in a row. It is allocated
/// once.
pub struct LastingError {
    first: Vec<Vec6>,
    value: Vec<Vec6>,
    /// Rate of the value, times the time constant.
    rate: Vec<Vec6>,
    /// Time constant of the last step; `None` before the first.
    tau: Option<f64>,
}

keep!(LastingError { first, value, rate, tau });

impl LastingError {
    /// A filter at rest for this number of nodes.
    pub fn new(nodes: usize) -> LastingError {
        let zeros = vec![Vec6::zeros(); nodes];
        LastingError { first: zeros.clone(), value: zeros.clone(), rate: zeros, tau: None }
    }

    /// Forgets all errors.
    pub fn forget(&mut self) {
        self.tau = None;
        self.rate.fill(Vec6::zeros());
    }

    /// The lasting errors over c Δt³, by node.
    pub fn value(&self) -> &[Vec6] {
        &self.value
    }

    /// Filters the errors of a step of length `dt`, divided by `per` = c Δt³, with the time constant `tau`. Implicit Euler integrates
    /// `τ y₁' + y₁ = e` and `τ² y'' + τ y' + y = y₁`.
    pub fn update(&mut self, errors: &[Vec6], per: f64, dt: f64, tau: f64) {
        let (s, stretched) = (dt / tau, self.tau.map(|before| tau / before));
        self.tau = Some(tau);
        for (i, error) in errors.iter().enumerate() {
            let error = error / per;
            let Some(stretched) = stretched else {
                (self.first[i], self.value[i]) = (error, error);
                continue;
            };
            let (first, value, rate) = (&mut self.first[i], &mut self.value[i], &mut self.rate[i]);
            *first += (error - *first) * (s / (1.0 + s));
            *rate = (*rate * stretched + (*first - *value) * s) / (1.0 + s + s * s);
            *value += *rate * s;
        }
    }
}
