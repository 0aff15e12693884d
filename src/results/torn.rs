//! Tables that end within a row, as a kill at the moment of writing leaves them: readers omit this row, and commands name the table.

use super::disk::at;
use super::tables::TABLES;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// A sentence for each table of results in a folder whose last line has no end, in the order of their names.
///
/// # Errors
/// A table cannot be read; the error names it.
pub fn torn_tables(folder: &Path) -> io::Result<Vec<String>> {
    let mut torn = Vec::new();
    for table in TABLES {
        let path = folder.join(table.file);
        match ends_within_a_row(&path) {
            Ok(true) => torn.push(table.file),
            Ok(false) => {}
            Err(fault) if fault.kind() == io::ErrorKind::NotFound => {}
            Err(fault) => return Err(at(&path, fault)),
        }
    }
    torn.sort_unstable();
    let sentence = |name: &str| {
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
