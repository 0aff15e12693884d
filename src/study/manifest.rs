//! study.list: the names of all that a study has written into its folder. Nothing else is removed or written over.

use super::options::RUNS;
use base::text_file::read_text;
use results::{at, holds_run, remove, remove_empty, remove_run, replace};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The name of the list in the folder of a study.
pub const NAME: &str = "study.list";
/// The first line of every list.
const HEAD: &str = "# written by this study; --overwrite takes it away";

/// The files and folders of runs that a study has written, by their names below its folder.
pub struct Manifest {
    folder: PathBuf,
    names: Vec<String>,
}

impl Manifest {
    /// Starts in a new, empty or overwritten folder: the files of an older study are removed, all others stay.
    ///
    /// # Errors
    /// Something there that no study has written is in the way of these files and folders of runs; then nothing has been removed.
    pub fn begin(folder: &Path, files: &[&str], runs: &[String]) -> io::Result<Manifest> {
        fs::create_dir_all(folder).map_err(|error| at(folder, error))?;
        let list = folder.join(NAME);
        let older: Vec<String> = match read_text(&list) {
            Ok(text) if text.lines().next() == Some(HEAD) => text.lines().skip(1).map(str::to_owned).collect(),
            Ok(_) => return Err(foreign(&list)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(at(&list, error)),
        };
        let is_known = |name: &str| older.iter().any(|older| older == name);
        for name in files {
            let path = folder.join(name);
            if fs::symlink_metadata(&path).is_ok() && !is_known(name) {
                return Err(foreign(&path));
            }
        }
        let linked = is_link(&folder.join(RUNS));
        for name in runs {
            let path = folder.join(name);
            let known = is_known(name) && !linked && !is_link(&path);
            if !known && holds_results(&path)? {
                return Err(foreign(&path));
            }
        }
        let of_runs =
            |name: &&String| name.strip_prefix(RUNS).and_then(|rest| rest.strip_prefix('/')).is_some_and(is_plain);
        for name in older.iter().filter(of_runs) {
            let path = folder.join(name);
            // No study makes symbolic links: somebody has put it there, so it stays.
            if !linked && fs::symlink_metadata(&path).is_ok_and(|found| found.is_dir()) {
                remove_run(&path)?;
            }
        }
        let runs = folder.join(RUNS);
        if !linked && runs.is_dir() {
            remove_empty(&runs)?;
        }
        remove(folder, &|name| name == NAME || is_known(name))?;
        Ok(Manifest { folder: folder.to_owned(), names: Vec::new() })
    }

    /// Adds files before they are written, so that the list is complete even after a crash.
    ///
    /// # Errors
    /// The list cannot be written; the error names it.
    pub fn note(&mut self, name: &str) -> io::Result<()> {
        self.names.push(name.to_owned());
        let lines = std::iter::once(HEAD).chain(self.names.iter().map(String::as_str));
        let text: String = lines.map(|line| format!("{line}\n")).collect();
        replace(&self.folder.join(NAME), text.as_bytes())
    }

    /// Notes and writes a file, whole or not at all.
    ///
    /// # Errors
    /// A file cannot be written; the error names it.
    pub fn write(&mut self, name: &str, text: &[u8]) -> io::Result<()> {
        self.note(name)?;
        replace(&self.folder.join(name), text)
    }
}

/// Whether a name leads to nothing but an entry of the folder itself.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name != "." && name != ".." && !name.contains(['/', '\\'])
}

fn is_link(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink())
}

/// Whether a run would write over something in this place.
fn holds_results(path: &Path) -> io::Result<bool> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => holds_run(path),
        Ok(_) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(is_link(path)),
        Err(error) => Err(at(path, error)),
    }
}

/// The error that a file is in the way of a study and was not written by one.
fn foreign(path: &Path) -> io::Error {
    let path = path.display();
    io::Error::new(
        io::ErrorKind::AlreadyExists,
        format!(
            "`{path}` was not written by a study there, so --overwrite leaves it: move it, or name another folder with -o"
        ),
    )
}
