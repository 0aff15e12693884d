//! study.svg: error against the time of the time stepping, or a count, both by decades, with one curve a line of settings. It needs no
//! fonts or scripts, and is legible on light and on dark paper.

use super::cells::seconds;
use super::chart::{Axis, FRAME, LETTER, legend, line, mark, open, pen, rules, text, titles};
use super::cost::Cost;
use super::found::Found;
use super::lines::StudyLine;
use super::run::StudyRun;

/// The picture of a study over a cost.
pub fn draw(found: &Found, cost: Cost) -> String {
    let [left, top, width, height] = FRAME;
    let shown = |run: &&StudyRun| run.error.is_some_and(|error| error > 0.0) && cost.of(run).is_some();
    let runs: Vec<&StudyRun> = found.runs.iter().filter(shown).collect();
    let errors: Vec<f64> = runs.iter().filter_map(|run| run.error).collect();
    let costs: Vec<f64> = runs.iter().filter_map(|run| cost.of(run)).collect();
    let letters = found.grid.lines.iter().map(|line| line.label.chars().count()).max().unwrap_or(0).max(28);
    let whole = left + width + 52.0 + LETTER * letters as f64;
    let (x, y) = (Axis::new(&costs, [left, left + width]), Axis::new(&errors, [top + height, top]));
    let mut out = open(whole, &format!("Error against {}", cost.word())) + &axes(&x, &y, found, cost);
    for (index, setting) in found.grid.lines.iter().enumerate() {
        let of_line: Vec<&StudyRun> = runs.iter().copied().filter(|run| run.line == index).collect();
        out += &curve(index, setting, &of_line, [&x, &y], cost);
    }
    if runs.is_empty() {
        out += &text(
            "middle",
            left + 0.5 * width,
            top + 0.5 * height,
            &format!("no run has an error and {}", cost.word()),
        );
    }
    if runs.iter().any(|run| !run.resolved) {
        let at = top + height + 42.0;
        out += &text("start", left + width + 16.0, at, "hollow: an upper bound, below the");
        out += &text("start", left + width + 16.0, at + 16.0, "resolution of the reference");
    }
    out + "</svg>\n"
}

/// The frame with its rules, the errors asked for, and the titles of the axes.
fn axes(x: &Axis, y: &Axis, found: &Found, cost: Cost) -> String {
    let [left, _, width, _] = FRAME;
    let mut out = rules(x, y);
    for (wanted, _) in &found.cheapest {
        if (y.low..=y.high).contains(&wanted.log10()) {
            out += &line("wanted", [left, y.at(*wanted), left + width, y.at(*wanted)]);
        }
    }
    out + &titles(cost.title(), "relative error")
}

/// The curve of a line of settings, and its entry in the legend.
fn curve(index: usize, setting: &StudyLine, runs: &[&StudyRun], [x, y]: [&Axis; 2], cost: Cost) -> String {
    let (colour, dashes) = pen(index);
    let point = |run: &&StudyRun| Some(format!("{:.1},{:.1}", x.at(cost.of(run)?), y.at(run.error?)));
    let points: Vec<String> = runs.iter().filter_map(point).collect();
    let stroke = format!("stroke=\"{colour}\" stroke-width=\"1.8\"");
    let mut out = format!("<polyline points=\"{}\" fill=\"none\" {stroke}{dashes}/>\n", points.join(" "));
    for run in runs {
        let (Some(error), Some(across)) = (run.error, cost.of(run)) else { continue };
        let title = format!(
            "{}, {}: error {}{error:.2e}, time stepping {} s, {} iterations, {} factorizations",
            setting.label,
            setting.resolution(run.resolution),
            if run.resolved { "" } else { "at most " },
            seconds(run.loop_s),
            run.measured.iterations + run.measured.other_iterations,
            run.measured.factorizations + run.measured.other_factorizations
        );
        out += &mark(index, x.at(across), y.at(error), colour, run.resolved, &title);
    }
    out + &legend(index, index, &setting.label)
}
