//! The modes of a run as lines for the terminal and the log.

use base::names::{joined, to_digits};
use base::quantities::{Unit, UnitSystem};
use model::Model;
use solve::modes::{EigenMode, ModeKind, Modes, Whirl};
use std::fmt::Write;

/// Modes that are listed; modes.csv has all.
const LISTED: usize = 20;
/// Digits of frequencies and masses.
const DIGITS: usize = 5;

/// A table of the modes: frequency, period, damping and effective mass, or load factor; and the critical speeds.
pub fn lines(modes: &Modes, model: &Model) -> Vec<String> {
    if modes.list.is_empty() || modes.response.is_some() {
        return Vec::new();
    }
    let units = model.output.units.as_deref().and_then(UnitSystem::find);
    let mut lines = match modes.kind {
        ModeKind::Buckling => of_buckling(&modes.list),
        ModeKind::Natural if model.analysis.damps_modes() => of_damped(&modes.list, units),
        ModeKind::Natural => of_natural(modes, units),
    };
    if let Some(more) = modes.list.len().checked_sub(LISTED).filter(|more| *more > 0) {
        lines.push(format!("  and {more} more in modes.csv"));
    }
    lines.extend(of_rigid(modes));
    if !modes.speeds.is_empty() {
        lines.extend(of_critical_speeds(modes, units));
    }
    lines
}

/// A line about natural modes of frequency zero that nothing resists.
fn of_rigid(modes: &Modes) -> Option<String> {
    /// Roots have eleven digits.
    const ROUNDING: f64 = 1e-9;
    let size = |mode: &EigenMode| mode.root[0].hypot(mode.root[1]);
    let highest = modes.list.iter().map(size).fold(0.0, f64::max);
    let is_free = |mode: &EigenMode| mode.factor.is_none() && mode.lost.is_none() && size(mode) <= ROUNDING * highest;
    let free: Vec<String> =
        (1..).zip(&modes.list).filter(|(_, mode)| is_free(mode)).map(|(number, _)| number.to_string()).collect();
    let free: Vec<&str> = free.iter().map(String::as_str).collect();
    (!free.is_empty()).then(|| {
        let of = if free.len() == 1 { "mode" } else { "modes" };
        format!("  {of} {}: a free motion, as a rigid body or a mechanism, without stiffness", joined(&free))
    })
}

/// A heading with its unit, where the deck has units.
fn heading(word: &str, unit: Unit, units: Option<&UnitSystem>) -> String {
    units.map_or_else(|| word.to_owned(), |units| format!("{word} ({})", unit.text(Some(units))))
}

fn headings(units: Option<&UnitSystem>) -> [String; 2] {
    [heading("frequency", Unit::Frequency, units), heading("period", Unit::Time, units)]
}

/// Rows of cells, right-aligned under their headings.
fn table(headings: &[&str], rows: Vec<Vec<String>>) -> Vec<String> {
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.chain([headings[column].chars().count()]).max().unwrap_or_default()
    };
    let widths: Vec<usize> = (0..headings.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        cells.iter().zip(&widths).fold(String::new(), |mut line, (cell, width)| {
            // A String takes every character.
            let _ = write!(line, "  {cell:>width$}");
            line
        })
    };
    let head = line(headings.to_vec());
    [head].into_iter().chain(rows.iter().map(|row| line(row.iter().map(String::as_str).collect()))).collect()
}

fn digits(value: f64) -> String {
    to_digits(value, DIGITS)
}

/// A damping ratio in percent; nothing of none, zero of rounding.
fn percent(ratio: Option<f64>) -> String {
    /// Roots have eleven digits.
    const ROUNDING: f64 = 1e-9;
    let cell = |ratio: f64| format!("{} %", to_digits(100.0 * if ratio.abs() < ROUNDING { 0.0 } else { ratio }, 3));
    ratio.map_or(String::new(), cell)
}

fn period(mode: &EigenMode) -> String {
    if mode.frequency() > 0.0 { digits(1.0 / mode.frequency()) } else { String::new() }
}

fn of_natural(modes: &Modes, units: Option<&UnitSystem>) -> Vec<String> {
    let share = |mass: f64, axis: usize| match modes.masses[axis] > 0.0 {
        true => format!("{:.1} %", 100.0 * mass / modes.masses[axis] + 0.0),
        false => String::new(),
    };
    let row = |(number, mode): (usize, &EigenMode)| {
        let own = [number.to_string(), digits(mode.frequency()), period(mode)];
        own.into_iter().chain((0..3).map(|axis| share(mode.effective_mass(axis), axis))).collect()
    };
    let mut rows: Vec<Vec<String>> = (1..).zip(&modes.list).take(LISTED).map(row).collect();
    let sum = |axis: usize| share(modes.list.iter().map(|mode| mode.effective_mass(axis)).sum(), axis);
    rows.push(["sum".to_owned(), String::new(), String::new()].into_iter().chain((0..3).map(sum)).collect());
    let [frequency, period] = headings(units);
    table(&["mode", &frequency, &period, "mass x", "mass y", "mass z"], rows)
}

fn of_damped(list: &[EigenMode], units: Option<&UnitSystem>) -> Vec<String> {
    let spins = list.iter().any(|mode| mode.whirl.is_some());
    let row = |(number, mode): (usize, &EigenMode)| {
        let damping = percent(mode.damping_ratio());
        let own = [number.to_string(), digits(mode.frequency()), period(mode), damping];
        own.into_iter().chain(spins.then(|| whirl_in_words(mode.whirl))).collect()
    };
    let [frequency, period] = headings(units);
    let headings = ["mode", &frequency, &period, "damping", "whirl"];
    table(&headings[..if spins { 5 } else { 4 }], (1..).zip(list).take(LISTED).map(row).collect())
}

fn of_buckling(list: &[EigenMode]) -> Vec<String> {
    let row = |(number, mode): (usize, &EigenMode)| vec![number.to_string(), mode.factor.map_or(String::new(), digits)];
    table(&["mode", "load factor"], (1..).zip(list).take(LISTED).map(row).collect())
}

fn of_critical_speeds(modes: &Modes, units: Option<&UnitSystem>) -> Vec<String> {
    let range = [modes.speeds.first(), modes.speeds.last()].map(|at| at.map_or(0.0, |at| at.speed));
    if modes.critical_speeds.is_empty() {
        let unit = units.map_or_else(String::new, |units| format!(" {}", Unit::AngularVelocity.text(Some(units))));
        return vec![format!("no critical speed from {} to {}{unit}", digits(range[0]), digits(range[1]))];
    }
    let row = |(number, critical): (usize, &solve::modes::CriticalSpeed)| {
        let damping = percent(critical.mode.damping_ratio());
        vec![number.to_string(), digits(critical.speed), damping, whirl_in_words(critical.mode.whirl)]
    };
    let rows = (1..).zip(&modes.critical_speeds).take(LISTED).map(row).collect();
    table(&["critical", &heading("speed", Unit::AngularVelocity, units), "damping", "whirl"], rows)
}

/// "forward", "backward" with their sense, "planar" and "torsion or axial".
fn whirl_in_words(whirl: Option<Whirl>) -> String {
    whirl.map_or_else(String::new, |whirl| match whirl.kind() {
        kind @ ("forward" | "backward") => format!("{kind} {}", to_digits(whirl.sense.abs(), 2)),
        kind => kind.to_owned(),
    })
}
