//! Which of the programs of a release runs. A release is a folder with the program built for several levels of instructions, named
//! `rdsolve` (any processor), `rdsolve-x86-64-v3` and `rdsolve-x86-64-v4`. The first program replaces itself by the best one beside it for
//! this processor, or by the requested one. Process, arguments and open files stay. A single program, the result of a build, runs itself.

use super::console::{complain, show_json};
use super::exit::Exit;
use super::processor::Level;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use study::INSTRUCTIONS;

/// The option for a level.
const OPTION: &str = "--instructions";

/// The programs that there are, and the processor.
#[derive(Debug)]
struct Installation {
    /// The path of the program that runs.
    path: PathBuf,
    /// The level that it was built for.
    own: Level,
    /// The level that the name of its file says.
    named: Option<Level>,
    /// The other levels that are there, each with the path of its program.
    beside: Vec<(Level, PathBuf)>,
    /// The highest level that the processor has.
    processor: Level,
}

impl Installation {
    /// The programs beside this one; `None` if its path or the levels are unknown.
    fn here() -> Option<Installation> {
        let path = std::env::current_exe().ok()?;
        Installation::at(path, Level::BUILT_FOR?, Level::of_processor(), |path| path.is_file())
    }

    /// The programs beside a program.
    fn at(path: PathBuf, own: Level, processor: Level, exists: impl Fn(&Path) -> bool) -> Option<Installation> {
        let name = path.file_name()?.to_str()?.to_owned();
        let suffix = |level: Level| format!("-{}", level.name());
        let (stem, named) = Level::ALL
            .into_iter()
            .find_map(|level| Some((name.strip_suffix(&suffix(level))?, Some(level))))
            .unwrap_or((&name, None));
        let of = |level: Level| {
            let of_its_name = path.with_file_name(format!("{stem}{}", suffix(level)));
            // The one for any processor has the plain name.
            let plain = path.with_file_name(stem);
            let found =
                [of_its_name, plain].into_iter().take(if level == Level::Any && named.is_some() { 2 } else { 1 });
            found.into_iter().find(|path| exists(path)).map(|path| (level, path))
        };
        let beside = Level::ALL.into_iter().filter(|&level| level != own).filter_map(of).collect();
        Some(Installation { path, own, named, beside, processor })
    }

    /// The program that is to run in place of this one, or `None` for this one itself.
    ///
    /// # Errors
    /// The level that is asked for is not there, or not in the processor, or a file has the name of another level: a message.
    fn choose(&self, wish: Option<Level>) -> Result<Option<&(Level, PathBuf)>, String> {
        if let Some(named) = self.named.filter(|&named| named != self.own) {
            let (path, named, own) = (self.path.display(), named.name(), self.own.name());
            return Err(format!("`{path}` is named after {named}, and was built for {own}"));
        }
        let Some(wish) = wish else {
            let best = self.beside.iter().filter(|(level, _)| *level <= self.processor && *level > self.own);
            return Ok(best.max_by_key(|(level, _)| *level).filter(|_| self.named.is_none()));
        };
        if wish == self.own {
            return Ok(None);
        }
        match self.beside.iter().find(|(level, _)| *level == wish) {
            Some(_) if wish > self.processor => {
                Err(format!("this processor lacks the instructions of {}\n  {}", wish.name(), self.help()))
            }
            None => Err(format!("there is no program for {} in this installation\n  {}", wish.name(), self.help())),
            there => Ok(there),
        }
    }

    /// The levels that can be asked for, the lowest first.
    fn levels(&self) -> Vec<&'static str> {
        let usable = |level: &Level| *level <= self.processor && self.beside.iter().any(|(other, _)| other == level);
        let levels = Level::ALL.into_iter().filter(|level| *level == self.own || usable(level));
        levels.map(Level::name).collect()
    }

    /// The available levels.
    fn help(&self) -> String {
        match &self.levels()[..] {
            [own] => format!("help: there is {own} alone; a release, made by scripts/release, has several"),
            levels => format!("help: there are {}", levels.join(", ")),
        }
    }
}

