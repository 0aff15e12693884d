//! The lines of text about a plan.

use std::fmt::{self, Display, Formatter};

/// A plan in words. The printer may add lines before and after the plan.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Explanation {
    /// The label of each line, and its text.
    pub computed: Vec<(&'static str, String)>,
    /// The omissions, and why.
    pub omitted: Vec<String>,
    /// Operations avoided by the omissions, if countable.
    pub avoided: Vec<String>,
    /// Notes for readers of the results.
    pub notes: Vec<String>,
}

impl Explanation {
    /// Adds a line to the computed items.
    pub(super) fn add(&mut self, label: &'static str, what: impl Into<String>) {
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
