//! A picture of the scene at one time, as SVG: faces from the farthest to the nearest, then lines and points, with axes and scales.

use super::data::PageScene;
use super::html::escaped;
use super::picture_marks::symbols;
use super::result::Result;
use super::view::{ScreenView, dot, minus, product, span};
use base::names::{short, to_digits};
use base::quantities::{Unit, UnitSystem};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The time, the magnification and the size of a picture.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// The time, or the number of a mode; `None` shows the last time, or the first mode.
    pub time: Option<f64>,
    /// The factor of the displacements.
    pub magnify: f64,
    /// The width in pixels; the height is three quarters of it.
    pub width: f64,
}

/// Coordinates of paths count parts of a pixel, so that they are whole numbers.
const PARTS: f64 = 4.0;
/// Colours from the least to the largest value, as the page has them.
const SCALE: [[f64; 3]; 7] = [
    [66.0, 92.0, 205.0],
    [52.0, 148.0, 206.0],
    [62.0, 178.0, 140.0],
    [150.0, 196.0, 66.0],
    [236.0, 186.0, 52.0],
    [236.0, 122.0, 46.0],
    [207.0, 48.0, 48.0],
];
/// A grey that shows on light and on dark paper.
const PLAIN: [f64; 3] = [158.0, 166.0, 176.0];
/// Steps of the colours and of the light, so that neighbours can share a path.
const SHADES: [f64; 2] = [12.0, 24.0];
/// Space at the upper and the lower rim, and at the sides, in pixels.
const RIMS: [f64; 3] = [36.0, 40.0, 12.0];
/// The rules of the style, each with the class of its elements; those without one stand in every picture.
const STYLES: [(&str, &str); 9] = [
    ("", "text{font:11px Helvetica,Arial,sans-serif;fill:#24292f}"),
    ("f", ".f path{fill:currentColor;stroke:currentColor;stroke-width:2;stroke-linejoin:round}"),
    ("e", ".e path{stroke:#24292f;stroke-opacity:.35}"),
    ("l", ".l{fill:none;stroke-width:10;stroke-linecap:round;stroke-linejoin:round}"),
    ("g", ".g{fill:none;stroke:#8c959f;stroke-width:4;stroke-dasharray:12 10}"),
    ("", ".s{stroke:#24292f;fill:none}"),
    ("h", ".h{stroke:#6f7782;fill:#6f7782;fill-opacity:.5;stroke-width:1.3}"),
    ("j", ".j{stroke:#8250df;fill:none;stroke-width:1.5}"),
    ("a", ".a{stroke:#d6336c;fill:#d6336c;stroke-width:1.4}"),
];
/// The rule of dark paper.
const DARK: &str = "@media(prefers-color-scheme:dark){text{fill:#e6edf3}.s,.e path{stroke:#e6edf3}}";

/// The width of a line without a section, in parts of a pixel, as [`STYLES`] has it.
const THIN: i64 = 10;

/// Cosine of the angle between two faces above which their edge is not drawn: 30 degrees.
const CREASE: f64 = 0.87;
/// The mean size of a face in square pixels above which edges are drawn in ink; smaller faces of one colour become one.
const EDGED: f64 = 150.0;

/// The number of paths that a face may pass below to join one of its colour.
const REACH: usize = 100;

/// A face: its points, its cell, its normal, and its height out of the screen.
struct Face {
    points: Vec<u32>,
    cell: u32,
    normal: [f64; 3],
    height: f64,
}

/// A convex face on the screen, in parts of a pixel.
struct Shape {
    corners: Vec<[i64; 2]>,
    /// The least and the largest of each coordinate.
    bounds: [[i64; 2]; 2],
    /// Twice the area: positive where the corners turn from x to y.
    twice_area: i64,
}

impl Shape {
    fn of(corners: Vec<[i64; 2]>) -> Shape {
        let bounds = corners.iter().fold([[i64::MAX; 2], [i64::MIN; 2]], |[least, most], c| {
            [[0, 1].map(|k| least[k].min(c[k])), [0, 1].map(|k| most[k].max(c[k]))]
        });
        let mut shape = Shape { corners, bounds, twice_area: 0 };
        shape.twice_area = shape.edges().map(|[a, b]| a[0] * b[1] - a[1] * b[0]).sum();
        shape
    }

