//! Parts and sets of a mesh against the same patches and paths in the deck.

use super::{Folder, Plate, displacements, positions};
use crate::support::{self, node};
use rdsolve::math::Vec3;
use rdsolve::model::{Link, Model, PartKind, Shell};

const PLATE: Plate = Plate { n: 8, m: 3, size: [2.0, 0.6] };

const HEAD: &str = r#"
[analysis]
kind = "KIND"
end_time = 0.05
time_step = 0.005
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
"#;

fn patch(kind: &str) -> String {
    format!(
        "{}{}",
        HEAD.replace("KIND", kind),
        r#"
[points]
a = [0.0, 0.0, 0.0]
b = [2.0, 0.0, 0.0]
c = [2.0, 0.6, 0.0]
d = [0.0, 0.6, 0.0]
[[shells]]
name = "plate"
corners = ["a", "b", "c", "d"]
elements = [8, 3]
thickness = 0.02
material = "steel"
[[supports]]
at = "plate.edge4"
fix = "all"
[[loads]]
at = "plate.edge2"
force_per_length = [100.0, 0.0, 9000.0]
[[loads]]
at = "plate"
pressure = 1000.0
[[loads]]
at = "c"
force = [0.0, 500.0, 0.0]
"#
    )
}

fn meshed(kind: &str, file: &str) -> String {
    let corner = if file.ends_with("inp") { "Corner" } else { "corner" };
    format!(
        "{}[mesh]\nfile = \"{file}\"\n{}",
        HEAD.replace("KIND", kind),
        r#"
[[shells]]
group = "plate"
thickness = 0.02
material = "steel"
[[supports]]
at = "root"
fix = "all"
[[loads]]
at = "tip"
force_per_length = [100.0, 0.0, 9000.0]
[[loads]]
at = "plate"
pressure = 1000.0
[[loads]]
at = "CORNER"
force = [0.0, 500.0, 0.0]
"#
        .replace("CORNER", corner)
    )
}

/// The three formats and the patch: the same plate, statically at large deflection and swinging. Nodes are numbered in another
/// order, so sums round differently; iterations stop at 1e-8 of the forces, far below that after the last one.
#[test]
fn a_cantilever_from_three_formats_is_the_patch() {
    let folder = Folder::with(&[("a.msh", &PLATE.msh4()), ("b.msh", &PLATE.msh2()), ("c.inp", &PLATE.inp())]);
    for kind in ["static", "dynamic"] {
        let exact = positions(&folder.model(&patch(kind)), "c");
        let label = format!("mesh.{}", PLATE.node(PLATE.n, PLATE.m));
        let found = ["a.msh", "b.msh", "c.inp"].map(|file| positions(&folder.model(&meshed(kind, file)), &label));
        assert_eq!(found[0], found[1], "the same bytes");
        assert_eq!(found[0], found[2], "the same bytes");
        let largest = exact.iter().map(|x| x[2].abs()).fold(0.0, f64::max);
        assert!(largest > 0.1, "it bends: {largest}");
        for (x, exact) in found[0].iter().zip(&exact) {
            let off = (Vec3::from(*x) - Vec3::from(*exact)).norm();
            println!("{kind}: {:.6} off by {off:.1e}", exact[2]);
            assert!(off < 1e-11 * largest.max(1.0), "{kind}: {x:?} {exact:?}"); // 27 nodes × κ of the iteration matrix
        }
    }
}

