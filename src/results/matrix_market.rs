//! SceneMatrices in the format Matrix Market, which numerical libraries read: coordinates from 1 on, one entry a line.

use super::disk::{at, create};
use solve::modes::SceneMatrices;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes K.mtx, M.mtx, C.mtx (with damping), G.mtx (with joints), and dofs.csv, the node and direction of each row, into a folder, which
/// is created if needed. Files of these names are replaced. Returns their names.
///
/// # Errors
/// A file cannot be written; the error names it.
pub fn write(folder: &Path, matrices: &SceneMatrices) -> io::Result<Vec<&'static str>> {
    std::fs::create_dir_all(folder).map_err(|error| at(folder, error))?;
    let unknowns = matrices.unknowns.len();
    let mut written = Vec::new();
    for (name, matrix) in [("K.mtx", &matrices.stiffness), ("M.mtx", &matrices.mass), ("C.mtx", &matrices.damping)] {
        if name != "C.mtx" || !matrix.is_zero() {
            matrix_file(&folder.join(name), [unknowns; 2], || matrix.entries())?;
            written.push(name);
        }
    }
    if matrices.equations > 0 {
        matrix_file(&folder.join("G.mtx"), [matrices.equations, unknowns], || matrices.constraints.iter().copied())?;
        written.push("G.mtx");
    }
    let path = folder.join("dofs.csv");
    let mut table = csv::Writer::from_writer(create(&path).map_err(|error| at(&path, error))?);
    table.write_record(["row", "node", "direction"]).map_err(|error| at(&path, error.into()))?;
    for (row, (node, direction)) in matrices.unknowns.iter().enumerate() {
        let row = (row + 1).to_string();
        table.write_record([row.as_str(), node.as_str(), direction]).map_err(|error| at(&path, error.into()))?;
    }
    table.flush().map_err(|error| at(&path, error))?;
    written.push("dofs.csv");
    Ok(written)
}

/// Writes one matrix, whose `entries` are asked for twice.
fn matrix_file<I: Iterator<Item = (usize, usize, f64)>>(
    path: &Path,
    [rows, columns]: [usize; 2],
    entries: impl Fn() -> I,
) -> io::Result<()> {
    let write = || {
        let mut file = BufWriter::new(create(path)?);
        writeln!(file, "%%MatrixMarket matrix coordinate real general")?;
        writeln!(file, "{rows} {columns} {}", entries().count())?;
        for (row, column, value) in entries() {
            writeln!(file, "{} {} {value:e}", row + 1, column + 1)?;
        }
        file.flush()
    };
    write().map_err(|error| at(path, error))
}
