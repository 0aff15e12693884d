//! Decks of Abaqus and CalculiX: a file is read whole, and becomes a deck, its mesh, and a verdict on every keyword.
//!
//! ```text
//!  text ──▶ keywords ──▶ importer ──▶ build ──▶ deck text, mesh text, verdicts
//! ```
//!
//! Each keyword has a row in [`keywords::KEYWORDS`], with the function that reads it or the reason why none does. Reading fills the importer with
//! the content of the file, family by family. Building then resolves sets and instances and writes tables of the deck.
//! Nothing is dropped in silence.

mod amplitude_cards;
mod assemble;
mod base_motion;
mod bodies;
mod build;
mod connector_cards;
mod constraint_cards;
mod contact_cards;
mod contact_content;
mod contacts;
mod deck_text;
mod dialect;
mod distributing;
mod edge_loads;
mod element_types;
mod equations;
mod file_content;
mod flat_mesh;
mod harmonics;
mod importer;
mod joints;
mod keyword_block;
pub mod keywords;
mod laws;
mod linear;
mod links;
mod loads;
mod material_cards;
mod material_starts;
mod material_table;
mod mesh_cards;
mod mesh_makers;
mod mesh_text;
mod model_changes;
mod nodal_axes;
mod nodal_numbers;
mod output;
mod part_piece;
mod parts;
mod pretension;
mod property_cards;
mod robot;
mod robot_deck;
mod scopes;
mod section_cards;
mod single_loads;
mod spread_loads;
mod stage_text;
mod step_cards;
mod supports;
mod surface_ties;
mod surfaces;
mod temperatures;
mod thin_sections;
mod tied_nodes;
mod ties;
mod time_formula;
mod timeline;
mod units_hint;
mod unread;
mod urdf;
mod verdicts;

pub use dialect::Dialect;
pub use urdf::import_robot;
pub use verdicts::{KeywordVerdict, VerdictRow, Verdicts};

use base::diagnostic::Diagnostic;
use base::text_file::{Text, foreign, includes};
use importer::Importer;
use keyword_block::KeywordBlock;
use keywords::Treatment;
use scopes::Scopes;
use std::fmt::Write;

/// The options for a file.
#[derive(Debug, Default)]
pub struct ImportOptions {
    /// The program of the file; by default signs in the file decide.
    pub dialect: Option<Dialect>,
    /// The word for its units; by default that of a remark in the file.
    pub units: Option<String>,
    /// The name of the mesh file in the deck.
    pub mesh_file: String,
}

/// A deck that has been made of a file.
pub struct Imported {
    /// The deck.
    pub deck: String,
    /// Its mesh.
    pub mesh: String,
    /// The verdict on each keyword.
    pub verdicts: Verdicts,
}

/// The keywords of a file that is a mesh alone.
const IN_MESHES: &[&str] = &["HEADING", "NODE", "ELEMENT", "NSET", "ELSET", "SURFACE"];

/// Makes a deck of a file.
pub fn import(text: &mut Text, options: &ImportOptions) -> Imported {
    let blocks = keyword_block::blocks(text);
    let keywords = blocks.iter().map(|block| (block.keyword.line, format!("*{}", block.keyword.name))).collect();
    let count = blocks.iter().filter(|block| block.keyword.key() == "INSTANCE").count() as u64;
    let largest = largest(&blocks);
    let step =
        if count > 1 || has_outer_nodes(&blocks) { 10u64.pow(largest.checked_ilog10().unwrap_or(0) + 1) } else { 0 };
    let text: &Text = text;
    let scopes = Scopes { outer_offset: count * step, step, largest, ..Scopes::default() };
    let dialect = options.dialect.or_else(|| Dialect::of(text, &blocks));
    let mut im = Importer::new(text, Verdicts::new(keywords), dialect, scopes);
    let rows: Vec<_> = blocks.iter().map(|block| keywords::row(&block.keyword.key())).collect();
    for (block, row) in blocks.iter().zip(&rows) {
        read(&mut im, block, *row);
    }
    let built = assemble::build(&mut im, &options.mesh_file);
    let has = |words: &[&str], block: &KeywordBlock| words.contains(&block.keyword.key().as_str());
    let is_mesh = blocks.iter().any(|block| has(&["NODE"], block)) && blocks.iter().all(|block| has(IN_MESHES, block));
    let alone = || {
        is_mesh.then_some((
            "a mesh alone, without *STEP",
            "name it in a deck: `[mesh] file = \"NAME.inp\"`; its sets are groups there",
        ))
    };
    if let Some((kind, hint)) = foreign::recognized(&String::from_utf8_lossy(text.bytes)).or_else(alone) {
        // Other verdicts would ask for changes to a file that is read otherwise.
        im.verdicts = Verdicts::new(std::mem::take(&mut im.verdicts.keywords));
        let about = format!("this file is {kind}");
        let said = Box::new(Diagnostic { hints: vec![hint.to_owned()], ..*text.fault(about.as_str(), 1) });
        im.verdicts.add(text, KeywordVerdict::Refused, 1, Some(said), about);
    }
    for (block, row) in blocks.iter().zip(&rows) {
        let line = block.keyword.line;
        if let Some(row) = row
            && !im.verdicts.has(line)
        {
            im.verdicts.add(im.text, KeywordVerdict::Translated, line, None, row.about.to_owned());
        }
        if let Some(row) = row.filter(|row| matches!(row.treatment, Treatment::Read(_))) {
            unread::report(&mut im, block, row);
        }
    }
    im.verdicts.rows.sort_by_key(|row| row.line);
    let head = head(&im, options);
    let deck = built.deck.write(&head, |line| source(text, line));
    Imported { deck, mesh: built.mesh, verdicts: im.verdicts }
}

