//! docs/import.md: what becomes of each keyword, from the table of the importer.

use super::{keep, read, root, with_generated};

#[test]
fn docs_list_every_keyword_of_other_programs() {
    let page = read(&root().join("docs/import.md"));
    keep("docs/import.md", &with_generated(&page, &import::keywords::page()));
}
