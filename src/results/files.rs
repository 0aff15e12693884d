//! The files that grow with a run: the deck selects the files, and every accepted step goes to each. A sweep also has collected numbers found
//! in rows, which are formed at every step for it; without folders it keeps these numbers alone.

use super::collected::{Collected, RowSearch, found, has_peak};
use super::disk::at;
use super::envelopes::Envelopes;
use super::expect::needs;
use super::fields::{Fields, FieldsMark, LISTS};
use super::frd::{self, FrdFile, FrdMark};
use super::result_json;
use super::table::{TableKind, WriteRows};
use super::table_file::{EmptyFields, TableFile, TableMark};
use super::table_size::size_in_words;
use super::tables::{TABLES, holds_response};
use base::names::{instant, short};
use base::snapshot::keep;
use model::{Cadence, FieldFormat, Model, When};
use solve::plan::Plan;
use solve::{Frame, Observer, Wanted};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Finished rows reach their files at least this often, and at [`Files::finish`].
const PATIENCE: Duration = Duration::from_millis(200);

/// A table that is being written.
struct OpenTable {
    kind: &'static TableKind,
    file: TableFile,
    /// `None` where the stage under way has nothing to put in.
    write: Option<WriteRows>,
}

impl OpenTable {
    /// The table of a stage that begins.
    fn begin(kind: &'static TableKind, mut file: TableFile, model: &Model) -> io::Result<OpenTable> {
        if let Some(stage) = &model.analysis.stage {
            file.begin_stage(&stage.name)?;
        }
        Ok(OpenTable { kind, file, write: Some((kind.rows)(model)) })
    }

    /// True if it has rows of every accepted step.
    fn takes_every_step(&self) -> bool {
        self.kind.every_step || self.file.search().is_some_and(RowSearch::has_peaks)
    }
}

/// What a run keeps.
#[derive(Debug, Clone, Copy)]
pub struct RunKeeps<'a> {
    /// True if it keeps files.
    pub files: bool,
    /// The numbers that are found in the rows of every step.
    pub numbers: &'a [Collected],
}

impl RunKeeps<'_> {
    /// Files alone.
    pub const FILES: RunKeeps<'static> = RunKeeps { files: true, numbers: &[] };
}

/// The search for the numbers wanted of a table; `None` if it has none of them.
fn search_of(kind: &TableKind, model: &Model, wanted: &[Collected]) -> Option<RowSearch> {
    RowSearch::new(kind, &kind.header(model), wanted)
}

/// Writes the files that the deck selects. [`Files::finish`] closes them after success and after failure.
pub struct Files {
    dir: PathBuf,
    tables: Vec<OpenTable>,
    fields: Option<Fields>,
    envelopes: Envelopes,
    frd: Option<FrdFile>,
    flushed: Instant,
    writes: bool,
    numbers: Vec<Collected>,
}

/// How far the files of a run had come at a checkpoint.
#[derive(Debug, Default)]
pub struct FilesMark {
    tables: Vec<TableMark>,
    fields: Option<FieldsMark>,
    frd: Option<FrdMark>,
}

keep!(FilesMark: Default { tables, fields, frd });

impl Files {
    /// Creates the folder and its files.
    ///
    /// # Errors
    /// A file cannot be made.
    pub fn open(dir: &Path, model: &Model) -> io::Result<Files> {
        Files::waiting(dir, RunKeeps::FILES).begin(model)
    }

    /// No files yet, until [`Files::begin`] makes them or [`Files::go_on`] opens those of a checkpoint.
    pub fn waiting(dir: &Path, keeps: RunKeeps) -> Files {
        let (dir, tables, envelopes) = (dir.to_owned(), Vec::new(), Envelopes::default());
        let (writes, numbers) = (keeps.files, keeps.numbers.to_vec());
        Files { dir, tables, fields: None, frd: None, envelopes, flushed: Instant::now(), writes, numbers }
    }

