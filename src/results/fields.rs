//! fields.pvd and fields_000000.vtu …: the moving scene for ParaView and its kin, one grid per written step; fields.csv
//! names the parts that the grids number.
//!
//! Points of beams carry section forces, moments and extreme stresses, which are zero at other points. Cells have the number of their part. If the scene can
//! yield or fail, they have the largest plastic strain and the flag of failure (1). If there are shells, they have the stress resultants
//! along axis 1, zero on other cells.
//!
//! Beams are curves through their nodes, with separate points for each element, because each has its section axes. Bars and links are
//! lines, shells faces, bodies closed shapes. A grid is named after its step and listed only once it is whole.

use super::disk::{at, replace};
use super::run_list::RunList;
use super::vtu::{Cell, GridText};
use base::math::{Mat3, Vec3, Vec6, angular, linear, rotation};
use base::quantities::SECTION_STRESSES;
use base::snapshot::keep;
use mechanics::solids::outline::OutlineCell;
use mechanics::state::Node;
use model::{Beam, Drawing, Model, Part, PartType};
use solve::{Frame, ShellState, elastic_stresses};
use std::collections::HashMap;
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A drawn point, which is fixed to a node and turns with it; `arm` and `axes` (columns) are global at t = 0.
struct Place {
    node: usize,
    arm: Vec3,
    axes: Mat3,
}

/// The cells of the whole scene, and the part that each belongs to.
#[derive(Default)]
struct Grid {
    places: Vec<Place>,
    connectivity: Vec<i64>,
    offsets: Vec<i64>,
    types: Vec<u8>,
    parts: Vec<i64>,
}

impl Grid {
    fn cell(&mut self, kind: Cell, part: usize, points: impl Iterator<Item = usize>) {
        self.connectivity.extend(points.map(|point| point as i64));
        self.offsets.push(self.connectivity.len() as i64);
        self.types.push(kind as u8);
        self.parts.push(part as i64);
    }

    /// Adds a curve from the first node to the last, with separate points; VTK lists the ends first. VTK spaces the parameter of its curves
    /// evenly, and Lobatto points are not even, but the curve drawn passes through all of them.
    fn curve(&mut self, kind: Cell, part: usize, nodes: &[usize], axes: Mat3) {
        let (first, last) = (self.places.len(), self.places.len() + nodes.len() - 1);
        self.places.extend(nodes.iter().map(|&node| Place { node, arm: Vec3::zeros(), axes }));
        self.cell(kind, part, [first, last].into_iter().chain(first + 1..last));
    }

    /// Adds the cells of a part, or of one of the two shells that make it up.
    fn part(&mut self, part: usize, of: &Part) {
        let first = self.places.len();
        // A surface has one point for each of its nodes, shared by its elements.
        let mut place = HashMap::new();
        for element in 0..of.elements() {
            match of.drawing(element) {
                Some(Drawing::Curve { nodes, axes }) => {
                    let kind = match nodes.len() {
                        2 => Cell::Line,
                        3 => Cell::QuadraticEdge,
                        _ => Cell::LagrangeCurve,
                    };
                    self.curve(kind, part, nodes, axes);
                }
                Some(Drawing::Face { nodes }) => {
                    let kind = match nodes.len() {
                        3 => Cell::Triangle,
                        6 => Cell::QuadraticTriangle,
                        9 => Cell::BiquadraticQuad,
                        _ => Cell::Quad,
                    };
                    let points: Vec<usize> = nodes
                        .iter()
                        .map(|&node| {
                            let next = first + place.len();
                            *place.entry(node).or_insert_with(|| {
                                self.places.push(Place { node, arm: Vec3::zeros(), axes: Mat3::identity() });
                                next
                            })
                        })
                        .collect();
                    self.cell(kind, part, points.into_iter());
                }
                None => {}
            }
        }
    }

    /// The grid of a model: parts kind by kind, then bodies, each in the order of the deck.
    fn of(model: &Model) -> Grid {
        let mut grid = Grid::default();
        let mut part = 0..;
        let mut next = || part.next().unwrap_or_default();
        for of in model.parts.chunk_by(Part::is_one_with).filter(|of| is_drawn(&of[0])) {
            let part = next();
            of.iter().for_each(|piece| grid.part(part, piece));
        }
        for body in &model.bodies {
            let (part, first) = (next(), grid.places.len());
            let outline = body.shape.outline();
            let place = |arm| Place { node: body.node, arm, axes: Mat3::identity() };
            grid.places.extend(outline.points.into_iter().map(place));
            for cell in outline.cells {
                let (kind, points) = match cell {
                    OutlineCell::Hexahedron => (Cell::Hexahedron, (0..8).collect()),
                    OutlineCell::Face(points) => (face(points.len()), points),
                };
                grid.cell(kind, part, points.into_iter().map(|point| first + point));
            }
        }
        grid
    }
}

