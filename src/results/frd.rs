//! fields.frd: displacements of nodes, and stresses of shells, as CalculiX writes them. FreeCAD, PrePoMax and cgx read such a file.
//! Reference: CalculiX CGX manual, "result format"; columns are twelve wide and read by place.

use super::disk::{at, create};
use super::run_list::RunList;
use super::shell_stresses::upper_sides;
use base::math::{Mat3, Vec3, linear};
use base::snapshot::keep;
use model::{Drawing, Model};
use solve::Frame;
use std::collections::HashMap;
use std::fmt::Write;
use std::fs::{File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// The name of the file.
pub const NAME: &str = "fields.frd";
/// The last line of the file.
const END: &str = " 9999\n";
/// Bytes of a row with three numbers.
const ROW: usize = 50;

/// The kind of the values in a block, by the numbers of the format.
#[derive(Debug, Clone, Copy)]
enum FrdKind {
    Static = 0,
    Time = 1,
    Frequency = 2,
    Buckling = 4,
}

/// How far the file has come.
#[derive(Debug, Clone, Default)]
pub struct FrdMark {
    /// Bytes without the last line, ...
    length: u64,
    /// ... and those before the stage under way.
    before_stage: u64,
    /// The number of blocks of displacements.
    blocks: usize,
}

keep!(FrdMark: Default { length, before_stage, blocks });

/// Writes the file, to which each time and each mode adds blocks.
pub struct FrdFile {
    path: PathBuf,
    file: File,
    /// The number of each node of the model that is in the file.
    numbers: Vec<(usize, u64)>,
    /// The numbers by the labels of the nodes.
    labels: HashMap<String, u64>,
    marked: FrdMark,
    text: String,
}

impl FrdFile {
    /// Writes nodes and elements.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn open(dir: &Path, model: &Model) -> io::Result<FrdFile> {
        RunList::open(dir)?.note([NAME])?;
        let path = dir.join(NAME);
        let file = create(&path).map_err(|error| at(&path, error))?;
        let numbers = numbered(model);
        let labels = numbers.iter().map(|(node, number)| (model.nodes[*node].label.clone(), *number)).collect();
        let text = head(model, &numbers);
        let mut opened = FrdFile { path, file, numbers, labels, marked: FrdMark::default(), text };
        opened.append()?;
        Ok(opened)
    }

    /// Goes on with the file of a checkpoint.
    ///
    /// # Errors
    /// The file cannot be opened or written.
    pub fn reopen(dir: &Path, model: &Model, mark: FrdMark) -> io::Result<FrdFile> {
        let path = dir.join(NAME);
        let file = OpenOptions::new().append(true).open(&path).map_err(|error| at(&path, error))?;
        let numbers = numbered(model);
        let labels = numbers.iter().map(|(node, number)| (model.nodes[*node].label.clone(), *number)).collect();
        let mut opened = FrdFile { path, file, numbers, labels, marked: mark, text: String::new() };
        opened.append()?;
        Ok(opened)
    }

    /// Goes on with the next stage, whose model this is. Nodes keep their numbers.
    pub fn next_stage(&mut self, model: &Model) {
        let number = |(node, of): (usize, &model::Node)| Some((node, *self.labels.get(&of.label)?));
        self.numbers = model.nodes.iter().enumerate().filter_map(number).collect();
        self.marked.before_stage = self.marked.length;
    }

    /// How far the file has come.
    pub fn mark(&self) -> FrdMark {
        self.marked.clone()
    }

    /// Takes away the blocks of the stage under way.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn withdraw(&mut self) -> io::Result<()> {
        self.marked.length = self.marked.before_stage;
        self.append()
    }

    /// Adds the blocks of a step where one is to be drawn.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        // Readers take times above zero alone, and CalculiX writes none at t = 0 either.
        if !frame.drawn || frame.state.time <= 0.0 {
            return Ok(());
        }
        let kind = if frame.model.analysis.is_dynamic() { FrdKind::Time } else { FrdKind::Static };
        let (now, start) = (&frame.state.nodes, &frame.model.nodes);
        self.displacements((frame, kind, value_of(frame)), &|node| match &frame.case {
            Some(case) => linear(&case.motions[node]),
            None => now[node].moved(&start[node].x),
        });
        self.stresses(frame, kind);
        self.append()
    }

    /// Adds the shapes of modes.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        let Some(modes) = frame.modes else { return Ok(()) };
        for (number, mode) in (1..).zip(&modes.list) {
            let (kind, value) = match mode.factor {
                None => (FrdKind::Frequency, mode.frequency()),
                Some(factor) => (FrdKind::Buckling, factor),
            };
            let stiffness = mode.angular_frequency().powi(2) * mode.modal_mass;
            for (word, value) in [
                ("1PGM", twelve(mode.modal_mass)),
                ("1PGK", twelve(stiffness)),
                ("1PHID", format!("{:12}", -1)),
                ("1PSUBC", format!("{:12}", 0)),
                ("1PMODE", format!("{number:12}")),
            ] {
                let _ = writeln!(self.text, "    {word:<20}{value}");
            }
            let parameters = std::mem::take(&mut self.text);
            self.displacements((frame, kind, value), &|node| linear(&mode.shape[node]));
            // The number of the step comes first, then the numbers of the mode.
            let at = self.text.find('\n').map_or(0, |at| at + 1);
            self.text.insert_str(at, &parameters);
            self.append()?;
        }
        Ok(())
    }

    /// The head of a block: its kind, and its time, frequency or load factor.
    fn begin(&mut self, kind: FrdKind, value: f64) {
        let count = self.marked.blocks;
        let name = if matches!(kind, FrdKind::Frequency) { "MODAL" } else { "" };
        let _ = writeln!(
            self.text,
            "  100CL{:5}{}{:12}{:20}{:2}{count:5}{name:<10}{:2}",
            100 + count,
            twelve(value),
            self.numbers.len(),
            "",
            kind as u8,
            1
        );
    }

    /// A block of displacements.
    fn displacements(&mut self, of: (&Frame, FrdKind, f64), motion: &dyn Fn(usize) -> Vec3) {
        let stage = of.0.model.analysis.stage.as_ref().map_or(1, |stage| stage.index + 1);
        let stage = of.0.case.and_then(|case| case.name).map_or(stage, |(place, _)| place + 1);
        self.marked.blocks += 1;
        let _ = writeln!(self.text, "    1PSTEP{:14}{:12}{:12}{stage:12}", "", self.marked.blocks, of.0.step.max(1));
        self.begin(of.1, of.2);
        self.text.push_str(" -4  DISP        4    1\n");
        for (axis, name) in (1..).zip(["D1", "D2", "D3"]) {
            let _ = writeln!(self.text, " -5  {name:<8}    1    2    {axis}    0");
        }
        self.text.push_str(" -5  ALL         1    2    0    0    1ALL\n");
        for (node, number) in &self.numbers {
            row(&mut self.text, *number, motion(*node).as_slice());
        }
        self.text.push_str(" -3\n");
    }

    /// Blocks of stress and strain at the upper side of elastic shells, where there are any. Nodes of other parts have zeros.
    fn stresses(&mut self, frame: &Frame, kind: FrdKind) {
        if frame.derived.shells.is_empty() {
            return;
        }
        let [stress, strain] = upper_sides(frame);
        for (name, short, values) in [("STRESS", 'S', stress), ("TOSTRAIN", 'E', strain)] {
            self.begin(kind, value_of(frame));
            let _ = writeln!(self.text, " -4  {name:<8}    6    1");
            for (place, [a, b]) in
                [("XX", [1, 1]), ("YY", [2, 2]), ("ZZ", [3, 3]), ("XY", [1, 2]), ("YZ", [2, 3]), ("ZX", [3, 1])]
            {
                let name = format!("{short}{place}");
                let _ = writeln!(self.text, " -5  {name:<8}    1    4    {a}    {b}");
            }
            for (node, number) in &self.numbers {
                let at = values.get(node).copied().unwrap_or_else(Mat3::zeros);
                let six = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(|place| at[place]);
                row(&mut self.text, *number, &six);
            }
            self.text.push_str(" -3\n");
        }
    }

    /// Writes what has been put together behind the blocks so far.
    fn append(&mut self) -> io::Result<()> {
        let done = self.marked.length;
        self.marked.length += self.text.len() as u64;
        self.text.push_str(END);
        let written = self.file.set_len(done).and_then(|()| self.file.write_all(self.text.as_bytes()));
        self.text.clear();
        written.map_err(|error| at(&self.path, error))
    }
}