    fn edges(&self) -> impl Iterator<Item = [[i64; 2]; 2]> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// On which side of an edge a point lies: positive inside.
    fn side(&self, [a, b]: [[i64; 2]; 2], [x, y]: [i64; 2]) -> i64 {
        self.twice_area.signum() * ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]))
    }

    fn holds(&self, point: [i64; 2]) -> bool {
        self.edges().all(|edge| self.side(edge, point) >= 0)
    }

    /// Whether an edge of one parts the two; faces that share an edge do not overlap.
    fn overlaps(&self, other: &Shape) -> bool {
        let apart = |k: usize| self.bounds[1][k] <= other.bounds[0][k] || other.bounds[1][k] <= self.bounds[0][k];
        let parts =
            |a: &Shape, b: &Shape| a.edges().any(|edge| b.corners.iter().all(|&corner| a.side(edge, corner) <= 0));
        !(apart(0) || apart(1) || parts(self, other) || parts(other, self))
    }
}

/// A value for each point or each cell at one time, with its range.
struct Field {
    name: &'static str,
    unit: Unit,
    by_point: bool,
    values: Vec<f32>,
    range: [f64; 2],
}

impl Field {
    /// The colour between two values, as the page mixes it; grey where there is no number.
    fn colour(&self, points: &[u32], cell: Option<u32>, light: f64) -> String {
        let mean = |points: &[u32]| {
            points.iter().map(|&p| f64::from(self.values[p as usize])).sum::<f64>() / points.len() as f64
        };
        let value = if self.by_point {
            mean(points)
        } else {
            cell.map_or(f64::NAN, |cell| f64::from(self.values[cell as usize]))
        };
        let [least, most] = self.range;
        let part = (SHADES[0] * (value - least) / (most - least)).round() / SHADES[0];
        let light = (SHADES[1] * light).round() / SHADES[1];
        css(if part.is_finite() { mixed(part) } else { PLAIN }.map(|c| c * light))
    }
}

/// The colour at a part of the scale from 0 to 1.
fn mixed(part: f64) -> [f64; 3] {
    let x = part.clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let i = (x as usize).min(SCALE.len() - 2);
    [0, 1, 2].map(|k| SCALE[i][k] + (x - i as f64) * (SCALE[i + 1][k] - SCALE[i][k]))
}

