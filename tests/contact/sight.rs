//! Surfaces that pass between the points which are to touch them are said, whatever touches, with the points that would do.

use rdsolve::diagnostic::Source;
use rdsolve::model;
use rdsolve::plan::Plan;
use rdsolve::plan::explain::explain;
use rdsolve::system::System;

const OPENING: &str = r#"
[analysis]
kind = "dynamic"
end_time = 1.0
time_step = 0.001
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
[sections.strip]
shape = "rectangle"
width = 0.03
height = 0.01
[points]
a = [0.0, 0.0, 0.5]
b = [1.0, 0.0, 0.5]
c = [1.0, 1.0, 0.5]
d = [0.0, 1.0, 0.5]
"#;

fn contact(surface: &str, with: &str, points: Option<u64>) -> String {
    let points = points.map_or(String::new(), |points| format!("points = {points}\n"));
    format!("[[contacts]]\nname = \"hit\"\nsurface = {{ {surface} }}\nwith = \"{with}\"\nstiffness = 1e6\n{points}")
}

fn said(thing: &str, contact: &str) -> Vec<[String; 2]> {
    let (_, said) = model::read(&Source::new("deck.toml", format!("{OPENING}{thing}{contact}"), &[]));
    let said = said.into_iter().filter(|said| !said.message.starts_with("nothing "));
    said.map(|said| [said.message, said.hints.join(" ")]).collect()
}

const SPHERE: &str = "shape = \"sphere\", center = [0.5, 0.5, 0.2], radius = 0.05";

fn beam(elements: usize) -> String {
    format!(
        "[[beams]]\nname = \"beam\"\npath = [\"a\", \"b\"]\nelements = {elements}\nmaterial = \"steel\"\n\
         section = \"strip\"\norientation = [0.0, 1.0, 0.3]\n"
    )
}

fn body(shape: &str) -> String {
    format!("[[bodies]]\nname = \"body\"\ncenter = [0.5, 0.5, 0.5]\nmass = 1.0\nshape = {{ {shape} }}\n")
}

/// As many points as the hint asks for, and one less; the widest opening with them is known.
#[test]
fn surfaces_that_pass_between_points_are_said_until_there_are_enough() {
    let plate = "[[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [4, 4]\n\
                 material = \"steel\"\nthickness = 0.01\n";
    let rod = "shape = \"capsule\", ends = [[0.5, -1.0, 0.2], [0.5, 2.0, 0.2]], radius = 0.02";
    let block = "shape = \"box\", center = [0.5, 0.0, 0.2], size = [0.1, 0.2, 0.15]";
    let cases = [
        // The diagonal of an element against the diameter.
        (plate.to_owned(), "plate", SPHERE, 0.25 * 2f64.sqrt(), 0.1),
        // Nodes of a beam, four to an element at ±1 and ±1/√5, against the middle dimension of a box and the diameter of a capsule.
        (beam(1), "beam", block, 1.0 / 5f64.sqrt(), 0.15),
        (beam(4), "beam", rod, 0.25 / 5f64.sqrt(), 0.04),
    ];
    for (thing, with, surface, opening, width) in cases {
        // Half a thickness is the radius of a part's points.
        let radius = 0.005;
        let enough = (opening / (width + 2.0 * radius) - 1.0 - 1e-6f64).ceil() as u64;
        let few = said(&thing, &contact(surface, with, None));
        assert!(few.iter().any(|[_, hint]| hint.contains(&format!("`points` = {enough} "))), "{enough}: {few:?}");
        let one_less = said(&thing, &contact(surface, with, Some(enough - 1)));
        assert!(one_less.iter().any(|[said, _]| said.contains("may pass between them")), "{enough}: {one_less:?}");
        let silent = said(&thing, &contact(surface, with, Some(enough)));
        assert!(silent.is_empty(), "{enough}: {silent:?}");
    }
}

#[test]
fn what_is_wider_than_the_openings_is_not_said() {
    let big = "shape = \"box\", center = [0.5, 0.0, 0.2], size = [0.6, 0.5, 0.01]";
    let plane = "shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]";
    // A plate that lies flat under a beam, though it is thin; a plane; a box against a box, which sees all.
    assert!(said(&beam(2), &contact(big, "beam", None)).is_empty());
    assert!(said(&beam(1), &contact(plane, "beam", None)).is_empty());
    let brick = body("kind = \"box\", size = [0.4, 0.3, 0.1]");
    let small = "shape = \"box\", center = [0.5, 0.5, 0.2], size = [0.05, 0.05, 0.05]";
    assert!(said(&brick, &contact(small, "body", None)).is_empty());
    assert!(said(&brick, &contact(SPHERE, "body", None)).is_empty());
    // By the radius that the contact gives, and by that alone: 0.04 and twice the radius against 0.1118.
    let thin = "shape = \"capsule\", ends = [[0.5, -1.0, 0.2], [0.5, 2.0, 0.2]], radius = 0.02";
    let round = |radius: f64| contact(thin, "beam", None) + &format!("radius = {radius}\n");
    assert!(said(&beam(4), &round(0.036)).is_empty());
    assert_eq!(said(&beam(4), &round(0.035)).len(), 1);
}

const LOG: &str = "[[bodies]]\nname = \"log\"\nmass = 1.0\n\
                   shape = { kind = \"capsule\", ends = [[0.5, -0.2, 0.6], [0.5, 0.2, 0.6]], radius = 0.02 }\n";

