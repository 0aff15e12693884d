//! What a linear analysis is solved for, one after the other: times, or load cases.

use crate::context::Context;
use crate::control::{Interval, Schedule};
use crate::system::{Loading, Prescribed, Side};
use model::{Actors, CaseActor, LoadCase};

/// One set of loads and prescribed motions.
pub struct Instant {
    /// The time.
    pub time: f64,
    /// The load case, by its place in the model; `None` at a time.
    pub case: Option<usize>,
    /// True where tables are due, whatever the cadence says.
    pub due: bool,
    /// True where runs are compared.
    pub compared: bool,
}

/// All of them, in order.
pub fn instants(cx: &Context, schedule: &Schedule) -> Vec<Instant> {
    let cases = cx.model.cases.list.len();
    if cases > 0 {
        let time = cx.model.analysis.end_time;
        return (0..cases).map(|case| Instant { time, case: Some(case), due: true, compared: false }).collect();
    }
    let of_interval = |interval: &Interval| {
        let (interval, &Interval { steps, due, compared, .. }) = (*interval, interval);
        (1..=steps).map(move |k| {
            let ends = k == steps;
            Instant { time: interval.time(k), case: None, due: due && ends, compared: compared && ends }
        })
    };
    schedule.intervals.iter().flat_map(of_interval).collect()
}

impl Instant {
    /// Writes its loads and prescribed motions.
    pub fn excite(&self, cx: &Context, loading: &mut Loading, prescribed: &mut Vec<Prescribed>) {
        cx.excitation.loading(self.time, Side::Before, loading);
        cx.excitation.prescribed(self.time, Side::Before, prescribed);
        if let Some(case) = self.case {
            select(cx, &cx.model.cases.list[case], loading, prescribed);
        }
    }
}

/// Leaves of all loads those of a case, with its factors.
fn select(cx: &Context, case: &LoadCase, loading: &mut Loading, prescribed: &mut [Prescribed]) {
    let all = loading.clone();
    let given = prescribed.to_vec();
    *loading = all.plus(-1.0, &all);
    prescribed.fill(Prescribed::default());
    for term in &case.terms {
        match &term.acts {
            CaseActor::Gravity => loading.field += term.factor * all.field,
            CaseActor::Named(Actors { nodal, pressures, centrifugal, motions, .. }) => {
                nodal.clone().for_each(|i| loading.factors[i] += term.factor * all.factors[i]);
                pressures.clone().for_each(|i| loading.pressures[i] += term.factor * all.pressures[i]);
                centrifugal.clone().for_each(|i| loading.squares[i] += term.factor * all.squares[i]);
                let restraints = &cx.model.constraints.restraints;
                for &[node, dof] in motions {
                    if let Ok(at) = restraints.binary_search_by_key(&(node, dof), |held| (held.node, held.dof)) {
                        prescribed[at].u += term.factor * given[at].u;
                    }
                }
            }
        }
    }
}
