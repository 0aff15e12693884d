//! Error against run time: runs one scene repeatedly with other time steps, schemes, methods and meshes. It derives measured orders, the
//! cheapest setting for an error, and the cost of a rigid part. Each run is a separate process, so that its time is the time for a user.
//!
//! Error = √(mean |q − q_ref|²) / max |q_ref| over equidistant times, q all quantities. Steps land on these times; nothing is interpolated.
//! The reference is a file, or the limit of the finest runs, with a bound of its error ([`reference`]).

#![warn(missing_docs)]

mod advice;
mod asked;
mod asked_picture;
mod cells;
mod chart;
mod cheapest;
mod columns;
mod confirm;
mod confirmation;
mod cost;
mod family;
mod found;
mod grid;
mod history;
mod limit;
mod lines;
mod manifest;
mod meshes;
mod options;
mod order;
mod page;
mod picture;
mod process;
mod progress;
mod recommend;
mod reference;
mod reference_file;
mod refinement;
mod rigidify;
mod run;
mod run_all;
mod section;
mod study_csv;
mod table;

pub use advice::{AdvisedPart, StudyAdvice};
pub use asked::{Asked, AskedRun};
pub use cheapest::Cheapest;
pub use confirmation::{Confirmation, Difference};
pub use cost::Cost;
pub use family::Family;
pub use found::Found;
pub use grid::StudyGrid;
pub use lines::{StudyLine, follows_tolerance};
pub use meshes::{CoarserMesh, coarser};
pub use options::{Options, StudyFault};
pub use order::Order;
pub use process::{INSTRUCTIONS, LIFELINE};
pub use recommend::recommend;
pub use reference::Reference;
pub use refinement::{RefinableParts, is_affordable, mesh_groups};
pub use rigidify::rigidify;
pub use run::{RunStatus, StudyRun};
pub use table::text;

use deck::Deck;
use manifest::Manifest;
use model::Model;
use run_all::RunSeries;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The table of runs that a study writes.
const TABLE: &str = "study.csv";
/// The picture of error against run time.
const PICTURE: &str = "study.svg";
/// The picture of what automatic steps were asked for and reached.
const ASKED: &str = "asked.svg";
/// The page with all.
const PAGE: &str = "study.html";

/// Runs the grid of settings of a sound deck and writes study.csv, study.svg and study.html. Raising `stop` ends it with the runs
/// that are complete.
///
/// # Errors
/// The options contradict this deck, or a file cannot be read or written.
pub fn study(model: &Model, deck: &Deck, options: &Options, stop: &AtomicBool) -> Result<Found, StudyFault> {
    let asked = model.study.clone().unwrap_or_default();
    let quantities = history::quantities(model, &asked);
    let base = options.deck.parent().map(PathBuf::from).unwrap_or_default();
    let key = deck.study.as_ref().and_then(|study| study.reference.as_ref()).map(|file| &file.span);
    let given = reference_file::read(model, &asked, &quantities, &base, key);
    let samples = given.as_ref().ok().and_then(|given| given.as_ref()).map(|given| given.samples);
    let grid = StudyGrid::new(model, deck, &asked, &quantities, samples);
    let (given, grid) = match (given, grid) {
        (Ok(given), Ok(grid)) => (given, grid),
        (given, grid) => {
            return Err(StudyFault::Deck([given.err(), grid.err()].into_iter().flatten().flatten().collect()));
        }
    };
    let mut manifest = Manifest::begin(&options.folder, &[TABLE, PICTURE, ASKED, PAGE], &run_all::folders(&grid))?;
    let once_run = &mut |_, _: &StudyRun, _: &Path| Ok(());
    let series = RunSeries { options, quantities: &quantities, samples: grid.samples, end: grid.end_time, once_run };
    let (runs, stopped) = series.run_all(&run_all::jobs(&grid, options), &mut manifest, stop)?;
    let mut runs: Vec<StudyRun> = runs.into_iter().flatten().collect();
    let reference = match given {
        Some(given) => Ok(given.into()),
        None => reference::extrapolate(&grid, &runs, &quantities),
    };
    let reference = reference.map(|mut reference| {
        confirm::confirm(&mut reference, &grid, &runs);
        reference
    });
    if let Ok(reference) = &reference {
        runs.iter_mut().for_each(|run| run.judge(&reference.values, reference.error_bound, quantities.len()));
    }
    let orders = order::orders(&grid, &runs);
    let wanted = if asked.wanted_errors.is_empty() { vec![1e-2, 1e-3, 1e-4] } else { asked.wanted_errors.clone() };
    let cheapest = cheapest::cheapest(&grid, &runs, &wanted);
    let asked_for = asked::asked(&grid, &runs);
    let title = if model.title.is_empty() { options.deck.display().to_string() } else { model.title.clone() };
    let deck = options.deck.display().to_string();
    let found = Found { title, deck, quantities, grid, runs, reference, orders, cheapest, asked: asked_for, stopped };
    write(&found, options, &mut manifest)?;
    Ok(found)
}

/// Writes the tables, the pictures and the page.
fn write(found: &Found, options: &Options, manifest: &mut Manifest) -> std::io::Result<()> {
    manifest.write(TABLE, study_csv::table(found).as_bytes())?;
    manifest.write(PICTURE, picture::draw(found, options.axis).as_bytes())?;
    if let Some(picture) = asked_picture::draw(&found.grid, &found.asked) {
        manifest.write(ASKED, picture.as_bytes())?;
    }
    manifest.write(PAGE, page::page(found, options.axis).as_bytes())
}
