//! Lines of text about a plan.

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