/// Every node of the mesh moves as the patch's node at its place; a set named in `output` brings nodes to nodes.csv, which
/// holds named points alone by default.
#[test]
fn sets_and_names() {
    let folder = Folder::with(&[("a.msh", &PLATE.msh4())]);
    let deck = meshed("static", "a.msh");
    let model = folder.model(&deck);
    assert_eq!((model.nodes.len(), model.count(PartKind::Shell), model.parts[0].elements()), (36, 1, 24));
    assert!(model.output.nodes.is_empty());
    let with = |nodes: &str| folder.model(&format!("{deck}\n[output]\nnodes = {nodes}\n"));
    let labels = |nodes: &str| -> Vec<String> {
        let model = with(nodes);
        model.output.nodes.iter().map(|&node| model.nodes[node].label.clone()).collect()
    };
    assert_eq!(labels("\"tip\""), ["mesh.9", "mesh.18", "mesh.27", "mesh.36"]);
    assert_eq!(labels("[\"mesh.5\", \"corner\"]"), ["mesh.5", "mesh.36"]);
    assert_eq!(labels("\"all\"").len(), 36);
    assert_eq!(with("\"tip\"").output.sets, ["tip"; 4]);
    assert_eq!(with("[\"mesh.5\", \"corner\"]").output.sets, ["mesh.5", "corner"]);
    assert!(with("[\"mesh.5\", \"mesh.9\"]").output.sets.is_empty() && with("\"all\"").output.sets.is_empty());
    // Values and links at a set of one node.
    let more = r#"
[sets]
one = ["corner"]
[[expect]]
at = "corner"
quantity = "z"
time = 0.05
value = 1.0
tolerance = 0.1
[[expect]]
at = "one"
quantity = "z"
time = 0.05
value = 1.0
tolerance = 0.1
[[links]]
name = "spring"
from = { node = "corner" }
to = { ground = [2.0, 0.6, -1.0] }
stiffness = 1.0
"#;
    let model = folder.model(&format!("{deck}{more}"));
    let at = node(&model, "mesh.36");
    assert_eq!(model.each::<Link>().next().unwrap().ends[0], at);
    let expected = rdsolve::model::ExpectAt::Node(at);
    assert!(model.expects.iter().all(|expect| expect.at == expected));
}

/// Scaled, and nodes that no part uses left out.
#[test]
fn scale_and_what_is_left_out() {
    let millimetres = Plate { size: [2000.0, 600.0], ..PLATE };
    let text = millimetres.msh2().replace("$Nodes\n36\n", "$Nodes\n37\n1000 7 7 7\n");
    let folder = Folder::with(&[("a.msh", &PLATE.msh4()), ("mm.msh", &text)]);
    let one = displacements(&folder.model(&meshed("static", "a.msh")));
    let deck = meshed("static", "mm.msh").replace("file = \"mm.msh\"", "file = \"mm.msh\"\nscale = 1e-3");
    let two = displacements(&folder.model(&deck));
    assert_eq!(one.len(), two.len());
    for ((label, u), (other, v)) in one.iter().zip(&two) {
        assert_eq!(label, other);
        // Coordinates that differ in the last digit.
        assert!((Vec3::from(*u) - Vec3::from(*v)).norm() < 1e-10, "{label}: {u:?} {v:?}");
    }
}

/// Triangles and quadrilaterals of one group are one part: mass, pressure and values by its name cover both.
#[test]
fn a_group_of_both_kinds() {
    let text = PLATE.inp().replace(
        "*nset, nset=root",
        "*NODE\n101, 3., 0.3, 0.\n*ELEMENT, TYPE=S3, ELSET=plate\n101, 9, 101, 18\n102, 18, 101, 27\n103, 27, 101, 36\n*nset, nset=root",
    );
    let folder = Folder::with(&[("a.inp", &text)]);
    let deck = meshed("static", "a.inp")
        .replace("\"elastic\"", "\"elastic-plastic\"\nyield_stress = 200e6\nhardening_modulus = 1e9");
    let more = "[[expect]]\nat = \"plate\"\nquantity = \"plastic_strain\"\ntime = 0.05\nvalue = 0.0\nabsolute_tolerance = 1.0\n";
    let model = folder.model(&format!("{deck}{more}[environment]\ngravity = [0.0, 0.0, -9.81]\n"));
    assert_eq!(
        model.each::<Shell>().map(|shell| (shell.name.as_str(), shell.corners)).collect::<Vec<_>>(),
        [("plate", 4), ("plate", 3)]
    );
    assert_eq!(model.expects[0].at, rdsolve::model::ExpectAt::Shells(0, 2));
    let system = rdsolve::system::System::new(&model).unwrap();
    let mass: f64 = system.inertias.iter().map(|inertia| inertia.mass).sum();
    // ρ h (1.2 + 0.3)
    assert!((mass / (7850.0 * 0.02 * 1.5) - 1.0).abs() < 1e-14, "{mass}");
    let pressure: f64 = model.loading.nodal.iter().map(|load| load.force.z).sum();
    assert!((pressure - (9000.0 * 0.6 - 1000.0 * 1.5)).abs() < 1e-9, "{pressure}");
}

