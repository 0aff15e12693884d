//! study.svg: error against the time of the time stepping, both by decades, with one curve a line of settings. It has no fonts or
//! scripts of its own, and is legible on light and on dark paper.

use super::found::Found;
use super::grid::StudyLine;
use super::run::StudyRun;
use super::table::{resolution, seconds};
use crate::names::short;
use crate::output::report::html::escaped;

/// The height of the picture, in its own units.
const HEIGHT: f64 = 520.0;
/// The width of a letter, at the widest.
const LETTER: f64 = 7.6;
/// The frame of the axes: left, top, width, height.
const FRAME: [f64; 4] = [70.0, 20.0, 560.0, 440.0];
/// Colours that are legible on white and on black.
const COLOURS: [&str; 8] = ["#3b7dd8", "#d9622b", "#2f9e63", "#b058c4", "#b38a12", "#1f9aa8", "#d14b6b", "#7c7f86"];
/// Dashes, which tell curves apart where the colours are used up.
const DASHES: [&str; 3] = ["", "7 4", "2 4"];

/// A decimal logarithm from `low` to `high`, drawn from `from` to `to`.
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// The axis of some values, with a margin on both sides.
    fn new(values: &[f64], [from, to]: [f64; 2]) -> Axis {
        let logs = values.iter().filter(|value| **value > 0.0).map(|value| value.log10());
        let (low, high) = logs.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        let (low, high) = if low > high { (-1.0, 0.0) } else { (low, high) };
        let room = 0.06 * (high - low).max(0.5);
        Axis { low: low - room, high: high + room, from, to }
    }

    /// The place of a value in the picture.
    fn at(&self, value: f64) -> f64 {
        let part = (value.log10() - self.low) / (self.high - self.low);
        self.from + part * (self.to - self.from)
    }

    /// The values that get a rule, and whether each is a whole decade; parts of decades are ruled where these are few.
    fn marks(&self) -> Vec<(f64, bool)> {
        let wide = self.high - self.low;
        let parts: &[f64] = if wide < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let decades = self.low.floor() as i32..=self.high.ceil() as i32;
        let marks = decades.flat_map(|k| parts.iter().map(move |part| (part * 10f64.powi(k), *part == 1.0)));
        marks.filter(|(value, _)| (self.low..=self.high).contains(&value.log10())).collect()
    }
}

/// The text at a rule: "1e-3", "0.05".
fn label(value: f64) -> String {
    if (0.01..1000.0).contains(&value) { short(value) } else { format!("{value:.0e}") }
}

/// The picture of a study.
pub fn draw(found: &Found) -> String {
    let [left, top, width, height] = FRAME;
    let shown = |run: &&StudyRun| run.error.is_some_and(|error| error > 0.0) && run.loop_s > 0.0;
    let runs: Vec<&StudyRun> = found.runs.iter().filter(shown).collect();
    let errors: Vec<f64> = runs.iter().filter_map(|run| run.error).collect();
    let times: Vec<f64> = runs.iter().map(|run| run.loop_s).collect();
    let letters = found.grid.lines.iter().map(|line| line.label.chars().count()).max().unwrap_or(0).max(28);
    let whole = left + width + 52.0 + LETTER * letters as f64;
    let (x, y) = (Axis::new(&times, [left, left + width]), Axis::new(&errors, [top + height, top]));
    let mut out = open(whole) + &axes(&x, &y, found);
    for (index, setting) in found.grid.lines.iter().enumerate() {
        let of_line: Vec<&StudyRun> = runs.iter().copied().filter(|run| run.line == index).collect();
        out += &curve(index, setting, &of_line, [&x, &y]);
    }
    if runs.is_empty() {
        out += &text("middle", left + 0.5 * width, top + 0.5 * height, "no run has an error");
    }
    if runs.iter().any(|run| !run.resolved) {
        let at = top + height + 42.0;
        out += &text("start", left + width + 16.0, at, "hollow: an upper bound, below the");
        out += &text("start", left + width + 16.0, at + 16.0, "resolution of the reference");
    }
    out + "</svg>\n"
}

/// The beginning of the picture, with its styles.
fn open(width: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {HEIGHT}\" class=\"study\" role=\"img\" \
         aria-label=\"Error against run time\">\n<style>\n.study {{ font: 13px sans-serif; }}\n.study text {{ fill: #30353b; }}\n\
         .study .rule {{ stroke: #808890; stroke-opacity: .25; }}\n.study .part {{ stroke-opacity: .12; }}\n\
         .study .edge {{ fill: none; stroke: #808890; }}\n.study .wanted {{ stroke: #808890; stroke-dasharray: 3 3; }}\n\
         @media (prefers-color-scheme: dark) {{ .study text {{ fill: #d5d9dd; }} }}\n</style>\n"
    )
}

