//! Error against run time: one scene run again and again by the program itself, with other time steps, schemes, methods and
//! meshes, and what the runs say together: measured orders, the cheapest setting for an error, what it would cost to make a part
//! rigid. Each run is a process of its own, so that what is measured is what a user pays.
//!
//! Error = √(mean |q − q_ref|²) / max |q_ref| over equidistant times, q all quantities. Steps land on these times; nothing is
//! interpolated. The reference is a file, or what the finest runs tend to, with a bound of its own error ([`reference`]).

mod grid;
mod history;
mod manifest;
mod order;
mod page;
mod picture;
mod process;
mod progress;
mod reference;
mod rigidify;
mod runs;
mod study_csv;
mod table;

pub use grid::{Line, StudyGrid};
pub use order::{Cheapest, Order};
pub use process::LIFELINE;
pub use reference::Reference;
pub use rigidify::{Advice, Part, rigidify};
pub use runs::{Run, Status};

use crate::deck::Deck;
use crate::diagnostic::Diagnostic;
use crate::model::Model;
use crate::model::study::Quantity;
use manifest::Manifest;
use std::io;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// Files that a study writes besides its runs.
const TABLE: &str = "study.csv";
const PICTURE: &str = "study.svg";
const PAGE: &str = "study.html";

/// How a study is run.
#[derive(Debug, Clone)]
pub struct Options {
    pub deck: PathBuf,
    /// The user's own `--set` arguments.
    pub sets: Vec<String>,
    /// For study.csv and the runs.
    pub folder: PathBuf,
    pub threads: usize,
    /// Runs of each setting, of which the least time counts.
    pub repeats: usize,
    /// A setting is run again only while its runs have taken less than so many seconds together.
    pub budget: f64,
    pub quiet: bool,
}

/// Why there is no study.
#[derive(Debug)]
pub enum Fault {
    /// What is asked for makes no sense with this deck.
    Deck(Vec<Diagnostic>),
    Io(io::Error),
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Fault::Io(error)
    }
}

/// A study that has been run.
pub struct Found {
    pub title: String,
    pub deck: String,
    pub quantities: Vec<Quantity>,
    pub grid: StudyGrid,
    /// By line, longest time step first.
    pub runs: Vec<Run>,
    /// Or why there is none, in words.
    pub reference: Result<Reference, String>,
    /// Of each line; or why there is none, in words.
    pub orders: Vec<Result<Order, &'static str>>,
    /// For each error asked for, by cost; empty where no line comes to it.
    pub cheapest: Vec<(f64, Vec<Cheapest>)>,
    /// A signal ended it.
    pub stopped: bool,
}

/// Runs the grid of settings of a sound deck and writes study.csv, study.svg and study.html.
pub fn study(model: &Model, deck: &Deck, options: &Options, stop: &AtomicBool) -> Result<Found, Fault> {
    let asked = model.study.clone().unwrap_or_default();
    let quantities = history::quantities(model, &asked);
    let base = options.deck.parent().map(PathBuf::from).unwrap_or_default();
    let key = deck.study.as_ref().and_then(|study| study.reference.as_ref()).map(|file| &file.span);
    let given = reference::read(model, &asked, &quantities, &base, key);
    let samples = given.as_ref().ok().and_then(|given| given.as_ref()).map(|given| given.samples);
    let grid = StudyGrid::new(model, deck, &asked, &quantities, samples);
    let (given, grid) = match (given, grid) {
        (Ok(given), Ok(grid)) => (given, grid),
        (given, grid) => {
            return Err(Fault::Deck([given.err(), grid.err()].into_iter().flatten().flatten().collect()));
        }
    };
    let mut manifest = Manifest::begin(&options.folder, &[TABLE, PICTURE, PAGE], &runs::folders(&grid))?;
    let (mut runs, stopped) = runs::run_all(&grid, &quantities, options, &mut manifest, stop)?;
    let reference = match given {
        Some(given) => Ok(given.into()),
        None => reference::extrapolate(&grid, &runs, &quantities),
    };
    if let Ok(reference) = &reference {
        runs.iter_mut().for_each(|run| run.judge(reference, quantities.len()));
    }
    let orders = order::orders(&grid, &runs);
    let wanted = if asked.wanted_errors.is_empty() { vec![1e-2, 1e-3, 1e-4] } else { asked.wanted_errors.clone() };
    let cheapest = order::cheapest(&grid, &runs, &wanted);
    let title = if model.title.is_empty() { options.deck.display().to_string() } else { model.title.clone() };
    let deck = options.deck.display().to_string();
    let found = Found { title, deck, quantities, grid, runs, reference, orders, cheapest, stopped };
    manifest.write(TABLE, study_csv::table(&found).as_bytes())?;
    let picture = picture::draw(&found);
    manifest.write(PICTURE, picture.as_bytes())?;
    manifest.write(PAGE, page::page(&found, &picture).as_bytes())?;
    Ok(found)
}

impl Found {
    /// For standard output.
    pub fn text(&self) -> String {
        table::text(self)
    }

    /// Runs of a line, longest time step first.
    pub fn of_line(&self, line: usize) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(move |run| run.line == line)
    }
}

/// Numbers in columns, the first two to the left.
fn columns(lines: &[Vec<String>], left: usize) -> String {
    let count = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width = |i: usize| lines.iter().filter_map(|line| line.get(i)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..count).map(|i| width(i).unwrap_or(0)).collect();
    let row = |line: &Vec<String>| {
        let cell = |(i, cell): (usize, &String)| match i {
            i if i < left || i + 1 == count => format!("{cell:<0$}", widths[i]),
            i => format!("{cell:>0$}", widths[i]),
        };
        let cells: Vec<String> = line.iter().enumerate().map(cell).collect();
        format!("{}\n", cells.join("  ").trim_end())
    };
    lines.iter().map(row).collect()
}
