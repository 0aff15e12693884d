//! Free edges of shells against each other and against beams: sheets that cross edge to edge, between whose nodes nothing else meets.

use super::go;
use crate::support::{read_deck, run, run_with_warnings};
use rdsolve::solve::{Frame, Outcome};

const SCHEMES: [&str; 3] = [
    r#"scheme = "newmark""#,
    r#"scheme = "generalized-alpha", spectral_radius = 0.9"#,
    r#"scheme = "central-difference""#,
];

/// Mass of a sheet of 0.5 by 0.5, 10 mm thick, of steel.
const MASS: f64 = 0.5 * 0.5 * 0.01 * 7850.0;

/// A sheet that stands below z = 0 along x, and one above it across, `along` and `aside` off the middles, `gap` apart from touching.
struct Sheets<'a> {
    run: &'a str,
    place: [f64; 2],
    gap: f64,
    /// Further keys of both sheets.
    shells: &'a str,
    /// Further keys of the contact.
    contact: &'a str,
    /// Further tables.
    more: &'a str,
}

impl Sheets<'_> {
    fn deck(&self) -> String {
        let &Sheets { run, place: [along, aside], gap, shells, contact, more } = self;
        let (low, high, first, last) = (0.01 + gap, 0.51 + gap, aside - 0.25, aside + 0.25);
        format!(
            r#"
            {run}
            output = {{ energy = true, contacts = true, every = 1 }}
            materials.steel = {{ model = "elastic", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}
            [points]
            a = [-0.25, 0.0, -0.5]
            b = [0.25, 0.0, -0.5]
            c = [0.25, 0.0, 0.0]
            d = [-0.25, 0.0, 0.0]
            e = [{along:?}, {first:?}, {low:?}]
            f = [{along:?}, {last:?}, {low:?}]
            g = [{along:?}, {last:?}, {high:?}]
            h = [{along:?}, {first:?}, {high:?}]
            [[shells]]
            name = "lower"
            corners = ["a", "b", "c", "d"]
            thickness = 0.01
            material = "steel"
            {shells}
            [[shells]]
            name = "upper"
            corners = ["e", "f", "g", "h"]
            thickness = 0.01
            material = "steel"
            {shells}
            [[contacts]]
            name = "hit"
            surface = {{ part = "lower", edges = true }}
            with = "upper"
            {contact}
            {more}
            "#
        )
    }
}

fn motion(scheme: &str, end: f64, dt: f64) -> String {
    format!(
        "analysis = {{ kind = \"dynamic\", end_time = {end:?}, time_step = {dt:?} }}\nintegrator = {{ {scheme} }}\n"
    )
}

const THROWN: &str = "[[initial]]\nat = \"upper\"\nvelocity = [0.0, 0.0, -1.0]\n";

/// Time, mechanical energy, what the scheme took, energy of the contact, its force on the upper sheet, momentum along z, gap.
fn watch(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let (force, gap) = frame.derived.contacts.first().map_or((0.0, 0.0), |contact| (-contact.f.z, contact.gap));
    vec![frame.state.time, e.mechanical, e.numerical, e.contact, force, e.p.z, gap]
}

/// Pressed together by a force, elastic sheets are as deep in each other as force over stiffness, wherever their edges cross and however they give.
#[test]
fn sheets_pressed_on_edge_sink_in_by_force_over_stiffness() {
    for (place, shells) in [
        ([0.0, 0.0], "elements = 5"),
        ([0.03, -0.07], "elements = 4\nkind = \"triangle\""),
        ([0.11, 0.02], "elements = 3\norder = 2"),
    ] {
        let held = "[[supports]]\nat = \"lower.edge1\"\nfix = \"all\"\n\
                    [[supports]]\nat = \"upper.edge3\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n\
                    [[loads]]\nat = \"upper.edge3\"\nforce_per_length = [0.0, 0.0, -4000.0]\n";
        let run = "analysis = { kind = \"static\", end_time = 1.0, time_step = 0.25 }";
        let deck = Sheets { run, place, gap: 0.0, shells, contact: "stiffness = 1e7", more: held }.deck();
        let done = go(&deck, &mut watch);
        for row in &done.rows {
            let force = 2000.0 * row[0];
            // The tolerance of the iteration.
            assert!(
                (row[4] - force).abs() < 1e-6 * 2000.0 && (row[6] + force / 1e7).abs() < 1e-10,
                "{shells}: {row:?}"
            );
            assert!((row[3] - 0.5 * force * force / 1e7).abs() < 1e-6, "{shells}: {row:?}");
        }
        assert!(done.rows.len() > 4, "{}", done.rows.len());
    }
}

