//! `rdsolve report DIR`: one HTML file of a folder of results, or one picture of its scene.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::Args;

use super::console::{complain, print, say};
use super::exit::Exit;
use results::report::{View, page, scene_picture};
use results::torn_tables;

#[derive(Debug, Args)]
#[command(
    after_help = "The page opens without a network: status, plan, counts, expectations, the deck if it is still that of the \
run, plots of all tables, energy balance, and the moving scene (of fields.pvd if the run wrote it: [output] fields). Long \
histories are thinned, which it says. --picture draws one time of this scene as SVG, for light and dark paper: \
rdsolve report cab.out --picture --time 0.05 --magnify 10"
)]
pub struct ReportArgs {
    /// The folder of results
    dir: PathBuf,
    /// The file to write [default: the folder's name with .html or .svg, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw one time of the scene as a picture (SVG) instead of the page
    #[arg(long)]
    picture: bool,
    /// The time that the picture shows, or the number of the mode [default: the last time, or the first mode]
    #[arg(long, value_name = "TIME", requires = "picture", allow_negative_numbers = true)]
    time: Option<f64>,
    /// The factor of the displacements in the picture
    #[arg(long, value_name = "FACTOR", requires = "picture", default_value_t = 1.0, value_parser = positive)]
    magnify: f64,
    /// The width of the picture in pixels; its height is three quarters of it
    #[arg(long, value_name = "PIXELS", requires = "picture", default_value_t = 480.0, value_parser = positive)]
    width: f64,
    /// Replace a file that is there already
    #[arg(long)]
    overwrite: bool,
    /// Show errors only
    #[arg(long)]
    quiet: bool,
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "a number above 0 is needed".into())
}

/// Writes the HTML file of a folder of results, or the picture of its scene.
///
/// # Errors
/// [`Exit::Usage`] if the file exists, [`Exit::InputOutput`] if results cannot be read or the file cannot be written; the reason has been
/// shown.
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
    let torn = torn_tables(&args.dir).map_err(|error| fault(format!("cannot read results: {error}")))?;
    torn.iter().for_each(|torn| say(&format!("warning: {torn}")));
    let (page, time) = contents(args).map_err(|error| fault(format!("cannot read results: {error}")))?;
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
    let size = page.len() as f64;
    let what =
        time.map_or_else(|| format!("{:.1} MB", 1e-6 * size), |time| format!("t = {time}, {:.1} kB", 1e-3 * size));
    if args.quiet { Ok(()) } else { print(&format!("{name}, {what}\n")) }
}

/// The text of the file, and the time that a picture shows.
fn contents(args: &ReportArgs) -> std::io::Result<(String, Option<f32>)> {
    if !args.picture {
        return Ok((page(&args.dir)?, None));
    }
    let view = View { time: args.time, magnify: args.magnify, width: args.width };
    scene_picture(&args.dir, &view).map(|(picture, time)| (picture, Some(time)))
}

/// The default file: `cab.out` becomes `cab.html` or `cab.svg`, and dots within a name stay.
fn default(args: &ReportArgs) -> std::io::Result<PathBuf> {
    let folder = args.dir.canonicalize()?;
    let name = folder.file_name().map_or("report".into(), |name| name.to_string_lossy().into_owned());
    let kind = if args.picture { "svg" } else { "html" };
    Ok(PathBuf::from(format!("{}.{kind}", name.strip_suffix(".out").unwrap_or(&name))))
}
