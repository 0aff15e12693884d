//! The lock of many folders at once: a hard link of one file stands as run.lock in each of them. Some file systems (ext4 for minutes) do
//! not reuse the inodes of removed files at once, and search all of them for each new file. A new lock for each case of a sweep would make
//! every case slower than the one before.

use super::disk::{at, is_same};
use super::lock::{
    FolderLock, Held, Holder, NAME, SETTLED, TAKEN_OVER, busy, holder, is_given_up, keep_alive, unstable,
};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// The beginning and the ending of the name of the file that is linked, with host and process between.
const NAMED: [&str; 2] = ["cases.", ".lock"];

/// The lock of this process for many folders, one after the other. It ends when this is dropped, and with it the file.
#[derive(Debug)]
pub struct SharedLock {
    own: FolderLock,
    /// Held while an abandoned lock is removed: all abandoned locks of a killed process are one file.
    making_room: Mutex<()>,
}

impl SharedLock {
    /// Links the lock into an existing folder, and removes the files of dead processes.
    ///
    /// # Errors
    /// The file cannot be made; the error names it.
    pub fn new(dir: &Path) -> io::Result<SharedLock> {
        take_away_left(dir)?;
        let this = Holder::this();
        let host: String = this.host.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        let path = dir.join(format!("{}{host}.{}{}", NAMED[0], this.process, NAMED[1]));
        for _ in 0..TAKEN_OVER.1 {
            let made = OpenOptions::new().read(true).write(true).create_new(true).open(&path);
            let mut file = match made {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                    // A process that is gone has had the same number.
                    remove(&path)?;
                    continue;
                }
                made => made.map_err(|error| at(&path, error))?,
            };
            // A process that cleans up may mistake a file that is not locked yet for an abandoned one.
            if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) || !is_same(&file, &path) {
                std::thread::sleep(TAKEN_OVER.0);
                continue;
            }
            let text = this.text();
            file.write_all(text.as_bytes()).map_err(|error| at(&path, error))?;
            let held = Arc::new(Held { file, text });
            keep_alive(&held);
            return Ok(SharedLock { own: FolderLock { path, held }, making_room: Mutex::new(()) });
        }
        Err(unstable(&path))
    }

    /// Takes the lock of a folder, which must exist.
    ///
    /// # Errors
    /// As for [`FolderLock::take`].
    pub fn take(&self, dir: &Path) -> io::Result<FolderLock> {
        let path = dir.join(NAME);
        let mut of_another_host = false;
        for _ in 0..TAKEN_OVER.1 {
            match fs::hard_link(&self.own.path, &path) {
                Ok(()) => {
                    let lock = FolderLock { path, held: self.own.held.clone() };
                    if of_another_host {
                        std::thread::sleep(SETTLED);
                        if !is_same(&lock.held.file, &lock.path) {
                            return Err(busy(dir, &lock.path, None));
                        }
                    }
                    return Ok(lock);
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                    of_another_host |= self.make_room(dir, &path)?;
                }
                // A file system without links.
                Err(_) => return FolderLock::take(dir),
            }
        }
        Err(busy(dir, &path, None))
    }

    /// Removes the lock of a dead process from a folder, if it is still there; true for a process of another host. An error says who holds
    /// it.
    fn make_room(&self, dir: &Path, path: &Path) -> io::Result<bool> {
        let _one_at_a_time = self.making_room.lock();
        if fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink()) {
            return remove(path).map(|()| false);
        }
        let mut file = match OpenOptions::new().read(true).write(true).open(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            opened => opened.map_err(|error| at(path, error))?,
        };
        let this = Holder::this();
        let locked = match file.try_lock() {
            Ok(()) => true,
            Err(TryLockError::WouldBlock) => {
                let holder = holder(&mut file);
                if holder.as_ref().is_none_or(|holder| holder.may_live(&this)) {
                    return Err(busy(dir, path, holder.as_ref()));
                }
                // Another process is just taking over a lock that is the same file.
                std::thread::sleep(TAKEN_OVER.0);
                return Ok(false);
            }
            // On a file system without locks the text alone decides.
            Err(TryLockError::Error(_)) => false,
        };
        if locked && !is_same(&file, path) {
            return Ok(false);
        }
        let older = holder(&mut file);
        let in_the_way = older.filter(|older| if locked { older.host != this.host } else { older.may_live(&this) });
        if let Some(older) = in_the_way.as_ref().filter(|older| !is_given_up(older, &this, &file, dir)) {
            return Err(busy(dir, path, Some(older)));
        }
        remove(path)?;
        Ok(in_the_way.is_some())
    }
}

