//! The numbers of an explicit Runge-Kutta scheme.

/// The terms of a sum over stages that are not zero: (stage, weight).
pub type StageWeights = &'static [(usize, f64)];

/// The numbers of a scheme. Stages count from 0, at the start of the step; the last is the end of the step, which the next
/// one begins with.
#[derive(Debug, PartialEq)]
pub struct Tableau {
    /// Order of the scheme.
    pub order: usize,
    /// Times of the stages after the first, as fractions of the step.
    pub c: &'static [f64],
    /// Weights of earlier rates in the motion of each stage.
    pub a: &'static [StageWeights],
    /// Weights of the rates of all stages at the end of the step.
    pub b: StageWeights,
    /// Differences to the embedded schemes; where there are two, e₁²/√(e₁² + e₂²/100) is the error.
    pub errors: &'static [StageWeights],
    /// The error of a step decreases with this power of its length.
    pub error_order: f64,
    /// The motion inside a step.
    pub inside: StepPolynomial,
}

/// The numbers of the motion inside a step: the cubic through both ends with their rates, and bubbles that vanish there with their rates.
#[derive(Debug, PartialEq)]
pub struct StepPolynomial {
    /// Times of the further stages, which only this motion needs, as fractions of the step.
    pub c: &'static [f64],
    /// Weights of earlier rates in the motion of each further stage.
    pub a: &'static [StageWeights],
    /// Weights of the rates of all stages in the factors of the bubbles s²(1 − s)², s³(1 − s)², s³(1 − s)³ and s⁴(1 − s)³.
    pub bubbles: &'static [StageWeights],
}

impl Tableau {
    /// Evaluations of a step, the one at its end included.
    pub fn stages(&self) -> usize {
        self.c.len() + 2
    }

    /// Evaluations of a step with its motion inside.
    pub fn all_stages(&self) -> usize {
        self.stages() + self.inside.c.len()
    }

    /// Writes the weights of the rates of all stages in the increment at the fraction `s` of a step, and their derivatives by `s`. Returns both
    /// of its whole increment.
    pub fn weights_inside(&self, s: f64, weights: &mut [[f64; 2]]) -> [f64; 2] {
        let r = 1.0 - s;
        weights.fill([0.0; 2]);
        let mut add = |stage: usize, factor: f64, [value, slope]: [f64; 2]| {
            let [of_value, of_slope] = &mut weights[stage];
            *of_value += factor * value;
            *of_slope += factor * slope;
        };
        let (rs, r2, s2) = (r * s, r * r, s * s);
        let shapes = [
            [r2 * s2, 2.0 * rs * (r - s)],
            [rs * rs * s, s2 * r * (3.0 * r - 2.0 * s)],
            [rs * rs * rs, 3.0 * rs * rs * (r - s)],
            [rs * rs * rs * s, s2 * s * r2 * (4.0 * r - 3.0 * s)],
        ];
        for (shape, bubble) in shapes.into_iter().zip(self.inside.bubbles) {
            bubble.iter().for_each(|&(stage, factor)| add(stage, factor, shape));
        }
        add(0, 1.0, [s * r2, r * (r - 2.0 * s)]);
        add(self.stages() - 1, -1.0, [s2 * r, s * (2.0 * r - s)]);
        [s2 * (1.0 + 2.0 * r), 6.0 * rs]
    }
}
