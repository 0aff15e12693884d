//! The results that `accuracy` is about, over one run, and their difference to another run of the same deck with another mesh or other steps.
//!
//! These are displacements of the nodes of nodes.csv, displacements and rotations of bodies, and the quantities of `[[expect]]`. The difference
//! of each is a root mean square over the times of comparison, relative to the largest change of this result.

use super::expect::find;
use super::table::Answers;
use base::math::Vec3;
use model::{Expect, Model, Tolerance};
use nalgebra::Quaternion;
use solve::{Frame, Observer};
use std::io;

/// Results that change less than this part of the largest change of their kind are relative to this part: their own change may be rounding.
const LEAST: f64 = 0.01;

/// The kind of a result.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Displacement,
    Rotation,
    /// An expected value. Its error is relative to this number at least.
    Value(f64),
}

impl Kind {
    /// True where largest changes are comparable.
    fn is_like(self, other: Kind) -> bool {
        matches!((self, other), (Kind::Displacement, Kind::Displacement) | (Kind::Rotation, Kind::Rotation))
    }
}

/// One result over the run.
#[derive(Debug, Clone)]
struct Observed {
    name: String,
    kind: Kind,
    /// One vector or quaternion for each time; NaN where the frame has no value.
    values: Vec<[f64; 4]>,
}

/// The results of one run at the times of comparison.
pub struct ObservedRun {
    results: Vec<Observed>,
    nodes: Vec<usize>,
    bodies: Vec<usize>,
    expects: Vec<(Expect, &'static Answers, usize)>,
    /// The largest distance between nodes at t = 0, the scale between displacements and rotations.
    extent: f64,
}

/// The largest difference between two runs.
#[derive(Debug, Clone, PartialEq)]
pub struct RunDifference {
    /// Its size, relative to the largest change of the result.
    pub size: f64,
    /// The result, such as "displacement of tip".
    pub of: String,
}

impl ObservedRun {
    /// Nothing observed yet of a run of this model.
    pub fn new(model: &Model) -> ObservedRun {
        // Inner nodes of parts stand elsewhere on another mesh.
        let is_named = |node: &&usize| !model.nodes[**node].label.ends_with(']') && !model.nodes[**node].is_number;
        let nodes: Vec<usize> = model.output.nodes.iter().filter(is_named).copied().collect();
        let bodies: Vec<usize> = model.bodies.iter().map(|body| body.node).collect();
        let answered = |expect: &Expect| find(expect.at, &expect.quantity).map(|(all, at)| (expect.clone(), all, at));
        let expects: Vec<_> = model.expects.iter().filter_map(answered).collect();
        let observed = |name: String, kind: Kind| Observed { name, kind, values: Vec::new() };
        let moved =
            nodes.iter().map(|&node| &model.nodes[node].label).chain(model.bodies.iter().map(|body| &body.name));
        let mut results: Vec<Observed> =
            moved.map(|name| observed(format!("displacement of {name}"), Kind::Displacement)).collect();
        results.extend(model.bodies.iter().map(|body| observed(format!("rotation of {}", body.name), Kind::Rotation)));
        results.extend(expects.iter().map(|(expect, ..)| {
            let least = match expect.tolerance {
                Tolerance::Absolute(tolerance) => tolerance,
                _ => expect.value.abs(),
            };
            observed(expect.label.clone(), Kind::Value(least))
        }));
        let places = || model.nodes.iter().filter(|node| !node.is_number).map(|node| node.x);
        let corner = |pick: fn(f64, f64) -> f64| places().reduce(|a, b| a.zip_map(&b, pick)).unwrap_or_default();
        let extent = (corner(f64::max) - corner(f64::min)).norm();
        ObservedRun { results, nodes, bodies, expects, extent }
    }

