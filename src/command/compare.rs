//! `rdsolve compare DIR_A DIR_B`: do two results agree?

use std::path::PathBuf;

use clap::Args;

use super::console::{complain, counted, print, say};
use super::exit::Exit;
use base::names::{nearest, short};
use results::compare::{
    Alone, ColumnTolerance, ComparedColumn, ComparedTable, Comparison, Matched, Selector, Settings,
    compare as compared, shown, size,
};

#[derive(Debug, Args)]
#[command(
    after_help = "Rows are matched by time (within a thousandth of a step) and name; each column is measured against its \
range, max - min over both folders, and where it is constant against the largest number of its kind in the file. With \
different steps or output, common times are compared. A table whose last line is torn does not agree. Not compared: run.log, timings, .vtu. Columns of steps.csv are shown but not \
judged unless named: they say what a run cost.

Exit codes: 0 the folders agree, 5 they do not, 6 one cannot be read, 2 usage."
)]
pub struct CompareArgs {
    /// The first folder of results
    dir_a: PathBuf,
    /// The second
    dir_b: PathBuf,
    /// Largest difference of a column, relative to its range: for all, or for some (nodes.csv:ux=1e-4, nodes.csv=1e-4,
    /// ux=1e-4); repeatable, the closest name counts [default: 1e-6]
    #[arg(long, value_name = "[FILE:COLUMN=]X")]
    tolerance: Vec<ColumnTolerance>,
    /// Differences up to this are none, whatever the column
    #[arg(long, value_name = "X", default_value = "0", value_parser = size)]
    absolute: f64,
    /// Compare these columns only: ux, nodes.csv, nodes.csv:ux; repeatable
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    columns: Vec<Selector>,
    /// Leave these columns out: ux, nodes.csv, nodes.csv:ux; repeatable
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    ignore: Vec<Selector>,
    /// Show differences only
    #[arg(long)]
    quiet: bool,
}

/// Compares two folders of results column by column and prints the differences.
///
/// # Errors
/// [`Exit::CheckFailed`] if they differ, [`Exit::Usage`] if an option names no column, [`Exit::InputOutput`] if a folder cannot be read;
/// the reason has been shown.
pub fn compare(args: &CompareArgs) -> Result<(), Exit> {
    let settings = Settings {
        tolerances: args.tolerance.clone(),
        absolute: args.absolute,
        columns: args.columns.clone(),
        ignored: args.ignore.clone(),
    };
    let names = [&args.dir_a, &args.dir_b].map(|dir| dir.display().to_string());
    let comparison = compared([&args.dir_a, &args.dir_b], &settings).map_err(|error| {
        complain(&format!("cannot compare: {error}"));
        Exit::InputOutput
    })?;
    if !comparison.idle.is_empty() {
        comparison.idle.iter().for_each(|selector| unknown(selector, &comparison));
        return Err(Exit::Usage);
    }
    print(&table(&comparison, args.quiet))?;
    let remarks = remarks(&comparison, &names, args.quiet);
    print(&remarks)?;
    if comparison.agrees() {
        if args.quiet { Ok(()) } else { print("the folders agree\n") }
    } else {
        complain(&format!("`{}` and `{}` do not agree", names[0], names[1]));
        Err(Exit::CheckFailed)
    }
}

/// Reports that an option names no column of either folder, with the nearest name.
fn unknown(selector: &Selector, comparison: &Comparison) {
    let (file, column) = (selector.file.as_deref(), selector.column.as_deref());
    let parts = comparison.known.iter().filter_map(|known| known.split_once(':'));
    let (text, near) = match (file, column) {
        (Some(file), Some(column)) if parts.clone().any(|(known, _)| known == file) => {
            let of_file = parts.filter(|(known, _)| *known == file).map(|(_, column)| column);
            (format!("no column of {file} is named `{column}`"), nearest(column, of_file))
        }
        (Some(file), _) => (format!("neither folder has a table `{file}`"), nearest(file, parts.map(|(file, _)| file))),
        (None, column) => {
            let column = column.unwrap_or_default();
            (format!("no column is named `{column}`"), nearest(column, parts.map(|(_, column)| column)))
        }
    };
    complain(&text);
    if let Some(near) = near {
        say(&format!("  help: did you mean `{near}`?"));
    }
}

/// The header of the printed table.
const HEAD: [&str; 7] = ["file", "column", "relative", "absolute", "where", "tolerance", "verdict"];

/// The printed table: it has one line for each column that differs, and one for the others of the same file.
fn table(comparison: &Comparison, quiet: bool) -> String {
    let mut lines: Vec<[String; 7]> = Vec::new();
    for table in &comparison.tables {
        let differs = |column: &&ComparedColumn| column.worst.difference > 0.0;
        let shown = table.columns.iter().filter(differs).filter(|column| !(quiet && column.passed));
        lines.extend(shown.map(|column| line(table, column)));
        let same: Vec<&str> =
            table.columns.iter().filter(|column| !differs(column)).map(|column| column.name.as_str()).collect();
        if !same.is_empty() && !quiet && !table.nothing_matched() {
            let name = match same[..] {
                [one] => one.to_owned(),
                _ if same.len() == table.columns.len() => format!("all {}", same.len()),
                _ => format!("{} others", same.len()),
            };
            let zero = || "0".to_string();
            lines.push([table.name.clone(), name, zero(), zero(), String::new(), String::new(), "same".into()]);
        }
    }
    if lines.is_empty() {
        return String::new();
    }
    lines.insert(0, HEAD.map(String::from));
    let widths: [usize; 7] =
        std::array::from_fn(|i| lines.iter().map(|line| line[i].chars().count()).max().unwrap_or(0));
    let row = |line: &[String; 7]| {
        let cells: Vec<String> = line.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        format!("{}\n", cells.join("  ").trim_end())
    };
    lines.iter().map(row).collect()
}

