//! Results of elements in linear statics: their derivatives along the motion, at t = 0.
//!
//! Elements know finite motions only. Their results are odd functions of a factor on the motion, so central differences of sixth order give
//! the derivative with an error of h⁶ f⁽⁷⁾/140.

use super::equations::LinearSolution;
use crate::context::Context;
use crate::derived::{Derived, Request, Wanted};
use crate::system::{Loading, renew_stresses};
use crate::tolerances::linear_statics::{FIRST, SECOND, STEPS, TURN};
use base::math::Vec6;
use mechanics::integrators::RotationUpdate;
use mechanics::state::{Increment, Node, State};

/// Derivatives of results along a motion.
pub struct Derivatives {
    /// The state at a factor of the motion.
    sample: State,
    at_sample: Derived,
    loading: Loading,
}

/// What derivatives are taken of, and when it is shown.
pub struct AskedResults {
    /// The quantities.
    pub wanted: Wanted,
    /// True where tables are due.
    pub due: bool,
    /// True where fields are drawn.
    pub drawn: bool,
}

impl Derivatives {
    /// Room for the derivatives of a scene.
    pub fn new(cx: &Context, state: &State) -> Derivatives {
        Derivatives { sample: state.clone(), at_sample: Derived::new(cx.model), loading: Loading::default() }
    }

    /// Writes the wanted results of a solution into `out`.
    pub fn compute(
        &mut self,
        cx: &Context,
        nodes: &[Node],
        (solution, loading): (&LinearSolution, &Loading),
        asked: &AskedResults,
        out: &mut Derived,
    ) {
        let step = step(cx, nodes, &solution.motions);
        let nothing = loading.plus(-1.0, loading);
        let mut is_first = true;
        for (k, factor) in STEPS.into_iter().enumerate() {
            for side in [1.0, -1.0] {
                let at = side * factor * step;
                self.place(nodes, &solution.motions, at);
                self.loading = nothing.plus(at, loading);
                let request = Request {
                    model: cx.model,
                    system: cx.system,
                    excitation: &cx.excitation,
                    state: &self.sample,
                    loads: Some(&self.loading),
                    begins: false,
                    due: asked.due,
                    drawn: asked.drawn,
                    balance: None,
                    threads: cx.plan.threads,
                };
                self.at_sample.compute(asked.wanted, &request);
                let weights = [side * FIRST[k] / step, 0.5 * SECOND[k] / (step * step)];
                if std::mem::take(&mut is_first) {
                    out.take_from(&self.at_sample);
                    add(out, &self.at_sample, weights, 0.0);
                } else {
                    add(out, &self.at_sample, weights, 1.0);
                }
            }
        }
        finish(cx, nodes, solution, out);
    }

    /// Places all nodes at a factor of the motion.
    fn place(&mut self, nodes: &[Node], motions: &[Vec6], factor: f64) {
        for ((node, start), motion) in self.sample.nodes.iter_mut().zip(nodes).zip(motions) {
            let increment = Increment { q: factor * motion, ..Increment::ZERO };
            node.advance(start, &increment, RotationUpdate::Exponential);
        }
    }
}

/// The factor on the motion with which nothing turns or stretches or heats by more than [`TURN`].
fn step(cx: &Context, nodes: &[Node], motions: &[Vec6]) -> f64 {
    let turn = motions.iter().map(|motion| motion.fixed_rows::<3>(3).amax()).fold(0.0, f64::max);
    let mut largest = turn;
    for group in &cx.system.groups {
        if let Some(heat) = cx.model.parts[group.part].heat() {
            // Strain by temperature, and the turn over the length of the part.
            for (of, number) in heat.numbers.iter().enumerate().filter_map(|(of, number)| Some((of, (*number)?))) {
                let size = if of == 0 { heat.length } else { 1.0 };
                largest = largest.max(motions[number].x.abs() / size);
            }
        }
        for e in 0..group.block.len() {
            let of = group.block.nodes(e);
            // Numbers are no places.
            let places = of.iter().take_while(|node| !cx.model.nodes[**node].is_number).count();
            for pair in of[..places].windows(2) {
                let apart = (nodes[pair[1]].x - nodes[pair[0]].x).norm();
                let moved = (motions[pair[1]] - motions[pair[0]]).fixed_rows::<3>(0).norm();
                if apart > 0.0 {
                    largest = largest.max(moved / apart);
                }
            }
        }
    }
    if largest > 0.0 { TURN / (STEPS[2] * largest) } else { 1.0 }
}

/// Replaces each number of `out` by `keep` times itself plus that of a sample with its weight: [first, second] derivative.
fn add(out: &mut Derived, sample: &Derived, [first, second]: [f64; 2], keep: f64) {
    let mut odd = |sum: &mut f64, value: f64| *sum = keep * *sum + first * value;
    for (sum, of) in out.links.iter_mut().zip(&sample.links) {
        odd(&mut sum.elongation, of.elongation);
        odd(&mut sum.force, of.force);
        for i in 0..3 {
            odd(&mut sum.f[i], of.f[i]);
            odd(&mut sum.m[i], of.m[i]);
        }
    }
    for (sum, of) in out.sections.iter_mut().zip(&sample.sections) {
        sum.at.forces.iter_mut().zip(of.at.forces).for_each(|(sum, of)| odd(sum, of));
    }
    for (sum, of) in out.shells.iter_mut().zip(&sample.shells) {
        sum.at.combine(&of.at, &mut odd);
    }
    for (sum, of) in out.nodal_resultants.iter_mut().zip(&sample.nodal_resultants) {
        sum.iter_mut().zip(of).for_each(|(sum, of)| odd(sum, *of));
    }
    out.bars.iter_mut().zip(&sample.bars).for_each(|(sum, of)| odd(sum, *of));
    let even = |sum: &mut f64, value: f64| *sum = keep * *sum + second * value;
    out.parts.iter_mut().zip(&sample.parts).for_each(|(sum, of)| even(&mut sum.strain, of.strain));
    if let (Some(sum), Some(of)) = (&mut out.energy, &sample.energy) {
        even(&mut sum.strain, of.strain);
        even(&mut sum.links, of.links);
    }
}

/// Completes what follows from the solution itself.
fn finish(cx: &Context, nodes: &[Node], solution: &LinearSolution, out: &mut Derived) {
    renew_stresses(cx.model, &mut out.sections);
    if !out.joints.is_empty() {
        cx.system.joint_states(nodes, &solution.multipliers, &mut out.joints);
    }
    if let Some(energy) = &mut out.energy {
        energy.mechanical = energy.strain + energy.links;
        energy.external = solution.work;
        energy.numerical = energy.external - energy.mechanical;
    }
}
