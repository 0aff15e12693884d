//! run.lock: the mark of the process that writes into a folder. The operating system holds it as long as the process lives, so
//! the one that a killed run leaves binds nobody on the same host; its text says who it is, for people and for other hosts.

use super::disk::{at, is_same};
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// The name of the lock in the output folder.
pub const NAME: &str = "run.lock";

/// The right to write into a folder. It is held until it is dropped, which removes the file.
#[derive(Debug)]
pub struct FolderLock {
    path: PathBuf,
    _file: File,
}

/// The process that writes into a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Holder {
    host: String,
    process: u32,
    /// Seconds since 1970, UTC.
    began: u64,
    /// The identifier of the boot of the host; empty where the system does not tell.
    boot: String,
}

impl Holder {
    /// This process.
    fn this() -> Holder {
        let line = |path: &str| fs::read_to_string(path).unwrap_or_default().trim().to_owned();
        let host = [line("/proc/sys/kernel/hostname"), std::env::var("HOSTNAME").unwrap_or_default()];
        Holder {
            host: host.into_iter().find(|name| !name.is_empty()).unwrap_or_else(|| "this host".into()),
            process: std::process::id(),
            began: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            boot: line("/proc/sys/kernel/random/boot_id"),
        }
    }

    /// The text of the lock.
    fn text(&self) -> String {
        let Holder { host, process, began, boot } = self;
        format!("host {host}\nprocess {process}\nbegan {began} ({})\nboot {boot}\n", date(*began))
    }

    /// Reads the text of a lock; `None` where it is not whole.
    fn read(text: &str) -> Option<Holder> {
        let entry =
            |key: &str| text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(' ')).map(str::to_owned);
        Some(Holder {
            host: entry("host")?,
            process: entry("process")?.parse().ok()?,
            began: entry("began")?.split(' ').next()?.parse().ok()?,
            boot: entry("boot").unwrap_or_default(),
        })
    }

    /// Whether the process may still run, as far as the text of its lock can tell.
    fn may_live(&self, this: &Holder) -> bool {
        if self.host != this.host {
            return true;
        }
        let rebooted = !self.boot.is_empty() && !this.boot.is_empty() && self.boot != this.boot;
        let processes = Path::new("/proc/self");
        !rebooted && (!processes.exists() || Path::new("/proc").join(self.process.to_string()).exists())
    }
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "process {} on {}, begun {}", self.process, self.host, date(self.began))
    }
}

impl FolderLock {
    /// Takes the lock of a folder, which must exist.
    ///
    /// # Errors
    /// Another process writes there ([`io::ErrorKind::ResourceBusy`]), and who it is; or the lock cannot be written.
    pub fn take(dir: &Path) -> io::Result<FolderLock> {
        let path = dir.join(NAME);
        let this = Holder::this();
        loop {
            // No run makes symbolic links: the link is removed, and what it leads to stays.
            if fs::symlink_metadata(&path).is_ok_and(|found| found.is_symlink()) {
                fs::remove_file(&path).map_err(|error| at(&path, error))?;
            }
            let open = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
            let mut file = open.map_err(|error| at(&path, error))?;
            let locked = match file.try_lock() {
                Ok(()) => true,
                Err(TryLockError::WouldBlock) => return Err(busy(dir, &path, holder(&mut file).as_ref())),
                // On a file system without locks the text alone tells.
                Err(TryLockError::Error(_)) => false,
            };
            // The holder before may have removed the file between opening and locking.
            if locked && !is_same(&file, &path) {
                continue;
            }
            let older = holder(&mut file);
            if let Some(older) =
                older.filter(|older| if locked { older.host != this.host } else { older.may_live(&this) })
            {
                return Err(busy(dir, &path, Some(&older)));
            }
            let write =
                file.set_len(0).and_then(|()| file.rewind()).and_then(|()| file.write_all(this.text().as_bytes()));
            write.map_err(|error| at(&path, error))?;
            return Ok(FolderLock { path, _file: file });
        }
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // Only the lock of this process is removed: a folder that was removed and made anew may have another.
        let text = fs::read_to_string(&self.path).unwrap_or_default();
        if Holder::read(&text).is_some_and(|holder| holder.process == std::process::id()) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// The holder that an open lock names.
fn holder(file: &mut File) -> Option<Holder> {
    let mut text = String::new();
    file.rewind().and_then(|()| file.read_to_string(&mut text)).ok()?;
    Holder::read(&text)
}

/// The error that another process writes into the folder.
fn busy(dir: &Path, path: &Path, holder: Option<&Holder>) -> io::Error {
    let who = holder.map_or_else(|| "another process".to_owned(), Holder::to_string);
    io::Error::new(
        io::ErrorKind::ResourceBusy,
        format!(
            "{}: another run writes there: {who}\n  help: wait for it, or name another folder with -o; if that process is gone, \
             remove `{}`",
            dir.display(),
            path.display()
        ),
    )
}

/// Seconds since 1970 as a date: 2026-01-31 23:59:59 UTC. Days become civil dates as in H. Hinnant, "chrono-compatible low-level
/// date algorithms".
fn date(seconds: u64) -> String {
    let (days, of_day) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * of_year + 2) / 153;
    let (day, month) = (of_year - (153 * shifted + 2) / 5 + 1, if shifted < 10 { shifted + 3 } else { shifted - 9 });
    let year = year_of_era + 400 * era + u64::from(month <= 2);
    let (hour, minute, second) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02} UTC")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_holds_it_and_the_next_takes_over_what_is_stale() {
        let dir = tempfile::tempdir().unwrap();
        let lock = FolderLock::take(dir.path()).unwrap();
        let error = FolderLock::take(dir.path()).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::ResourceBusy);
        assert!(error.to_string().contains(&format!("process {} on ", std::process::id())), "{error}");
        drop(lock);
        assert!(!dir.path().join(NAME).exists());
        // A lock that a process of this host has left is free: the system holds it no more.
        let this = Holder::this();
        for left in [this.text(), String::new(), "host ".into(), Holder { boot: "other".into(), ..this.clone() }.text()]
        {
            fs::write(dir.path().join(NAME), left).unwrap();
            drop(FolderLock::take(dir.path()).unwrap());
        }
        // Of a process of another host nobody here can tell whether it runs.
        fs::write(dir.path().join(NAME), Holder { host: "elsewhere".into(), ..this }.text()).unwrap();
        let error = FolderLock::take(dir.path()).unwrap_err().to_string();
        assert!(error.contains("on elsewhere") && error.contains("remove `"), "{error}");
    }

    #[test]
    fn dates_are_civil() {
        // The dates are those of `date -u -d @…`.
        assert_eq!(date(0), "1970-01-01 00:00:00 UTC");
        assert_eq!(date(951_782_399), "2000-02-28 23:59:59 UTC");
        assert_eq!(date(951_782_400), "2000-02-29 00:00:00 UTC");
        assert_eq!(date(1_798_761_599), "2026-12-31 23:59:59 UTC");
    }

    #[test]
    #[cfg(unix)]
    fn a_link_is_not_followed() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("mine"), "kept").unwrap();
        std::os::unix::fs::symlink("mine", dir.path().join(NAME)).unwrap();
        drop(FolderLock::take(dir.path()).unwrap());
        assert_eq!(fs::read_to_string(dir.path().join("mine")).unwrap(), "kept");
    }
}