    /// Creates the folder and the files of this model.
    ///
    /// # Errors
    /// A file cannot be made.
    pub fn begin(mut self, model: &Model) -> io::Result<Files> {
        let dir = &self.dir;
        let kept = model.output.fields.filter(|_| self.writes).map(|files| files.format);
        if self.writes {
            fs::create_dir_all(dir).map_err(|e| at(dir, e))?;
        }
        self.fields = (kept == Some(FieldFormat::Vtu)).then(|| Fields::open(dir, model)).transpose()?;
        self.frd = (kept == Some(FieldFormat::Frd)).then(|| FrdFile::open(dir, model)).transpose()?;
        self.envelopes = Envelopes::of(model);
        self.open_tables(model)?;
        Ok(self)
    }

    /// Opens the tables of a model that are not open yet.
    fn open_tables(&mut self, model: &Model) -> io::Result<()> {
        for &kind in TABLES.iter().filter(|kind| (kind.wanted)(model)) {
            if self.tables.iter().any(|table| std::ptr::eq(table.kind, kind)) {
                continue;
            }
            if self.writes {
                let file = TableFile::open(&self.dir, kind.file, &kind.header(model).join(","))?;
                self.tables.push(OpenTable::begin(kind, file, model)?);
            }
            if let Some(search) = search_of(kind, model, &self.numbers) {
                let file = TableFile::searched(search, TableMark::of(kind.file));
                self.tables.push(OpenTable::begin(kind, file, model)?);
            }
        }
        Ok(())
    }

    /// The numbers found in rows, `None` for each that no row has.
    pub fn numbers(&self) -> Vec<Option<f64>> {
        found(self.tables.iter().filter_map(|table| table.file.search()), self.numbers.len())
    }

    /// Goes on with the files of a checkpoint in the stage of this model, as they were then.
    ///
    /// # Errors
    /// A file cannot be opened, or has changed since the checkpoint.
    pub fn go_on(&mut self, model: &Model, mark: FilesMark) -> io::Result<()> {
        let has = |kind: &TableKind| mark.tables.iter().any(|mark| mark.file == kind.file);
        if let Some(kind) = TABLES.iter().find(|kind| self.writes && (kind.wanted)(model) && !has(kind)) {
            let message = format!("the checkpoint has no {}: it is of a run with other output", kind.file);
            return Err(at(&self.dir, io::Error::new(io::ErrorKind::InvalidData, message)));
        }
        for mark in mark.tables {
            let Some(&kind) = TABLES.iter().find(|kind| kind.file == mark.file) else { continue };
            let search = if mark.is_file() { None } else { search_of(kind, model, &self.numbers) };
            let file = match search {
                Some(search) => TableFile::searched(search, mark),
                None => TableFile::reopen(&self.dir, mark)?,
            };
            self.tables.push(OpenTable { kind, file, write: (kind.wanted)(model).then(|| (kind.rows)(model)) });
        }
        if let Some(mark) = mark.fields {
            let mut fields = Fields::open(&self.dir, model)?;
            fields.go_on(mark)?;
            self.fields = Some(fields);
        }
        self.frd = mark.frd.map(|mark| FrdFile::reopen(&self.dir, model, mark)).transpose()?;
        // The result is that of the part before.
        let result = self.dir.join(result_json::NAME);
        match fs::remove_file(&result) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(at(&result, error)),
            _ => Ok(()),
        }
    }

    /// How far all files have come, with their rows safe on the disk.
    ///
    /// # Errors
    /// As for [`Files::finish`].
    pub fn mark(&mut self) -> io::Result<FilesMark> {
        let tables = self.tables.iter_mut().map(|table| table.file.mark()).collect::<io::Result<_>>()?;
        Ok(FilesMark {
            tables,
            fields: self.fields.as_ref().map(Fields::mark),
            frd: self.frd.as_ref().map(FrdFile::mark),
        })
    }

    /// Goes on with the next stage, whose model this is.
    ///
    /// # Errors
    /// A file cannot be made, or is no longer what this run has written.
    pub fn next_stage(&mut self, model: &Model) -> io::Result<()> {
        self.finish()?;
        let stage = model.analysis.stage.as_ref().map_or("", |stage| &stage.name);
        for table in &mut self.tables {
            table.file.begin_stage(stage)?;
            table.write = (table.kind.wanted)(model).then(|| (table.kind.rows)(model));
        }
        self.open_tables(model)?;
        if let Some(fields) = &mut self.fields {
            fields.next_stage(model)?;
        }
        if let Some(frd) = &mut self.frd {
            frd.next_stage(model);
        }
        Ok(())
    }

    /// Hands over the rows and the list of grids still waiting, at the end of a run.
    ///
    /// # Errors
    /// A table cannot grow, or is no longer what this run has written.
    pub fn finish(&mut self) -> io::Result<()> {
        self.flushed = Instant::now();
        if let Some(fields) = &mut self.fields {
            fields.finish()?;
        }
        self.tables.iter_mut().try_for_each(|table| table.file.flush().and_then(|()| table.file.verify()))
    }

    /// A warning for each table with fields that had to stay empty, in words.
    pub fn empty_fields(&self) -> Vec<String> {
        let are_kept = self.tables.iter().filter(|table| table.file.search().is_none() == self.writes);
        let told = are_kept.filter_map(|table| Some((table.kind.file, table.file.empty_fields()?)));
        told.map(|(file, EmptyFields { since, count })| {
            let fields = if count == 1 { "field is" } else { "fields are" };
            format!(
                "{count} {fields} empty in {file}, the first at t = {}: their values are not finite. Look for a slip in the units of the deck, or \
                 take units with ordinary numbers for lengths, masses and times",
                instant(since)
            )
        })
        .collect()
    }
}

