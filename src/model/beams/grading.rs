//! Elements of different lengths along a segment of a path: short at its ends, where hinges form and boundary layers lie, long between.

use crate::part_context::PartContext;
use deck::words::{Maybe, OneOrMany};

/// A segment of fewer elements is all ends.
const FEWEST: usize = 3;

/// Reads the grading of each segment; `counts` are the numbers of their elements. Default: 1.
pub fn gradings(grading: &Maybe<OneOrMany<f64>>, counts: &[usize], cx: &mut PartContext) -> Option<Vec<f64>> {
    let Some(grading) = grading else { return Some(vec![1.0; counts.len()]) };
    let mut sound = Some(());
    for value in &grading.values {
        if !(value.value > 0.0 && value.value <= 1.0) {
            let message = "`grading` must be above 0 and at most 1";
            let hint = "it is the length of the first and the last element of a segment over that of its longest; 1 makes all alike";
            sound = cx.report.error_with(&value.span, message, hint);
        }
    }
    if !grading.single && grading.values.len() != counts.len() {
        let message = format!("`grading` has {} numbers and the path {} segments", grading.values.len(), counts.len());
        let hint = "give one for each segment, or one number without brackets for all";
        return cx.report.error_with(&grading.span, message, hint);
    }
    sound?;
    let of = |segment: usize| &grading.values[if grading.single { 0 } else { segment }];
    for (segment, &count) in counts.iter().enumerate() {
        if count < FEWEST && of(segment).value < 1.0 {
            let message =
                format!("`grading` takes {FEWEST} elements or more in a segment; segment {} has {count}", segment + 1);
            let hint = "elements at the ends are shorter than those between";
            return cx.report.error_with(&of(segment).span, message, hint);
        }
    }
    Some((0..counts.len()).map(|segment| of(segment).value).collect())
}

/// The places where the `count` elements of a segment begin and end, as parts of its length. From either end to the middle, the lengths of
/// elements grow by a constant factor; the first and the last are `grading` times the longest.
pub fn cuts(count: usize, grading: f64) -> Vec<f64> {
    let middle = (count - 1) / 2;
    let length = |element: usize| {
        let from_end = element.min(count - 1 - element);
        if middle == 0 { 1.0 } else { grading.powf(1.0 - from_end as f64 / middle as f64) }
    };
    let whole: f64 = (0..count).map(length).sum();
    let mut cuts = vec![0.0; count + 1];
    // From both ends, so that the halves are alike to the last bit.
    let mut end = 0.0;
    for element in 0..count.div_ceil(2) {
        end += length(element) / whole;
        cuts[element + 1] = end;
        cuts[count - element - 1] = 1.0 - end;
    }
    if count.is_multiple_of(2) {
        cuts[count / 2] = 0.5;
    }
    (cuts[0], cuts[count]) = (0.0, 1.0);
    cuts
}
