//! run.lock: the mark of the process that writes into a folder. The operating system holds the lock while the process lives, so that the
//! lock of a killed run blocks nobody on the same host. Its text names the process for people and other hosts.
//!
//! Whether a process of another host lives cannot be asked. Each process therefore renews its lock every [`RENEWED`]. A lock that is older
//! than [`GIVEN_UP`] by the clock of the file system belongs to a dead host and is replaced.

use super::disk::{UNFINISHED, at, is_same};
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, Once, OnceLock, Weak};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The name of the lock in the output folder.
pub const NAME: &str = "run.lock";
/// The time between two signs of life of who holds a lock.
const RENEWED: Duration = Duration::from_secs(30);
/// The time without one after which a lock of another host is taken over.
const GIVEN_UP: Duration = Duration::from_secs(300);
/// The time after which a replaced lock must still be ours: another host may replace it in the same moment.
pub(super) const SETTLED: Duration = Duration::from_secs(1);
/// The pause before another look at a lock that is just being taken or released, and the number of looks.
pub(super) const TAKEN_OVER: (Duration, usize) = (Duration::from_millis(1), 200);

/// The right to write into a folder. It is held until it is dropped, which removes the file.
#[derive(Debug)]
pub struct FolderLock {
    pub(super) path: PathBuf,
    pub(super) held: Arc<Held>,
}

/// An open lock with its text.
#[derive(Debug)]
pub(super) struct Held {
    pub(super) file: File,
    pub(super) text: String,
}

impl Held {
    /// Writes the text once more, so that the file system notes the time. Readers see the same bytes before and after. A lock that another
    /// host has taken over, as after a long suspension, is left to it.
    fn renew(&self) -> io::Result<()> {
        let (mut file, mut text) = (&self.file, String::new());
        file.rewind()?;
        file.read_to_string(&mut text)?;
        if text == self.text {
            file.rewind()?;
            file.write_all(text.as_bytes())?;
            file.sync_data()?;
        }
        Ok(())
    }
}

/// The locks that this process holds.
static ALL_HELD: Mutex<Vec<Weak<Held>>> = Mutex::new(Vec::new());

/// Renews a lock periodically while it is held.
pub(super) fn keep_alive(held: &Arc<Held>) {
    static BEGUN: Once = Once::new();
    let Ok(mut all) = ALL_HELD.lock() else { return };
    all.retain(|one| one.strong_count() > 0);
    all.push(Arc::downgrade(held));
    BEGUN.call_once(|| {
        std::thread::spawn(|| {
            loop {
                std::thread::sleep(RENEWED);
                let held: Vec<Arc<Held>> =
                    ALL_HELD.lock().map(|all| all.iter().filter_map(Weak::upgrade).collect()).unwrap_or_default();
                // Other processes replace a lock that is not renewed in time; the run itself reports the failing disk elsewhere.
                held.iter().for_each(|held| drop(held.renew()));
            }
        });
    });
}

/// The process that writes into a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Holder {
    pub(super) host: String,
    pub(super) process: u32,
    /// Seconds since 1970, UTC.
    began: u64,
    /// The identifier of the boot of the host; empty if the system has none.
    boot: String,
    /// Whether it renews its lock, which older versions of this program do not.
    renews: bool,
}

impl Holder {
    /// This process.
    pub(super) fn this() -> Holder {
        // A sweep acquires thousands of locks.
        static HOST_AND_BOOT: OnceLock<(String, String)> = OnceLock::new();
        let (host, boot) = HOST_AND_BOOT.get_or_init(|| {
            let line = |path: &str| fs::read_to_string(path).unwrap_or_default().trim().to_owned();
            let host = [line("/proc/sys/kernel/hostname"), std::env::var("HOSTNAME").unwrap_or_default()];
            let host = host.into_iter().find(|name| !name.is_empty()).unwrap_or_else(|| "this host".into());
            (host, line("/proc/sys/kernel/random/boot_id"))
        });
        Holder {
            host: host.clone(),
            process: std::process::id(),
            began: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            boot: boot.clone(),
            renews: true,
        }
    }

