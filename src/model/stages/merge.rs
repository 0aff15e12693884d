//! Merges the diagnostics of the decks of several stages.

use base::diagnostic::Diagnostic;

/// Merges the diagnostics of the decks of several stages: each one once, with its stages unless it holds for all.
pub fn merge(of_stages: Vec<(String, Vec<Diagnostic>)>) -> Vec<Diagnostic> {
    let count = of_stages.len();
    let mut all: Vec<(Diagnostic, Vec<String>)> = Vec::new();
    for (name, problems) in of_stages {
        for problem in problems {
            match all.iter_mut().find(|(said, _)| *said == problem) {
                Some((_, stages)) => stages.push(name.clone()),
                None => all.push((problem, vec![name.clone()])),
            }
        }
    }
    let told = |(problem, stages): (Diagnostic, Vec<String>)| match stages.len() < count {
        true => {
            let (word, named) = (if stages.len() == 1 { "stage" } else { "stages" }, stages.join("`, `"));
            problem.hint(format!("in {word} `{named}`"))
        }
        false => problem,
    };
    all.into_iter().map(told).collect()
}
