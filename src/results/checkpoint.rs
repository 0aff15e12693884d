//! run.checkpoint: the state from which a run continues as if it had never stopped, and the origin of that state. It is written beside the
//! one before and moved into its place, and closed by a digest: a reader finds a whole one, or none.

use super::disk::{UNFINISHED, at, create};
use base::snapshot::{Keep, Snapshot, keep};
use base::text_file::open_regular;
use sha2::{Digest, Sha256};
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// The name of the checkpoint in the output folder.
pub const NAME: &str = "run.checkpoint";
/// The first line of every checkpoint.
const HEAD: &[u8] = b"rdsolve checkpoint 1\n";
/// The number of bytes of the digest at the end.
const DIGEST: usize = 32;

/// The program, the deck and the options that a checkpoint belongs to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CheckpointOrigin {
    /// The version of the program, with its commit.
    pub version: String,
    /// The digest of the deck without the entries that may change.
    pub deck: String,
    /// The overrides, as they were given, without those of what may change.
    pub sets: Vec<String>,
    /// The end of the run.
    pub end_time: f64,
    /// True where the run has come to it.
    pub is_over: bool,
    /// The names and digests of the mesh and the records that the deck names.
    pub files: Vec<(String, String)>,
    /// True with `--mesh-error`.
    pub mesh_error: bool,
    /// The results that a case of a sweep keeps; empty of another run.
    pub numbers: String,
    /// The level of instructions of the run. It may change, because a scheduler may continue the run on another machine.
    pub instructions: String,
}

keep!(CheckpointOrigin: Default { version, deck, sets, end_time, is_over, files, mesh_error, numbers, instructions });

impl CheckpointOrigin {
    /// The differences between the checkpoint and the run that would continue it, in words; `None` if there are none.
    pub fn difference(&self, now: &CheckpointOrigin) -> Option<String> {
        let list = |sets: &[String]| match sets {
            [] => "none".to_owned(),
            sets => sets.iter().map(|set| format!("`{set}`")).collect::<Vec<_>>().join(", "),
        };
        if self.version != now.version {
            return Some(format!("rdsolve {} has written it, and this is {}", self.version, now.version));
        }
        if self.deck != now.deck {
            return Some("the deck has changed since".to_owned());
        }
        if self.sets != now.sets {
            return Some(format!("its --set are {}, and now {}", list(&self.sets), list(&now.sets)));
        }
        if self.mesh_error != now.mesh_error {
            return Some(format!("it was {} --mesh-error", if self.mesh_error { "with" } else { "without" }));
        }
        if self.numbers != now.numbers {
            return Some("a sweep has written it, or one that keeps or collects something else".to_owned());
        }
        if self.end_time != now.end_time && !(self.is_over && self.end_time < now.end_time) {
            let then = if self.is_over { "" } else { ", which it has not come to: let it come there first" };
            return Some(format!("it is one of a run to `end_time` = {}{then}", self.end_time));
        }
        let changed = now.files.iter().find(|file| !self.files.contains(file));
        changed.map(|(name, _)| format!("`{name}` has changed since"))
    }
}

/// A checkpoint: its origin, and the states of earlier stages, of the watchers and of the run itself.
#[derive(Debug, Default)]
pub struct Checkpoint {
    /// What it belongs to.
    pub origin: CheckpointOrigin,
    /// The stages before.
    pub stages: Vec<u8>,
    /// Files, expectations, log and error bars.
    pub watchers: Vec<u8>,
    /// The run.
    pub run: Vec<u8>,
}

impl Keep for Checkpoint {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let Checkpoint { origin, stages, watchers, run } = self;
        origin.keep(snapshot);
        [stages, watchers, run].into_iter().for_each(|bytes| snapshot.all(bytes));
    }
}

impl Checkpoint {
    /// The path of the checkpoint of a folder.
    pub fn path(dir: &Path) -> PathBuf {
        dir.join(NAME)
    }

    /// Writes the checkpoint of a folder to the disk completely, then replaces the earlier one.
    ///
    /// # Errors
    /// It cannot be written; the one before then stands.
    pub fn write(&mut self, dir: &Path) -> io::Result<()> {
        let path = Checkpoint::path(dir);
        let mut snapshot = Snapshot::taken();
        self.keep(&mut snapshot);
        let body = snapshot.into_bytes();
        let unfinished = dir.join(format!("{NAME}{UNFINISHED}"));
        let write = || {
            let mut file = create(&unfinished)?;
            file.write_all(HEAD)?;
            file.write_all(&body)?;
            file.write_all(&digest(&body))?;
            file.sync_all()?;
            fs::rename(&unfinished, &path)?;
            sync_folder(dir)
        };
        write().map_err(|error| {
            let _ = fs::remove_file(&unfinished);
            at(&path, error)
        })
    }

