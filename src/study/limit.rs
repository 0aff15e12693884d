//! The limit that runs tend to as their steps or elements shrink (Richardson), and a bound of its error.

use super::history;

/// The least relative bound of the limit of equal runs, relative to the largest motion: rounding of many steps.
const ROUNDING: f64 = 1e-10;
/// A measured order may exceed that of the scheme by this; beyond, it is chance.
const ABOVE: f64 = 0.3;

/// The limit that some runs tend to.
#[derive(Debug, Clone)]
pub struct Limit {
    /// The values at the sample times one after the other, each time all quantities.
    pub q: Vec<f64>,
    /// A bound of its error, relative as errors are.
    pub error_bound: f64,
    /// The order of the extrapolation; `None` where nothing was extrapolated.
    pub order: Option<f64>,
    /// The factor by which errors of the extrapolated values can grow.
    pub growth: f64,
}

/// The limit of runs `q` with steps or element sizes `h`, coarse to fine; `most` is the highest order that they can have.
pub fn limit(h: &[f64], q: &[&[f64]], count: usize, most: f64) -> Option<Limit> {
    let n = q.len();
    let (fine, before) = (q.last()?, q.get(n.checked_sub(2)?)?);
    let last = history::error(before, fine, count, |_| true).max(ROUNDING);
    // At first order the finest run is off by Δ/(r − 1): less is not taken for granted where no order is seen.
    let ratio = h[n - 2] / h[n - 1];
    let as_it_is = Limit { q: fine.to_vec(), error_bound: last / (ratio - 1.0).min(1.0), order: None, growth: 1.0 };
    let Some(first) = n.checked_sub(3).map(|i| q[i]) else { return Some(as_it_is) };
    let (r1, r2) = (h[n - 3] / h[n - 2], h[n - 2] / h[n - 1]);
    let ratio = distance(first, before) / distance(before, fine);
    let Some(order) = order(ratio, r1, r2).filter(|order| *order <= most + ABOVE) else { return Some(as_it_is) };
    let whole = (order - order.round()).abs() < 0.2;
    let order = if whole { order.round() } else { order };
    let toward = |coarse: &[f64], fine: &[f64], r: f64, order: f64| -> Vec<f64> {
        let part = 1.0 / (r.powf(order) - 1.0);
        fine.iter().zip(coarse).map(|(fine, coarse)| fine + part * (fine - coarse)).collect()
    };
    let best = toward(before, fine, r2, order);
    let apart = |other: &[f64]| history::error(other, &best, count, |_| true);
    let mut error_bound = apart(&toward(first, before, r1, order)).max(ROUNDING);
    // An order as it was measured makes the two agree whatever the truth is: the orders next to it may be that.
    if !whole {
        let least = if order < 1.0 { fine.to_vec() } else { toward(before, fine, r2, order.floor()) };
        error_bound = error_bound.max(apart(&least)).max(apart(&toward(before, fine, r2, order.ceil())));
    }
    // If the extrapolation is no better than the runs, there is no order.
    if error_bound >= as_it_is.error_bound {
        return Some(as_it_is);
    }
    let growth = 1.0 + 2.0 / (r2.powf(order) - 1.0);
    Some(Limit { q: best, error_bound, order: Some(order), growth })
}

