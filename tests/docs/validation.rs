//! docs/validation.md: what decks expect and what comes out.

use super::{cell, keep, read, root, with_generated};
use rdsolve::output::expect::Verdict;

/// What one deck expected, and what came out.
pub struct Validated {
    /// Below `decks/`, without the file `deck.toml`.
    pub deck: String,
    pub title: String,
    pub verdicts: Vec<Verdict>,
}

/// A row of the table: what is the same everywhere, and numbers whose last digits differ between processors.
struct Row {
    words: String,
    computed: String,
    deviation: String,
    /// What a deviation is measured by: one, or where it is absolute the size of the quantity.
    scale: f64,
}

fn number(value: f64) -> String {
    let text = format!("{value:.4e}");
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-3..1e5 => format!("{}", text.parse::<f64>().unwrap()),
        _ => text,
    }
}

fn rows(decks: &[Validated]) -> Vec<Row> {
    let mut rows = Vec::new();
    for deck in decks {
        for (k, v) in deck.verdicts.iter().enumerate() {
            let path =
                if deck.deck.ends_with(".toml") { deck.deck.clone() } else { format!("{}/deck.toml", deck.deck) };
            let scene = if k == 0 { format!("[{}](../decks/{path})", cell(&deck.title)) } else { String::new() };
            let expected = number(v.expected);
            let expected = v.bound.map_or(expected.clone(), |bound| format!("{bound} {expected}"));
            let words = format!("| {scene} | {} | {} | {expected} |", cell(&v.label), cell(&v.source));
            let error = v.error.unwrap_or(f64::NAN).abs();
            let scale = match (v.relative, v.expected) {
                (true, _) => 1.0,
                (false, 0.0) => v.tolerance,
                (false, expected) => expected.abs(),
            };
            let deviation = match (v.bound, v.relative) {
                (Some(_), _) => "met".to_owned(),
                (None, _) if error < 1e-6 * scale => "< 1e-6".to_owned(),
                (None, true) => format!("{error:.1e}"),
                (None, false) => format!("{error:.1e} abs."),
            };
            rows.push(Row { words, computed: v.value.map_or("-".to_owned(), number), deviation, scale });
        }
    }
    rows
}

/// Deviations that differ as those of two processors may.
fn alike(found: &str, row: &Row) -> bool {
    let parse = |text: &str| match text {
        "< 1e-6" => Ok(1e-6 * row.scale),
        text => text.trim_end_matches(" abs.").parse::<f64>(),
    };
    match (parse(found), parse(&row.deviation)) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.11 * a.max(b) + 1e-5 * row.scale,
        _ => found == row.deviation,
    }
}

/// Compares docs/validation.md with what has come out, or writes it. Handed over by the test that runs every deck.
pub fn keep_validation(decks: &[Validated]) {
    let page = read(&root().join("docs/validation.md"));
    let rows = rows(decks);
    let head = "\n| scene | value | source | expected | computed | deviation |\n|---|---|---|---|---|---|\n";
    let lines: Vec<String> = rows.iter().map(|r| format!("{} {} | {} |", r.words, r.computed, r.deviation)).collect();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        let text = format!("{head}{}\n\n", lines.join("\n"));
        return keep("docs/validation.md", &with_generated(&page, &text));
    }
    // Other tables stand above and below.
    let (_, generated) = page.split_once(head).expect("the head of the generated table");
    let found: Vec<&str> = generated.lines().take_while(|line| line.starts_with("| ")).collect();
    let in_step = found.len() == rows.len()
        && found.iter().zip(&rows).all(|(line, row)| {
            let rest = line.strip_prefix(&row.words).and_then(|rest| rest.trim().strip_suffix(" |"));
            rest.and_then(|rest| rest.split_once(" | "))
                .is_some_and(|(computed, deviation)| close(computed, row) && alike(deviation, row))
        });
    let differs = found.iter().zip(&lines).find(|(a, b)| a != b);
    assert!(
        in_step,
        "docs/validation.md is out of step: UPDATE_DOCS=1 cargo test --test all -- docs decks writes it anew; see {differs:?}"
    );
}

/// To the digits that are shown, but for the last one; what is zero but for rounding is zero.
fn close(found: &str, row: &Row) -> bool {
    match (found.parse::<f64>(), row.computed.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 3e-4 * a.abs().max(b.abs()) + 1e-5 * row.scale.min(1.0),
        _ => found == row.computed,
    }
}
