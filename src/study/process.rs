//! One run as a process of its own, timed from start to exit.

use crate::output::at;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// How often a signal is looked for while a run goes on.
const GLANCE: Duration = Duration::from_millis(50);

/// Exit code of a run that a signal has ended.
const STOPPED: i32 = 75;

/// Set in the environment of a run: it ends when its standard input does, which is when the study is gone, however it went.
pub const LIFELINE: &str = "RDSOLVE_LIFELINE";

/// A process that has ended.
pub struct Ended {
    /// `None`: by a signal.
    pub code: Option<i32>,
    /// Seconds from start to exit.
    pub process_s: f64,
    /// What it said on standard error.
    pub said: String,
}

/// How to run one deck.
pub struct Program {
    pub path: PathBuf,
    pub deck: PathBuf,
    pub threads: usize,
}

impl Program {
    /// Runs the deck with overrides into a folder; `None`: stopped by a signal, and the process has been ended.
    pub fn run(&self, sets: &[String], folder: &Path, stop: &AtomicBool) -> io::Result<Option<Ended>> {
        let mut command = Command::new(&self.path);
        command.arg("run").arg(&self.deck).arg("--output").arg(folder);
        command.args(["--quiet", "--overwrite", "--threads"]).arg(self.threads.to_string());
        sets.iter().for_each(|set| {
            command.arg("--set").arg(set);
        });
        command.env(LIFELINE, "1").stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let began = Instant::now();
        let mut child = command.spawn().map_err(|error| at(&self.path, error))?;
        // Waiting for the process would close it.
        let lifeline = child.stdin.take();
        let (sender, ended) = channel();
        let pipe = child.stderr.take();
        // The pipe closes when the process ends: its reader knows the moment without asking again and again.
        let reader = std::thread::spawn(move || {
            let mut said = Vec::new();
            let _ = pipe.map(|mut pipe| pipe.read_to_end(&mut said));
            let _ = sender.send(began.elapsed());
            String::from_utf8_lossy(&said).into_owned()
        });
        let mut stopped = false;
        let elapsed = loop {
            match ended.recv_timeout(GLANCE) {
                Ok(elapsed) => break elapsed,
                Err(RecvTimeoutError::Timeout) if stop.load(Ordering::Relaxed) && !stopped => {
                    stopped = true;
                    child.kill()?;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break began.elapsed(),
            }
        };
        let status = child.wait()?;
        drop(lifeline);
        let said = reader.join().unwrap_or_default();
        // One at a terminal gets the signal itself, and may be first.
        if stopped || stop.load(Ordering::Relaxed) || status.code() == Some(STOPPED) {
            return Ok(None);
        }
        Ok(Some(Ended { code: status.code(), process_s: elapsed.as_secs_f64(), said }))
    }
}

/// The first error of what a process said, in a line.
pub fn first_error(said: &str) -> Option<String> {
    said.lines().find_map(|line| line.strip_prefix("error: ")).map(str::to_owned)
}
