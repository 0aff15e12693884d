//! `rdsolve recommend deck.toml`: prints the deck with the settings chosen for `accuracy`. The new deck needs no pilot runs.

use super::accuracy::settle;
use super::arguments::MAX_THREADS;
use super::console::{complain, print, say, show};
use super::exit::Exit;
use super::load::load;
use super::signals::EndAtOnce;
use super::written_deck::with_entries;
use base::diagnostic::Diagnostic;
use clap::Args;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

#[derive(Debug, Args)]
#[command(
    after_help = "Standard output has the deck, standard error the estimated errors. Paths of meshes and records stay as they are: keep \
the new deck in the folder of the old one.

Exit codes: 0 done, 2 usage, 3 deck invalid, 6 input/output."
)]
pub struct RecommendArgs {
    /// The deck, a TOML file; - is standard input
    deck: PathBuf,
    /// Error asked for, relative to the largest change of each result [default: `accuracy` of the deck]
    #[arg(long, value_name = "ERROR", value_parser = between_0_and_1)]
    accuracy: Option<f64>,
    /// Override one entry of the deck, as for `run`; repeatable. The new deck has it written out
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Threads to use, from 1 to 64; the settings do not depend on it
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=MAX_THREADS))]
    threads: u8,
    /// Show errors only
    #[arg(long)]
    quiet: bool,
}

/// Reads an error for clap.
fn between_0_and_1(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number < 1.0 => Ok(number),
        _ => Err("a number between 0 and 1 is wanted".to_owned()),
    }
}

/// Chooses the settings and prints the deck with them.
///
/// # Errors
/// The exit code; the reason has been shown.
pub fn recommend(args: &RecommendArgs) -> Result<(), Exit> {
    let _ends = EndAtOnce::on_signals();
    let given = load(&args.deck, &args.sets, Vec::new())?;
    let loaded = match args.accuracy {
        Some(accuracy) => {
            let automatic = given.model.analysis.is_dynamic().then(|| "analysis.time_step=\"auto\"".to_owned());
            let asked = [format!("analysis.accuracy={accuracy:e}")].into_iter().chain(automatic);
            load(&args.deck, &asked.chain(args.sets.iter().cloned()).collect::<Vec<_>>(), Vec::new())?
        }
        None => given,
    };
    let own: Vec<String> = loaded.source.sets.iter().map(|(_, set)| set.clone()).collect();
    let text = loaded.source.text.clone();
    if !args.quiet {
        show(&loaded.warnings, &loaded.source);
    }
    let (settled, chosen) =
        settle(loaded, usize::from(args.threads), &AtomicBool::new(false)).map_err(|(problems, source)| {
            show(&problems, &source);
            Exit::DeckInvalid
        })?;
    let Some(chosen) = chosen else {
        complain("the deck has no `accuracy`\n  help: give --accuracy 1e-3, or `accuracy` in [analysis]");
        return Err(Exit::Usage);
    };
    let warnings = chosen.warnings(None);
    warnings.iter().for_each(|warning| show(&[Diagnostic::warning(warning.as_str())], &settled.source));
    let lines = chosen.lines();
    let entries: Vec<String> =
        own.into_iter().filter(|set| !set.starts_with("analysis.accuracy")).chain(chosen.report.settings).collect();
    let Some(written) = with_entries(&text, &entries, "analysis.accuracy") else {
        let sets: String = entries.iter().map(|entry| format!(" --set '{entry}'")).collect();
        complain(&format!(
            "the settings cannot be written into the text of this deck, whose tables stand in single lines\n  help: remove `accuracy` \
             from it, then rdsolve run {}{sets}",
            args.deck.display()
        ));
        return Err(Exit::DeckInvalid);
    };
    if !args.quiet {
        lines.iter().for_each(|line| say(line));
    }
    print(&format!("# rdsolve recommend: {}\n{written}", lines[0]))
}
