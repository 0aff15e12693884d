//! The elements of pictures of studies: axes by decades, a frame with rules, marks.

use base::names::short;
use results::report::html::escaped;

/// The height of the picture, in its own units.
const HEIGHT: f64 = 520.0;
/// The width of a letter, at the widest.
pub const LETTER: f64 = 7.6;
/// The frame of the axes: left, top, width, height.
pub const FRAME: [f64; 4] = [70.0, 20.0, 560.0, 440.0];
/// Colours that are legible on white and on black.
const COLOURS: [&str; 8] = ["#3b7dd8", "#d9622b", "#2f9e63", "#b058c4", "#b38a12", "#1f9aa8", "#d14b6b", "#7c7f86"];
/// Dashes, which distinguish curves of equal colour.
const DASHES: [&str; 3] = ["", "7 4", "2 4"];

/// A decimal logarithm from `low` to `high`, drawn from `from` to `to`.
pub struct Axis {
    pub low: f64,
    pub high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// The axis of some values, with a margin on both sides.
    pub fn new(values: &[f64], [from, to]: [f64; 2]) -> Axis {
        let logs = values.iter().filter(|value| **value > 0.0).map(|value| value.log10());
        let (low, high) = logs.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        let (low, high) = if low > high { (-1.0, 0.0) } else { (low, high) };
        let room = 0.06 * (high - low).max(0.5);
        Axis { low: low - room, high: high + room, from, to }
    }

    /// The place of a value in the picture.
    pub fn at(&self, value: f64) -> f64 {
        let part = (value.log10() - self.low) / (self.high - self.low);
        self.from + part * (self.to - self.from)
    }

    /// The values with a rule, and whether each is a whole decade; with few decades, parts of decades have rules too.
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

/// The beginning of the picture, with its styles.
pub fn open(width: f64, what: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {HEIGHT}\" class=\"study\" role=\"img\" \
         aria-label=\"{}\">\n<style>\n.study {{ font: 13px sans-serif; }}\n.study text {{ fill: #30353b; }}\n\
         .study .rule {{ stroke: #808890; stroke-opacity: .25; }}\n.study .part {{ stroke-opacity: .12; }}\n\
         .study .edge {{ fill: none; stroke: #808890; }}\n.study .wanted {{ stroke: #808890; stroke-dasharray: 3 3; }}\n\
         @media (prefers-color-scheme: dark) {{ .study text {{ fill: #d5d9dd; }} }}\n</style>\n",
        escaped(what)
    )
}

/// A straight line of a class.
pub fn line(class: &str, [x1, y1, x2, y2]: [f64; 4]) -> String {
    format!("<line class=\"{class}\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>\n")
}

/// A text, escaped.
pub fn text(anchor: &str, x: f64, y: f64, text: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", escaped(text))
}

/// The frame with its rules.
pub fn rules(x: &Axis, y: &Axis) -> String {
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
    out + &format!("<rect class=\"edge\" x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/>\n")
}

/// The titles of the axes.
pub fn titles(across: &str, up: &str) -> String {
    let [left, top, width, height] = FRAME;
    let out = text("middle", left + 0.5 * width, top + height + 42.0, across);
    let middle = top + 0.5 * height;
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {middle:.1})\"");
    out + &format!("<text x=\"18\" y=\"{middle:.1}\" {turned}>{}</text>\n", escaped(up))
}

/// The colour of a line, and its dashes as an attribute.
pub fn pen(index: usize) -> (&'static str, String) {
    let dash = DASHES[index / COLOURS.len() % DASHES.len()];
    let dashes = if dash.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dash}\"") };
    (COLOURS[index % COLOURS.len()], dashes)
}

/// The entry of a line in the legend, the `row`th; nothing where the picture has no room for it.
pub fn legend(index: usize, row: usize, name: &str) -> String {
    let [left, top, width, height] = FRAME;
    let (at, y) = (left + width + 16.0, top + 12.0 + 20.0 * row as f64);
    if y >= top + height + 30.0 {
        return String::new();
    }
    let (colour, dashes) = pen(index);
    let stroke = format!("stroke=\"{colour}\" stroke-width=\"1.8\"{dashes}");
    format!("<line x1=\"{at}\" y1=\"{y}\" x2=\"{}\" y2=\"{y}\" {stroke}/>\n", at + 24.0)
        + &mark(index, at + 12.0, y, colour, true, name)
        + &text("start", at + 32.0, y + 4.0, name)
}

/// The mark of a run: lines differ in its shape, and it is hollow where the error is a bound.
pub fn mark(index: usize, x: f64, y: f64, colour: &str, full: bool, title: &str) -> String {
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
