//! The memory of a run, forecast before its first step.

use super::console::{complain, show};
use super::exit::Exit;
use super::load::{Loaded, too_large};
use base::diagnostic::Diagnostic;
use base::names::amount;
use linear::{TooLarge, available_memory};
use results::result_json::process_bytes;
use solve::Run;

/// Forecasts are within this factor of the peak of a run.
const WITHIN: f64 = 1.3;
/// Bytes below which there is no forecast: the program itself occupies a good part of them.
const SMALL: f64 = 64e6;
/// Nodes below which later matrices are too small to matter.
const FEW_NODES: usize = 500;

/// A forecast of the memory of a run, from the memory of the process so far.
pub struct Forecast {
    /// Resident bytes at the end of planning.
    planned: f64,
    /// Bytes of data at that time, touched or not.
    data: f64,
    /// The parts of the stage with the largest memory, each with its name.
    parts: Vec<(&'static str, f64)>,
    /// Bytes that this stage has not taken yet.
    ahead: f64,
}

impl Forecast {
    /// Begins at the end of planning; `None` if the memory of the process is unknown.
    pub fn begin() -> Option<Forecast> {
        let (planned, data) = (process_bytes("VmRSS:")?, process_bytes("VmData:")?);
        Some(Forecast { planned, data, parts: Vec::new(), ahead: 0.0 })
    }

    /// Includes a finished run while its memory and all that remains beside it is in use.
    ///
    /// # Errors
    /// The memory does not hold a matrix that the run will need.
    pub fn take(&mut self, run: &Run, nodes: usize) -> Result<(), TooLarge> {
        let data = || process_bytes("VmData:").unwrap_or(self.data);
        let made = data();
        let stats = run.solver().stats();
        let in_memory = stats.numbers - if stats.in_file { stats.nonzeros } else { 0 };
        let factor = (size_of::<f64>() * in_memory) as f64;
        let later = if nodes < FEW_NODES { Vec::new() } else { run.matrices_ahead()? };
        let matrices = run.copies_ahead() * (data() - made).max(0.0);
        drop(later);
        let states = run.state_bytes();
        let parts = vec![
            ("the model and its plan", self.planned),
            ("the matrix with its factor", factor),
            ("places of elements in the matrix, forces and the scheme", (made - self.data - factor).max(0.0)),
            ("matrices for contact, modes or responses", matrices),
            ("the state with its history", states),
        ];
        if sum(&parts) > sum(&self.parts) {
            (self.parts, self.ahead) = (parts, matrices + states);
        }
        Ok(())
    }

    /// The whole with its parts, the largest first.
    pub fn in_words(&self) -> String {
        let whole = sum(&self.parts);
        if whole < SMALL {
            return format!("less than {} at the peak of a run", amount(SMALL));
        }
        let mut parts = self.parts.clone();
        parts.retain(|(_, bytes)| *bytes > 0.01 * whole);
        parts.sort_by(|a, b| b.1.total_cmp(&a.1));
        let parts: Vec<String> = parts.iter().map(|(name, bytes)| format!("{name} {}", amount(*bytes))).collect();
        format!("about {} at the peak of a run: {}", amount(whole), parts.join(", "))
    }

    /// Compares the forecast with the memory still available to the process. If the memory is too little even for a forecast reduced by its
    /// error, the run is refused; a warning is returned.
    ///
    /// # Errors
    /// The memory will end before the run does; the reason has been shown.
    pub fn judge(&self) -> Result<Option<String>, Exit> {
        let (Some(available), Some(now)) = (available_memory(), process_bytes("VmRSS:")) else { return Ok(None) };
        // Only an allocation shows what a limit on addresses grants; the memory is returned untouched.
        let grants = |bytes: f64| Vec::<u8>::new().try_reserve_exact(bytes as usize).is_ok();
        self.weigh(now + available, &grants).map_err(|said| {
            complain(&said);
            Exit::TooLittleMemory
        })
    }

    /// Compares the forecast with the available bytes; `grants` says whether a limit on addresses allows so many more.
    fn weigh(&self, free: f64, grants: &dyn Fn(f64) -> bool) -> Result<Option<String>, String> {
        let whole = sum(&self.parts);
        let fits = |part: f64| whole * part <= free && grants(self.ahead * part);
        if whole < SMALL || fits(1.0) {
            return Ok(None);
        }
        let limit = match whole <= free {
            true => "a limit of this process is lower (`ulimit -v`)".to_owned(),
            false => format!("it can have {}", amount(free)),
        };
        let wanted = amount(WITHIN * whole);
        let said = format!(
            "the run needs about {} of memory, and {limit}. Run it where it can have {wanted}, or take a coarser mesh",
            amount(whole)
        );
        if fits(1.0 / WITHIN) { Ok(Some(said + "; otherwise it may end without results")) } else { Err(said) }
    }
}

fn sum(parts: &[(&'static str, f64)]) -> f64 {
    parts.iter().map(|(_, bytes)| bytes).sum()
}

/// Forecasts the memory of a finished run, and refuses a run for which there is too little; a warning is returned, and shown unless
/// `quiet`.
///
/// # Errors
/// There is too little memory; the reason has been shown.
pub fn require_memory(
    forecast: Option<Forecast>,
    run: &Run,
    (loaded, quiet): (&Loaded, bool),
) -> Result<Option<Diagnostic>, Exit> {
    let Some(mut forecast) = forecast else { return Ok(None) };
    forecast.take(run, loaded.model.nodes.len()).map_err(too_large)?;
    let warning = forecast.judge()?.map(Diagnostic::warning);
    if !quiet {
        show(warning.as_slice(), &loaded.source);
    }
    Ok(warning)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1000 MB, 300 of them still to come, against more memory, less by less than the error of a forecast, and less by more.
    #[test]
    fn too_little_memory_is_warned_of_or_refused() {
        let forecast = Forecast { planned: 7e8, data: 0.0, parts: vec![("all", 1e9)], ahead: 3e8 };
        let with = |free: f64, granted: f64| forecast.weigh(free, &|bytes| bytes <= granted);
        assert_eq!(with(1.1e9, 3e8), Ok(None));
        let warning = with(0.9e9, 3e8).unwrap().unwrap();
        assert!(
            warning.starts_with(
                "the run needs about 1.0 GB of memory, and it can have 900 MB. Run it where it can have 1.3 GB"
            ),
            "{warning}"
        );
        assert!(with(0.7e9, 3e8).is_err());
        assert!(with(1.1e9, 2.5e8).unwrap().unwrap().contains("`ulimit -v`"));
        assert!(with(1.1e9, 2e8).is_err());
        let small = Forecast { planned: 1e7, data: 0.0, parts: vec![("all", 1e7)], ahead: 0.0 };
        assert_eq!(small.weigh(1e6, &|_| true), Ok(None));
        assert_eq!(small.in_words(), "less than 64 MB at the peak of a run");
    }
}
