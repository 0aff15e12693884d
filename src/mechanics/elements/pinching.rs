//! Hysteresis that aims at the largest elongation so far, with pinching, damage and softer unloading, after F. C. Filippou (material Hysteretic of
//! OpenSees, M. H. Scott).
//!
//! First loading follows a symmetric backbone of up to three points. Unloading has the slope K μ^-b, where μ is the largest elongation
//! over that of the first point, before which nothing is remembered. Reloading begins at the elongation without force x₀ and aims at the
//! largest elongation X so far in its sense, of force Y, in two lines. They meet at the force p_f Y and the elongation x₀ + p_x (X − (1 −
//! p_f) Y/K − x₀). At each reversal, X grows by the part d₁ (μ − 1) + d₂ E/A, with the energy E dissipated so far and twice the area A/2
//! below the backbone. A step runs straight, and its events are found exactly.

use super::piecewise::area;

/// The number of history variables.
pub const MEMORY: usize = 8;
/// The largest number of points of a backbone.
pub const MOST_POINTS: usize = 3;

/// The parameters of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pinching {
    /// The backbone; a point that is not given repeats the one before.
    points: [[f64; 2]; MOST_POINTS],
    /// A.
    area: f64,
    /// How it reloads.
    reloading: Reloading,
}

/// How a law reloads and unloads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reloading {
    /// p_f: 1 without pinching.
    pub force: f64,
    /// p_x: 1 without pinching.
    pub elongation: f64,
    /// d₁ and d₂.
    pub damage: [f64; 2],
    /// b.
    pub unloading: f64,
}

/// What a law remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PinchingState {
    /// Elongation.
    pub x: f64,
    /// Force.
    pub force: f64,
    /// ∫ F dx.
    pub work: f64,
    /// The sign of the last motion.
    way: f64,
    /// Targets of reloading downwards and upwards, 0 or more.
    targets: [f64; 2],
    /// Elongations without force after the last unloading from below and from above, positive in the sense that they begin.
    zeros: [f64; 2],
}

impl PinchingState {
    /// Of its history variables; all zero where there are none yet.
    pub fn of(memory: &[f64]) -> PinchingState {
        match memory {
            &[x, force, work, way, a, b, c, d, ..] => {
                PinchingState { x, force, work, way, targets: [a, b], zeros: [c, d] }
            }
            _ => PinchingState::default(),
        }
    }

    /// Its history variables.
    pub fn memory(&self) -> [f64; MEMORY] {
        let ([a, b], [c, d]) = (self.targets, self.zeros);
        [self.x, self.force, self.work, self.way, a, b, c, d]
    }
}