    /// The text of the lock.
    pub(super) fn text(&self) -> String {
        let Holder { host, process, began, boot, renews } = self;
        let renewed = if *renews { format!("renewed every {} s\n", RENEWED.as_secs()) } else { String::new() };
        format!("host {host}\nprocess {process}\nbegan {began} ({})\nboot {boot}\n{renewed}", date(*began))
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
            renews: entry("renewed").is_some(),
        })
    }

    /// Whether the process may still run, judged by the text of its lock.
    pub(super) fn may_live(&self, this: &Holder) -> bool {
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

/// The name of this host.
pub fn host() -> String {
    Holder::this().host
}

impl FolderLock {
    /// Acquires the lock of a folder, and creates the folder if needed.
    ///
    /// # Errors
    /// As for [`FolderLock::take`], or the folder cannot be made.
    pub fn make(dir: &Path) -> io::Result<FolderLock> {
        fs::create_dir_all(dir).map_err(|error| at(dir, error))?;
        FolderLock::take(dir)
    }

    /// Takes the lock of a folder, which must exist.
    ///
    /// # Errors
    /// Another process writes there ([`io::ErrorKind::ResourceBusy`]), and who it is; or the lock cannot be written.
    pub fn take(dir: &Path) -> io::Result<FolderLock> {
        let path = dir.join(NAME);
        for _ in 0..TAKEN_OVER.1 {
            if let Some(lock) = FolderLock::take_once(dir, &path)? {
                return Ok(lock);
            }
            std::thread::sleep(TAKEN_OVER.0);
        }
        Err(unstable(&path))
    }

    /// Acquires a lock; `None` if the locked file no longer has its name.
    fn take_once(dir: &Path, path: &Path) -> io::Result<Option<FolderLock>> {
        let this = Holder::this();
        // No run makes symbolic links: the link is removed, and its target remains.
        if fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink()) {
            fs::remove_file(path).map_err(|error| at(path, error))?;
        }
        let open = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let mut file = open.map_err(|error| at(path, error))?;
        let locked = match file.try_lock() {
            Ok(()) => true,
            Err(TryLockError::WouldBlock) => return Err(busy(dir, path, holder(&mut file).as_ref())),
            // On a file system without locks the text alone decides.
            Err(TryLockError::Error(_)) => false,
        };
        // The holder before may have removed the file between opening and locking.
        if locked && !is_same(&file, path) {
            return Ok(None);
        }
        let older = holder(&mut file);
        let in_the_way = older.filter(|older| if locked { older.host != this.host } else { older.may_live(&this) });
        if let Some(older) = in_the_way.as_ref().filter(|older| !is_given_up(older, &this, &file, dir)) {
            return Err(busy(dir, path, Some(older)));
        }
        let text = this.text();
        let write = file.set_len(0).and_then(|()| file.rewind()).and_then(|()| file.write_all(text.as_bytes()));
        write.map_err(|error| at(path, error))?;
        if in_the_way.is_some() {
            file.sync_data().map_err(|error| at(path, error))?;
            std::thread::sleep(SETTLED);
            let now = fs::read_to_string(path).unwrap_or_default();
            if now != text {
                return Err(busy(dir, path, Holder::read(&now).as_ref()));
            }
        }
        let held = Arc::new(Held { file, text });
        keep_alive(&held);
        Ok(Some(FolderLock { path: path.to_owned(), held }))
    }
}

/// A lock that is another file whenever it is looked at.
pub(super) fn unstable(path: &Path) -> io::Error {
    let (file, times) = (path.display(), TAKEN_OVER.1);
    io::Error::other(format!(
        "{file}: another file replaced it {times} times after it was locked, so the lock protects nothing\n  help: let no other program remove \
         it. If none does, the file system has no locks: take a folder on another disk"
    ))
}

/// Whether the process of another host that holds a lock has died with its host: it has not renewed it for so long. Both times come from
/// the file system, because clocks of hosts differ.
pub(super) fn is_given_up(holder: &Holder, this: &Holder, file: &File, dir: &Path) -> bool {
    if !holder.renews || holder.host == this.host {
        return false;
    }
    let probe = dir.join(format!("{NAME}.{}{UNFINISHED}", std::process::id()));
    let now = File::create(&probe).and_then(|mut file| {
        file.write_all(b"\n")?;
        file.sync_data()?;
        file.metadata()?.modified()
    });
    let _ = fs::remove_file(&probe);
    let renewed = file.metadata().and_then(|found| found.modified());
    // A date far in the future is no sign of life either: the clock of the file system gives none such.
    let apart = |now: SystemTime, renewed| now.duration_since(renewed).unwrap_or_else(|ahead| ahead.duration());
    matches!((now, renewed), (Ok(now), Ok(renewed)) if apart(now, renewed) > GIVEN_UP)
}

