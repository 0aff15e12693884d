//! What the omissions of a plan save: the matrix with each of them undone, against that of the plan.

use super::place::Why;
use super::{Plan, grouped, structure};
use crate::linear::{Factorization, Structure, operations};
use crate::model::{AnalysisKind, Model};
use crate::system::System;
use crate::system::assembly::{NONE, loose_cliques};

/// Savings of less are not worth a line.
const WORTH: f64 = 1.05;

impl Plan {
    /// A line for each omission whose saving can be counted. The counts are those of the matrix of a step: nothing is run.
    pub fn savings(&self, model: &Model, system: &System) -> Vec<String> {
        if self.explicit || self.directions.is_empty() {
            return Vec::new();
        }
        let own = operations(&self.structure);
        let mut out = Vec::new();
        let mut compare = |what: &str, with: &Structure| {
            let unknowns: usize = with.sizes.iter().sum();
            let times = operations(with) / own;
            if times >= WORTH {
                out.push(format!(
                    "{what}: with them {unknowns} unknowns and {times:.1} times the operations of a factorisation"
                ));
            }
        };
        let kept = [
            (Why::Plane, "directions out of the plane"),
            (Why::Still, "masses that nothing sets moving"),
            (Why::Held, "held directions"),
        ];
        for (why, what) in kept {
            compare(what, &structure(system, &self.rows_with(why)));
        }
        if !system.attachments.is_empty() {
            compare("multipliers of attached nodes", &self.with_multipliers(system));
        }
        if self.kind == Factorization::Cholesky && !self.linear {
            out.push(
                "the unsymmetric part of the tangent: with it 2 times the operations of a factorisation".to_string(),
            );
        }
        if self.linear && model.analysis.kind == AnalysisKind::Dynamic {
            out.push("iterations: the scene is linear, one solve a step is exact".to_string());
        }
        out
    }

    /// Rows with the directions left out for this reason kept; their numbers mean nothing.
    fn rows_with(&self, why: Why) -> Vec<[u32; 6]> {
        let mut rows = self.rows.clone();
        for (rows, place) in rows.iter_mut().zip(&self.nodes) {
            for (row, reason) in rows.iter_mut().zip(place) {
                *row = if *reason == why { 0 } else { *row };
            }
        }
        rows
    }

    /// Riders with unknowns of their own and a multiplier for each direction that rides.
    fn with_multipliers(&self, system: &System) -> Structure {
        let mut rows = self.rows_with(Why::Rides);
        let joints = rows.len() - self.nodes.len();
        let nodes = rows.len();
        rows.extend(system.attachments.iter().map(|rider| rider.dofs.map(|rides| if rides { 0 } else { NONE })));
        grouped(&rows, loose_cliques(system, nodes), joints + system.attachments.len())
    }
}