/// Removes the files of dead processes from a folder.
fn take_away_left(dir: &Path) -> io::Result<()> {
    let this = Holder::this();
    for entry in fs::read_dir(dir).map_err(|error| at(dir, error))? {
        let name = entry.map_err(|error| at(dir, error))?.file_name();
        let is_one = name.to_str().is_some_and(|name| name.starts_with(NAMED[0]) && name.ends_with(NAMED[1]));
        let path: PathBuf = dir.join(&name);
        let Some(mut file) = is_one.then(|| File::options().read(true).write(true).open(&path).ok()).flatten() else {
            continue;
        };
        let is_left = match (file.try_lock(), holder(&mut file)) {
            (Err(TryLockError::WouldBlock), _) => false,
            (_, Some(older)) if older.host != this.host => is_given_up(&older, &this, &file, dir),
            (Ok(()), _) => true,
            (Err(TryLockError::Error(_)), older) => older.is_some_and(|older| !older.may_live(&this)),
        };
        if is_left {
            remove(&path)?;
        }
    }
    Ok(())
}

/// Removes a file that another process may be removing as well.
fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(at(path, error)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of the files in a folder.
    fn names(dir: &Path) -> Vec<String> {
        let entries = fs::read_dir(dir).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn one_file_locks_many_folders() {
        let root = tempfile::tempdir().unwrap();
        let dirs = ["a", "b"].map(|name| root.path().join(name));
        dirs.iter().for_each(|dir| fs::create_dir(dir).unwrap());
        let shared = SharedLock::new(root.path()).unwrap();
        let locks = dirs.each_ref().map(|dir| shared.take(dir).unwrap());
        for dir in &dirs {
            // Neither this process nor another acquires it a second time.
            for error in [shared.take(dir).unwrap_err(), FolderLock::take(dir).unwrap_err()] {
                assert_eq!(error.kind(), ErrorKind::ResourceBusy);
                assert!(error.to_string().contains(&format!("process {} on ", std::process::id())), "{error}");
            }
        }
        drop(locks);
        assert!(dirs.iter().all(|dir| names(dir).is_empty()));
        drop(shared);
        assert_eq!(names(root.path()).len(), 2);
    }

    /// A killed process leaves one file in many folders; two others may acquire it at the same time.
    #[test]
    fn what_a_killed_process_has_left_is_free() {
        let root = tempfile::tempdir().unwrap();
        let this = format!("process {}", std::process::id());
        let gone = Holder::this().text().replace(&this, &format!("process {}", u32::MAX));
        let left = root.path().join("cases.here.7.lock");
        fs::write(&left, gone).unwrap();
        let dirs: Vec<PathBuf> = (0..40).map(|i| root.path().join(i.to_string())).collect();
        for dir in &dirs {
            fs::create_dir(dir).unwrap();
            fs::hard_link(&left, dir.join(NAME)).unwrap();
        }
        let shared = SharedLock::new(root.path()).unwrap();
        assert!(!left.exists());
        std::thread::scope(|scope| {
            for half in dirs.chunks(20) {
                let shared = &shared;
                scope.spawn(move || half.iter().for_each(|dir| drop(shared.take(dir).unwrap())));
            }
        });
        assert!(dirs.iter().all(|dir| names(dir).is_empty()));
    }
}
