//! Verdicts: what became of each keyword of a file.

use base::diagnostic::{Diagnostic, Severity};
use base::text_file::{Fault, Text, Word};
use std::collections::{BTreeSet, HashMap, HashSet};

/// The verdict on a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum KeywordVerdict {
    /// The deck says the same.
    Translated,
    /// It does not act on the motion: output and settings of the solver.
    Ignored,
    /// The deck computes it otherwise.
    Changed,
    /// The deck cannot say it.
    Refused,
}

impl KeywordVerdict {
    /// All verdicts in the order of the summary.
    pub const ALL: [KeywordVerdict; 4] =
        [KeywordVerdict::Translated, KeywordVerdict::Changed, KeywordVerdict::Ignored, KeywordVerdict::Refused];

    /// The word in the report.
    pub fn word(self) -> &'static str {
        match self {
            KeywordVerdict::Translated => "translated",
            KeywordVerdict::Ignored => "ignored",
            KeywordVerdict::Changed => "changed",
            KeywordVerdict::Refused => "refused",
        }
    }
}

/// One line of the report.
#[derive(Debug)]
pub struct VerdictRow {
    /// The path of the file.
    pub file: String,
    /// The line in that file, counted from 1.
    pub file_line: usize,
    /// The line in the text with all included files.
    pub line: usize,
    /// The keyword that the line belongs to, with its asterisk, or the element of XML.
    pub keyword: String,
    /// The verdict.
    pub verdict: KeywordVerdict,
    /// Its counterpart in the deck, or the reason of the refusal.
    pub text: String,
    /// The message with the line, for changed or refused lines.
    pub said: Option<Fault>,
}

/// The verdicts so far.
#[derive(Debug, Default)]
pub struct Verdicts {
    /// Line and name of every keyword or element, ascending.
    pub(crate) keywords: Vec<(usize, String)>,
    /// All rows, as they were found.
    pub rows: Vec<VerdictRow>,
    /// Harmless parameters that nothing has read: "INC of *STEP".
    pub unread: BTreeSet<String>,
    /// What has been said of each keyword.
    known: HashSet<(Option<usize>, KeywordVerdict, String)>,
    /// The keywords with a verdict.
    judged: HashSet<Option<usize>>,
    /// Those that are refused.
    refused: HashSet<Option<usize>>,
    /// Lines that form one load with an earlier line, by the place of that line. They take its later verdicts.
    joined: HashMap<usize, Vec<usize>>,
}

impl Verdicts {
    /// No verdicts yet on keywords at these lines.
    pub fn new(keywords: Vec<(usize, String)>) -> Self {
        Verdicts { keywords, ..Verdicts::default() }
    }

    /// The keyword that a line belongs to: its place in the list.
    fn keyword(&self, line: usize) -> Option<usize> {
        self.keywords.partition_point(|(first, _)| *first <= line).checked_sub(1)
    }

    /// Makes a line share the verdicts on another.
    pub fn join(&mut self, first: usize, line: usize) {
        self.joined.entry(first).or_default().push(line);
    }

    /// Adds a verdict on a line, and on those joined with it.
    pub fn add(&mut self, text: &Text, verdict: KeywordVerdict, line: usize, said: Option<Fault>, about: String) {
        let joined = self.joined.get(&line).cloned().unwrap_or_default();
        joined.into_iter().for_each(|other| self.add_one(text, verdict, other, None, about.clone()));
        self.add_one(text, verdict, line, said, about);
    }

    /// Adds a verdict on a line. One sentence about several lines of a keyword is reported once.
    fn add_one(&mut self, text: &Text, verdict: KeywordVerdict, line: usize, said: Option<Fault>, about: String) {
        let of = self.keyword(line);
        if !self.known.insert((of, verdict, about.clone())) {
            return;
        }
        self.judged.insert(of);
        if verdict == KeywordVerdict::Refused {
            self.refused.insert(of);
        }
        let keyword = of.map_or_else(String::new, |of| self.keywords[of].1.clone());
        let (file, file_line) = text.origin(line);
        let severe = verdict >= KeywordVerdict::Changed;
        let said = severe.then(|| said.unwrap_or_else(|| text.fault(&*about, line))).map(|mut said| {
            if verdict == KeywordVerdict::Changed {
                said.severity = Severity::Warning;
            } else if said.hints.is_empty() {
                said.hints.push("remove it, or import with --partial".to_owned());
            }
            said
        });
        self.rows.push(VerdictRow { file: file.to_owned(), file_line, line, keyword, verdict, text: about, said });
    }

    /// Adds a verdict at a word.
    pub fn at(&mut self, text: &Text, verdict: KeywordVerdict, word: &Word, about: String) {
        let said = text.fault_at(&*about, word);
        self.add(text, verdict, word.line, Some(said), about);
    }

    /// True where a keyword has a verdict already; `line`: its own.
    pub fn has(&self, line: usize) -> bool {
        self.judged.contains(&self.keyword(line))
    }

    /// True where a keyword is refused; `line`: its own.
    pub fn is_refused(&self, line: usize) -> bool {
        self.refused.contains(&self.keyword(line))
    }

    /// The number of rows with a verdict.
    pub fn count(&self, verdict: KeywordVerdict) -> usize {
        self.rows.iter().filter(|row| row.verdict == verdict).count()
    }

    /// The messages about changed and refused lines, in the order of the file.
    pub fn said(&self) -> Vec<Diagnostic> {
        self.rows.iter().filter_map(|row| row.said.as_deref().cloned()).collect()
    }
}