    /// The largest difference to another run over all results; `None` where the runs have nothing in common. `self` is the finer one.
    pub fn difference(&self, other: &ObservedRun) -> Option<RunDifference> {
        let changes: Vec<f64> = self.results.iter().map(Observed::largest).collect();
        let of_kind = |kind: Kind| {
            let alike = self.results.iter().zip(&changes).filter(|(result, _)| result.kind.is_like(kind));
            alike.map(|(_, change)| *change).fold(0.0, f64::max)
        };
        let moved = of_kind(Kind::Displacement);
        let relative = |(result, change): (&Observed, &f64)| {
            let theirs = other.results.iter().find(|theirs| theirs.name == result.name)?;
            let scale = match result.kind {
                Kind::Displacement => change.max(LEAST * moved),
                Kind::Rotation => change.max(LEAST * of_kind(Kind::Rotation)).max(moved / self.extent),
                Kind::Value(least) => change.max(least),
            };
            let difference = result.difference(theirs)?;
            let size = if difference == 0.0 { 0.0 } else { difference / scale };
            Some(RunDifference { size, of: result.name.clone() })
        };
        let all = self.results.iter().zip(&changes).filter_map(relative);
        // A NaN must not vanish in the maximum.
        all.reduce(|most, one| if one.size > most.size || one.size.is_nan() { one } else { most })
    }
}

impl Observed {
    /// The largest change over the run.
    fn largest(&self) -> f64 {
        let norms = || self.values.iter().map(|value| Vec3::new(value[0], value[1], value[2]).norm());
        let most = || norms().fold(0.0, f64::max);
        match self.kind {
            Kind::Displacement => most(),
            Kind::Rotation => {
                let half = |value: &[f64; 4]| Vec3::new(value[1], value[2], value[3]).norm().min(1.0).asin();
                self.values.iter().map(|value| 2.0 * half(value)).fold(0.0, f64::max)
            }
            Kind::Value(_) => {
                let numbers = || self.values.iter().map(|value| value[0]).filter(|value| value.is_finite());
                let range = numbers().fold(f64::NEG_INFINITY, f64::max) - numbers().fold(f64::INFINITY, f64::min);
                if range > 0.0 { range } else { most() }
            }
        }
    }

    /// The root mean square of the difference over common times; `None` without common times.
    fn difference(&self, other: &Observed) -> Option<f64> {
        let pairs = || self.values.iter().zip(&other.values).filter(|(a, b)| a[0].is_finite() == b[0].is_finite());
        let known = || pairs().filter(|(a, _)| a[0].is_finite());
        let apart = |a: &[f64; 4], b: &[f64; 4]| match self.kind {
            Kind::Rotation => {
                let [p, q] = [a, b].map(|v| Quaternion::new(v[0], v[1], v[2], v[3]));
                2.0 * (p - q).norm().min((p + q).norm())
            }
            _ => (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt(),
        };
        let count = known().count();
        let sum: f64 = known().map(|(a, b)| apart(a, b).powi(2)).sum();
        (count > 0).then(|| (sum / count as f64).sqrt())
    }
}

impl Observer for ObservedRun {
    fn on_step(&mut self, _: &Frame) -> io::Result<()> {
        Ok(())
    }

    fn begin_comparison(&mut self) {
        self.results.iter_mut().for_each(|result| result.values.clear());
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        let Frame { model, state, .. } = frame;
        let moved = self.nodes.iter().chain(&self.bodies).map(|&node| {
            let u = state.nodes[node].moved(&model.nodes[node].x);
            [u.x, u.y, u.z, 0.0]
        });
        let turned = self.bodies.iter().map(|&node| {
            let q = state.nodes[node].rotation;
            [q.w, q.i, q.j, q.k]
        });
        let expected = self.expects.iter().map(|(expect, answers, index)| {
            let value = (answers.value)(expect.at, *index, frame).unwrap_or(f64::NAN);
            [value, 0.0, 0.0, 0.0]
        });
        let all = moved.chain(turned).chain(expected);
        self.results.iter_mut().zip(all).for_each(|(result, value)| result.values.push(value));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(of: &[(&str, Kind, &[f64])]) -> ObservedRun {
        let results = of.iter().map(|(name, kind, numbers)| Observed {
            name: (*name).to_owned(),
            kind: *kind,
            values: numbers.iter().map(|number| [*number, 0.0, 0.0, 0.0]).collect(),
        });
        ObservedRun {
            results: results.collect(),
            nodes: Vec::new(),
            bodies: Vec::new(),
            expects: Vec::new(),
            extent: 1.0,
        }
    }

    #[test]
    fn each_result_is_relative_to_its_own_change() {
        let moved = Kind::Displacement;
        let fine = run(&[("far", moved, &[0.0, 10.0]), ("near", moved, &[0.0, 1.0]), ("held", moved, &[0.0, 0.0])]);
        let other = run(&[("far", moved, &[0.0, 10.1]), ("near", moved, &[0.2, 1.2]), ("held", moved, &[1e-9, 0.0])]);
        let difference = fine.difference(&other).expect("results in common");
        assert_eq!(difference.of, "near");
        assert!((difference.size - 0.2).abs() < 1e-12, "{difference:?}");
    }

    #[test]
    fn an_expected_zero_is_relative_to_its_tolerance() {
        let kind = Kind::Value(1e-3);
        let difference = run(&[("drift", kind, &[0.0, 1e-9])]).difference(&run(&[("drift", kind, &[0.0, 3e-9])]));
        let size = difference.expect("a result in common").size;
        assert!((size - 2e-9 / 2f64.sqrt() / 1e-3).abs() < 1e-15, "{size}");
    }
}
