//! Tables that end within a row, as a kill at the moment of writing leaves them: readers omit this row, and commands name the table.

use super::disk::at;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// A sentence for each table of a folder whose last line has no end, in the order of their names.
///
/// # Errors
/// The folder or a table cannot be read; the error names it.
pub fn torn_tables(folder: &Path) -> io::Result<Vec<String>> {
    let mut torn = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| at(folder, e))? {
        let path = entry.map_err(|e| at(folder, e))?.path();
        let is_table = path.extension().is_some_and(|extension| extension == "csv") && path.is_file();
        if is_table && ends_within_a_row(&path).map_err(|e| at(&path, e))? {
            torn.extend(path.file_name().map(|name| name.to_string_lossy().into_owned()));
        }
    }
    torn.sort();
    let sentence = |name: String| {
        format!(
            "the last line of {name} is incomplete and omitted: the run was killed, is still writing, or its disk was full. \
             Continue it by `--resume`, or run it again"
        )
    };
    Ok(torn.into_iter().map(sentence).collect())
}

fn ends_within_a_row(path: &Path) -> io::Result<bool> {
    let mut file = File::open(path)?;
    let mut last = [b'\n'];
    if file.seek(SeekFrom::End(0))? > 0 {
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last)?;
    }
    Ok(last != [b'\n'])
}