/// The time of a block; load cases have one time, and follow each other by their numbers.
fn value_of(frame: &Frame) -> f64 {
    frame.case.and_then(|case| case.name).map_or(frame.state.time, |(place, _)| place as f64 + 1.0)
}

/// Bytes of the blocks of one time at most.
pub fn bytes(model: &Model) -> usize {
    let blocks = if model.has_surfaces() { 5 } else { 1 };
    blocks * (ROW * model.nodes.len() + 400)
}

/// Numbers of the nodes that have a place: those of the mesh by their own, others behind these.
fn numbered(model: &Model) -> Vec<(usize, u64)> {
    let of_mesh = |label: &str| label.strip_prefix("mesh.")?.parse::<u64>().ok();
    let placed = || model.nodes.iter().enumerate().filter(|(_, node)| !node.is_number);
    let mut next = placed().filter_map(|(_, node)| of_mesh(&node.label)).max().unwrap_or(0);
    placed()
        .map(|(index, node)| {
            let number = of_mesh(&node.label).unwrap_or_else(|| {
                next += 1;
                next
            });
            (index, number)
        })
        .collect()
}

/// What stands before the first block: nodes, then elements by parts, a material for each.
fn head(model: &Model, numbers: &[(usize, u64)]) -> String {
    let number_of: HashMap<usize, u64> = numbers.iter().copied().collect();
    let mut elements: Vec<(u8, usize, Vec<u64>)> = Vec::new();
    let ids = |nodes: &[usize]| -> Option<Vec<u64>> { nodes.iter().map(|node| number_of.get(node).copied()).collect() };
    for (part, of) in (1..).zip(model.parts.iter().filter(|part| part.kind().is_drawn() && part.is_listed())) {
        for element in 0..of.elements() {
            match of.drawing(element) {
                Some(Drawing::Curve { nodes, .. }) => {
                    elements.extend(nodes.windows(2).filter_map(|ends| Some((11, part, ids(ends)?))));
                }
                Some(Drawing::Face { nodes }) => {
                    // The ninth node of a face is not in the format.
                    let kind = [(3, 7), (6, 8), (4, 9), (9, 10)].into_iter().find(|(count, _)| *count == nodes.len());
                    let kept = &nodes[..nodes.len().min(8)];
                    elements.extend(kind.and_then(|(_, kind)| Some((kind, part, ids(kept)?))));
                }
                None => {}
            }
        }
    }
    let bodies: Vec<usize> = model.bodies.iter().map(|body| body.node).collect();
    for spoke in &model.constraints.dependents {
        let is_of_body = bodies.contains(&spoke.master) && spoke.node != spoke.master;
        elements.extend(ids(&[spoke.master, spoke.node]).filter(|_| is_of_body).map(|ends| (11, 0, ends)));
    }
    text_of_mesh(model, numbers, &elements)
}

