//! The work of a stress on a way of strains.

/// ∫σ dε from one strain to another. The stress is smooth between the `stops`; three Gauss points on each piece are exact for straight lines and
/// parabolas.
pub(super) fn work<const N: usize>([from, to]: [f64; 2], mut stops: [f64; N], stress: impl Fn(f64) -> f64) -> f64 {
    let [low, high] = [from.min(to), from.max(to)];
    stops.iter_mut().for_each(|stop| *stop = if *stop > low && *stop < high { *stop } else { high });
    stops.sort_unstable_by(f64::total_cmp);
    let (place, weights) = (0.6f64.sqrt(), [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0]);
    let (mut sum, mut start) = (0.0, low);
    for stop in stops.into_iter().chain([high]) {
        let half = 0.5 * (stop - start);
        if half > 0.0 {
            for (x, w) in [-place, 0.0, place].into_iter().zip(weights) {
                sum += w * half * stress(start + half * (1.0 + x));
            }
        }
        start = stop;
    }
    if to > from { sum } else { -sum }
}
