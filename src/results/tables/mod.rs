//! The tables of results, a file each. A new table is one more file and one line of [`TABLES`].

mod bars;
mod bodies;
mod campbell;
mod contact_pairs;
mod contacts;
mod critical_speeds;
mod drifts;
mod energy;
mod joints;
mod layers;
mod links;
mod mode_parts;
mod mode_shapes;
mod modes;
mod nodes;
mod parts;
mod reactions;
mod response;
mod response_links;
mod sections;
mod shell_order;
mod shells;
mod steps;
mod ties;

use super::table::TableKind;
use base::quantities::RESPONSE_FREQUENCY;

/// All tables, in their order for readers.
pub static TABLES: &[&TableKind] = &[
    &nodes::TABLE,
    &drifts::TABLE,
    &bodies::TABLE,
    &energy::TABLE,
    &links::TABLE,
    &contacts::TABLE,
    &contact_pairs::TABLE,
    &joints::TABLE,
    &ties::TABLE,
    &reactions::TABLE,
    &sections::TABLE,
    &bars::TABLE,
    &shells::TABLE,
    &layers::TABLE,
    &parts::TABLE,
    &modes::TABLE,
    &mode_parts::TABLE,
    &mode_shapes::TABLE,
    &response::TABLE,
    &response_links::TABLE,
    &campbell::TABLE,
    &critical_speeds::TABLE,
    &steps::TABLE,
];

/// The table of a file; `None` where the file is no table of a run.
pub fn of_file(name: &str) -> Option<&'static TableKind> {
    TABLES.iter().copied().find(|table| table.file == name)
}

/// True for the tables of a frequency response. Their rows come in parts, see [`solve::Observer::on_response`], and have a frequency besides
/// the time of the state.
pub fn holds_response(table: &TableKind) -> bool {
    table.columns().any(|column| column == RESPONSE_FREQUENCY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_column_is_described_once() {
        let files: HashSet<&str> = TABLES.iter().map(|table| table.file).collect();
        assert_eq!(files.len(), TABLES.len());
        for table in TABLES {
            let names: HashSet<&str> = table.columns().map(|column| column.name).collect();
            assert_eq!(names.len(), table.columns().count(), "{}", table.file);
            assert!(table.about.ends_with('.'), "{}", table.file);
            assert!(table.columns().all(|column| !column.meaning.is_empty()), "{}", table.file);
        }
    }
}
