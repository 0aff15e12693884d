//! `rdsolve summary DIR`: peaks and ends of all columns of a result, and its status.

use super::console::{complain, print, say};
use super::exit::Exit;
use base::names::to_digits;
use base::row_text::shortest;
use clap::{Args, ValueEnum};
use results::compare::Selector;
use results::curve::{Curve, CurveAxis, CurveMarks};
use results::low_pass::{LowPass, TimeSampling};
use results::summary::{ColumnSummary, Extremum, Filter, ResultSummary};
use results::torn_tables;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Each column of each table has its least and its largest value, with the time and what the row is about, and the value \
of largest magnitude at the last time. Tables of modes and responses are about one state: their values have the mode, frequency or speed. Columns that are zero throughout are left out of the text.

A curve goes over the rows of two tables: `--curve nodes.csv:tip:ux reactions.csv:*:fx`. An axis is FILE:NAME:COLUMN; NAME is that of the row, \
joined by blanks where a row has several, and `*` in it stands for anything: such rows are summed. `-` in front changes the sign. The text has \
peaks, stiffness and work, csv and json have all points.

A filter runs forwards and backwards: `cfc60` is a channel frequency class of SAE J211, `butterworth:100:4` has cutoff frequency and order."
)]
pub struct SummaryArgs {
    /// The folder of results
    dir: PathBuf,
    /// How it is printed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Low-pass filter of columns over time: `cfc60`, `butterworth:CUTOFF` or `butterworth:CUTOFF:ORDER`
    #[arg(long)]
    filter: Option<LowPass>,
    /// The unit of time, which classes of filters need
    #[arg(long, value_enum, default_value_t = TimeUnit::S, requires = "filter")]
    time_unit: TimeUnit,
    /// Columns to show: `ux` in any table, `nodes.csv`, or `nodes.csv:ux`
    #[arg(long, num_args = 1..)]
    only: Vec<Selector>,
    /// One stage alone
    #[arg(long)]
    stage: Option<String>,
    /// A column over another: x, then y, each FILE:NAME:COLUMN
    #[arg(long, num_args = 2, value_names = ["X", "Y"], allow_hyphen_values = true, conflicts_with = "only")]
    curve: Vec<CurveAxis>,
}

/// Units of time of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TimeUnit {
    /// Seconds
    S,
    /// Milliseconds
    Ms,
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
    let unreadable = |error| {
        complain(&format!("cannot read results: {error}"));
        Exit::InputOutput
    };
    let second = if args.time_unit == TimeUnit::Ms { 1e-3 } else { 1.0 };
    let filter = args.filter.map(|low_pass| Filter { low_pass, second });
    // The other forms hold it.
    if !args.curve.is_empty() || args.format == Format::Csv {
        torn_tables(&args.dir).map_err(unreadable)?.iter().for_each(|torn| say(&format!("warning: {torn}")));
    }
    if let [x, y] = &args.curve[..] {
        let mut curve = Curve::read(&args.dir, [x, y]).map_err(unreadable)?;
        if let Some(stage) = &args.stage {
            curve = curve.in_stage(stage);
            if curve.at.is_empty() {
                complain(&format!("no row is of a stage `{stage}`"));
                return Err(Exit::InputOutput);
            }
        }
        if let Some(filter) = filter {
            smoothen(&mut curve, &filter).map_err(|why| {
                complain(&why);
                Exit::Usage
            })?;
        }
        return print_curve(&curve, [x, y], args.format);
    }
    let summary =
        ResultSummary::of(&args.dir, filter.as_ref(), (&args.only, args.stage.as_deref())).map_err(unreadable)?;
    match args.format {
        Format::Text => print(&text(&summary, args.filter.as_ref())),
        Format::Csv => print(&csv(&summary)),
        Format::Json => {
            let json = serde_json::to_string_pretty(&summary).map_err(|_| Exit::Internal)?;
            print(&format!("{json}\n"))
        }
    }
}

/// Digits of numbers in the text.
const DIGITS: usize = 7;

/// Filters both columns of a curve.
fn smoothen(curve: &mut Curve, filter: &Filter) -> Result<(), String> {
    if curve.over != "time" {
        return Err(format!("a filter goes over time, and these rows over {}: leave out `--filter`", curve.over));
    }
    let sampling = TimeSampling::of(&curve.at)?;
    for values in [&mut curve.x, &mut curve.y] {
        let smooth = filter.low_pass.apply(&sampling, filter.second, &curve.at, values)?;
        *values = sampling.at_rows(&smooth, &curve.at);
    }
    Ok(())
}