    /// Reads the checkpoint of a folder; `None` where there is none.
    ///
    /// # Errors
    /// It cannot be read, or is not whole.
    pub fn read(dir: &Path) -> io::Result<Option<Checkpoint>> {
        let path = Checkpoint::path(dir);
        let mut bytes = Vec::new();
        match open_regular(&path).and_then(|mut file| file.read_to_end(&mut bytes)) {
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(at(&path, error)),
        };
        let torn = || at(&path, io::Error::new(io::ErrorKind::InvalidData, "this is no whole checkpoint of a run"));
        if !bytes.starts_with(HEAD) || bytes.len() < HEAD.len() + DIGEST {
            return Err(torn());
        }
        let told = bytes.split_off(bytes.len() - DIGEST);
        let body = bytes.split_off(HEAD.len());
        if digest(&body)[..] != told[..] {
            return Err(torn());
        }
        let (mut snapshot, mut checkpoint) = (Snapshot::of(body), Checkpoint::default());
        checkpoint.keep(&mut snapshot);
        if snapshot.is_used_up() { Ok(Some(checkpoint)) } else { Err(torn()) }
    }

    /// Removes the checkpoint of a folder, and an unfinished one of a killed run.
    ///
    /// # Errors
    /// It cannot be removed.
    pub fn remove(dir: &Path) -> io::Result<()> {
        let unfinished = dir.join(format!("{NAME}{UNFINISHED}"));
        [Checkpoint::path(dir), unfinished].iter().try_for_each(|path| match fs::remove_file(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            removed => removed.map_err(|error| at(path, error)),
        })
    }
}

/// Has the names in a folder safe on the disk: those of the tables that a checkpoint is about, and its own.
fn sync_folder(dir: &Path) -> io::Result<()> {
    // Elsewhere folders cannot be opened, and names are safe with their files.
    if cfg!(unix) { fs::File::open(dir)?.sync_all() } else { Ok(()) }
}

fn digest(bytes: &[u8]) -> [u8; DIGEST] {
    Sha256::digest(bytes).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checkpoint(run: &[u8]) -> Checkpoint {
        let origin = CheckpointOrigin { version: "1".into(), deck: "a".into(), ..CheckpointOrigin::default() };
        Checkpoint { origin, run: run.to_vec(), ..Checkpoint::default() }
    }

    #[test]
    fn a_checkpoint_is_whole_or_refused() {
        let dir = tempfile::tempdir().unwrap();
        assert!(Checkpoint::read(dir.path()).unwrap().is_none());
        checkpoint(b"first").write(dir.path()).unwrap();
        checkpoint(b"second").write(dir.path()).unwrap();
        let back = Checkpoint::read(dir.path()).unwrap().unwrap();
        assert_eq!((back.run.as_slice(), back.origin.version.as_str()), (&b"second"[..], "1"));
        let whole = fs::read(Checkpoint::path(dir.path())).unwrap();
        for place in 0..whole.len() {
            // Cut short, and a bit turned.
            let mut turned = whole.clone();
            turned[place] ^= 4;
            for spoiled in [&whole[..place], &turned] {
                fs::write(Checkpoint::path(dir.path()), spoiled).unwrap();
                assert!(Checkpoint::read(dir.path()).is_err(), "{place}");
            }
        }
    }

    #[test]
    fn what_differs_is_named() {
        let was = checkpoint(b"").origin;
        assert_eq!(was.difference(&was), None);
        let differs = |change: &dyn Fn(&mut CheckpointOrigin)| {
            let mut now = was.clone();
            change(&mut now);
            was.difference(&now).unwrap()
        };
        assert!(differs(&|now| now.version = "2".into()).contains("rdsolve 1 has written it, and this is 2"));
        assert!(differs(&|now| now.deck = "b".into()).contains("the deck has changed"));
        assert!(differs(&|now| now.sets = vec!["a=1".into()]).contains("its --set are none, and now `a=1`"));
        assert!(differs(&|now| now.files = vec![("m.msh".into(), "0".into())]).contains("`m.msh` has changed"));
        assert!(differs(&|now| now.numbers = "x".into()).contains("collects something else"));
        assert!(differs(&|now| now.mesh_error = true).contains("without --mesh-error"));
        assert!(differs(&|now| now.end_time = 2.0).contains("to `end_time` = 0, which it has not come to"));
        let over = CheckpointOrigin { end_time: 1.0, is_over: true, ..was.clone() };
        let to = |end_time: f64| over.difference(&CheckpointOrigin { end_time, ..was.clone() });
        assert_eq!((to(2.0), to(1.0)), (None, None));
        assert!(to(0.5).unwrap().contains("to `end_time` = 1"));
    }
}
