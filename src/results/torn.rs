//! Tables that end within a row, as a kill at the moment of writing leaves them: readers omit this row, and commands name the table.

use super::disk::at;
use super::folder::entries;
use super::tables::of_file;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// A sentence for each table of results in a folder whose last line has no end, in the order of their names.
///
/// # Errors
/// A table cannot be read; the error names it.
pub fn torn_tables(folder: &Path) -> io::Result<Vec<String>> {
    let mut torn = Vec::new();
    // A sweep has thousands of folders. Each is listed by one call, where two dozen calls would ask for its tables.
    for name in entries(folder)?.into_iter().filter(|name| of_file(name).is_some()) {
        let path = folder.join(&name);
        if ends_within_a_row(&path).map_err(|fault| at(&path, fault))? {
            torn.push(name);
        }
    }
    torn.sort_unstable();
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
