//! Supports, loads and joints of a picture: symbols of one size, and arrows whose length follows the load.

use super::marks::{Anchor, PageMarks};
use super::view::{ScreenView, span};
use std::fmt::Write;

/// The length of the largest arrow, as a part of the diagonal of the scene.
const ARROW: f64 = 0.12;
/// The length of the bar of a held direction.
const BAR: f64 = 0.04;
/// The least part of its length that an arrow of a small load has.
const SHORTEST: f64 = 0.3;
/// Loads below this part of the largest have no arrow.
const SEEN: f64 = 1e-6;

/// The symbols, in pixels, with the points of the scene at their places; `size` is the diagonal of the scene.
pub fn symbols(marks: &PageMarks, at: &[[f64; 3]], sight: &ScreenView, size: f64) -> String {
    let place = |anchor: &Anchor| {
        let point = at[anchor.point];
        [0, 1, 2].map(|k| point[k] + anchor.way[k])
    };
    let mut out = String::new();
    for (anchor, dofs) in &marks.supports {
        let path = support(place(anchor), *dofs, sight, BAR * size);
        let _ = writeln!(out, "<path class=\"h\" d=\"{path}\"/>");
    }
    for anchor in &marks.joints {
        let [x, y] = sight.place(place(anchor));
        let _ = writeln!(out, "<circle class=\"j\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>");
    }
    let parts = |load: &[f64; 6]| [[load[0], load[1], load[2]], [load[3], load[4], load[5]]];
    let largest = [0, 1].map(|k| marks.loads.iter().map(|(_, load)| span(parts(load)[k])).fold(0.0, f64::max));
    for (anchor, load) in &marks.loads {
        for (k, vector) in parts(load).into_iter().enumerate() {
            let own = span(vector);
            if own > SEEN * largest[k] {
                let reach = (SHORTEST + (1.0 - SHORTEST) * own / largest[k]) * ARROW * size;
                let way = vector.map(|x| x / own * reach);
                let path = arrow(place(anchor), way, k + 1, sight);
                let _ = writeln!(out, "<path class=\"a\" d=\"{path}\"/>");
            }
        }
    }
    out
}

/// A square for a clamped node, a triangle for fixed translations, else a bar along each fixed direction.
fn support(place: [f64; 3], dofs: u8, sight: &ScreenView, length: f64) -> String {
    let [x, y] = sight.place(place);
    if dofs == 63 {
        return format!("M{:.1} {:.1}h9v9h-9z", x - 4.5, y - 4.5);
    }
    if dofs & 7 == 7 {
        return format!("M{x:.1} {y:.1}l6 10h-12z");
    }
    let mut path = format!("M{:.1} {y:.1}a2 2 0 1 0 4 0a2 2 0 1 0 -4 0", x - 2.0);
    for axis in (0..3).filter(|axis| dofs & 1 << axis != 0) {
        let mut end = place;
        end[axis] -= length;
        let [a, b] = sight.place(end);
        let _ = write!(path, "M{x:.1} {y:.1}L{a:.1} {b:.1}");
    }
    path
}

/// An arrow whose head is at the place, or, with two heads, whose tail is there.
fn arrow(place: [f64; 3], way: [f64; 3], heads: usize, sight: &ScreenView) -> String {
    let sign = if heads == 1 { -1.0 } else { 1.0 };
    let [own, other] = [place, [0, 1, 2].map(|k| place[k] + sign * way[k])].map(|p| sight.place(p));
    let [from, to] = if heads == 1 { [other, own] } else { [own, other] };
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let far = dx.hypot(dy);
    if far < 3.0 {
        return format!("M{:.1} {:.1}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0", to[0] - 3.0, to[1]);
    }
    let [ux, uy] = [dx / far, dy / far];
    let mut path = format!("M{:.1} {:.1}L{:.1} {:.1}", from[0], from[1], to[0], to[1]);
    for head in 0..heads {
        let [x, y] = [to[0] - 6.0 * head as f64 * ux, to[1] - 6.0 * head as f64 * uy];
        let corner = |side: f64| [x - 7.0 * ux + side * 3.0 * uy, y - 7.0 * uy - side * 3.0 * ux];
        let [[a, b], [c, d]] = [corner(1.0), corner(-1.0)];
        let _ = write!(path, "M{x:.1} {y:.1}L{a:.1} {b:.1}L{c:.1} {d:.1}z");
    }
    path
}
