//! The numbers of a table at the times of comparison.

use base::snapshot::keep;

/// Largest number of numbers of one table that are kept of a run.
const MOST: usize = 1 << 21;

/// All numbers of a table at some times.
#[derive(Debug, Clone, Default)]
pub struct ComparedHistory {
    /// The times, rising.
    times: Vec<f64>,
    /// The numbers of each time, and where those of the first, second, ... end.
    numbers: Vec<f64>,
    ends: Vec<usize>,
    /// True where a time had no room.
    is_full: bool,
}

keep!(ComparedHistory { times, numbers, ends, is_full });

impl ComparedHistory {
    /// Keeps the numbers of a time; where there is no more room nothing is known any more.
    pub fn keep(&mut self, time: f64, numbers: &[f64]) {
        self.is_full |= self.numbers.len() + numbers.len() > MOST;
        if self.is_full {
            return;
        }
        self.times.push(time);
        self.numbers.extend_from_slice(numbers);
        self.ends.push(self.numbers.len());
    }

    /// The times, in order.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The numbers of a time, to `rounding`; `None` where it was not kept.
    pub fn numbers_at(&self, time: f64, rounding: f64) -> Option<&[f64]> {
        let place = self.times.iter().position(|own| (own - time).abs() <= rounding)?;
        Some(self.at(place))
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.times.clear();
        self.numbers.clear();
        self.ends.clear();
        self.is_full = false;
    }

    /// The largest difference to another run at any time that both have, for each of so many columns; NaN does not count. `None` where they
    /// have no time in common, or one was too large to keep. Times within `rounding` of each other are the same.
    pub fn largest_differences(&self, other: &ComparedHistory, columns: usize, rounding: f64) -> Option<Vec<f64>> {
        if self.is_full || other.is_full {
            return None;
        }
        let mut largest = None;
        let mut theirs = 0;
        for (mine, &time) in self.times.iter().enumerate() {
            while other.times.get(theirs).is_some_and(|their_time| *their_time < time - rounding) {
                theirs += 1;
            }
            let same = other.times.get(theirs).is_some_and(|their_time| *their_time <= time + rounding);
            let (a, b) = (self.at(mine), other.at(theirs));
            if !same || a.len() != b.len() {
                continue;
            }
            let largest = largest.get_or_insert_with(|| vec![0.0f64; columns]);
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                let column = &mut largest[index % columns];
                *column = column.max((a - b).abs());
            }
        }
        largest
    }

    /// The numbers of the k-th time; empty beyond the last.
    fn at(&self, k: usize) -> &[f64] {
        let start = k.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        self.ends.get(k).map_or(&[], |&end| &self.numbers[start..end])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_common_times_are_compared() {
        let (mut one, mut other) = (ComparedHistory::default(), ComparedHistory::default());
        one.keep(0.5, &[1.0, 10.0, 2.0, 20.0]);
        one.keep(0.7, &[1.0, 10.0, 2.0, 20.0]);
        other.keep(0.1, &[9.0; 4]);
        other.keep(0.7, &[1.5, 10.0, 1.75, 17.0]);
        other.keep(0.9, &[9.0; 4]);
        assert_eq!(one.largest_differences(&other, 2, 1e-9), Some(vec![0.5, 3.0]));
        assert_eq!(one.largest_differences(&ComparedHistory::default(), 2, 1e-9), None);
    }
}
