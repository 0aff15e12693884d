//! Nodes attached to a body or a beam within a distance: heads of bolts in shells.

use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};

const PLATE: &str = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 1.0
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
[sections.bolt]
shape = "circle"
diameter = 0.012
[points]
a = [0.0, 0.0, 0.0]
b = [0.1, 0.0, 0.0]
c = [0.1, 0.1, 0.0]
d = [0.0, 0.1, 0.0]
head = [0.051, 0.05, 0.0]
nut = [0.051, 0.05, 0.03]
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = 10
thickness = 0.01
material = "steel"
[[beams]]
name = "bolt"
path = ["head", "nut"]
elements = 1
section = "bolt"
material = "steel"
orientation = [1.0, 0.0, 0.0]
[[supports]]
at = "plate.edge4"
fix = ["translations", "rx", "ry", "rz"]
"#;

fn read(more: &str) -> (Option<Model>, Vec<String>) {
    let (model, said) = model::read(&Source::new("deck.toml", PLATE.to_owned() + more, &[]));
    (model, said.iter().map(|said| format!("{} {}", said.message, said.hints.join(" "))).collect())
}

/// Exactly the nodes of the shell in the circle go with the head of the bolt, and each is attached to the nearest node of the beam.
#[test]
fn the_head_of_a_bolt_holds_the_nodes_around_it() {
    let (model, said) = read("[[attachments]]\nbeam = \"bolt\"\nnodes = \"plate\"\nwithin = 0.015\n");
    assert_eq!(said, Vec::<String>::new());
    let model = model.unwrap();
    let held = &model.constraints.dependents;
    let inside = (0..=10).flat_map(|i| (0..=10).map(move |j| [0.01 * f64::from(i), 0.01 * f64::from(j)]));
    let inside = inside.filter(|[x, y]| (x - 0.051).hypot(y - 0.05) < 0.015).count();
    assert_eq!((held.len(), inside), (9, 9));
    for one in held {
        let x = model.nodes[one.node].x;
        assert!((x.x - 0.051).hypot(x.y - 0.05) < 0.015, "{x}");
        assert_eq!(model.nodes[one.master].label, "head");
    }
}

/// A body takes the nodes around its centre; a distance without nodes, and one that is none, are errors.
#[test]
fn distances_of_attachments_are_checked() {
    let body = "[[bodies]]\nname = \"nut_body\"\ncenter = [0.05, 0.05, 0.0]\nmass = 0.1\ninertia = [1e-5, 1e-5, 1e-5]\n\
                [[attachments]]\nbeam = \"bolt\"\nnodes = \"nut_body\"\n";
    let (model, said) =
        read(&format!("{body}[[attachments]]\nbody = \"nut_body\"\nnodes = \"plate\"\nwithin = 0.01\n"));
    // The node in the middle and four around it, on the circle.
    assert_eq!(model.unwrap_or_else(|| panic!("{said:?}")).constraints.dependents.len(), 6);
    // Each name must have a node there.
    let far = "[[bodies]]\nname = \"far\"\ncenter = [0.5, 0.5, 0.0]\nmass = 0.1\ninertia = [1e-5, 1e-5, 1e-5]\n\
               [[attachments]]\nbeam = \"bolt\"\nnodes = [\"plate\", \"far\"]\nwithin = 0.015\n";
    let (model, said) = read(far);
    assert!(model.is_none() && said.iter().any(|said| said.contains("no node of this lies within 0.015")), "{said:?}");
    for (within, words) in [
        ("5e-4", "no node of this lies within 0.0005 the nearest is 0.001 away"),
        ("0.0", "`within` must be above zero"),
        ("-1.0", "`within` must be above zero"),
    ] {
        let (model, said) = read(&format!("[[attachments]]\nbeam = \"bolt\"\nnodes = \"plate\"\nwithin = {within}\n"));
        assert!(model.is_none() && said.iter().any(|said| said.contains(words)), "{within}: {said:?}");
    }
}

/// A circle by its diameter or its radius is the tube whose wall is as thick as its radius.
#[test]
fn a_circle_is_a_full_tube() {
    let of = |keys: &str| {
        let text = PLATE.replace("shape = \"circle\"\ndiameter = 0.012", keys);
        let (model, said) = model::read(&Source::new("deck.toml", &text, &[]));
        format!("{:?}", model.unwrap_or_else(|| panic!("{said:?}")).stiffnesses)
    };
    let tube = of("shape = \"tube\"\nradius = 0.006\nthickness = 0.006");
    for circle in ["shape = \"circle\"\ndiameter = 0.012", "shape = \"round\"\nradius = 0.006"] {
        assert_eq!(of(circle), tube);
    }
}
