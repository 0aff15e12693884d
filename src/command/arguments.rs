//! Arguments that several commands share.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The largest number for `--threads`: more threads gain nothing, and the system refuses to start thousands of them.
pub const MAX_THREADS: i64 = 64;

/// A program whose files are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ForeignProgram {
    /// Abaqus
    Abaqus,
    /// CalculiX
    Calculix,
}

#[derive(Debug, Args)]
pub struct DeckArgs {
    /// The deck, a TOML file; - is standard input
    pub deck: PathBuf,
    /// Override one entry of the deck: a dotted path with list items by name or number, and a TOML value;
    /// repeatable: beams.portal.elements=24, loads[0].force=[0.0,0.0,-50.0], integrator.scheme=newmark
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    #[command(flatten)]
    pub deck: DeckArgs,
    /// Write the matrices of the undeformed scene without loads into this folder (Matrix Market): K.mtx, M.mtx, C.mtx with damping, G.mtx
    /// with joints, and dofs.csv, the node and direction of each row
    #[arg(long, value_name = "DIR")]
    pub export_matrices: Option<PathBuf>,
    /// Find the first natural period of the scene as the deck draws it, without loads
    #[arg(long)]
    pub first_period: bool,
}

#[derive(Debug, Args)]
pub struct RunArgs {
    // The entries of `DeckArgs` are repeated, for clap does not find a group within an optional group.
    /// The deck, a TOML file; - is standard input
    pub deck: PathBuf,
    /// Override one entry of the deck: a dotted path with list items by name or number, and a TOML value;
    /// repeatable: beams.portal.elements=24, loads[0].force=[0.0,0.0,-50.0], integrator.scheme=newmark
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// Folder for the results [default: the deck's name with .out, in the current folder]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// The program that an input file of Abaqus or CalculiX is for [default: by signs in the file]
    #[arg(long, value_enum)]
    pub from: Option<ForeignProgram>,
    /// Threads to use, from 1 to 64; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=MAX_THREADS))]
    pub threads: Option<u8>,
    /// Make another run with half as many elements in each part, or a degree less, and estimate the error of the mesh in expected values
    /// and in the largest value of each column
    #[arg(long)]
    pub mesh_error: bool,
    /// Show errors only
    #[arg(long)]
    pub quiet: bool,
    /// Write into a folder that already holds files, and replace results there
    #[arg(long, conflicts_with = "resume")]
    pub overwrite: bool,
    /// Continue from the checkpoint of a stopped run in the folder; start from the beginning if there is none
    #[arg(long)]
    pub resume: bool,
}
