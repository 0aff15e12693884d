//! Effort of a plastic hinge or a yielding damper over its coordinate: parallel springs with slip limits, and one without (Iwan, J. Appl.
//! Mech. 33, 1966). First loading follows the backbone, which is piecewise linear and symmetric. Unloading and reloading follow the
//! backbone twice as large (Masing), with kinematic hardening.

use super::slider::{CoordinateState, DryFriction};

/// The largest number of points of a backbone.
pub const MOST_POINTS: usize = 6;

/// A backbone as springs side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hysteresis {
    /// The first `count` of them act.
    sliders: [DryFriction; MOST_POINTS],
    count: usize,
    /// Effort per coordinate beyond the last point.
    after: f64,
}

impl Hysteresis {
    /// A backbone through `points`, [coordinate, effort] from the first yielding on, which goes on with the slope `after`.
    ///
    /// # Errors
    /// Reports faults of the points: too many, not rising, or a growing slope.
    pub fn new(points: &[[f64; 2]], after: f64) -> Result<Hysteresis, String> {
        if points.is_empty() || points.len() > MOST_POINTS {
            return Err(format!("it takes 1 to {MOST_POINTS} points"));
        }
        let starts = std::iter::once(&[0.0, 0.0]).chain(points);
        let mut slopes: Vec<f64> = starts.zip(points).map(|(a, b)| (b[1] - a[1]) / (b[0] - a[0])).collect();
        slopes.push(after);
        let rises = points.windows(2).all(|pair| pair[1][0] > pair[0][0]) && points[0][0] > 0.0 && points[0][1] > 0.0;
        if !rises {
            return Err("coordinates must grow from above 0 on, and the first effort must be above 0".into());
        }
        if slopes.iter().any(|slope| slope.is_nan() || *slope < 0.0) {
            return Err("efforts must not fall".into());
        }
        // Equal slopes to rounding make a point of no effect.
        if slopes.windows(2).any(|pair| pair[1] > pair[0] * (1.0 + 1e-9)) {
            return Err("each line must be less steep than the one before".into());
        }
        let mut sliders = [DryFriction { limit: 0.0, stiffness: 0.0 }; MOST_POINTS];
        for (k, slider) in sliders[..points.len()].iter_mut().enumerate() {
            let stiffness = (slopes[k] - slopes[k + 1]).max(0.0);
            *slider = DryFriction { limit: stiffness * points[k][0], stiffness };
        }
        Ok(Hysteresis { sliders, count: points.len(), after })
    }

    /// Effort per coordinate before anything yields.
    pub fn stiffness(&self) -> f64 {
        self.after + self.acting().map(|slider| slider.stiffness).sum::<f64>()
    }

    /// The number of history variables: the anchor of each slider.
    pub fn memory(&self) -> usize {
        self.count
    }

    /// Adds effort, stiffness and energy at a coordinate.
    pub fn add(&self, anchors: &[f64], state: &mut CoordinateState) {
        state.effort += self.after * state.q;
        state.by_q += self.after;
        state.energy += 0.5 * self.after * state.q * state.q;
        for (slider, anchor) in self.acting().zip(anchors) {
            slider.add(*anchor, state);
        }
    }

    /// Lets the anchors follow `part` of the way to the coordinate `q`; returns the work that is dissipated on it.
    pub fn follow(&self, q: f64, part: f64, anchors: &mut [f64]) -> f64 {
        let follow = |(slider, anchor): (&DryFriction, &mut f64)| {
            let slip = part * slider.stretch(q, *anchor).1;
            *anchor += slip;
            slider.limit * slip.abs()
        };
        self.acting().zip(anchors).map(follow).sum()
    }

    /// The sliders that are there; one without stiffness has no effect.
    fn acting(&self) -> impl Iterator<Item = &DryFriction> {
        self.sliders[..self.count].iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::coordinate_law::{CoordinateLaw, MEMORY};
    use crate::elements::path_law::PathLaw;

    fn effort(law: &CoordinateLaw, q: f64, anchors: &[f64]) -> CoordinateState {
        let memory: Vec<f64> = [0.0; MEMORY].into_iter().chain(anchors.iter().copied()).collect();
        law.at(q, 0.0, &memory, 0.0)
    }

    #[test]
    fn the_first_loading_follows_the_backbone_and_the_next_twice_of_it() {
        let points = [[0.01, 10.0], [0.03, 16.0], [0.08, 18.0]];
        let hysteresis = Hysteresis::new(&points, 5.0).unwrap();
        let law = CoordinateLaw { hysteresis: Some(PathLaw::Backbone(hysteresis)), ..CoordinateLaw::FREE };
        let backbone = |q: f64| match q {
            0.0..0.01 => 1000.0 * q,
            0.01..0.03 => 10.0 + 300.0 * (q - 0.01),
            0.03..0.08 => 16.0 + 40.0 * (q - 0.03),
            _ => 18.0 + 5.0 * (q - 0.08),
        };
        let mut anchors = [0.0; 3];
        let mut dissipated = 0.0;
        // Sums of three springs and one: rounding of some 1e-14.
        for q in [0.004, 0.02, 0.05, 0.1] {
            assert!((effort(&law, q, &anchors).effort - backbone(q)).abs() < 1e-12);
            dissipated += hysteresis.follow(q, 1.0, &mut anchors);
        }
        let top = backbone(0.1);
        for back in [0.01, 0.05, 0.09, 0.15, 0.2] {
            let expected = top - 2.0 * backbone(0.5 * back);
            assert!((effort(&law, 0.1 - back, &anchors).effort - expected).abs() < 1e-12, "{back} back");
            dissipated += hysteresis.follow(0.1 - back, 1.0, &mut anchors);
        }
        assert!(dissipated > 0.0);
    }

    #[test]
    fn what_is_put_in_is_stored_or_dissipated() {
        let hysteresis = Hysteresis::new(&[[0.01, 10.0], [0.03, 12.0]], 0.0).unwrap();
        let law = CoordinateLaw { hysteresis: Some(PathLaw::Backbone(hysteresis)), ..CoordinateLaw::FREE };
        let mut anchors = [0.0; 2];
        let (mut work, mut dissipated, mut q) = (0.0, 0.0, 0.0);
        let way = (0..4000).map(|k| 0.05 * (k as f64 * 0.004).sin());
        let mut before = effort(&law, q, &anchors);
        for next in way {
            let now = effort(&law, next, &anchors);
            dissipated += hysteresis.follow(next, 1.0, &mut anchors);
            work += 0.5 * (before.effort + now.effort) * (next - q);
            (before, q) = (now, next);
        }
        // The trapezoidal rule errs where a slider begins to slip within a step: some ten times, by k h^2 / 8 with h = 2e-4 each.
        assert!((work - before.energy - dissipated).abs() < 10.0 * 1000.0 * 4e-8 / 8.0, "{work} {dissipated}");
    }
}
