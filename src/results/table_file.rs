//! A table that grows by whole rows, without allocating: a comma separated file, or a search that keeps the collected numbers alone.
//!
//! Rows collect in memory, and one call writes all of them: a call for each page costs more time than the format of the numbers. If the file
//! cannot grow, it is cut back to its last whole row. A run that is killed during the call may tear a row, which readers omit. The csv crate
//! is for readers: its writer hands over whatever fills its buffer.

use super::collected::{FoundSoFar, RowSearch};
use super::disk::{at, create, is_same};
use super::table::WriteRow;
use base::row_text::RowText;
use base::snapshot::keep;
use std::fs::{File, OpenOptions};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

/// The number of bytes of finished rows that do not wait for the next flush.
const ENOUGH: usize = 1 << 16;

/// A table of results that is being written.
pub struct TableFile {
    path: PathBuf,
    target: Target,
    /// The number of bytes in the file, all of whole rows.
    written: u64,
    /// The finished rows not yet written, and the current row.
    rows: RowText,
    /// The time of the row that is being written.
    time: f64,
    /// The stage that rows name; empty in a deck without stages.
    stage: String,
    /// The load case that rows name; empty in a deck without cases.
    case: String,
    /// The number of bytes before the rows of the stage under way.
    before_stage: u64,
    /// The numbers found before them.
    found_before: Vec<FoundSoFar>,
    empty: Option<EmptyFields>,
}

/// Where the rows go.
enum Target {
    File(File),
    Search(Box<RowSearch>),
}

/// Fields that stayed empty because their number is not finite.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EmptyFields {
    /// The time of the first row that has one.
    pub since: f64,
    /// How many there are.
    pub count: usize,
}

keep!(EmptyFields: Default { since, count });

/// How far a table had come at a checkpoint.
#[derive(Debug, Clone, Default)]
pub struct TableMark {
    /// The name of the file.
    pub file: String,
    written: u64,
    stage: String,
    before_stage: u64,
    found: Vec<FoundSoFar>,
    found_before: Vec<FoundSoFar>,
    empty: Option<EmptyFields>,
}

impl TableMark {
    /// True if its rows are in a file, which has a header at least; false if they go to a search.
    pub fn is_file(&self) -> bool {
        self.written > 0
    }

    /// The beginning of a table.
    pub fn of(file: &str) -> TableMark {
        TableMark { file: file.to_owned(), ..TableMark::default() }
    }
}

keep!(TableMark: Default { file, written, stage, before_stage, found, found_before, empty });

impl TableFile {
    /// Makes a new file with its header row.
    ///
    /// # Errors
    /// The file cannot be opened or written; the error names it.
    pub fn open(dir: &Path, name: &str, header: &str) -> io::Result<TableFile> {
        let path = dir.join(name);
        let file = create(&path).map_err(|e| at(&path, e))?;
        let mut table = TableFile::of(path, Target::File(file));
        table.rows = RowText::with_capacity(2 * ENOUGH);
        table.rows.line(header);
        table.flush()?;
        Ok(table)
    }

    /// Opens the table of a checkpoint and removes all later rows.
    ///
    /// # Errors
    /// The file cannot be opened or cut, or has changed since the checkpoint; the error names it.
    pub fn reopen(dir: &Path, mark: TableMark) -> io::Result<TableFile> {
        let TableMark { file: name, written, stage, before_stage, empty, .. } = mark;
        let path = dir.join(name);
        let mut file = OpenOptions::new().read(true).append(true).open(&path).map_err(|e| at(&path, e))?;
        if file.metadata().map_err(|e| at(&path, e))?.len() < written {
            let what =
                "the table is shorter than it was at the checkpoint: --overwrite runs the deck from the beginning";
            return Err(at(&path, io::Error::new(io::ErrorKind::InvalidData, what)));
        }
        let cut = file.set_len(written).and_then(|()| file.seek(io::SeekFrom::End(0)));
        cut.map_err(|e| at(&path, e))?;
        let rows = RowText::with_capacity(2 * ENOUGH);
        Ok(TableFile { written, rows, stage, before_stage, empty, ..TableFile::of(path, Target::File(file)) })
    }

    /// A table without a file: its rows go to a search, from the place of the mark on.
    pub fn searched(search: RowSearch, mark: TableMark) -> TableFile {
        let TableMark { file: name, stage, found, found_before, empty, .. } = mark;
        let mut search = Box::new(search);
        search.go_back(&found);
        TableFile { stage, found_before, empty, ..TableFile::of(PathBuf::from(name), Target::Search(search)) }
    }

