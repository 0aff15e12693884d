//! One more of a kind is one file and one line: the name of a kind stands in its own file and in the line that lists it, and
//! the parts a model is made of are known to few files besides their own.

use super::ratchet::{Known, compare};
use super::source::{File, Source};
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};

/// Kinds of parts, and by how many files besides their own they are spoken of.
const PARTS: [&str; 5] = ["beam", "bar", "shell", "link", "contact"];
const STRANGERS: usize = 6;

/// Kinds of parts that more files speak of.
const WELL_KNOWN: Known = &[("bar", 30), ("beam", 28), ("contact", 33), ("link", 29), ("shell", 36)];

/// Folders in which each file is a kind of its own, and what else stands there.
const CATALOGUES: [(&str, &[&str]); 1] = [("integrators", &["load_steps", "spectrum"])];

/// Kinds whose names stand in more than one line besides their file.
const LISTED_OFTEN: Known = &[
    ("bathe", 2),
    ("central_difference", 7),
    ("coefficients", 78),
    ("generalized_alpha", 7),
    ("hht_alpha", 2),
    ("newmark", 6),
    ("runge_kutta", 11),
    ("scheme", 218),
    ("tableau", 31),
    ("wilson_theta", 3),
];

#[test]
fn parts_are_known_to_few() {
    let source = Source::read();
    let spoken: Vec<(&File, BTreeSet<String>)> = source.files.iter().map(|file| (file, file_words(file))).collect();
    let mut found = BTreeMap::new();
    for part in PARTS {
        let strange = spoken.iter().filter(|(file, spoken)| spoken.contains(part) && !words(&file.path).contains(part));
        let strangers: Vec<&str> = strange.map(|(file, _)| file.path.as_str()).collect();
        println!("{part}: {} files: {strangers:?}", strangers.len());
        if strangers.len() > STRANGERS {
            found.insert(part.to_string(), strangers.len());
        }
    }
    compare("files besides their own that speak of a kind of part", WELL_KNOWN, &found);
}

#[test]
fn names_of_kinds_stand_in_one_line() {
    let source = Source::read();
    let mut found = BTreeMap::new();
    for (folder, others) in CATALOGUES {
        for kind in source.files.iter().filter(|file| file.path.starts_with(&format!("{folder}/"))) {
            let stem = kind.module.last().expect("a name");
            if kind.path.ends_with("/mod.rs") || others.contains(&stem.as_str()) {
                continue;
            }
            let lines: BTreeSet<String> = source
                .files
                .iter()
                .filter(|file| file.path != kind.path)
                .flat_map(|file| mentions(file, stem))
                .collect();
            println!("{stem}: {lines:?}");
            if lines.len() > 1 {
                found.insert(stem.clone(), lines.len());
            }
        }
    }
    compare("lines that name a kind, besides its file", LISTED_OFTEN, &found);
}

/// Lines of a file that name a kind as a module, a type or a word of the deck; its `mod` line is none.
fn mentions(file: &File, stem: &str) -> Vec<String> {
    let type_name: String = stem
        .split('_')
        .map(|word| {
            let mut letters = word.chars();
            letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect::<String>()
        })
        .collect();
    let word = format!("\"{}\"", stem.replace('_', "-"));
    let mut lines = BTreeSet::new();
    for item in file.items.iter().filter(|item| !matches!(item, syn::Item::Mod(_))) {
        each(item.to_token_stream(), &mut |token| {
            let text = token.to_string();
            if text == stem || text == type_name || text == word {
                lines.insert(token.span().start().line);
            }
        });
    }
    lines.into_iter().map(|line| format!("{}:{line}", file.path)).collect()
}

/// Words of all identifiers of a file, in the singular.
fn file_words(file: &File) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for item in &file.items {
        each(item.to_token_stream(), &mut |token| {
            if let TokenTree::Ident(name) = token {
                found.append(&mut words(&name.to_string()));
            }
        });
    }
    found
}

/// `ShellState` and `shell_states` are made of `shell` and `state`.
fn words(text: &str) -> BTreeSet<String> {
    let mut spaced = String::new();
    for letter in text.chars() {
        if letter.is_uppercase() {
            spaced.push(' ');
        }
        spaced.extend(letter.to_lowercase());
    }
    let words = spaced.split(|letter: char| !letter.is_alphanumeric());
    words.map(|word| word.strip_suffix('s').unwrap_or(word).to_string()).collect()
}

fn each(tokens: TokenStream, see: &mut impl FnMut(&TokenTree)) {
    for token in tokens {
        see(&token);
        if let TokenTree::Group(group) = token {
            each(group.stream(), see);
        }
    }
}
