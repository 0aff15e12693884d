//! Reinforcing steel after Menegotto and Pinto, with the isotropic hardening of Filippou, Popov and Bertero, as Steel02 of OpenSees has it.
//!
//! From each reversal the stress follows a curve. It leaves the line of slope E through the reversal and approaches the line of hardening of
//! slope b E:
//!   σ* = b ε* + (1 − b) ε*/(1 + |ε*|ᴿ)^(1/R),   R = R₀ (1 − c₁ ξ/(c₂ + ξ)).
//! ε* and σ* run from 0 at the reversal to 1 where the two lines meet. ξ is the distance in yield strains of this meeting point from the
//! extreme strain on its side so far. The line of hardening moves outwards by the factor 1 + a₃ (Δ/2a₄ ε_y)^0.8 in tension and by a₁, a₂ in
//! compression, where Δ is the range of strains so far. M. Menegotto and P. E. Pinto, IABSE Symposium, Lisbon 1973; F. C. Filippou, E. P.
//! Popov and V. V. Bertero, EERC 83-19, Berkeley 1983.
//!
//! Omitted: buckling and rupture. After a small reversal the curve does not return to the one that it left and runs above it.

use super::work::work;

/// The parameters of a steel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MenegottoPinto {
    /// E.
    pub modulus: f64,
    /// f_y.
    pub yield_stress: f64,
    /// b, below 1.
    pub hardening_ratio: f64,
    /// R₀, c₁, c₂.
    pub curvature: [f64; 3],
    /// a₁ to a₄.
    pub isotropic: [f64; 4],
}

/// The history of a point. All are zero at the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SteelState {
    /// Strain.
    pub strain: f64,
    /// Stress.
    pub stress: f64,
    /// 1 on a curve towards tension, −1 towards compression, 0 at the start.
    direction: f64,
    /// The least and the largest strain at reversals.
    extremes: [f64; 2],
    /// The extreme strain on the side of the curve.
    target: f64,
    /// Strain and stress at the last reversal.
    reversal: [f64; 2],
    /// The strain where the two lines meet.
    meeting: f64,
    /// The strain at the front of the curve, from which it turns.
    front: f64,
    /// The accumulated inelastic strain, ∫ |d(ε − σ/E)|.
    accumulated: f64,
}

/// A way back of so many yield strains belongs to the curve: rounding and the iteration, with tolerances up to 1e-5, move strains to and fro where
/// a load stays. The error of the stress is at most this part of the yield stress.
pub(super) const SAME: f64 = 1e-4;

/// Where a reversal lies nearer to the line of hardening, in yield strains, the line is the answer: differences of strains round to 1e-12 of them.
const LEAST_WAY: f64 = 1e-9;

/// The number of history variables.
pub const VARIABLES: usize = 11;

impl SteelState {
    /// The state from its history variables.
    pub fn of(history: &[f64]) -> SteelState {
        let &[strain, stress, direction, least, most, target, rx, rs, meeting, front, accumulated, ..] = history else {
            return SteelState::default();
        };
        let (extremes, reversal) = ([least, most], [rx, rs]);
        SteelState { strain, stress, direction, extremes, target, reversal, meeting, front, accumulated }
    }

    /// The history variables.
    pub fn history(&self) -> [f64; VARIABLES] {
        let SteelState { strain, stress, direction, extremes, target, reversal, meeting, front, accumulated } = *self;
        let ([least, most], [rx, rs]) = (extremes, reversal);
        [strain, stress, direction, least, most, target, rx, rs, meeting, front, accumulated]
    }

    /// The accumulated inelastic strain.
    pub fn accumulated(&self) -> f64 {
        self.accumulated
    }
}

impl MenegottoPinto {
    /// ε_y.
    fn yield_strain(&self) -> f64 {
        self.yield_stress / self.modulus
    }

    /// The curve on the way from `from` to `strain`: that of `from`, or a new one where the strain goes back by more than rounding.
    fn turned(&self, from: &SteelState, strain: f64) -> SteelState {
        let (E, yield_strain) = (self.modulus, self.yield_strain());
        if from.direction == 0.0 {
            let direction = strain.signum();
            let (target, extremes) = (direction * yield_strain, [-yield_strain, yield_strain]);
            return SteelState { direction, extremes, target, meeting: target, ..*from };
        }
        if from.direction * (from.front - strain) <= SAME * yield_strain {
            return *from;
        }
        let (direction, x) = (-from.direction, from.front);
        let s = self.curve(from, x)[0];
        let extremes = [from.extremes[0].min(x), from.extremes[1].max(x)];
        let [a1, a2, a3, a4] = self.isotropic;
        let (factor, range, target) = if direction > 0.0 { (a3, a4, extremes[1]) } else { (a1, a2, extremes[0]) };
        let shift = match factor {
            0.0 => 1.0,
            _ => 1.0 + factor * ((extremes[1] - extremes[0]) / (2.0 * range * yield_strain)).powf(0.8),
        };
        // The line of hardening at the reversal, less the stress there, closes at the rate E − b E.
        let hardening = self.hardening_ratio * E;
        let line = direction * shift * (self.yield_stress - hardening * yield_strain) + hardening * x;
        let meeting = x + (line - s) / (E - hardening);
        SteelState { direction, extremes, target, reversal: [x, s], meeting, ..*from }
    }

    /// Stress and slope at a strain on the curve of `at`.
    fn curve(&self, at: &SteelState, strain: f64) -> [f64; 2] {
        let ([R0, c1, c2], b, E) = (self.curvature, self.hardening_ratio, self.modulus);
        let [x, s] = at.reversal;
        let way = at.meeting - x;
        if at.direction * way <= LEAST_WAY * self.yield_strain() {
            // The reversal lies on the line of hardening, or beyond.
            return [s + b * E * (strain - x), b * E];
        }
        let xi = ((at.target - at.meeting) / self.yield_strain()).abs();
        let R = R0 * (1.0 - c1 * xi / (c2 + xi));
        let part = (strain - x) / way;
        let sum = 1.0 + part.abs().powf(R);
        let root = sum.powf(1.0 / R);
        [s + E * way * (b * part + (1.0 - b) * part / root), E * (b + (1.0 - b) / (sum * root))]
    }

    /// The state at `strain` on a straight way from `from`, and its slope.
    pub fn moved(&self, from: &SteelState, strain: f64) -> (SteelState, f64) {
        if from.direction == 0.0 && strain == 0.0 {
            return (*from, self.modulus);
        }
        let on = self.turned(from, strain);
        let [stress, slope] = self.curve(&on, strain);
        let turns = on.direction != from.direction;
        let front = if turns || on.direction * (strain - on.front) > 0.0 { strain } else { on.front };
        let inelastic = strain - from.strain - (stress - from.stress) / self.modulus;
        (SteelState { strain, stress, front, accumulated: from.accumulated + inelastic.abs(), ..on }, slope)
    }

    /// The elastic energy per volume.
    pub fn energy(&self, at: &SteelState) -> f64 {
        0.5 * at.stress * at.stress / self.modulus
    }

    /// The energy per volume dissipated on the way between two states: the work less the change of the elastic energy. It is negative
    /// where the curve bends before the stress has changed its sign.
    pub fn dissipated(&self, from: &SteelState, to: &SteelState) -> f64 {
        let work = work([from.strain, to.strain], [to.meeting, from.front], |strain| self.moved(from, strain).0.stress);
        work - (self.energy(to) - self.energy(from))
    }
}
