//! The scheme that automatic steps choose for sheets that are struck.

use crate::support::read_deck;
use rdsolve::model::StepLength;

/// A plate of n × n elements that falls onto a ball, with keys of the analysis and of the deck.
fn plate(n: usize, end: f64, analysis: &str, more: &str) -> String {
    format!(
        r#"
[analysis]
kind = "dynamic"
end_time = {end:?}
time_step = "auto"
{analysis}
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
c = [1.0, 1.0, 0.0]
d = [0.0, 1.0, 0.0]
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = {n}
thickness = 0.001
material = "steel"
[[bodies]]
name = "ball"
center = [0.5, 0.5, 0.2]
shape = {{ kind = "sphere", radius = 0.1, density = 7850.0 }}
velocity = [0.0, 0.0, -1.0]
[[contacts]]
name = "blow"
surface = {{ body = "ball" }}
with = "plate"
stiffness = 1e6
{more}
"#
    )
}

/// Central differences from 200 elements on, up to 20,000 elements that a wave crosses, if no error is asked for and all parts are shells.
#[test]
fn sheets_that_are_struck_take_central_differences() {
    let rod = "[sections.rod]\nshape = \"circle\"\ndiameter = 0.02\n[[beams]]\nname = \"rod\"\npath = [\"a\", \"c\"]\nelements = 1\nsection = \"rod\"\n\
               material = \"steel\"\n";
    for (text, is_explicit) in [
        (plate(15, 0.01, "", ""), true),
        // 196 elements.
        (plate(14, 0.01, "", ""), false),
        // 5420 m/s · 0.3 s · 15/m = 24,400 elements.
        (plate(15, 0.3, "", ""), false),
        (plate(15, 0.01, "error_tolerance = 1e-3", ""), false),
        (plate(15, 0.01, "", rod), false),
    ] {
        let model = read_deck(&text);
        let found = matches!(model.analysis.step_length, StepLength::StabilityLimited { .. });
        assert_eq!((found, model.solution.scheme.is_explicit()), (is_explicit, is_explicit), "{text}");
        assert!(model.solution.scheme_is_chosen);
    }
}
