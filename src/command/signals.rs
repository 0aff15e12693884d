//! Signals that request the end of a run, and the end of the process that started it.

use super::console::complain;
use super::exit::Exit;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// Lets interrupt, termination and the loss of the terminal raise a flag: the run then ends after the step in hand, with whole
/// files.
///
/// # Errors
/// The operating system refuses to have its signals caught.
pub fn stop_on_signals(flag: &Arc<AtomicBool>) -> io::Result<()> {
    // A second interrupt from the keyboard ends the program at once. A second termination does not, for schedulers send it to a
    // process and to its group, which is two at the same moment.
    let code = i32::from(Exit::Stopped as u8);
    signal_hook::flag::register_conditional_shutdown(signal_hook::consts::SIGINT, code, Arc::clone(flag))?;
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(flag))?;
    }
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGXCPU};
        if !is_ignored(SIGHUP) {
            signal_hook::flag::register(SIGHUP, Arc::clone(flag))?;
        }
        // At the soft limit on processor time (`ulimit -t`) some seconds are left, enough to end with whole files.
        signal_hook::flag::register(SIGXCPU, Arc::clone(flag))?;
    }
    Ok(())
}

/// Ends the process with a message and the exit code of a stopped run, while a deck is read and planned and there are no results to
/// complete. Dropping it passes signals to [`stop_on_signals`].
pub struct EndAtOnce {
    #[cfg(unix)]
    handle: Option<signal_hook::iterator::Handle>,
    /// The folder into which files are being written.
    written: Arc<OnceLock<PathBuf>>,
}

impl EndAtOnce {
    /// Begins to wait for signals; where the system does not let them be caught they end the process as they always do.
    pub fn on_signals() -> EndAtOnce {
        let written = Arc::<OnceLock<PathBuf>>::default();
        #[cfg(unix)]
        {
            use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXCPU};
            let caught = [SIGINT, SIGTERM, SIGXCPU].into_iter().chain((!is_ignored(SIGHUP)).then_some(SIGHUP));
            let signals = signal_hook::iterator::Signals::new(caught).ok();
            let handle = signals.as_ref().map(signal_hook::iterator::Signals::handle);
            if let Some(mut signals) = signals {
                let written = Arc::clone(&written);
                std::thread::spawn(move || {
                    if signals.forever().next().is_some() {
                        complain(&match written.get() {
                            None => "stopped by a signal before the first step; nothing has been written".to_owned(),
                            Some(folder) => format!(
                                "stopped by a signal; files in `{}` may be missing or cut short: run the same command again",
                                folder.display()
                            ),
                        });
                        std::process::exit(i32::from(Exit::Stopped as u8));
                    }
                });
            }
            EndAtOnce { handle, written }
        }
        #[cfg(not(unix))]
        EndAtOnce { written }
    }

    /// Notes that files in a folder are not whole from now on.
    pub fn writes_into(&self, folder: &Path) {
        self.written.get_or_init(|| folder.to_owned());
    }
}

#[cfg(unix)]
impl Drop for EndAtOnce {
    fn drop(&mut self) {
        self.handle.iter().for_each(signal_hook::iterator::Handle::close);
    }
}

/// Makes a file that reaches a limit (`ulimit -f`) an error of writing instead of the end of the process.
pub fn survive_file_limits() {
    #[cfg(unix)]
    {
        // A caught signal has no other effect; a signal that cannot be caught ends the process as before.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
    }
}

/// Gives insufficient memory a separate exit code. After a failed allocation, the standard library prints a message and aborts. A panic,
/// which may abort as well, is a fault of the program and keeps its signal.
pub fn name_want_of_memory() {
    #[cfg(unix)]
    {
        let is_memory = Arc::new(AtomicBool::new(true));
        let code = i32::from(Exit::TooLittleMemory as u8);
        let flag = Arc::clone(&is_memory);
        if signal_hook::flag::register_conditional_shutdown(signal_hook::consts::SIGABRT, code, flag).is_ok() {
            let shown = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |panic| {
                is_memory.store(false, Ordering::Relaxed);
                shown(panic);
            }));
        }
    }
}

/// Whether whoever started the process has asked for a signal to be ignored, as `nohup` does. If the system does not report it, the signal
/// counts as ignored, so that an ignored signal stays ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Ends the process when its standard input ends: nobody is left who wants the run of a study that is gone.
pub fn end_with_input() {
    let mut input = io::stdin().lock();
    let mut bytes = [0; 64];
    // Zero bytes are the end, and so is an input that cannot be read.
    while input.read(&mut bytes).is_ok_and(|count| count > 0) {}
    std::process::exit(i32::from(Exit::Stopped as u8));
}
