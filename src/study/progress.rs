//! The progress bar of a study on standard error: how much of the work is done, which setting runs, the time left.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// The number of positions of the bar.
const LENGTH: f64 = 1e4;

/// The progress bar of a study. When quiet or not on a terminal it shows nothing.
pub struct StudyProgress {
    bar: Option<ProgressBar>,
    work: f64,
    done: f64,
}

impl StudyProgress {
    /// A bar for all the work of a study, in any unit that is proportional to the time of a run.
    pub fn new(quiet: bool, work: f64) -> StudyProgress {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let style = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}  {eta} left");
            let bar = ProgressBar::with_draw_target(Some(LENGTH as u64), ProgressDrawTarget::stderr());
            // The time left goes on even while a long run says nothing.
            bar.enable_steady_tick(Duration::from_millis(500));
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        StudyProgress { bar, work, done: 0.0 }
    }

    /// Shows the current setting and the number of its repeat.
    pub fn show(&self, label: &str, repeat: usize, repeats: usize) {
        if let Some(bar) = &self.bar {
            bar.set_message(format!("{label}, {repeat} of {repeats}"));
        }
    }

    /// Adds work that is done.
    pub fn did(&mut self, work: f64) {
        self.done += work;
        if let Some(bar) = &self.bar {
            bar.set_position((LENGTH * self.done / self.work) as u64);
        }
    }

    /// Clears the line for the next message.
    pub fn finish(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}