/// The Euclidean distance of two runs.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The order p at which successive differences have the ratio Δ₁/Δ₂ = r₂ᵖ (r₁ᵖ − 1)/(r₂ᵖ − 1). The ratio rises with p; `None` if p lies
/// outside 0.4 to 12.
fn order(ratio: f64, r1: f64, r2: f64) -> Option<f64> {
    let of = |p: f64| r2.powf(p) * (r1.powf(p) - 1.0) / (r2.powf(p) - 1.0);
    let (mut low, mut high) = (0.4, 12.0);
    if !(of(low)..=of(high)).contains(&ratio) {
        return None;
    }
    for _ in 0..60 {
        let p = 0.5 * (low + high);
        if of(p) < ratio { low = p } else { high = p }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// q(h) = 1 + c hᵖ + d hᵖ⁺¹ at two times; the limit is 1.
    fn runs(h: &[f64], p: f64, d: f64) -> Vec<Vec<f64>> {
        h.iter().map(|h| vec![1.0 + 0.3 * h.powf(p) + d * h.powf(p + 1.0), 1.0 - 0.2 * h.powf(p)]).collect()
    }

    #[test]
    fn the_bar_holds_the_error_of_the_limit() {
        for p in [1.0, 1.5, 1.6, 2.0, 2.4, 3.0, 4.0] {
            for h in [[0.4, 0.2, 0.1], [0.3, 0.2, 0.1], [0.3, 0.15, 0.1]] {
                let runs = runs(&h, p, 0.2);
                let q: Vec<&[f64]> = runs.iter().map(Vec::as_slice).collect();
                let limit = limit(&h, &q, 1, f64::INFINITY).unwrap();
                let error = history::error(&limit.q, &[1.0, 1.0], 1, |_| true);
                let finest = history::error(&runs[2], &[1.0, 1.0], 1, |_| true);
                assert!(error <= limit.error_bound, "order {p}, {h:?}: {error} of {}", limit.error_bound);
                // It says more than the finest run itself, or not much less: at high orders the resolution above is far off.
                let most = if p == p.round() && p < 4.0 { 1.0 } else { 3.0 };
                assert!(limit.error_bound < most * finest, "order {p}, {h:?}: {} of {finest}", limit.error_bound);
            }
        }
    }

    #[test]
    fn the_order_is_found_whatever_the_ratios() {
        for (r1, r2) in [(2.0, 2.0), (1.5, 2.0), (3.0, 1.25)] {
            for p in [0.7, 1.0, 2.0, 4.0] {
                let (h0, h1, h2) = (r1 * r2, r2, 1.0_f64);
                let difference = |a: f64, b: f64| a.powf(p) - b.powf(p);
                let found = order(difference(h0, h1) / difference(h1, h2), r1, r2).unwrap();
                // After 60 halvings of the interval from 0.4 to 12 only rounding is left.
                assert!((found - p).abs() < 1e-9, "{found} for {p}");
            }
        }
        assert_eq!(order(0.9, 2.0, 2.0), None);
    }

    #[test]
    fn an_order_above_that_of_the_scheme_is_none() {
        let runs = runs(&[0.4, 0.2, 0.1], 3.0, 0.0);
        let q: Vec<&[f64]> = runs.iter().map(Vec::as_slice).collect();
        let of = |most: f64| limit(&[0.4, 0.2, 0.1], &q, 1, most).unwrap();
        assert_eq!((of(3.0).order, of(2.0).order), (Some(3.0), None));
        assert_eq!((of(2.0).q.as_slice(), of(2.0).error_bound), (q[2], history::error(q[1], q[2], 1, |_| true)));
    }

    #[test]
    fn runs_that_are_alike_resolve_no_more_than_rounding() {
        let run = vec![1.0, 2.0];
        let other = vec![1.1, 1.9];
        for q in [vec![run.as_slice(); 2], vec![run.as_slice(); 3], vec![&other, &run, &run]] {
            let h: Vec<f64> = (0..q.len()).rev().map(|k| 2f64.powi(k as i32)).collect();
            let limit = limit(&h, &q, 1, f64::INFINITY).unwrap();
            assert_eq!((limit.error_bound, limit.q), (ROUNDING, run.clone()));
        }
    }

    #[test]
    fn runs_without_an_order_are_their_own_bar() {
        let runs = [vec![1.0, 2.0], vec![1.1, 1.9], vec![0.9, 2.2]];
        let q: Vec<&[f64]> = runs.iter().map(Vec::as_slice).collect();
        let limit = limit(&[4.0, 2.0, 1.0], &q, 1, f64::INFINITY).unwrap();
        assert_eq!((limit.q.as_slice(), limit.order), (&runs[2][..], None));
        assert_eq!(limit.error_bound, history::error(&runs[1], &runs[2], 1, |_| true));
    }
}