/// The levels for the option in this installation; `None` if there is only one.
pub fn several() -> Option<Vec<&'static str>> {
    Installation::here().map(|here| here.levels()).filter(|levels| levels.len() > 1)
}

/// Becomes the program that is to run in place of this one, if there is another: it then does not return.
///
/// # Errors
/// [`Exit::Usage`] if the requested level is not available, [`Exit::InputOutput`] if the other program does not start; the reason has been
/// shown.
pub fn settle() -> Result<(), Exit> {
    let refuse = |message: &str, exit: Exit| {
        if std::env::args_os().any(|argument| argument == "--json") {
            show_json();
        }
        complain(message);
        exit
    };
    let wish = wish().map_err(|message| refuse(&message, Exit::Usage))?;
    match Installation::here() {
        Some(here) => match here.choose(wish) {
            Ok(None) => Ok(()),
            Ok(Some((level, path))) => {
                let error = become_program(path, *level);
                Err(refuse(&format!("`{}` does not start: {error}", path.display()), Exit::InputOutput))
            }
            Err(message) => Err(refuse(&message, Exit::Usage)),
        },
        None if wish.is_some_and(|wish| Some(wish) != Level::BUILT_FOR) => {
            let message = format!("{OPTION} has no meaning here: this program knows one set of instructions");
            Err(refuse(&message, Exit::Usage))
        }
        None => Ok(()),
    }
}

/// The level requested by the command line, or else by the environment. Clap reports other words on the command line later.
fn wish() -> Result<Option<Level>, String> {
    if let Some(word) = asked(std::env::args_os().skip(1)) {
        return Ok(level_of(&word));
    }
    let Some(word) = std::env::var_os(INSTRUCTIONS).filter(|word| !word.is_empty()) else {
        return Ok(None);
    };
    level_of(&word).map(Some).ok_or_else(|| {
        let levels = Level::ALL.map(Level::name).join(", ");
        format!("{INSTRUCTIONS}={} names no level of instructions\n  help: there are {levels}", word.display())
    })
}

fn level_of(word: &OsStr) -> Option<Level> {
    Level::ALL.into_iter().find(|level| word == level.name())
}

/// The value of the option among arguments. The arguments are not parsed here, because the other program would parse them again.
fn asked(mut arguments: impl Iterator<Item = OsString>) -> Option<OsString> {
    while let Some(argument) = arguments.next().filter(|argument| argument != "--") {
        if argument == OPTION {
            return arguments.next();
        }
        if let Some(word) = argument.to_str().and_then(|argument| argument.strip_prefix(OPTION)?.strip_prefix('=')) {
            return Some(word.into());
        }
    }
    None
}

/// Becomes the program of a level, with the same arguments and in the same process; returns only on failure. Processes that it starts shall
/// have the same level.
#[cfg(unix)]
fn become_program(path: &Path, level: Level) -> std::io::Error {
    use std::os::unix::process::CommandExt;
    let mut arguments = std::env::args_os();
    let mut command = std::process::Command::new(path);
    if let Some(name) = arguments.next() {
        command.arg0(name);
    }
    command.args(arguments).env(INSTRUCTIONS, level.name()).exec()
}

/// Other systems have no such call.
#[cfg(not(unix))]
fn become_program(_: &Path, _: Level) -> std::io::Error {
    std::io::Error::from(std::io::ErrorKind::Unsupported)
}

#[cfg(test)]
mod tests {
    use super::Level::{Any, V3, V4};
    use super::*;
    use clap::ValueEnum;

    /// A folder with these files and the running one among them.
    fn folder(runs: &str, own: Level, processor: Level, files: &[&str]) -> Installation {
        let exists = |path: &Path| files.iter().any(|file| path == Path::new("/opt").join(file));
        Installation::at(Path::new("/opt").join(runs), own, processor, exists).unwrap()
    }

