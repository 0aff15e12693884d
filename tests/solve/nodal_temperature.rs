//! Temperatures by node: closed forms of bars, beams and shells, the bits of a uniform temperature, and refusals.

use crate::mesh::Folder;
use crate::support::{Tables, node, position, read_deck, run_to_the_end, tables_of};
use rdsolve::math::Vec3;

const EXPANSION: f64 = 1e-5;

fn material() -> String {
    format!(
        "materials.m = {{ model = \"elastic\", youngs_modulus = 2e11, poisson_ratio = 0.3, expansion = {EXPANSION:?} }}\n"
    )
}

const STATIC: &str = "analysis = { kind = \"static\", end_time = 1.0, time_step = 1.0 }\n";

fn last(text: &str, at: &str) -> Vec3 {
    let model = read_deck(text);
    let at = node(&model, at);
    let start = model.nodes[at].x;
    let rows = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[at]).to_vec()).rows;
    Vec3::from_column_slice(rows.last().expect("a row")) - start
}

/// A path of two segments of three elements each, with a load on it.
fn line(kind: &str, supports: &str, load: &str) -> String {
    let part = match kind {
        "beams" => "section = \"s\", orientation = [0.0, 1.0, 0.0], elements = 3",
        _ => "area = 0.01, elements = 1",
    };
    format!(
        "{STATIC}{}points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [3.0, 0.0, 0.0], e = [9.0, 0.0, 0.0] }}\n\
         sections.s = {{ shape = \"rectangle\", width = 0.1, height = 0.1 }}\n\
         {kind} = [{{ name = \"rod\", path = [\"a\", \"b\", \"c\"], material = \"m\", {part} }}]\n{supports}\
         loads = [{{ part = \"rod\", {load} }}]\noutput = {{ sections = true, parts = true }}\n",
        material()
    )
}

/// Between points of a path the temperature is linear: u = α ∫ T dx, whatever the elements.
#[test]
fn rods_grow_by_the_integral_of_their_temperature() {
    let held = "supports = [{ at = \"a\", fix = \"all\" }]\n";
    let along = "supports = [{ at = \"a\", fix = \"all\" }, { at = [\"b\", \"c\"], fix = [\"uy\", \"uz\"] }]\n";
    for (kind, supports) in [("beams", held), ("bars", along)] {
        let grown = last(&line(kind, supports, "nodal_temperature = { a = 20.0, b = 80.0, c = 30.0 }"), "c");
        let exact = EXPANSION * (50.0 + 2.0 * 55.0);
        assert!((grown.x / exact - 1.0).abs() < 1e-9 && grown.yz().norm() < 1e-12, "{kind}: {grown} {exact}");
        // Points without an entry have `temperature`.
        let grown = last(&line(kind, supports, "temperature = 10.0, nodal_temperature = { b = 80.0 }"), "c");
        assert!((grown.x / (EXPANSION * (45.0 + 90.0)) - 1.0).abs() < 1e-9, "{kind}: {grown}");
    }
}

/// One temperature at all nodes has the bits of `temperature`.
#[test]
fn one_temperature_at_all_nodes_is_uniform() {
    for kind in ["beams", "bars"] {
        let clamped = "supports = [{ at = [\"a\", \"c\"], fix = \"all\" }]\n";
        let supports = if kind == "beams" {
            clamped
        } else {
            "supports = [{ at = [\"a\", \"c\", \"b\"], fix = [\"uy\", \"uz\"] }, { at = \"a\", fix = [\"ux\"] }]\n"
        };
        let [uniform, nodal] = ["temperature = 40.0", "nodal_temperature = { a = 40.0, b = 40.0, c = 40.0 }"]
            .map(|load| last(&line(kind, supports, load), "b"));
        assert_eq!(uniform, nodal, "{kind}");
    }
}

/// Held at both ends a rod presses with E A α times its mean temperature; heating has done the work of its strain energy.
#[test]
fn a_clamped_rod_presses_with_its_mean_temperature() {
    let clamped = "supports = [{ at = [\"a\", \"c\"], fix = \"all\" }]\n";
    let tables = tables_of(&read_deck(&line("beams", clamped, "nodal_temperature = { a = 20.0, b = 80.0, c = 30.0 }")));
    let force = tables.rows("sections.csv").last().expect("a row").number("N");
    let exact = -2e11 * 0.01 * EXPANSION * 160.0 / 3.0;
    // The rod moves along itself by 1e-4, which the strain measure has to the first order.
    assert!((force / exact - 1.0).abs() < 1e-3, "{force} {exact}");
    balanced(&tables);
}

/// The work of heating is the energy that it leaves.
fn balanced(tables: &Tables) {
    let row = tables.rows("energy.csv").into_iter().last().expect("a row");
    let (strain, external) = (row.number("strain"), row.number("external"));
    println!("strain {strain} external {external}");
    // One load step integrates a force that is linear in the temperature.
    assert!((strain - external).abs() < 2e-3 * strain, "{strain} {external}");
}