impl Pinching {
    /// A law with this backbone.
    ///
    /// # Errors
    /// Reports faults of the points.
    pub fn new(points: &[[f64; 2]], reloading: Reloading) -> Result<Pinching, String> {
        if points.is_empty() || points.len() > MOST_POINTS {
            return Err(format!("it takes 1 to {MOST_POINTS} points"));
        }
        if !points.windows(2).all(|pair| pair[1][0] > pair[0][0]) || points[0][0].is_nan() || points[0][0] <= 0.0 {
            return Err("coordinates must grow from above 0 on".into());
        }
        if !points.iter().all(|point| point[1] > 0.0) {
            return Err("efforts must be above 0".into());
        }
        let slope = points[0][1] / points[0][0];
        let steep = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]) > slope;
        if points.windows(2).any(steep) {
            return Err("no line may be steeper than the first".into());
        }
        let all = std::array::from_fn(|k| points[k.min(points.len() - 1)]);
        let starts = std::iter::once(&[0.0, 0.0]).chain(points);
        let area = starts.zip(points).map(|(a, b)| (b[0] - a[0]) * (a[1] + b[1])).sum();
        Ok(Pinching { points: all, area, reloading })
    }

    /// The slope of first loading.
    pub fn stiffness(&self) -> f64 {
        self.points[0][1] / self.points[0][0]
    }

    /// Force and slope of the backbone at an elongation of 0 or more. The last line goes on if it rises.
    fn backbone(&self, x: f64) -> [f64; 2] {
        let [first, second, third] = self.points;
        let line = |a: [f64; 2], b: [f64; 2], goes_on: bool| {
            let slope = (b[1] - a[1]) / (b[0] - a[0]);
            let slope = if goes_on && slope.is_nan() || x > b[0] && slope < 0.0 { 0.0 } else { slope };
            let start = if x > b[0] && slope == 0.0 { b } else { a };
            [start[1] + slope * (x - start[0]), slope]
        };
        match x {
            _ if x <= first[0] => line([0.0, 0.0], first, false),
            _ if x <= second[0] => line(first, second, false),
            _ if third == second => line(first, second, true),
            _ => line(second, third, false),
        }
    }

    /// The slope of unloading after the largest elongation `target`.
    fn unloading(&self, target: f64) -> f64 {
        let ductility = (target / self.points[0][0]).max(1.0);
        self.stiffness() * ductility.powf(-self.reloading.unloading)
    }

    /// The recoverable energy: that of unloading.
    pub fn energy(&self, at: &PinchingState) -> f64 {
        let k = self.unloading(at.targets[usize::from(at.force > 0.0)]);
        0.5 * at.force * at.force / k
    }

    /// The dissipation between two states: the work less the change of the energy.
    pub fn dissipated(&self, from: &PinchingState, to: &PinchingState) -> f64 {
        to.work - from.work - (self.energy(to) - self.energy(from))
    }

    /// At a reversal: the target ahead grows by the damage, and reloading begins where the force is zero.
    fn reverse(&self, at: &mut PinchingState, sense: usize, sign: f64) {
        if at.force * sign > 0.0 {
            return;
        }
        let behind = at.targets[1 - sense];
        let k = self.unloading(behind);
        at.zeros[sense] = sign * (at.x - at.force / k);
        let yields = self.points[0][0];
        if behind > yields {
            let [by_ductility, by_energy] = self.reloading.damage;
            let spent = at.work - 0.5 * at.force * at.force / k;
            at.targets[sense] *= 1.0 + by_ductility * (behind - yields) / yields + by_energy * spent / self.area;
        }
    }

    /// The state at the elongation `x`, on a straight way from `from`, and the slope of the force there.
    pub fn moved(&self, from: &PinchingState, x: f64) -> (PinchingState, f64) {
        let mut at = *from;
        let way = x - from.x;
        if way == 0.0 {
            return (at, self.unloading(at.targets[usize::from(at.force > 0.0)]));
        }
        let sign = way.signum();
        let sense = usize::from(sign > 0.0);
        if at.way * sign < 0.0 {
            self.reverse(&mut at, sense, sign);
        }
        at.way = sign;
        let [x0, f0] = [sign * at.x, sign * at.force];
        let (ahead, yields) = (at.targets[sense], self.points[0][0]);
        let target = match at.targets {
            targets if targets.iter().all(|target| *target <= yields) => f64::NEG_INFINITY,
            _ if x0 >= ahead => ahead,
            _ => ahead.max(yields),
        };
        let path = Path::new(self, target, (at.zeros[sense], at.targets[1 - sense]), [x0, f0]);
        let end = sign * x;
        let mut stops = path.stops();
        at.work += area([x0, f0], end, &mut stops, &|x| path.force(x)[0]);
        let [force, slope] = path.force(end);
        (at.x, at.force) = (sign * end, sign * force);
        at.targets[sense] = ahead.max(target).max(end);
        (at, slope)
    }
}

/// The force on a way in one sense, in which all is positive.
struct Path<'a> {
    law: &'a Pinching,
    target: f64,
    zero: f64,
    start: [f64; 2],
    /// Slopes before the force is zero and after.
    slopes: [f64; 2],
    /// Where the lines of reloading meet.
    knee: [f64; 2],
    /// Force of the target.
    top: f64,
}

