//! `--resume`: what a run goes on from.

use super::console::{complain, say};
use super::exit::Exit;
use super::folder::require_free;
use super::load::Loaded;
use super::version::VERSION;
use crate::output::checkpoint::{Checkpoint, CheckpointOrigin};
use crate::output::{holds_run, log, result_json};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Where a run begins.
pub enum Begins {
    /// At t = 0.
    Anew,
    /// At a checkpoint.
    At(Box<Checkpoint>),
}

impl Begins {
    /// The checkpoint, if there is one.
    pub fn checkpoint(self) -> Option<Checkpoint> {
        match self {
            Begins::Anew => None,
            Begins::At(checkpoint) => Some(*checkpoint),
        }
    }
}

/// What checkpoints of this deck belong to.
pub fn checkpoint_origin(loaded: &Loaded, mesh_error: bool) -> CheckpointOrigin {
    let hex = |digest: &[u8]| digest.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let origin = &loaded.model.origin;
    let mesh = origin.mesh.iter().map(|mesh| (mesh.path.clone(), hex(&mesh.digest)));
    let records = origin.records.iter().map(|record| (record.path.clone(), hex(&record.digest)));
    CheckpointOrigin {
        version: VERSION.to_owned(),
        deck: hex(&Sha256::digest(&loaded.source.text)),
        sets: loaded.sets.clone(),
        files: mesh.chain(records).collect(),
        mesh_error,
    }
}

/// Finds the checkpoint in a folder from which a run of this origin, and of a deck with this hash, is to go on.
///
/// # Errors
/// [`Exit::Usage`] where the folder holds something else; [`Exit::Done`] where the run has come to its end, or the code with which it did;
/// [`Exit::InputOutput`] where it cannot be read. The reason has been shown.
pub fn resume(folder: &Path, origin: &CheckpointOrigin, hash: &str) -> Result<Begins, Exit> {
    let place = folder.display();
    let checkpoint = Checkpoint::read(folder).map_err(|error| {
        complain(&format!("cannot resume: {error}"));
        say("  help: --overwrite in place of --resume runs the deck from the beginning");
        Exit::InputOutput
    })?;
    if let Some(checkpoint) = checkpoint {
        if let Some(difference) = checkpoint.origin.difference(origin) {
            complain(&format!("the checkpoint in `{place}` is not of this run: {difference}"));
            say("  help: --overwrite in place of --resume runs the deck from the beginning; -o DIR writes elsewhere");
            return Err(Exit::Usage);
        }
        return Ok(Begins::At(Box::new(checkpoint)));
    }
    if folder.join(result_json::NAME).exists() {
        complain(&format!("there is nothing to resume in `{place}`: the run there has come to its end"));
        say("  help: --overwrite in place of --resume runs the deck again; -o DIR writes elsewhere");
        return Err(Exit::Usage);
    }
    let log = std::fs::read_to_string(folder.join(log::NAME)).unwrap_or_default();
    if !log.is_empty() && !log.lines().any(|line| line.strip_prefix("deck hash ") == Some(hash)) {
        complain(&format!("the results in `{place}` are those of another deck, or of other --set"));
        say("  help: --overwrite in place of --resume replaces them; -o DIR writes elsewhere");
        return Err(Exit::Usage);
    }
    if log.is_empty() {
        require_free(folder, holds_run(folder).unwrap_or(false))?;
    }
    say(&format!("there is no checkpoint in `{place}` yet: the run begins at t = 0"));
    Ok(Begins::Anew)
}
