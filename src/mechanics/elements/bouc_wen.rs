//! The hysteresis of Bouc and Wen, with the deterioration of Baber. The force is
//!   F = k₂ x + (k − k₂) z.
//! The hysteretic displacement z follows from
//!   dz/dx = (1 − ν |z/x_y|ⁿ (b sgn(z dx) + 1 − b)) / η,   ν = 1 + δ_ν e,  η = 1 + δ_η e.
//! The yield displacement is x_y = F_y/k. The energy e = ∫ (1 − k₂/k) z dx / x_y² is the work on z in units of F_y x_y. Along a step x runs
//! straight, so this is an equation in x alone. Y. K. Wen, J. Eng. Mech. Div. ASCE 102 (1976) 249-263; T. T. Baber & Y. K. Wen, ibid. 107
//! (1981) 1069-1087.

/// Length of a step of the integration, over the yield displacement: its error is 1e-10 of it for exponents up to 5.
const PIECE: f64 = 0.005;
/// Largest number of steps: a way of hundred yield displacements ends where z has settled long before.
const MOST_PIECES: f64 = 20_000.0;

/// The parameters of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoucWen {
    /// k, force per elongation before yielding.
    pub stiffness: f64,
    /// k₂, the slope far beyond.
    pub post_yield_stiffness: f64,
    /// F_y.
    pub yield_force: f64,
    /// n, how sharp the knee is.
    pub exponent: f64,
    /// b, 0.5 to 1: unloading is straight with 0.5, and bulges with more.
    pub bulge: f64,
    /// δ_ν and δ_η: the loss of strength and of stiffness by e.
    pub losses: [f64; 2],
}

/// What a law remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BoucWenState {
    /// Elongation.
    pub x: f64,
    /// Hysteretic displacement.
    pub z: f64,
    /// ∫ z dx.
    pub area: f64,
}

/// The number of history variables.
pub const MEMORY: usize = 3;

impl BoucWenState {
    /// Of its history variables; all zero where there are none yet.
    pub fn of(memory: &[f64]) -> BoucWenState {
        match memory {
            &[x, z, area, ..] => BoucWenState { x, z, area },
            _ => BoucWenState::default(),
        }
    }
}

impl BoucWen {
    /// F_y/k.
    fn yield_displacement(&self) -> f64 {
        self.yield_force / self.stiffness
    }

    /// k − k₂.
    pub fn hysteretic_stiffness(&self) -> f64 {
        self.stiffness - self.post_yield_stiffness
    }

    /// ν and η.
    fn deterioration(&self, area: f64) -> [f64; 2] {
        let energy = self.hysteretic_stiffness() * area / (self.yield_force * self.yield_displacement());
        self.losses.map(|loss| 1.0 + loss * energy.max(0.0))
    }

    /// dz/dx towards `sign`.
    fn slope(&self, z: f64, area: f64, sign: f64) -> f64 {
        let of = z / self.yield_displacement();
        let [nu, eta] = self.deterioration(area);
        let part = self.bulge * (z * sign).signum() + 1.0 - self.bulge;
        (1.0 - nu * of.abs().powf(self.exponent) * part) / eta
    }

    /// The state at the elongation `x`, on a straight way from `from`, by steps of fourth order.
    pub fn moved(&self, from: &BoucWenState, x: f64) -> BoucWenState {
        let way = x - from.x;
        if way == 0.0 {
            return *from;
        }
        let sign = way.signum();
        // Whole pieces and a rest, so that the force has no jump where one more is needed.
        let piece = self.yield_displacement() * PIECE.max(way.abs() / self.yield_displacement() / MOST_PIECES);
        let (mut left, mut z, mut area) = (way.abs(), from.z, from.area);
        while left > 0.0 {
            let h = sign * left.min(piece);
            left -= piece;
            let rate = |z: f64, area: f64| [self.slope(z, area, sign), z];
            let k1 = rate(z, area);
            let k2 = rate(z + 0.5 * h * k1[0], area + 0.5 * h * k1[1]);
            let k3 = rate(z + 0.5 * h * k2[0], area + 0.5 * h * k2[1]);
            let k4 = rate(z + h * k3[0], area + h * k3[1]);
            let mean = |i: usize| h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
            (z, area) = (z + mean(0), area + mean(1));
        }
        BoucWenState { x, z, area }
    }

    /// Force and its slope at the elongation `x`, from the state at the start of the step.
    pub fn force(&self, from: &BoucWenState, x: f64) -> [f64; 2] {
        let at = self.moved(from, x);
        let sign = if x < from.x { -1.0 } else { 1.0 };
        let hysteretic = self.hysteretic_stiffness();
        let slope = self.slope(at.z, at.area, sign);
        [self.post_yield_stiffness * x + hysteretic * at.z, self.post_yield_stiffness + hysteretic * slope]
    }

