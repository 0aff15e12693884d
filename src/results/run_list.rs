//! run.list: the names of the files that a run has written into its folder. `--overwrite` removes these files and nothing else.

use super::disk::at;
use base::text_file::read_text;
use std::collections::HashSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The name of the list in the output folder.
pub const NAME: &str = "run.list";
/// The first line of every list.
const HEAD: &str = "# written by this run; --overwrite takes it away";

/// The list of a run that is going on.
pub struct RunList {
    path: PathBuf,
    file: File,
    /// The names that are in the file.
    noted: HashSet<String>,
}

impl RunList {
    /// Opens a new list, or the one that is there to go on with it.
    ///
    /// # Errors
    /// The file cannot be written, or was not written by a run.
    pub fn open(dir: &Path) -> io::Result<RunList> {
        let path = dir.join(NAME);
        let listed = read(dir)?;
        let file = OpenOptions::new().append(true).create(true).open(&path).map_err(|error| at(&path, error))?;
        let is_new = listed.is_none();
        let mut list = RunList { path, file, noted: listed.into_iter().flatten().collect() };
        if is_new {
            list.note([HEAD])?;
        }
        Ok(list)
    }

    /// Adds files before they are written, so that the list is complete even after a crash.
    ///
    /// # Errors
    /// The list cannot be written; the error names it.
    pub fn note<'n>(&mut self, names: impl IntoIterator<Item = &'n str>) -> io::Result<()> {
        let new = names.into_iter().filter(|name| self.noted.insert((*name).to_owned()));
        let lines: String = new.map(|name| format!("{name}\n")).collect();
        if lines.is_empty() {
            return Ok(());
        }
        // The lines are written at once, so that each is there whole or not at all.
        self.file.write_all(lines.as_bytes()).map_err(|error| at(&self.path, error))
    }
}

/// The names in the list of a folder, without paths; `None` without a list.
///
/// # Errors
/// A file of this name was not written by a run, or a link has this name.
pub fn read(dir: &Path) -> io::Result<Option<Vec<String>>> {
    let path = dir.join(NAME);
    match fs::symlink_metadata(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(at(&path, error)),
        Ok(found) if !found.is_file() => return Err(foreign(&path)),
        Ok(_) => {}
    }
    let text = read_text(&path).map_err(|error| at(&path, error))?;
    if text.is_empty() {
        return Ok(None); // a run killed before its first line
    }
    if text.lines().next() != Some(HEAD) {
        return Err(foreign(&path));
    }
    let names = text.lines().skip(1).filter(|name| is_plain(name));
    Ok(Some(names.map(str::to_owned).collect()))
}

/// Whether a name leads to nothing but a file of the folder itself.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name != "." && name != ".." && !name.contains(['/', '\\', '\0'])
}

/// The error that a file is in the way of a run and was not written by a run.
pub fn foreign(path: &Path) -> io::Error {
    let path = path.display();
    io::Error::new(
        io::ErrorKind::AlreadyExists,
        format!(
            "`{path}` was not written by a run there, so --overwrite leaves it: move it, or name another folder with -o"
        ),
    )
}
