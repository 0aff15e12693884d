//! Work along a force that consists of straight lines.

/// The area below `force` from the point `start` to the elongation `end` beyond. `stops` holds all corners between, among others; it is sorted.
pub fn area(start: [f64; 2], end: f64, stops: &mut [f64], force: &dyn Fn(f64) -> f64) -> f64 {
    let [mut x, mut f] = start;
    // Lines that are parallel meet nowhere.
    stops.iter_mut().filter(|stop| !(**stop > x && **stop < end)).for_each(|stop| *stop = end);
    stops.sort_unstable_by(f64::total_cmp);
    let mut sum = 0.0;
    for stop in stops.iter().copied().chain([end]) {
        let next = force(stop);
        sum += 0.5 * (f + next) * (stop - x);
        (x, f) = (stop, next);
    }
    sum
}
