//! run.log: the events of a run in plain lines. It may hold timings, which the tables may not: those are the same bytes whenever
//! the deck is run again.

use super::disk::{at, create};
use base::diagnostic::plain;
use base::names::{instant, short};
use base::snapshot::keep;
use base::text_file::open_regular;
use solve::{Broken, Frame, Observer};
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The name of the log in the output folder.
pub const NAME: &str = "run.log";

/// The number of lines of one kind after which steps are only counted.
const MOST_LINES: usize = 20;

/// The log of a run. Its lines reach the file at once: they are few, and the last ones matter when a run dies.
pub struct Log {
    path: PathBuf,
    /// `None` where nobody reads the log.
    file: Option<File>,
    /// The number of negative pivots and the increment of the load in the last step of a path.
    path_before: Option<(usize, f64)>,
    cut: Events,
    passed: Events,
    broken: Events,
}

keep!(Log { path_before, cut, passed, broken } without { path, file });

/// Lines of one kind.
#[derive(Default)]
struct Events {
    /// The number of steps with separate lines, and the number of later steps.
    said: usize,
    more: usize,
    /// The cutbacks of those after them.
    cutbacks: usize,
}

keep!(Events { said, more, cutbacks });

impl Events {
    /// Counts a step; true if it gets a separate line.
    fn count(&mut self, cutbacks: usize) -> bool {
        let tells = self.said < MOST_LINES;
        match tells {
            true => self.said += 1,
            false => (self.more, self.cutbacks) = (self.more + 1, self.cutbacks + cutbacks),
        }
        tells
    }
}

impl Log {
    /// Opens a new log or, with `resume`, the one that is there, to go on with it. The folder is made where there is none.
    ///
    /// # Errors
    /// The file cannot be opened; the error names it.
    pub fn open(dir: &Path, resume: bool) -> io::Result<Log> {
        let path = dir.join(NAME);
        let go_on = || {
            // A pipe of this name would wait for a reader for ever.
            if path.exists() {
                open_regular(&path).map(drop)?
            }
            OpenOptions::new().create(true).append(true).open(&path)
        };
        let open = |()| if resume { go_on() } else { create(&path) };
        let file = std::fs::create_dir_all(dir).and_then(open).map_err(|e| at(&path, e))?;
        Ok(Log { path, file: Some(file), ..Log::unread() })
    }

    /// A log that nobody reads, without file.
    pub fn unread() -> Log {
        let [cut, passed, broken] = [(); 3].map(|()| Events::default());
        Log { path: PathBuf::new(), file: None, path_before: None, cut, passed, broken }
    }

    /// Writes one or more lines; the last may do without its line break.
    ///
    /// # Errors
    /// The file cannot be written; the error names it.
    pub fn say(&mut self, text: &str) -> io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let text = format!("{}\n", plain(text.trim_end()));
        file.write_all(text.as_bytes()).map_err(|e| at(&self.path, e))
    }

    /// Writes a warning about the deck or its results.
    ///
    /// # Errors
    /// The file cannot be written; the error names it.
    pub fn warn(&mut self, message: &str) -> io::Result<()> {
        self.say(&format!("warning: {message}"))
    }
}

impl Observer for Log {
    /// Notes steps with cutbacks, failures, and limit and bifurcation points of a path.
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        self.see_path(frame)?;
        self.see_broken(frame)?;
        if frame.effort.cuts == 0 || !self.cut.count(frame.effort.cuts) {
            return Ok(());
        }
        let cutbacks =
            if frame.effort.cuts == 1 { "1 cutback".into() } else { format!("{} cutbacks", frame.effort.cuts) };
        let (step, time, dt) = (frame.step, instant(frame.state.time), instant(frame.dt));
        self.say(&format!("step {step} to t = {time}: {cutbacks}, accepted with dt = {dt}"))
    }
}

impl Log {
    /// Notes limit points and bifurcations: an eigenvalue of the matrix changes its sign there, and at a limit point the load
    /// turns, which may show a step later.
    fn see_path(&mut self, frame: &Frame) -> io::Result<()> {
        let Some(now) = frame.negative_pivots else { return Ok(()) };
        let (before, dt) = self.path_before.replace((now, frame.dt)).unwrap_or((now, frame.dt));
        let what = match (dt * frame.dt < 0.0, now == before) {
            (true, true) => "the load turns".to_string(),
            (true, false) => format!("the load turns, a limit point: negative pivots {before}, now {now}"),
            (false, false) => format!("a limit point or a bifurcation: negative pivots {before}, now {now}"),
            (false, true) => return Ok(()),
        };
        if !self.passed.count(0) {
            return Ok(());
        }
        let (step, time) = (frame.step, instant(frame.state.time));
        self.say(&format!("step {step} to t = {time}: {what}"))
    }

    /// Notes each failure with its place and cause.
    fn see_broken(&mut self, frame: &Frame) -> io::Result<()> {
        for Broken { what, reason, place } in &frame.derived.broken {
            if self.broken.count(0) {
                let (time, [x, y, z]) = (instant(frame.state.time), [place.x, place.y, place.z].map(short));
                self.say(&format!("t = {time}: {what} failed at [{x}, {y}, {z}]: {reason}"))?;
            }
        }
        Ok(())
    }

    /// At the end of a run, writes how many steps had no separate line, and restarts the count.
    ///
    /// # Errors
    /// The file cannot be written; the error names it.
    pub fn sum_up(&mut self) -> io::Result<()> {
        let [cut, passed, broken] = [&mut self.cut, &mut self.passed, &mut self.broken].map(std::mem::take);
        if cut.more > 0 {
            let steps = if cut.more == 1 { "step" } else { "steps" };
            let cutbacks = if cut.cutbacks == 1 { "cutback" } else { "cutbacks" };
            self.say(&format!("and {} more {steps} with {} {cutbacks}", cut.more, cut.cutbacks))?;
        }
        if passed.more > 0 {
            self.say(&format!("and {} more limit points or bifurcations", passed.more))?;
        }
        if broken.more > 0 {
            self.say(&format!("and {} more elements or links failed", broken.more))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_the_first_lines_steps_are_counted() {
        let mut events = Events::default();
        let said = (1..=50).filter(|&cutbacks| events.count(cutbacks)).count();
        assert_eq!((said, events.more, events.cutbacks), (20, 30, (21..=50).sum()));
    }

    #[test]
    fn a_log_is_continued_on_resume() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("new");
        for (resume, line) in [(false, "lost"), (false, "start\nplan\n"), (true, "resumed")] {
            Log::open(&folder, resume).unwrap().say(line).unwrap();
        }
        assert_eq!(std::fs::read_to_string(folder.join("run.log")).unwrap(), "start\nplan\nresumed\n");
    }
}