    /// The search of a table without file.
    pub fn search(&self) -> Option<&RowSearch> {
        if let Target::Search(search) = &self.target { Some(search) } else { None }
    }

    /// An empty table.
    fn of(path: PathBuf, target: Target) -> TableFile {
        TableFile {
            path,
            target,
            written: 0,
            rows: RowText::default(),
            time: 0.0,
            stage: String::new(),
            case: String::new(),
            before_stage: 0,
            found_before: Vec::new(),
            empty: None,
        }
    }

    /// How far the table has come, with all its rows safe on the disk.
    ///
    /// # Errors
    /// As for [`TableFile::flush`].
    pub fn mark(&mut self) -> io::Result<TableMark> {
        self.flush()?;
        if let Target::File(file) = &self.target {
            file.sync_data().map_err(|e| at(&self.path, e))?;
        }
        let file = self.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let TableFile { written, before_stage, empty, .. } = *self;
        let (found, found_before) = (self.found(), self.found_before.clone());
        Ok(TableMark { file, written, stage: self.stage.clone(), before_stage, found, found_before, empty })
    }

    /// Lets all rows to come name this stage.
    ///
    /// # Errors
    /// As for [`TableFile::flush`].
    pub fn begin_stage(&mut self, name: &str) -> io::Result<()> {
        self.flush()?;
        (self.stage, self.before_stage, self.found_before) = (name.to_owned(), self.written, self.found());
        Ok(())
    }

    /// The results of the search so far; none of a file.
    fn found(&self) -> Vec<FoundSoFar> {
        self.search().map_or(Vec::new(), RowSearch::so_far)
    }

    /// Lets all rows to come name this load case.
    pub fn begin_case(&mut self, name: &str) {
        name.clone_into(&mut self.case);
    }

    /// Takes away the rows of the stage under way.
    ///
    /// # Errors
    /// The file cannot be cut.
    pub fn withdraw_stage(&mut self) -> io::Result<()> {
        self.rows.clear();
        self.written = self.before_stage;
        match &mut self.target {
            Target::Search(search) => search.go_back(&self.found_before),
            Target::File(file) => {
                let cut = file.set_len(self.written).and_then(|()| file.seek(io::SeekFrom::End(0)));
                cut.map_err(|e| at(&self.path, e))?;
            }
        }
        Ok(())
    }

    /// The fields that stayed empty so far, if any did.
    pub fn empty_fields(&self) -> Option<EmptyFields> {
        self.empty
    }

    /// Writes the finished rows to the file.
    ///
    /// # Errors
    /// The file cannot grow; it then ends with the last whole row that it holds, and the rows behind it are lost.
    pub fn flush(&mut self) -> io::Result<()> {
        let Target::File(file) = &mut self.target else { return Ok(()) };
        // A file that somebody has cut short would get a hole.
        if file.metadata().map_err(|error| at(&self.path, error))?.len() != self.written {
            self.rows.clear();
            return Err(self.spoiled());
        }
        let rows = self.rows.bytes();
        let done = file.write_all(rows);
        self.written += match &done {
            Ok(()) => rows.len() as u64,
            Err(_) => cut_back(file, self.written, rows),
        };
        self.rows.clear();
        done.map_err(|e| at(&self.path, e))
    }

    /// Checks that the file still has its name and holds the written rows, nothing more.
    ///
    /// # Errors
    /// Somebody has taken it away, put another in its place or written to it.
    pub fn verify(&self) -> io::Result<()> {
        let Target::File(file) = &self.target else { return Ok(()) };
        let length = file.metadata().map_err(|error| at(&self.path, error))?.len();
        if is_same(file, &self.path) && length == self.written {
            return Ok(());
        }
        Err(self.spoiled())
    }

    /// The error that somebody else has been at the file.
    fn spoiled(&self) -> io::Error {
        let what = "the table was taken away, replaced or changed while the run was writing it; its results are lost";
        at(&self.path, io::Error::new(io::ErrorKind::NotFound, what))
    }
}

/// Cuts a file back to whole ones of these rows after it could not grow, and returns the number of bytes gained.
fn cut_back(file: &File, written: u64, rows: &[u8]) -> u64 {
    let grown = file.metadata().map_or(0, |file| file.len().saturating_sub(written)) as usize;
    let taken = &rows[..grown.min(rows.len())];
    let (mut whole, mut is_quoted) = (0, false);
    for (at, byte) in (1..).zip(taken) {
        is_quoted ^= *byte == b'"';
        if *byte == b'\n' && !is_quoted {
            whole = at;
        }
    }
    // A shorter file always has room.
    let _ = file.set_len(written + whole);
    whole
}

