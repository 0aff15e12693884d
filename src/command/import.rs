//! `rdsolve import model.inp`: a deck, its mesh and a report on every keyword of a file of Abaqus or CalculiX; likewise robots of URDF.

use super::arguments::{ForeignProgram, RunArgs};
use super::console::{complain, counted, print, say, show};
use super::exit::Exit;
use super::folder::{named_after, require_free};
use super::load::{load, plan};
use super::run::run;
use base::diagnostic::Source;
use base::text_file::includes::Included;
use base::text_file::{Text, read_regular};
use clap::{Args, ValueEnum};
use import::{Dialect, ImportOptions, Imported, KeywordVerdict, Verdicts};
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub struct ImportArgs {
    /// The input file of Abaqus or CalculiX, or a robot of URDF
    pub file: PathBuf,
    /// Folder for the deck, its mesh and the report [default: the current folder]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// The program that the file is for [default: by signs in the file]
    #[arg(long, value_enum)]
    pub from: Option<ForeignProgram>,
    /// Count as refused what the deck computes otherwise
    #[arg(long)]
    pub strict: bool,
    /// Write what can be written in spite of refusals, which stand in the deck as comments
    #[arg(long)]
    pub partial: bool,
    /// The word for the units of the file; nothing is converted [default: by remarks of pre-processors]
    #[arg(long, value_enum)]
    pub units: Option<UnitsOfFile>,
    /// Print the report and write nothing
    #[arg(long)]
    pub check: bool,
    /// Replace files that exist
    #[arg(long)]
    pub force: bool,
}

/// Units as a deck calls them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum UnitsOfFile {
    /// Metre, kilogram, second
    #[value(name = "SI")]
    Si,
    /// Millimetre, tonne, second
    #[value(name = "mm-t-s")]
    MmTS,
    /// Millimetre, kilogram, second
    #[value(name = "mm-kg-s")]
    MmKgS,
    /// Millimetre, kilogram, millisecond
    #[value(name = "mm-kg-ms")]
    MmKgMs,
}

impl UnitsOfFile {
    fn word(self) -> &'static str {
        match self {
            UnitsOfFile::Si => "SI",
            UnitsOfFile::MmTS => "mm-t-s",
            UnitsOfFile::MmKgS => "mm-kg-s",
            UnitsOfFile::MmKgMs => "mm-kg-ms",
        }
    }
}

/// True for an input file of another program.
pub fn is_foreign(path: &Path) -> bool {
    has_extension(path, "inp") || is_robot(path)
}

