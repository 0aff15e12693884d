//! Error bars: what error the steps of a run leave in the largest value of every column of its tables, and its mesh.
//!
//! A run with a step tolerance always consists of two runs, with errors of a known ratio (see [`solve::StepError`]). The error of the mesh
//! needs another run with a coarser mesh. So the difference of any number of theirs tells the error of that number, too. At a single time
//! the difference may pass through zero, so those of the same column at other times count as well.

mod bar;
mod extremes;
mod history;
mod rows;

pub use self::bar::{ErrorBar, Told};
pub(super) use self::history::ComparedHistory;

use self::extremes::{Extreme, Extremes};
use self::rows::CollectedRows;
use super::table::{TableKind, WriteRows};
use super::tables::TABLES;
use base::quantities::Unit;
use base::snapshot::keep;
use model::{Model, StepLength};
use solve::{Frame, Observer, OtherRun};
use std::io;

/// Keeps the numbers of a run, and of the runs that estimate its errors.
pub struct ErrorBars {
    tables: Vec<WatchedTable>,
    rounding: f64,
    /// True where runs are compared at the times of output: their steps do not follow a tolerance, and have the same ends.
    at_output_times: bool,
}

keep!(ErrorBars { tables } without { rounding, at_output_times });

/// A table that the run writes.
struct WatchedTable {
    kind: &'static TableKind,
    write: WriteRows,
    rows: CollectedRows,
    /// Of the run under way, and of the one before.
    seen: Account,
    before: Account,
    /// Of an unseen run, and of one with a mesh that is coarser still.
    unseen: ComparedHistory,
    coarsest: ComparedHistory,
    /// Of a pilot run.
    pilot: ComparedHistory,
    /// The errors by the steps, by column, and the errors by the mesh; empty if they are not known.
    of_steps: Vec<Told>,
    of_mesh: Vec<Told>,
}

keep!(WatchedTable { seen, before, unseen, of_steps, of_mesh } without { kind, write, rows, coarsest, pilot });

/// The numbers of one run.
#[derive(Default)]
struct Account {
    largest: Extremes,
    history: ComparedHistory,
}

keep!(Account { largest, history });