/// An edge load on the segments of a group, on a set of nodes at the border, on one inside: the same resultant.
#[test]
fn loads_along_edges() {
    let text = PLATE.inp()
        + "*NSET, NSET=middle\n5, 14, 23, 32\n*NSET, NSET=border, GENERATE\n1, 9\n*NSET, NSET=border\n9, 18, 27, 36\n";
    let folder = Folder::with(&[("a.inp", &text)]);
    for (set, length) in [("tip", 0.6), ("middle", 0.6), ("border", 2.6)] {
        let deck = meshed("static", "a.inp")
            .replace("at = \"tip\"", &format!("at = \"{set}\""))
            .replace("pressure = 1000.0", "pressure = 0.0");
        let model = folder.model(&deck);
        let sum: f64 = model.loading.nodal.iter().map(|load| load.force.z).sum();
        assert!((sum - 9000.0 * length).abs() < 1e-9, "{set}: {sum}");
    }
}

/// Two tubes of a mesh against the same path; the orders of the elements, with inner nodes.
#[test]
fn beams_of_segments() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n7 0 0 0\n3 1 0 1\n8 2 0.5 1\n$EndNodes\n\
                $Elements\n2\n1 1 2 5 1 7 3\n2 1 2 5 1 3 8\n$EndElements\n";
    let folder = Folder::with(&[("a.msh", text)]);
    let tail = r#"
material = "steel"
section = "tube"
orientation = [0.0, 1.0, 0.2]
order = ORDER
[sections.tube]
shape = "tube"
radius = 0.02
thickness = 0.002
"#;
    for order in 1..=4 {
        let tail = tail.replace("ORDER", &order.to_string());
        let head = HEAD.replace("KIND", "dynamic");
        let path = format!(
            "{head}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 1.0]\nc = [2.0, 0.5, 1.0]\n\
             [[beams]]\nname = \"posts\"\npath = [\"a\", \"b\", \"c\"]\nelements = 1{tail}\
             [[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"c\"\nforce = [0.0, 100.0, -300.0]\n"
        );
        let mesh = format!(
            "{head}[mesh]\nfile = \"a.msh\"\n[[beams]]\nname = \"posts\"\ngroup = \"physical_5\"{tail}\
             [[supports]]\nat = \"mesh.7\"\nfix = \"all\"\n[[loads]]\nat = \"mesh.8\"\nforce = [0.0, 100.0, -300.0]\n"
        );
        let (one, two) = (positions(&folder.model(&path), "c"), positions(&folder.model(&mesh), "mesh.8"));
        for (a, b) in one.iter().zip(&two) {
            assert!((Vec3::from(*a) - Vec3::from(*b)).norm() < 1e-12, "order {order}: {a:?} {b:?}");
        }
        assert!((one.last().unwrap()[2] - 1.0).abs() > 0.01, "it moves");
    }
}

#[test]
fn the_plan_says_what_came_from_the_mesh() {
    let folder = Folder::with(&[("a.msh", &PLATE.msh4())]);
    let model = folder.model(&meshed("static", "a.msh"));
    let system = rdsolve::system::System::new(&model).unwrap();
    let text =
        rdsolve::plan::explain::explain(&rdsolve::plan::Plan::new(&model, &system, 1), &model, &system).to_string();
    assert!(text.contains("36 nodes, 30 elements, 24 of them in parts"), "{text}");
}

