//! Mesh and step together: the joint fit of each scheme that ran on several meshes with several steps, and the cheapest pair on
//! it for each error that is asked for.

use super::cells::seconds;
use super::grid::StudyGrid;
use super::joint_fit::{CostFit, JointFit, Pair, Point, PowerLaw, fit};
use super::run::{RunStatus, StudyRun};
use super::section::StudySection;
use base::names::short;

/// The fit of a scheme over meshes and steps.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshAndStep {
    /// The scheme, with what else distinguishes its lines besides the mesh.
    pub label: String,
    /// The fit, or in words why there is none.
    pub fit: Result<JointFit, &'static str>,
    /// The cheapest pairs for the errors that are asked for, largest first.
    pub cheapest: Vec<CheapestPair>,
    /// The meshes and steps that were run: the least and the largest size of elements, the shortest and the longest step.
    pub ranges: [[f64; 2]; 2],
}

/// The cheapest pair for an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheapestPair {
    /// The error that is asked for.
    pub error: f64,
    /// Of all sizes of elements.
    pub of_all: Option<Pair>,
    /// Of the meshes that were run.
    pub of_run: Option<Pair>,
}

/// The fits of a grid.
pub fn joints(grid: &StudyGrid, runs: &[StudyRun], wanted: &[f64]) -> Vec<MeshAndStep> {
    let mut done: Vec<usize> = Vec::new();
    let mut found = Vec::new();
    for (index, line) in grid.lines.iter().enumerate() {
        if done.contains(&index) || line.automatic || line.confirms {
            continue;
        }
        let same = |other: &usize| {
            let other = &grid.lines[*other];
            other.is_like(line) && other.beam_order == line.beam_order && !other.confirms
        };
        let group: Vec<usize> = (0..grid.lines.len()).filter(same).collect();
        done.extend(&group);
        if group.len() < 2 {
            continue;
        }
        let of_group =
            runs.iter().filter(|run| group.contains(&run.line) && run.status == RunStatus::Done && run.resolved);
        let point = |run: &StudyRun| {
            let steps = run.measured.steps as f64;
            let (h, dt) = (1.0 / grid.lines[run.line].mesh, grid.end_time / steps);
            run.error.map(|error| Point { h, dt, error, cost: run.loop_s })
        };
        let points: Vec<Point> = of_group.filter_map(point).collect();
        let words = line.label.split(", ").filter(|word| !word.starts_with("mesh x"));
        let label = words.collect::<Vec<_>>().join(", ");
        let label = if label.is_empty() { line.scheme.clone() } else { label };
        found.push(joint(label, &points, wanted));
    }
    found
}

/// The fit of a group of runs.
fn joint(label: String, points: &[Point], wanted: &[f64]) -> MeshAndStep {
    let range = |of: &dyn Fn(&Point) -> f64| {
        points.iter().map(of).fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)])
    };
    let ranges = [range(&|point| point.h), range(&|point| point.dt)];
    let (fit, cost) = (fit(points), CostFit::new(points));
    let mut sizes: Vec<f64> = points.iter().map(|point| point.h).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    let cheapest = wanted.iter().map(|&error| {
        let of_all = fit.as_ref().ok().zip(cost.as_ref()).and_then(|(fit, cost)| fit.cheapest(cost, error));
        let pair = |&h: &f64| {
            let (fit, cost) = (fit.as_ref().ok()?, cost.as_ref()?);
            let dt = fit.step_for(h, error)?;
            Some(Pair { h, dt, cost: cost.at(h, dt) })
        };
        let of_run = sizes.iter().filter_map(pair).min_by(|a, b| a.cost.total_cmp(&b.cost));
        CheapestPair { error, of_all, of_run }
    });
    let cheapest = cheapest.collect();
    MeshAndStep { label, fit, cheapest, ranges }
}