impl ErrorBars {
    /// Nothing seen yet. Tables of what steps cost have no errors.
    pub fn new(model: &Model) -> ErrorBars {
        let written = TABLES.iter().copied().filter(|kind| (kind.wanted)(model) && !kind.every_step);
        let watch = |kind: &'static TableKind| WatchedTable {
            kind,
            write: (kind.rows)(model),
            rows: CollectedRows::new(kind, model),
            seen: Account::default(),
            before: Account::default(),
            unseen: ComparedHistory::default(),
            coarsest: ComparedHistory::default(),
            pilot: ComparedHistory::default(),
            of_steps: Vec::new(),
            of_mesh: Vec::new(),
        };
        ErrorBars {
            tables: written.map(watch).collect(),
            rounding: 1e-9 * model.analysis.end_time,
            at_output_times: !matches!(model.analysis.step_length, StepLength::ErrorControlled { .. }),
        }
    }

    /// The times at which a run with another mesh must have frames.
    pub fn times_for_mesh(&self) -> Vec<f64> {
        let all = self.tables.iter().flat_map(|table| table.seen.history.times().iter().copied());
        all.chain(self.times_to_compare()).collect()
    }

    /// Receives a frame of a run with another mesh, whose own account writes its rows.
    ///
    /// # Errors
    /// There is none.
    pub fn on_other_mesh(&mut self, theirs: &mut ErrorBars, frame: &Frame) -> io::Result<()> {
        for (table, WatchedTable { write, rows, .. }) in self.tables.iter_mut().zip(&mut theirs.tables) {
            rows.clear();
            write(rows, frame)?;
            table.seen.largest.read(rows, frame.state.time, self.rounding, false);
            table.unseen.keep(frame.state.time, rows.numbers());
        }
        Ok(())
    }

    /// Receives a frame of a run with a mesh that is coarser than that of the other run.
    ///
    /// # Errors
    /// There is none.
    pub fn on_coarsest_mesh(&mut self, theirs: &mut ErrorBars, frame: &Frame) -> io::Result<()> {
        for (table, WatchedTable { write, rows, .. }) in self.tables.iter_mut().zip(&mut theirs.tables) {
            rows.clear();
            write(rows, frame)?;
            table.coarsest.keep(frame.state.time, rows.numbers());
        }
        Ok(())
    }

    /// Receives a frame of the run itself, a pilot run without tables.
    ///
    /// # Errors
    /// There is none.
    pub fn on_pilot(&mut self, frame: &Frame) -> io::Result<()> {
        let time = frame.state.time;
        for WatchedTable { write, rows, seen, .. } in &mut self.tables {
            rows.clear();
            write(rows, frame)?;
            seen.largest.update(rows, time);
            seen.history.keep(time, rows.numbers());
        }
        Ok(())
    }

    /// Keeps the numbers of a pilot run that may tell the errors by the steps.
    pub fn compare_with(&mut self, pilot: &ErrorBars) {
        for table in &mut self.tables {
            if let Some(seen) = pilot.seen_of(table.kind) {
                table.pilot.clone_from(&seen.history);
            }
        }
    }

    /// Tells the errors by the mesh from two pilot runs, the second with a coarser mesh and errors larger by this factor.
    pub fn told_by_pilots(&mut self, [fine, coarse]: [&ErrorBars; 2], apart: f64) {
        for table in &mut self.tables {
            let [Some(a), Some(b)] = [fine, coarse].map(|pilot| pilot.seen_of(table.kind)) else { continue };
            let anywhere = a.history.largest_differences(&b.history, table.rows.width(), self.rounding);
            let told = |(column, (a, b)): (usize, (&Option<Extreme>, &Option<Extreme>))| {
                // Rows of elements differ between meshes, but their largest numbers agree.
                let pair = [a, b].map(|extreme| extreme.as_ref().map(|extreme| extreme.value.abs()));
                Told::by(pair, anywhere.as_ref().map(|all| all[column]), apart)
            };
            table.of_mesh = a.largest.0.iter().zip(&b.largest.0).enumerate().map(told).collect();
        }
    }

    /// The numbers of a table; `None` if it is not watched.
    fn seen_of(&self, kind: &TableKind) -> Option<&Account> {
        self.tables.iter().find(|table| table.kind.file == kind.file).map(|table| &table.seen)
    }

    /// The ratio of the errors of displacements on the coarsest and the other mesh, measured by three meshes; `None` if no node is written.
    pub fn measured_ratio(&self) -> Option<f64> {
        let table = self.tables.iter().find(|table| table.kind.columns().any(|column| column.name == "ux"))?;
        let columns = table.kind.columns().skip(2).filter(|column| column.unit != Unit::Label);
        let moved: Vec<usize> = columns
            .enumerate()
            .filter(|(_, column)| ["ux", "uy", "uz"].contains(&column.name))
            .map(|(index, _)| index)
            .collect();
        let largest = |one: &ComparedHistory, other: &ComparedHistory| {
            let all = one.largest_differences(other, table.rows.width(), self.rounding)?;
            Some(moved.iter().map(|&column| all[column]).fold(0.0, f64::max))
        };
        let (fine, coarse) = (largest(&table.seen.history, &table.unseen)?, largest(&table.unseen, &table.coarsest)?);
        (fine > 0.0).then(|| coarse / fine)
    }

    /// Records that the run with another mesh has ended; its errors are larger by this factor.
    pub fn on_coarser_mesh(&mut self, apart: f64) {
        for table in &mut self.tables {
            table.of_mesh = table.told_by(&table.seen, &table.unseen, apart, self.rounding);
        }
    }

    /// The error bars, in the order of tables and columns; empty where no other run has told them.
    pub fn into_bars(self) -> Vec<ErrorBar> {
        self.tables.iter().flat_map(WatchedTable::bars).collect()
    }
}

