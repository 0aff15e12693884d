//! The normal force: a spring that only pushes, with damping for a given coefficient of restitution.
//!
//! Hunt & Crossley, J. Appl. Mech. 42 (1975) 440-445: f = k δ (1 + d δ̇). For a free impact at speed v₀ the motion δ̈ = −f/m has the
//! integral ∫ w/(1 + d w) dw = 0 from v₀ to −e v₀, for any m and k. D = d v₀ thus follows from the coefficient of restitution e alone: D (1
//! + e) = ln((1 + D)/(1 − e D)). The force begins and ends at zero and never pulls.

/// The least coefficient of restitution: below it D grows as 1/e, and steps would have to resolve ever shorter impacts.
pub const LEAST: f64 = 0.01;

/// D of an impact with restitution 0: at rest on the spring, the motion is critically damped.
const WHOLE: f64 = 2.0;
/// Rate of replacing the damper by the spring, relative to the decay rate of the impact.
const TAKES_OVER: f64 = 0.5;

/// The energy loss in an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Loss {
    /// An impact gives back all of its energy.
    None,
    /// An impact gives back a set part of the approach speed.
    Restitution {
        /// D of the coefficient of restitution.
        number: f64,
        /// Least approach speed for d: slower impacts use this speed.
        floor: f64,
    },
    /// An impact gives back nothing.
    Whole {
        /// Below this approach speed the spring follows at once, as for a sinking weight.
        floor: f64,
    },
    /// Viscous damping, force per velocity.
    Damping(f64),
}

/// A normal force and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NormalForce {
    /// Normal force.
    pub force: f64,
    /// ∂f/∂δ.
    pub by_depth: f64,
    /// ∂f/∂δ̇.
    pub by_rate: f64,
}

impl std::ops::Neg for NormalForce {
    type Output = NormalForce;

    fn neg(self) -> NormalForce {
        NormalForce { force: -self.force, by_depth: -self.by_depth, by_rate: -self.by_rate }
    }
}

/// D of a coefficient of restitution from [`LEAST`] to 1.
pub fn number(e: f64) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    let excess = |D: f64| D * (1.0 + e) - D.ln_1p() + (-e * D).ln_1p();
    // The function is positive from 0 on and falls to −∞ at 1/e, so it has one root. Near e = 1 only the series avoids cancellation.
    let series = 1.5 * (1.0 - e * e) / (1.0 + e * e * e);
    if series < 1e-4 {
        return series;
    }
    let (mut low, mut high) = (0.5 * series.min(1.0 / e), 1.0 / e);
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The normal force at depth δ > 0 and rate δ̇, after an approach at `speed`. `depth` is the depth of the spring, which starts at a depth
/// `inset`.
#[inline]
pub fn normal_force(stiffness: f64, loss: &Loss, depth: f64, inset: f64, rate: f64, speed: f64) -> NormalForce {
    let spring = stiffness * depth;
    let force = match *loss {
        Loss::None => NormalForce { force: spring, by_depth: stiffness, by_rate: 0.0 },
        Loss::Restitution { number, floor } => {
            let speed = speed.max(floor);
            let d = if speed > 0.0 { number / speed } else { 0.0 };
            // At the largest approach speed d falls as the rate rises, and their product stays.
            let by_rate = if rate < speed { spring * d } else { 0.0 };
            NormalForce { force: spring * (1.0 + d * rate), by_depth: stiffness * (1.0 + d * rate), by_rate }
        }
        Loss::Whole { floor } => {
            let speed = speed.max(floor);
            let d = if speed > 0.0 { WHOLE / speed } else { 0.0 };
            let whole = stiffness * (depth + inset);
            let by_rate = if rate < speed { whole * d } else { 0.0 };
            NormalForce { force: spring + whole * d * rate, by_depth: stiffness * (1.0 + d * rate), by_rate }
        }
        Loss::Damping(c) => NormalForce { force: spring + c * rate, by_depth: stiffness, by_rate: c },
    };
    // At zero depth there is no force yet, but stiffness.
    if force.force > 0.0 || force.force == 0.0 && force.by_depth > 0.0 { force } else { NormalForce::default() }
}

/// The depth of the spring at the end of the time `dt`, in an impact with restitution 0; the rest of the way to `to` no longer pushes.
/// During the impact the spring is left out, so that nothing drives the bodies apart. A lasting force compresses the spring nevertheless:
/// the spring grows at a rate proportional to its own depth.
pub fn taken_over(loss: &Loss, (from, to): (f64, f64), inset: f64, speed: f64, dt: f64) -> f64 {
    let Loss::Whole { floor } = *loss else { return to };
    let from = from.max(0.0);
    let whole = to + inset;
    let growth = if whole > 0.0 { TAKES_OVER * speed.max(floor) / (WHOLE * whole) } else { 0.0 };
    to.min(from + dt * (floor + growth * from))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The impact integrated by Runge-Kutta's method: the speed after it is e times that before.
    #[test]
    fn an_impact_gives_back_its_part_of_the_speed() {
        for (e, m, k, v0) in [
            (0.01, 1.0, 1e4, 1.0),
            (0.2, 3.0, 1e7, 0.1),
            (0.6, 0.1, 1e3, 5.0),
            (0.9, 2.0, 1e5, 2.0),
            (0.9999, 1.0, 1.0, 1.0),
        ] {
            let loss = Loss::Restitution { number: number(e), floor: 0.0 };
            let slope = |[x, v]: [f64; 2]| [v, -normal_force(k, &loss, x.max(0.0), 0.0, v, v0).force / m];
            let plus = |a: [f64; 2], s: f64, b: [f64; 2]| [a[0] + s * b[0], a[1] + s * b[1]];
            let h = (m / k).sqrt() * 1e-3 * if e < 0.1 { 0.1 } else { 1.0 };
            let mut y = [0.0, v0];
            loop {
                let k1 = slope(y);
                let k2 = slope(plus(y, 0.5 * h, k1));
                let k3 = slope(plus(y, 0.5 * h, k2));
                let k4 = slope(plus(y, h, k3));
                let sum: [f64; 2] = std::array::from_fn(|i| k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
                y = plus(y, h / 6.0, sum);
                if y[0] <= 0.0 && y[1] < 0.0 {
                    break;
                }
            }
            // Fourth order with 3000 steps an impact; the kink at the end adds 1e-9.
            assert!((-y[1] / v0 - e).abs() < 1e-6, "e = {e}: {}", -y[1] / v0);
        }
    }
}