impl FolderLock {
    /// True unless another process has taken the folder over, or removed it and made it anew.
    pub fn is_held(&self) -> bool {
        fs::read_to_string(&self.path).is_ok_and(|text| text == self.held.text)
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        if self.is_held() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// The holder that an open lock names.
pub(super) fn holder(file: &mut File) -> Option<Holder> {
    let mut text = String::new();
    file.rewind().and_then(|()| file.read_to_string(&mut text)).ok()?;
    Holder::read(&text)
}

/// The error that another process writes into the folder.
pub(super) fn busy(dir: &Path, path: &Path, holder: Option<&Holder>) -> io::Error {
    let who = holder.map_or_else(|| "another process".to_owned(), Holder::to_string);
    let elsewhere = holder.is_some_and(|holder| holder.renews && holder.host != Holder::this().host);
    let gone = match elsewhere {
        true => {
            format!("if its host died, its lock is taken over {} s after its last sign of life", GIVEN_UP.as_secs())
        }
        false => format!("if that process is gone, remove `{}`", path.display()),
    };
    let text = format!(
        "{}: another run writes there: {who}\n  help: wait for it, or name another folder with -o; {gone}",
        dir.display()
    );
    io::Error::new(io::ErrorKind::ResourceBusy, text)
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
        // Of a process of another host nobody here can tell whether it runs, unless it gives signs of life.
        let elsewhere = Holder { host: "elsewhere".into(), renews: false, ..this };
        fs::write(dir.path().join(NAME), elsewhere.text()).unwrap();
        age(&dir.path().join(NAME), 100 * GIVEN_UP);
        let error = FolderLock::take(dir.path()).unwrap_err().to_string();
        assert!(error.contains("on elsewhere") && error.contains("remove `"), "{error}");
    }

    /// Sets back the time of the last renewal of a lock.
    fn age(path: &Path, by: Duration) {
        OpenOptions::new().write(true).open(path).unwrap().set_modified(SystemTime::now() - by).unwrap();
    }

    #[test]
    fn the_lock_of_a_host_that_died_is_taken_over() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join(NAME);
        fs::write(&path, Holder { host: "elsewhere".into(), ..Holder::this() }.text()).unwrap();
        for sign_of_life in [Duration::ZERO, RENEWED, GIVEN_UP - RENEWED] {
            age(&path, sign_of_life);
            let error = FolderLock::take(dir.path()).unwrap_err().to_string();
            assert!(error.contains("on elsewhere") && error.contains("300 s after its last sign of life"), "{error}");
        }
        // A date in the future, as a wrong clock has left it, is taken over as well.
        OpenOptions::new().write(true).open(&path).unwrap().set_modified(SystemTime::now() + 2 * GIVEN_UP).unwrap();
        drop(FolderLock::take(dir.path()).unwrap());
        fs::write(&path, Holder { host: "elsewhere".into(), ..Holder::this() }.text()).unwrap();
        age(&path, GIVEN_UP + RENEWED);
        let lock = FolderLock::take(dir.path()).unwrap();
        assert!(fs::read_to_string(&path).unwrap().contains(&format!("process {}\n", std::process::id())));
        // Who holds it renews it, and the text stays as it was.
        let text = fs::read_to_string(&path).unwrap();
        age(&path, GIVEN_UP);
        lock.held.renew().unwrap();
        let since = fs::metadata(&path).unwrap().modified().unwrap().elapsed().unwrap_or_default();
        assert!(since < RENEWED && fs::read_to_string(&path).unwrap() == text, "{since:?}");
        drop(lock);
        // The lock that somebody else has put in its place meanwhile is not ours to remove.
        let lock = FolderLock::take(dir.path()).unwrap();
        let theirs = Holder { host: "elsewhere".into(), ..Holder::this() }.text();
        fs::write(&path, &theirs).unwrap();
        lock.held.renew().unwrap();
        drop(lock);
        assert_eq!(fs::read_to_string(&path).unwrap(), theirs);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
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
