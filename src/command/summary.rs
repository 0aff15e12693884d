//! `rdsolve summary DIR`: peaks and ends of all columns of a result, and its status.

use super::console::{complain, print};
use super::exit::Exit;
use base::names::to_digits;
use clap::{Args, ValueEnum};
use results::summary::{ColumnSummary, Extremum, ResultSummary};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Each column of each table has its least and its largest value, with the time and what the row is about, and the value \
of largest magnitude at the last time. Columns that are zero throughout are left out of the text."
)]
pub struct SummaryArgs {
    /// The folder of results
    dir: PathBuf,
    /// How it is printed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// The form of a summary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Lines for people, with seven digits
    Text,
    /// A row for each column, with all digits
    Csv,
    /// One object
    Json,
}

/// Prints the summary of a folder of results on standard output.
///
/// # Errors
/// [`Exit::InputOutput`] where results cannot be read or standard output cannot be written; the reason has been shown.
pub fn summary(args: &SummaryArgs) -> Result<(), Exit> {
    let summary = ResultSummary::of(&args.dir).map_err(|error| {
        complain(&format!("cannot read results: {error}"));
        Exit::InputOutput
    })?;
    match args.format {
        Format::Text => print(&text(&summary)),
        Format::Csv => print(&csv(&summary)),
        Format::Json => {
            let json = serde_json::to_string_pretty(&summary).map_err(|_| Exit::Internal)?;
            print(&format!("{json}\n"))
        }
    }
}

fn text(summary: &ResultSummary) -> String {
    const DIGITS: usize = 7;
    let value = |extremum: &Extremum| {
        let at = if extremum.at.is_empty() { String::new() } else { format!("{}, ", extremum.at) };
        format!("{} ({at}t = {})", to_digits(extremum.value, DIGITS), to_digits(extremum.time, DIGITS))
    };
    let mut lines = vec![match summary.reason.as_str() {
        "" => summary.status.clone(),
        reason => format!("{}: {reason}", summary.status),
    }];
    lines.extend(summary.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.extend(summary.expectations.iter().cloned());
    let mut table = "";
    let varies = |column: &&ColumnSummary| column.least.value != 0.0 || column.largest.value != 0.0;
    for column in summary.columns.iter().filter(varies) {
        if column.table != table {
            table = &column.table;
            lines.push(table.to_owned());
        }
        let ColumnSummary { column, least, largest, end, .. } = column;
        lines.push(format!("  {column}: {} to {}, at the end {}", value(least), value(largest), value(end)));
    }
    lines.push(String::new());
    lines.join("\n")
}

fn csv(summary: &ResultSummary) -> String {
    let quoted = |text: &str| {
        if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
    };
    let cells = |extremum: &Extremum| format!("{},{},{}", extremum.value, extremum.time, quoted(&extremum.at));
    let row = |column: &ColumnSummary| {
        let [least, largest, end] = [&column.least, &column.largest, &column.end].map(cells);
        format!("{},{},{least},{largest},{end}\n", column.table, column.column)
    };
    let rows: String = summary.columns.iter().map(row).collect();
    format!("table,column,min,min_time,min_at,max,max_time,max_at,end,end_time,end_at\n{rows}")
}
