//! The data that the scripts of the page read: numbers, and the moving scene.

use base64::prelude::{BASE64_STANDARD, Engine};

/// The moving scene, thinned to what a page can carry; points and cells are named by their places from 0.
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
    /// The names of the points, where points are all there is to see.
    pub labels: Vec<String>,
    /// The number of times before thinning.
    pub all: usize,
}

/// Numbers as the page reads them: base64 of little-endian Float32.
pub fn numbers(values: &[f32]) -> String {
    BASE64_STANDARD.encode(values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>())
}
