//! Beams without shear: deflections and frequencies of Euler and Bernoulli.

use crate::support::{read_deck, run};
use rdsolve::diagnostic::Source;
use rdsolve::solve::Outcome;

const STEEL: f64 = 210e9;

/// A cantilever along x, 1 m long, square of 0.2 m: shear adds 3 % to its deflection.
fn cantilever(analysis: &str, beam: &str, more: &str) -> String {
    format!(
        "analysis = {analysis}\npoints = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0] }}\nsupports = [{{ at = \"a\", fix = \"all\" }}]\n\
         [materials.m]\nmodel = \"elastic\"\nyoungs_modulus = {STEEL}\npoisson_ratio = 0.3\ndensity = 7850.0\n[sections.s]\n\
         shape = \"rectangle\"\nwidth = 0.2\nheight = 0.2\n[[beams]]\nname = \"beam\"\npath = [\"a\", \"b\"]\nmaterial = \"m\"\n\
         section = \"s\"\norientation = [0.0, 1.0, 0.0]\n{beam}\n{more}"
    )
}

/// P L³/3EI for elements of all orders; 1e-4 of the shear deflection is left, 3e-6.
#[test]
fn deflections_are_those_of_euler_and_bernoulli() {
    let force = 1e3;
    let exact = force / (3.0 * STEEL * 0.2_f64.powi(4) / 12.0);
    for (order, elements, bound) in [(1, 2, 1e-5), (2, 2, 1e-5), (3, 1, 1e-5), (4, 1, 1e-5)] {
        let deck = cantilever(
            "{ kind = \"static\", end_time = 1.0, time_step = 1.0 }",
            &format!("order = {order}\nelements = {elements}\nshear = false"),
            &format!(
                "[[loads]]\nat = \"b\"\nforce = [0.0, 0.0, {force}]\n[[expect]]\nat = \"b\"\nquantity = \"uz\"\ntime = 1.0\n\
                 value = {exact}\ntolerance = {bound}\n"
            ),
        );
        let done = run(&read_deck(&deck), &mut |_| Vec::new());
        assert!(matches!(done.outcome, Outcome::Done));
        assert!(done.verdicts[0].passed, "order {order}: {:?}", done.verdicts[0].reason);
    }
}

/// The first frequency of bending, 1.8751²/2π sqrt(EI/m), and the second; eight elements of order 3 leave 1e-6.
#[test]
fn frequencies_are_those_of_euler_and_bernoulli() {
    let frequency = |lambda: f64| {
        let section = (STEEL * 0.2_f64.powi(4) / 12.0 / (7850.0 * 0.04)).sqrt();
        lambda * lambda / std::f64::consts::TAU * section
    };
    let expect = |mode: usize, lambda: f64| {
        format!(
            "[[expect]]\nmode = {mode}\nquantity = \"frequency\"\nvalue = {}\ntolerance = 2e-4\n",
            frequency(lambda)
        )
    };
    // Modes across y and z come in pairs.
    let values = expect(1, 1.875_104_069) + &expect(2, 1.875_104_069) + &expect(3, 4.694_091_133);
    let deck = cantilever(
        "{ kind = \"modal\", modes = 3 }",
        "order = 3\nelements = 8\nshear = false\nrotary_inertia = false\nmass = \"consistent\"",
        &values,
    );
    let done = run(&read_deck(&deck), &mut |_| Vec::new());
    for verdict in &done.verdicts {
        assert!(verdict.passed, "{}: {:?}", verdict.label, verdict.reason);
    }
}

#[test]
fn what_does_not_shear_does_not_yield_in_shear() {
    let deck = cantilever(
        "{ kind = \"static\", end_time = 1.0, time_step = 1.0 }",
        "shear = false\nshear_yields = true\nelements = 1",
        "",
    )
    .replace("\"elastic\"", "\"elastic-plastic\"\nyield_stress = 250e6");
    let said = rdsolve::model::read(&Source::new("deck.toml", deck, &[])).1;
    assert!(said.iter().any(|problem| problem.message.contains("contradicts `shear = false`")), "{said:?}");
}
