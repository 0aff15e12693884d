//! The runs of a study. Each setting runs once for its answer and again for its time, in turn with the others, so that disturbances of the
//! machine affect all settings alike.

use super::grid::StudyGrid;
use super::manifest::Manifest;
use super::options::{Options, RUNS, StudyFault};
use super::process::Program;
use super::progress::StudyProgress;
use super::run::{RunStatus, StudyRun, measured};
use model::study::Quantity;
use std::io;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The folder of a setting, below that of the study.
fn folder(index: usize) -> String {
    format!("{RUNS}/{}", index + 1)
}

/// The folders of all settings of a grid.
pub fn folders(grid: &StudyGrid) -> Vec<String> {
    let count = (0..grid.lines.len()).map(|line| grid.resolutions(line).len()).sum();
    (0..count).map(folder).collect()
}

/// A setting to run.
pub struct Job {
    /// It in words.
    pub label: String,
    /// The folder, below that of the study.
    pub folder: String,
    /// The index of the line of the grid, and the time step or tolerance.
    pub setting: (usize, f64),
    /// A guess of its work, in any unit.
    pub work: f64,
    /// The overrides; `None` where it cannot be run.
    pub sets: Option<Vec<String>>,
}

/// The settings of a grid.
pub fn jobs(grid: &StudyGrid, options: &Options) -> Vec<Job> {
    let lines = (0..grid.lines.len()).flat_map(|line| grid.resolutions(line).iter().map(move |&at| (line, at)));
    let job = |(index, (line, resolution)): (usize, (usize, f64))| Job {
        label: format!("{}, {}", grid.lines[line].label, base::names::short(resolution)),
        folder: folder(index),
        setting: (line, resolution),
        // Starting a process costs as much as some hundred steps.
        work: 300.0 + grid.work(line, resolution),
        sets: Some(options.sets.iter().cloned().chain(grid.overrides(line, resolution)).collect()),
    };
    lines.enumerate().map(job).collect()
}

/// The options of the runs, and the data kept of each.
pub struct RunSeries<'t> {
    /// The options of the study.
    pub options: &'t Options,
    /// The quantities that are kept.
    pub quantities: &'t [Quantity],
    /// The number of intervals between the times of comparison.
    pub samples: usize,
    /// The end of the run.
    pub end: f64,
    /// Called after the first run of a setting, with its number and folder.
    pub once_run: &'t mut dyn FnMut(usize, &StudyRun, &Path) -> Result<(), StudyFault>,
}

impl RunSeries<'_> {
    /// Runs all settings, each again and again in turn. Returns the runs that came to be, and whether a signal has ended it.
    ///
    /// # Errors
    /// A run cannot be started, or its result cannot be read.
    pub fn run_all(
        self,
        jobs: &[Job],
        manifest: &mut Manifest,
        stop: &AtomicBool,
    ) -> Result<(Vec<Option<StudyRun>>, bool), StudyFault> {
        let RunSeries { options, quantities, samples, end, once_run } = self;
        let (program, repeats) = (program(options)?, options.repeats);
        let all: f64 = jobs.iter().map(|job| job.work).sum();
        let mut progress = StudyProgress::new(options.quiet, all * repeats as f64);
        let mut runs: Vec<Option<StudyRun>> = vec![None; jobs.len()];
        let mut stopped = false;
        'all: for repeat in 0..repeats {
            for (index, job) in jobs.iter().enumerate() {
                progress.show(&job.label, repeat + 1, repeats);
                progress.did(job.work);
                let enough =
                    |run: &StudyRun| run.status != RunStatus::Done || run.process_s * repeat as f64 > options.budget;
                let Some(sets) = &job.sets else { continue };
                if repeat > 0 && runs[index].as_ref().is_none_or(enough) {
                    continue;
                }
                let place = options.folder.join(&job.folder);
                if repeat == 0 {
                    manifest.note(&job.folder)?;
                }
                let Some(ended) = program.run(sets, &place, stop)? else {
                    stopped = true;
                    break 'all;
                };
                if let Some(run) = &mut runs[index] {
                    if let (Some(0), Ok(again)) = (ended.code, measured(&place)) {
                        run.again(again.loop_s, ended.process_s);
                    }
                    continue;
                }
                let (line, resolution) = job.setting;
                let run = StudyRun::new(line, resolution, job.folder.clone(), &ended, &place)?;
                let run = run.with_history(quantities, samples, end, &place);
                once_run(index, &run, &place)?;
                runs[index] = Some(run);
            }
        }
        progress.finish();
        Ok((runs, stopped))
    }
}

/// This program itself, with the deck of a study.
///
/// # Errors
/// The system does not tell the path of the program.
fn program(options: &Options) -> io::Result<Program> {
    let path = std::env::current_exe()?;
    Ok(Program { path, deck: options.deck.clone(), threads: options.threads, instructions: options.instructions })
}