    fn chosen(installation: &Installation, wish: Option<Level>) -> Result<Option<Level>, String> {
        installation.choose(wish).map(|other| other.map(|(level, _)| *level))
    }

    const RELEASE: [&str; 3] = ["rdsolve", "rdsolve-x86-64-v3", "rdsolve-x86-64-v4"];

    #[test]
    fn the_best_that_the_processor_has_is_chosen() {
        for (processor, best) in [(Any, None), (V3, Some(V3)), (V4, Some(V4))] {
            assert_eq!(chosen(&folder("rdsolve", Any, processor, &RELEASE), None), Ok(best));
        }
        assert_eq!(chosen(&folder("rdsolve", Any, V4, &RELEASE[..2]), None), Ok(Some(V3)));
        // A program alone, and one that was called by its level, run themselves.
        assert_eq!(chosen(&folder("rdsolve", Any, V4, &RELEASE[..1]), None), Ok(None));
        assert_eq!(chosen(&folder("rdsolve", V4, V4, &RELEASE), None), Ok(None));
        assert_eq!(chosen(&folder("rdsolve-x86-64-v3", V3, V4, &RELEASE), None), Ok(None));
    }

    #[test]
    fn a_level_can_be_asked_for() {
        let launcher = folder("rdsolve", Any, V4, &RELEASE);
        for (wish, other) in [(Any, None), (V3, Some(V3)), (V4, Some(V4))] {
            assert_eq!(chosen(&launcher, Some(wish)), Ok(other));
        }
        let third = folder("rdsolve-x86-64-v3", V3, V4, &RELEASE);
        assert_eq!(third.choose(Some(Any)).unwrap().unwrap().1, Path::new("/opt/rdsolve"));
        assert_eq!(chosen(&third, Some(V3)), Ok(None));
        assert_eq!(chosen(&third, Some(V4)), Ok(Some(V4)));
        // A build that has the plain name does not take itself for the program for any processor.
        assert!(chosen(&folder("rdsolve", V4, V4, &RELEASE), Some(Any)).is_err());
    }

    #[test]
    fn what_cannot_be_had_is_told_with_what_there_is() {
        let older = folder("rdsolve", Any, V3, &RELEASE);
        let told = chosen(&older, Some(V4)).unwrap_err();
        assert_eq!(told, "this processor lacks the instructions of x86-64-v4\n  help: there are x86-64, x86-64-v3");
        let alone = folder("rdsolve", V4, V4, &RELEASE[..1]);
        let told = chosen(&alone, Some(V3)).unwrap_err();
        assert!(
            told.starts_with(
                "there is no program for x86-64-v3 in this installation\n  help: there is x86-64-v4 alone"
            )
        );
        let misnamed = folder("rdsolve-x86-64-v3", V4, V4, &RELEASE);
        let told = chosen(&misnamed, None).unwrap_err();
        assert_eq!(told, "`/opt/rdsolve-x86-64-v3` is named after x86-64-v3, and was built for x86-64-v4");
    }

    #[test]
    fn the_option_is_found_among_arguments() {
        let asked = |words: &[&str]| asked(words.iter().map(OsString::from)).and_then(|word| level_of(&word));
        assert_eq!(asked(&["run", "deck.toml", "--instructions", "x86-64-v3"]), Some(V3));
        assert_eq!(asked(&["--instructions=x86-64", "deck.toml"]), Some(Any));
        assert_eq!(asked(&["deck.toml", "--", "--instructions", "x86-64-v3"]), None);
        assert_eq!(asked(&["deck.toml", "--instructions"]), None);
        assert_eq!(asked(&["--instructionsx=x86-64"]), None);
    }

    #[test]
    fn names_are_those_of_the_command_line() {
        for level in Level::ALL {
            assert_eq!(level.to_possible_value().unwrap().get_name(), level.name());
        }
    }
}
