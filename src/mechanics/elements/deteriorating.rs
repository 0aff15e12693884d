//! The hysteresis of Ibarra, Medina and Krawinkler, bilinear: a backbone with a capping point and a residual strength, which deteriorates with the
//! energy dissipated.
//!
//! Upwards the force rises with the stiffness K up to the backbone of that sense, the least of
//!   y + p (x − y/K₀),  C − s x,
//! and at least the residual force r; downwards likewise. At each force of zero an excursion of the energy E_i ends. The yield force y and its slope p of
//! the sense ahead then fall by β = (E_i/(E_t − ΣE))^c with the capacity E_t of strength, C by that with the capacity of softening, and s stays in proportion
//! to y − r. At each reversal K falls by that with the capacity of unloading and the energy dissipated since the last one. A capacity that is used
//! up breaks the spring, and so does the ultimate elongation. A step runs straight; its events are found exactly, so results do not depend on its
//! length. L. F. Ibarra, R. A. Medina & H. Krawinkler, Earthquake Eng. Struct. Dyn. 34 (2005) 1489-1511; D. G. Lignos & H. Krawinkler, J. Struct.
//! Eng. 137 (2011) 1291-1302.

use super::piecewise::area;

/// The number of history variables.
pub const MEMORY: usize = 12;

/// The parameters of a law, alike in both senses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deteriorating {
    /// K at the start.
    pub stiffness: f64,
    /// y at the start.
    pub yield_force: f64,
    /// p at the start.
    pub post_yield_stiffness: f64,
    /// Elongation from yielding to the largest force.
    pub capping: f64,
    /// Elongation from there down to zero force.
    pub post_capping: f64,
    /// Force that remains.
    pub residual: f64,
    /// Elongation of the break; infinite without one.
    pub ultimate: f64,
    /// E_t of strength, softening and unloading; infinite without deterioration.
    pub capacities: [f64; 3],
    /// c.
    pub exponent: f64,
}

/// What a law remembers. Losses are parts of the values at the start; the sense is 0 downwards, 1 upwards.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeterioratingState {
    /// Elongation.
    pub x: f64,
    /// Force.
    pub force: f64,
    /// ∫ F dx.
    pub work: f64,
    /// The work at the last force of zero.
    work_at_zero: f64,
    /// The dissipation at the last loss of stiffness.
    spent_at_reversal: f64,
    /// The sign of the last motion.
    way: f64,
    /// Of K.
    stiffness_loss: f64,
    /// Of y and p.
    strength_loss: [f64; 2],
    /// Of C.
    softening_loss: [f64; 2],
    /// 1 once it is broken.
    broken: f64,
}

impl DeterioratingState {
    /// Of its history variables; all zero where there are none yet.
    pub fn of(memory: &[f64]) -> DeterioratingState {
        match memory {
            &[x, force, work, work_at_zero, spent_at_reversal, way, stiffness_loss, a, b, c, d, broken, ..] => {
                DeterioratingState {
                    x,
                    force,
                    work,
                    work_at_zero,
                    spent_at_reversal,
                    way,
                    stiffness_loss,
                    strength_loss: [a, b],
                    softening_loss: [c, d],
                    broken,
                }
            }
            _ => DeterioratingState::default(),
        }
    }

    /// Its history variables.
    pub fn memory(&self) -> [f64; MEMORY] {
        let ([a, b], [c, d]) = (self.strength_loss, self.softening_loss);
        let Self { x, force, work, work_at_zero, spent_at_reversal, way, stiffness_loss, broken, .. } = *self;
        [x, force, work, work_at_zero, spent_at_reversal, way, stiffness_loss, a, b, c, d, broken]
    }

    /// True once it carries nothing any more.
    pub fn is_broken(&self) -> bool {
        self.broken > 0.0
    }
}

/// The backbone of one sense, with elongations and forces positive in it.
struct Backbone {
    /// Force at zero elongation and slope of the hardening line.
    hardening: [f64; 2],
    /// The same of the softening line.
    softening: [f64; 2],
    residual: f64,
}

impl Backbone {
    fn force(&self, x: f64) -> [f64; 2] {
        let [hardening, softening] = [self.hardening, self.softening].map(|[f, slope]| [f + slope * x, slope]);
        let least = if hardening[0] <= softening[0] { hardening } else { softening };
        if least[0] < self.residual { [self.residual, 0.0] } else { least }
    }

    /// Elongations among which are all its corners, and where it meets the line of force `f` at zero elongation and slope `k`.
    fn corners(&self, f: f64, k: f64) -> [f64; 6] {
        let lines = [self.hardening, self.softening, [self.residual, 0.0], [f, k]];
        let meet = |a: usize, b: usize| (lines[b][0] - lines[a][0]) / (lines[a][1] - lines[b][1]);
        [meet(0, 1), meet(0, 2), meet(1, 2), meet(0, 3), meet(1, 3), meet(2, 3)]
    }
}

