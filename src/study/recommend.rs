//! The deck lines of the cheapest setting that reaches an error, with its margin.

use super::cells::{float, seconds};
use super::cheapest::{noise, seconds_range};
use super::confirmation::Confirmation;
use super::found::Found;
use super::run::{RunStatus, StudyRun};
use base::names::short;
use deck::Deck;

/// The deck lines, as TOML with comments, of the cheapest run whose error is at most this one for certain.
///
/// # Errors
/// No run reaches it; the error says by how much, and what to do.
pub fn recommend(found: &Found, deck: &Deck, wanted: f64) -> Result<String, String> {
    let reference = found.reference.as_ref().map_err(|reason| format!("no error is known: {reason}"))?;
    let runs = || found.runs.iter().filter(|run| run.status == RunStatus::Done);
    let most = |run: &StudyRun| run.error_range().map_or(f64::INFINITY, |[_, most]| most);
    let reaching = || runs().filter(|run| most(run) <= wanted);
    let Some(best) = reaching().min_by(|a, b| a.loop_s.total_cmp(&b.loop_s)) else {
        let nearest = runs().min_by(|a, b| most(a).total_cmp(&most(b)));
        return Err(none(found, nearest, reference.error_bound, wanted));
    };
    let noise = noise(&found.runs);
    let slowest = seconds_range(best, noise)[1];
    let equal = reaching()
        .filter(|run| !std::ptr::eq(*run, best) && seconds_range(run, noise)[0] <= slowest)
        .map(|run| name(found, run));
    let equal: Vec<String> = equal.collect();
    let mut lines = margin(found, best, reference.error_bound, wanted);
    if !equal.is_empty() {
        lines.push(format!("# equal within noise: {}", equal.join("; ")));
    }
    if let Confirmation::Disagrees(_) = reference.confirmation {
        lines.push(format!("# the reference is {}", reference.confirmation.in_words()));
    }
    lines.extend(setting(found, deck, best));
    Ok(lines.join("\n") + "\n")
}

/// A run in words.
fn name(found: &Found, run: &StudyRun) -> String {
    let line = &found.grid.lines[run.line];
    let what =
        if line.automatic { line.resolution(run.resolution) } else { format!("time step {}", short(run.resolution)) };
    format!("{}, {what}", line.label)
}

/// Why nothing is recommended.
fn none(found: &Found, nearest: Option<&StudyRun>, bound: f64, wanted: f64) -> String {
    let Some(run) = nearest.filter(|run| run.error.is_some()) else {
        return format!("no setting reaches an error of {wanted:e}: no run has an error");
    };
    let [least, most] = run.error_range().unwrap_or([f64::NAN; 2]);
    let nearest = format!("the nearest is {}", name(found, run));
    let remedy = "shorter time steps or smaller tolerances, and finer meshes (--meshes)";
    if least <= wanted {
        format!(
            "no setting reaches an error of {wanted:e} for certain: {nearest}, at most {most:.1e}, for the reference is known to \
             {bound:.1e} only: take {remedy}, or give a reference"
        )
    } else {
        format!("no setting reaches an error of {wanted:e}: {nearest}, with {least:.1e} to {most:.1e}: take {remedy}")
    }
}

/// The error and the cost of the setting, as comments.
fn margin(found: &Found, run: &StudyRun, bound: f64, wanted: f64) -> Vec<String> {
    let most = run.error_range().map_or(f64::NAN, |[_, most]| most);
    let reached = run.error.filter(|_| run.resolved).map_or(String::new(), |error| format!("{error:.2e}, "));
    let known = if bound > 0.0 { format!("; the reference is known to {bound:.1e}") } else { String::new() };
    let m = &run.measured;
    let others = match m.other_runs {
        0 => String::new(),
        runs => {
            let (iterations, factorizations) = (m.other_iterations, m.other_factorizations);
            format!("; {runs} other runs for its error: {iterations} iterations, {factorizations} factorizations")
        }
    };
    vec![
        format!("# {}: {}", found.deck, name(found, run)),
        format!(
            "# error {reached}at most {most:.2e}: {:.2} times below the {wanted:e} asked for{known}",
            wanted / most
        ),
        format!(
            "# time stepping {} s, {} steps, {} iterations, {} factorizations{others}",
            seconds(run.loop_s),
            m.steps,
            m.iterations,
            m.factorizations
        ),
    ]
}

/// The lines of the deck, and the command that runs it so.
fn setting(found: &Found, deck: &Deck, run: &StudyRun) -> Vec<String> {
    let (grid, line) = (&found.grid, &found.grid.lines[run.line]);
    let mut lines = vec!["[analysis]".to_owned()];
    match line.automatic {
        true => {
            lines.extend(["time_step = \"auto\"".to_owned(), format!("error_tolerance = {}", float(run.resolution))])
        }
        false => {
            lines.push(format!("time_step = {}", float(run.resolution)));
            if deck.analysis.as_ref().is_some_and(|analysis| analysis.error_tolerance.is_some()) {
                lines.push("# without `error_tolerance`".to_owned());
            }
        }
    }
    let (mut iteration, mut parts) = (Vec::new(), Vec::new());
    for set in &line.sets {
        let (key, value) = set.split_once('=').unwrap_or((set, ""));
        if key == "integrator" {
            let entries = value.trim_matches(|letter| "{} ".contains(letter));
            lines.extend(["[integrator]".to_owned()].into_iter().chain(entries.split(", ").map(str::to_owned)));
        } else if let Some(key) = key.strip_prefix("iteration.") {
            iteration.push(format!("{key} = {value}"));
        } else if let Some((part, key)) = key.rsplit_once('.') {
            let part = deck.parts().find(|of| of.table_path() == part).map_or(part.to_owned(), |of| of.title());
            parts.push(format!("# {part}: {key} = {value}"));
        }
    }
    if !iteration.is_empty() {
        lines.push("[iteration]".to_owned());
        lines.extend(iteration);
    }
    let interval = grid.end_time / grid.samples as f64;
    let ends_at_samples = line.automatic && !line.family.looks_inside();
    if ends_at_samples {
        lines.push("[output]".to_owned());
        lines.push(format!("interval = {}", float(interval)));
        lines.push("# the error was measured with steps that end at these times, in place of `every`".to_owned());
    }
    lines.extend(parts);
    let quoted = |set: String| format!(" --set '{set}'");
    let sets: String = grid.setting(run.line, run.resolution).into_iter().map(quoted).collect();
    let every = deck.output.as_ref().is_some_and(|output| output.every.is_some());
    let at =
        if ends_at_samples && !every { format!(" --set 'output.interval={}'", float(interval)) } else { String::new() };
    lines.push(format!("# rdsolve run {}{sets}{at}", found.deck));
    lines
}