/// Pressed on edge and then drawn along it by more than friction holds, sheets slide by Coulomb's law in load steps.
#[test]
fn sheets_drawn_over_an_edge_rub_in_load_steps() {
    let held = "[amplitudes]\npress = { kind = \"table\", points = [[0.0, 0.0], [1.0, 1.0], [2.0, 1.0]] }\n\
                draw = { kind = \"table\", points = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]] }\n\
                [[supports]]\nat = \"lower.edge1\"\nfix = \"all\"\n\
                [[supports]]\nat = \"upper.edge3\"\nfix = [\"uy\", \"rx\", \"ry\", \"rz\"]\n\
                motion = { ux = { amplitude = \"draw\", scale = 0.03 } }\n\
                [[loads]]\nat = \"upper.edge3\"\nforce_per_length = [0.0, 0.0, -4000.0]\namplitude = \"press\"\n";
    let run = "analysis = { kind = \"static\", end_time = 2.0, time_step = 0.25 }";
    let contact = "stiffness = 1e7\nfriction = 0.3";
    let deck = Sheets { run, place: [0.02, 0.02], gap: 0.0, shells: "elements = 3", contact, more: held }.deck();
    let done = go(&deck, &mut |frame| {
        let contact = &frame.derived.contacts[0];
        let e = frame.derived.energy.expect("energies");
        vec![frame.state.time, contact.f.x, contact.f.y, contact.f.z, e.friction, e.numerical]
    });
    let last = done.rows.last().unwrap();
    let (rubs, pressed) = (last[1].hypot(last[2]), -last[3]);
    // The normal has turned with the sheets that bend, by less than a hundredth, whose square is what the parts tell; then the iteration.
    assert!((pressed / 2000.0 - 1.0).abs() < 1e-4 && (rubs / 600.0 - 1.0).abs() < 1e-3, "{last:?}");
    // 600 N over 30 mm, less what the sheets give and the first steps bend: 17.2 J of work in all.
    assert!(last[4] > 14.0 && last[4] < 18.0 && last[5].abs() < 0.02 * last[4], "{last:?}");
}

/// Rigid sheets that are moved by a path onto each other press by stiffness times depth, from the gap on.
#[test]
fn sheets_moved_on_each_other_press_by_stiffness_times_depth() {
    let held = "[[supports]]\nat = \"lower\"\nfix = \"all\"\n[amplitudes.down]\nkind = \"ramp\"\nend = 1.0\n\
                [[supports]]\nat = \"upper\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n\
                motion = { uz = { amplitude = \"down\", scale = -1e-3 } }\n";
    let run = "analysis = { kind = \"static\", end_time = 1.0, time_step = 0.1 }";
    let deck = Sheets {
        run,
        place: [0.02, 0.03],
        gap: 2.5e-4,
        shells: "elements = 5\nrigid = true",
        contact: "stiffness = 1e7",
        more: held,
    };
    let done = go(&deck.deck(), &mut watch);
    for row in &done.rows {
        let gap = 2.5e-4 - 1e-3 * row[0];
        // Coordinates of size 0.5 to rounding.
        assert!((row[6] - gap).abs() < 1e-12 && (row[4] - 1e7 * (-gap).max(0.0)).abs() < 1e-5, "{row:?}");
    }
}