impl Observer for ErrorBars {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        if !frame.due && !frame.compared {
            return Ok(());
        }
        let time = frame.state.time;
        for WatchedTable { write, rows, seen, before, .. } in &mut self.tables {
            rows.clear();
            write(rows, frame)?;
            if frame.due {
                seen.largest.update(rows, time);
            }
            if frame.compared {
                before.largest.read(rows, time, self.rounding, true);
            }
            if frame.compared || self.at_output_times {
                seen.history.keep(time, rows.numbers());
            }
        }
        Ok(())
    }

    fn restart(&mut self, _: &Model) -> io::Result<()> {
        for table in &mut self.tables {
            table.before = std::mem::take(&mut table.seen);
            table.unseen.clear();
        }
        Ok(())
    }

    fn times_to_compare(&self) -> Vec<f64> {
        self.tables.iter().flat_map(|table| table.seen.largest.times()).collect()
    }

    fn begin_comparison(&mut self) {
        for table in &mut self.tables {
            table.unseen.clear();
            table.seen.largest.forget_others();
        }
    }

    fn on_comparison(&mut self, frame: &Frame) -> io::Result<()> {
        let time = frame.state.time;
        for WatchedTable { write, rows, seen, unseen, .. } in &mut self.tables {
            rows.clear();
            write(rows, frame)?;
            seen.largest.read(rows, time, self.rounding, true);
            unseen.keep(time, rows.numbers());
        }
        Ok(())
    }

    fn on_other_run(&mut self, other: Option<OtherRun>) {
        for table in &mut self.tables {
            table.of_steps = match other {
                Some(OtherRun::Comparison(apart)) => table.told_by(&table.seen, &table.unseen, apart, self.rounding),
                Some(OtherRun::Before(apart)) => {
                    table.told_by(&table.before, &table.before.history, apart, self.rounding)
                }
                Some(OtherRun::Pilot(apart)) => table.told_by(&table.seen, &table.pilot, apart, self.rounding),
                None => Vec::new(),
            };
        }
    }
}

impl WatchedTable {
    /// The errors by column, estimated from the history of another run and its values at the extremes of either run.
    fn told_by(&self, compared: &Account, other: &ComparedHistory, apart: f64, rounding: f64) -> Vec<Told> {
        let anywhere = self.seen.history.largest_differences(other, self.rows.width(), rounding);
        let told = |(column, largest): (usize, &Option<Extreme>)| {
            let pair =
                [largest.as_ref().map(|largest| largest.value), largest.as_ref().and_then(|largest| largest.other)];
            Told::by(pair, anywhere.as_ref().map(|all| all[column]), apart)
        };
        compared.largest.0.iter().enumerate().map(told).collect()
    }

    /// The error bars of all columns with a known error.
    fn bars(&self) -> Vec<ErrorBar> {
        let columns = self.kind.columns().skip(2).filter(|column| column.unit != Unit::Label);
        let bar = |(index, (column, largest)): (usize, (base::quantities::Column, &Option<Extreme>))| {
            let largest = largest.as_ref()?;
            let (steps, mesh) = (self.of_steps.get(index), self.of_mesh.get(index));
            let both = |of: fn(&Told) -> Option<f64>| {
                let known = [steps.and_then(of), mesh.and_then(of)];
                known.into_iter().flatten().reduce(|one, other| one + other)
            };
            let bar = ErrorBar {
                table: self.kind.file,
                column: column.name,
                at: largest.label.clone(),
                time: largest.time,
                value: largest.value,
                step_error: steps.and_then(|told| told.error),
                mesh_error: mesh.and_then(|told| told.error),
                anywhere: both(|told| told.anywhere),
            };
            (bar.step_error.is_some() || bar.mesh_error.is_some()).then_some(bar)
        };
        columns.zip(&self.seen.largest.0).enumerate().filter_map(bar).collect()
    }
}