impl Deteriorating {
    fn stiffness(&self, at: &DeterioratingState) -> f64 {
        self.stiffness * (1.0 - at.stiffness_loss)
    }

    /// The elongation at the largest force and this force, of the backbone at the start.
    fn cap(&self) -> [f64; 2] {
        let force = self.yield_force + self.post_yield_stiffness * self.capping;
        [self.yield_force / self.stiffness + self.capping, force]
    }

    fn backbone(&self, at: &DeterioratingState, sense: usize) -> Backbone {
        let held = 1.0 - at.strength_loss[sense];
        let (y, slope) = (held * self.yield_force, held * self.post_yield_stiffness);
        let [x, most] = self.cap();
        let falls = most / self.post_capping;
        let start = (most + falls * x) * (1.0 - at.softening_loss[sense]);
        let falls = falls * ((y - self.residual) / (self.yield_force - self.residual)).max(0.0);
        Backbone {
            hardening: [y - slope * y / self.stiffness, slope],
            softening: [start, -falls],
            residual: self.residual,
        }
    }

    /// β of a loss: the energy over what is left of a capacity. One or more where it is used up.
    fn loss(&self, energy: f64, left: f64) -> f64 {
        match energy {
            _ if left.is_infinite() || energy <= 0.0 => 0.0,
            _ if left <= energy => 1.0,
            _ => (energy / left).powf(self.exponent),
        }
    }

    /// The recoverable energy: that of unloading.
    pub fn energy(&self, at: &DeterioratingState) -> f64 {
        if at.is_broken() { 0.0 } else { 0.5 * at.force * at.force / self.stiffness(at) }
    }

    /// The dissipation between two states: the work less the change of the energy.
    pub fn dissipated(&self, from: &DeterioratingState, to: &DeterioratingState) -> f64 {
        to.work - from.work - (self.energy(to) - self.energy(from))
    }

    /// At a reversal: the loss of stiffness.
    fn reverse(&self, at: &mut DeterioratingState) {
        let spent = at.work - self.energy(at);
        let loss = self.loss(spent - at.spent_at_reversal, self.capacities[2] - spent);
        if loss > 0.0 {
            at.stiffness_loss = 1.0 - (1.0 - at.stiffness_loss) * (1.0 - loss);
            at.broken = if loss >= 1.0 { 1.0 } else { at.broken };
            // Unloading recovers more along the softer slope.
            at.spent_at_reversal = at.work - self.energy(at);
        }
    }

    /// At a force of zero: the losses of the sense ahead by the excursion that ends.
    fn begin_excursion(&self, at: &mut DeterioratingState, sense: usize) {
        let energy = at.work - at.work_at_zero;
        at.work_at_zero = at.work;
        let [strength, softening] = [0, 1].map(|k| self.loss(energy, self.capacities[k] - at.work));
        at.strength_loss[sense] = 1.0 - (1.0 - at.strength_loss[sense]) * (1.0 - strength);
        at.softening_loss[sense] = 1.0 - (1.0 - at.softening_loss[sense]) * (1.0 - softening);
        at.broken = if strength >= 1.0 || softening >= 1.0 { 1.0 } else { at.broken };
    }

    /// Moves to the elongation `x`, straight and without another event; returns the slope at the end.
    fn go(&self, at: &mut DeterioratingState, x: f64, sign: f64) -> f64 {
        let k = self.stiffness(at);
        let backbone = self.backbone(at, usize::from(sign > 0.0));
        let [x0, f0] = [sign * at.x, sign * at.force];
        let force = |x: f64| {
            let elastic = f0 + k * (x - x0);
            let [bound, slope] = backbone.force(x);
            if elastic <= bound { [elastic, k] } else { [bound, slope] }
        };
        let end = sign * x;
        let mut stops = backbone.corners(f0 - k * x0, k);
        at.work += area([x0, f0], end, &mut stops, &|x| force(x)[0]);
        let [last, slope] = force(end);
        (at.x, at.force) = (sign * end, sign * last);
        slope
    }