/// Rigid sheets are two masses on a spring: v √(k m/2) at the most, and the speed is handed on; no energy and no momentum comes or goes.
#[test]
fn an_edge_thrown_on_an_edge_rebounds() {
    for scheme in SCHEMES {
        let run = motion(scheme, 0.006, 1e-5);
        for (place, meeting) in [([0.0, 0.0], 0.5 * MASS), ([0.04, -0.03], f64::NAN)] {
            let shells = "elements = 5\nrigid = true";
            let deck = Sheets { run: &run, place, gap: 5e-4, shells, contact: "stiffness = 1e7", more: THROWN }.deck();
            let done = go(&deck, &mut watch);
            assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
            let (first, last) = (&done.rows[0], done.rows.last().unwrap());
            let highest = done.rows.iter().map(|row| row[4]).fold(0.0, f64::max);
            println!("{scheme}: {highest} {last:?}");
            // Of 300 samples an impact, where the middles meet.
            let exact = (1e7 * meeting).sqrt();
            assert!(exact.is_nan() || (highest / exact - 1.0).abs() < 1e-4, "{scheme}: {highest} for {exact}");
            assert!(
                highest > 5000.0 && (last[1] / first[1] - 1.0).abs() < 1e-3 && last[3] == 0.0,
                "{scheme}: {last:?}"
            );
            assert!((last[5] - first[5]).abs() < 1e-10 * first[5].abs(), "{scheme}: momentum {last:?}");
        }
    }
}

/// Sheets that bend keep their energy and momentum; what restitution and friction take is told.
#[test]
fn sheets_that_give_keep_their_energy() {
    for scheme in SCHEMES {
        for contact in ["stiffness = 1e7", "stiffness = 1e7\nrestitution = 0.6\nfriction = 0.3"] {
            let run = motion(scheme, 0.005, if scheme.contains("central") { 1e-6 } else { 5e-6 });
            let more = "[[initial]]\nat = \"upper\"\nvelocity = [0.0, 0.2, -1.0]\n";
            let deck = Sheets { run: &run, place: [0.07, -0.03], gap: 5e-4, shells: "elements = 5", contact, more };
            let done = go(&deck.deck(), &mut watch);
            assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
            let (first, last) = (&done.rows[0], done.rows.last().unwrap());
            let pressed = done.rows.iter().map(|row| row[3]).fold(0.0, f64::max);
            println!("{scheme} {contact:?}: pressed {pressed} of {}, last {last:?}", first[1]);
            assert!(pressed > 0.05 * first[1], "{scheme}: {pressed}");
            // Of some hundred steps an impact; the sheets ring.
            assert!(last[2].abs() < 1e-4 * first[1], "{scheme} {contact:?}: {last:?}");
            assert!((last[5] - first[5]).abs() < 1e-9 * first[5].abs(), "{scheme}: momentum {last:?}");
        }
    }
}