/// The type of the cell that has so many corners.
fn face(corners: usize) -> Cell {
    match corners {
        2 => Cell::Line,
        3 => Cell::Triangle,
        4 => Cell::Quad,
        _ => Cell::Polygon,
    }
}

/// Whether a part is drawn. Contacts and forces along joints are not drawn; their parts are.
fn is_drawn(part: &Part) -> bool {
    part.kind().is_drawn() && part.is_listed()
}

/// The upper bound of the bytes of one grid; compression usually halves them.
pub fn bytes(model: &Model) -> usize {
    let Grid { places, connectivity, offsets, .. } = Grid::of(model);
    let cells = offsets.len();
    let of_shells = if model.has_surfaces() { 13 } else { 0 };
    let of_beams = if model.has_sections() { 2 } else { 0 };
    let stresses = if model.stresses.iter().any(Option::is_some) { SECTION_STRESSES.len() } else { 0 };
    let of_points = 21 + 3 * of_beams + stresses;
    let numbers = of_points * places.len() + connectivity.len() + cells * (2 + of_shells + usize::from(model.yields()));
    let arrays = if model.has_surfaces() { 18 } else { 12 } + of_beams + stresses;
    8 * numbers + cells + arrays * ARRAY + ENDS
}

/// Bytes of an array without its numbers, and of the text before and after the arrays.
const ARRAY: usize = 190;
const ENDS: usize = 600;

/// The text of fields.csv: number, kind and name of the parts, in the order of [`Grid::of`].
fn names(model: &Model) -> csv::Result<Vec<u8>> {
    let parts = model.parts.chunk_by(Part::is_one_with).map(|of| &of[0]).filter(|part| is_drawn(part));
    let parts = parts.map(|part| (part.kind().word(), part.name()));
    let bodies = model.bodies.iter().map(|part| ("body", part.name.as_str()));
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["part", "kind", "name"])?;
    for (part, (kind, name)) in parts.chain(bodies).enumerate() {
        table.write_record([&part.to_string(), kind, name])?;
    }
    table.into_inner().map_err(|e| e.into_error().into())
}

/// Whether a file of this name is one that [`Fields`] writes.
pub fn is_file(name: &str) -> bool {
    LISTS.contains(&name) || is_grid(name) || name == MODES || is_mode(name)
}

/// The list of the grids of modes.
pub const MODES: &str = "modes.pvd";

/// Whether a file of this name is the grid of a mode.
fn is_mode(name: &str) -> bool {
    let numbers = name.strip_prefix("mode_").and_then(|rest| rest.strip_suffix(".vtu"));
    let is_number = |digits: &str| !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    numbers.is_some_and(|numbers| numbers.len() >= 4 && numbers.splitn(2, '_').all(is_number))
}

/// The files that are written however many grids there are.
pub const LISTS: [&str; 2] = ["fields.csv", "fields.pvd"];

