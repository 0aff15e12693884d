//! `rdsolve run deck.toml`.

use super::{Exit, RunArgs, load, output_folder, show};

pub(super) fn run(args: &RunArgs) -> Result<(), Exit> {
    let loaded = load(&args.deck, &args.sets)?;
    let folder = output_folder(args)?;
    if !args.quiet {
        show(&loaded.warnings, &loaded.source);
    }
    super::print(&format!(
        "{}: {} nodes, results in {}\n",
        loaded.source.path,
        loaded.model.nodes.len(),
        folder.display()
    ))
}
