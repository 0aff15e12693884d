//! `--resume`: the state from which a run continues.

use super::console::{complain, say};
use super::exit::Exit;
use super::folder::require_free;
use super::load::Loaded;
use super::version::{VERSION, instructions};
use base::text_file::read_text;
use results::checkpoint::{Checkpoint, CheckpointOrigin};
use results::{FolderLock, holds_run, log, result_json};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Entries of a deck that a checkpoint does not depend on; the end of the run is compared separately.
const FREE: [[&str; 2]; 2] = [["analysis", "end_time"], ["output", "checkpoint"]];

/// The digest of the text of a deck on which a checkpoint depends.
pub fn deck_digest(text: &str) -> String {
    hex(&Sha256::digest(what_must_stay(text)))
}

fn hex(digest: &[u8]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The origin of checkpoints of this deck; `deck` is its [`deck_digest`].
pub fn checkpoint_origin(loaded: &Loaded, deck: String, mesh_error: bool) -> CheckpointOrigin {
    let origin = &loaded.model.origin;
    // As the deck names them, wherever it is run from.
    let folder = Path::new(&loaded.source.path).parent().unwrap_or(Path::new(""));
    let name = |path: &str| Path::new(path).strip_prefix(folder).unwrap_or(Path::new(path)).display().to_string();
    let mesh = origin.mesh.iter().map(|mesh| (name(&mesh.path), hex(&mesh.digest)));
    let records = origin.records.iter().map(|record| (name(&record.path), hex(&record.digest)));
    let is_free = |set: &&String| {
        set.split('=').next().is_some_and(|key| FREE.map(|of| of.join(".")).contains(&key.trim().to_owned()))
    };
    CheckpointOrigin {
        version: VERSION.to_owned(),
        deck,
        sets: loaded.sets.iter().filter(|set| !is_free(set)).cloned().collect(),
        end_time: loaded.models().last().map_or(0.0, |model| model.analysis.end_time),
        is_over: false,
        files: mesh.chain(records).collect(),
        mesh_error,
        numbers: String::new(),
        instructions: instructions(),
    }
}

/// The text of a deck on which a checkpoint depends: without comments and spaces between words.
fn what_must_stay(text: &str) -> String {
    let Ok(mut deck) = text.parse::<toml::Table>() else { return text.to_owned() };
    for [table, key] in FREE {
        if let Some(table) = deck.get_mut(table).and_then(toml::Value::as_table_mut) {
            table.remove(key);
        }
    }
    deck.to_string()
}

/// Reads the checkpoint of a folder for a run of this origin; `None` where there is none. It is read before pilot runs, which may take long.
///
/// # Errors
/// [`Exit::Usage`] if the checkpoint is of another run, [`Exit::InputOutput`] if it cannot be read. The reason has been shown.
pub fn checkpoint_in(folder: &Path, origin: &CheckpointOrigin) -> Result<Option<Checkpoint>, Exit> {
    let checkpoint = Checkpoint::read(folder).map_err(|error| {
        complain(&format!("cannot resume: {error}"));
        say("  help: --overwrite in place of --resume runs the deck from the beginning");
        Exit::InputOutput
    })?;
    if let Some(difference) = checkpoint.as_ref().and_then(|checkpoint| checkpoint.origin.difference(origin)) {
        complain(&format!("the checkpoint in `{}` is not of this run: {difference}", folder.display()));
        say("  help: --overwrite in place of --resume runs the deck from the beginning; -o DIR writes elsewhere");
        return Err(Exit::Usage);
    }
    Ok(checkpoint)
}

/// The checkpoint where a run of this origin goes on, and of a deck with this hash; `None` where it begins at t = 0.
///
/// # Errors
/// [`Exit::Usage`] if the folder holds something else. A finished run returns its exit code, including [`Exit::Done`]. The reason has been
/// shown.
pub fn resume(
    folder: &Path,
    checkpoint: Option<Checkpoint>,
    (origin, hash): (&CheckpointOrigin, &str),
) -> Result<Option<Checkpoint>, Exit> {
    let place = folder.display();
    if let Some(checkpoint) = checkpoint {
        let (then, now) = (&checkpoint.origin.instructions, &origin.instructions);
        if then != now {
            say(&format!("note: the checkpoint is of a run with the instructions {then}, which goes on with {now}"));
            say("  last digits will differ from those of a run that was never stopped");
        }
        // A run that is over may still have to write its result.
        let is_done = checkpoint.origin.is_over && checkpoint.origin.end_time == origin.end_time;
        if !is_done || !folder.join(result_json::NAME).exists() {
            return Ok(Some(checkpoint));
        }
    }
    if let Some(ended) = ended(folder, (hash, origin)) {
        return Err(ended);
    }
    let log = read_text(folder.join(log::NAME)).unwrap_or_default();
    if !log.is_empty() && !log.lines().any(|line| line.strip_prefix("deck hash ") == Some(hash)) {
        complain(&format!("the results in `{place}` are those of another deck, or of other --set"));
        say("  help: --overwrite in place of --resume replaces them; -o DIR writes elsewhere");
        return Err(Exit::Usage);
    }
    if log.is_empty() {
        require_free(folder, holds_run(folder).unwrap_or(false))?;
    }
    say(&format!("there is no checkpoint in `{place}` yet: the run begins at t = 0"));
    Ok(None)
}

/// Repeats the last message of a finished run; `None` if there is no result.
fn ended(folder: &Path, (hash, origin): (&str, &CheckpointOrigin)) -> Option<Exit> {
    let (place, text) = (folder.display(), read_text(folder.join(result_json::NAME)).ok()?);
    let result: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    let said = |key: &str| result[key].as_str().unwrap_or_default().to_owned();
    if said("deck_hash") != hash || said("version") != origin.version {
        complain(&format!("the results in `{place}` are those of another deck, other --set or another version"));
        say("  help: --overwrite in place of --resume replaces them; -o DIR writes elsewhere");
        return Some(Exit::Usage);
    }
    let exit = match said("status").as_str() {
        "done" => Exit::Done,
        "not-converged" => Exit::NotConverged,
        "expectation-missed" => Exit::CheckFailed,
        "too-little-memory" => Exit::TooLittleMemory,
        // A run that stops before the end of its first step has no checkpoint.
        "stopped" if result["counts"]["steps"] == 0 => return None,
        _ => {
            complain(&format!("the run in `{place}` was stopped, and its checkpoint is gone"));
            say("  help: --overwrite in place of --resume runs the deck from the beginning");
            return Some(Exit::Usage);
        }
    };
    // If a run is killed between its result and its end, its lock stays.
    drop(FolderLock::take(folder));
    say(&format!("there is nothing to resume in `{place}`: the run there has come to its end"));
    if exit != Exit::Done {
        complain(&said("reason"));
    }
    Some(exit)
}
