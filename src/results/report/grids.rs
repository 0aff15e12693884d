//! Reads the moving scene from the grids of the fields: triangles, lines and edges, their places over time, and the data of their cells.

use super::data::PageScene;
use super::marks::PageMarks;
use super::numbers::PageNumbers;
use crate::at;
use crate::table_reader::{TableReader, fields, number, text};
use crate::vtu::APPENDED;
use base::math::curved_faces::{facets, ring};
use base::quantities::{SECTION_STRESSES, Unit};
use base::text_file::{read_regular, read_text};
use base64::prelude::{BASE64_STANDARD, Engine};
use flate2::bufread::ZlibDecoder;
use std::collections::HashSet;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// The largest number of numbers over all times that a page carries.
const NUMBERS: usize = 600_000;
/// The largest number of times.
const GRIDS: usize = 150;
/// The largest number of points: a scene with more of them is not shown.
const POINTS: usize = 1_000_000;

/// The kinds of parts, in the order of their numbers on the page.
const KINDS: [&str; 5] = ["beam", "bar", "shell", "link", "body"];

/// The scene of a folder; `None` if it has no grids. The inner error says in words why a page cannot hold the scene.
///
/// # Errors
/// A file cannot be read, or is no grid of this program; the error names it.
pub fn scene(folder: &Path) -> io::Result<Option<Result<PageScene, String>>> {
    let grids = listed(&folder.join("fields.pvd"))?;
    let Some((_, first)) = grids.first() else { return Ok(None) };
    let (kinds, part_names) = parts(&folder.join("fields.csv"))?;
    let first = Grid::read(folder.join(first))?;
    let points = first.array("Points", 3)?;
    let count = points.len() / 3;
    if count > POINTS {
        return Ok(Some(Err(format!(
            "The fields have {count} points, more than a page can carry: see them in ParaView."
        ))));
    }
    let mut scene = PageScene { all: grids.len(), marks: PageMarks::of_parts(part_names), ..PageScene::default() };
    let displacement = first.array("displacement", 3)?;
    if displacement.len() != points.len() {
        return Err(first.wrong("a displacement for each point"));
    }
    let origin = far_origin(&points);
    scene.marks.origin = origin;
    scene.x0 = points.iter().zip(&displacement).enumerate().map(|(i, (x, u))| (x - u - origin[i % 3]) as f32).collect();
    cells(&first, &kinds, count, &mut scene)?;
    scene.marks.section_y = section_y(&first, &scene);

    let names: Vec<String> = first.scalars_of_cells();
    let of_grid = 3 * count + names.len() * scene.kinds.len();
    let most = (NUMBERS / of_grid.max(1)).clamp(2, GRIDS);
    let every = grids.len().div_ceil(most).max(1);
    scene.fields = names.into_iter().map(|name| (name, Vec::new())).collect();
    let has_beams = scene.kinds.contains(&0) && first.array(SECTION_STRESSES[0].name, 1).is_ok();
    let mut of_beams = SECTION_STRESSES.map(|column| (column.name, Vec::new()));
    for (number, (time, file)) in grids.iter().enumerate() {
        if !number.is_multiple_of(every) && number + 1 != grids.len() {
            continue;
        }
        let grid = Grid::read(folder.join(file))?;
        let u = grid.array("displacement", 3)?;
        let of_cells: Vec<Vec<f64>> =
            scene.fields.iter().map(|(name, _)| grid.array(name, 1)).collect::<io::Result<_>>()?;
        // A stage may have other bodies: the page counts the times that are left out.
        if u.len() != 3 * count || of_cells.iter().any(|values| values.len() != scene.kinds.len()) {
            continue;
        }
        scene.times.push(*time as f32);
        scene.u.extend(u.iter().map(|&u| u as f32));
        for ((_, values), of_cells) in scene.fields.iter_mut().zip(of_cells) {
            values.extend(of_cells.iter().map(|&value| value as f32));
        }
        for (name, values) in of_beams.iter_mut().filter(|_| has_beams) {
            stresses_of_beams(&grid, name, &scene, values)?;
        }
    }
    let of_beams = of_beams.into_iter().filter(|_| has_beams);
    scene.fields.extend(of_beams.map(|(name, values)| (name.to_owned(), values)));
    Ok(Some(Ok(scene)))
}

