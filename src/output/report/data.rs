//! What the scripts of the page read: numbers, and the moving scene.

use base64::prelude::{BASE64_STANDARD, Engine};

/// What moves.
#[derive(Default)]
pub struct PageScene {
    pub times: Vec<f32>,
    /// Undeformed, three numbers a point.
    pub x0: Vec<f32>,
    /// Displacements, by time and point.
    pub u: Vec<f32>,
    /// Three points each, and the cells they belong to.
    pub triangles: Vec<u32>,
    pub triangle_cells: Vec<u32>,
    /// Two points each.
    pub lines: Vec<u32>,
    pub line_cells: Vec<u32>,
    pub edges: Vec<u32>,
    /// What each cell is part of.
    pub kinds: Vec<u8>,
    /// Names, and numbers by time and cell.
    pub fields: Vec<(String, Vec<f32>)>,
    /// Names of the points, where they are all there is to see.
    pub labels: Vec<String>,
    /// Times there are.
    pub all: usize,
}

/// As the page reads them: base64 of little-endian Float32.
pub fn numbers(values: &[f32]) -> String {
    BASE64_STANDARD.encode(values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>())
}
