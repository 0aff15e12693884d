//! The output folder as a whole: who may write there, which files in it are those of a run, and how they are taken away.

use super::disk::{UNFINISHED, at};
use super::files::names;
use super::lock;
use super::run_list::{self, RunList, foreign};
use super::{checkpoint, fields, frd, log, result_json, tables};
use model::Model;
use std::collections::HashSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Prepares a locked folder for a run: it removes the files of an older run, so that none passes for a result of this one. Anything else
/// stays: other files, what links lead to, and the files `read` by the run, such as its deck.
///
/// # Errors
/// Without `overwrite`, the folder holds files. With it, a file that no run has written, or that this run reads, has a name that the run
/// needs. Then nothing has been removed.
pub fn claim(dir: &Path, overwrite: bool, models: &[&Model], read: &[PathBuf]) -> io::Result<()> {
    let files = entries(dir)?;
    if !overwrite && files.iter().any(|name| name != lock::NAME) {
        return Err(at(dir, io::Error::new(io::ErrorKind::AlreadyExists, "the folder holds files already")));
    }
    let older = ours(dir)?;
    let mut written: Vec<&str> = models.iter().copied().flat_map(names).collect();
    let draws = models.iter().any(|model| model.output.fields.is_some());
    written.extend([log::NAME, result_json::NAME, checkpoint::NAME]);
    let in_the_way = |name: &&String| {
        let is_next = written.contains(&name.as_str()) || (draws && fields::is_grid(name));
        is_next && !older.contains(*name)
    };
    if let Some(name) = files.iter().find(in_the_way) {
        return Err(foreign(&dir.join(name)));
    }
    let read: Vec<PathBuf> = read.iter().flat_map(|path| [place(path), path.canonicalize().ok()]).flatten().collect();
    let is_read = |name: &&String| place(&dir.join(name)).is_some_and(|path| read.contains(&path));
    if let Some(name) = older.iter().find(is_read) {
        let text = "this run reads it, so --overwrite leaves it: name another folder with -o";
        return Err(at(&dir.join(name), io::Error::new(io::ErrorKind::AlreadyExists, text)));
    }
    take_away(dir, &files, &older)?;
    let mut list = RunList::open(dir)?;
    list.note(written)
}

/// The names of all that is in a folder.
pub(super) fn entries(dir: &Path) -> io::Result<Vec<String>> {
    let entries = fs::read_dir(dir).map_err(|e| at(dir, e))?;
    let name = |entry: io::Result<fs::DirEntry>| Ok(entry?.file_name().to_str().map(str::to_owned));
    let names: io::Result<Vec<Option<String>>> = entries.map(name).collect();
    Ok(names.map_err(|e| at(dir, e))?.into_iter().flatten().collect())
}

/// A path whose folder is free of links; the file itself may be a link.
fn place(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}

/// The files in the list of a folder, and unfinished files of a run.
fn ours(dir: &Path) -> io::Result<HashSet<String>> {
    let listed = run_list::read(dir)?.unwrap_or_default();
    let unfinished: Vec<String> = listed.iter().map(|name| format!("{name}{UNFINISHED}")).collect();
    Ok(listed.into_iter().chain(unfinished).collect())
}

/// Removes files of a run. The result goes first, so that it never stands beside tables of another run. The list goes last, so that a
/// failure leaves the remaining names known.
fn take_away(dir: &Path, files: &[String], ours: &HashSet<String>) -> io::Result<()> {
    let remove = |name: &str| {
        let path = dir.join(name);
        match fs::remove_file(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            removed => removed.map_err(|error| at(&path, error)),
        }
    };
    let there = || files.iter().filter(|name| ours.contains(*name)).map(String::as_str);
    there().filter(|name| *name == result_json::NAME).try_for_each(remove)?;
    there().filter(|name| *name != result_json::NAME).try_for_each(remove)?;
    remove(run_list::NAME)
}

/// Whether a run writes a file of this name, whole or unfinished.
fn is_of_a_run(name: &str) -> bool {
    let whole = name.strip_suffix(UNFINISHED).unwrap_or(name);
    let is_result =
        tables::of_file(whole).is_some() || fields::is_file(whole) || [frd::NAME, result_json::NAME].contains(&whole);
    is_result || [log::NAME, run_list::NAME, lock::NAME, checkpoint::NAME].contains(&name)
}

/// Removes the files of an earlier run, and its folder if nothing else is in it.
///
/// # Errors
/// The folder cannot be read, or a file in it cannot be removed; the error names it.
pub fn remove_run(dir: &Path) -> io::Result<()> {
    let files = entries(dir)?;
    let mut ours = ours(dir)?;
    // A killed run leaves its lock behind.
    ours.insert(lock::NAME.to_owned());
    take_away(dir, &files, &ours)?;
    remove_empty(dir)
}

/// True where a folder holds files of a run.
pub fn holds_run(dir: &Path) -> io::Result<bool> {
    Ok(entries(dir)?.iter().any(|name| is_of_a_run(name)))
}

/// Removes a folder that has nothing in it; any other stays.
pub fn remove_empty(dir: &Path) -> io::Result<()> {
    let mut entries = fs::read_dir(dir).map_err(|e| at(dir, e))?;
    if entries.next().is_none() { fs::remove_dir(dir).map_err(|e| at(dir, e)) } else { Ok(()) }
}

/// Removes the files whose names are `ours`; folders and symbolic links stay.
pub fn remove(dir: &Path, is_ours: &dyn Fn(&str) -> bool) -> io::Result<()> {
    for entry in fs::read_dir(dir).map_err(|e| at(dir, e))? {
        let entry = entry.map_err(|e| at(dir, e))?;
        let path = entry.path();
        // No run makes symbolic links: somebody has put it there.
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