/// Prints a curve: its marks as text, or all of its points.
fn print_curve(curve: &Curve, [x, y]: [&CurveAxis; 2], format: Format) -> Result<(), Exit> {
    match format {
        Format::Text => print(&curve_text(curve, [x, y])),
        Format::Csv => {
            let head = if curve.stage.is_empty() { "" } else { "stage," };
            let row = |k: usize| {
                let stage = curve.stage.get(k).map_or(String::new(), |stage| quoted(stage) + ",");
                let [at, x, y] = [curve.at[k], curve.x[k], curve.y[k]].map(shortest);
                format!("{stage}{at},{x},{y}\n")
            };
            let rows: String = (0..curve.at.len()).map(row).collect();
            print(&format!("{head}{},{},{}\n{rows}", curve.over, quoted(&x.word), quoted(&y.word)))
        }
        Format::Json => {
            let json = serde_json::to_string_pretty(curve).map_err(|_| Exit::Internal)?;
            print(&format!("{json}\n"))
        }
    }
}

/// The peaks of a curve, the slope of its first step, and the work along it, for each stage.
fn curve_text(curve: &Curve, [x, y]: [&CurveAxis; 2]) -> String {
    let digits = |value: f64| to_digits(value, DIGITS);
    let over = if curve.over == "time" { "t" } else { &curve.over };
    let point =
        |k: usize| format!("{} at {} ({over} = {})", digits(curve.y[k]), digits(curve.x[k]), digits(curve.at[k]));
    let mut lines = vec![format!("{} over {}: {} points", y.word, x.word, curve.at.len())];
    for marks in curve.marks() {
        let CurveMarks { stage, extremes: [most, least, last], first_slope, work } = marks;
        if !stage.is_empty() {
            lines.push(format!("  stage {stage}"));
        }
        lines.push(format!("  largest {}", point(most)));
        lines.push(format!("  least {}", point(least)));
        lines.push(format!("  at the end {}", point(last)));
        lines.extend(first_slope.map(|slope| format!("  first slope {}", digits(slope))));
        lines.push(format!("  work along the curve {}", digits(work)));
    }
    lines.push(String::new());
    lines.join("\n")
}

/// A text as a field of a table.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

fn text(summary: &ResultSummary, filter: Option<&LowPass>) -> String {
    let value = |extremum: &Extremum| {
        let at = if extremum.at.is_empty() { String::new() } else { format!("{}, ", extremum.at) };
        format!("{} ({at}t = {})", to_digits(extremum.value, DIGITS), to_digits(extremum.time, DIGITS))
    };
    let at_state = |extremum: &Extremum| {
        let at = if extremum.at.is_empty() { String::new() } else { format!(" ({})", extremum.at) };
        format!("{}{at}", to_digits(extremum.value, DIGITS))
    };
    let mut lines = vec![match summary.reason.as_str() {
        "" => summary.status.clone(),
        reason => format!("{}: {reason}", summary.status),
    }];
    lines.extend(summary.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.extend(summary.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(summary.expectations.iter().cloned());
    lines.extend(filter.map(|filter| format!("filtered: {}", filter.name())));
    let mut table = "";
    let varies = |column: &&ColumnSummary| column.least.value != 0.0 || column.largest.value != 0.0;
    for column in summary.columns.iter().filter(varies) {
        if column.table != table {
            table = &column.table;
            lines.push(table.to_owned());
        }
        let ColumnSummary { column, least, largest, end, is_over_time, .. } = column;
        lines.push(match is_over_time {
            true => format!("  {column}: {} to {}, at the end {}", value(least), value(largest), value(end)),
            false => format!("  {column}: {} to {}", at_state(least), at_state(largest)),
        });
    }
    lines.push(String::new());
    lines.join("\n")
}

fn csv(summary: &ResultSummary) -> String {
    let cells = |extremum: &Extremum| {
        format!("{},{},{}", shortest(extremum.value), shortest(extremum.time), quoted(&extremum.at))
    };
    let row = |column: &ColumnSummary| {
        let [least, largest, end] = [&column.least, &column.largest, &column.end].map(cells);
        format!("{},{},{least},{largest},{end}\n", column.table, column.column)
    };
    let rows: String = summary.columns.iter().map(row).collect();
    format!("table,column,min,min_time,min_at,max,max_time,max_at,end,end_time,end_at\n{rows}")
}