/// A strip along x whose temperature rises across it: a free one bends by α T′ in its plane.
fn strip(elements: [usize; 2], kind: &str, load: &str) -> String {
    format!(
        "{STATIC}{}points = {{ a = [0.0, 0.0, 0.0], b = [2.0, 0.0, 0.0], c = [2.0, 0.5, 0.0], d = [0.0, 0.5, 0.0] }}\n\
         shells = [{{ name = \"strip\", corners = [\"a\", \"b\", \"c\", \"d\"], elements = {elements:?}, thickness = 0.01, material = \"m\"{kind} }}]\n\
         supports = [{{ at = \"strip\", fix = [\"uz\"] }}, {{ at = \"a\", fix = [\"ux\", \"uy\"] }}, {{ at = \"d\", fix = [\"ux\"] }}]\n{load}",
        material()
    )
}

/// Two edges with one temperature each, and one at all nodes.
#[test]
fn a_shell_grows_by_the_mean_of_its_corners() {
    for kind in ["", ", kind = \"triangle\"", ", order = 2"] {
        let load =
            "loads = [{ part = \"strip\", nodal_temperature = { \"strip.edge4\" = 30.0, \"strip.edge2\" = 90.0 } }]\n";
        if !kind.contains("triangle") {
            let one = last(&strip([1, 1], kind, load), "b");
            // All corners lie on the two edges, and the mean over the strip is 60; the triangles of a square have 50 and 70.
            assert!((one.x / (EXPANSION * 60.0 * 2.0) - 1.0).abs() < 1e-2, "{kind}: {one}");
        }
        let load = "loads = [{ part = \"strip\", nodal_temperature = { strip = 60.0 } }]\n";
        let uniform = "loads = [{ part = \"strip\", temperature = 60.0 }]\n";
        let [nodal, uniform] = [load, uniform].map(|load| last(&strip([4, 2], kind, load), "c"));
        assert_eq!(nodal, uniform, "{kind}");
    }
}

/// A sheet of a mesh with T = 100 y bends in its plane to the curvature α 100, the better the more elements lie across.
#[test]
fn a_strip_bends_away_from_its_warm_edge() {
    let tip = |across: usize, yielding: bool| {
        let along = 4 * across;
        let (mut nodes, mut elements, mut values) = (String::new(), String::new(), Vec::new());
        for j in 0..=across {
            for i in 0..=along {
                let id = j * (along + 1) + i + 1;
                let y = 0.5 * j as f64 / across as f64;
                nodes += &format!("{id} {} {y} 0\n", 2.0 * i as f64 / along as f64);
                values.push(format!("\"mesh.{id}\" = {:?}", 100.0 * y));
            }
        }
        for j in 0..across {
            for i in 0..along {
                let a = j * (along + 1) + i + 1;
                let id = j * along + i + 1;
                elements += &format!("{id} 3 2 1 1 {a} {} {} {}\n", a + 1, a + along + 2, a + along + 1);
            }
        }
        let mesh = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"sheet\"\n$EndPhysicalNames\n$Nodes\n{}\n{nodes}$EndNodes\n\
             $Elements\n{}\n{elements}$EndElements\n",
            (along + 1) * (across + 1),
            along * across
        );
        let far = along + 1;
        let law = if yielding {
            "model = \"elastic-plastic\", yield_stress = 1e9, hardening_modulus = 1e9"
        } else {
            "model = \"elastic\""
        };
        let deck = format!(
            "{STATIC}materials.m = {{ {law}, youngs_modulus = 2e11, poisson_ratio = 0.3, expansion = {EXPANSION:?} }}\nmesh.file = \"m.msh\"\n\
             shells = [{{ group = \"sheet\", thickness = 0.01, material = \"m\" }}]\n\
             supports = [{{ at = \"sheet\", fix = [\"uz\"] }}, {{ at = \"mesh.1\", fix = [\"ux\", \"uy\"] }}, {{ at = \"mesh.{}\", fix = [\"ux\"] }}]\n\
             loads = [{{ part = \"sheet\", nodal_temperature = {{ {} }} }}]\n",
            across * (along + 1) + 1,
            values.join(", ")
        );
        let folder = Folder::with(&[("m.msh", &mesh)]);
        let model = folder.model(&deck);
        let at = node(&model, &format!("mesh.{far}"));
        let rows = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[at]).to_vec()).rows;
        rows.last().expect("a row")[1]
    };
    // The axis of zero temperature bends with the curvature α T′ toward −y where y is warm.
    let exact = -0.5 * EXPANSION * 100.0 * 4.0;
    let [coarse, fine] = [2, 4].map(|across| tip(across, false) / exact - 1.0);
    println!("{coarse} {fine}");
    assert!(fine.abs() < 0.1 && (3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
    let yielding = tip(2, true) / exact - 1.0;
    assert!((yielding - coarse).abs() < 1e-3, "layers that stay elastic: {yielding} {coarse}");
}

#[test]
fn temperatures_of_nothing_are_refused() {
    let told = |load: &str| {
        let text = line("beams", "supports = [{ at = \"a\", fix = \"all\" }]\n", load);
        let source = rdsolve::diagnostic::Source::new("deck.toml", text, &[]);
        let problems = rdsolve::model::read(&source).1;
        problems.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n")
    };
    for (load, message) in [
        ("nodal_temperature = { d = 20.0 }", "no point, body or set is named `d`"),
        ("nodal_temperature = { e = 20.0 }", "`e` has no node of the heated parts"),
        (
            "nodal_temperature = { a = 20.0 }, force = [1.0, 0.0, 0.0]",
            "`force` does not apply to a load that heats parts",
        ),
    ] {
        let said = told(load);
        assert!(said.contains(message), "{message}\n{said}");
    }
}