fn css(colour: [f64; 3]) -> String {
    let [r, g, b] = colour.map(|c| c.round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Draws the scene at the time with a number, counted from 0.
pub fn draw(scene: &PageScene, result: &Result, title: &str, frame: usize, view: &View) -> String {
    let count = scene.x0.len() / 3;
    let point = |values: &[f32], i: usize| [0, 1, 2].map(|k| f64::from(values[3 * i + k]));
    let start: Vec<[f64; 3]> = (0..count).map(|i| point(&scene.x0, i)).collect();
    let moved =
        |i: usize| [0, 1, 2].map(|k| start[i][k] + view.magnify * f64::from(scene.u[3 * (frame * count + i) + k]));
    let at: Vec<[f64; 3]> = (0..count).map(moved).collect();
    let shown = used(scene, &at);
    let all = || shown.iter().flat_map(|&i| [start[i], at[i]]);
    let size = [view.width, 0.75 * view.width];
    let sight = ScreenView::of(all(), size, RIMS);
    let screen = |points: &[[f64; 3]]| {
        points.iter().map(|&p| sight.place(p).map(|x| (PARTS * x).round() as i64)).collect::<Vec<_>>()
    };
    let (now, before) = (screen(&at), screen(&start));
    let field = field(scene, frame);
    let faces = faces(scene, &at, &sight);
    let has_moved = shown.iter().any(|&i| (0..2).any(|k| (now[i][k] - before[i][k]).abs() > 2 * PARTS as i64));

    let mut out = format!("<g transform=\"scale({})\">", 1.0 / PARTS);
    if has_moved {
        let mut outline = outline(&faces);
        outline.extend(scene.lines.as_chunks::<2>().0);
        let _ = writeln!(out, "<path class=\"g\" d=\"{}\"/>", strokes(&outline, &before));
    }
    out += &fills(&in_sight(faces, &now, size), &sight, &now, &field);
    out += &lines(scene, &now, &field, sight.scale());
    if !scene.labels.is_empty() {
        for (i, [x, y]) in now.iter().enumerate() {
            let _ = write!(
                out,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"14\" fill=\"{}\"/>",
                field.colour(&[i as u32], None, 1.0)
            );
        }
    }
    out += "</g>\n";
    out += &symbols(&scene.marks, &at, &sight, sight.whole());
    if !scene.is_modes {
        out += &legend(&field, size, result.units());
    }
    out += &sides(&sight, size, &note(scene, frame, view, result), &Unit::Length.text(result.units()));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"{}\" role=\"img\"><title>{}</title><style>{}</style>\n{out}</svg>\n",
        size[0],
        size[1],
        size[0],
        escaped(title),
        style(&out)
    )
}

/// The rules that the elements of a picture use.
fn style(elements: &str) -> String {
    let names = || {
        elements.split("class=\"").skip(1).flat_map(|rest| rest.split('"').take(1)).flat_map(|names| names.split(' '))
    };
    let is_used = |class: &str| class.is_empty() || names().any(|name| name == class);
    STYLES.iter().filter(|(class, _)| is_used(class)).map(|(_, rule)| *rule).chain([DARK]).collect()
}

/// The points of faces, lines and marks with finite coordinates.
fn used(scene: &PageScene, at: &[[f64; 3]]) -> Vec<usize> {
    let mut shown = vec![!scene.labels.is_empty(); at.len()];
    scene.triangles.iter().chain(&scene.lines).for_each(|&p| shown[p as usize] = true);
    (0..at.len()).filter(|&i| shown[i] && at[i].iter().all(|x| x.is_finite())).collect()
}

/// The field that the page shows first: the stress of shells, else plastic strain, else the displacement.
fn field(scene: &PageScene, frame: usize) -> Field {
    let cells = scene.kinds.len();
    let find = |name: &str| {
        let (_, values) = scene.fields.iter().find(|(known, _)| known == name)?;
        values.get(frame * cells..(frame + 1) * cells)
    };
    let (name, unit, by_point, values) = match (find("von_mises_bottom"), find("von_mises_top"), find("plastic_strain"))
    {
        (Some(bottom), Some(top), _) => {
            let has = |cell: usize| scene.kinds[cell] == SHELL;
            let larger = |(cell, (a, b)): (usize, (&f32, &f32))| if has(cell) { a.max(*b) } else { f32::NAN };
            ("von Mises", Unit::Stress, false, bottom.iter().zip(top).enumerate().map(larger).collect::<Vec<_>>())
        }
        (_, _, Some(strain)) => {
            let only = |(&value, &kind): (&f32, &u8)| if kind <= SHELL { value } else { f32::NAN };
            ("plastic strain", Unit::One, false, strain.iter().zip(&scene.kinds).map(only).collect())
        }
        _ => {
            let u = &scene.u[scene.x0.len() * frame..scene.x0.len() * (frame + 1)];
            let size = |u: &[f32; 3]| u.iter().map(|u| u * u).sum::<f32>().sqrt();
            ("displacement", Unit::Length, true, u.as_chunks::<3>().0.iter().map(size).collect())
        }
    };
    let finite = || values.iter().filter(|x| x.is_finite()).map(|&x| f64::from(x));
    let range = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
    Field { name, unit, by_point, values, range }
}

/// The number of the kind of shells; beams and bars come before it.
const SHELL: u8 = 2;

/// The faces, from the farthest to the nearest: triangles of one cell that fan out from one corner make one face.
fn faces(scene: &PageScene, at: &[[f64; 3]], sight: &ScreenView) -> Vec<Face> {
    let mut faces: Vec<Face> = Vec::new();
    for (&[a, b, c], &cell) in scene.triangles.as_chunks::<3>().0.iter().zip(&scene.triangle_cells) {
        match faces.last_mut() {
            Some(face) if face.cell == cell && face.points[0] == a && face.points.last() == Some(&b) => {
                face.points.push(c)
            }
            _ => faces.push(Face { points: vec![a, b, c], cell, normal: [0.0; 3], height: 0.0 }),
        }
    }
    for face in &mut faces {
        let corner = |k: usize| at[face.points[k] as usize];
        let normal = product(minus(corner(1), corner(0)), minus(corner(2), corner(0)));
        face.normal = normal.map(|n| n / span(normal).max(f64::MIN_POSITIVE));
        face.height = face.points.iter().map(|&p| sight.toward(at[p as usize])).sum::<f64>() / face.points.len() as f64;
    }
    faces.retain(|face| face.height.is_finite());
    faces.sort_by(|a, b| a.height.total_cmp(&b.height));
    faces
}

/// The edges that show a shape: rims, and edges between faces at more than [`CREASE`].
fn outline(faces: &[Face]) -> Vec<[u32; 2]> {
    let mut meeting: BTreeMap<[u32; 2], Vec<[f64; 3]>> = BTreeMap::new();
    for face in faces {
        for (k, &a) in face.points.iter().enumerate() {
            let b = face.points[(k + 1) % face.points.len()];
            meeting.entry([a.min(b), a.max(b)]).or_default().push(face.normal);
        }
    }
    let shows = |normals: &[[f64; 3]]| match normals {
        [a, b] => dot(*a, *b).abs() < CREASE,
        _ => true,
    };
    meeting.into_iter().filter(|(_, normals)| shows(normals)).map(|(edge, _)| edge).collect()
}

/// Adds a line through points to a path, and returns whether it did: not where they all lie in one place. `from` is where the path stands.
fn trace(path: &mut String, from: [i64; 2], points: &[[i64; 2]]) -> bool {
    let is_one = points.iter().all(|point| *point == points[0]);
    let mut last = from;
    for (k, point) in points.iter().enumerate().filter(|_| !is_one) {
        let [x, y] = [point[0] - last[0], point[1] - last[1]];
        if k == 0 || [x, y] != [0, 0] {
            // Pairs after the first are steps too; a sign parts numbers as well as a space.
            let mark = if k == 0 {
                "m"
            } else if x < 0 {
                ""
            } else {
                " "
            };
            let _ = write!(path, "{mark}{x}{}{y}", if y < 0 { "" } else { " " });
            last = *point;
        }
    }
    !is_one
}

/// Omits hidden faces: faces that cover no free cell on a grid of half pixels.
fn in_sight(faces: Vec<Face>, at: &[[i64; 2]], size: [f64; 2]) -> Vec<Face> {
    let step = (PARTS / 2.0) as i64;
    let [width, height] = size.map(|side| (2.0 * side) as i64 + 1);
    let mut is_covered = vec![false; (width * height) as usize];
    let mut seen: Vec<Face> = Vec::new();
    for face in faces.into_iter().rev() {
        let shape = Shape::of(face.points.iter().map(|&p| at[p as usize]).collect());
        let [least, most] = shape.bounds;
        let mut shows = false;
        for y in (least[1] / step).max(0)..=(most[1] / step).min(height - 1) {
            for x in (least[0] / step).max(0)..=(most[0] / step).min(width - 1) {
                if shape.holds([x * step, y * step]) {
                    shows |= !std::mem::replace(&mut is_covered[(y * width + x) as usize], true);
                }
            }
        }
        if shows {
            seen.push(face);
        }
    }
    seen.reverse();
    seen
}

/// Faces as paths; each path holds faces of one colour.
fn fills(faces: &[Face], sight: &ScreenView, at: &[[i64; 2]], field: &Field) -> String {
    let shapes: Vec<Shape> =
        faces.iter().map(|face| Shape::of(face.points.iter().map(|&p| at[p as usize]).collect())).collect();
    let all: f64 = shapes.iter().map(|shape| 0.5 * shape.twice_area.abs() as f64).sum();
    let kind = if all > EDGED * PARTS * PARTS * faces.len() as f64 { "f e" } else { "f" };
    let mut layers: Vec<(String, Vec<&Shape>)> = Vec::new();
    for (face, shape) in faces.iter().zip(&shapes) {
        let light = 0.7 + 0.3 * sight.toward(face.normal).abs();
        let colour = field.colour(&face.points, Some(face.cell), light);
        match layer_of(&layers, &colour, shape) {
            Some(layer) => layers[layer].1.push(shape),
            None => layers.push((colour, vec![shape])),
        }
    }
    let mut out = format!("<g class=\"{kind}\">");
    for (colour, shapes) in layers {
        let rims = if kind == "f" { rims(&shapes) } else { shapes.iter().map(|shape| shape.corners.clone()).collect() };
        let (mut path, mut from) = (String::new(), [0; 2]);
        for rim in rims {
            if trace(&mut path, from, &rim) {
                path.push('z');
                from = rim[0];
            }
        }
        if !path.is_empty() {
            let _ = writeln!(out, "<path color=\"{colour}\" d=\"{path}\"/>");
        }
    }
    out + "</g>\n"
}

/// The closed lines around faces of one colour: an edge that two of them share is none, as it has both directions.
fn rims(shapes: &[&Shape]) -> Vec<Vec<[i64; 2]>> {
    let mut ends: BTreeMap<[i64; 2], Vec<[i64; 2]>> = BTreeMap::new();
    for shape in shapes {
        for edge in shape.edges() {
            let [a, b] = if shape.twice_area < 0 { [edge[1], edge[0]] } else { edge };
            let back = ends.get_mut(&b).and_then(|of_b| Some(of_b.swap_remove(of_b.iter().position(|end| *end == a)?)));
            if back.is_none() && a != b {
                ends.entry(a).or_default().push(b);
            }
        }
    }
    let mut rims = Vec::new();
    while let Some((&first, _)) = ends.iter().find(|(_, of)| !of.is_empty()) {
        let (mut rim, mut at) = (Vec::new(), first);
        // As many edges begin as end at each point, so that a line closes.
        while let Some(next) = ends.get_mut(&at).and_then(Vec::pop) {
            rim.push(at);
            at = next;
        }
        rims.push(straightened(&rim));
    }
    rims
}

/// A closed line without the points that lie within half a part of a pixel of the line from the last point kept to the next.
fn straightened(rim: &[[i64; 2]]) -> Vec<[i64; 2]> {
    let mut kept: Vec<[i64; 2]> = Vec::new();
    for (k, &point) in rim.iter().enumerate() {
        let next = rim[(k + 1) % rim.len()];
        let is_bend = kept.last().is_none_or(|last| {
            let [a, b] = [[point[0] - last[0], point[1] - last[1]], [next[0] - point[0], next[1] - point[1]]];
            let off = (a[0] * b[1] - a[1] * b[0]).abs() as f64;
            a[0] * b[0] + a[1] * b[1] < 0 || off > 0.5 * ((a[0] + b[0]) as f64).hypot((a[1] + b[1]) as f64)
        });
        if is_bend {
            kept.push(point);
        }
    }
    kept
}

/// The last path of a colour, unless a face that it or a later path has lies below the new one. Not more than [`REACH`] paths are looked at.
fn layer_of(layers: &[(String, Vec<&Shape>)], colour: &str, shape: &Shape) -> Option<usize> {
    for (number, (other, shapes)) in layers.iter().enumerate().rev().take(REACH) {
        if shapes.iter().any(|below| below.overlaps(shape)) {
            return None;
        }
        if other == colour {
            return Some(number);
        }
    }
    None
}

/// Lines; those that follow each other are one path.
fn strokes(lines: &[[u32; 2]], at: &[[i64; 2]]) -> String {
    let (mut path, mut from, mut run): (String, [i64; 2], Vec<[i64; 2]>) = (String::new(), [0; 2], Vec::new());
    for ends in lines.iter().map(|ends| ends.map(|p| at[p as usize])) {
        if run.last() != Some(&ends[0]) {
            end(&mut path, &mut from, &run);
            run = vec![ends[0]];
        }
        run.push(ends[1]);
    }
    end(&mut path, &mut from, &run);
    path
}

/// Adds a run of lines to a path, which then stands at its end.
fn end(path: &mut String, from: &mut [i64; 2], run: &[[i64; 2]]) {
    if let Some(last) = run.last()
        && trace(path, *from, run)
    {
        *from = *last;
    }
}

/// Lines by their colours, as wide as beams are deep at a scale of pixels for one length.
fn lines(scene: &PageScene, at: &[[i64; 2]], field: &Field, scale: f64) -> String {
    let mut of_colour: BTreeMap<(i64, String), Vec<[u32; 2]>> = BTreeMap::new();
    for (&ends, &cell) in scene.lines.as_chunks::<2>().0.iter().zip(&scene.line_cells) {
        let width = (PARTS * scale * scene.marks.depth(cell as usize)).round() as i64;
        let colour = field.colour(&ends, Some(cell), 1.0);
        of_colour.entry((width.max(THIN), colour)).or_default().push(ends);
    }
    let path = |((width, colour), lines): (&(i64, String), &Vec<[u32; 2]>)| {
        let width =
            if *width > THIN { format!(" style=\"stroke-width:{width};stroke-linecap:butt\"") } else { String::new() };
        format!("<path class=\"l\" stroke=\"{colour}\"{width} d=\"{}\"/>\n", strokes(lines, at))
    };
    of_colour.iter().map(path).collect()
}

/// The time or the mode, and the factor of the displacements where it is not 1.
fn note(scene: &PageScene, frame: usize, view: &View, result: &Result) -> String {
    let time = short(f64::from(scene.times[frame])) + &result.clock();
    let what = match scene.is_modes {
        true => scene.name_of_mode(scene.times[frame] as usize, result.units()),
        false => format!("t = {time}"),
    };
    if view.magnify == 1.0 { what } else { format!("{what}, displacements × {}", short(view.magnify)) }
}

/// The field, its range and its colours along the upper rim; nothing where all values are equal.
fn legend(field: &Field, [width, _]: [f64; 2], units: Option<&UnitSystem>) -> String {
    let [least, most] = field.range;
    if least >= most {
        return String::new();
    }
    let (left, top, part) = (12.0, 20.0, 0.25 * width / 12.0);
    let low = to_digits(least, 3);
    // A digit is 6 pixels wide.
    let begin = left + 6.2 * low.len() as f64 + 5.0;
    let mut out = format!(
        "<text x=\"{left}\" y=\"14\">{} ({})</text><text x=\"{left}\" y=\"{}\">{low}</text>",
        field.name,
        field.unit.text(units),
        top + 8.0
    );
    for i in 0..12 {
        let (colour, x) = (css(mixed((f64::from(i) + 0.5) / 12.0)), begin + part * f64::from(i));
        let _ = write!(out, "<path fill=\"{colour}\" d=\"M{x:.1} {top}h{0:.1}v8h-{0:.1}z\"/>", part + 0.2);
    }
    let _ =
        writeln!(out, "<text x=\"{:.1}\" y=\"{}\">{}</text>", begin + 12.0 * part + 5.0, top + 8.0, to_digits(most, 3));
    out
}

/// The axes at the lower left, a note in the middle, and a length at the lower right.
fn sides(sight: &ScreenView, [width, height]: [f64; 2], note: &str, unit: &str) -> String {
    let mut out = String::new();
    let [x, y] = [30.0, height - 26.0];
    for (name, axis, colour) in [("x", 0, "#d9534f"), ("y", 1, "#3c9d4e"), ("z", 2, "#4a7fe0")] {
        let [right, up] = sight.axis(axis);
        if right.hypot(up) > 0.05 {
            let _ = write!(
                out,
                "<path stroke=\"{colour}\" stroke-width=\"1.5\" d=\"M{x} {y}l{:.1} {:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{name}</text>",
                15.0 * right,
                -15.0 * up,
                x + 22.0 * right,
                y - 22.0 * up + 4.0
            );
        }
    }
    let _ = write!(
        out,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
        width / 2.0,
        height - 8.0,
        escaped(note)
    );
    let length = round_below(0.25 * width / sight.scale());
    let (bar, right) = (length * sight.scale(), width - RIMS[2]);
    let _ = writeln!(
        out,
        "<path class=\"s\" d=\"M{right} {}v4h-{bar:.1}v-4\"/><text x=\"{right}\" y=\"{}\" text-anchor=\"end\">{} ({})</text>",
        height - 12.0,
        height - 16.0,
        short(length),
        unit
    );
    out
}

/// The largest of 1, 2 or 5 times a power of ten that is not above a number.
fn round_below(number: f64) -> f64 {
    let power = 10.0_f64.powi(number.log10().floor() as i32);
    [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|&round| round <= number).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 10 at a place, turning one way or the other.
    fn square([x, y]: [i64; 2], is_back: bool) -> Shape {
        let mut corners = vec![[x, y], [x + 10, y], [x + 10, y + 10], [x, y + 10]];
        if is_back {
            corners.reverse();
        }
        Shape::of(corners)
    }

    #[test]
    fn faces_of_one_colour_have_one_rim_and_one_for_each_hole() {
        let ring = (0..9).filter(|k| *k != 4).map(|k| square([10 * (k % 3), 10 * (k / 3)], k % 2 == 0));
        let ring: Vec<Shape> = ring.collect();
        let mut found = rims(&ring.iter().collect::<Vec<_>>());
        found.iter_mut().for_each(|rim| rim.sort_unstable());
        found.sort();
        assert_eq!(found, [vec![[0, 0], [0, 30], [30, 0], [30, 30]], vec![[10, 10], [10, 20], [20, 10], [20, 20]]]);
    }
}