/// A quarter of a ring, whose normals the patch knows and the mesh takes from its faces, one-sided at the ends: what that does
/// falls faster than the square of the size of the elements, and so faster than their own error.
#[test]
fn normals_of_a_mesh_bend_as_those_of_the_surface() {
    let head = HEAD.replace("KIND", "static").replace("time_step = 0.005", "time_step = 0.05");
    let off = |n: usize| {
        let mut text = "*NODE\n".to_owned();
        for j in 0..=2 {
            for i in 0..=n {
                let (sin, cos) = (std::f64::consts::FRAC_PI_2 * i as f64 / n as f64).sin_cos();
                text += &format!("{}, {sin}, {}, {}\n", 1 + i + j * (n + 1), 0.2 * j as f64, 1.0 - cos);
            }
        }
        text += "*ELEMENT, TYPE=S4, ELSET=s\n";
        for (i, j) in (0..2).flat_map(|j| (0..n).map(move |i| (i, j))) {
            let a = 1 + i + j * (n + 1);
            text += &format!("{}, {a}, {}, {}, {}\n", 1 + i + j * n, a + 1, a + n + 2, a + n + 1);
        }
        let set = |name: &str, first: usize| {
            format!("*NSET, NSET={name}, GENERATE\n{first}, {}, {}\n", first + 2 * (n + 1), n + 1)
        };
        text += &(set("root", 1) + &set("tip", n + 1));
        let tail = "thickness = 0.01\nmaterial = \"steel\"\n[[supports]]\nat = \"ROOT\"\nfix = \"all\"\n\
                    [[loads]]\nat = \"TIP\"\nforce_per_length = [0.0, 200.0, -2000.0]\n";
        let mesh = format!("{head}[mesh]\nfile = \"a.inp\"\n[[shells]]\ngroup = \"s\"\n{tail}")
            .replace("ROOT", "root")
            .replace("TIP", "tip");
        let patch = format!(
            "{head}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 1.0]\nc = [1.0, 0.4, 1.0]\nd = [0.0, 0.4, 0.0]\n\
             [[shells]]\nname = \"s\"\ncorners = [\"a\", \"b\", \"c\", \"d\"]\nelements = [{n}, 2]\n\
             surface = {{ kind = \"cylinder\", axis = [0.0, 1.0, 0.0], center = [0.0, 0.0, 1.0] }}\n{tail}"
        );
        let patch = patch.replace("ROOT", "s.edge4").replace("TIP", "s.edge2");
        let folder = Folder::with(&[("a.inp", &text)]);
        let one = positions(&folder.model(&mesh), &format!("mesh.{}", n + 1)).last().unwrap()[2] - 1.0;
        let two = positions(&folder.model(&patch), "b").last().unwrap()[2] - 1.0;
        (one / two - 1.0).abs()
    };
    let points = [8, 16, 32].map(|n| (1.0 / n as f64, off(n)));
    println!("{points:?}");
    assert!(support::slope(&points) > 2.0 && points[0].1 < 2e-3, "{points:?}");
}

/// A part is read by itself, whatever else the mesh holds: nodes before it, another part beside it.
#[test]
fn a_part_of_a_large_mesh_has_the_normals_of_a_small_one() {
    let nodes = "1, 0., 0.\n2, 1., 0., .2\n3, 2., 0.\n4, 3., 0., .1\n5, 0., 1.\n6, 1., 1.\n7, 2., 1., .2\n8, 3., 1.\n";
    let elements = "*ELEMENT, TYPE=S3, ELSET=plate\n1, 1, 2, 6\n2, 1, 6, 5\n*ELEMENT, TYPE=S4, ELSET=plate\n3, 2, 3, 7, 6\n\
                    4, 3, 4, 8, 7\n*NSET, NSET=root\n1, 5\n*NSET, NSET=tip\n4, 8\n*NSET, NSET=Corner\n8\n";
    let small = format!("*NODE\n{nodes}{elements}");
    let others: String = (101..200).map(|id| format!("{id}, {}., 5.\n", id - 100)).collect();
    let beside = "*ELEMENT, TYPE=S3, ELSET=flap\n9, 4, 8, 101\n10, 8, 4, 102\n";
    let large = format!("*NODE\n{others}{nodes}{beside}{elements}");
    let folder = Folder::with(&[("small.inp", &small), ("large.inp", &large)]);
    let flap = "[[shells]]\ngroup = \"flap\"\nthickness = 0.02\nmaterial = \"steel\"\n[[shells]]\ngroup = \"plate\"";
    let alone = folder.model(&meshed("static", "small.inp"));
    let with = folder.model(&meshed("static", "large.inp").replace("[[shells]]\ngroup = \"plate\"", flap));
    let of = |model: &Model| -> Vec<_> {
        let plate = model.each::<Shell>().filter(|shell| shell.name == "plate");
        plate.flat_map(|shell| shell.elements.iter().map(|e| e.normals)).collect()
    };
    assert_eq!(of(&alone).len(), 4);
    assert_eq!(of(&alone), of(&with), "to the last bit");
}

