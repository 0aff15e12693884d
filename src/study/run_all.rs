//! The runs of a study: each setting is run once for its answer and again for its time, in turn with the others, so that what
//! disturbs the machine for a while disturbs all settings alike.

use super::grid::StudyGrid;
use super::manifest::Manifest;
use super::options::{Options, RUNS, StudyFault};
use super::process::Program;
use super::progress::StudyProgress;
use super::run::{RunStatus, StudyRun, measured};
use model::study::Quantity;
use std::io;
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

/// Runs all settings. Returns the settings that were run, and whether a signal has ended it.
///
/// # Errors
/// A run cannot be started, or its result cannot be read.
pub fn run_all(
    grid: &StudyGrid,
    quantities: &[Quantity],
    options: &Options,
    manifest: &mut Manifest,
    stop: &AtomicBool,
) -> Result<(Vec<StudyRun>, bool), StudyFault> {
    let program = program(options)?;
    let mut jobs = Vec::new();
    for line in 0..grid.lines.len() {
        for &resolution in grid.resolutions(line) {
            let sets: Vec<String> = options.sets.iter().cloned().chain(grid.overrides(line, resolution)).collect();
            jobs.push((line, resolution, sets));
        }
    }
    // Starting a process costs as much as some hundred steps.
    let work = |line: usize, resolution: f64| 300.0 + grid.work(line, resolution);
    let all: f64 = jobs.iter().map(|(line, resolution, _)| work(*line, *resolution)).sum();
    let mut progress = StudyProgress::new(options.quiet, all * options.repeats as f64);
    let mut runs: Vec<StudyRun> = Vec::new();
    let mut stopped = false;
    for repeat in 0..options.repeats {
        for (index, (line, resolution, sets)) in jobs.iter().enumerate() {
            let label = format!("{}, {}", grid.lines[*line].label, base::names::short(*resolution));
            progress.show(&label, repeat + 1, options.repeats);
            let folder = folder(index);
            let enough =
                |run: &StudyRun| run.status != RunStatus::Done || run.process_s * repeat as f64 > options.budget;
            if repeat > 0 && runs.get(index).is_none_or(enough) {
                progress.did(work(*line, *resolution));
                continue;
            }
            let place = options.folder.join(&folder);
            if repeat == 0 {
                manifest.note(&folder)?;
            }
            let Some(ended) = program.run(sets, &place, stop)? else {
                stopped = true;
                break;
            };
            progress.did(work(*line, *resolution));
            if repeat == 0 {
                let run = StudyRun::new(*line, *resolution, folder, &ended, &place)?;
                runs.push(run.with_history(quantities, grid.samples, grid.end_time, &place));
            } else if ended.code == Some(0)
                && let (Some(run), Ok(again)) = (runs.get_mut(index), measured(&place))
            {
                run.again(again.loop_s, ended.process_s);
            }
        }
        if stopped {
            break;
        }
    }
    progress.finish();
    Ok((runs, stopped))
}

/// This program itself, with the deck of a study.
///
/// # Errors
/// The system does not tell the path of the program.
pub fn program(options: &Options) -> io::Result<Program> {
    let path = std::env::current_exe()?;
    Ok(Program { path, deck: options.deck.clone(), threads: options.threads, instructions: options.instructions })
}
