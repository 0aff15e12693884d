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

    /// Adds what holds of one part of a kind, "beam `a`: ..."; parts of which the same holds share a line.
    pub(super) fn add_of(&mut self, label: &'static str, kind: [&'static str; 2], name: &str, what: impl Into<String>) {
        let (what, named) = (what.into(), format!("`{name}`"));
        let end = format!(": {what}");
        let [one, more] = kind.map(|word| format!("{word} `"));
        let alike = self.computed.iter_mut().find(|(of, line)| {
            *of == label && line.ends_with(&end) && (line.starts_with(&one) || line.starts_with(&more))
        });
        match alike {
            Some((_, line)) => {
                let names = line[..line.len() - end.len()].trim_start_matches(kind[1]).trim_start_matches(kind[0]);
                *line = format!("{}{names}, {named}{end}", kind[1]);
            }
            None => self.computed.push((label, format!("{} {named}{end}", kind[0]))),
        }
    }

    /// The plan of a stage without the lines that hold as in the stage before it.
    pub fn beyond(&self, before: &Explanation) -> Explanation {
        let new = |lines: &[String], old: &[String]| {
            lines.iter().filter(|line| !old.contains(line)).cloned().collect::<Vec<_>>()
        };
        let computed = self.computed.iter().filter(|line| !before.computed.contains(line)).cloned();
        let same = self.computed.len() > computed.clone().count();
        let rest = same.then(|| ("otherwise", "as in the stage before".to_owned()));
        Explanation {
            computed: computed.chain(rest).collect(),
            omitted: new(&self.omitted, &before.omitted),
            avoided: new(&self.avoided, &before.avoided),
            notes: new(&self.notes, &before.notes),
        }
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
