//! A part of the report of a study: a title, a table, and sentences below it; equal on standard output and on the page.

use super::columns::columns;
use results::report::html::{self, escaped};

/// A titled table with notes.
pub struct StudySection {
    /// The title, without a capital on standard output.
    pub title: &'static str,
    /// The heads of the columns.
    pub head: Vec<&'static str>,
    /// The cells, as many to a row as there are heads; the first column names the row.
    pub rows: Vec<Vec<String>>,
    /// The sentences below the table.
    pub notes: Vec<String>,
}

impl StudySection {
    /// The section for standard output; nothing where it has neither rows nor notes.
    pub fn text(&self) -> String {
        if self.rows.is_empty() && self.notes.is_empty() {
            return String::new();
        }
        let mut lines = Vec::new();
        if !self.rows.is_empty() {
            lines.push(self.head.iter().map(|head| (*head).to_owned()).collect());
            lines.extend(self.rows.iter().cloned());
        }
        for line in &mut lines {
            line.insert(0, String::new());
        }
        let notes: String = self.notes.iter().map(|note| format!("  {note}\n")).collect();
        format!("\n{}\n{}{notes}", self.title.to_lowercase(), columns(&lines, 2))
    }

    /// The section of the page; nothing where it has neither rows nor notes.
    pub fn html(&self) -> String {
        if self.rows.is_empty() && self.notes.is_empty() {
            return String::new();
        }
        let table = if self.rows.is_empty() { String::new() } else { html::table(&self.head, &self.rows) };
        let notes: String =
            self.notes.iter().map(|note| format!("<p class=\"note\">{}</p>\n", escaped(note))).collect();
        format!("<section><h2>{}</h2>\n{table}{notes}</section>\n", escaped(self.title))
    }
}
