//! A run of a study is a separate process, timed from start to exit.

use results::at;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// The time between two looks for a signal while a run goes on.
const GLANCE: Duration = Duration::from_millis(50);

/// The exit code of a run that a signal has ended.
const STOPPED: i32 = 75;

/// The variable of the environment that ends a run when its standard input closes, which happens at the end of the study however it ended.
pub const LIFELINE: &str = "RDSOLVE_LIFELINE";

/// The variable of the environment with the level of instructions.
pub const INSTRUCTIONS: &str = "RDSOLVE_INSTRUCTIONS";

/// A process that has ended.
pub struct Ended {
    /// The exit code; `None` where a signal has ended it.
    pub code: Option<i32>,
    /// The seconds from start to exit.
    pub process_s: f64,
    /// The text that it has written to standard error.
    pub said: String,
}

/// The program and the deck that it runs.
pub struct Program {
    /// The path of the program.
    pub path: PathBuf,
    /// The path of the deck.
    pub deck: PathBuf,
    /// The number of threads of each run.
    pub threads: usize,
    /// The level of instructions of each run; empty where the program chooses.
    pub instructions: &'static str,
}

impl Program {
    /// Runs the deck with overrides into a folder. It returns `None` where a signal has stopped it; the process has then ended.
    ///
    /// # Errors
    /// The process cannot be started.
    pub fn run(&self, sets: &[String], folder: &Path, stop: &AtomicBool) -> io::Result<Option<Ended>> {
        let mut command = Command::new(&self.path);
        command.arg("run").arg(&self.deck).arg("--output").arg(folder);
        command.args(["--quiet", "--overwrite", "--threads"]).arg(self.threads.to_string());
        sets.iter().for_each(|set| {
            command.arg("--set").arg(set);
        });
        command.env(INSTRUCTIONS, self.instructions);
        command.env(LIFELINE, "1").stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let began = Instant::now();
        let mut child = command.spawn().map_err(|error| at(&self.path, error))?;
        // Waiting for the process would close its input, which would end it.
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
        // At a terminal the run gets the signal as well, and may end before the flag is seen.
        if stopped || stop.load(Ordering::Relaxed) || status.code() == Some(STOPPED) {
            return Ok(None);
        }
        Ok(Some(Ended { code: status.code(), process_s: elapsed.as_secs_f64(), said }))
    }
}

/// The first error in the standard error of a process, without the lines that explain it.
pub fn first_error(said: &str) -> Option<String> {
    said.lines().find_map(|line| line.strip_prefix("error: ")).map(str::to_owned)
}
