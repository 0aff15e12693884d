//! Names that mean several groups of a mesh: which of them a place of the deck takes, and what is said.

use super::{Folder, displacements};
use insta::assert_snapshot;
use rdsolve::mesh;

/// A strip of 4 x 2 elements as a pre-processor writes it. `Set-1` of the part is everything, that of the assembly the clamped edge;
/// `Edge` is a set of nodes and of elements.
const STRIP: &str = "\
*Part, name=STRIP
*Node
1, 0., 0.
2, .5, 0.
3, 1., 0.
4, 1.5, 0.
5, 2., 0.
6, 0., .5
7, .5, .5
8, 1., .5
9, 1.5, .5
10, 2., .5
11, 0., 1.
12, .5, 1.
13, 1., 1.
14, 1.5, 1.
15, 2., 1.
*Element, type=S4R, elset=SKIN
1, 1, 2, 7, 6
2, 2, 3, 8, 7
3, 3, 4, 9, 8
4, 4, 5, 10, 9
5, 6, 7, 12, 11
6, 7, 8, 13, 12
7, 8, 9, 14, 13
8, 9, 10, 15, 14
*Nset, nset=Set-1, generate
1, 15
*Elset, elset=Set-1, generate
1, 8
*End Part
*Assembly, name=Assembly
*Instance, name=STRIP-1, part=STRIP
*End Instance
*Nset, nset=Set-1, instance=STRIP-1
1, 6, 11
*Nset, nset=Edge, instance=STRIP-1
1, 6, 11
*Elset, elset=Edge, instance=STRIP-1
1, 5
*Nset, nset=Named
STRIP-1.1, STRIP-1.6, strip.11
*Nset, nset=Skin, instance=STRIP-1
1, 6, 11
*Nset, nset=Row, elset=Edge
*End Assembly
";

fn deck(group: &str, at: &str) -> String {
    format!(
        "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[mesh]\nfile = \"strip.inp\"\n[materials.m]\nmodel = \"elastic\"\n\
         youngs_modulus = 210e9\npoisson_ratio = 0.0\n[[shells]]\ngroup = \"{group}\"\nmaterial = \"m\"\nthickness = 0.05\n\
         [[supports]]\nat = {at}\nfix = \"all\"\n[[loads]]\nat = \"{group}\"\npressure = 1000.0\n"
    )
}

/// How far the free corner sinks, and what is said.
fn sinks(group: &str, at: &str) -> (f64, String) {
    let (model, said) = Folder::with(&[("strip.inp", STRIP)]).read(&deck(group, at));
    let model = model.unwrap_or_else(|| panic!("{said}"));
    let u = displacements(&model).into_iter().find(|(label, _)| label == "mesh.15").map(|(_, u)| -u[2]);
    (u.unwrap(), said)
}

/// Deflection of a cantilever strip 2 x 1 x 0.05 under 1000 per area, with shear: q L⁴/(8 E I) + q L²/(2 · 5/6 G A). Poisson's ratio
/// is zero, so that the strip is a beam; linear bending of four-node elements with a uniform load is exact at the nodes but for
/// the square of the slope, 6e-4.
const CLAMPED: f64 =
    1000.0 * 16.0 / (8.0 * 210e9 * 0.05 * 0.05 * 0.05 / 12.0) + 4000.0 / (2.0 * 5.0 / 6.0 * 105e9 * 0.05);

#[test]
fn supports_mean_sets_of_nodes() {
    for (at, notes) in
        [("Edge", 1), ("Set-1", 1), ("edge", 1), ("Named", 0), ("node-set:Edge", 0), ("Assembly.Set-1", 0)]
    {
        let (u, said) = sinks("SKIN", &format!("\"{at}\""));
        assert!((u / CLAMPED - 1.0).abs() < 1e-5, "{at}: {u} for {CLAMPED}");
        assert_eq!(said.matches("note: ").count(), notes, "{at}: {said}");
        assert!(!said.contains("warning"), "{said}");
    }
    // `SKIN` is the name of the shell too, which is made of the set of elements.
    let (u, said) = sinks("SKIN", "\"Skin\"");
    assert!((u / CLAMPED - 1.0).abs() < 1e-5, "{u}");
    assert!(said.contains("`node-set:Assembly.Skin` is taken"), "{said}");
    // Sections belong to the sets of parts.
    let (u, said) = sinks("Set-1", "\"Edge\"");
    assert!((u / CLAMPED - 1.0).abs() < 1e-5, "{u}: {said}");
    assert_snapshot!("a_node_set_is_taken", sinks("SKIN", "\"Edge\"").1);
}

