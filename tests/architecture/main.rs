//! The architecture of src, held by reading it: who may import whom, how large things may become, and in how many places a
//! kind is named. `cargo test --test architecture -- --nocapture` prints what was counted.
//!
//! Lists of exceptions stand at the top of each file; they may only become shorter, and a test says when one has.

mod budget;
mod circles;
mod kinds;
mod names;
mod ratchet;
mod rows;
mod silent;
mod sizes;
mod source;
mod step;

use source::Source;

/// Checks the source; a panic says what breaks the rule.
type Check = fn(&Source);

/// What is held of the source as a compiler sees it.
const RULES: [(&str, Check); 10] = [
    ("files of a room import in one direction", circles::files_of_a_room_import_in_one_direction),
    ("parts are known to few", kinds::parts_are_known_to_few),
    ("kinds are listed once", kinds::kinds_are_listed_once),
    ("types have names of their own", names::types_have_names_of_their_own),
    ("structs have few public fields", sizes::structs_have_few_public_fields),
    ("methods of a type stand together", sizes::methods_of_a_type_stand_together),
    ("functions are short", sizes::functions_are_short),
    ("the step is short", step::the_step_is_short),
    ("thresholds stand in one file", step::thresholds_stand_in_one_file),
    ("few functions take the workspace", step::few_functions_take_the_workspace),
];

/// One test for all rules: to read the source takes longer than to check it. Each rule is checked, whatever the others say.
#[test]
fn the_source_keeps_its_rules() {
    let source = Source::read();
    let breaks = |rule: Check| std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| rule(&source))).is_err();
    let broken: Vec<&str> = RULES.iter().filter(|(_, rule)| breaks(*rule)).map(|(name, _)| *name).collect();
    assert!(broken.is_empty(), "broken rules: {}", broken.join("; "));
}