fn text_of_mesh(model: &Model, numbers: &[(usize, u64)], elements: &[(u8, usize, Vec<u64>)]) -> String {
    let mut text = format!("    1C{}\n", model.title.replace(char::is_control, " "));
    let _ = writeln!(text, "    1UPGM               rdsolve");
    let _ = writeln!(text, "    2C{:18}{:12}{:37}1", "", numbers.len(), "");
    for (node, number) in numbers {
        row(&mut text, *number, model.nodes[*node].x.as_slice());
    }
    let _ = writeln!(text, " -3\n    3C{:18}{:12}{:37}1", "", elements.len(), "");
    for (number, (kind, part, nodes)) in (1..).zip(elements) {
        let _ = writeln!(text, " -1{number:10}{kind:5}{:5}{part:5}", 0);
        let nodes: String = nodes.iter().map(|node| format!("{node:10}")).collect();
        let _ = writeln!(text, " -2{nodes}");
    }
    text.push_str(" -3\n");
    text
}

/// A row of numbers of a node, six a line at most.
fn row(text: &mut String, number: u64, values: &[f64]) {
    let _ = write!(text, " -1{number:10}");
    values.iter().for_each(|value| text.push_str(&twelve(*value)));
    text.push('\n');
}

/// A number in twelve columns with an exponent of two digits.
fn twelve(x: f64) -> String {
    if x.abs() < 1e-99 || !x.is_finite() {
        return " 0.00000E+00".to_owned();
    }
    let plain = format!("{:.5E}", x.clamp(-9.99999e99, 9.99999e99));
    let (digits, exponent) = plain.split_once('E').unwrap_or((&plain, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    format!("{digits:>8}E{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
}