#[test]
fn a_set_can_be_named_in_full() {
    // A row of elements held: what is left is a strip of 1.5.
    let held = |at: &str| sinks("SKIN", at).0;
    let row = held("\"element-set:Edge\"");
    assert!(row < 0.4 * CLAMPED, "{row}");
    assert_eq!([held("\"element-set:Assembly.edge\""), held("\"Row\""), held("\"face-set:Edge\"")], [row; 3]);
    // The set of the part is everything, and nothing moves.
    for name in ["STRIP-1.Set-1", "strip.set-1", "node-set:STRIP-1.Set-1"] {
        let (u, said) = sinks("SKIN", &format!("\"{name}\""));
        assert_eq!(u, 0.0);
        assert!(said.contains("hold all 90 degrees of freedom at zero"), "{said}");
    }
    assert_snapshot!("all_held", sinks("SKIN", "\"STRIP-1.Set-1\"").1);
    let unknown = Folder::with(&[("strip.inp", STRIP)]).read(&deck("SKIN", "\"line-set:Edge\"")).1;
    assert!(unknown.starts_with("error: no point, body, set or part is named `line-set:Edge`"), "{unknown}");
}

/// What moves by itself is not held, nor what a support moves.
#[test]
fn a_scene_that_moves_is_not_all_held() {
    let moved =
        deck("SKIN", "\"STRIP-1.Set-1\"").replace("fix = \"all\"", "fix = [\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"]");
    let motion = format!(
        "{moved}[[supports]]\nat = \"STRIP-1.Set-1\"\nmotion = {{ uz = {{ amplitude = \"a\" }} }}\n[amplitudes.a]\nkind = \"ramp\"\nend = 1.0\n"
    );
    for deck in [&moved, &motion] {
        let (model, said) = Folder::with(&[("strip.inp", STRIP)]).read(deck);
        assert!(model.is_some() && !said.contains("hold all"), "{said}");
    }
}

/// Physical groups of a point, a curve and a surface of one name: none of them is meant more than the others.
#[test]
fn groups_of_several_dimensions() {
    let plate = super::Plate { n: 2, m: 2, size: [2.0, 1.0] };
    let mesh = plate.msh4().replace("\"corner\"", "\"tip\"").replace("\"plate\"", "\"root\"");
    let folder = Folder::with(&[("strip.inp", STRIP), ("plate.msh", &mesh)]);
    let read = |at: &str| folder.read(&deck("root", at).replace("strip.inp", "plate.msh"));
    // Shells are made of faces, pressure acts on them.
    let (model, said) = read("\"line-set:root\"");
    assert!(model.is_some() && !said.contains("several groups"), "{said}");
    let held = |at: &str| read(at).0.unwrap_or_else(|| panic!("{}", read(at).1)).constraints.restraints.len() / 6;
    assert_eq!(held("\"line-set:root\""), 3);
    assert_eq!(held("[\"line-set:root\", \"node-set:tip\"]"), 4);
    assert_eq!(held("[\"line-set:root\", \"line-set:tip\"]"), 6);
    assert_snapshot!("a_point_and_a_curve", read("\"tip\"").1);
    // A name of groups that cover the same nodes means one thing.
    let same = mesh.replace("\"tip\"", "\"end\"");
    let mesh = mesh::read("a.msh", same.as_bytes()).unwrap();
    assert_eq!(mesh.named("end").len(), 2);
}