/// Names of the tables and lists that a run of this model writes; grids come with the steps.
pub fn names(model: &Model) -> Vec<&'static str> {
    let tables = TABLES.iter().copied().filter(|kind| (kind.wanted)(model)).map(|kind| kind.file);
    let lists = |format| if format == FieldFormat::Frd { vec![frd::NAME] } else { LISTS.to_vec() };
    tables.chain(model.output.fields.into_iter().flat_map(|files| lists(files.format))).collect()
}

impl Observer for Files {
    fn on_step(&mut self, frame: &Frame) -> io::Result<()> {
        let case = frame.case.and_then(|case| case.name);
        for (index, table) in self.tables.iter_mut().enumerate() {
            let is_due = frame.due || table.takes_every_step();
            let OpenTable { kind, file, write } = table;
            let Some(write) = write else { continue };
            if let Some((_, name)) = case {
                file.begin_case(name);
            }
            if is_due {
                write(file, frame)?;
            }
            if let Some((place, _)) = case.filter(|_| !kind.every_step) {
                self.envelopes.take(index, place, |rows| write(rows, frame))?;
            }
        }
        if frame.last && case.is_some() {
            for (index, OpenTable { file, .. }) in self.tables.iter_mut().enumerate() {
                self.envelopes.write(index, frame.step, file)?;
            }
        }
        if let Some(fields) = &mut self.fields {
            fields.on_step(frame)?;
        }
        if let Some(frd) = &mut self.frd {
            frd.on_step(frame)?;
        }
        // The clock is looked at where there is something to write.
        let writes = frame.due || frame.step.is_multiple_of(64);
        if writes && self.flushed.elapsed() > PATIENCE { self.finish() } else { Ok(()) }
    }

    fn on_modes(&mut self, frame: &Frame) -> io::Result<()> {
        for OpenTable { kind, file, write } in &mut self.tables {
            if let Some(write) = write.as_ref().filter(|_| kind.needs.has(Wanted::MODES)) {
                write(file, frame)?;
            }
        }
        if let Some(frd) = &mut self.frd {
            frd.on_modes(frame)?;
        }
        match &mut self.fields {
            Some(fields) => fields.on_modes(frame),
            None => Ok(()),
        }
    }

