//! The shallow truss of von Mises as a deck, which snaps through; with a spring in front of it, it snaps back.

/// Two bars of EA = 1000 over a span of 2, the crown 0.5 above the feet, held at both feet.
pub const TRUSS: &str = r#"[points]
left = [-1.0, 0.0, 0.0]
right = [1.0, 0.0, 0.0]
crown = [0.0, 0.0, 0.5]
[[bars]]
name = "bars"
path = ["left", "crown", "right"]
axial_stiffness = 1000.0
mass_per_length = 0.0
[[supports]]
at = ["left", "right"]
fix = "translations"
"#;

/// The truss with a vertical spring from its crown to the point `hand` above it.
pub fn behind_spring(stiffness: f64) -> String {
    let spring = format!(
        r#"[[links]]
name = "spring"
from = {{ node = "crown" }}
to = {{ node = "hand" }}
direction = [0.0, 0.0, 1.0]
stiffness = {stiffness:?}
"#
    );
    TRUSS.replace("crown = [", "hand = [0.0, 0.0, 1.0]\ncrown = [") + &spring
}
