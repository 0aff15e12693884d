//! The plan in words, for `rdsolve check`, the log and result.json: what will be computed, what is omitted and why.

mod analysis;
mod omitted;
mod scene;
mod solution;

use super::Plan;
use crate::linear::Solver;
use crate::model::Model;
use crate::system::System;
use std::fmt::{self, Display, Formatter};

/// What a plan comes to. Whoever prints it may add lines of what comes before and after the plan.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Explanation {
    /// What a line is about, and what it says.
    pub computed: Vec<(&'static str, String)>,
    pub omitted: Vec<String>,
    /// What the omissions come to, where it can be counted.
    pub avoided: Vec<String>,
    /// What the reader of a result must know.
    pub notes: Vec<String>,
}

impl Explanation {
    fn add(&mut self, label: &'static str, what: impl Into<String>) {
        self.computed.push((label, what.into()));
    }
}

impl Display for Explanation {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        writeln!(f, "computed")?;
        self.computed.iter().try_for_each(|(label, what)| writeln!(f, "  {label:<11} {what}"))?;
        for (head, lines) in [("omitted", &self.omitted), ("operations avoided", &self.avoided), ("notes", &self.notes)]
        {
            if !lines.is_empty() {
                writeln!(f, "{head}")?;
                lines.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
            }
        }
        Ok(())
    }
}

impl Plan {
    /// What will be computed, what is omitted and why.
    pub fn explain(&self, model: &Model, system: &System) -> Explanation {
        let mut text = Explanation::default();
        analysis::explain(&mut text, model);
        scene::explain(&mut text, self, model, system);
        solution::explain(&mut text, self, model, system);
        text.omitted = omitted::list(self, model, system);
        text.notes.extend(self.repeated(model, system));
        text
    }

    /// The same, with the factorization and what the omissions avoid, which take a while to count.
    pub fn explain_costs(&self, model: &Model, system: &System, solver: &Solver) -> Explanation {
        let mut text = self.explain(model, system);
        if !self.explicit || self.masses(system).is_none() {
            text.add("factor", solver.describe());
        }
        text.avoided = self.savings(model, system);
        text
    }
}