    fn on_response(&mut self, frame: &Frame) -> io::Result<()> {
        for OpenTable { file, write, .. } in self.tables.iter_mut().filter(|table| holds_response(table.kind)) {
            if let Some(write) = write {
                write(file, frame)?;
            }
        }
        if self.flushed.elapsed() > PATIENCE { self.finish() } else { Ok(()) }
    }

    fn restart(&mut self, model: &Model) -> io::Result<()> {
        if let Some(fields) = &mut self.fields {
            fields.withdraw()?;
        }
        if let Some(frd) = &mut self.frd {
            frd.withdraw()?;
        }
        if model.analysis.begin > 0.0 {
            return self.tables.iter_mut().try_for_each(|table| table.file.withdraw_stage());
        }
        let keeps = RunKeeps { files: self.writes, numbers: &std::mem::take(&mut self.numbers) };
        *self = Files::waiting(&self.dir, keeps).begin(model)?;
        Ok(())
    }
}

/// The files that a run of this model writes, when, and how large they become.
pub fn listed(model: &Model, plan: &Plan) -> String {
    let output = &model.output;
    let names: Vec<&str> = TABLES.iter().filter(|kind| (kind.wanted)(model)).map(|kind| kind.file).collect();
    let chosen = output.cadence_is_open && output.cadence != Cadence::Steps(1);
    let open = if chosen { ", as rows would be many and `[output]` has neither `every` nor `interval`" } else { "" };
    let mut groups = vec![format!("{} ({}{open})", names.join(", "), in_words(output.cadence))];
    groups.extend(output.fields.map(|files| format!("fields ({})", in_words(files.cadence))));
    groups.extend(output.checkpoint.map(|apart| format!("a checkpoint every {apart} s of run time")));
    groups.push(size_in_words(model, plan));
    groups.join("; ")
}

fn in_words(cadence: Cadence) -> String {
    match cadence {
        Cadence::Steps(0 | 1) => "every step".to_owned(),
        Cadence::Steps(every) => format!("every {every} steps"),
        Cadence::Interval(interval) => format!("every {interval} of time"),
        Cadence::Apart(apart) => format!("at steps {} of time or more apart", short(apart)),
    }
}

/// The results that the solver must compute for the tables, fields and expectations of a model.
pub fn wanted(model: &Model) -> Wanted {
    wanted_with(model, &[])
}

/// Like [`wanted`], with extremes that are found in the rows of every step.
pub fn wanted_with(model: &Model, numbers: &[Collected]) -> Wanted {
    // Tables that a sweep leaves out count too: results do not depend on `keep`.
    let tables = TABLES.iter().copied().filter(|kind| (kind.wanted)(model));
    let tables = tables.map(|kind| if has_peak(kind, numbers) { kind.needs.at_every_step() } else { kind.needs });
    let drawn = (Wanted::PLASTIC_STRAINS | Wanted::SHELLS | Wanted::NODAL_RESULTANTS).where_drawn();
    // Stresses of fibres are those of integration points.
    let drawn = if model.yields() { drawn | Wanted::SECTIONS.where_drawn() } else { drawn };
    let fields = model.output.fields.map(|_| drawn);
    let expects = model.expects.iter().map(|expect| match expect.when {
        // A peak between two rows is one too.
        When::Max | When::Min | When::Abs => needs(expect.at, &expect.quantity).at_every_step(),
        When::Time(_) | When::Target(_) | When::End | When::Case(_) => needs(expect.at, &expect.quantity),
    });
    let all = tables.chain(fields).chain(expects).fold(Wanted::NOTHING, |all, of| all | of);
    let all = if model.yields() { all } else { all.without(Wanted::PLASTIC_STRAINS) };
    let all = if model.has_sections() { all } else { all.without(Wanted::NODAL_RESULTANTS) };
    if model.has_surfaces() { all } else { all.without(Wanted::SHELLS) }
}
