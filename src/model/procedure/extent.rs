//! How many modes an analysis finds: `modes` or `up_to` of `[analysis]`.

use crate::data::ModeExtent;
use crate::report::Report;
use deck::analysis::Analysis;

/// Number of modes unless the deck says otherwise.
const MODES: usize = 10;
/// Most modes that are computed at once.
const MOST: usize = 2000;

/// The modes that the keys of modes ask for.
pub fn extent(analysis: &Analysis, report: &mut Report) -> ModeExtent {
    if let (Some(_), Some(up_to)) = (&analysis.modes, &analysis.up_to) {
        let hint = "the number of modes follows from the frequency";
        report.error_with::<()>(&up_to.span, "`modes` or `up_to` is given, not both", hint);
    }
    if let Some(frequency) = report.positive("up_to", &analysis.up_to) {
        return ModeExtent::UpTo(frequency);
    }
    ModeExtent::Count(count(analysis, report))
}

/// The number of modes.
pub fn count(analysis: &Analysis, report: &mut Report) -> usize {
    let count = report.count("modes", &analysis.modes, MODES);
    if let Some(at) = analysis.modes.as_ref().filter(|_| count > MOST) {
        report.error_with::<()>(&at.span, "`modes` asks for too many", format!("at most {MOST} are computed at once"));
    }
    count
}
