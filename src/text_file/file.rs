//! Files that a deck names, judged before they are read: a device without end or a pipe that nobody fills would hold the program
//! for good.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Bytes of a file at most: a mesh of some ten million nodes.
pub const LARGEST: u64 = 4 << 30;

/// The bytes of a regular file.
///
/// # Errors
/// The file is of another kind, larger than [`LARGEST`], or cannot be read.
pub fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    let wrong = |text: String| Err(io::Error::new(io::ErrorKind::InvalidInput, text));
    let found = std::fs::metadata(path)?;
    if found.is_dir() {
        return wrong("it is a folder".into());
    }
    if !found.is_file() {
        return wrong("it is a device or a pipe, not a regular file".into());
    }
    if found.len() > LARGEST {
        return wrong(format!(
            "it has {:.1} GB, more than {} GB are not read",
            found.len() as f64 / 1e9,
            LARGEST >> 30
        ));
    }
    let mut bytes = Vec::with_capacity(found.len() as usize);
    // The file may grow while it is read.
    File::open(path)?.take(LARGEST).read_to_end(&mut bytes)?;
    Ok(bytes)
}
