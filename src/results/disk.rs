//! Common to all files of the output folder: errors name the file, new files never follow links, and small files appear complete or not at
//! all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Adds the name of the file to the message of an error, and the remedy if the file cannot grow.
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

/// The ending that the name of a file has while it is not whole yet.
pub const UNFINISHED: &str = ".tmp";

/// Makes a new file for writing. An older file or link of this name is removed first; the target of a link remains.
///
/// # Errors
/// Something that is neither a file nor a link has this name, or the system refuses; the error does not name the file.
pub fn create(path: &Path) -> io::Result<File> {
    // Each write appends: if another process truncates the file, no hole arises, and the length shows the loss.
    let make = || OpenOptions::new().append(true).create_new(true).open(path);
    match make() {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        made => return made,
    }
    let found = fs::symlink_metadata(path)?;
    if !(found.is_file() || found.is_symlink()) {
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, "there is something else of this name"));
    }
    fs::remove_file(path)?;
    make()
}

/// Whether an open file still stands under its name. On systems without inodes, any file of that name counts.
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
///
/// # Errors
/// The file cannot be written; the error names it, and no part of it is left.
pub fn replace(path: &Path, text: &[u8]) -> io::Result<()> {
    let mut name = path.as_os_str().to_owned();
    name.push(UNFINISHED);
    let name = Path::new(&name);
    let write = || {
        create(name)?.write_all(text)?;
        fs::rename(name, path)
    };
    write().map_err(|error| {
        // The unfinished file is useless, and occupies space on a full disk.
        let _ = fs::remove_file(name);
        at(path, error)
    })
}

/// Has all files of these folders, which stand in the folder `within`, safe on the disk, and their names.
///
/// # Errors
/// The disk does not take them.
#[cfg(target_os = "linux")]
pub fn make_safe(within: &Path, _folders: &[PathBuf]) -> io::Result<()> {
    // One call for the whole file system: waiting for each file of a case separately costs several milliseconds.
    rustix::fs::syncfs(File::open(within)?).map_err(|error| at(within, error.into()))
}

/// Has all files of these folders, which stand in the folder `within`, safe on the disk, and their names.
///
/// # Errors
/// The disk does not take them.
#[cfg(not(target_os = "linux"))]
pub fn make_safe(within: &Path, folders: &[PathBuf]) -> io::Result<()> {
    for folder in folders.iter().map(PathBuf::as_path) {
        for entry in fs::read_dir(folder).map_err(|error| at(folder, error))? {
            let path = entry.map_err(|error| at(folder, error))?.path();
            // Who only reads a file may not have it written on some systems.
            let opened = OpenOptions::new().append(true).open(&path);
            opened.and_then(|file| file.sync_all()).map_err(|error| at(&path, error))?;
        }
    }
    // Where folders cannot be opened, names are safe with their files.
    for folder in folders.iter().map(PathBuf::as_path).chain([within]) {
        if cfg!(unix) {
            File::open(folder).and_then(|file| file.sync_all()).map_err(|error| at(folder, error))?;
        }
    }
    Ok(())
}
