//! What every file of the output folder shares: errors that name the file, and small files that are there whole or not at all.

use std::fs;
use std::io;
use std::path::Path;

/// The error with the file it is about.
pub fn at(path: &Path, error: io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// At the end of the name of a file that is not whole yet.
pub const UNFINISHED: &str = ".tmp";

/// Writes a small file so that a reader sees the old one or the new one, never a part.
pub fn replace(path: &Path, text: &[u8]) -> io::Result<()> {
    let mut name = path.as_os_str().to_owned();
    name.push(UNFINISHED);
    fs::write(&name, text).and_then(|()| fs::rename(&name, path)).map_err(|e| at(path, e))
}