impl Path<'_> {
    fn new(law: &Pinching, target: f64, (zero, behind): (f64, f64), start: [f64; 2]) -> Path<'_> {
        let top = law.backbone(target)[0];
        let slopes = [law.unloading(behind), law.unloading(target)];
        let held = law.reloading.force;
        let straight = target - (1.0 - held) * top / slopes[1];
        let knee = [zero + law.reloading.elongation * (straight - zero), held * top];
        Path { law, target, zero, start, slopes, knee, top }
    }

    /// Lines of reloading up to the knee and beyond, as force at zero elongation and slope.
    fn lines(&self) -> [[f64; 2]; 2] {
        let [x, f] = self.knee;
        let [low, high] = [f / (x - self.zero), (self.top - f) / (self.target - x)];
        [[-low * self.zero, low], [f - high * x, high]]
    }

    /// The line of the start where the force is above zero.
    fn elastic(&self) -> [f64; 2] {
        let [x, f] = self.start;
        let k = self.slopes[1];
        if x < self.zero { [-k * self.zero, k] } else { [f - k * x, k] }
    }

    fn force(&self, x: f64) -> [f64; 2] {
        if x >= self.target {
            return self.law.backbone(x);
        }
        if x < self.zero {
            let force = self.start[1] + self.slopes[0] * (x - self.start[0]);
            return if force < 0.0 { [force, self.slopes[0]] } else { [0.0, 0.0] };
        }
        let [bound, elastic] = [self.lines()[usize::from(x >= self.knee[0])], self.elastic()];
        let [a, b] = [elastic, bound].map(|[f, k]| [f + k * x, k]);
        if a[0] < b[0] { a } else { b }
    }

    fn stops(&self) -> [f64; 10] {
        let [low, high] = self.lines();
        let meet = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) / (a[1] - b[1]);
        let elastic = self.elastic();
        let [a, b, c] = self.law.points.map(|point| point[0]);
        let rest = self.start[0] - self.start[1] / self.slopes[0];
        [self.zero, self.knee[0], self.target, rest, meet(elastic, low), meet(elastic, high), a, b, c, c]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random reversals, then some before zero force.
    const WAY: [f64; 22] = [
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
        0.03,
        0.02,
        0.045,
        -0.01,
        -0.005,
        -0.03,
    ];
    const BACKBONE: [[f64; 2]; 3] = [[0.01, 10.0], [0.03, 12.0], [0.1, 6.0]];

    /// Forces at the reversals by the material Hysteretic of OpenSees 3.7.1, with 20,000 steps between two of them.
    #[test]
    fn random_reversals_beside_opensees() {
        let none = Reloading { force: 1.0, elongation: 1.0, damage: [0.0; 2], unloading: 0.0 };
        let pinched = Reloading { force: 0.4, elongation: 0.7, ..none };
        let damaged = Reloading { damage: [0.02, 0.05], unloading: 0.3, ..pinched };
        let runs = [
            (none, [-8.93424701, -6.13079556, -11.04562863, -4.30538506]),
            (pinched, [-8.29628822, -4.19761558, -10.85279699, -2.73565980]),
            (damaged, [-8.15608863, -4.04963961, -8.79902698, -0.90982502]),
        ];
        for (reloading, expected) in runs {
            let law = Pinching::new(&BACKBONE, reloading).expect("a backbone");
            for steps in [1, 7] {
                let (mut state, mut spent, mut forces) = (PinchingState::default(), 0.0, Vec::new());
                for end in WAY {
                    let start = state.x;
                    for k in 1..=steps {
                        let next = law.moved(&state, start + (end - start) * f64::from(k) / f64::from(steps)).0;
                        let lost = law.dissipated(&state, &next);
                        assert!(lost > -1e-14, "{lost}");
                        spent += lost;
                        state = PinchingState::of(&next.memory());
                    }
                    forces.push(state.force);
                }
                for (found, expected) in [3, 9, 11, 21].map(|k| forces[k]).iter().zip(expected) {
                    // Digits of the values.
                    assert!((found - expected).abs() < 2e-8, "{reloading:?} {steps}: {found} {expected}");
                }
                assert!((state.work - law.energy(&state) - spent).abs() < 1e-12 * spent, "{spent}");
            }
        }
    }

    /// Below the first point nothing is remembered, whatever the pinching.
    #[test]
    fn it_is_elastic_before_it_yields() {
        let reloading = Reloading { force: 0.3, elongation: 0.5, damage: [0.1; 2], unloading: 0.5 };
        let law = Pinching::new(&[[0.01, 10.0]], reloading).expect("a backbone");
        let mut state = PinchingState::default();
        for x in [0.009, 0.001, 0.005, -0.008, 0.0099, -0.001] {
            state = law.moved(&state, x).0;
            assert!((state.force - 1e3 * x).abs() < 1e-14, "{x}: {state:?}");
        }
        // A backbone of one point is flat beyond it.
        assert_eq!(law.moved(&state, 0.07).0.force, 10.0);
    }
}
