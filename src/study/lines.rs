//! The lines of a grid: every scheme with every method, tolerance of the iteration, mesh, order of beams and kind of steps, as
//! overrides of the deck.

use super::cells::float;
use super::family::Family;
use super::meshes::{refine, reorder};
use base::diagnostic::Diagnostic;
use base::names::short;
use deck::Deck;
use mechanics::integrators::{Scheme, Stepping, default_scheme};
use model::Model;
use model::study::{Study, choose_scheme};
use std::sync::Arc;

/// Over a load step only material that yields makes an error, of first order in general and never above second.
const OF_LOAD_STEPS: f64 = 2.0;

/// A line of settings, run over all time steps or all tolerances of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyLine {
    /// The words that distinguish it from the other lines.
    pub label: String,
    /// The label of the scheme, with its parameters; `static` in a static analysis.
    pub scheme: String,
    /// The family of the scheme.
    pub family: Family,
    /// The word of the iteration method.
    pub method: String,
    /// The tolerance of the iteration.
    pub iteration_tolerance: f64,
    /// The factor on the numbers of elements of the deck.
    pub mesh: f64,
    /// The polynomial degree of the elements of all beams; `None` as the deck has them.
    pub beam_order: Option<u64>,
    /// True where the step is automatic, and the grid goes over its tolerance.
    pub automatic: bool,
    /// The order of the scheme in the time step; of load steps, the highest that they can have.
    pub order: f64,
    /// The overrides of the deck that make this line, `KEY=VALUE`.
    pub sets: Vec<String>,
}

impl StudyLine {
    /// The line of the deck's own settings, with fixed steps.
    pub fn own(model: &Model) -> StudyLine {
        let mut line = StudyLine {
            label: String::new(),
            scheme: String::new(),
            family: Family::of(&*model.solution.scheme),
            method: model.solution.iteration.method.word().to_owned(),
            iteration_tolerance: model.solution.iteration.tolerance,
            mesh: 1.0,
            beam_order: None,
            automatic: false,
            order: OF_LOAD_STEPS,
            sets: Vec::new(),
        };
        match model.analysis.is_dynamic() {
            false => "static".clone_into(&mut line.scheme),
            true => line.take(model.solution.scheme.word(), &*model.solution.scheme),
        }
        line
    }

    /// A line of a made-up study.
    #[cfg(test)]
    pub fn plain(label: &str) -> StudyLine {
        StudyLine {
            label: label.to_owned(),
            scheme: "newmark".to_owned(),
            family: Family::OneStage,
            method: "auto".to_owned(),
            iteration_tolerance: 1e-8,
            mesh: 1.0,
            beam_order: None,
            automatic: false,
            order: 2.0,
            sets: Vec::new(),
        }
    }

    /// Takes a scheme by its label.
    pub fn take(&mut self, label: &str, scheme: &dyn Scheme) {
        label.clone_into(&mut self.scheme);
        (self.family, self.order) = (Family::of(scheme), scheme.order() as f64);
    }

    /// A time step as a number, or a tolerance, which is marked as one.
    pub fn resolution(&self, resolution: f64) -> String {
        if self.automatic { format!("tol {}", short(resolution)) } else { short(resolution) }
    }

    /// Larger for lines on better meshes, then of higher degree, then with closer iterations.
    pub fn rank(&self) -> [f64; 3] {
        [self.mesh, self.beam_order.unwrap_or(0) as f64, -self.iteration_tolerance]
    }

    /// Whether it differs from another in the mesh, the order of beams and the length of steps at most.
    pub fn is_like(&self, other: &StudyLine) -> bool {
        self.scheme == other.scheme
            && self.method == other.method
            && self.iteration_tolerance == other.iteration_tolerance
            && self.automatic == other.automatic
    }
}

/// The schemes of a study, each with its label and its override. Without an override, equal and automatic steps may have different schemes,
/// because automatic steps choose a scheme if the deck names none.
struct Schemes {
    listed: Vec<(String, Arc<dyn Scheme>, Option<String>)>,
    /// Where nothing is listed: the schemes of fixed and of automatic steps.
    own: [Arc<dyn Scheme>; 2],
}

impl Schemes {
    fn new(model: &Model, deck: &Deck, study: &Study) -> Schemes {
        let listed = study
            .schemes
            .iter()
            .map(|of| (of.label.clone(), of.scheme.clone(), Some(format!("integrator={}", of.table))));
        let is_free = deck.integrator.as_ref().is_none_or(|integrator| integrator.kind.is_none());
        let own = match is_free {
            true => [default_scheme(), choose_scheme(model)],
            false => [model.solution.scheme.clone(), model.solution.scheme.clone()],
        };
        Schemes { listed: listed.collect(), own }
    }

    /// The scheme of a kind of steps.
    fn of(&self, listed: usize, automatic: bool) -> (&str, &dyn Scheme, Option<&String>) {
        match self.listed.get(listed) {
            Some((label, scheme, set)) => (label, &**scheme, set.as_ref()),
            None => {
                let scheme = &*self.own[usize::from(automatic)];
                (scheme.word(), scheme, None)
            }
        }
    }
}