impl WriteRow for TableFile {
    fn reads(&self, subject: &str) -> bool {
        self.search().is_none_or(|search| search.reads(subject))
    }

    fn row(&mut self, step: usize, time: f64) -> &mut dyn WriteRow {
        match &mut self.target {
            Target::File(_) => self.rows.begin(step),
            Target::Search(search) => search.begin(step),
        }
        self.time = time;
        self.number(time);
        for name in [&self.stage, &self.case] {
            if !name.is_empty() {
                put_text(&mut self.target, &mut self.rows, name);
            }
        }
        self
    }

    fn count(&mut self, value: usize) -> &mut dyn WriteRow {
        match &mut self.target {
            Target::File(_) => self.rows.count(value),
            Target::Search(search) => search.count(value),
        }
        self
    }

    fn number(&mut self, value: f64) -> &mut dyn WriteRow {
        self.numbers(&[value])
    }

    fn numbers(&mut self, values: &[f64]) -> &mut dyn WriteRow {
        let empty = match &mut self.target {
            Target::File(_) => self.rows.numbers(values),
            Target::Search(search) => search.numbers(values),
        };
        if empty > 0 {
            self.empty.get_or_insert(EmptyFields { since: self.time, count: 0 }).count += empty;
        }
        self
    }

    fn text(&mut self, text: &str) -> &mut dyn WriteRow {
        put_text(&mut self.target, &mut self.rows, text);
        self
    }

    fn end(&mut self) -> io::Result<()> {
        if let Target::Search(search) = &mut self.target {
            search.end();
            return Ok(());
        }
        self.rows.end();
        if self.rows.bytes().len() < ENOUGH { Ok(()) } else { self.flush() }
    }
}