/// A pressure on a group of elements within a shell: its resultant is that on the area of the group, in its middle. A face named twice is
/// loaded once; a face outside all shells is an error.
#[test]
fn loads_act_on_groups_within_a_shell() {
    let outer = "*ELSET, ELSET=outer, GENERATE\n5, 8\n13, 16\n21, 24\n*ELSET, ELSET=free\n9\n";
    let whole = PLATE.inp() + outer;
    let cut = whole.replace("*ELEMENT, TYPE=S4R, ELSET=plate\n", "*ELEMENT, TYPE=S4R\n")
        + "*ELSET, ELSET=plate, GENERATE\n1, 8\n10, 24\n";
    let folder = Folder::with(&[("c.inp", &whole), ("cut.inp", &cut)]);
    let loaded = |at: &str, load: &str, file: &str| {
        let deck = meshed("static", file).replace("force_per_length = [100.0, 0.0, 9000.0]", "force = [0.0, 0.0, 0.0]");
        let deck = deck.replace("force = [0.0, 500.0, 0.0]", "force = [0.0, 0.0, 0.0]");
        deck.replace("at = \"plate\"\npressure = 1000.0", &format!("at = {at}\n{load}"))
            + "[sets]\nskin = [\"outer\", \"free\"]\nskins = [\"skin\"]\n"
    };
    for (at, load, area) in [
        ("\"outer\"", "pressure = 1000.0", 0.6),
        ("[\"outer\", \"outer\"]", "force_per_area = [0.0, 0.0, -1000.0]", 0.6),
        ("[\"outer\", \"plate\"]", "pressure = 1000.0", 1.2),
        ("[\"skins\", \"element-set:free\"]", "pressure = 1000.0", 0.65),
    ] {
        let model = folder.model(&loaded(at, load, "c.inp"));
        let forces = || model.loading.nodal.iter().map(|load| (model.nodes[load.node].x, load.force));
        let force: f64 = forces().map(|(_, force)| force.z).sum();
        assert!((force + 1000.0 * area).abs() < 1e-10, "{at}: {force}");
        if area == 0.6 {
            let moment: f64 = forces().map(|(x, force)| x.x * force.z).sum();
            assert!((moment + 1000.0 * area * 1.5).abs() < 1e-10, "{at}: {moment}");
        }
    }
    let follower = folder.model(&loaded("\"outer\"", "pressure = 1000.0\nfollower = true", "c.inp"));
    assert_eq!(follower.loading.pressures[0].faces.len(), 12);
    let said = folder.read(&loaded("\"free\"", "pressure = 1000.0", "cut.inp")).1;
    assert!(said.contains("1 of the 1 faces of `free` are in no shell"), "{said}");
}

/// A plate made of two halves of its thickness, on either side of the nodes, is the plate: statically with large deflections, in its modes,
/// swinging, and by an explicit scheme.
#[test]
fn two_halves_beside_the_nodes_are_the_plate() {
    let elements = |inp: &str| {
        let (head, rest) = inp.split_once("*ELEMENT").unwrap();
        let (block, tail) = rest.split_at(rest.find("*nset").unwrap());
        let other = block.replace("ELSET=plate", "ELSET=other");
        let renumbered: String = other
            .lines()
            .map(|line| match line.split_once(',') {
                Some((id, nodes)) if id.parse::<u32>().is_ok() && nodes.trim_end().ends_with(',') => {
                    format!("1{id:0>3},{nodes}\n")
                }
                _ => format!("{line}\n"),
            })
            .collect();
        format!("{head}*ELEMENT{block}*ELEMENT{renumbered}{tail}")
    };
    let folder = Folder::with(&[("c.inp", &PLATE.inp()), ("two.inp", &elements(&PLATE.inp()))]);
    let explicit = "time_step = 1e-5\n[integrator]\nscheme = \"central-difference\"\n";
    let tip = format!("mesh.{}", PLATE.node(PLATE.n, PLATE.m));
    for (kind, step, tolerance) in [
        // Edges bend between their nodes by the thickness of each half: 3e-4 of the deflection, a tenth of the error of the mesh.
        ("static", "time_step = 0.025\n", 5e-4),
        // The same in frequencies, over two thirds of a period.
        ("dynamic", "time_step = 0.0005\n", 2e-3),
        ("dynamic", explicit, 2e-3),
    ] {
        let whole = meshed(kind, "c.inp")
            .replace("time_step = 0.005\n", step)
            .replace("force = [0.0, 500.0, 0.0]", "force = [0.0, 0.0, 0.0]");
        let whole = if step == explicit { whole.replace("end_time = 0.05", "end_time = 0.002") } else { whole };
        let half = |group: &str, offset: f64| {
            format!("[[shells]]\ngroup = \"{group}\"\nthickness = 0.01\noffset = {offset}\nmaterial = \"steel\"\n")
        };
        let halves = whole.replace("c.inp", "two.inp").replace(
            "[[shells]]\ngroup = \"plate\"\nthickness = 0.02\nmaterial = \"steel\"\n",
            &(half("plate", 0.005) + &half("other", -0.005)),
        );
        // Steps may be cut apart; both end at the same time.
        let [one, two] =
            [&whole, &halves].map(|deck| Vec3::from(*positions(&folder.model(deck), &tip).last().unwrap()));
        assert!((one - two).norm() < tolerance * one.z.abs(), "{kind}: {one} {two}");
    }
}