/// Appends an extreme stress of each beam element, of `sigma_min` the least over its points, of others the largest; zero for other cells.
fn stresses_of_beams(grid: &Grid, name: &str, scene: &PageScene, out: &mut Vec<f32>) -> io::Result<()> {
    let of_points = grid.array(name, 1)?;
    let mut of_cells: Vec<Option<f64>> = vec![None; scene.kinds.len()];
    for (pair, &cell) in scene.lines.as_chunks::<2>().0.iter().zip(&scene.line_cells) {
        for point in pair {
            let value = of_points.get(*point as usize).ok_or_else(|| grid.wrong("the points of the first grid"))?;
            let so_far = of_cells[cell as usize].get_or_insert(*value);
            *so_far = if name == "sigma_min" { so_far.min(*value) } else { so_far.max(*value) };
        }
    }
    out.extend(of_cells.iter().map(|value| value.unwrap_or_default() as f32));
    Ok(())
}

/// The first point of a scene so far from the origin that seven digits do not resolve it; else the origin.
fn far_origin(points: &[f64]) -> [f64; 3] {
    let Some(&first) = points.as_chunks::<3>().0.first() else { return [0.0; 3] };
    let reach = |from: [f64; 3]| points.iter().enumerate().map(|(i, x)| (x - from[i % 3]).abs()).fold(0.0, f64::max);
    if reach([0.0; 3]) > 1e3 * reach(first) { first } else { [0.0; 3] }
}

/// Pictures of a mode in one swing.
const PHASES: usize = 16;
/// The largest number of pictures of all modes.
const PICTURES: usize = 640;
/// The largest displacement of a displayed mode, as a part of the size of the scene.
const SWING: f64 = 0.1;

/// The modes of a folder as a moving scene, and their number: each swings once, one after the other. The time is the number of the mode
/// and the part of its period. `None` where there are no modes.
///
/// # Errors
/// As for [`scene`].
pub fn modes(folder: &Path) -> io::Result<Option<(PageScene, usize)>> {
    let grids = listed(&folder.join("modes.pvd"))?;
    let Some((_, first)) = grids.first() else { return Ok(None) };
    let (kinds, part_names) = parts(&folder.join("fields.csv"))?;
    let first = Grid::read(folder.join(first))?;
    let points = first.array("Points", 3)?;
    let count = points.len() / 3;
    if count > POINTS {
        return Ok(None);
    }
    let mut scene = PageScene {
        x0: points.iter().map(|x| *x as f32).collect(),
        is_modes: true,
        marks: PageMarks::of_parts(part_names),
        ..PageScene::default()
    };
    cells(&first, &kinds, count, &mut scene)?;
    scene.marks.section_y = section_y(&first, &scene);
    let bounds = (0..3).map(|axis| {
        let of = || points.iter().skip(axis).step_by(3).copied();
        of().fold(f64::NEG_INFINITY, f64::max) - of().fold(f64::INFINITY, f64::min)
    });
    let swing = SWING * bounds.map(|side| side * side).sum::<f64>().sqrt();
    let most = (NUMBERS / (3 * count).max(1)).min(PICTURES) / PHASES;
    for (number, file) in grids.iter().take(most.max(1)) {
        let grid = Grid::read(folder.join(file))?;
        let u = grid.array("displacement", 3)?;
        let ahead = grid.array("displacement_ahead", 3).unwrap_or_else(|_| vec![0.0; u.len()]);
        if u.len() != 3 * count || ahead.len() != u.len() {
            return Err(grid.wrong("the points of the first grid"));
        }
        let largest = u.iter().chain(&ahead).map(|u| u.abs()).fold(f64::MIN_POSITIVE, f64::max);
        for phase in 0..PHASES {
            let part = phase as f64 / PHASES as f64;
            let (sin, cos) = (std::f64::consts::TAU * part).sin_cos();
            scene.times.push((number + part) as f32);
            let moved = u.iter().zip(&ahead).map(|(u, ahead)| swing / largest * (cos * u + sin * ahead));
            scene.u.extend(moved.map(|u| u as f32));
        }
    }
    scene.all = scene.times.len();
    scene.modes = roots(&folder.join("modes.csv"))?;
    Ok(Some((scene, grids.len())))
}

