//! Sentences of pages, comments and messages stay short and direct.

use super::{pages, read, root};
use std::path::{Path, PathBuf};

/// Most words of a sentence.
const LONG: usize = 28;
/// Openings that replace the name of a thing.
const OPENINGS: [&str; 8] = ["What ", "Those ", "That of ", "Nor ", "So are ", "So is ", "As is ", "As are "];
/// Turns that replace a subject, a verb or a quantity.
const TURNS: [&str; 14] = [
    " is told",
    " are told",
    " is had",
    " is borne",
    " of which",
    " by which",
    " for which",
    " in which",
    " what is ",
    " what it ",
    " what the ",
    " what a ",
    " by itself",
    " at hand",
];
/// Largest share of flagged sentences in pages, in per cent: the level reached.
const PAGES: usize = 3;
/// Largest share of flagged sentences in comments, in per cent: the level reached.
const CODE: usize = 3;

/// Largest share of flagged sentences in messages, in per cent: the level reached.
const MESSAGES: usize = 2;

/// Paragraphs of prose: lines of a page outside of code, tables and headings, with list items on their own.
fn paragraphs(lines: impl Iterator<Item = String>) -> Vec<String> {
    let (mut found, mut run, mut is_code) = (Vec::new(), String::new(), false);
    let mut close = |run: &mut String| {
        if !run.is_empty() {
            found.push(std::mem::take(run));
        }
    };
    for line in lines.chain([String::new()]) {
        let text = line.trim();
        let fence = text.starts_with("```");
        is_code ^= fence;
        let is_prose =
            !is_code && !fence && !text.is_empty() && !text.starts_with(['|', '#', '<']) && !text.starts_with("![");
        let item = text.strip_prefix("- ").or_else(|| text.strip_prefix("* "));
        if !is_prose || item.is_some() {
            close(&mut run);
        }
        if is_prose {
            run.push(' ');
            run += item.unwrap_or(text);
        }
    }
    found
}

/// The comment of a source line without its slashes; empty for a line of code.
fn comment(line: &str) -> String {
    let text = line.trim_start();
    let body = text.strip_prefix("//").map(|rest| rest.trim_start_matches(['/', '!']));
    body.unwrap_or_default().trim().to_owned()
}

/// A source without comments, each string literal on one line.
fn joined(source: &str) -> String {
    let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    code.fold(String::new(), |all, line| match all.strip_suffix('\\') {
        Some(start) => start.to_owned() + line.trim_start(),
        None => all + "\n" + line,
    })
}

/// Texts of messages in a source: string literals of three words or more, with values as one word.
fn messages(source: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in joined(source).lines() {
        // Every second part lies within quotes.
        let parts = line.replace("\\\"", "`").replace("\\n", " ");
        found.extend(parts.split('"').skip(1).step_by(2).map(values_as_words));
    }
    found.retain(|text| text.split_whitespace().filter(|word| word.chars().all(char::is_alphabetic)).count() > 3);
    found
}

/// The text with `CODE` in place of what is written in braces.
fn values_as_words(text: &str) -> String {
    let mut parts = text.split('{');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |all, part| all + "CODE" + part.split_once('}').map_or("", |(_, rest)| rest))
}

/// Sentences of at least five words; code in backticks counts as one word.
fn sentences(paragraph: &str) -> Vec<String> {
    let plain: Vec<&str> = paragraph.split('`').collect();
    let text: String = plain.iter().enumerate().map(|(k, part)| if k % 2 == 1 { "CODE" } else { part }).collect();
    let (mut found, mut start) = (Vec::new(), 0);
    let bytes = text.as_bytes();
    for at in 1..text.len().saturating_sub(2) {
        let ends = b".!?".contains(&bytes[at]) && bytes[at + 1] == b' ';
        let before =
            bytes[at - 1].is_ascii_lowercase() || bytes[at - 1].is_ascii_digit() || b")E]".contains(&bytes[at - 1]);
        if ends && before && (bytes[at + 2].is_ascii_uppercase() || bytes[at + 2] == b'(') {
            found.push(text[start..=at].trim().to_owned());
            start = at + 1;
        }
    }
    found.push(text[start..].trim().to_owned());
    found.retain(|sentence| sentence.split_whitespace().count() >= 5);
    found
}

fn is_flagged(sentence: &str) -> bool {
    let clauses = ["which", "whose", "where", "what", "that"];
    let words = || sentence.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    sentence.split_whitespace().count() > LONG
        || words().filter(|word| clauses.contains(&word.to_lowercase().as_str())).count() > 1
        || OPENINGS.iter().any(|opening| sentence.starts_with(opening))
        || TURNS.iter().any(|turn| sentence.contains(turn))
        || sentence.matches("; ").count() > 1
}

/// Fails if more than `limit` per cent of the sentences are flagged, with the worst places.
fn hold(texts: Vec<(PathBuf, Vec<String>)>, limit: usize) {
    let (mut all, mut flagged) = (0, Vec::new());
    for (path, paragraphs) in texts {
        for sentence in paragraphs.iter().flat_map(|paragraph| sentences(paragraph)) {
            all += 1;
            if is_flagged(&sentence) {
                flagged.push(format!("{}: {sentence}", path.display()));
            }
        }
    }
    flagged.sort_by_key(|line| std::cmp::Reverse(line.len()));
    let share = 100.0 * flagged.len() as f64 / all as f64;
    let worst = flagged[..flagged.len().min(10)].join("\n");
    assert!(
        share <= limit as f64,
        "{share:.1} % of {all} sentences are long or indirect, and {limit} are allowed:\n{worst}"
    );
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            sources(&entry, found);
        } else if entry.extension().is_some_and(|e| e == "rs") {
            found.push(entry);
        }
    }
}

#[test]
fn sentences_of_pages_are_short_and_direct() {
    let pages = pages().into_iter().filter(|path| !path.ends_with("CHANGELOG.md"));
    hold(pages.map(|path| (path.clone(), paragraphs(read(&path).lines().map(str::to_owned)))).collect(), PAGES);
}

#[test]
fn sentences_of_comments_are_short_and_direct() {
    let mut files = Vec::new();
    sources(&root().join("src"), &mut files);
    hold(files.into_iter().map(|path| (path.clone(), paragraphs(read(&path).lines().map(comment)))).collect(), CODE);
}

#[test]
fn sentences_of_messages_are_short_and_direct() {
    let mut files = Vec::new();
    sources(&root().join("src"), &mut files);
    hold(files.into_iter().map(|path| (path.clone(), messages(&read(&path)))).collect(), MESSAGES);
}

/// The page of messages quotes words that the program says; `...` stands for values.
#[test]
fn quoted_messages_are_those_of_the_program() {
    let mut files = Vec::new();
    sources(&root().join("src"), &mut files);
    let said: String = files.iter().map(|path| joined(&read(path)).replace("\\\"", "\"")).collect();
    let page = read(&root().join("docs/messages.md"));
    let rows = page.lines().filter(|line| line.starts_with("| *"));
    let first = rows.map(|row| row.split(" | ").next().unwrap_or_default().replace("**", "*"));
    let quotes: Vec<String> =
        first.flat_map(|cell| cell.split('*').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()).collect();
    let pieces = quotes.iter().flat_map(|quote| quote.split("...")).map(|piece| piece.trim_matches([' ', ',', '|']));
    let pieces: Vec<&str> = pieces.filter(|piece| piece.split(' ').count() > 1).collect();
    assert!(pieces.len() > 25, "{pieces:?}");
    for piece in pieces {
        assert!(said.contains(piece), "no message says: {piece}");
    }
}
