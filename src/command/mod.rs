//! The command line: one file per command, and common parts: arguments, exit codes, the console, reading a deck.

mod accuracy;
mod arguments;
mod automatic_steps;
mod check;
mod checkpoints;
mod compare;
mod console;
mod estimate;
mod exit;
mod explicit_steps;
mod folder;
mod hint;
mod import;
mod init;
mod instructions;
mod load;
mod memory;
mod mesh_error;
mod modes_told;
mod processor;
mod recommend;
mod report;
mod resume;
mod run;
mod schema;
mod shell_completions;
mod signals;
mod stages;
mod study;
mod study_defaults;
mod summary;
mod sweep;
mod verdict;
mod version;
mod watchers;
mod written_deck;

pub use exit::Exit;

use arguments::{CheckArgs, RunArgs};
use std::path::Path;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};
use console::complain;
use hint::command_hint;

/// Batch solver for the nonlinear dynamics of structures made of rigid bodies and deformable parts.
#[derive(Debug, Parser)]
#[command(
    version = version::VERSION,
    long_version = version::long(),
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    arg_required_else_help = true
)]
#[command(after_help = "`rdsolve deck.toml` is short for `rdsolve run deck.toml`.

Exit codes: 0 done, 1 internal error, 2 usage, 3 deck invalid, 4 did not converge or turned unstable, 5 an expected value or
a stop was missed or folders differ, 6 input/output, 7 too little memory, 75 stopped by a signal: --resume goes on.")]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: Option<RunArgs>,
    /// Show diagnostics as JSON, one object a line, on standard error
    #[arg(long, global = true)]
    json: bool,
    /// Use a lower level of instructions than the best of this processor; only a release has several. The same level gives the same bits on
    /// every processor [default: the best; environment: RDSOLVE_INSTRUCTIONS]
    #[arg(long, global = true, value_name = "LEVEL")]
    instructions: Option<processor::Level>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a deck: tables, field files and result.json go to a folder
    ///
    /// Example: `rdsolve run deck.toml -o new.out --set analysis.time_step=1e-3`
    Run(RunArgs),
    /// Read and validate a deck, and print the computed and the omitted parts with reasons, mass, loads and the expected time; writes nothing
    ///
    /// Example: `rdsolve check deck.toml --set analysis.time_step=1e-3`
    Check(CheckArgs),
    /// Make a deck of an input file of Abaqus or CalculiX, and say what became of each keyword
    ///
    /// Example: `rdsolve import model.inp -o model`
    Import(import::ImportArgs),
    /// Compare two folders of results within tolerances, for regression tests
    ///
    /// Example: `rdsolve compare old.out new.out --tolerance 1e-6`
    Compare(compare::CompareArgs),
    /// Make one HTML file of a folder of results: plots, energy balance, the moving scene
    ///
    /// Example: `rdsolve report new.out -o new.html`
    Report(report::ReportArgs),
    /// Measure error against run time over time steps, schemes, methods and meshes; or what rigid parts would cost and save
    ///
    /// Example: `rdsolve study deck.toml -o deck.study --time-steps 1e-2,5e-3`
    Study(Box<study::StudyArgs>),
    /// Print the deck with the mesh, contact stiffness and steps that an accuracy needs, found by pilot runs
    ///
    /// Example: `rdsolve recommend deck.toml --accuracy 1e-3 > chosen.toml`
    Recommend(recommend::RecommendArgs),
    /// Run many variants of a deck, here or as one shard of many, and collect numbers of each in one table
    ///
    /// Example: `rdsolve sweep cases.toml -o cases.out --jobs 4`
    Sweep(sweep::SweepArgs),
    /// Print peaks and ends of all columns of a folder of results
    ///
    /// Example: `rdsolve summary new.out --format csv`
    Summary(summary::SummaryArgs),
    /// Print a commented deck that runs, to begin with
    ///
    /// Example: `rdsolve init frame > deck.toml`
    Init(init::InitArgs),
    /// Print the JSON Schema of the deck, or of a sweep, for completion and checks in editors
    ///
    /// Example: `rdsolve schema > deck.schema.json`
    Schema(schema::SchemaArgs),
    /// Print a script that lets a shell complete commands and options
    ///
    /// Example: `rdsolve completions bash > rdsolve.bash`
    Completions(shell_completions::CompletionsArgs),
    /// Print the manual page
    ///
    /// Example: `rdsolve man > rdsolve.1`
    Man,
}