/// Whether a file of this name is the grid of a step.
pub fn is_grid(name: &str) -> bool {
    let step = name.strip_prefix("fields_").and_then(|rest| rest.strip_suffix(".vtu"));
    step.is_some_and(|step| step.len() >= 6 && step.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Writes a grid of the moving scene at every step that is asked for, and the list of all grids.
pub struct Fields {
    dir: PathBuf,
    /// The list of the files of this run, which each grid enters.
    list: RunList,
    places: Vec<Place>,
    /// The opening of the one piece of a grid, which is the same at every step, as are the next two.
    piece: String,
    /// The tag of the array with the part of each cell.
    parts: String,
    /// The tags of the cells.
    cells: String,
    /// The number of cells.
    count: usize,
    /// The number of cells before those of shells; `None` where there are no shells.
    before: Option<usize>,
    /// How far the grids have come.
    marked: FieldsMark,
    /// The bytes of the lines that fields.pvd has.
    written: usize,
    grid: GridText,
}

/// How far the grids of a run have come.
#[derive(Debug, Clone, Default)]
pub struct FieldsMark {
    /// The lines of fields.pvd so far, ...
    listed: String,
    /// ... and their bytes before the stage under way.
    before_stage: usize,
    /// The lines of modes.pvd so far, and their number.
    listed_modes: String,
    modes: usize,
}

keep!(FieldsMark: Default { listed, before_stage, listed_modes, modes });

impl Fields {
    /// Writes fields.csv.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn open(dir: &Path, model: &Model) -> io::Result<Fields> {
        let Grid { places, connectivity, offsets, types, parts } = Grid::of(model);
        replace(&dir.join("fields.csv"), &names(model)?)?;
        let piece = format!("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", places.len(), offsets.len());
        let mut grid = GridText::new();
        let parts = grid.keep("part", 1, parts.into_iter());
        let connectivity = grid.keep("connectivity", 1, connectivity.into_iter());
        let ends = grid.keep("offsets", 1, offsets.iter().copied());
        let types = grid.keep("types", 1, types.into_iter());
        Ok(Fields {
            dir: dir.into(),
            list: RunList::open(dir)?,
            places,
            piece,
            parts,
            cells: format!("<Cells>\n{connectivity}{ends}{types}</Cells>\n</Piece>\n"),
            count: offsets.len(),
            before: model.has_surfaces().then(|| {
                let others = model.parts.iter().take_while(|part| !part.kind().is_surface());
                others.map(|part| part.elements()).sum()
            }),
            marked: FieldsMark::default(),
            written: 0,
            grid,
        })
    }

    /// Goes on with the next stage, whose model this is.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn next_stage(&mut self, model: &Model) -> io::Result<()> {
        let mut marked = std::mem::take(&mut self.marked);
        marked.before_stage = marked.listed.len();
        *self = Fields { marked, ..Fields::open(&self.dir, model)? };
        Ok(())
    }

    /// Continues the grids of a checkpoint; grids after it are drawn again.
    ///
    /// # Errors
    /// The list cannot be written.
    pub fn go_on(&mut self, mark: FieldsMark) -> io::Result<()> {
        self.marked = mark;
        self.finish()
    }

    /// How far the grids have come.
    pub fn mark(&self) -> FieldsMark {
        self.marked.clone()
    }

    /// Writes a grid where one is to be drawn.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        if frame.drawn { self.write(frame) } else { Ok(()) }
    }

    /// Removes the grids so far: a run that starts again writes grids at other steps.
    ///
    /// # Errors
    /// One of them cannot be removed.
    pub fn withdraw(&mut self) -> io::Result<()> {
        let names = self.marked.listed[self.marked.before_stage..]
            .lines()
            .filter_map(|line| line.split_once("file=\"")?.1.split('"').next());
        for name in names {
            let path = self.dir.join(name);
            match fs::remove_file(&path) {
                // A run that was killed while it began again has taken some away.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                removed => removed.map_err(|error| at(&path, error))?,
            }
        }
        self.marked.listed.truncate(self.marked.before_stage);
        self.written = 0;
        Ok(())
    }

    /// Writes a grid of each mode, with its shape as displacements of the state, and the list of them by number.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        let Some(modes) = frame.modes else { return Ok(()) };
        for (number, mode) in (1..).zip(&modes.list) {
            let grid = &mut self.grid;
            grid.begin();
            grid.push("<FieldData>\n");
            grid.array("TimeValue", 1, [f64::from(number)].into_iter());
            grid.array("frequency", 1, [mode.frequency()].into_iter());
            grid.push("</FieldData>\n");
            grid.push(&self.piece);
            let (places, now) = (&self.places, &frame.state.nodes);
            let arm = |p: &Place| now[p.node].R() * p.arm;
            let moved = |p: &Place, shape: &[Vec6]| linear(&shape[p.node]) + angular(&shape[p.node]).cross(&arm(p));
            grid.push("<PointData>\n");
            vectors(grid, places, "displacement", |p| moved(p, &mode.shape));
            vectors(grid, places, "rotation", |p| angular(&mode.shape[p.node]));
            write_axes(grid, places, now);
            if !mode.quadrature.is_empty() {
                vectors(grid, places, "displacement_ahead", |p| moved(p, &mode.quadrature));
                vectors(grid, places, "rotation_ahead", |p| angular(&mode.quadrature[p.node]));
            }
            grid.push("</PointData>\n<Points>\n");
            vectors(grid, places, "Points", |p| now[p.node].x + arm(p));
            grid.push("</Points>\n<CellData>\n");
            grid.push(&self.parts);
            grid.push("</CellData>\n");
            grid.push(&self.cells);
            let name = match &frame.model.analysis.stage {
                Some(stage) => format!("mode_{}_{number:04}.vtu", stage.index + 1),
                None => format!("mode_{number:04}.vtu"),
            };
            let path = self.dir.join(&name);
            self.list.note([name.as_str()])?;
            self.grid.write(&path)?;
            self.marked.modes += 1;
            let _ = writeln!(
                self.marked.listed_modes,
                "<DataSet timestep=\"{}\" part=\"0\" file=\"{name}\"/>",
                self.marked.modes
            );
        }
        let list = format!("{LIST}{}</Collection>\n</VTKFile>\n", self.marked.listed_modes);
        self.list.note([MODES])?;
        replace(&self.dir.join(MODES), list.as_bytes())
    }

    fn write(&mut self, frame: &Frame) -> io::Result<()> {
        // Load cases have one time, and follow each other by their numbers.
        let case = frame.case.and_then(|case| case.name);
        let (grid, time) = (&mut self.grid, case.map_or(frame.state.time, |(place, _)| place as f64 + 1.0));
        grid.begin();
        grid.push("<FieldData>\n");
        grid.array("TimeValue", 1, [time].into_iter());
        grid.push("</FieldData>\n");
        grid.push(&self.piece);

        write_points(grid, &self.places, frame);
        grid.push("<CellData>\n");
        grid.push(&self.parts);
        if !frame.derived.plastic_strains.is_empty() {
            // Cells of beams, bars and shells come first; links and bodies do not yield.
            let strains = frame.derived.plastic_strains.iter().copied().chain(std::iter::repeat(0.0)).take(self.count);
            grid.array("plastic_strain", 1, strains);
        }
        if !frame.derived.failed.is_empty() {
            let failed = frame.derived.failed.iter().map(|failed| f64::from(u8::from(*failed)));
            grid.array("failed", 1, failed.chain(std::iter::repeat(0.0)).take(self.count));
        }
        if let Some(before) = self.before {
            let (count, after) =
                (self.count, self.count - before - frame.derived.shells.len().min(self.count - before));
            let mut cells = |name: &str, components: usize, of: &dyn Fn(&ShellState, usize) -> f64| {
                let zeros = |cells: usize| std::iter::repeat_n(0.0, components * cells);
                let shells = frame.derived.shells.iter().flat_map(|state| (0..components).map(move |i| of(state, i)));
                let all = zeros(before).chain(shells).chain(zeros(after)).take(components * count);
                grid.array(name, components, all);
            };
            cells("axis_1", 3, &|state, i| state.at.frame[(i, 0)]);
            cells("membrane_force", 3, &|state, i| state.at.N[i]);
            cells("bending_moment", 3, &|state, i| state.at.M[i]);
            cells("shear_force", 2, &|state, i| state.at.Q[i]);
            cells("von_mises_bottom", 1, &|state, _| state.outer_von_mises()[0]);
            cells("von_mises_top", 1, &|state, _| state.outer_von_mises()[1]);
        }
        grid.push("</CellData>\n");
        grid.push(&self.cells);

        let name = format!("fields_{:06}.vtu", frame.step);
        let path = self.dir.join(&name);
        self.list.note([name.as_str()])?;
        self.grid.write(&path)?;
        let _ = writeln!(self.marked.listed, "<DataSet timestep=\"{time}\" part=\"0\" file=\"{name}\"/>");
        // A viewer may open the first grid at once; the others wait, for a list at each grid costs as much as the grid.
        if self.written == 0 { self.finish() } else { Ok(()) }
    }

    /// Writes the list of all grids, if it is not there yet.
    ///
    /// # Errors
    /// The list cannot be written.
    pub fn finish(&mut self) -> io::Result<()> {
        if self.written == self.marked.listed.len() {
            return Ok(());
        }
        let list = format!("{LIST}{}</Collection>\n</VTKFile>\n", self.marked.listed);
        replace(&self.dir.join("fields.pvd"), list.as_bytes())?;
        self.written = self.marked.listed.len();
        Ok(())
    }
}

