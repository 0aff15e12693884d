//! A joint fit e = a hᵖ + b Δt^q of the errors of a grid of meshes and steps, and the cheapest pair (h, Δt) on it.
//!
//! The fit is nonlinear least squares of ln e, since errors span decades, by Levenberg and Marquardt from several starts. A part
//! that shows nowhere in the grid cannot be fitted, and is left out. Costs are c = k h⁻ʳ Δt⁻ˢ, by linear least squares of ln c.

/// Exponents to start from: those of common elements and schemes.
const STARTS: [f64; 4] = [1.0, 2.0, 4.0, 6.0];
/// The exponents that are believed.
const EXPONENTS: [f64; 2] = [0.2, 16.0];
/// A part of the error is seen where it is more than this share of it, which is twice what fits of clean data leave.
const SEEN: f64 = 0.2;
/// Iterations of a fit; it converges in ten to thirty.
const MOST: usize = 200;

/// A run of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The size of the elements, relative to that of the deck.
    pub h: f64,
    /// The time step.
    pub dt: f64,
    /// The error.
    pub error: f64,
    /// The seconds of the time stepping.
    pub cost: f64,
}

/// One part of the error: factor · x^exponent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    /// The factor before the power.
    pub factor: f64,
    /// The order that the grid shows.
    pub exponent: f64,
}

impl PowerLaw {
    /// The part at a size of elements or a step.
    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }

    /// The size of elements, or the step, at which the part is this large.
    fn inverse(&self, error: f64) -> f64 {
        (error / self.factor).powf(1.0 / self.exponent)
    }
}

/// The error over a grid of meshes and steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointFit {
    /// a hᵖ; `None` where no run shows an error of the mesh.
    pub mesh: Option<PowerLaw>,
    /// b Δt^q; `None` where no run shows an error of the step.
    pub step: Option<PowerLaw>,
    /// What is left unexplained: the root mean square of ln e − ln fit.
    pub rest: f64,
    /// The largest of these differences.
    pub largest: f64,
    /// The number of runs that it is fitted to.
    pub runs: usize,
}

/// The cost over a grid, c = k h⁻ʳ Δt⁻ˢ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CostFit {
    /// ln k, r, s.
    log: [f64; 3],
}

/// A pair of mesh and step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// The size of the elements, relative to that of the deck.
    pub h: f64,
    /// The time step.
    pub dt: f64,
    /// Its cost, as fitted.
    pub cost: f64,
}

impl JointFit {
    /// The error at a pair, as fitted.
    pub fn at(&self, h: f64, dt: f64) -> f64 {
        self.mesh.map_or(0.0, |part| part.at(h)) + self.step.map_or(0.0, |part| part.at(dt))
    }

    /// The step that leaves this error on a mesh; `None` where the mesh alone leaves more, or steps leave nothing.
    pub fn step_for(&self, h: f64, error: f64) -> Option<f64> {
        let left = error - self.mesh.map_or(0.0, |part| part.at(h));
        self.step.filter(|_| left > 0.0).map(|part| part.inverse(left))
    }

    /// The cheapest pair of all sizes for an error. By Lagrange, mesh and step share the error as r/p to s/q.
    pub fn cheapest(&self, cost: &CostFit, error: f64) -> Option<Pair> {
        let (mesh, step) = (self.mesh?, self.step?);
        let [_, r, s] = cost.log;
        if r <= 0.0 || s <= 0.0 {
            return None;
        }
        let (of_mesh, of_step) = (r / mesh.exponent, s / step.exponent);
        let share = of_mesh / (of_mesh + of_step);
        let (h, dt) = (mesh.inverse(share * error), step.inverse((1.0 - share) * error));
        Some(Pair { h, dt, cost: cost.at(h, dt) })
    }
}

