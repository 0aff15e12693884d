//! Checks files before rdsolve reads them, because an endless device or an empty pipe would block the program.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Bytes of a file at most: a mesh of some ten million nodes.
pub const LARGEST: u64 = 4 << 30;

/// Opens a regular file for reading.
///
/// # Errors
/// The file is of another kind or cannot be opened.
pub fn open_regular(path: impl AsRef<Path>) -> io::Result<File> {
    let path = path.as_ref();
    let found = std::fs::metadata(path)?;
    let wrong = |text: &str| Err(io::Error::new(io::ErrorKind::InvalidInput, text));
    match () {
        () if found.is_dir() => wrong("it is a folder"),
        () if !found.is_file() => wrong("it is a device or a pipe, not a regular file"),
        () => File::open(path),
    }
}

/// The bytes of a regular file.
///
/// # Errors
/// The file is of another kind, larger than [`LARGEST`], or cannot be read.
pub fn read_regular(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    let file = open_regular(path)?;
    let length = file.metadata()?.len();
    if length > LARGEST {
        let message = format!("it has {:.1} GB, rdsolve reads {} GB at most", length as f64 / 1e9, LARGEST >> 30);
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    // The file may grow while it is read.
    file.take(LARGEST).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The text of a regular file.
///
/// # Errors
/// The file is of another kind, larger than [`LARGEST`], not UTF-8, or cannot be read.
pub fn read_text(path: impl AsRef<Path>) -> io::Result<String> {
    String::from_utf8(read_regular(path)?).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}
