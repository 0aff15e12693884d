//! A study in words: the table of runs, measured orders, the cheapest setting.

use super::asked;
use super::cells::seconds;
use super::cheapest::Cheapest;
use super::columns::columns;
use super::confirmation::Confirmation;
use super::found::Found;
use super::lines::StudyLine;
use super::order::{Order, local};
use super::run::{RunStatus, StudyRun, spread};
use super::section::StudySection;
use base::names::short;

/// The header of the table of runs.
pub const HEAD: [&str; 9] =
    ["setting", "time step", "error", "order", "loop s", "process s", "iterations", "factorizations", "status"];

/// The error of a run to three digits, or its bound; empty if it is unknown.
pub fn error(run: &StudyRun) -> String {
    match run.error {
        Some(error) if run.resolved => format!("{error:.2e}"),
        Some(error) => format!("<= {error:.1e}"),
        None => String::new(),
    }
}

/// The cells of all runs, in the columns of [`HEAD`].
pub fn cells(found: &Found) -> Vec<Vec<String>> {
    let mut before: Option<&StudyRun> = None;
    let mut rows = Vec::new();
    for run in &found.runs {
        let line = &found.grid.lines[run.line];
        let order = local(before.filter(|before| before.line == run.line), run);
        before = Some(run);
        // Counts of the other runs of automatic steps stand apart: "120 + 340".
        let count = |own: u64, others: u64| match run.measured.steps {
            0 => String::new(),
            _ if others > 0 => format!("{own} + {others}"),
            _ => own.to_string(),
        };
        let cuts = if run.measured.cuts > 0 { format!(", {} cuts", run.measured.cuts) } else { String::new() };
        let status = match run.status {
            RunStatus::Done => format!("done{cuts}"),
            status => format!("{}: {}", status.word(), run.reason),
        };
        rows.push(vec![
            line.label.clone(),
            line.resolution(run.resolution),
            error(run),
            order.map_or(String::new(), |order| format!("{order:.2}")),
            if run.measured.steps > 0 { seconds(run.loop_s) } else { String::new() },
            seconds(run.process_s),
            count(run.measured.iterations, run.measured.other_iterations),
            count(run.measured.factorizations, run.measured.other_factorizations),
            status,
        ]);
    }
    rows
}

/// The measured order of a line: "1.99 over time steps 0.01 to 0.00125 (4 runs)", or why there is none.
pub fn order(line: &StudyLine, order: &Result<Order, &str>) -> String {
    let order = match order {
        Ok(order) => order,
        Err(reason) => return (*reason).to_owned(),
    };
    let (from, to) = (short(order.from), short(order.to));
    let floor = order.floor.map_or(String::new(), |floor| format!("; levels off at {floor:.1e}"));
    let caution = if order.runs < 3 { ", which is few" } else { "" };
    let what = if line.automatic { "tolerances" } else { "time steps" };
    format!("{:.2} over {what} {from} to {to} ({} runs{caution}){floor}", order.order, order.runs)
}

/// The cost of an error on a line: "loop 0.0021 s, process 0.0070 s, time step 0.0071".
pub fn cost(line: &StudyLine, of: &Cheapest) -> String {
    let what = if line.automatic { "tolerance" } else { "time step" };
    let bound = if of.at_the_top { ", the coarsest setting run" } else { "" };
    let (loop_s, process_s) = (seconds(of.loop_s), seconds(of.process_s));
    format!("loop {loop_s} s, process {process_s} s, {what} {}{bound}", short(of.resolution))
}

/// The reference of the errors, and the compared quantities.
pub fn reference(found: &Found) -> String {
    let (samples, count) = (found.grid.samples + 1, found.quantities.len());
    let against = match &found.reference {
        Err(reason) => return format!("no reference: {reason}"),
        Ok(reference) if reference.error_bound > 0.0 || reference.confirmation != Confirmation::None => {
            let known = match reference.error_bound {
                bound if bound > 0.0 => format!("; its own error is at most about {bound:.1e}"),
                _ => String::new(),
            };
            format!("{}{known}; {}", reference.source, reference.confirmation.in_words())
        }
        Ok(reference) => reference.source.clone(),
    };
    let quantities = if count == 1 { "quantity" } else { "quantities" };
    format!("{against}; {count} {quantities} at {samples} times")
}

/// How times were taken, and how far they scatter.
pub fn timing(found: &Found) -> String {
    let most = found.runs.iter().map(|run| run.times.len()).max().unwrap_or(0);
    match spread(&found.runs) {
        Some(spread) => {
            format!("times: least of up to {most} runs in turn, whose median is {spread:.2} times as long\n")
        }
        None => "times: of one run each\n".to_owned(),
    }
}

/// The outcome of a study for standard output: reference, table of runs, orders, the cheapest settings.
pub fn text(found: &Found) -> String {
    let mut rows = vec![HEAD.map(String::from).to_vec()];
    rows.extend(cells(found));
    let mut text = format!("reference: {}\n{}", reference(found), timing(found));
    if !found.grid.fitted.is_empty() {
        let fitted: Vec<String> =
            found.grid.fitted.iter().map(|(asked, step)| format!("{} for {}", short(*step), short(*asked))).collect();
        text += &format!("time steps shortened to fit between samples: {}\n", fitted.join(", "));
    }
    if found.grid.lines.iter().any(|line| line.automatic) {
        text += "automatic steps end at all sample times; a plain run may take longer steps, with larger errors\n";
    }
    text += &format!("\n{}\nmeasured order\n", columns(&rows, 1));
    let label = |line: usize| found.grid.lines[line].label.clone();
    let orders: Vec<Vec<String>> = found
        .orders
        .iter()
        .enumerate()
        .map(|(line, of)| vec![format!("  {}", label(line)), order(&found.grid.lines[line], of)])
        .collect();
    text += &columns(&orders, 1);
    for (wanted, list) in &found.cheapest {
        text += &format!("\ncheapest for an error of {wanted:e}\n");
        if list.is_empty() {
            text += "  no run reaches it\n";
            continue;
        }
        let rows: Vec<Vec<String>> = list
            .iter()
            .map(|of| {
                let line = &found.grid.lines[of.line];
                vec![format!("  {}", label(of.line)), rank(of, list), cost(line, of)]
            })
            .collect();
        text += &columns(&rows, 1);
    }
    text + &asked(found).text()
}

/// How dear a line is beside the cheapest: "x 1.35", or that the two are equal within noise.
pub fn rank(of: &Cheapest, list: &[Cheapest]) -> String {
    let times = of.loop_s / list[0].loop_s;
    let equal = match list {
        [first, others @ ..] if first.line == of.line => others.iter().any(|other| other.equals(first)),
        [first, ..] => of.equals(first),
        [] => false,
    };
    if equal { format!("x {times:.2}, equal within noise") } else { format!("x {times:.2}") }
}

/// Requested and reached errors.
pub fn asked(found: &Found) -> StudySection {
    asked::section(&found.grid, &found.asked)
}