impl CostFit {
    /// The cost over the runs; `None` where they do not tell how it grows with mesh and step.
    pub fn new(points: &[Point]) -> Option<CostFit> {
        let rows = points.iter().filter(|point| point.cost > 0.0);
        let rows: Vec<([f64; 3], f64)> =
            rows.map(|point| ([1.0, -point.h.ln(), -point.dt.ln()], point.cost.ln())).collect();
        let (mut matrix, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
        for (row, value) in &rows {
            for i in 0..3 {
                right[i] += row[i] * value;
                (0..3).for_each(|j| matrix[i][j] += row[i] * row[j]);
            }
        }
        solve(matrix, right).map(|log| CostFit { log })
    }

    /// The cost of a pair.
    pub fn at(&self, h: f64, dt: f64) -> f64 {
        (self.log[0] - self.log[1] * h.ln() - self.log[2] * dt.ln()).exp()
    }
}

/// Fits the error over a grid.
///
/// # Errors
/// The runs are too few or too much alike; the error says so in words.
pub fn fit(points: &[Point]) -> Result<JointFit, &'static str> {
    let points: Vec<Point> = points.iter().copied().filter(|point| point.error > 0.0).collect();
    let different = |of: &dyn Fn(&Point) -> f64| {
        let mut values: Vec<f64> = points.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    if different(&|point| point.h) < 2 || different(&|point| point.dt) < 2 {
        return Err("two meshes and two steps at least are wanted");
    }
    if points.len() < 5 {
        return Err("five runs at least whose error is known are wanted, for four numbers are fitted");
    }
    let both = STARTS.iter().flat_map(|&p| STARTS[..3].iter().map(move |&q| (p, q)));
    let both = both.filter_map(|(p, q)| descend(&points, [true, true], [p, q]));
    let best = both.min_by(|a, b| a.rest.total_cmp(&b.rest));
    if let Some(fit) = best.filter(|fit| is_seen(fit, &points)) {
        return Ok(fit);
    }
    let one = [[true, false], [false, true]]
        .into_iter()
        .flat_map(|with| STARTS.into_iter().map(move |start| (with, [start, start])));
    let one = one.filter_map(|(with, start)| descend(&points, with, start));
    one.min_by(|a, b| a.rest.total_cmp(&b.rest)).ok_or("the errors follow no power of mesh or step")
}

/// True where both parts show at two sizes each at least, and their exponents are believable.
fn is_seen(fit: &JointFit, points: &[Point]) -> bool {
    let (Some(mesh), Some(step)) = (fit.mesh, fit.step) else { return false };
    let sizes = |of: &dyn Fn(&Point) -> (f64, f64)| {
        let shown = points.iter().map(of).filter(|(_, share)| *share > SEEN).map(|(size, _)| size);
        let (low, high) = shown.fold((f64::MAX, f64::MIN), |(l, h), size| (l.min(size), h.max(size)));
        high > low
    };
    let all = |point: &Point| fit.at(point.h, point.dt);
    let believed = [mesh, step].iter().all(|part| (EXPONENTS[0]..EXPONENTS[1]).contains(&part.exponent));
    believed
        && sizes(&|point| (point.h, mesh.at(point.h) / all(point)))
        && sizes(&|point| (point.dt, step.at(point.dt) / all(point)))
}

/// Descends by Levenberg and Marquardt from these exponents; `with` says which parts there are.
fn descend(points: &[Point], with: [bool; 2], exponents: [f64; 2]) -> Option<JointFit> {
    // Unknowns: ln a, p, ln b, q, about the geometric means of sizes and steps, so that they are nearly independent.
    let mean =
        |of: &dyn Fn(&Point) -> f64| points.iter().map(|point| of(point).ln()).sum::<f64>() / points.len() as f64;
    let (h0, dt0, e0) = (mean(&|point| point.h), mean(&|point| point.dt), mean(&|point| point.error));
    let mut x = [e0 - 0.7, exponents[0], e0 - 0.7, exponents[1]];
    let parts = |x: &[f64; 4], point: &Point| -> [f64; 2] {
        let part = |i: usize, log: f64| if with[i] { (x[2 * i] + x[2 * i + 1] * log).exp() } else { 0.0 };
        [part(0, point.h.ln() - h0), part(1, point.dt.ln() - dt0)]
    };
    let residual = |x: &[f64; 4], point: &Point| parts(x, point).iter().sum::<f64>().ln() - point.error.ln();
    let square = |x: &[f64; 4]| points.iter().map(|point| residual(x, point).powi(2)).sum::<f64>();
    let (mut now, mut damping) = (square(&x), 1e-2);
    for _ in 0..MOST {
        let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
        for point in points {
            let [mesh, step] = parts(&x, point).map(|part| part / parts(&x, point).iter().sum::<f64>());
            let row = [mesh, mesh * (point.h.ln() - h0), step, step * (point.dt.ln() - dt0)];
            let r = residual(&x, point);
            for i in 0..4 {
                right[i] -= row[i] * r;
                (0..4).for_each(|j| matrix[i][j] += row[i] * row[j]);
            }
        }
        // Unknowns that show nowhere stay where they are.
        (0..4).for_each(|i| matrix[i][i] += damping * matrix[i][i] + 1e-12);
        let Some(step) = solve(matrix, right) else { break };
        let next: [f64; 4] = std::array::from_fn(|i| x[i] + step[i]);
        let then = square(&next);
        if then.is_finite() && then <= now {
            let done = now - then <= 1e-14 * now || then < 1e-24;
            (x, now, damping) = (next, then, (damping * 0.3).max(1e-12));
            if done {
                break;
            }
        } else if damping > 1e8 {
            break;
        } else {
            damping *= 4.0;
        }
    }
    let part = |i: usize, mean: f64| {
        with[i].then(|| PowerLaw { factor: (x[2 * i] - x[2 * i + 1] * mean).exp(), exponent: x[2 * i + 1] })
    };
    let largest = points.iter().map(|point| residual(&x, point).abs()).fold(0.0, f64::max);
    let rest = (now / points.len() as f64).sqrt();
    let fit = JointFit { mesh: part(0, h0), step: part(1, dt0), rest, largest, runs: points.len() };
    now.is_finite().then_some(fit)
}

/// Solves a small system by elimination with pivots; `None` where it is singular.
fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> Option<[f64; N]> {
    let size = matrix.iter().flatten().fold(0.0f64, |most, entry| most.max(entry.abs()));
    for i in 0..N {
        let pivot = (i..N).max_by(|&a, &b| matrix[a][i].abs().total_cmp(&matrix[b][i].abs()))?;
        matrix.swap(i, pivot);
        right.swap(i, pivot);
        if matrix[i][i].abs() <= 1e-13 * size || !matrix[i][i].is_finite() {
            return None;
        }
        for k in i + 1..N {
            let factor = matrix[k][i] / matrix[i][i];
            (i..N).for_each(|j| matrix[k][j] -= factor * matrix[i][j]);
            right[k] -= factor * right[i];
        }
    }
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs whose errors are a hᵖ + b Δt^q, and whose costs are 0.3/(h Δt), times what `noise` says of each.
    fn grid(mesh: (f64, f64), step: (f64, f64), noise: impl Fn(usize) -> f64) -> Vec<Point> {
        let mut points = Vec::new();
        for h in [1.0f64, 0.5, 0.25, 0.125] {
            for k in 0..6 {
                let dt = 0.02 * 0.5f64.powi(k);
                let error = (mesh.0 * h.powf(mesh.1) + step.0 * dt.powf(step.1)) * noise(points.len());
                points.push(Point { h, dt, error, cost: 0.3 / (h * dt) });
            }
        }
        points
    }

    #[test]
    fn what_was_put_in_comes_out() {
        for (mesh, step) in [((0.05, 2.0), (100.0, 2.0)), ((0.3, 6.0), (2.0e4, 3.0)), ((2e-3, 4.0), (0.1, 1.0))] {
            let fit = fit(&grid(mesh, step, |_| 1.0)).unwrap();
            let (a, b) = (fit.mesh.unwrap(), fit.step.unwrap());
            let near = |found: f64, put: f64| (found / put - 1.0).abs() < 1e-5;
            assert!(near(a.factor, mesh.0) && near(a.exponent, mesh.1), "{fit:?}");
            assert!(near(b.factor, step.0) && near(b.exponent, step.1), "{fit:?}");
            assert!(fit.rest < 1e-6 && fit.runs == 24, "{fit:?}");
        }
    }

    #[test]
    fn what_is_left_unexplained_is_said() {
        // Errors that are 10 % above and below in turn leave 10 %, and move the orders by less than 0.1.
        let fit = fit(&grid((0.05, 2.0), (100.0, 2.0), |i| if (i * 7) % 4 < 2 { 1.1 } else { 1.0 / 1.1 })).unwrap();
        let (a, b) = (fit.mesh.unwrap(), fit.step.unwrap());
        assert!((a.exponent - 2.0).abs() < 0.1 && (b.exponent - 2.0).abs() < 0.1, "{fit:?}");
        assert!((0.5 * 1.1f64.ln()..1.01 * 1.1f64.ln()).contains(&fit.rest), "{fit:?}");
        assert!(fit.largest >= fit.rest);
    }

    #[test]
    fn a_part_that_nothing_shows_is_left_out() {
        let of_step = fit(&grid((1e-9, 2.0), (100.0, 2.0), |_| 1.0)).unwrap();
        assert!(of_step.mesh.is_none() && (of_step.step.unwrap().exponent - 2.0).abs() < 1e-6, "{of_step:?}");
        let of_mesh = fit(&grid((0.05, 2.0), (1e-9, 1.0), |_| 1.0)).unwrap();
        assert!(of_mesh.step.is_none() && (of_mesh.mesh.unwrap().exponent - 2.0).abs() < 1e-4, "{of_mesh:?}");
        let all = grid((0.05, 2.0), (100.0, 2.0), |_| 1.0);
        assert!(fit(&all[..6]).is_err() && fit(&[all[0], all[1], all[6], all[7]]).is_err());
    }

    #[test]
    fn the_cheapest_pair_is_the_least_of_all_that_keep_the_error() {
        let points = grid((0.05, 2.0), (2000.0, 3.0), |_| 1.0);
        let (fit, cost) = (fit(&points).unwrap(), CostFit::new(&points).unwrap());
        // The costs were put in as 0.3/(h Δt).
        assert!((cost.at(0.5, 0.01) / 60.0 - 1.0).abs() < 1e-9);
        for error in [1e-2, 1e-3, 1e-4] {
            let pair = fit.cheapest(&cost, error).unwrap();
            assert!((fit.at(pair.h, pair.dt) / error - 1.0).abs() < 1e-6);
            // Every other mesh with the step that keeps the error costs more.
            for part in 1..200 {
                let h = pair.h * 0.02 * f64::from(part);
                let Some(dt) = fit.step_for(h, error) else { continue };
                assert!(cost.at(h, dt) >= pair.cost * (1.0 - 1e-9), "{h}: {} of {}", cost.at(h, dt), pair.cost);
            }
        }
        assert!(fit.step_for(10.0, 1e-3).is_none());
    }
}
