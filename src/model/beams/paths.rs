//! Paths of beams and bars: successive points, and the division of each segment into elements.

use crate::part_context::PartContext;
use crate::parts::MOST_IN_SEGMENT;
use crate::report::Owner;
use base::diagnostic::At;
use deck::words::{Maybe, OneOrMany};

/// Finds the nodes of a path of two or more points and connects them, for a beam with their `rotations`.
pub fn path<'d>(
    owner: &Owner<'d>,
    path: &'d Maybe<OneOrMany<String>>,
    rotations: bool,
    cx: &mut PartContext<'_, 'd>,
) -> Option<Vec<usize>> {
    let path = cx.report.require_nodes(owner, "path", path)?;
    if path.values.len() < 2 {
        cx.report.lose_connections();
        cx.report.error_with::<()>(&path.span, "a path needs two points or more", "such as [\"foot\", \"knee\"]");
    }
    let nodes: Vec<Option<usize>> =
        path.values.iter().map(|point| cx.names.point("path", point, &cx.parts, cx.report)).collect();
    // They are connected even if the rest of the part has errors.
    nodes.iter().flatten().for_each(|&node| cx.nodes.connect(node, rotations));
    nodes.into_iter().collect::<Option<Vec<usize>>>().filter(|nodes| nodes.len() >= 2)
}

/// Reports segments without length.
pub fn segments<'d>(
    owner: &Owner<'d>,
    points: &'d [At<String>],
    path: &[usize],
    cx: &mut PartContext<'_, 'd>,
) -> Option<()> {
    let mut sound = Some(());
    for (i, pair) in path.windows(2).enumerate() {
        let [x0, x1] = [cx.nodes.x(pair[0]), cx.nodes.x(pair[1])];
        // Below this the ends agree to round-off of their coordinates.
        if (x1 - x0).norm() <= 1e-12 * x0.amax().max(x1.amax()) {
            let [from, to] = [&points[i], &points[i + 1]];
            let message = format!("{}: segment `{}` - `{}` has no length", owner.what, from.value, to.value);
            sound = cx.report.error_with(&to.span, message, "its ends lie at the same place");
        }
    }
    sound
}

/// Reads how many elements each segment is cut into.
pub fn counts<'d>(elements: &At<OneOrMany<u64>>, segments: usize, cx: &mut PartContext<'_, 'd>) -> Option<Vec<usize>> {
    let mut sound = true;
    for count in &elements.values {
        if count.value == 0 || count.value > MOST_IN_SEGMENT {
            let message = format!("`elements` must lie between 1 and {MOST_IN_SEGMENT}");
            cx.report.error::<()>(&count.span, message);
            sound = false;
        }
    }
    if !elements.single && elements.values.len() != segments {
        let message = format!("`elements` has {} numbers and the path {segments} segments", elements.values.len());
        return cx.report.error_with(
            &elements.span,
            message,
            "give one for each segment, or one number without brackets for all",
        );
    }
    let count = |segment: usize| elements.values[if elements.single { 0 } else { segment }].value as usize;
    if !sound {
        return None;
    }
    cx.parts.require_room()?;
    Some((0..segments).map(count).collect())
}
