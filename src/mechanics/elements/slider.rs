//! A spring along a coordinate that slips at its limit (return mapping), so sticking does not creep; and the state along the coordinate.

/// Dry friction, a spring that slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DryFriction {
    /// Slip limit.
    pub limit: f64,
    /// Effort per coordinate before it does.
    pub stiffness: f64,
}

/// Coordinate and effort at an instant.
#[derive(Debug, Clone, Copy)]
pub struct CoordinateState {
    /// q, turns counted.
    pub q: f64,
    /// q̇.
    pub rate: f64,
    /// f, positive where it pulls the second node back.
    pub effort: f64,
    /// ∂f/∂q.
    pub by_q: f64,
    /// ∂f/∂q̇.
    pub by_rate: f64,
    /// Energy stored in the springs.
    pub energy: f64,
    /// The displacement of the anchor of friction.
    pub slip: f64,
    /// Dissipation by impact, per time.
    pub impact_power: f64,
    /// Speed of the landing.
    pub impact_speed: f64,
}

impl CoordinateState {
    /// Without effort at a coordinate and its rate.
    pub fn at(q: f64, rate: f64) -> CoordinateState {
        CoordinateState {
            q,
            rate,
            effort: 0.0,
            by_q: 0.0,
            by_rate: 0.0,
            energy: 0.0,
            slip: 0.0,
            impact_power: 0.0,
            impact_speed: 0.0,
        }
    }
}

impl DryFriction {
    /// Stretch of the spring at `q`, and the displacement of its anchor; both zero without a spring.
    pub fn stretch(&self, q: f64, anchor: f64) -> (f64, f64) {
        if self.stiffness == 0.0 {
            return (0.0, 0.0);
        }
        let (stretch, most) = (q - anchor, self.limit / self.stiffness);
        let held = stretch.clamp(-most, most);
        (held, stretch - held)
    }

    /// Adds effort, stiffness and energy at the coordinate of `state`; returns the way of the anchor.
    pub fn add(&self, anchor: f64, state: &mut CoordinateState) -> f64 {
        let (held, slip) = self.stretch(state.q, anchor);
        state.effort += self.stiffness * held;
        if slip == 0.0 {
            state.by_q += self.stiffness;
        }
        state.energy += 0.5 * self.stiffness * held * held;
        slip
    }
}
