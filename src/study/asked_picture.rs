//! asked.svg: the reached error of automatic steps over the requested error. On the straight line both are the same.

use super::asked::Asked;
use super::chart::{Axis, FRAME, LETTER, legend, line, mark, open, pen, rules, titles};
use super::grid::StudyGrid;

/// The picture of the reached errors; nothing without automatic steps.
pub fn draw(grid: &StudyGrid, asked: &[Asked]) -> Option<String> {
    let [left, top, width, height] = FRAME;
    let runs = || asked.iter().flat_map(|of| &of.runs);
    let all: Vec<f64> = runs().flat_map(|run| [run.asked, run.reached]).collect();
    if all.is_empty() {
        return None;
    }
    // Both axes have one scale, so that the line of equal errors runs from corner to corner.
    let (x, y) = (Axis::new(&all, [left, left + width]), Axis::new(&all, [top + height, top]));
    let letters = asked.iter().map(|of| grid.lines[of.line].label.chars().count()).max().unwrap_or(0).max(12);
    let mut out = open(left + width + 52.0 + LETTER * letters as f64, "Error reached against error asked for");
    out += &rules(&x, &y);
    out += &line("wanted", [left, top + height, left + width, top]);
    out += &titles("error asked for", "error reached");
    for (row, of) in asked.iter().enumerate() {
        let (colour, dashes) = pen(of.line);
        let points: Vec<String> =
            of.runs.iter().map(|run| format!("{:.1},{:.1}", x.at(run.asked), y.at(run.reached))).collect();
        let stroke = format!("stroke=\"{colour}\" stroke-width=\"1.8\"{dashes}");
        out += &format!("<polyline points=\"{}\" fill=\"none\" {stroke}/>\n", points.join(" "));
        let label = &grid.lines[of.line].label;
        for run in &of.runs {
            let bound = if run.resolved { "" } else { "at most " };
            let title = format!("{label}: asked {:.1e}, reached {bound}{:.2e}", run.asked, run.reached);
            out += &mark(of.line, x.at(run.asked), y.at(run.reached), colour, run.resolved, &title);
        }
        out += &legend(of.line, row, label);
    }
    Some(out + "</svg>\n")
}