/// Adds a vector for each point.
fn vectors(grid: &mut GridText, places: &[Place], name: &str, vector: impl Fn(&Place) -> Vec3) {
    grid.array(name, 3, places.iter().flat_map(|place| <[f64; 3]>::from(vector(place))));
}

/// Adds the axes of sections at the points.
fn write_axes(grid: &mut GridText, places: &[Place], now: &[Node]) {
    for (axis, name) in ["frame_x", "frame_y", "frame_z"].into_iter().enumerate() {
        vectors(grid, places, name, |p| now[p.node].R() * p.axes.column(axis));
    }
}

/// Adds the points of a grid and their data.
fn write_points(grid: &mut GridText, places: &[Place], frame: &Frame) {
    let (start, now) = (&frame.model.nodes, &frame.state.nodes);
    let arm = |p: &Place| now[p.node].R() * p.arm;
    grid.push("<PointData>\n");
    let moved = |p: &Place| match &frame.case {
        Some(case) => linear(&case.motions[p.node]) + angular(&case.motions[p.node]).cross(&p.arm),
        None => now[p.node].moved(&start[p.node].x) + (arm(p) - p.arm),
    };
    vectors(grid, places, "displacement", moved);
    vectors(grid, places, "velocity", |p| now[p.node].v + now[p.node].omega.cross(&arm(p)));
    vectors(grid, places, "rotation", |p| match &frame.case {
        Some(case) => angular(&case.motions[p.node]),
        None => rotation::log(&now[p.node].rotation),
    });
    write_axes(grid, places, now);
    // Points of beams come first.
    let resultants = &frame.derived.nodal_resultants;
    for (first, name) in [(0, "section_force"), (3, "section_moment")].into_iter().filter(|_| !resultants.is_empty()) {
        let zeros = std::iter::repeat_n(0.0, 3 * places.len().saturating_sub(resultants.len()));
        let values = resultants.iter().flat_map(|all| all[first..first + 3].iter().copied()).chain(zeros);
        grid.array(name, 3, values.take(3 * places.len()));
    }
    write_stresses(grid, places.len(), frame);
    grid.push("</PointData>\n<Points>\n");
    vectors(grid, places, "Points", |p| now[p.node].x + arm(p));
    grid.push("</Points>\n");
}