/// The fits in words, and the cheapest pairs as a table.
pub fn section(joints: &[MeshAndStep]) -> StudySection {
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    for joint in joints {
        let fit = match &joint.fit {
            Ok(fit) => fit,
            Err(reason) => {
                notes.push(format!("{}: no joint fit: {reason}", joint.label));
                continue;
            }
        };
        let part = |part: &Option<PowerLaw>, x: &str, none: &str| match part {
            Some(part) => format!("{:.2e} {x}^{:.2}", part.factor, part.exponent),
            None => none.to_owned(),
        };
        let (mesh, step) = (
            part(&fit.mesh, "h", "(no error of the mesh shows)"),
            part(&fit.step, "dt", "(no error of the step shows)"),
        );
        notes.push(format!(
            "{}: error = {mesh} + {step}, h the size of elements relative to the deck's; least squares of logarithms over {} runs, \
             which leave a factor of {:.2} unexplained (at most {:.2})",
            joint.label,
            fit.runs,
            fit.rest.exp(),
            fit.largest.exp()
        ));
        for of in &joint.cheapest {
            let outside = |pair: &Pair| {
                let beyond = |x: f64, [low, high]: [f64; 2]| x < 0.99 * low || x > 1.01 * high;
                if beyond(pair.h, joint.ranges[0]) || beyond(pair.dt, joint.ranges[1]) {
                    ", beyond what was run"
                } else {
                    ""
                }
            };
            let pair = |pair: &Option<Pair>| match pair {
                Some(of) => format!(
                    "mesh x {}, time step {}, {} s{}",
                    short(1.0 / of.h),
                    short(of.dt),
                    seconds(of.cost),
                    outside(of)
                ),
                None => "none".to_owned(),
            };
            rows.push(vec![format!("{:e}", of.error), joint.label.clone(), pair(&of.of_run), pair(&of.of_all)]);
        }
    }
    let head = vec!["error", "setting", "cheapest of the meshes run", "cheapest of all"];
    StudySection { title: "Mesh and step together", head, rows, notes }
}

#[cfg(test)]
mod tests {
    use super::super::lines::StudyLine;
    use super::*;

    #[test]
    fn the_cheapest_of_the_meshes_run_is_found() {
        let mut lines = vec![StudyLine::plain("newmark, mesh x 1"); 3];
        for (line, mesh) in lines.iter_mut().zip([1.0, 2.0, 4.0]) {
            (line.mesh, line.label) = (mesh, format!("newmark, mesh x {mesh}"));
        }
        let steps: Vec<f64> = (0..5).map(|k| 0.02 * 0.5f64.powi(k)).collect();
        let grid = StudyGrid::of_steps(lines, steps.clone(), 1.0, 50);
        let mut runs = Vec::new();
        for (line, mesh) in [1.0f64, 2.0, 4.0].into_iter().enumerate() {
            for &dt in &steps {
                let error = 0.02 / mesh.powi(2) + 50.0 * dt * dt;
                let mut run = StudyRun::made_up(line, dt, 1e-5 * mesh / dt, Some(error), Vec::new());
                run.measured.steps = (1.0 / dt).round() as u64;
                runs.push(run);
            }
        }
        let found = joints(&grid, &runs, &[1e-2, 1e-3]);
        assert_eq!((found.len(), found[0].label.as_str()), (1, "newmark"));
        let of = found[0].cheapest[0];
        // 1e-2 is beyond the deck's own mesh. With two times the elements 5e-3 are left for the step: Δt = 1e-2 at 2e-3 s;
        // with four times as many 8.75e-3, Δt = 1.32e-2 at 3.0e-3 s.
        let pair = of.of_run.unwrap();
        assert!((pair.h - 0.5).abs() < 1e-12 && (pair.dt / 1e-2 - 1.0).abs() < 1e-4, "{of:?}");
        assert!((pair.cost / 2e-3 - 1.0).abs() < 1e-4 && of.of_all.unwrap().cost <= pair.cost * (1.0 + 1e-9), "{of:?}");
        // No mesh that was run comes to 1e-3.
        assert_eq!(found[0].cheapest[1].of_run, None);
        assert!(section(&found).text().contains("beyond what was run"));
    }
}