/// The frequency of each mode, or its load factor; empty where there is no table.
fn roots(path: &Path) -> io::Result<Vec<(Unit, f64)>> {
    if !path.is_file() {
        return Ok(Vec::new());
    }
    let mut rows = TableReader::open(path)?;
    let places = ["frequency", "factor"].map(|name| rows.column(name));
    let mut roots = Vec::new();
    while let Some(row) = rows.next_row()? {
        let [frequency, factor] =
            places.map(|place| place.and_then(|place| fields(row).nth(place)).map_or(f64::NAN, number));
        roots.push(if frequency.is_finite() { (Unit::Frequency, frequency) } else { (Unit::One, factor) });
    }
    Ok(roots)
}

/// The times and names of the grids; empty where there is no list.
fn listed(path: &Path) -> io::Result<Vec<(f64, String)>> {
    let list = match read_text(path) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        read => read.map_err(|e| at(path, e))?,
    };
    let grid = |line: &str| {
        let time = attribute(line, "timestep")?.parse().ok()?;
        let file = attribute(line, "file")?;
        // Only a file of the folder itself is opened, whatever the list says.
        (!file.contains(['/', '\\'])).then(|| (time, file.to_owned()))
    };
    Ok(list.lines().filter(|line| line.starts_with("<DataSet ")).filter_map(grid).collect())
}

/// The value of an attribute of a tag of XML.
fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    tag.split_once(&format!(" {name}=\""))?.1.split('"').next()
}

/// The y axes of sections at the points, where there are beams whose grid has them.
fn section_y(grid: &Grid, scene: &PageScene) -> Vec<f32> {
    let axes = if scene.kinds.contains(&0) { grid.array("frame_y", 3).unwrap_or_default() } else { Vec::new() };
    axes.into_iter().map(|x| x as f32).collect()
}

/// The kinds and the names of the parts, by the numbers of the parts.
fn parts(path: &Path) -> io::Result<(Vec<u8>, Vec<String>)> {
    let (mut kinds, mut names) = (Vec::new(), Vec::new());
    if !path.is_file() {
        return Ok((kinds, names));
    }
    let mut rows = TableReader::open(path)?;
    while let Some(row) = rows.next_row()? {
        let of = |place: usize| fields(row).nth(place).map(text).unwrap_or_default();
        kinds.push(KINDS.iter().position(|other| *other == of(1)).unwrap_or_default() as u8);
        names.push(of(2).into_owned());
    }
    Ok((kinds, names))
}

/// A grid as this program writes it.
struct Grid {
    path: PathBuf,
    /// The text before the numbers.
    text: String,
    /// The compressed arrays, and the end of the file.
    data: Vec<u8>,
}

impl Grid {
    fn read(path: PathBuf) -> io::Result<Grid> {
        let mut bytes = read_regular(&path).map_err(|e| at(&path, e))?;
        let found = bytes.windows(APPENDED.len()).position(|window| window == APPENDED.as_bytes());
        let data = bytes.split_off(found.map_or(bytes.len(), |at| at + APPENDED.len()));
        Ok(Grid { path, text: String::from_utf8_lossy(&bytes).into_owned(), data })
    }