/// Adds the extreme stresses of beams: those of elastic sections under the resultants at the node, of others the extremes over the integration
/// points of the element.
fn write_stresses(grid: &mut GridText, count: usize, frame: &Frame) {
    let model = frame.model;
    if frame.derived.nodal_resultants.is_empty() || model.stresses.iter().all(Option::is_none) {
        return;
    }
    let mut resultants = frame.derived.nodal_resultants.iter();
    let mut points = frame.derived.sections.iter().peekable();
    let mut all: Vec<[f64; 4]> = Vec::with_capacity(count);
    for (part, beam) in model.parts.iter().enumerate().filter_map(|(part, of)| Some((part, Beam::of(of)?))) {
        for element in 0..beam.elements.len() {
            let mut of_fibres: Option<[f64; 4]> = None;
            while let Some(point) = points.next_if(|point| point.part == part && point.element == element) {
                let Some(stresses) = point.at.stresses.filter(|_| beam.yielding.is_some()) else { continue };
                let [most, least, tau, mises] = stresses.values;
                let so_far = of_fibres.unwrap_or(stresses.values);
                of_fibres = Some([so_far[0].max(most), so_far[1].min(least), so_far[2].max(tau), so_far[3].max(mises)]);
            }
            for (k, forces) in resultants.by_ref().take(beam.order + 1).enumerate() {
                let section = beam.elements[element].at_node(k).section;
                let elastic = || elastic_stresses(model, section, forces).map(|stresses| stresses.values);
                let stresses = if beam.yielding.is_some() { of_fibres } else { elastic() };
                // Between sections of different shapes there is no stress to tell.
                let unknown = if beam.elements[element].varied.is_some() { f64::NAN } else { 0.0 };
                all.push(stresses.unwrap_or([unknown; 4]));
            }
        }
    }
    for (k, column) in SECTION_STRESSES.iter().enumerate() {
        let values = all.iter().map(|stresses| stresses[k]).chain(std::iter::repeat(0.0));
        grid.array(column.name, 1, values.take(count));
    }
}

/// The beginning of fields.pvd.
const LIST: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