    /// The state at the elongation `x`, on a straight way from `from`, and the slope of the force there.
    pub fn moved(&self, from: &DeterioratingState, x: f64) -> (DeterioratingState, f64) {
        let mut at = *from;
        if at.is_broken() {
            return (DeterioratingState { x, force: 0.0, ..at }, 0.0);
        }
        let way = x - from.x;
        if way == 0.0 {
            return (at, self.stiffness(&at));
        }
        let sign = way.signum();
        if at.way * sign < 0.0 {
            self.reverse(&mut at);
        }
        at.way = sign;
        let mut slope = self.stiffness(&at);
        if at.force * sign < 0.0 {
            let zero = at.x - at.force / slope;
            if (x - zero) * sign <= 0.0 {
                slope = self.go(&mut at, x, sign);
                return (at, slope);
            }
            at.work += 0.5 * at.force * (zero - at.x);
            (at.x, at.force) = (zero, 0.0);
            self.begin_excursion(&mut at, usize::from(sign > 0.0));
        }
        if at.is_broken() {
            return (DeterioratingState { x, force: 0.0, ..at }, 0.0);
        }
        slope = self.go(&mut at, x, sign);
        if x.abs() >= self.ultimate {
            at.broken = 1.0;
        }
        (at, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random reversals: inside and beyond the cap.
    const WAY: [f64; 16] = [
        0.007092989476,
        -0.01942717864,
        0.02128337695,
        -0.0139975383,
        0.02134455051,
        -0.02258815764,
        0.03062266078,
        -0.0377057058,
        0.01755368212,
        -0.01655188734,
        0.04911947429,
        -0.03572401414,
        0.05251655164,
        -0.02012340534,
        0.04312985803,
        -0.05977704318,
    ];

    fn law(capacities: [f64; 3], exponent: f64) -> Deteriorating {
        Deteriorating {
            stiffness: 1e3,
            yield_force: 10.0,
            post_yield_stiffness: 20.0,
            capping: 0.03,
            post_capping: 0.2,
            residual: 0.0,
            ultimate: f64::INFINITY,
            capacities,
            exponent,
        }
    }

    /// Forces at the reversals by the material IMKBilin of OpenSees 3.7.1, with 20,000 steps between two of them.
    #[test]
    fn random_reversals_beside_opensees() {
        let never = f64::INFINITY;
        let runs = [
            ([never; 3], 1.0, [10.225668, 10.412453, 10.116668, -9.5518167]),
            ([9.0, 12.0, never], 1.0, [10.120673, 9.8477957, 9.2409357, -7.501798]),
            ([9.0, 12.0, 15.0], 1.0, [10.121045, 9.8641806, 9.2853289, -7.7419383]),
            ([15.0, 20.0, never], 1.3, [10.21198, 10.323028, 9.9731291, -9.1780864]),
        ];
        for (capacities, exponent, expected) in runs {
            let law = law(capacities, exponent);
            for steps in [1, 7] {
                let (mut state, mut spent, mut forces) = (DeterioratingState::default(), 0.0, Vec::new());
                for end in WAY {
                    let start = state.x;
                    for k in 1..=steps {
                        let next = law.moved(&state, start + (end - start) * f64::from(k) / f64::from(steps)).0;
                        spent += law.dissipated(&state, &next);
                        state = DeterioratingState::of(&next.memory());
                    }
                    forces.push(state.force);
                }
                for (found, expected) in [2, 6, 10, 15].map(|k| forces[k]).iter().zip(expected) {
                    // Eight digits, and the trapezoidal rule of OpenSees over corners.
                    assert!((found / expected - 1.0).abs() < 1e-6, "{capacities:?} {steps}: {found} {expected}");
                }
                assert!((state.work - law.energy(&state) - spent).abs() < 1e-12 * spent, "{spent}");
            }
        }
    }

    /// First loading: the cap, the line to zero, the residual, and the end.
    #[test]
    fn first_loading_by_hand() {
        let law = Deteriorating { residual: 2.0, ultimate: 0.5, ..law([f64::INFINITY; 3], 1.0) };
        let start = DeterioratingState::default();
        for (x, force, slope) in
            [(0.005, 5.0, 1e3), (0.04, 10.6, 20.0), (0.14, 10.6 - 5.3, -53.0), (0.3, 2.0, 0.0), (-0.14, -5.3, -53.0)]
        {
            let (state, found) = law.moved(&start, x);
            assert!((state.force - force).abs() < 1e-12, "{x}: {state:?}");
            // At the cap itself the slope is that of either side.
            assert!((found - slope).abs() < 1e-9 || x == 0.04, "{x}: {found}");
        }
        // 0.05 + 0.309 + the triangle to the residual + the residual, and what the elastic spring gives up.
        let broken = law.moved(&start, 0.5).0;
        let falls = (10.6 - 2.0) / 53.0;
        let area = 0.05 + 0.5 * 20.6 * 0.03 + 0.5 * 12.6 * falls + 2.0 * (0.46 - falls);
        assert!((broken.work - area).abs() < 1e-12 && broken.is_broken());
        assert!((law.dissipated(&start, &broken) - area).abs() < 1e-12);
        assert_eq!(law.moved(&broken, 0.1).0.force, 0.0);
    }

    /// A capacity that is used up leaves nothing.
    #[test]
    fn a_capacity_comes_to_its_end() {
        let law = law([2.0, f64::INFINITY, f64::INFINITY], 1.0);
        let mut state = DeterioratingState::default();
        for k in 0..20 {
            state = law.moved(&state, if k % 2 == 0 { 0.03 } else { -0.03 }).0;
        }
        assert!(state.is_broken() && state.force == 0.0 && state.work < 2.0 + 10.0 * 0.06, "{state:?}");
    }
}
