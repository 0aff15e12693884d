//! Supports, loads, joints and sections of beams on the page. Each mark is tied to the nearest point of the scene, and moves with it.

use super::numbers::PageNumbers;
use crate::marks::{SceneMarks, SectionSize, box_of};
use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::{Value, json};
use std::collections::HashMap;

/// Part of the size of the scene within which a place and a point are one: coordinates on the page have seven digits.
const SAME: f64 = 1e-5;
/// The largest number of places that lie on no point, such as centres of bodies.
const BESIDE: usize = 200;

/// A place of the scene: a point that it moves with, and the way from there at t = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anchor {
    /// The point.
    pub point: usize,
    /// The way, global components.
    pub way: [f64; 3],
}

/// The marks of a page, and the sections of its beams.
#[derive(Default)]
pub struct PageMarks {
    /// The place of the origin of the coordinates of the scene.
    pub origin: [f64; 3],
    /// The number of the part of each cell.
    pub cell_parts: Vec<usize>,
    /// The names of the parts, by their numbers.
    part_names: Vec<String>,
    /// The y axes of sections at the points of beams at t = 0, three global components each; empty without beams.
    pub section_y: Vec<f32>,
    sections: Vec<SectionSize>,
    /// The number of the section of each cell from 1; 0 of cells without one.
    cell_sections: Vec<u8>,
    /// Supports, with the bits of their directions.
    pub supports: Vec<(Anchor, u8)>,
    /// Loads, with force and moment.
    pub loads: Vec<(Anchor, [f64; 6])>,
    /// Joints.
    pub joints: Vec<Anchor>,
}

impl PageMarks {
    /// Without any mark yet; the parts have these names.
    pub fn of_parts(part_names: Vec<String>) -> PageMarks {
        PageMarks { part_names, ..PageMarks::default() }
    }

    /// Adds the marks of a run on a scene with points at `x0`.
    pub fn add(&mut self, marks: SceneMarks, x0: &[f32]) {
        self.cell_sections = vec![0; self.cell_parts.len()];
        for (cell, part) in self.cell_parts.iter().enumerate() {
            let Some(size) = self.part_names.get(*part).and_then(|name| marks.beams.get(name)) else { continue };
            let place = self.sections.iter().position(|known| known == size).unwrap_or_else(|| {
                self.sections.push(size.clone());
                self.sections.len() - 1
            });
            self.cell_sections[cell] = u8::try_from(place + 1).unwrap_or_default();
        }
        let (mut anchors, origin) = (Anchors::new(x0), self.origin);
        let mut at = |place: [f64; 3]| anchors.at([0, 1, 2].map(|k| place[k] - origin[k]));
        self.supports = marks.supports.into_iter().filter_map(|(place, dofs)| Some((at(place)?, dofs))).collect();
        self.loads = marks.loads.into_iter().filter_map(|(place, load)| Some((at(place)?, load))).collect();
        self.joints = marks.joints.into_iter().filter_map(&mut at).collect();
    }

    /// The depth of the beam of a cell, half the sum of the sides of its box; zero without a section.
    pub fn depth(&self, cell: usize) -> f64 {
        let number = usize::from(self.cell_sections.get(cell).copied().unwrap_or_default());
        match number.checked_sub(1).map(|place| &self.sections[place]) {
            Some(SectionSize::Round { radius }) => 2.0 * radius,
            Some(SectionSize::Box { y, z }) => 0.5 * (y[1] - y[0] + z[1] - z[0]),
            Some(SectionSize::Walls { walls }) => box_of(walls).iter().map(|[low, high]| 0.5 * (high - low)).sum(),
            None => 0.0,
        }
    }

    /// The marks as the scripts of the page read them: rows of a point, a way and the numbers of a mark.
    pub fn json(&self, numbers: &mut PageNumbers) -> Value {
        let row = |anchor: &Anchor, numbers: &[f64]| {
            let mut row = vec![json!(anchor.point)];
            row.extend(anchor.way.iter().chain(numbers).map(|x| json!(*x as f32)));
            row
        };
        json!({
            "sections": self.sections,
            "sectionY": (!self.sections.is_empty()).then(|| numbers.add(&self.section_y, 3)),
            "cellSections": BASE64_STANDARD.encode(&self.cell_sections),
            "supports": self.supports.iter().map(|(at, dofs)| row(at, &[f64::from(*dofs)])).collect::<Vec<_>>(),
            "loads": self.loads.iter().map(|(at, load)| row(at, load)).collect::<Vec<_>>(),
            "joints": self.joints.iter().map(|at| row(at, &[])).collect::<Vec<_>>(),
        })
    }
}

/// Finds points by their places.
struct Anchors<'s> {
    x0: &'s [[f32; 3]],
    by_place: HashMap<[i64; 3], usize>,
    step: f64,
    /// The places beside points so far.
    beside: usize,
}

impl Anchors<'_> {
    fn new(x0: &[f32]) -> Anchors<'_> {
        let most = x0.iter().filter(|x| x.is_finite()).fold(f32::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let x0 = x0.as_chunks::<3>().0;
        let mut anchors = Anchors { x0, by_place: HashMap::new(), step: SAME * f64::from(most), beside: 0 };
        for (point, x) in x0.iter().enumerate() {
            let key = anchors.key(x.map(f64::from));
            anchors.by_place.entry(key).or_insert(point);
        }
        anchors
    }

    fn key(&self, place: [f64; 3]) -> [i64; 3] {
        place.map(|x| (x / self.step).round() as i64)
    }

    fn at(&mut self, place: [f64; 3]) -> Option<Anchor> {
        let key = self.key(place);
        let near = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
        let mut keys = std::iter::once([0; 3]).chain(near).map(|by: [i64; 3]| [0, 1, 2].map(|i| key[i] + by[i]));
        if let Some(point) = keys.find_map(|key| self.by_place.get(&key)) {
            return Some(Anchor { point: *point, way: [0.0; 3] });
        }
        self.beside += 1;
        if self.beside > BESIDE {
            return None;
        }
        let way = |x: &[f32; 3]| [0, 1, 2].map(|i| place[i] - f64::from(x[i]));
        let far = |x: &[f32; 3]| way(x).iter().map(|d| d * d).sum::<f64>();
        let points = self.x0.iter().enumerate().filter(|(_, x)| far(x).is_finite());
        let (point, x) = points.min_by(|a, b| far(a.1).total_cmp(&far(b.1)))?;
        Some(Anchor { point, way: way(x) })
    }
}
