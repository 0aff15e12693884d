//! The places of what elements of different kinds remember, in the history of their group.

use std::ops::Range;

/// The places of the memories of several elements, where each has so many numbers.
pub fn places(counts: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    let mut at = 0;
    let place = |count: usize| {
        at += count;
        at - count..at
    };
    counts.map(place).collect()
}
