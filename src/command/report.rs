//! `rdsolve report DIR`: one HTML file of a folder of results.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::Args;

use super::console::{complain, print, say};
use super::exit::Exit;
use results::report::page;

#[derive(Debug, Args)]
#[command(
    after_help = "The page opens without a network: status, plan, counts, expectations, the deck if it is still that of the \
run, plots of all tables, energy balance, and the moving scene (of fields.pvd if the run wrote it: [output] fields). Long \
histories are thinned, which it says."
)]
pub struct ReportArgs {
    /// The folder of results
    dir: PathBuf,
    /// The file to write [default: the folder's name with .html, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace a file that is there already
    #[arg(long)]
    overwrite: bool,
    /// Show errors only
    #[arg(long)]
    quiet: bool,
}

/// Writes the HTML file of a folder of results.
///
/// # Errors
/// [`Exit::Usage`] where the file is there already, [`Exit::InputOutput`] where results cannot be read or the file cannot be
/// written; the reason has been shown.
pub fn report(args: &ReportArgs) -> Result<(), Exit> {
    let fault = |what: String| {
        complain(&what);
        Exit::InputOutput
    };
    let file = match &args.output {
        Some(file) => file.clone(),
        None => default(args).map_err(|error| fault(format!("cannot read `{}`: {error}", args.dir.display())))?,
    };
    let name = file.display().to_string();
    let exists = || {
        complain(&format!("the file `{name}` is there already"));
        say("  help: --overwrite replaces it; -o FILE writes elsewhere");
        Exit::Usage
    };
    if !args.overwrite && file.exists() {
        return Err(exists());
    }
    let page = page(&args.dir).map_err(|error| fault(format!("cannot read results: {error}")))?;
    let mut options = OpenOptions::new();
    let options = if args.overwrite {
        options.write(true).create(true).truncate(true)
    } else {
        options.write(true).create_new(true)
    };
    match options.open(&file).and_then(|mut file| file.write_all(page.as_bytes())) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Err(exists()),
        Err(error) => return Err(fault(format!("cannot write `{name}`: {error}"))),
        Ok(()) => {}
    }
    if args.quiet { Ok(()) } else { print(&format!("{name}, {:.1} MB\n", page.len() as f64 / 1e6)) }
}

/// The file that is written where the user names none: `cab.out` becomes `cab.html`, and dots within a name stay.
fn default(args: &ReportArgs) -> std::io::Result<PathBuf> {
    let folder = args.dir.canonicalize()?;
    let name = folder.file_name().map_or("report".into(), |name| name.to_string_lossy().into_owned());
    Ok(PathBuf::from(format!("{}.html", name.strip_suffix(".out").unwrap_or(&name))))
}
