//! The motion inside the last step of an explicit Runge-Kutta scheme: its polynomial, and the work up to there.

use crate::context::Context;
use crate::step::trial::rates_of;
use crate::step::work::{Power, WorkQuadrature};
use base::math::Vec6;
use mechanics::integrators::tableau::Tableau;
use mechanics::state::{Increment, State};

/// The data of a completed step besides the rates of its stages. It is allocated once.
pub struct InsideStep {
    /// Increments q and velocities at the end of the step, of the independent nodes.
    ends: Vec<[Vec6; 2]>,
    /// The power of each stage.
    pub powers: Vec<Power>,
    /// Work of the whole step.
    work: WorkQuadrature,
    /// Weights of the rates of all stages at the time that was asked for last, and of the increment of the whole step, each with its
    /// derivative.
    weights: Vec<[f64; 2]>,
    whole: [f64; 2],
    /// True once the further stages of the step have been evaluated.
    pub is_complete: bool,
}

impl InsideStep {
    /// Room for the steps of this scheme.
    pub fn new(cx: &Context, tableau: &Tableau) -> InsideStep {
        InsideStep {
            ends: vec![[Vec6::zeros(); 2]; cx.independent_nodes.len()],
            powers: vec![Power::default(); tableau.all_stages()],
            work: WorkQuadrature::default(),
            weights: vec![[0.0; 2]; tableau.all_stages()],
            whole: [0.0; 2],
            is_complete: false,
        }
    }

    /// Begins with the increments of a step that has led to `state`, and its work. Joints may have changed the rates at its end, which `rates`
    /// holds by independent node.
    pub fn begin(
        &mut self,
        cx: &Context,
        increments: &[Increment],
        state: &State,
        (rates, work): (&mut [[Vec6; 2]], WorkQuadrature),
    ) {
        for ((end, rates), &node) in self.ends.iter_mut().zip(rates).zip(&cx.independent_nodes) {
            let (increment, now) = (&increments[node], &state.nodes[node]);
            let [v, a] = rates_of(now);
            *end = [increment.q, v];
            *rates = [increment.d, a];
        }
        (self.work, self.is_complete) = (work, false);
    }

    /// Writes the increments, velocities and accelerations at the fraction `part` of the step of length `dt` from `start`.
    pub fn move_to(
        &mut self,
        cx: &Context,
        increments: &mut [Increment],
        (start, part, dt): (&State, f64, f64),
        (tableau, stages): (&Tableau, &[[Vec6; 2]]),
    ) {
        self.whole = tableau.weights_inside(part, &mut self.weights);
        let (nodes, [whole, slope]) = (cx.independent_nodes.len(), self.whole);
        for (k, (&node, [q_end, v_end])) in cx.independent_nodes.iter().zip(&self.ends).enumerate() {
            let [v_start, _] = rates_of(&start.nodes[node]);
            let [mut q, mut v, mut a] = [Vec6::zeros(); 3];
            for (stage, [weight, slope]) in self.weights.iter().enumerate() {
                let [dq, dv] = &stages[stage * nodes + k];
                q += dq * *weight;
                v += dv * *weight;
                a += dv * *slope;
            }
            let grown = v_end - v_start;
            increments[node] = Increment {
                q: q_end * whole + q * dt,
                d: v_start + grown * whole + v * dt,
                dd: grown * (slope / dt) + a,
            };
        }
    }

    /// The work up to that time.
    pub fn work(&self, dt: f64) -> WorkQuadrature {
        let mut work = self.work.part(self.whole[0]);
        self.powers.iter().zip(&self.weights).for_each(|(power, [weight, _])| work.add(power, dt * weight));
        work.within(&self.work)
    }
}