/// An instance stands where it is put: one that is moved and turned, and another of the same part with numbers of its own.
#[test]
fn instances_are_placed() {
    let placed = |lines: &str| {
        let text = STRIP.replace("part=STRIP\n", &format!("part=STRIP\n{lines}"));
        mesh::read("a.inp", text.as_bytes()).unwrap_or_else(|problems| panic!("{problems:?}"))
    };
    // Moved by (1, 2, 3), then a quarter turn about the line along y through (1, 2, 3): x becomes −z.
    let mesh = placed("1., 2., 3.\n1., 2., 3., 1., 5., 3., 90.\n");
    let x = mesh.nodes[14].x;
    // Coordinates of 5 with sixteen digits, and a cosine of 6e-17.
    assert!((x - rdsolve::math::Vec3::new(1.0, 3.0, 1.0)).norm() < 1e-14, "{x}");
    let text = STRIP.replace(
        "*End Instance\n",
        "*End Instance\n*Instance, name=STRIP-2, part=STRIP\n0., 0., 1.\n*End Instance\n*Node\n1, 9., 9., 9.\n",
    );
    let mesh = mesh::read("a.inp", text.as_bytes()).unwrap();
    let of = |id: u64| mesh.nodes[mesh.node(id).unwrap()].x;
    assert_eq!(
        (of(15).as_slice(), of(115).as_slice(), of(201).as_slice()),
        (&[2.0, 1.0, 0.0][..], &[2.0, 1.0, 1.0][..], &[9.0; 3][..])
    );
    assert_eq!((mesh.named("STRIP-2.skin").len(), mesh.named("skin").len(), mesh.notes.len()), (1, 3, 2));
    // A number in the assembly is that of a node of its own.
    let lost = text.replace("nset=Skin, instance=STRIP-1", "nset=Skin");
    let lost = mesh::read("a.inp", lost.as_bytes()).unwrap_err();
    assert_eq!(lost[0].message, "set `Skin` holds node 6, which does not exist");
    assert_eq!(lost[0].hints, ["numbers of an instance need `INSTANCE=STRIP-1` in the line of the set"]);
    let ids = |name: &str| {
        mesh.named(name)
            .iter()
            .flat_map(|&g| &mesh.groups[g as usize].nodes)
            .map(|&n| mesh.nodes[n as usize].id)
            .collect::<Vec<_>>()
    };
    assert_eq!(ids("Named"), [1, 6, 11]);
}

/// A beam or a bar in a list whose entries hold for every node alike means what a set with it means.
#[test]
fn lists_take_beams_as_sets_do() {
    let head = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n\
                c = [2.0, 1.0, 0.0]\n[materials.m]\nmodel = \"elastic\"\nyoungs_modulus = 1e9\npoisson_ratio = 0.3\ndensity = 1.0\n\
                [sections.s]\nshape = \"rectangle\"\nwidth = 0.02\nheight = 0.02\n[[beams]]\nname = \"rod\"\npath = [\"a\", \"b\"]\nelements = 3\n\
                material = \"m\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[bars]]\nname = \"tie\"\npath = [\"b\", \"c\"]\n\
                material = \"m\"\narea = 1e-4\n[[bodies]]\nname = \"hub\"\ncenter = [2.0, 1.0, 0.0]\nmass = 1.0\n\
                inertia = [1.0, 1.0, 1.0]\n[sets]\nof_rod = [\"rod\"]\nof_tie = [\"tie\"]\n";
    let folder = Folder::with(&[]);
    let model = |part: &str, other: &str| {
        let model = folder.model(&format!(
            "{head}[[supports]]\nat = \"{part}\"\nfix = [\"uz\"]\n[[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\", \"rx\"]\n\
             [[attachments]]\nbody = \"hub\"\nnodes = \"{other}\"\n[output]\nnodes = \"{part}\"\n"
        ));
        let held: Vec<_> = model.constraints.restraints.iter().map(|r| (r.node, r.dof)).collect();
        let attached: Vec<_> = model.constraints.dependents.iter().map(|d| (d.node, d.master)).collect();
        (held, attached, model.output.nodes)
    };
    assert_eq!(model("rod", "tie"), model("of_rod", "of_tie"));
    assert_eq!(model("tie", "rod"), model("of_tie", "of_rod"));
    assert!(model("rod", "tie").0.len() > 6);
    // What each node gets in whole is not spread over a beam by its name.
    let load =
        format!("{head}[[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"rod\"\nforce = [1.0, 0.0, 0.0]\n");
    assert!(folder.read(&load).1.contains("or a set of the part: each of its nodes gets the whole"));
}