/// What touches with lines has nothing that `points` would divide: alone it is refused, beside what has points it is said.
#[test]
fn points_that_divide_nothing_are_said() {
    let plate = "[[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [4, 4]\n\
                 material = \"steel\"\nthickness = 0.01\n";
    let things = beam(4) + LOG + plate;
    let on_beam = |with: &str, points| contact("part = \"beam\"", "X", points).replace("\"X\"", with);
    let about = |said: &[[String; 2]]| said.iter().find(|[said, _]| said.contains("`points` does not apply")).cloned();
    let [alone, beside, without] =
        [("\"log\"", Some(3)), ("[\"log\", \"plate\"]", Some(3)), ("[\"log\", \"plate\"]", None)]
            .map(|(with, points)| about(&said(&things, &on_beam(with, points))));
    let line = "`points` does not apply to `log`, which touches here in full, not with points";
    assert_eq!(alone, Some([line.to_owned(), "leave `points` out".to_owned()]));
    assert_eq!(
        beside,
        Some([line.to_owned(), "add a separate contact for these; it divides the others in `with`".to_owned()])
    );
    assert_eq!(without, None);
}

/// Solids that see all of each other need no points, and are told so.
#[test]
fn points_of_solids_are_said_to_do_nothing() {
    let post = "shape = \"cylinder\", center = [0.5, 0.5, -0.4], radius = 0.05, length = 1.0, axis = [0.0, 0.0, 1.0]";
    let plane = "shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]";
    let brick = body("kind = \"box\", size = [0.4, 0.3, 0.1]");
    let roll = body("kind = \"cylinder\", radius = 0.2, length = 1.0, axis = [1.0, 0.0, 0.0]");
    for (thing, surface) in [(&brick, post), (&roll, post), (&roll, SPHERE), (&roll, plane)] {
        assert_eq!(said(thing, &contact(surface, "body", None)), Vec::<[String; 2]>::new());
        let said = said(thing, &contact(surface, "body", Some(3)));
        let line = "`points` does not apply to `body`, which touches here in full, not with points";
        assert_eq!(said, [[line.to_owned(), "leave `points` out".to_owned()]], "{surface}");
    }
    // On a plane a box is its corners, and what lies between these.
    assert!(said(&brick, &contact(plane, "body", Some(3))).is_empty());
}

/// Edges of a mesh that is coarser than a capsule is wide may sink into its side; with as many points as the hint asks for they do not.
#[test]
fn capsules_on_coarse_faces_are_said_until_there_are_points() {
    let plate = "[[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [2, 2]\n\
                 material = \"steel\"\nthickness = 0.01\n";
    let sinks = |points| {
        let said = said(&(plate.to_owned() + LOG), &contact("part = \"plate\"", "log", points));
        said.into_iter().find(|[said, _]| said.contains("sees the side of capsule `log` by nodes of `plate`"))
    };
    // 0.4 long, 0.05 wide with the thickness.
    let [_, hint] = sinks(None).expect("a warning");
    assert!(hint.contains("`points` = 7 or more"), "{hint}");
    assert!(sinks(Some(6)).is_some() && sinks(Some(7)).is_none());
}

/// A capsule in the middle of a flat sheet finds no edge that it could lie across; at the border, or where something may move it there, it does.
#[test]
fn capsules_that_come_to_no_edge_are_not_warned_of() {
    let plate = "[[shells]]\nname = \"plate\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [2, 2]\n\
                 material = \"steel\"\nthickness = 0.01\n";
    let warned = |y: f64, more: &str| {
        let log = format!(
            "[[bodies]]\nname = \"log\"\nmass = 1.0\n{more}\n[bodies.shape]\nkind = \"capsule\"\nradius = 0.02\n\
             ends = [[0.3, {y:?}, 0.6], [0.7, {y:?}, 0.6]]\n"
        );
        let said = said(&(plate.to_owned() + &log), &contact("part = \"plate\"", "log", None));
        said.into_iter().any(|[said, _]| said.contains("sees the side of capsule `log`"))
    };
    // Half of its length and its radius are 0.22; the run lasts 1.
    assert!(!warned(0.5, "") && !warned(0.75, "") && !warned(0.23, ""));
    assert!(warned(0.21, "") && warned(0.0, ""));
    assert!(warned(0.5, "velocity = [0.0, 0.3, 0.0]") && !warned(0.5, "velocity = [0.0, 0.2, -5.0]"));
}

/// Nothing passes a monitor, whose gaps are those of its points: it is no warning, and its line says so where there is more than points.
#[test]
fn a_monitor_says_where_its_gaps_are_taken() {
    let explained = |thing: &str, with: &str, stiffness: &str| {
        let contact = contact(SPHERE, with, None).replace("stiffness = 1e6", stiffness);
        let model =
            model::read(&Source::new("deck.toml", format!("{OPENING}{thing}{contact}"), &[])).0.expect("a model");
        let system = System::new(&model).unwrap();
        explain(&Plan::new(&model, &system, 1), &model, &system).to_string()
    };
    let (unseen, by_points) = ("contact `hit` does not see what lies between nodes", "gaps are those of the points");
    let says = |text: &str| [text.contains(unseen), text.contains(by_points)];
    assert_eq!(says(&explained(&beam(4), "beam", "stiffness = 1e6")), [true, false]);
    assert_eq!(says(&explained(&beam(4), "beam", "stiffness = 0.0")), [false, true]);
    let brick = body("kind = \"box\", size = [0.4, 0.3, 0.1]");
    assert_eq!(says(&explained(&brick, "body", "stiffness = 0.0")), [false, false]);
}
