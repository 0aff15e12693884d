//! ESDIRK3(2)5L\[2\]SA: four implicit stages with one matrix, third order, stage order two. It is L-stable and removes unresolved motion.
//! C. A. Kennedy, M. H. Carpenter, NASA/TM-2016-219173 (2016), whence the coefficients; they are proved by the order conditions below.

use std::f64::consts::SQRT_2 as R;
use std::sync::Arc;

use super::coefficients::Coefficients;
use super::scheme::{MakeScheme, Scheme, SchemeKind, Stepping};
use super::stage_tableau::StageTableau;
use base::math::rotation::RotationUpdate;

/// The scheme's word and maker.
pub static KIND: SchemeKind = SchemeKind {
    word: "esdirk3",
    aliases: &["esdirk"],
    guesses: &["dirk", "dirk3", "sdirk", "radau", "radau5", "kennedy-carpenter"],
    about: "Kennedy and Carpenter's ESDIRK3(2)5L[2]SA: implicit, four stages a step, of third order, L-stable; it damps the modes that the step \
            does not resolve. The cheapest where errors of 1e-3 and less are asked for.",
    keys: &[],
    make: MakeScheme { scheme: |_, rotation| Arc::new(Esdirk3 { rotation }), rotation_update: true },
};

/// The scheme of third order.
#[derive(Debug, Clone, PartialEq)]
pub struct Esdirk3 {
    /// The update of rotations.
    pub rotation: RotationUpdate,
}

impl Scheme for Esdirk3 {
    fn word(&self) -> &'static str {
        KIND.word
    }

    fn in_words(&self) -> String {
        KIND.word.to_owned()
    }

    fn order(&self) -> usize {
        TABLEAU.order
    }

    fn stepping(&self) -> Stepping<'_> {
        Stepping::DiagonallyImplicit(&TABLEAU)
    }

    fn coefficients(&self, dt: f64) -> Coefficients {
        TABLEAU.coefficients(dt, self.rotation)
    }
}

const GAMMA: f64 = 9.0 / 40.0;
const A3: f64 = 9.0 * (1.0 + R) / 80.0;
const A4: f64 = (22.0 + 15.0 * R) / (80.0 * (1.0 + R));
const A43: f64 = -7.0 / (40.0 * (1.0 + R));
const B1: f64 = (2398.0 + 1205.0 * R) / (2835.0 * (4.0 + 3.0 * R));
const B3: f64 = -2374.0 * (1.0 + 2.0 * R) / (2835.0 * (5.0 + 3.0 * R));
const B4: f64 = 5827.0 / 7560.0;

/// The coefficients.
pub static TABLEAU: StageTableau = StageTableau {
    order: 3,
    gamma: GAMMA,
    c: &[9.0 / 20.0, 9.0 * (2.0 + R) / 40.0, 0.6, 1.0],
    a: &[&[(0, GAMMA)], &[(0, A3), (1, A3)], &[(0, A4), (1, A4), (2, A43)], &[(0, B1), (1, B1), (2, B3), (3, B4)]],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::spectrum::spectrum;

    /// Rows of A and times c of all stages, the first included.
    fn stages() -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut rows = vec![vec![0.0; TABLEAU.stages()]];
        for (stage, weights) in TABLEAU.a.iter().enumerate() {
            let mut row = vec![0.0; TABLEAU.stages()];
            weights.iter().for_each(|&(of, weight)| row[of] = weight);
            row[stage + 1] = TABLEAU.gamma;
            rows.push(row);
        }
        (rows, std::iter::once(0.0).chain(TABLEAU.c.iter().copied()).collect())
    }

    /// The conditions of third order, and of second order in every stage, hold to rounding.
    #[test]
    fn conditions_of_order() {
        let (a, c) = stages();
        let dot = |row: &[f64], of: &dyn Fn(usize) -> f64| (0..c.len()).map(|j| row[j] * of(j)).sum::<f64>();
        for (row, time) in a.iter().zip(&c) {
            assert!((dot(row, &|_| 1.0) - time).abs() < 4.0 * f64::EPSILON);
            assert!((dot(row, &|j| c[j]) - 0.5 * time * time).abs() < 4.0 * f64::EPSILON);
        }
        let b = &a[c.len() - 1];
        assert!((dot(b, &|j| c[j] * c[j]) - 1.0 / 3.0).abs() < 4.0 * f64::EPSILON);
        assert!((dot(b, &|i| dot(&a[i], &|j| c[j])) - 1.0 / 6.0).abs() < 4.0 * f64::EPSILON);
    }

    /// A parabola is met by the second derivative over the stages, and by the prediction of those that have three before them.
    #[test]
    fn weights_of_the_stages() {
        let (_, c) = stages();
        let parabola = |time: f64| 3.0 - 2.0 * time + 0.7 * time * time;
        let second: f64 =
            TABLEAU.second_derivative().iter().zip(&c).map(|(weight, &time)| weight * parabola(time)).sum();
        assert!((second - 1.4).abs() < 1e-13, "{second}"); // weights of up to 10, each rounded
        for stage in 3..c.len() {
            let weights = TABLEAU.extrapolation(stage);
            let predicted: f64 = weights.iter().zip(&c).map(|(weight, &time)| weight * parabola(time)).sum();
            assert!((predicted - parabola(c[stage])).abs() < 1e-13, "stage {stage}: {predicted}");
        }
    }

    /// Damping and period elongation per period at 10, 20 and 40 implicit stages a period. The reference is an independent evaluation of
    /// R(iωΔt), to two digits; a step removes unresolved motion.
    #[test]
    fn spectrum_of_the_free_oscillator() {
        let scheme = Esdirk3 { rotation: RotationUpdate::Exponential };
        for (stages, damping, phase) in [(10.0, 1.0e-2, 2.8e-2), (20.0, 4.2e-3, 2.5e-3), (40.0, 7.5e-4, 1.8e-4)] {
            let got = spectrum(&scheme, std::f64::consts::TAU * 4.0 / stages);
            let decrement = std::f64::consts::TAU * got.damping;
            assert!((decrement / damping - 1.0).abs() < 0.1, "{stages}: {got:?}");
            assert!((got.elongation.abs() / phase - 1.0).abs() < 0.1, "{stages}: {got:?}");
        }
        let unresolved = spectrum(&scheme, 1e4);
        assert!(unresolved.damping > 0.9, "{unresolved:?}");
    }
}