/// Reads one keyword.
fn read(im: &mut Importer, block: &KeywordBlock, row: Option<&'static keywords::KeywordRow>) {
    let line = block.keyword.line;
    let Some(row) = row else {
        return im.refuse(line, &format!("*{} is not known", block.keyword.name));
    };
    match row.treatment {
        Treatment::Ignore => im.ignore(line, row.about),
        Treatment::Refuse => im.refuse(line, row.about),
        Treatment::Read(read) => {
            block.keyword.forget_reads();
            // The lines of that file are in the text already.
            includes::included(&block.keyword);
            read(im, block);
            unread::judge(im, block, row);
        }
    }
}

/// The largest number of a node or an element.
fn largest(blocks: &[KeywordBlock]) -> u64 {
    let numbered = blocks.iter().filter(|block| ["NODE", "ELEMENT"].contains(&block.keyword.key().as_str()));
    let first = numbered.flat_map(|block| &block.data).filter_map(|data| data.words.first()?.whole());
    let largest = first.filter(|id| *id <= u64::from(u32::MAX)).max().unwrap_or(0);
    mesh_makers::largest(blocks, largest)
}

/// True where nodes or elements stand in the assembly itself.
fn has_outer_nodes(blocks: &[KeywordBlock]) -> bool {
    let (mut is_inside, mut has_instance, mut found) = (false, false, false);
    for block in blocks {
        match block.keyword.key().as_str() {
            "PART" | "INSTANCE" => {
                is_inside = true;
                has_instance |= block.keyword.key() == "INSTANCE";
            }
            "ENDPART" | "ENDINSTANCE" | "ASSEMBLY" => is_inside = false,
            "NODE" | "ELEMENT" if !is_inside && has_instance => found = true,
            _ => {}
        }
    }
    found
}

/// The file, the line of the text, and its words.
fn source(text: &Text, line: usize) -> String {
    let excerpt = text.excerpt(line);
    let (path, number) = text.origin(line);
    let path = path.rsplit(['/', '\\']).next().unwrap_or(path);
    let shown: String = excerpt.text.trim().chars().filter(|c| !c.is_control()).take(100).collect();
    format!("{path}:{number} {shown}")
}

/// The comment above the tables.
fn head(im: &Importer, options: &ImportOptions) -> String {
    let path = im.text.path.rsplit(['/', '\\']).next().unwrap_or(im.text.path);
    let mut head = format!("# made of {path} by rdsolve import\n");
    let placed = im.scopes.instances.iter().map(|at| (&at.own.name, at.offset));
    for (name, offset) in placed.filter(|(_, offset)| *offset > 0) {
        let _ = writeln!(head, "# node 1 of {name} is mesh.{} here: {offset} is added to all its numbers", offset + 1);
    }
    if im.scopes.outer_offset > 0 && !im.scopes.outer.nodes.is_empty() {
        let _ = writeln!(head, "# {} is added to the numbers of the assembly", im.scopes.outer_offset);
    }
    if !im.title.is_empty() {
        let _ = writeln!(head, "title = {}", deck_text::quoted(&im.title));
    }
    if let Some(units) = options.units.clone().or_else(|| units_hint::units(im.text).map(str::to_owned)) {
        let _ = writeln!(head, "units = {}", deck_text::quoted(&units));
    }
    head
}
