//! A budget of lines: what src may hold, crate by crate. Whoever raises a number says why in the commit; whoever deletes lowers it.

use super::source::{CRATES, lines_below};

/// Lines of the sources below src by crate, `program` for what lies beside them.
const BUDGET: [(&str, usize); 11] = [
    ("base", 7112),
    ("linear", 4265),
    ("mechanics", 36_996),
    ("deck", 5534),
    ("import", 11_569),
    ("model", 30_340),
    ("solve", 37_395),
    ("results", 12_604),
    ("study", 4271),
    ("sweep", 1595),
    ("program", 7221),
];

#[test]
fn crates_keep_to_their_budgets() {
    let all = lines_below("");
    let below: Vec<(&str, usize)> = CRATES.iter().map(|name| (*name, lines_below(name))).collect();
    let program = all - below.iter().map(|(_, lines)| lines).sum::<usize>();
    let mut beyond = Vec::new();
    for ((name, lines), (listed, most)) in below.into_iter().chain([("program", program)]).zip(BUDGET) {
        assert_eq!(name, listed, "the budget lists the crates in their order");
        println!("{name:10} {lines:6} of {most:6} lines");
        if lines > most {
            beyond.push(format!("{name}: {lines} lines, {} more than its budget of {most}", lines - most));
        }
    }
    println!("src        {all:6} of {:6} lines", BUDGET.iter().map(|(_, most)| most).sum::<usize>());
    assert!(beyond.is_empty(), "src is larger than its budget in tests/architecture/budget.rs:\n{}", beyond.join("\n"));
}