/// Reads the command line. Help, versions and most errors are shown by clap, which ends the process.
///
/// # Errors
/// [`Exit::Usage`] where the first word is no command, nor a deck, or a level of instructions cannot be had; it has been said.
pub fn parse() -> Result<Cli, Exit> {
    instructions::settle()?;
    let word = std::env::args_os().nth(1).unwrap_or_default().to_string_lossy().into_owned();
    let parsed = Cli::try_parse();
    // Clap mistakes a word that is no command for a deck, and rejects the next word as one argument too many.
    let may_be_misspelt = match &parsed {
        Ok(cli) => cli.command.is_none() && !Path::new(&word).exists(),
        Err(error) => error.kind() == ErrorKind::ArgumentConflict,
    };
    if may_be_misspelt && let Some(hint) = command_hint(&word) {
        complain(&format!("there is no command `{word}`\n  help: {hint}"));
        return Err(Exit::Usage);
    }
    parsed.map_err(|error| error.exit())
}

/// Executes a parsed command line.
pub fn execute(cli: Cli) -> Exit {
    if let Some(missing) = processor::missing() {
        let built = processor::built_for();
        complain(&format!(
            "this program was built for {built}, and this processor has no {missing}\n  help: use a release (scripts/release), which chooses its \
             code at run time, or build rdsolve on this machine, or anywhere with RUSTFLAGS=\"-C target-cpu=x86-64\""
        ));
        return Exit::Internal;
    }
    signals::survive_file_limits();
    signals::name_want_of_memory();
    // The level of instructions is settled before parsing; clap only reports words that are no level.
    let Cli { instructions: _, .. } = cli;
    if cli.json {
        console::show_json();
    }
    let done = match (cli.command, cli.run) {
        (Some(Command::Run(args)), _) | (None, Some(args)) if import::is_foreign(&args.deck) => {
            import::import_and_run(args)
        }
        (Some(Command::Run(args)), _) | (None, Some(args)) if args.from.is_some() => {
            complain("--from is for input files of Abaqus and CalculiX, and this is a deck\n  help: remove --from");
            Err(Exit::Usage)
        }
        (Some(Command::Run(args)), _) | (None, Some(args)) => run::run(&args),
        (Some(Command::Import(args)), _) => import::import(&args).map(drop),
        (Some(Command::Check(args)), _) => check::check(&args),
        (Some(Command::Compare(args)), _) => compare::compare(&args),
        (Some(Command::Report(args)), _) => report::report(&args),
        (Some(Command::Study(args)), _) => study::study(&args),
        (Some(Command::Recommend(args)), _) => recommend::recommend(&args),
        (Some(Command::Sweep(args)), _) => sweep::sweep(&args),
        (Some(Command::Summary(args)), _) => summary::summary(&args),
        (Some(Command::Init(args)), _) => init::init(&args),
        (Some(Command::Schema(args)), _) => schema::schema(&args),
        (Some(Command::Completions(args)), _) => shell_completions::completions(&args, Cli::command()),
        (Some(Command::Man), _) => shell_completions::man(Cli::command()),
        // Clap requires a deck before this point.
        (None, None) => Err(Exit::Usage),
    };
    done.err().unwrap_or(Exit::Done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hints_know_the_commands() {
        let cli = Cli::command();
        let names: Vec<&str> = cli.get_subcommands().map(|command| command.get_name()).collect();
        assert_eq!(names, hint::COMMANDS);
    }
}
