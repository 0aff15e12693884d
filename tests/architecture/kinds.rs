//! One more of a kind is one file and one line: a kind is used by the file that lists it alone, and its word stands in its own
//! file. The parts a model is made of are known to few files besides their own.

use super::ratchet::{Known, compare};
use super::source::{File, Source};
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};

/// Kinds of parts, and by how many files besides their own they may be named.
const PARTS: [&str; 5] = ["Beam", "Bar", "Shell", "Link", "Contact"];
const STRANGERS: usize = 6;

/// Kinds of parts that more files name: stresses and loads at a place are those of beams alone, foundations lie under beams and shells.
const WELL_KNOWN: Known = &[("Beam", 11), ("Contact", 7), ("Shell", 7)];

/// Folders in which each file is a kind of its own, and what else stands there.
const CATALOGUES: [(&str, &[&str]); 7] = [
    ("mechanics/constraints/joints", &["kind"]),
    ("mechanics/elements/contact/surfaces", &["kind", "sight"]),
    (
        "mechanics/integrators",
        &[
            "alpha_family",
            "coefficients",
            "load_steps",
            "scheme",
            "spectrum",
            "stability_limit",
            "stage_tableau",
            "tableau",
        ],
    ),
    ("mechanics/materials/models", &["kind"]),
    ("results/tables", &["shell_order"]),
    (
        "mechanics/sections",
        &[
            "dimensions",
            "fibres",
            "matrices",
            "profile",
            "rounded",
            "section",
            "section_shape",
            "section_triangle",
            "stresses",
            "wall",
        ],
    ),
    ("mechanics/solids", &["element_faces", "hollow", "hull_points", "kind", "outline", "segment"]),
];

/// Kinds that more than one file besides their own knows: a circle is a tube without a hole.
const LISTED_OFTEN: Known = &[("mechanics/sections/tube.rs", 2)];

pub fn parts_are_known_to_few(source: &Source) {
    let named: Vec<(&File, BTreeSet<String>)> = source.files.iter().map(|file| (file, tokens(file))).collect();
    let mut found = BTreeMap::new();
    for part in PARTS {
        let home = part.to_lowercase();
        // The importer knows the kinds of other programs, and writes the words of the deck.
        let at_home = |path: &str| {
            path.starts_with("import/") || path.split(['/', '_', '.']).any(|word| word.trim_end_matches('s') == home)
        };
        let strange = named.iter().filter(|(file, named)| named.contains(part) && !at_home(&file.path));
        let strangers: Vec<&str> = strange.map(|(file, _)| file.path.as_str()).collect();
        println!("{part}: {} files: {}", strangers.len(), strangers.join(", "));
        if strangers.len() > STRANGERS {
            found.insert(part.to_string(), strangers.len());
        }
    }
    compare("files besides their own that name a kind of part", WELL_KNOWN, &found);
}

pub fn kinds_are_listed_once(source: &Source) {
    let named: Vec<BTreeSet<String>> = source.files.iter().map(tokens).collect();
    let used: Vec<_> = (0..source.files.len()).map(|file| source.uses(file)).collect();
    let mut found = BTreeMap::new();
    for (folder, others) in CATALOGUES {
        for (own, kind) in source.files.iter().enumerate() {
            let Some((_, stem)) = kind.path.trim_end_matches(".rs").rsplit_once('/') else { continue };
            if !kind.path.starts_with(&format!("{folder}/{stem}.")) || stem == "mod" || others.contains(&stem) {
                continue;
            }
            let word = format!("\"{}\"", stem.replace('_', "-"));
            let knows = |&file: &usize| {
                // A word of one part may be a word of the deck elsewhere: `fixed`, `general`.
                let says = word.contains('-') && named[file].contains(&word);
                let is_writer = source.files[file].path.starts_with("import/");
                file != own && !is_writer && (says || used[file].contains_key(&own))
            };
            let files: Vec<&str> =
                (0..source.files.len()).filter(knows).map(|file| source.files[file].path.as_str()).collect();
            println!("{}: {}", kind.path, files.join(", "));
            if files.len() > 1 {
                found.insert(kind.path.clone(), files.len());
            }
        }
    }
    compare("files besides its own that know a kind", LISTED_OFTEN, &found);
}

/// Identifiers and literals of a file.
fn tokens(file: &File) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for item in &file.items {
        each(item.to_token_stream(), &mut |token| {
            found.insert(token.to_string());
        });
    }
    found
}

fn each(tokens: TokenStream, see: &mut impl FnMut(&TokenTree)) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => each(group.stream(), see),
            token => see(&token),
        }
    }
}
