//! Effort over a coordinate with a backbone of straight lines and isotropic hardening. The yield force F_y(a) grows with the plastic path a in
//! both senses, where ȧ = |q̇_p|. The plastic path of a step is exact, line by line (J. C. Simo, T. J. R. Hughes, Computational Inelasticity,
//! 1998, section 1.4).

use super::hysteresis::{Hysteresis, MOST_POINTS};
use super::slider::CoordinateState;

/// History variables: the plastic part of the coordinate, and the plastic path.
pub const MEMORY: usize = 2;

/// A backbone whose yield force grows with the plastic path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    /// Effort per coordinate before it yields.
    pub stiffness: f64,
    /// The first `count` [plastic path, yield force].
    points: [[f64; 2]; MOST_POINTS],
    count: usize,
    /// Growth of the yield force per plastic path beyond the last.
    after: f64,
}

impl Isotropic {
    /// A backbone through `points`, as [`Hysteresis::new`] has it.
    ///
    /// # Errors
    /// Faults of the points.
    pub fn new(points: &[[f64; 2]], after: f64) -> Result<Isotropic, String> {
        Hysteresis::new(points, after)?;
        let stiffness = points[0][1] / points[0][0];
        let mut by_path = [[0.0; 2]; MOST_POINTS];
        for (own, [q, force]) in by_path.iter_mut().zip(points) {
            *own = [q - force / stiffness, *force];
        }
        by_path[0][0] = 0.0;
        let after = after * stiffness / (stiffness - after);
        Ok(Isotropic { stiffness, points: by_path, count: points.len(), after })
    }

    /// The lines of the yield force: where each begins, the yield force there, its slope, and where it ends.
    fn lines(&self) -> impl Iterator<Item = ([f64; 2], f64, f64)> {
        let points = &self.points[..self.count];
        points.iter().enumerate().map(|(k, &[path, force])| match points.get(k + 1) {
            Some(next) => ([path, force], (next[1] - force) / (next[0] - path), next[0]),
            None => ([path, force], self.after, f64::INFINITY),
        })
    }

    /// The plastic path at a coordinate, and the slope of the effort there.
    fn path(&self, [plastic, path]: [f64; 2], q: f64) -> (f64, f64) {
        let trial = (self.stiffness * (q - plastic)).abs();
        for ([start, force], slope, end) in self.lines().filter(|(.., end)| *end > path) {
            // |trial| − k (a − path) = force + slope (a − start)
            let found = (trial + self.stiffness * path - force + slope * start) / (self.stiffness + slope);
            if found <= path {
                return (path, self.stiffness);
            }
            if found <= end {
                return (found, self.stiffness * slope / (self.stiffness + slope));
            }
        }
        (path, self.stiffness)
    }

    /// The dissipation from the start up to a plastic path.
    fn dissipated(&self, path: f64) -> f64 {
        let of_line = |([start, force], slope, end): ([f64; 2], f64, f64)| {
            let length = path.min(end) - start;
            if length > 0.0 { length * (force + 0.5 * slope * length) } else { 0.0 }
        };
        self.lines().map(of_line).sum()
    }

    /// Effort, slope and stored energy at a coordinate.
    pub fn at(&self, memory: &[f64], q: f64) -> [f64; 3] {
        let from = of(memory);
        let (path, slope) = self.path(from, q);
        let elastic = q - from[0];
        let stretch = elastic - (path - from[1]).copysign(elastic);
        [self.stiffness * stretch, slope, 0.5 * self.stiffness * stretch * stretch]
    }

    /// Lets the memory follow `part` of the way to the coordinate `q`; returns the work that is dissipated on it.
    pub fn follow(&self, q: f64, part: f64, memory: &mut [f64]) -> f64 {
        let from = of(memory);
        let grown = part * (self.path(from, q).0 - from[1]);
        memory.copy_from_slice(&[from[0] + grown.copysign(q - from[0]), from[1] + grown]);
        self.dissipated(from[1] + grown) - self.dissipated(from[1])
    }

    /// Adds effort, slope and energy at the coordinate of `state`.
    pub fn add(&self, memory: &[f64], state: &mut CoordinateState) {
        let [effort, slope, energy] = self.at(memory, state.q);
        state.effort += effort;
        state.by_q += slope;
        state.energy += energy;
    }
}

/// The memory; zero before the first step.
fn of(memory: &[f64]) -> [f64; 2] {
    [0, 1].map(|k| memory.get(k).copied().unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random histories beside the rate equations in small parts of each step: ḟ = k q̇ below the yield force, F_y(a) on it.
    #[test]
    fn random_histories_agree_with_an_independent_integration() {
        let points = [[0.01, 10.0], [0.03, 16.0], [0.08, 18.0]];
        let law = Isotropic::new(&points, 5.0).expect("a backbone");
        let backbone = |q: f64| match q {
            0.0..0.01 => 1000.0 * q,
            0.01..0.03 => 10.0 + 300.0 * (q - 0.01),
            0.03..0.08 => 16.0 + 40.0 * (q - 0.03),
            _ => 18.0 + 5.0 * (q - 0.08),
        };
        // F_y(a) from the backbone alone: the coordinate of first loading with the plastic part a.
        let yield_force = |a: f64| {
            let (mut low, mut high) = (0.01, 100.0);
            for _ in 0..45 {
                let middle = 0.5 * (low + high);
                if middle - backbone(middle) / 1000.0 < a { low = middle } else { high = middle }
            }
            backbone(low)
        };
        let (mut seed, mut memory, mut q, mut dissipated) = (7u64, [0.0; MEMORY], 0.0, 0.0);
        let (mut force, mut path, mut lost) = (0.0f64, 0.0, 0.0);
        const PARTS: usize = 400;
        for _ in 0..100 {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let next = 0.06 * ((seed >> 33) as f64 / f64::from(1u32 << 30) - 1.0);
            for _ in 0..PARTS {
                let trial = force + 1000.0 * (next - q) / PARTS as f64;
                // The plastic part of a small step: from its own equation by bisection.
                let (mut low, mut high) = (0.0, trial.abs() / 1000.0);
                for _ in 0..45 {
                    let grown = 0.5 * (low + high);
                    if trial.abs() - 1000.0 * grown > yield_force(path + grown) { low = grown } else { high = grown }
                }
                lost += low * (yield_force(path) + yield_force(path + low)) / 2.0;
                path += low;
                force = trial - (1000.0 * low).copysign(trial);
            }
            let [effort, slope, energy] = law.at(&memory, next);
            let [above, ..] = law.at(&memory, next + 1e-9);
            dissipated += law.follow(next, 1.0, &mut memory);
            q = next;
            // Rounding of the bisections in 40,000 parts.
            assert!((effort - force).abs() < 1e-6 * 18.0, "{effort} {force}");
            // The trapezoidal rule errs by ΔH a²/8 at two kinks of the yield force, where parts have a plastic path a of up to 3e-4.
            assert!((dissipated - lost).abs() < 1e-5 + 1e-6 * lost && energy >= 0.0, "{dissipated} {lost}");
            assert!((above - effort - 1e-9 * slope).abs() < 1e-10, "{slope}");
        }
        assert!(path > 0.2);
    }
}