fn line(class: &str, [x1, y1, x2, y2]: [f64; 4]) -> String {
    format!("<line class=\"{class}\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>\n")
}

fn text(anchor: &str, x: f64, y: f64, text: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", escaped(text))
}

/// The frame with its rules, the errors asked for, and the titles of the axes.
fn axes(x: &Axis, y: &Axis, found: &Found) -> String {
    let [left, top, width, height] = FRAME;
    let mut out = String::new();
    for (value, decade) in x.marks() {
        let at = x.at(value);
        out += &line(if decade { "rule" } else { "rule part" }, [at, top, at, top + height]);
        out += &text("middle", at, top + height + 18.0, &label(value));
    }
    for (value, decade) in y.marks() {
        let at = y.at(value);
        out += &line(if decade { "rule" } else { "rule part" }, [left, at, left + width, at]);
        out += &text("end", left - 6.0, at + 4.0, &label(value));
    }
    out += &format!("<rect class=\"edge\" x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/>\n");
    for (wanted, _) in &found.cheapest {
        if (y.low..=y.high).contains(&wanted.log10()) {
            out += &line("wanted", [left, y.at(*wanted), left + width, y.at(*wanted)]);
        }
    }
    out += &text("middle", left + 0.5 * width, top + height + 42.0, "run time of the time stepping (s)");
    let middle = top + 0.5 * height;
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {middle:.1})\"");
    out + &format!("<text x=\"18\" y=\"{middle:.1}\" {turned}>relative error</text>\n")
}

/// The curve of a line of settings, and its entry in the legend.
fn curve(index: usize, setting: &StudyLine, runs: &[&StudyRun], [x, y]: [&Axis; 2]) -> String {
    let [left, top, width, height] = FRAME;
    let (colour, dash) = (COLOURS[index % COLOURS.len()], DASHES[index / COLOURS.len() % DASHES.len()]);
    let points: Vec<String> =
        runs.iter().filter_map(|run| Some(format!("{:.1},{:.1}", x.at(run.loop_s), y.at(run.error?)))).collect();
    let dashes = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dash}\"") };
    let stroke = format!("stroke=\"{colour}\" stroke-width=\"1.8\"");
    let mut out = format!("<polyline points=\"{}\" fill=\"none\" {stroke}{dashes}/>\n", points.join(" "));
    for run in runs {
        let Some(error) = run.error else { continue };
        let title = format!(
            "{}, {}: error {}{error:.2e}, time stepping {} s",
            setting.label,
            resolution(setting, run.resolution),
            if run.resolved { "" } else { "at most " },
            seconds(run.loop_s)
        );
        out += &mark(index, x.at(run.loop_s), y.at(error), colour, run.resolved, &title);
    }
    let (at, row) = (left + width + 16.0, top + 12.0 + 20.0 * index as f64);
    if row < top + height + 30.0 {
        out += &format!("<line x1=\"{at}\" y1=\"{row}\" x2=\"{}\" y2=\"{row}\" {stroke}{dashes}/>\n", at + 24.0);
        out += &mark(index, at + 12.0, row, colour, true, &setting.label);
        out += &text("start", at + 32.0, row + 4.0, &setting.label);
    }
    out
}

/// The mark of a run: lines differ in its shape, and it is hollow where the error is a bound.
fn mark(index: usize, x: f64, y: f64, colour: &str, full: bool, title: &str) -> String {
    let fill = if full { colour } else { "none" };
    let path = match index % 4 {
        0 => format!("M{:.1} {y:.1}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z", x - 4.0),
        1 => format!("M{:.1} {:.1}h7v7h-7z", x - 3.5, y - 3.5),
        2 => format!("M{x:.1} {:.1}l5 5l-5 5l-5 -5z", y - 5.0),
        _ => format!("M{x:.1} {:.1}l4.6 8h-9.2z", y - 5.0),
    };
    let title = escaped(title);
    format!(
        "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.5\"><title>{title}</title></path>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_lie_on_the_axis() {
        let axis = Axis::new(&[0.003, 0.4], [0.0, 100.0]);
        let marks = axis.marks();
        assert!(marks.iter().any(|(value, decade)| *decade && (value - 0.1).abs() < 1e-12));
        assert!(marks.iter().all(|(value, _)| (0.0..=100.0).contains(&axis.at(*value))));
        assert!(Axis::new(&[], [0.0, 1.0]).at(0.5).is_finite());
        assert_eq!([1e-3, 0.05, 2.0].map(label), ["1e-3", "0.05", "2"]);
    }
}
