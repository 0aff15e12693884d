//! What every file of the output folder shares: errors that name the file, new files that never lead through links, and small
//! files that are there whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::Path;

/// The error with the file it is about, and for a file that cannot grow with what to do.
pub fn at(path: &Path, error: io::Error) -> io::Error {
    let remedy = match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "\n  help: make room, or name another folder with -o"
        }
        io::ErrorKind::FileTooLarge => {
            "\n  help: raise the limit on the size of files (`ulimit -f`), or write less: `[output] interval`, `every`"
        }
        _ => "",
    };
    io::Error::new(error.kind(), format!("{}: {error}{remedy}", path.display()))
}

/// At the end of the name of a file that is not whole yet.
pub const UNFINISHED: &str = ".tmp";

/// A new file, for writing. An older file or link of this name goes first; what a link leads to stays as it is.
pub fn create(path: &Path) -> io::Result<File> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_file() || found.is_symlink() => fs::remove_file(path)?,
        Ok(_) => return Err(io::Error::new(io::ErrorKind::AlreadyExists, "there is something else of this name")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(error),
    }
    OpenOptions::new().write(true).create_new(true).open(path)
}

/// Whether a file still stands under its name.
pub fn is_same(file: &File, path: &Path) -> bool {
    let (Ok(open), Ok(named)) = (file.metadata(), fs::symlink_metadata(path)) else { return false };
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        (open.dev(), open.ino()) == (named.dev(), named.ino())
    }
    #[cfg(not(unix))]
    {
        open.file_type() == named.file_type()
    }
}

/// Writes a small file so that a reader sees the old one or the new one, never a part.
pub fn replace(path: &Path, text: &[u8]) -> io::Result<()> {
    let mut name = path.as_os_str().to_owned();
    name.push(UNFINISHED);
    let name = Path::new(&name);
    let write = || {
        create(name)?.write_all(text)?;
        fs::rename(name, path)
    };
    write().map_err(|error| {
        // A part of it is of no use, and on a full disk in the way.
        let _ = fs::remove_file(name);
        at(path, error)
    })
}