/// The lines of a grid: all schemes with all methods, tolerances, meshes, orders of beams and `kinds` of steps (true: automatic).
pub fn lines(
    model: &Model,
    deck: &Deck,
    study: &Study,
    kinds: &[bool],
    problems: &mut Vec<Diagnostic>,
) -> Vec<StudyLine> {
    let is_static = !model.analysis.is_dynamic();
    let schemes = Schemes::new(model, deck, study);
    let listed: Vec<usize> = (0..schemes.listed.len().max(1)).collect();
    if !is_static && kinds.contains(&true) {
        problems.extend(listed.iter().filter_map(|&i| {
            let (label, scheme, _) = schemes.of(i, true);
            no_tolerance(label, scheme)
        }));
    }
    let meshes: Vec<f64> = if study.meshes.is_empty() { vec![1.0] } else { study.meshes.clone() };
    let meshes: Vec<_> = meshes.iter().map(|&mesh| (mesh, refine(deck, mesh, problems))).collect();
    let orders: Vec<_> = study.beam_orders.iter().map(|&order| (order, reorder(deck, order))).collect();
    if orders.iter().any(|(_, sets)| sets.is_empty()) {
        problems.push(
            Diagnostic::error("`beam_orders` has nothing to change: the deck has no beams that deform")
                .hint("remove `beam_orders`"),
        );
    }
    let mut lines: Vec<(usize, StudyLine)> = listed.iter().map(|&i| (i, StudyLine::own(model))).collect();
    spread(&mut lines, &study.methods, |(_, line), method| {
        method.word().clone_into(&mut line.method);
        line.sets.push(format!("iteration.method=\"{}\"", method.word()));
    });
    spread(&mut lines, &study.iteration_tolerances, |(_, line), &tolerance| {
        line.iteration_tolerance = tolerance;
        line.sets.push(format!("iteration.tolerance={}", float(tolerance)));
    });
    spread(&mut lines, &meshes, |(_, line), (mesh, sets)| {
        line.mesh = *mesh;
        line.sets.extend_from_slice(sets);
    });
    spread(&mut lines, &orders, |(_, line), (order, sets)| {
        line.beam_order = Some(*order);
        line.sets.extend_from_slice(sets);
    });
    spread(&mut lines, kinds, |(scheme, line), &automatic| {
        line.automatic = automatic;
        let (label, which, set) = schemes.of(*scheme, automatic);
        if !is_static {
            line.take(label, which);
        }
        line.sets.splice(0..0, set.cloned());
    });
    labelled(lines.into_iter().map(|(_, line)| line).collect())
}

/// Makes of every line one for each of these values; without values, they stay.
fn spread<L: Clone, T>(lines: &mut Vec<L>, values: &[T], apply: impl Fn(&mut L, &T)) {
    if values.is_empty() {
        return;
    }
    let each = lines.drain(..).flat_map(|line| values.iter().map(move |value| (line.clone(), value)));
    *lines = each
        .map(|(mut line, value)| {
            apply(&mut line, value);
            line
        })
        .collect();
}

/// The lines with labels: of what differs between them, or of the scheme.
fn labelled(mut lines: Vec<StudyLine>) -> Vec<StudyLine> {
    let all = lines.clone();
    let vary = |of: &dyn Fn(&StudyLine) -> String| all.iter().any(|line| of(line) != of(&all[0]));
    let method = vary(&|line| line.method.clone());
    let tolerance = vary(&|line| line.iteration_tolerance.to_string());
    let mesh = vary(&|line| line.mesh.to_string());
    let order = vary(&|line| format!("{:?}", line.beam_order));
    let scheme = vary(&|line| line.scheme.clone()) || !(method || tolerance || mesh || order);
    for line in &mut lines {
        let mut words = Vec::new();
        let mut add = |shown: bool, word: String| words.extend(shown.then_some(word));
        add(scheme, line.scheme.clone());
        add(method, line.method.clone());
        add(tolerance, format!("iteration {:e}", line.iteration_tolerance));
        add(mesh, format!("mesh x {}", line.mesh));
        add(order, line.beam_order.map_or(String::new(), |order| format!("order {order}")));
        add(line.automatic, "automatic".to_owned());
        line.label = words.join(", ");
    }
    lines
}

/// Whether automatic steps of a scheme follow a tolerance.
pub fn follows_tolerance(scheme: &dyn Scheme) -> bool {
    no_tolerance("", scheme).is_none()
}

/// Why a scheme cannot be studied over tolerances; `None` where it can.
fn no_tolerance(label: &str, scheme: &dyn Scheme) -> Option<Diagnostic> {
    let (message, hint) = match scheme.stepping() {
        Stepping::Verlet => (
            format!("`{label}` has no error tolerance: its automatic steps follow the critical time step"),
            "give time steps (--time-steps): those above the critical time step are cut back",
        ),
        _ if scheme.order() < 2 => (
            format!("`{label}` is of first order, and automatic steps want second"),
            "use a scheme of second order, such as \"generalized-alpha\", or give time steps (--time-steps)",
        ),
        _ => return None,
    };
    Some(Diagnostic::error(message).hint(hint))
}
