//! What people wrote: inclusions, decks, commands and links of all pages.

use super::{anchor, blocks, keep, pages, rdsolve, read, root};
use rdsolve::diagnostic::Source;
use rdsolve::{deck, model, sweep};
use serde_json::Value;
use std::fs;

/// `PATH`, or `PATH | FIRST | LAST`.
fn included(what: &str) -> String {
    let parts: Vec<&str> = what.split(" | ").collect();
    let text = read(&root().join(parts[0]));
    let lines: Vec<&str> = text.lines().collect();
    let find = |from: usize, words: &str| {
        let at = lines[from..].iter().position(|line| line.starts_with(words));
        from + at.unwrap_or_else(|| panic!("no line of {} begins with `{words}`", parts[0]))
    };
    let chosen = match parts[..] {
        [_, first, last] => {
            let from = find(0, first);
            &lines[from..=find(from, last)]
        }
        _ => &lines[..],
    };
    chosen.join("\n")
}

fn with_inclusions(page: &str) -> String {
    let mut lines = page.lines();
    let mut out = String::new();
    while let Some(line) = lines.next() {
        out += &format!("{line}\n");
        if let Some(what) = line.strip_prefix("<!-- include ").and_then(|rest| rest.strip_suffix(" -->")) {
            let fence = lines.next().unwrap_or_default();
            assert!(fence.starts_with("```"), "a block follows `{line}`");
            let _old: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
            out += &format!("{fence}\n{}\n```\n", included(what));
        }
    }
    out
}

#[test]
fn docs_include_what_is_in_the_decks() {
    for page in pages() {
        let (name, text) = (page.strip_prefix(root()).unwrap().to_str().unwrap().to_owned(), read(&page));
        if text.contains("\n<!-- include ") {
            keep(&name, &with_inclusions(&text));
        }
    }
}

/// Whole decks are sound; of a part of one much is missing, but no key and no word is wrong.
#[test]
fn docs_speak_the_words_of_the_deck() {
    for page in pages() {
        let blocks = blocks(&read(&page)).into_iter().filter(|block| block.language == "toml");
        for block in blocks.filter(|block| !block.before.starts_with("<!-- include")) {
            let source = Source::new(page.display().to_string(), block.text.as_str(), &[]);
            let is_whole = block.text.contains("[analysis]") || block.text.contains("analysis = {");
            let problems = match () {
                () if block.text.starts_with("# sweep.toml") => sweep::file::read(&source).1,
                () if is_whole => model::read(&source).1,
                () => deck::read(&source).1,
            };
            let errors: Vec<String> =
                problems.iter().filter(|p| p.is_error()).map(|p| p.draw(&source, false)).collect();
            assert!(errors.is_empty(), "{}", errors.join("\n"));
        }
    }
}

#[test]
fn the_deck_of_the_readme_meets_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let readme = read(&root().join("README.md"));
    let deck = blocks(&readme).into_iter().find(|b| b.language == "toml" && b.text.contains("analysis"));
    let path = folder.path().join("readme.toml");
    fs::write(&path, deck.expect("a deck").text).unwrap();
    let out = folder.path().join("out");
    rdsolve(&[path.to_str().unwrap(), "-o", out.to_str().unwrap(), "--quiet"]).assert().code(0);
    let result: Value = serde_json::from_str(&read(&out.join("result.json"))).unwrap();
    assert!(!result["expectations"].as_array().unwrap().is_empty());
}

/// Names of the decks of the tutorial; `decks` runs them.
pub fn tutorial() -> Vec<String> {
    let files = fs::read_dir(root().join("decks/tutorial")).expect("decks").map(|entry| entry.unwrap().path());
    let decks = files.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let mut names: Vec<String> = decks.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    names.sort();
    names
}

#[test]
fn the_tutorial_has_a_task_for_each_of_its_decks() {
    let page = read(&root().join("docs/tutorial.md"));
    let tasks = page.lines().filter(|line| line.starts_with("## ")).count();
    assert_eq!(tasks, tutorial().len());
    for name in tutorial() {
        assert!(page.contains(&format!("`decks/tutorial/{name}.toml`")), "the tutorial does not name {name}");
    }
}

/// Words of a command line, with quotes.
fn words(line: &str) -> Vec<String> {
    let (mut found, mut word, mut quote): (Vec<String>, String, Option<char>) = (Vec::new(), String::new(), None);
    for c in line.chars() {
        match (quote, c) {
            (Some(open), _) if c == open => quote = None,
            (None, '\'' | '"') => quote = Some(c),
            (None, ' ') => found.extend((!word.is_empty()).then(|| std::mem::take(&mut word))),
            _ => word.push(c),
        }
    }
    found.extend((!word.is_empty()).then_some(word));
    found
}

#[test]
fn docs_show_commands_that_exist() {
    for page in pages() {
        for block in blocks(&read(&page)).iter().filter(|block| block.language == "sh") {
            for line in block.text.lines().map(str::trim).filter(|line| line.starts_with("rdsolve ")) {
                let line = line.split("  #").next().unwrap();
                let words = words(line);
                let deck = words.iter().find(|word| word.ends_with(".toml") && word.contains('/'));
                assert!(deck.is_none_or(|deck| root().join(deck).exists()), "{}: {line}", page.display());
                // Overrides are tried by `check` on the deck.
                let known = rdsolve(&[&words[1], "--help"]).output().unwrap().status.success();
                assert!(known, "{}: {line}", page.display());
                let sets = words.windows(2).filter(|pair| pair[0] == "--set" && !pair[1].contains('$'));
                let mut arguments = vec!["check".to_owned()];
                arguments.extend(sets.flat_map(|pair| pair.to_vec()));
                if let Some(deck) = deck {
                    arguments.push(deck.clone());
                    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
                    rdsolve(&arguments).assert().code(0);
                }
            }
        }
    }
}

/// Options in backticks, alone or behind `rdsolve`, with the help of all commands.
#[test]
fn docs_name_options_that_exist() {
    let commands = [
        "run",
        "check",
        "import",
        "report",
        "compare",
        "study",
        "recommend",
        "sweep",
        "summary",
        "schema",
        "init",
        "completions",
    ];
    let help = |command: &&str| rdsolve(&[command, "--help"]).output().unwrap().stdout;
    let known: Vec<u8> = commands.iter().flat_map(help).collect();
    let known = String::from_utf8(known).unwrap();
    for page in pages().iter().filter(|page| !page.ends_with("CHANGELOG.md")) {
        let text = blocks(&read(page)).iter().fold(read(page), |text, block| text.replace(&block.text, ""));
        for code in
            text.split('`').skip(1).step_by(2).filter(|code| code.starts_with("--") || code.starts_with("rdsolve "))
        {
            for option in code.split(' ').filter(|word| word.starts_with("--") && !word.contains(':')) {
                let name = option.split('=').next().unwrap();
                let exists = name.starts_with("--version") || known.split([' ', ',', '\n']).any(|word| word == name);
                assert!(exists, "{}: no command has `{option}`", page.display());
            }
        }
    }
}

#[test]
fn links_of_docs_lead_somewhere() {
    for page in pages() {
        let text = read(&page);
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.starts_with("http") {
                continue;
            }
            let (file, fragment) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { page.parent().unwrap().join(file) };
            assert!(target.exists(), "{}: {link}", page.display());
            if !fragment.is_empty() {
                let headings = read(&target);
                let known = headings
                    .lines()
                    .filter(|line| line.starts_with('#'))
                    .any(|line| anchor(line.trim_start_matches('#')) == fragment);
                assert!(known, "{}: no heading for {link}", page.display());
            }
        }
    }
}