/// The cells of a column's line, in the order of [`HEAD`].
fn line(table: &ComparedTable, column: &ComparedColumn) -> [String; 7] {
    let verdict = match (column.judged, column.passed) {
        (false, _) => "not judged",
        (true, true) => "ok",
        (true, false) => "DIFFERS",
    };
    let (difference, relative) = (column.worst.difference, column.relative());
    let numbers = if difference.is_finite() {
        [format!("{relative:.2e}"), format!("{difference:.2e}")]
    } else {
        ["no number".to_string(), "on one side, or NaN".to_string()]
    };
    let [relative, absolute] = numbers;
    let place = place(table.by, column.worst.time, &column.worst.key);
    let tolerance = short(column.tolerance);
    [table.name.clone(), column.name.clone(), relative, absolute, place, tolerance, verdict.into()]
}

/// The time, or frequency, of a row and the name of the thing that it is about.
fn place(by: Matched, time: f64, key: &[u8]) -> String {
    let name = shown(key);
    // A time is a sum of steps, whose last digits are rounding and say nothing.
    let time: f64 = format!("{time:.9e}").parse().unwrap_or(time);
    let what = if by == Matched::Frequency { "frequency" } else { "t =" };
    if name.is_empty() { format!("{what} {time}") } else { format!("{what} {time}, {name}") }
}

/// The number that pairs rows, in a word.
fn word(by: Matched) -> &'static str {
    match by {
        Matched::Time => "time",
        Matched::Step => "step",
        Matched::Frequency => "frequency",
    }
}

/// So many of them.
fn frames(by: Matched, count: u64, more: &str) -> String {
    match (by, count) {
        (Matched::Frequency, 2..) | (Matched::Frequency, 0) => format!("{count} {more}frequencies"),
        _ => counted(count as usize, &format!("{more}{}", word(by))),
    }
}

/// Lines about rows outside the table of columns: the number of paired rows, and the rows of one side alone.
fn remarks(comparison: &Comparison, names: &[String; 2], quiet: bool) -> String {
    let mut text = String::new();
    let mut say = |line: String| text += &format!("{line}\n");
    for table in &comparison.tables {
        let name = &table.name;
        if !quiet {
            let rows = counted(table.rows as usize, "row");
            let times = frames(table.by, table.frames, "");
            say(format!("{name}: {rows} matched at {times}"));
        }
        for (side, Alone { frames, all_rows, .. }) in table.alone.iter().enumerate() {
            if *frames > 0 && !quiet {
                let times = self::frames(table.by, *frames, "more ");
                say(format!("{name}: {} has {times}, {}", names[side], counted(*all_rows as usize, "row")));
            }
        }
        for (name_of, truncated) in names.iter().zip(table.truncated) {
            if truncated {
                say(format!(
                    "TORN {name}: the last line in {name_of} is incomplete and was left out: that run was killed or its file cut short"
                ));
            }
        }
        for (side, columns) in table.only.iter().enumerate() {
            columns
                .iter()
                .for_each(|column| say(format!("MISSING {name}: column `{column}` is only in {}", names[side])));
        }
        if !table.judged {
            continue;
        }
        for (side, alone) in table.alone.iter().enumerate() {
            if let Some((time, key)) = &alone.first {
                let rows = counted(alone.rows as usize, "row");
                say(format!(
                    "MISSING {name}: {rows} only in {}, the first at {}",
                    names[side],
                    place(table.by, *time, key)
                ));
            }
        }
        if let Some([a, b]) = table.ends {
            let what = if table.by == Matched::Time { "t =" } else { word(table.by) };
            say(format!("DIFFERS {name}: ends at {what} {a} in {} and {what} {b} in {}", names[0], names[1]));
        }
        if table.nothing_matched() {
            say(format!("DIFFERS {name}: no row of one matches a row of the other"));
        }
    }
    for (side, files) in comparison.only.iter().enumerate() {
        files.iter().for_each(|file| say(format!("MISSING {file}: only in {}", names[side])));
    }
    text + &of_status(comparison, names, quiet)
}

/// A line about the ends of the two runs; none if they agree and `quiet` is set.
fn of_status(comparison: &Comparison, names: &[String; 2], quiet: bool) -> String {
    match &comparison.status {
        Some([a, b]) if a != b => {
            format!("DIFFERS result.json: status `{a}` in {} and `{b}` in {}\n", names[0], names[1])
        }
        Some([a, _]) if !quiet => format!("result.json: status `{a}` in both\n"),
        None if comparison.without_status && !quiet => {
            "result.json: in neither folder, so neither run is known to have come to its end\n".to_owned()
        }
        _ => String::new(),
    }
}
