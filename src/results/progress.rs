//! The progress bar on standard error, for a person at a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use solve::{Frame, Observer};
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

/// The time between two pictures of the bar: a terminal that is written to at every step would cost more than the steps.
const PAUSE: Duration = Duration::from_millis(50);
/// The number of positions of the bar from start to end time.
const LENGTH: f64 = 1e4;

/// Shows simulated time, steps, iterations and the time left. When quiet or not on a terminal it shows nothing.
pub struct Progress {
    bar: Option<ProgressBar>,
    shown: Instant,
    iterations: usize,
    /// Cutbacks since the last accepted step.
    cutbacks: usize,
    /// The number of runs that have begun, when there is more than one: "run 2, ".
    run: String,
    runs: usize,
}

impl Progress {
    /// A bar at its beginning, unless `quiet`.
    pub fn new(quiet: bool) -> Progress {
        let bar = (!quiet && io::stderr().is_terminal()).then(|| {
            let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}  {eta} left");
            let bar = ProgressBar::with_draw_target(Some(LENGTH as u64), ProgressDrawTarget::stderr());
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Progress { bar, shown: Instant::now(), iterations: 0, cutbacks: 0, run: String::new(), runs: 1 }
    }

    /// Says above the bar why another run begins, and counts it from here on. Without a bar it says nothing.
    pub fn begin_again(&mut self, why: &str) {
        self.runs += 1;
        self.run = format!("run {}, ", self.runs);
        if let Some(bar) = &self.bar {
            bar.println(format!("note: {why}"));
            bar.reset();
        }
    }

    /// Clears the line for the next message.
    pub fn finish(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

impl Observer for Progress {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        let Some(bar) = &self.bar else { return Ok(()) };
        self.iterations += frame.effort.iterations;
        self.cutbacks = 0;
        if self.shown.elapsed() < PAUSE {
            return Ok(());
        }
        self.shown = Instant::now();
        let (time, end) = (frame.state.time, frame.model.analysis.end_time);
        bar.set_message(format!("{}t = {time:.4e}  step {}  {} iterations", self.run, frame.step, self.iterations));
        bar.set_position((LENGTH * time / end) as u64);
        Ok(())
    }

    fn on_cutback(&mut self, time: f64) {
        self.cutbacks += 1;
        if let Some(bar) = &self.bar {
            let times = if self.cutbacks == 1 { "time" } else { "times" };
            bar.set_message(format!("{}t = {time:.4e}  step shortened {} {times}", self.run, self.cutbacks));
        }
    }
}