/// A strip beside its nodes, pulled along them: u = N L/E A + e² N L/E I, w = e N L²/2 E I.
#[test]
fn a_strip_beside_its_nodes_bends_as_it_is_pulled() {
    let folder = Folder::with(&[("c.inp", &PLATE.inp())]);
    let (N, e, E, h) = (1e5, 0.03, 210e9, 0.02f64);
    let deck = meshed("static", "c.inp")
        .replace("end_time = 0.05\ntime_step = 0.005\n", "geometry = \"linear\"\n")
        .replace("poisson_ratio = 0.3", "poisson_ratio = 0.0")
        .replace("thickness = 0.02", &format!("thickness = {h}\noffset = {e}"))
        .replace("force_per_length = [100.0, 0.0, 9000.0]", &format!("force_per_length = [{:?}, 0.0, 0.0]", N / 0.6))
        .replace("force = [0.0, 500.0, 0.0]", "force = [0.0, 0.0, 0.0]")
        .replace("pressure = 1000.0", "pressure = 0.0");
    let (area, inertia) = (0.6 * h, 0.6 * h.powi(3) / 12.0);
    let (u, w) = (2.0 * N / E * (1.0 / area + e * e / inertia), e * N * 4.0 / (2.0 * E * inertia));
    let found = displacements(&folder.model(&deck));
    let tip = found.iter().find(|(label, _)| *label == format!("mesh.{}", PLATE.node(PLATE.n, 1))).unwrap().1;
    assert!((tip[0] / u - 1.0).abs() < 1e-9, "{tip:?} {u} {w}");
    assert!((tip[2] / w - 1.0).abs() < 1e-9, "{tip:?} {u} {w}");
}