    /// The error that the grid lacks something.
    fn wrong(&self, lacks: &str) -> io::Error {
        at(&self.path, io::Error::new(io::ErrorKind::InvalidData, format!("this grid has not {lacks}")))
    }

    /// The numbers of the array of a name, with so many components a tuple.
    fn array(&self, name: &str, components: usize) -> io::Result<Vec<f64>> {
        let read = || {
            let at = self.text.find(&format!(" Name=\"{name}\""))?;
            let tag = &self.text[self.text[..at].rfind('<')?..];
            let tag = &tag[..tag.find('>')?];
            let fits = attribute(tag, "NumberOfComponents")?.parse() == Ok(components);
            let bytes = inflate(self.data.get(attribute(tag, "offset")?.parse().ok()?..)?)?;
            let bytes = fits.then_some(bytes)?;
            Some(match attribute(tag, "type")? {
                "Float64" => bytes.as_chunks().0.iter().map(|&eight| f64::from_le_bytes(eight)).collect(),
                "Int64" => bytes.as_chunks().0.iter().map(|&eight| i64::from_le_bytes(eight) as f64).collect(),
                "UInt8" => bytes.iter().map(|&byte| f64::from(byte)).collect(),
                _ => return None,
            })
        };
        read().ok_or_else(|| self.wrong(&format!("an array `{name}` of {components} numbers each")))
    }

    /// The numbers of an array of places, numbers of parts, or types.
    fn places(&self, name: &str) -> io::Result<Vec<usize>> {
        Ok(self.array(name, 1)?.into_iter().map(|number| number as usize).collect())
    }

    /// The names of the arrays with one number for each cell, but for that with the numbers of parts.
    fn scalars_of_cells(&self) -> Vec<String> {
        let data = self.text.split_once("<CellData>").and_then(|(_, rest)| rest.split_once("</CellData>"));
        let tags = data.map_or("", |(data, _)| data).split("<DataArray").skip(1);
        let scalar = |tag: &&str| attribute(tag, "NumberOfComponents") == Some("1");
        let names = tags.filter(scalar).filter_map(|tag| attribute(tag, "Name"));
        names.filter(|name| *name != "part").map(String::from).collect()
    }
}

/// The bytes of a compressed array, which begins with the numbers of its blocks; `None` if they are inconsistent.
fn inflate(data: &[u8]) -> Option<Vec<u8>> {
    let head = data.as_chunks::<8>().0;
    let number = |k: usize| head.get(k).map(|&eight| u64::from_le_bytes(eight) as usize);
    let [count, size, last] = [number(0)?, number(1)?, number(2)?];
    let mut blocks = data.get(8_usize.checked_mul(count.checked_add(3)?)?..)?;
    let mut bytes = Vec::new();
    for k in 0..count {
        let (block, rest) = blocks.split_at_checked(number(3 + k)?)?;
        blocks = rest;
        let whole = if k + 1 == count && last > 0 { last } else { size };
        let before = bytes.len();
        // No more than a block holds, whatever the file says.
        ZlibDecoder::new(block).take(whole.min(LARGEST_BLOCK) as u64).read_to_end(&mut bytes).ok()?;
        if bytes.len() - before != whole {
            return None;
        }
    }
    Some(bytes)
}

/// The largest number of bytes of a block that is read.
const LARGEST_BLOCK: usize = 1 << 30;

