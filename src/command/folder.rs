//! The folder that a command writes into.

use super::console::{complain, say};
use super::exit::Exit;
use super::load::is_standard_input;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A folder of the current folder that is named after a deck. Only the last extension is replaced, so that `a.v1.toml` and
/// `a.v2.toml` have a folder each.
pub fn named_after(deck: &Path, extension: &str) -> PathBuf {
    // A deck on standard input has no name.
    let stem = if is_standard_input(deck) { OsStr::new("deck") } else { deck.file_stem().unwrap_or_default() };
    let mut name = stem.to_owned();
    name.push(".");
    name.push(extension);
    PathBuf::from(name)
}

/// Makes sure that a folder is new, or empty, or given up by `--overwrite`.
///
/// # Errors
/// [`Exit::Usage`] if it holds files, [`Exit::InputOutput`] if it cannot be read; the reason has been shown.
pub fn require_free(folder: &Path, overwrite: bool) -> Result<(), Exit> {
    let entries = match std::fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_some(),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => false,
        Err(error) => {
            complain(&format!("cannot write to `{}`: {error}", folder.display()));
            return Err(Exit::InputOutput);
        }
    };
    if entries && !overwrite {
        complain(&format!("the folder `{}` holds files already", folder.display()));
        say("  help: --overwrite replaces results; -o DIR writes elsewhere");
        return Err(Exit::Usage);
    }
    Ok(())
}