/// A strip whose thickness falls from the root to half at the tip: the deflection under a force is ∫ F (L − x)²/(E I) dx with shear, to second
/// order of the elements' length, and its mass is exact.
#[test]
fn thickness_by_node_tapers_a_strip() {
    let (E, thick, force) = (210e9, 0.04, 100.0);
    let h = |x: f64| thick * (1.0 - 0.25 * x);
    let exact: f64 = (0..10_000)
        .map(|k| {
            let x = (k as f64 + 0.5) * 2e-4;
            let (inertia, area) = (0.5 * h(x).powi(3) / 12.0, 0.5 * h(x));
            force * ((2.0 - x).powi(2) / (E * inertia) + 1.0 / (5.0 / 6.0 * 0.5 * E * area)) * 2e-4
        })
        .sum();
    let off = |n: usize| {
        let plate = Plate { n, m: 1, size: [2.0, 0.5] };
        let folder = Folder::with(&[("c.inp", &plate.inp())]);
        let nodes = (0..=n).flat_map(|i| [0, 1].map(|j| (i, j)));
        let entries: Vec<String> =
            nodes.map(|(i, j)| format!("\"mesh.{}\" = {:?}", plate.node(i, j), h(2.0 * i as f64 / n as f64))).collect();
        let deck = meshed("static", "c.inp")
            .replace("end_time = 0.05\ntime_step = 0.005\n", "geometry = \"linear\"\n")
            .replace("poisson_ratio = 0.3", "poisson_ratio = 0.0")
            .replace("thickness = 0.02", &format!("thickness = 1.0\nnodal_thickness = {{ {} }}", entries.join(", ")))
            .replace(
                "force_per_length = [100.0, 0.0, 9000.0]",
                &format!("force_per_length = [0.0, 0.0, {:?}]", force / 0.5),
            )
            .replace("force = [0.0, 500.0, 0.0]", "force = [0.0, 0.0, 0.0]")
            .replace("pressure = 1000.0", "pressure = 0.0");
        let model = folder.model(&deck);
        let mass: f64 = (0..n).map(|e| model.parts[0].element_mass(e, &model.nodes, &[])).sum();
        assert!((mass / (7850.0 * 0.5 * 2.0 * 0.75 * thick) - 1.0).abs() < 1e-12, "{mass}");
        let found = displacements(&model);
        let tip = found.iter().find(|(label, _)| *label == format!("mesh.{}", plate.node(n, 0))).unwrap().1;
        tip[2] / exact - 1.0
    };
    let [coarse, fine] = [8, 16].map(off);
    assert!(fine.abs() < 2e-3 && (3.0..5.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}

/// Two members of two segments each in one group, every one between two clamps under a force at its middle.
fn members(lines: &str, release: &str) -> (Folder, String) {
    let count = lines.lines().count();
    let mesh = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"braces\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n\
         4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n$Elements\n{count}\n{lines}$EndElements\n"
    );
    let deck = format!(
        "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[sections.s]\nshape = \"general\"\naxial_stiffness = 1e7\n\
         bending_stiffness = [1000.0, 1000.0]\ntorsional_stiffness = 1000.0\nshear_stiffness = [1e7, 1e7]\n[mesh]\nfile = \"m.msh\"\n\
         [[beams]]\ngroup = \"braces\"\nshear = false\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nrelease = {release}\n\
         [[supports]]\nat = [\"mesh.1\", \"mesh.3\", \"mesh.4\", \"mesh.6\"]\nfix = \"all\"\n\
         [[loads]]\nat = [\"mesh.2\", \"mesh.5\"]\nforce = [0.0, 0.01, 0.01]\n"
    );
    (Folder::with(&[("m.msh", &mesh)]), deck)
}

/// Along y one end is a hinge, along z both: 7 F l³/(768 E I) and F l³/(48 E I). The stiffness in shear adds 1e-8.
#[test]
fn members_of_a_group_are_released_at_their_ends() {
    let lines = "1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n3 1 2 1 1 4 5\n4 1 2 1 1 5 6\n";
    let (folder, deck) = members(lines, "{ start = [\"ry\", \"rz\"], end = \"ry\" }");
    let moved = displacements(&folder.model(&deck));
    for name in ["mesh.2", "mesh.5"] {
        let (_, u) = moved.iter().find(|(label, _)| label == name).unwrap();
        let unit = 0.01 * 8.0 / 1000.0;
        assert!(
            (u[1] / (unit * 7.0 / 768.0) - 1.0).abs() < 1e-6 && (u[2] / (unit / 48.0) - 1.0).abs() < 1e-6,
            "{name}: {u:?}"
        );
    }
}

#[test]
fn groups_without_ends_are_not_released() {
    let said = |lines: &str, release: &str| {
        let (folder, deck) = members(lines, release);
        folder.read(&deck.replace("orientation = [0.0, 1.0, 0.0]", "orientation = [0.0, 0.0, 1.0]")).1
    };
    let branched = "1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n3 1 2 1 1 2 5\n";
    assert!(said(branched, "{ start = \"ry\" }").contains("branch or close a ring at `mesh.2`"));
    let ring = "1 1 2 1 1 1 2\n2 1 2 1 1 2 5\n3 1 2 1 1 5 1\n";
    assert!(said(ring, "{ start = \"ry\" }").contains("branch or close a ring"));
    let against = "1 1 2 1 1 2 1\n2 1 2 1 1 2 3\n3 1 2 1 1 4 5\n4 1 2 1 1 5 6\n";
    assert!(said(against, "{ start = \"ry\" }").contains("a line has no start"));
    assert_eq!(said(against, "{ start = \"ry\", end = \"ry\" }"), "");
}