/// A rod falls across the edge of a sheet: beams touch edges with all of their length.
#[test]
fn an_edge_meets_a_beam() {
    for scheme in SCHEMES {
        let text = format!(
            r#"
            {}
            output = {{ energy = true, contacts = true, every = 1 }}
            materials.steel = {{ model = "elastic", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}
            sections.round = {{ shape = "tube", radius = 0.02, thickness = 0.02 }}
            [points]
            a = [-0.25, 0.0, -0.5]
            b = [0.25, 0.0, -0.5]
            c = [0.25, 0.0, 0.0]
            d = [-0.25, 0.0, 0.0]
            e = [0.0, -0.3, 0.0255]
            f = [0.0, 0.3, 0.0255]
            [[shells]]
            name = "sheet"
            corners = ["a", "b", "c", "d"]
            elements = 5
            thickness = 0.01
            material = "steel"
            rigid = true
            [[beams]]
            name = "rod"
            path = ["e", "f"]
            elements = 3
            material = "steel"
            section = "round"
            orientation = [0.0, 0.0, 1.0]
            rigid = true
            [[initial]]
            at = "rod"
            velocity = [0.0, 0.0, -1.0]
            [[contacts]]
            name = "hit"
            surface = {{ part = "sheet", edges = true }}
            with = "rod"
            stiffness = 1e7
            "#,
            motion(scheme, 0.006, 1e-5)
        );
        let done = go(&text, &mut watch);
        assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
        let rod = std::f64::consts::PI * 0.02f64.powi(2) * 0.6 * 7850.0;
        let exact = (1e7 / (1.0 / rod + 1.0 / MASS)).sqrt();
        let highest = done.rows.iter().map(|row| row[4]).fold(0.0, f64::max);
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        assert!((highest / exact - 1.0).abs() < 2e-4, "{scheme}: {highest} for {exact}");
        assert!((last[1] / first[1] - 1.0).abs() < 1e-3 && last[3] == 0.0, "{scheme}: {last:?}");
        assert!((last[5] - first[5]).abs() < 1e-10 * first[5].abs(), "{scheme}: momentum {last:?}");
    }
}

/// A sheet is dragged along the edges of two others, across them and over their nodes: Coulomb's law slows it down, and heats.
#[test]
fn an_edge_that_is_dragged_over_edges_slides_by_coulombs_law() {
    let weight = 0.3 * 1.0 * 0.01 * 7850.0 * 10.0;
    let z = 0.01 - 0.5 * weight / 1e6;
    let rail = |name: &str| {
        format!(
            "[[shells]]\nname = \"{name}\"\ncorners = [\"{name}1\", \"{name}2\", \"{name}3\", \"{name}4\"]\nelements = [20, 1]\n\
             thickness = 0.01\nmaterial = \"steel\"\nrigid = true\n\
             [[contacts]]\nname = \"on_{name}\"\nsurface = {{ part = \"{name}\", edges = true }}\nwith = \"sheet\"\nstiffness = 1e6\nfriction = 0.3\n"
        )
    };
    let corners = |name: &str, y: f64| {
        let at = [[0.0, -0.2], [2.0, -0.2], [2.0, 0.0], [0.0, 0.0]];
        (0..4).map(|k| format!("{name}{} = [{:?}, {y:?}, {:?}]\n", k + 1, at[k][0], at[k][1])).collect::<String>()
    };
    for scheme in SCHEMES {
        let text = format!(
            "analysis = {{ kind = \"dynamic\", end_time = 0.5, time_step = 1e-4 }}\nintegrator = {{ {scheme} }}\noutput = {{ energy = true }}\n\
             environment.gravity = [0.0, 0.0, -10.0]\n\
             materials.steel = {{ model = \"elastic\", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}\n\
             [points]\n{}{}e = [0.13, 0.0, {z:?}]\nf = [0.13, 1.0, {z:?}]\ng = [0.13, 1.0, {:?}]\nh = [0.13, 0.0, {:?}]\n\
             {}{}[[shells]]\nname = \"sheet\"\ncorners = [\"e\", \"f\", \"g\", \"h\"]\nelements = [7, 2]\nthickness = 0.01\nmaterial = \"steel\"\n\
             rigid = true\n[[supports]]\nat = [\"left\", \"right\"]\nfix = \"all\"\n\
             [[supports]]\nat = \"sheet\"\nfix = [\"uy\", \"rx\", \"ry\", \"rz\"]\n\
             [[initial]]\nat = \"sheet\"\nvelocity = [3.0, 0.0, 0.0]\n",
            corners("left", 0.2),
            corners("right", 0.8),
            z + 0.3,
            z + 0.3,
            rail("left"),
            rail("right"),
        );
        let done = go(&text, &mut |frame| {
            let e = frame.derived.energy.expect("energies");
            let body = frame.model.bodies.iter().find(|body| body.name == "sheet").expect("the sheet").node;
            vec![frame.state.nodes[body].v.x, frame.state.nodes[body].x.x, e.friction, e.numerical, e.mechanical]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        println!("{scheme}: {last:?}");
        // As for beams on beams: half a step at the end, and what passing nodes leaves.
        assert!((last[0] - (3.0 - 0.3 * 10.0 * 0.5)).abs() < 3e-4 && last[1] > 1.2, "{scheme}: {last:?}");
        assert!((last[2] / (first[4] - last[4]) - 1.0).abs() < 1e-3, "{scheme}: {last:?} {first:?}");
        assert!(last[3].abs() < 1e-3 * first[4], "{scheme}: {last:?}");
    }
}

/// The corner of a sheet comes down on the edge of another: round as the edges themselves, and one touch although two edges meet there.
#[test]
fn a_corner_is_one_touch() {
    for scheme in SCHEMES {
        // The upper sheet begins where the edge of the lower one is: its corner is over it.
        let run = motion(scheme, 0.006, 1e-5);
        let shells = "elements = 5\nrigid = true";
        let held = "[[supports]]\nat = \"upper\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n\
                    [[supports]]\nat = \"lower\"\nfix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]\n";
        let more = format!("{THROWN}{held}");
        let deck =
            Sheets { run: &run, place: [0.03, 0.25], gap: 5e-4, shells, contact: "stiffness = 1e7", more: &more };
        let done = go(&deck.deck(), &mut watch);
        assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        let highest = done.rows.iter().map(|row| row[4]).fold(0.0, f64::max);
        let exact = (1e7 * 0.5 * MASS).sqrt();
        assert!((highest / exact - 1.0).abs() < 2e-4, "{scheme}: {highest} for {exact}");
        assert!((last[1] / first[1] - 1.0).abs() < 1e-3 && last[3] == 0.0, "{scheme}: {last:?}");
    }
}

/// Edges that lie along each other are rough, and said to be: their nodes on the faces of the other hold them.
#[test]
fn edges_side_by_side_are_said() {
    let run = motion(SCHEMES[0], 0.004, 1e-5);
    let shells = "elements = 5\nrigid = true";
    let text =
        Sheets { run: &run, place: [0.0, 0.0], gap: 5e-4, shells, contact: "stiffness = 1e6", more: THROWN }.deck();
    let (outcome, said) = run_with_warnings(&text);
    assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    assert!(said.iter().all(|said| !said.contains("side by side")), "{said:?}");
    // The upper sheet turned by 90 degrees.
    let along = text
        .replace("e = [0.0, -0.25, 0.0105]", "e = [-0.21, 0.0, 0.0105]")
        .replace("f = [0.0, 0.25, 0.0105]", "f = [0.29, 0.0, 0.0105]")
        .replace("g = [0.0, 0.25, 0.5105]", "g = [0.29, 0.0, 0.5105]")
        .replace("h = [0.0, -0.25, 0.5105]", "h = [-0.21, 0.0, 0.5105]");
    assert_ne!(along, text);
    let (outcome, said) = run_with_warnings(&along);
    assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
    assert!(
        said.iter().any(|said| said.contains("contact `hit`: beams, bars or edges press each other side by side")),
        "{said:?}"
    );
}

/// Without its edges one sheet cuts through the other, and with them a step that would go through is refused, however fast it comes.
#[test]
fn nothing_passes_through() {
    let held = "[[supports]]\nat = \"lower\"\nfix = \"all\"\n";
    for speed in [1.0, 30.0] {
        let thrown = format!("[[initial]]\nat = \"upper\"\nvelocity = [0.0, 0.0, {:?}]\n", -speed);
        // Without cuts the steps would be three thicknesses long.
        let run = motion(SCHEMES[0], 0.3 / speed, 0.03 / speed);
        let contact = format!("stiffness = {:?}", 1e7 * speed * speed);
        let shells = "elements = 5\nrigid = true";
        let more = format!("{thrown}{held}");
        let deck = Sheets { run: &run, place: [0.03, 0.02], gap: 0.1, shells, contact: &contact, more: &more }.deck();
        let height = |frame: &Frame| {
            let body = frame.model.bodies.iter().find(|body| body.name == "upper").expect("the sheet").node;
            vec![frame.state.nodes[body].x.z]
        };
        let lowest = |deck: &str| {
            let done = run_model(deck, &mut |frame| height(frame));
            done.iter().map(|row| row[0]).fold(f64::INFINITY, f64::min)
        };
        assert!(lowest(&deck) > 0.25, "{speed}");
        let nodes = deck.replace(", edges = true", "");
        assert!(lowest(&nodes) < 0.2, "{speed}: nodes and faces saw it");
    }
}

fn run_model(deck: &str, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> Vec<Vec<f64>> {
    let done = run(&read_deck(deck), probe);
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    done.rows
}

/// Two sheets of one part, of 5 by 5 quadrilaterals each, as an Abaqus mesh.
fn two_sheets_of_one_part() -> String {
    let mut text = "*NODE\n".to_owned();
    let (mut elements, mut upper) = (String::new(), Vec::new());
    for sheet in 0..2 {
        for j in 0..=5 {
            for i in 0..=5 {
                let id = 100 * sheet + 6 * j + i + 1;
                let (along, up) = (-0.25 + 0.1 * f64::from(i), 0.1 * f64::from(j));
                let [x, y, z] = if sheet == 0 { [along, 0.0, up - 0.5] } else { [0.07, along - 0.03, up + 0.0105] };
                text += &format!("{id}, {x}, {y}, {z}\n");
                if sheet == 1 {
                    upper.push(id.to_string());
                }
                if i < 5 && j < 5 {
                    elements += &format!("{}, {id}, {}, {}, {}\n", 1000 + id, id + 1, id + 7, id + 6);
                }
            }
        }
    }
    let nodes = upper.chunks(10).map(|ids| ids.join(", ")).collect::<Vec<_>>().join("\n");
    text + "*ELEMENT, TYPE=S4, ELSET=SHEETS\n" + &elements + "*NSET, NSET=UPPER\n" + &nodes + "\n"
}

/// Two sheets that are one part press each other by their edges as two parts do, and neighbours along an edge do not.
#[test]
fn edges_of_one_part_touch_each_other() {
    let run = motion(SCHEMES[0], 0.002, 5e-6);
    let contact = "stiffness = 1e7";
    let two = Sheets { run: &run, place: [0.07, -0.03], gap: 5e-4, shells: "elements = 5", contact, more: THROWN };
    let apart = go(&two.deck(), &mut watch);
    let text = format!(
        "{run}\noutput = {{ energy = true, contacts = true, every = 1 }}\n\
         materials.steel = {{ model = \"elastic\", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}\n\
         mesh.file = \"sheets.inp\"\n\
         [[shells]]\nname = \"sheets\"\ngroup = \"SHEETS\"\nthickness = 0.01\nmaterial = \"steel\"\n\
         [[initial]]\nat = \"UPPER\"\nvelocity = [0.0, 0.0, -1.0]\n\
         [[contacts]]\nname = \"hit\"\nsurface = {{ part = \"sheets\", edges = true }}\nwith = \"itself\"\nstiffness = 1e7\n"
    );
    let folder = crate::mesh::Folder::with(&[("sheets.inp", &two_sheets_of_one_part())]);
    let model = folder.model(&text);
    let done = crate::support::run_to_the_end(&model, &mut watch);
    let pressed = |rows: &[Vec<f64>]| rows.iter().map(|row| row[3]).fold(0.0, f64::max);
    let (one, both) = (pressed(&done.rows), pressed(&apart.rows));
    // Nodes in another order: rounding, and the tolerance of the iteration.
    assert!(both > 0.5 && (one / both - 1.0).abs() < 1e-5, "{one} for {both}");
    assert!(done.rows[0][3] == 0.0, "neighbours press each other: {:?}", done.rows[0]);
}

/// A closed shell has no free edges.
#[test]
fn a_closed_shell_has_no_edges() {
    let mesh = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n\
                *ELEMENT, TYPE=S3, ELSET=TENT\n1, 1, 3, 2\n2, 1, 2, 4\n3, 2, 3, 4\n4, 1, 4, 3\n";
    let text = "analysis = { kind = \"dynamic\", end_time = 1e-3, time_step = 1e-5 }\n\
                materials.steel = { model = \"elastic\", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }\n\
                mesh.file = \"tent.inp\"\n\
                [[shells]]\nname = \"tent\"\ngroup = \"TENT\"\nthickness = 0.01\nmaterial = \"steel\"\n\
                [[contacts]]\nname = \"hit\"\nsurface = { part = \"tent\", edges = true }\nwith = \"itself\"\nstiffness = 1e7\n";
    let (model, said) = crate::mesh::Folder::with(&[("tent.inp", mesh)]).read(text);
    assert!(model.is_none() && said.contains("`tent` is closed and has no free edges"), "{said}");
}
