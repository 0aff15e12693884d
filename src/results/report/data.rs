//! The moving scene that the scripts of the page read.

use super::marks::PageMarks;
use base::names::{short, to_digits};
use base::quantities::{Unit, UnitSystem};

/// The moving scene, thinned to the capacity of a page; points and cells are numbered from 0.
#[derive(Default)]
pub struct PageScene {
    /// The times that are shown.
    pub times: Vec<f32>,
    /// The undeformed positions, three global components a point.
    pub x0: Vec<f32>,
    /// The displacements by time and point, three global components each.
    pub u: Vec<f32>,
    /// The triangles, three points each.
    pub triangles: Vec<u32>,
    /// The cell that each triangle belongs to.
    pub triangle_cells: Vec<u32>,
    /// The lines, two points each.
    pub lines: Vec<u32>,
    /// The cell that each line belongs to.
    pub line_cells: Vec<u32>,
    /// The edges of faces, two points each.
    pub edges: Vec<u32>,
    /// The kind of part that each cell belongs to, as the page numbers them.
    pub kinds: Vec<u8>,
    /// The fields on cells: a name, and numbers by time and cell.
    pub fields: Vec<(String, Vec<f32>)>,
    /// Sections of beams, supports, loads and joints.
    pub marks: PageMarks,
    /// The names of the points, where points are all there is to see.
    pub labels: Vec<String>,
    /// The number of times before thinning.
    pub all: usize,
    /// Whether the times are numbers of modes and parts of their periods.
    pub is_modes: bool,
    /// The frequency or the load factor of each mode, from the first on; empty of other scenes.
    pub modes: Vec<(Unit, f64)>,
}

impl PageScene {
    /// Whether there is a face, a line or a named point at any time.
    pub fn is_seen(&self) -> bool {
        let lengths = [self.triangles.len(), self.lines.len(), self.labels.len()];
        !self.times.is_empty() && lengths.iter().any(|&length| length > 0)
    }

    /// The name of a mode, by its number from 1: its frequency, or its load factor.
    pub fn name_of_mode(&self, number: usize, units: Option<&UnitSystem>) -> String {
        let of_root = |(unit, value): &(Unit, f64)| match unit {
            Unit::Frequency => format!(": {} {}", to_digits(*value, 4), unit.text(units)),
            _ => format!(": load factor {}", to_digits(*value, 4)),
        };
        let root = self.modes.get(number.wrapping_sub(1)).filter(|(_, value)| value.is_finite());
        format!("mode {number}{}", root.map(of_root).unwrap_or_default())
    }

    /// The number of the time nearest to one, from 0; without one, the last time, or the first of a mode.
    ///
    /// # Errors
    /// The time lies before the first or after the last of the scene.
    pub fn frame(&self, time: Option<f64>) -> Result<usize, String> {
        let last = self.times.len() - 1;
        let Some(time) = time else { return Ok(if self.is_modes { 0 } else { last }) };
        let off = |frame: &usize| (f64::from(self.times[*frame]) - time).abs();
        let [from, to] = [0, last].map(|frame| f64::from(self.times[frame]));
        let room = 1e-6 * from.abs().max(to.abs());
        if !(from.min(to) - room..=from.max(to) + room).contains(&time) {
            return Err(format!(
                "the results have no time {}: they go from {} to {}",
                short(time),
                short(from),
                short(to)
            ));
        }
        Ok((0..=last).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(last))
    }
}