fn put_text(target: &mut Target, rows: &mut RowText, text: &str) {
    match target {
        Target::File(_) => rows.text(text),
        Target::Search(search) => search.text(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng, rngs::SmallRng};

    fn read(path: &Path) -> Vec<Vec<String>> {
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(path).unwrap();
        reader.records().map(|record| record.unwrap().iter().map(String::from).collect()).collect()
    }

    #[test]
    fn numbers_read_back_bit_for_bit() {
        let dir = tempfile::tempdir().unwrap();
        let mut random = SmallRng::seed_from_u64(5);
        let mut values = vec![0.0, -0.0, 0.1, 1e-3, 1e300, f64::MIN_POSITIVE, 5e-324, f64::MAX, -1.0 / 3.0];
        values.extend((0..20_000).map(|_| f64::from_bits(random.next_u64())).filter(|x| x.is_finite()));
        let mut table = TableFile::open(dir.path(), "t.csv", "step,time,value").unwrap();
        for (i, value) in values.iter().enumerate() {
            table.row(i, *value).number(-value).end().unwrap();
        }
        table.flush().unwrap();
        let rows = read(&dir.path().join("t.csv"));
        assert_eq!(rows.len(), values.len() + 1);
        for (row, value) in rows[1..].iter().zip(&values) {
            assert_eq!(row[1].parse::<f64>().unwrap().to_bits(), value.to_bits());
            assert_eq!(row[2].parse::<f64>().unwrap().to_bits(), (-value).to_bits());
        }
    }

    #[test]
    fn text_survives_commas_and_quotes() {
        let dir = tempfile::tempdir().unwrap();
        let mut table = TableFile::open(dir.path(), "t.csv", "step,time,name,none").unwrap();
        let names = ["portal[3]", "a, b", "the \"elbow\"", "two\nlines", "Träger"];
        for name in names {
            table.row(0, 0.5).text(name).number(f64::NAN).end().unwrap();
        }
        assert_eq!(table.empty_fields(), Some(EmptyFields { since: 0.5, count: names.len() }));
        table.flush().unwrap();
        let rows = read(&dir.path().join("t.csv"));
        assert!(rows[1..].iter().zip(names).all(|(row, name)| row[2] == name && row[3].is_empty()));
    }

    #[test]
    fn a_resumed_table_ends_where_the_checkpoint_was() {
        let dir = tempfile::tempdir().unwrap();
        let mut table = TableFile::open(dir.path(), "t.csv", "step,time,name").unwrap();
        for step in 0..5 {
            table.row(step, 0.5).text("first\nline").end().unwrap();
            table.row(step, 0.5).text("b").end().unwrap();
        }
        table.flush().unwrap();
        let path = dir.path().join("t.csv");
        let mark = table.mark().unwrap();
        table.row(9, 0.5).text("lost").end().unwrap();
        table.flush().unwrap();
        OpenOptions::new().append(true).open(&path).unwrap().write_all(b"5,0.").unwrap(); // torn
        let mut table = TableFile::reopen(dir.path(), mark.clone()).unwrap();
        table.row(3, 0.25).text("c").end().unwrap();
        table.flush().unwrap();
        let rows = read(&path);
        assert_eq!(rows.len(), 1 + 5 * 2 + 1);
        assert_eq!(rows[10], ["4", "0.5", "b"]);
        assert_eq!(rows[11], ["3", "0.25", "c"]);
        OpenOptions::new().write(true).open(&path).unwrap().set_len(mark.written - 1).unwrap();
        let error = TableFile::reopen(dir.path(), mark).err().unwrap();
        assert!(error.to_string().contains("t.csv: the table is shorter"), "{error}");
    }

    #[test]
    fn a_full_disk_is_an_error() {
        if !Path::new("/dev/full").exists() {
            return;
        }
        let dir = tempfile::tempdir().unwrap();
        let mut table = TableFile::open(dir.path(), "t.csv", "step,time").unwrap();
        table.path = PathBuf::from("/dev/full");
        table.target = Target::File(OpenOptions::new().write(true).open(&table.path).unwrap());
        table.written = 0;
        table.row(0, 0.0).end().unwrap();
        let error = table.flush().unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        assert!(error.to_string().starts_with("/dev/full: ") && error.to_string().contains("make room"), "{error}");
    }

    #[test]
    fn a_table_that_is_gone_or_changed_is_an_error() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.csv");
        let table = || {
            let mut table = TableFile::open(dir.path(), "t.csv", "step,time").unwrap();
            table.row(0, 0.0).end().unwrap();
            table.flush().and_then(|()| table.verify()).unwrap();
            table
        };
        let spoil: [&dyn Fn(); 4] = [
            &|| std::fs::remove_file(&path).unwrap(),
            &|| std::fs::rename(&path, dir.path().join("elsewhere")).unwrap(),
            &|| std::fs::write(&path, "step").unwrap(),
            &|| OpenOptions::new().append(true).open(&path).unwrap().write_all(b"9,9.0\n").unwrap(),
        ];
        for spoil in spoil {
            let table = table();
            spoil();
            let error = table.verify().unwrap_err();
            assert!(error.to_string().contains("t.csv: the table was taken away"), "{error}");
        }
    }

    #[test]
    #[cfg(unix)]
    fn what_a_link_leads_to_stays() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("mine"), "kept").unwrap();
        std::os::unix::fs::symlink("mine", dir.path().join("t.csv")).unwrap();
        TableFile::open(dir.path(), "t.csv", "step,time").unwrap();
        assert_eq!(std::fs::read_to_string(dir.path().join("mine")).unwrap(), "kept");
        assert_eq!(std::fs::read_to_string(dir.path().join("t.csv")).unwrap(), "step,time\n");
    }

    #[test]
    fn a_file_that_cannot_grow_ends_with_a_whole_row() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.csv");
        for (grown, rows) in [("", 0), ("1,0", 0), ("1,0.5\n", 1), ("1,0.5\n2,0.5\n3", 2), ("1,0.5\n2,0.5\n3,0.5\n", 3)]
        {
            let mut table = TableFile::open(dir.path(), "t.csv", "step,time").unwrap();
            (1..4).for_each(|step| table.row(step, 0.5).end().unwrap());
            // The disk takes a part of the rows.
            OpenOptions::new().append(true).open(&path).unwrap().write_all(grown.as_bytes()).unwrap();
            let Target::File(file) = &table.target else { unreachable!() };
            assert_eq!(cut_back(file, table.written, table.rows.bytes()), 6 * rows);
            let text = std::fs::read_to_string(&path).unwrap();
            assert_eq!(text, ["step,time\n", &grown[..6 * rows as usize]].concat());
        }
    }

    #[test]
    fn rows_longer_and_shorter_than_a_page_arrive_whole() {
        let dir = tempfile::tempdir().unwrap();
        let mut table = TableFile::open(dir.path(), "t.csv", "step,time,name").unwrap();
        let mut random = SmallRng::seed_from_u64(9);
        let lengths: Vec<usize> = (0..300).map(|_| (random.next_u64() % 6000) as usize).collect();
        for (step, length) in lengths.iter().enumerate() {
            table.row(step, 0.0).text(&"x".repeat(*length)).end().unwrap();
        }
        table.flush().and_then(|()| table.verify()).unwrap();
        let rows = read(&dir.path().join("t.csv"));
        assert!(rows.len() == 301 && rows[1..].iter().zip(&lengths).all(|(row, length)| row[2].len() == *length));
    }
}
