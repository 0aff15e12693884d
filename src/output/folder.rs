//! The output folder as a whole: which files in it are those of a run, and how they are taken away.

use super::disk::{UNFINISHED, at};
use super::{fields, log, result_json, tables};
use std::fs;
use std::io;
use std::path::Path;

/// Removes results of an earlier run, so that none of them is taken for one of this; other files stay.
pub fn remove_stale(dir: &Path) -> io::Result<()> {
    remove(dir, &is_result)
}

fn is_result(name: &str) -> bool {
    tables::of_file(name).is_some() || fields::is_file(name) || name == result_json::NAME
}

/// A file that a run writes, whole or not.
fn is_of_a_run(name: &str) -> bool {
    name == log::NAME || is_result(name.strip_suffix(UNFINISHED).unwrap_or(name))
}

/// Removes what an earlier run has left, and its folder unless something else is in it.
pub fn remove_run(dir: &Path) -> io::Result<()> {
    remove(dir, &is_of_a_run)?;
    remove_empty(dir)
}

/// True where a folder holds files of a run.
pub fn holds_run(dir: &Path) -> io::Result<bool> {
    for entry in fs::read_dir(dir).map_err(|e| at(dir, e))? {
        let entry = entry.map_err(|e| at(dir, e))?;
        if entry.file_name().to_str().is_some_and(is_of_a_run) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Removes a folder with nothing in it.
pub fn remove_empty(dir: &Path) -> io::Result<()> {
    let mut entries = fs::read_dir(dir).map_err(|e| at(dir, e))?;
    if entries.next().is_none() { fs::remove_dir(dir).map_err(|e| at(dir, e)) } else { Ok(()) }
}

/// Removes the files of these names.
pub fn remove(dir: &Path, is_ours: &dyn Fn(&str) -> bool) -> io::Result<()> {
    for entry in fs::read_dir(dir).map_err(|e| at(dir, e))? {
        let entry = entry.map_err(|e| at(dir, e))?;
        let path = entry.path();
        // A symbolic link was put there by somebody.
        if !entry.file_type().map_err(|e| at(&path, e))?.is_file() {
            continue;
        }
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if is_ours(name) {
            fs::remove_file(&path).map_err(|e| at(&path, e))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_results_of_an_earlier_run_go() {
        let dir = tempfile::tempdir().unwrap();
        for name in ["links.csv", "fields.csv", "fields_000010.vtu", "result.json", "notes.txt", "my_nodes.csv"] {
            fs::write(dir.path().join(name), "old").unwrap();
        }
        remove_stale(dir.path()).unwrap();
        let mut left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["my_nodes.csv", "notes.txt"]);
    }
}