/// The corners of the faces of a hexahedron, in VTK's order.
const FACES: [[usize; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// Adds the triangles of a flat face.
fn triangles(corners: &[usize], cell: usize, scene: &mut PageScene) {
    for k in 1..corners.len().saturating_sub(1) {
        scene.triangles.extend([corners[0], corners[k], corners[k + 1]].map(|p| p as u32));
        scene.triangle_cells.push(cell as u32);
    }
}

/// Adds the edges round a face.
fn edge_round(points: &[usize], edges: &mut HashSet<(u32, u32)>) {
    for (k, &a) in points.iter().enumerate() {
        let b = points[(k + 1) % points.len()];
        edges.insert((a.min(b) as u32, a.max(b) as u32));
    }
}

/// Takes cells apart into triangles and lines.
fn cells(grid: &Grid, kinds: &[u8], points: usize, scene: &mut PageScene) -> io::Result<()> {
    let (connectivity, offsets) = (grid.places("connectivity")?, grid.places("offsets")?);
    let (types, parts) = (grid.places("types")?, grid.places("part")?);
    if types.len() != offsets.len() || parts.len() != offsets.len() || connectivity.iter().any(|&p| p >= points) {
        return Err(grid.wrong("cells that fit its points"));
    }
    let mut edges = HashSet::new();
    let mut first = 0;
    for (cell, &end) in offsets.iter().enumerate() {
        let corners = connectivity.get(first..end).ok_or_else(|| grid.wrong("cells that fit its points"))?;
        first = end;
        scene.kinds.push(kinds.get(parts[cell]).copied().unwrap_or_default());
        scene.marks.cell_parts.push(parts[cell]);
        let mut face = |corners: &[usize]| {
            triangles(corners, cell, scene);
            edge_round(corners, &mut edges);
        };
        match (types[cell], corners) {
            (3 | 21 | 68, &[a, b, ref inner @ ..]) => {
                // VTK lists the ends of a curve first.
                let along: Vec<usize> = [a].into_iter().chain(inner.iter().copied()).chain([b]).collect();
                for pair in along.windows(2) {
                    scene.lines.extend([pair[0] as u32, pair[1] as u32]);
                    scene.line_cells.push(cell as u32);
                }
            }
            (12, corners) if corners.len() == 8 => FACES.iter().for_each(|f| face(&f.map(|k| corners[k]))),
            (5 | 7 | 9, corners) => face(corners),
            (22 | 28, nodes) => {
                // Its inner lines are none of the mesh.
                facets(nodes.len())
                    .iter()
                    .for_each(|facet| triangles(&facet.iter().map(|&k| nodes[k]).collect::<Vec<_>>(), cell, scene));
                edge_round(&ring(nodes.len()).map(|k| nodes[k]).collect::<Vec<_>>(), &mut edges);
            }
            _ => {}
        }
    }
    let mut edges: Vec<(u32, u32)> = edges.into_iter().collect();
    edges.sort_unstable();
    scene.edges = edges.into_iter().flat_map(|(a, b)| [a, b]).collect();
    Ok(())
}

impl PageScene {
    /// The scene as the scripts of the page read it, with the units of its legend and of its clock.
    pub fn json(&self, result: &super::result::Result, numbers: &mut PageNumbers) -> serde_json::Value {
        let shown = |unit: Unit| if self.is_modes { String::new() } else { unit.text(result.units()) };
        let fields: Vec<_> = self
            .fields
            .iter()
            .map(|(name, values)| serde_json::json!({ "name": name, "values": numbers.add(values, self.kinds.len()) }))
            .collect();
        let places =
            |places: &[u32]| BASE64_STANDARD.encode(places.iter().flat_map(|p| p.to_le_bytes()).collect::<Vec<_>>());
        serde_json::json!({
            "times": numbers.add(&self.times, 1),
            "x0": numbers.add(&self.x0, 3),
            "u": numbers.add(&self.u, self.x0.len()),
            "triangles": places(&self.triangles),
            "triangleCells": places(&self.triangle_cells),
            "lines": places(&self.lines),
            "lineCells": places(&self.line_cells),
            "edges": places(&self.edges),
            "kinds": BASE64_STANDARD.encode(&self.kinds),
            "fields": fields,
            "units": { "displacement": shown(Unit::Length), "stress": shown(Unit::Stress) },
            "clock": if self.is_modes { String::new() } else { result.clock() },
            "marks": self.marks.json(numbers),
            "labels": self.labels,
            "modes": (1..=self.modes.len()).map(|number| self.name_of_mode(number, result.units())).collect::<Vec<_>>(),
        })
    }
}