    /// The energy that comes back: unloading has the slope (k − k₂)/η.
    pub fn energy(&self, at: &BoucWenState) -> f64 {
        let eta = self.deterioration(at.area)[1];
        0.5 * (self.post_yield_stiffness * at.x * at.x + self.hysteretic_stiffness() * eta * at.z * at.z)
    }

    /// The dissipation between two states: the work less the change of the energy.
    pub fn dissipated(&self, from: &BoucWenState, to: &BoucWenState) -> f64 {
        let elastic = 0.5 * self.post_yield_stiffness * (to.x * to.x - from.x * from.x);
        let work = elastic + self.hysteretic_stiffness() * (to.area - from.area);
        work - (self.energy(to) - self.energy(from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const LAW: BoucWen = BoucWen {
        stiffness: 1e6,
        post_yield_stiffness: 1e5,
        yield_force: 2e3,
        exponent: 1.0,
        bulge: 0.5,
        losses: [0.0; 2],
    };

    /// With n = 1 and b = 1/2 first loading is z = x_y (1 − exp(−x/x_y)), and unloading is straight until z passes zero.
    #[test]
    fn loading_and_unloading_by_exponentials() {
        let (x_y, start) = (2e-3, BoucWenState::default());
        let top = LAW.moved(&start, 5e-3);
        // Steps of fourth order: (x/x_y/pieces)⁴ of it.
        assert!((top.z / (x_y * (1.0 - (-2.5f64).exp())) - 1.0).abs() < 1e-8, "{top:?}");
        let back = LAW.moved(&top, 4.5e-3);
        assert!((top.z - back.z - 5e-4).abs() < 1e-15, "{back:?}");
        let area = 5e-3 * x_y - x_y * x_y * (1.0 - (-2.5f64).exp());
        assert!((top.area / area - 1.0).abs() < 1e-8);
    }

    /// A random history that loses strength and stiffness, beside an integration in time with a hundred times as many steps.
    #[test]
    fn a_history_is_that_of_an_integration_in_time() {
        for (exponent, bulge, losses) in [(1.0, 0.5, [0.0; 2]), (2.0, 0.7, [0.02, 0.01]), (5.0, 0.5, [0.0, 0.05])] {
            let law = BoucWen { exponent, bulge, losses, ..LAW };
            let way =
                |t: f64| 4e-3 * ((TAU * t).sin() + 0.6 * (1.7 * TAU * t).sin() + 0.3 * (4.3 * TAU * t).cos() - 0.3);
            let (mut state, mut work, mut spent) = (BoucWenState::default(), 0.0, 0.0);
            let [mut z, mut e] = [0.0f64; 2];
            let (x_y, part) = (law.yield_force / law.stiffness, 0.9);
            for step in 0..4000 {
                let t = |k: f64| (step as f64 + k) * 1e-3;
                let next = law.moved(&state, way(t(1.0)));
                spent += law.dissipated(&state, &next);
                work += law.post_yield_stiffness * 0.5 * (next.x * next.x - state.x * state.x)
                    + law.hysteretic_stiffness() * (next.area - state.area);
                state = next;
                // ż by the formula as published, in small steps of second order.
                let n = 100;
                let rate = |z: f64, e: f64, v: f64| {
                    let nu = 1.0 + losses[0] * e;
                    let eta = 1.0 + losses[1] * e;
                    let f = (z / x_y).abs().powf(exponent - 1.0) * z / x_y;
                    let fabs = (z / x_y).abs().powf(exponent);
                    (v - nu * (bulge * v.abs() * f + (1.0 - bulge) * v * fabs)) / eta
                };
                for i in 0..n {
                    let (a, b) = (t(i as f64 / n as f64), t((i + 1) as f64 / n as f64));
                    let dx = way(b) - way(a);
                    let half = z + 0.5 * rate(z, e, dx);
                    let e_half = e + 0.5 * part * z * dx / (x_y * x_y);
                    let change = rate(half, e_half, dx);
                    e += part * (z + 0.5 * change) * dx / (x_y * x_y);
                    z += change;
                }
                // Steps of the law turn at their ends only: 4000 of them leave 1e-4 where the way turns.
                assert!((state.z - z).abs() < 2e-4 * x_y, "{exponent} {step}: {} {z}", state.z);
            }
            assert!((work - law.energy(&state) - spent).abs() < 1e-9 * spent, "{work} {spent}");
            assert!(spent > 0.0);
        }
    }

    #[test]
    fn slopes_are_those_of_forces() {
        let law = BoucWen { exponent: 2.0, bulge: 0.6, losses: [0.1, 0.05], ..LAW };
        let from = law.moved(&BoucWenState::default(), 3e-3);
        for x in [3.2e-3, 6e-3, 2.5e-3, -1e-3] {
            let h = 1e-8;
            let [up, down] = [h, -h].map(|h| law.force(&from, x + h)[0]);
            let slope = law.force(&from, x)[1];
            // Differences of forces of 1e3 over 1e-8, and steps that are not exact.
            assert!(((up - down) / (2.0 * h) / slope - 1.0).abs() < 1e-4, "{x}: {slope}");
        }
    }
}
