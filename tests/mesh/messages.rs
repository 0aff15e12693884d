//! What is said about wrong meshes and what is made of them, compared as text with `tests/mesh/snapshots`.

use super::{Folder, Plate};
use insta::assert_snapshot;

const DECK: &str = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.5
[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
[sections.strip]
shape = "rectangle"
width = 0.03
height = 0.005
[mesh]
file = "plate.msh"
[[shells]]
group = "plate"
thickness = 0.02
material = "steel"
[[supports]]
at = "root"
fix = "all"
[[loads]]
at = "tip"
force_per_length = [0.0, 0.0, 10.0]
[[beams]]
name = "rib"
path = ["p", "q"]
elements = 2
material = "steel"
section = "strip"
orientation = [0.0, 1.0, 0.0]
order = 1
[points]
p = [0.0, 0.5, -0.1]
q = [2.0, 0.5, -0.1]
[[supports]]
at = "p"
fix = "all"
"#;

fn plate() -> String {
    Plate { n: 2, m: 2, size: [2.0, 1.0] }.msh4()
}

/// The deck and the mesh with parts replaced.
fn said(deck: &[(&str, &str)], mesh: &[(&str, &str)]) -> String {
    let edited = |text: &str, edits: &[(&str, &str)]| {
        edits.iter().fold(text.to_owned(), |text, (old, new)| {
            assert_eq!(text.matches(old).count(), 1, "`{old}` must stand once");
            text.replace(old, new)
        })
    };
    Folder::with(&[("plate.msh", &edited(&plate(), mesh))]).read(&edited(DECK, deck)).1
}

fn and(more: &str) -> String {
    Folder::with(&[("plate.msh", &plate())]).read(&format!("{DECK}{more}")).1
}

fn inp(text: &str) -> String {
    let deck = DECK.replace("plate.msh", "plate.inp").replace("force_per_length", "force");
    Folder::with(&[("plate.inp", text)]).read(&deck).1
}

#[test]
fn a_sound_mesh_is_silent() {
    assert_eq!(said(&[], &[]), "");
}

#[test]
fn files() {
    assert_snapshot!("missing", said(&[("plate.msh", "other.msh")], &[]));
    assert_snapshot!("no_mesh_by_its_name", Folder::with(&[("a.vtu", "")]).read(&DECK.replace("plate.msh", "a.vtu")).1);
    assert_snapshot!("binary", said(&[], &[("4.1 0 8", "4.1 1 8")]));
    assert_snapshot!("version", said(&[], &[("4.1 0 8", "4.0 0 8")]));
    assert_snapshot!("no_file", said(&[("file = \"plate.msh\"", "scale = 1.0")], &[]));
}

#[test]
fn gmsh() {
    assert_snapshot!("truncated", said(&[], &[("$EndElements\n", "")]));
    assert_snapshot!("unknown_node", said(&[], &[("9 5 6 9 8 ", "9 5 6 77 8 ")]));
    assert_snapshot!("repeated_node", said(&[], &[("9 5 6 9 8 ", "9 5 6 9 5 ")]));
    assert_snapshot!("crossed", said(&[], &[("9 5 6 9 8 ", "9 5 9 6 8 ")]));
    assert_snapshot!("twice", said(&[], &[("9 5 6 9 8 ", "8 5 6 9 8 ")]));
    assert_snapshot!("not_finite", said(&[], &[("1 0.5 0\n", "1 nan 0\n")]));
    assert_snapshot!("same_place", said(&[], &[("\n0 0 0\n", "\n0 0.5 0\n")]));
    assert_snapshot!("a_word", said(&[], &[("9 5 6 9 8 ", "9 5 six 9 8 ")]));
}

#[test]
fn abaqus() {
    let text = Plate { n: 2, m: 2, size: [2.0, 1.0] }.inp();
    assert_snapshot!("inp_nodes_of_an_element", inp(&text.replace("TYPE=S4R", "TYPE=S3")));
    assert_snapshot!("inp_no_type", inp(&text.replace("TYPE=S4R, ", "")));
    assert_snapshot!("inp_unknown_node", inp(&text.replace("*NSET, NSET=tip\n3,", "*NSET, NSET=tip\n333,")));
    assert_snapshot!("inp_unknown_set", inp(&format!("{text}*ELSET, ELSET=all_of_it\nplate, roof\n")));
    let keywords = "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*ELEMENT, TYPE=C3D8, ELSET=more\n90, 1, 2, 3, 4, 5, 6, 7, 8\n*STEP\n*STEP\n";
    assert_snapshot!("inp_skipped", inp(&format!("{text}{keywords}")));
    assert_snapshot!("inp_instance", inp(&format!("{text}*INSTANCE, NAME=one, PART=plate\n1., 0., 0.\n")));
    assert_snapshot!("inp_set_of_the_other_kind", inp(&format!("{text}*ELSET, ELSET=more\nroot\n")));
}

#[test]
fn parts() {
    assert_snapshot!("unknown_group", said(&[("group = \"plate\"", "group = \"plat\"")], &[]));
    assert_snapshot!("group_without_faces", said(&[("group = \"plate\"", "group = \"tip\"")], &[]));
    assert_snapshot!(
        "group_twice",
        and("[[shells]]\nname = \"more\"\ngroup = \"plate\"\nthickness = 0.01\nmaterial = \"steel\"\n")
    );
    assert_snapshot!(
        "stray_keys",
        said(&[("group = \"plate\"", "group = \"plate\"\nelements = 3\nkind = \"triangle\"")], &[])
    );
    assert_snapshot!("no_mesh", said(&[("[mesh]\nfile = \"plate.msh\"\n", "")], &[]));
    assert_snapshot!(
        "name_of_a_group",
        said(&[("p = [0.0", "tip = [0.0"), ("path = [\"p\"", "path = [\"tip\""), ("at = \"p\"", "at = \"tip\"")], &[])
    );
    let body = "[[bodies]]\nname = \"plate\"\ncenter = [0.0, 0.0, 9.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n";
    let sheet = format!("{body}\n[[shells]]\nname = \"sheet\"\ngroup = \"plate\"");
    assert_snapshot!("name_of_a_group_of_another_part", said(&[("[[shells]]\ngroup = \"plate\"", &sheet)], &[]));
    assert_snapshot!("turned_round", said(&[], &[("9 5 6 9 8 ", "9 8 9 6 5 ")]));
    assert_snapshot!(
        "left_out",
        said(
            &[("group = \"plate\"", "corners = [\"p\", \"q\", \"corner\", \"mesh.7\"]\nelements = 1\nname = \"x\"")],
            &[]
        )
    );
    assert_snapshot!(
        "link_to_a_group",
        and("[[links]]\nname = \"l\"\nfrom = { node = \"tip\" }\nto = { ground = [9.0, 0.0, 0.0] }\nstiffness = 1.0\n")
    );
    assert_snapshot!(
        "value_at_a_group",
        and("[[expect]]\nat = \"tip\"\nquantity = \"z\"\ntime = 1.0\nvalue = 1.0\ntolerance = 1.0\n")
    );
    assert_snapshot!("load_inside", said(&[("at = \"tip\"", "at = \"plate\"")], &[]));
}

#[test]
fn rigid() {
    let plate = ("group = \"plate\"", "group = \"plate\"\nrigid = true");
    assert_snapshot!("supported", said(&[plate], &[]));
    let body = |more: &str| and(&format!("[[bodies]]\nname = \"block\"\n{more}\n"));
    assert_snapshot!("mass_and_parts", body("parts = [\"rib\"]\nmass = 3.0"));
    assert_snapshot!("unknown_part", body("parts = [\"ribs\"]"));
    assert_snapshot!("part_twice", body("parts = [\"rib\", \"rib\"]"));
    let weightless =
        DECK.replace("static", "dynamic").replace("poisson_ratio = 0.3", "poisson_ratio = 0.3\ndensity = 1.0");
    let weightless = weightless
        .replace("elements = 2", "elements = 2\nmass = \"none\"\nrigid = true")
        .replace("[[supports]]\nat = \"p\"\nfix = \"all\"\n", "");
    assert_snapshot!("weightless", Folder::with(&[("plate.msh", &super::messages::plate())]).read(&weightless).1);
}

#[test]
fn ties() {
    let tie = |nodes: &str| and(&format!("[[attachments]]\nbeam = \"rib\"\nnodes = {nodes}\n"));
    assert_eq!(tie("[\"mesh.5\", \"q\"]"), "");
    assert_snapshot!("not_a_beam", and("[[attachments]]\nbeam = \"plate\"\nnodes = \"q\"\n"));
    let moved = DECK.replace("q = [2.0", "q = [1.0").replace("elements = 2", "elements = 1");
    let folder = Folder::with(&[("plate.msh", &plate())]);
    let tie = "[[attachments]]\nbeam = \"rib\"\nnodes = \"mesh.6\"\n";
    assert_snapshot!("beyond_the_end", folder.read(&format!("{moved}{tie}")).1);
    assert_snapshot!(
        "between_two",
        folder.read(&format!("{}{}", DECK.replace("elements = 2", "elements = 1"), tie.replace("mesh.6", "mesh.5"))).1
    );
}

/// Names that would hold, load or move nothing.
#[test]
fn names_of_nothing() {
    let rigid = "[[bodies]]\nname = \"block\"\nparts = [\"plate\"]\n";
    assert_snapshot!("edge_of_a_group", and("[[supports]]\nat = \"plate.edge1\"\nfix = \"all\"\n"));
    assert_snapshot!(
        "velocity_of_a_rigid_part",
        and(&format!("{rigid}[[initial]]\nat = \"plate\"\nvelocity = [1.0, 0.0, 0.0]\n"))
    );
    assert_snapshot!(
        "value_of_a_rigid_part",
        and(&format!(
            "{rigid}[[expect]]\nat = \"plate\"\nquantity = \"von_mises\"\npeak = \"max\"\nvalue = 1.0\ntolerance = 0.1\n"
        ))
    );
    let mesh = Plate { n: 2, m: 2, size: [2.0, 1.0] }.inp().replace(
        "*nset, nset=root",
        "*NODE\n101, 9., 9., 0.\n102, 9., 8., 0.\n*ELEMENT, TYPE=B31, ELSET=elsewhere\n101, 101, 102\n\
         *nset, nset=void\n*nset, nset=root",
    );
    let folder = Folder::with(&[("plate.inp", &mesh)]);
    let deck = DECK.replace("plate.msh", "plate.inp");
    let held = "[[supports]]\nat = \"void\"\nfix = \"all\"\n";
    let load = "[[loads]]\nat = \"elsewhere\"\nforce_per_length = [0.0, 0.0, 1.0]\n";
    assert_snapshot!("group_of_nothing", folder.read(&format!("{deck}{held}")).1);
    assert_snapshot!("load_on_nothing", folder.read(&format!("{deck}{load}")).1);
}

/// What makes nodes, elements or sets in a way that is not read would leave them out.
#[test]
fn abaqus_that_changes_the_mesh() {
    let text = Plate { n: 2, m: 2, size: [2.0, 1.0] }.inp();
    let refused = |line: &str| {
        let said = inp(&format!("{text}{line}\n"));
        let word = line.split([',', '\n']).next().unwrap();
        assert!(said.starts_with("error: ") && said.contains("is not read") && said.contains(word), "{line}: {said}");
    };
    assert_snapshot!("inp_include", inp(&format!("{text}*INCLUDE, INPUT=more.inp\n")));
    assert!(inp(&format!("{text}*INCLUDE\n")).starts_with("error: *INCLUDE needs INPUT="));
    for line in [
        "*NGEN, NSET=more\n1, 3, 1",
        "*NFILL, NSET=more\nroot, tip, 4",
        "*NCOPY, CHANGE NUMBER=100, OLD SET=tip, SHIFT",
        "*ELGEN, ELSET=more\n1, 4",
        "*ELCOPY, ELEMENT SHIFT=10, OLD SET=plate, SHIFT NODES=10",
        "*SYSTEM\n1., 0., 0.",
        "*NMAP, NSET=tip, TYPE=RECTANGULAR",
        "*PARAMETER\nx = 1",
    ] {
        refused(line);
    }
    assert_snapshot!("inp_cylindrical", inp(&text.replace("*Node", "*Node, system=C")));
    let of_file = format!("{text}*ELEMENT, TYPE=S4, INPUT=more.inp\n");
    assert!(inp(&of_file).starts_with("error: cannot read `more.inp`"), "{}", inp(&of_file));
    // Two instances: numbers of the second are others, and a name alone means a set of each.
    let (head, rest) = text.split_once("*Node").unwrap();
    let framed = |more: &str| {
        let assembly = format!(
            "*END PART\n*ASSEMBLY, NAME=all\n*INSTANCE, NAME=one, PART=a\n*END INSTANCE\n{more}*END ASSEMBLY\n"
        );
        inp(&format!("{head}*PART, NAME=a\n*Node{rest}{assembly}"))
    };
    assert_eq!(framed(""), "");
    assert_snapshot!("inp_second_instance", framed("*INSTANCE, NAME=two, PART=a\n*END INSTANCE\n"));
    assert_eq!(inp(&format!("*PART, NAME=b\n*END PART\n*PART, NAME=a\n{text}")), "");
}

/// Lists of which many nodes are wrong in the same way: one message with the first of them and the count.
#[test]
fn many_nodes_with_one_mistake() {
    let plate = Plate { n: 40, m: 50, size: [2.0, 1.0] };
    let folder = Folder::with(&[("plate.inp", &plate.inp())]);
    let deck = DECK.replace("plate.msh", "plate.inp").replace("force_per_length", "force");
    let hub = "[[bodies]]\nname = \"HUB\"\ncenter = [9.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n\
               [[attachments]]\nbody = \"HUB\"\nnodes = \"tip\"\n";
    let said = |more: &str| folder.read(&format!("{deck}{more}")).1;
    assert_snapshot!("many_attached_twice", said(&format!("{hub}{hub}").replacen("HUB", "hub", 2)));
    assert_snapshot!("many_supported", said(&format!("{hub}[[supports]]\nat = \"tip\"\nfix = \"all\"\n")));
    let moved = "[[supports]]\nat = \"root\"\nmotion = { ux = { amplitude = \"a\" } }\n\
                 [amplitudes.a]\nkind = \"ramp\"\nend = 1.0\n";
    assert_snapshot!("many_held_twice", said(moved));
    // Nothing is connected to a set of nodes without elements.
    let loose: String = (0..3000).map(|k| format!("{}, 9., {k}.\n", 5000 + k)).collect();
    let mesh = plate.inp().replace("*nset, nset=root", &format!("*NODE, NSET=loose\n{loose}*nset, nset=root"));
    let folder = Folder::with(&[("plate.inp", &mesh)]);
    let load = "[[loads]]\nat = \"loose\"\nforce = [1.0, 0.0, 0.0]\n";
    assert_snapshot!("many_loose", folder.read(&format!("{deck}{load}")).1);
}

/// Elements of second order: what a mesh of them may not be.
#[test]
fn second_order() {
    let nodes = "*NODE\n1, 0., 0.\n2, 2., 0.\n3, 2., 1.\n4, 0., 1.\n5, 1., 0.\n6, 2., 0.5\n7, 1., 1.\n8, 0., 0.5\n9, 1., 0.1\n\
                 *NSET, NSET=root\n1, 4, 8\n*NSET, NSET=tip\n2, 3, 6\n";
    let faces = "*ELEMENT, TYPE=S8R, ELSET=plate\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";
    let inp = |text: &str, more: &str| {
        let deck = DECK.replace("plate.msh", "plate.inp");
        Folder::with(&[("plate.inp", text)]).read(&format!("{deck}{more}")).1
    };
    assert_eq!(inp(&format!("{nodes}{faces}"), ""), "");
    let line = |order: &str| {
        format!(
            "[[beams]]\ngroup = \"edge\"\nmaterial = \"steel\"\nsection = \"strip\"\norientation = [0.0, 1.0, 0.0]\n{order}"
        )
    };
    let straight = format!("{nodes}{faces}*ELEMENT, TYPE=B32, ELSET=edge\n2, 1, 5, 2\n");
    assert_eq!(inp(&straight, &line("order = 2\n")), "");
    assert_snapshot!("order_of_a_line", inp(&straight, &line("")));
    let curved = format!("{nodes}{faces}*ELEMENT, TYPE=B32, ELSET=edge\n2, 1, 9, 2\n");
    assert_snapshot!("curved_line", inp(&curved, &line("order = 2\n")));
    let beside = "*NODE\n10, 3., 0.\n11, 3., 1.\n*ELEMENT, TYPE=S4, ELSET=plate\n3, 2, 10, 11, 3\n";
    assert_snapshot!("two_orders", inp(&format!("{nodes}{faces}{beside}"), ""));
    let folded = faces.replace("5, 6, 7, 8", "7, 6, 5, 8");
    assert_snapshot!("folded_sides", inp(&format!("{nodes}{folded}"), ""));
}
