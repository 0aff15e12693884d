//! A set of thousands of nodes with the same mistake is one message.

use base::diagnostic::{Diagnostic, Severity};
use base::names::quoted;
use std::collections::HashMap;

/// Names that are listed; of the others, how many there are.
const LISTED: usize = 4;

/// Merges messages with the same words for several names at one place: the first message, then the next names and the count. The name is
/// the first thing that a message quotes.
pub(super) fn merge_diagnostics(problems: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut kept: Vec<(Diagnostic, Others)> = Vec::with_capacity(problems.len());
    let mut places: HashMap<Sameness, usize> = HashMap::new();
    for problem in problems {
        let (Some(same), name) = split(&problem) else {
            kept.push((problem, Others::default()));
            continue;
        };
        let next = kept.len();
        let place = *places.entry(same).or_insert(next);
        if place == next {
            kept.push((problem, Others { names: vec![name], count: 0 }));
        } else {
            kept[place].1.add(name);
        }
    }
    kept.into_iter().map(|(problem, others)| others.told(problem)).collect()
}

/// Equal for messages that are put together: place, severity, words before and after the name, hints.
type Sameness = (usize, usize, Severity, String, String, Vec<String>);

fn split(problem: &Diagnostic) -> (Option<Sameness>, String) {
    let parts = || {
        let (before, rest) = problem.message.split_once('`')?;
        let (name, after) = rest.split_once('`')?;
        let place = problem.place.as_ref().filter(|_| problem.excerpt.is_none())?;
        let severe = problem.severity;
        // The name may stand in what follows again.
        let plain = |text: &str| text.replace(&format!("`{name}`"), "``");
        let hints = problem.hints.iter().map(|hint| plain(hint)).collect();
        let same = (place.start, place.end, severe, before.to_owned(), plain(after), hints);
        Some((same, name.to_owned()))
    };
    parts().map_or((None, String::new()), |(same, name)| (Some(same), name))
}

/// The other names of one message.
#[derive(Default)]
struct Others {
    /// The first one, and the next few, each once.
    names: Vec<String>,
    /// Number of names without the first.
    count: usize,
}

impl Others {
    fn add(&mut self, name: String) {
        self.count += 1;
        if self.names.len() <= LISTED && !self.names.contains(&name) {
            self.names.push(name);
        }
    }

    fn told(self, problem: Diagnostic) -> Diagnostic {
        let (listed, count) = (self.names.get(1..).unwrap_or_default(), self.count);
        match (count, listed.len()) {
            (0, _) => problem,
            (_, 0) => problem.hint(format!("the same {count} more times")),
            (_, n) if n == count => {
                problem.hint(format!("the same goes for {}", quoted(listed.iter().map(String::as_str))))
            }
            (_, n) => {
                let names: Vec<String> = listed.iter().map(|name| format!("`{name}`")).collect();
                problem.hint(format!("the same goes for {} and {} more", names.join(", "), count - n))
            }
        }
    }
}