/// True for a robot of URDF.
fn is_robot(path: &Path) -> bool {
    has_extension(path, "urdf")
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// Imports a file and returns the path of its deck.
///
/// # Errors
/// [`Exit::InputOutput`] where a file cannot be read or written, [`Exit::Usage`] where one exists, [`Exit::DeckInvalid`] where something is
/// refused; the reason has been shown.
pub fn import(args: &ImportArgs) -> Result<PathBuf, Exit> {
    write_files(args, true)
}

/// Imports a file. `checks`: the written deck is read and planned, as a later run does too.
fn write_files(args: &ImportArgs, checks: bool) -> Result<PathBuf, Exit> {
    let stem = args.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = args.output.clone().unwrap_or_default();
    let names = [format!("{stem}.toml"), format!("{stem}.mesh.inp"), format!("{stem}.import.csv")];
    let paths = names.each_ref().map(|name| folder.join(name));
    // A robot has no mesh.
    let written: Vec<&PathBuf> = paths.iter().filter(|path| !is_robot(&args.file) || **path != paths[1]).collect();
    if !args.check && !args.force {
        require_new(&written)?;
    }
    let mut imported = read(args, &names[1])?;
    let source = Source::new(args.file.display().to_string(), "", &[]);
    show(&imported.verdicts.said(), &source);
    let refused = refused(&imported, args)?;
    let report = table(&imported.verdicts);
    let unread = unread(&imported.verdicts);
    if args.check {
        print(&format!("{report}{}\n{unread}", summary(args, &imported.verdicts)))?;
        return if refused { Err(Exit::DeckInvalid) } else { Ok(paths[0].clone()) };
    }
    if refused && !args.partial {
        complain(&format!("{}; nothing is written", summary(args, &imported.verdicts)));
        say("  help: --partial writes the deck with the refused lines as comments");
        return Err(Exit::DeckInvalid);
    }
    if refused {
        imported.deck += &comments(&imported.verdicts);
    }
    for (path, text) in paths.iter().zip([&imported.deck, &imported.mesh, &report]) {
        if written.contains(&path) {
            write(path, text)?;
        }
    }
    let written: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
    if refused {
        print(&format!(
            "{}\n{unread}written, incomplete: {}\n",
            summary(args, &imported.verdicts),
            written.join(", ")
        ))?;
        return Err(Exit::DeckInvalid);
    }
    if checks {
        check(&paths[0])?;
    }
    print(&format!("{}\n{unread}written: {}\n", summary(args, &imported.verdicts), written.join(", ")))?;
    Ok(paths[0].clone())
}

/// Imports a file into the folder of results and runs its deck there.
///
/// # Errors
/// Those of [`import`] and of a run.
pub fn import_and_run(args: RunArgs) -> Result<(), Exit> {
    let folder = args.output.clone().unwrap_or_else(|| named_after(&args.deck, "out"));
    if !args.resume {
        require_free(&folder, args.overwrite)?;
    }
    let files = ImportArgs {
        file: args.deck.clone(),
        output: Some(folder.clone()),
        from: args.from,
        strict: false,
        partial: false,
        units: None,
        check: false,
        force: true,
    };
    let deck = write_files(&files, false)?;
    let overwrite = !args.resume;
    run(&RunArgs { deck, output: Some(folder), overwrite, ..args })
}

/// Makes sure that no file is replaced.
fn require_new(paths: &[&PathBuf]) -> Result<(), Exit> {
    match paths.iter().find(|path| path.exists()) {
        None => Ok(()),
        Some(path) => {
            complain(&format!("the file `{}` exists", path.display()));
            say("  help: --force replaces it; -o DIR writes elsewhere");
            Err(Exit::Usage)
        }
    }
}

/// Reads the file with those that it includes, and makes a deck of it.
fn read(args: &ImportArgs, mesh_file: &str) -> Result<Imported, Exit> {
    let path = args.file.display().to_string();
    let bytes = read_regular(&args.file).map_err(|error| {
        complain(&format!("cannot read `{path}`: {error}"));
        Exit::InputOutput
    })?;
    if is_robot(&args.file) {
        let units = args.units.map(|units| units.word().to_owned());
        let text = Text::new(&path, &bytes);
        return Ok(import::import_robot(&text, &ImportOptions { dialect: None, units, mesh_file: String::new() }));
    }
    let folder = args.file.parent().unwrap_or(Path::new(""));
    let whole = Included::new(&path, bytes, &mut |name: &str| read_regular(folder.join(name))).map_err(|fault| {
        show(&[*fault], &Source::new(&*path, "", &[]));
        Exit::InputOutput
    })?;
    let mut text = Text::of_pieces(&path, &whole.bytes, &whole.pieces);
    let dialect = args.from.map(|program| match program {
        ForeignProgram::Abaqus => Dialect::Abaqus,
        ForeignProgram::Calculix => Dialect::Calculix,
    });
    let units = args.units.map(|units| units.word().to_owned());
    Ok(import::import(&mut text, &ImportOptions { dialect, units, mesh_file: mesh_file.to_owned() }))
}

/// True where something is refused: by the importer, by `--strict`, or because elements have no sound shape.
fn refused(imported: &Imported, args: &ImportArgs) -> Result<bool, Exit> {
    let count = |verdict| imported.verdicts.count(verdict);
    if count(KeywordVerdict::Refused) > 0 || args.strict && count(KeywordVerdict::Changed) > 0 {
        return Ok(true);
    }
    if imported.mesh.is_empty() {
        return Ok(false);
    }
    let Err(problems) = model::mesh::read("mesh.inp", imported.mesh.as_bytes()) else { return Ok(false) };
    show(&problems, &Source::new("mesh.inp", "", &[]));
    complain(&format!("the mesh of `{}` has {}", args.file.display(), counted(problems.len(), "error")));
    Err(Exit::DeckInvalid)
}

/// Counts of verdicts.
fn summary(args: &ImportArgs, verdicts: &Verdicts) -> String {
    let counts = KeywordVerdict::ALL.iter().map(|verdict| (verdicts.count(*verdict), verdict.word()));
    let counts: Vec<String> =
        counts.filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}")).collect();
    format!("{}: {}", args.file.display(), if counts.is_empty() { "no keyword".to_owned() } else { counts.join(", ") })
}

/// The line of harmless parameters that nothing has read, if there are any.
fn unread(verdicts: &Verdicts) -> String {
    let names: Vec<&str> = verdicts.unread.iter().map(String::as_str).collect();
    if names.is_empty() { String::new() } else { format!("not read, without effect: {}\n", names.join(", ")) }
}

/// The report as a table of commas.
fn table(verdicts: &Verdicts) -> String {
    let mut table = String::from("file,line,keyword,verdict,text\n");
    let field = |text: &str| match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    };
    for row in &verdicts.rows {
        let _ = writeln!(
            table,
            "{},{},{},{},{}",
            field(&row.file),
            row.file_line,
            field(&row.keyword),
            row.verdict.word(),
            field(&row.text)
        );
    }
    table
}

/// Refused lines as comments of a deck.
fn comments(verdicts: &Verdicts) -> String {
    let mut comments = String::from("\n# REFUSED\n");
    for row in verdicts.rows.iter().filter(|row| row.verdict == KeywordVerdict::Refused) {
        let _ = writeln!(
            comments,
            "# {}:{} {}: {}",
            row.file,
            row.file_line,
            row.keyword,
            row.text.replace(char::is_control, " ")
        );
    }
    comments
}

fn write(path: &Path, text: &str) -> Result<(), Exit> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let made = folder.map_or(Ok(()), std::fs::create_dir_all);
    made.and_then(|()| std::fs::write(path, text)).map_err(|error| {
        complain(&format!("cannot write `{}`: {error}", path.display()));
        Exit::InputOutput
    })
}

/// Makes sure that the deck can be run. One with values that no deck has stays, for messages show its lines, below those of the file.
fn check(deck: &Path) -> Result<(), Exit> {
    let checked = load(deck, &[], Vec::new()).and_then(|mut loaded| plan(&mut loaded, 1));
    if checked.is_err() {
        say(&format!(
            "  help: comments above the tables of `{}` name their lines in the file; --force replaces the deck",
            deck.display()
        ));
    }
    checked.map(drop)
}
