//! Lines of Abaqus and CalculiX input in every dress that the two programs read, and sections of Gmsh.

use super::{Folder, Plate};
use rdsolve::mesh::{self, CellShape, Mesh};

fn read(path: &str, text: &str) -> Mesh {
    mesh::read(path, text.as_bytes()).unwrap_or_else(|problems| panic!("{problems:?}\n{text}"))
}

fn ids(mesh: &Mesh, group: &str) -> Vec<u64> {
    mesh.group(group).unwrap_or_else(|| panic!("{group}")).nodes.iter().map(|&n| mesh.nodes[n as usize].id).collect()
}

const NODES: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n5, 2., 0., 0.\n6, 2., 1., 0.\n";
const PLAIN: &str = "*ELEMENT, TYPE=S4, ELSET=plate\n1, 1, 2, 3, 4\n2, 2, 5, 6, 3\n*NSET, NSET=root\n1, 4\n*NSET, NSET=tip\n5, 6\n\
                     *NSET, NSET=all\nroot, tip, 2, 3\n";

/// Nodes, elements and groups as text, names in small letters.
fn content(mesh: &Mesh) -> String {
    let elements: Vec<_> = mesh.elements.iter().map(|e| (e.id, e.kind, e.nodes().to_vec())).collect();
    let groups: Vec<_> = mesh.groups.iter().map(|g| (g.name.to_lowercase(), g.kind, &g.nodes, &g.elements)).collect();
    format!("{:?} {elements:?} {groups:?}", mesh.nodes)
}

/// One mesh in many dresses: the same nodes, elements and sets.
#[test]
fn every_dress_of_a_line() {
    let plain = format!("{NODES}{PLAIN}");
    let wanted = content(&read("a.inp", &plain));
    let dressed = |edits: &[(&str, &str)]| {
        edits.iter().fold(plain.clone(), |text, (old, new)| {
            assert!(text.contains(old), "{old}");
            text.replace(old, new)
        })
    };
    let dresses = [
        ("capitals", plain.to_uppercase()),
        ("small letters", plain.to_lowercase()),
        ("a byte order mark", format!("\u{feff}{plain}")),
        ("ends of lines with CR", plain.replace('\n', "\r\n")),
        ("blanks before", plain.replace('\n', "\n   ")),
        ("tabs", plain.replace(", ", ",\t").replace("\n*", "\n\t*")),
        (
            "blanks in names",
            dressed(&[("NSET=root", "NSET = ro ot"), ("*NODE", "* NODE"), ("ELSET=plate", " ELSET= plate ")]),
        ),
        ("quotes", dressed(&[("NSET=tip", "NSET=\"tip\""), ("root, tip", "\"root\", \"TIP\"")])),
        ("comments", plain.replace('\n', "\n  ** a comment, with a comma,\n")),
        ("blank lines", plain.replace('\n', "\n\n")),
        ("an asterisk alone", plain.replace("*NSET, NSET=root", "*\n*NSET, NSET=root")),
        ("a keyword over two lines", dressed(&[("TYPE=S4, ELSET=plate", "TYPE=S4,\nELSET=plate")])),
        (
            "a comma that ends keywords",
            dressed(&[("ELSET=plate", "ELSET=plate,"), ("=root", "=root,"), ("NSET=all", "NSET=all,")]),
        ),
        ("a comma that ends data", dressed(&[("1, 4\n", "1, 4,\n"), ("1, 2, 3, 4\n", "1, 2, 3, 4,\n")])),
        ("elements over two lines", dressed(&[("1, 1, 2, 3, 4", "1, 1, 2\n3, 4"), ("5, 6, 3", "5,\n6, 3")])),
        ("exponents", dressed(&[("5, 2., 0., 0.", "5, 0.2D1, 0d0, 0."), ("6, 2., 1.", "6, 20.0-1, 1.+0")])),
        (
            "missing coordinates",
            dressed(&[("1, 0., 0., 0.", "1"), ("2, 1., 0., 0.", "2, 1."), ("4, 0., 1., 0.", "4, , 1.")]),
        ),
        (
            "given again",
            plain.replace(
                "*NSET, NSET=root",
                "*NODE\n2, 1., 0., 0.\n*ELEMENT, TYPE=S4\n2, 2, 5, 6, 3\n*NSET, NSET=root",
            ),
        ),
        (
            "generated",
            dressed(&[("NSET=root\n1, 4", "NSET=root, GENERATE\n1, 4, 3"), ("NSET=tip\n5, 6", "NSET=tip, GEN\n5, 99")]),
        ),
        ("generated on a line of its own", dressed(&[("NSET=root\n1, 4", "NSET=root,\nGENERATE\n1, 4, 3")])),
        ("abbreviated", dressed(&[("TYPE=S4, ELSET=plate", "ELS=plate, TYP=S4")])),
        ("what means nothing", dressed(&[("*NODE", "*NODE, SYSTEM=R"), ("TYPE=S4,", "TYPE=S4, OFFSET=0,")])),
        ("split blocks", plain.replace("2, 2, 5, 6, 3", "*ELEMENT, ELSET=PLATE, TYPE=S4R\n2, 2, 5, 6, 3")),
        (
            "an instance that stays",
            format!(
                "*PART, NAME=P\n{plain}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n0., 0., 0.\n*END INSTANCE\n*END ASSEMBLY\n"
            ),
        ),
    ];
    for (what, text) in dresses {
        assert_eq!(content(&read("a.inp", &text)), wanted, "{what}:\n{text}");
    }
}

/// A keyword line that ends with a comma: CalculiX goes on with data, Abaqus with parameters. CalculiX 2.20 holds nodes 1 and 4
/// after `*NSET, NSET=HELD,`.
#[test]
fn a_comma_at_the_end_of_a_keyword() {
    let mesh = |more: &str| read("a.inp", &format!("{NODES}{PLAIN}{more}"));
    assert_eq!(ids(&mesh("*NSET, NSET=held,\n1, 4\n2, 3\n"), "held"), [1, 4, 2, 3]);
    assert_eq!(ids(&mesh("*NSET, NSET=held,\nroot,\ntip\n"), "held").len(), 4);
    assert_eq!(ids(&mesh("*NSET,\nNSET=held,\nGENERATE,\n1, 5, 2\n"), "held"), [1, 3, 5]);
    assert_eq!(ids(&mesh("*NSET,\n** a comment\nNSET=held, \n4\n"), "held"), [4]);
    assert_eq!(ids(&mesh("*NODE, NSET=more,\n7, 3., 0.\n"), "more"), [7]);
    // Nothing follows.
    assert!(ids(&mesh("*NSET, NSET=held,"), "held").is_empty());
}

/// Names of Abaqus and CalculiX for the shapes that are read, and the number of lines that others take.
#[test]
fn types_by_their_shape() {
    let shapes = [
        (CellShape::Segment, "1, 2", "B31 B31R B31H B33 B21 PIPE31 T3D2 T2D2 U1"),
        (CellShape::CurvedSegment, "1, 7, 2", "B32 B32R B32H B22 PIPE32 T3D3"),
        (CellShape::Triangle, "1, 2, 3", "S3 S3R STRI3 US3 CPS3 CPE3 M3D3 R3D3"),
        (CellShape::Quadrilateral, "1, 2, 3, 4", "S4 S4R S4R5 S4RS CPS4 CPS4R CPE4 M3D4 R3D4 CAX4P"),
        (CellShape::CurvedTriangle, "1, 2, 3, 7, 8, 9", "S6 STRI65 CPS6 CPE6 M3D6"),
        (CellShape::Serendipity, "1, 2, 3, 4, 7, 8, 10, 11", "S8 S8R S8R5 CPS8 CPE8R M3D8"),
        (CellShape::CurvedQuadrilateral, "1, 2, 3, 4, 7, 8, 10, 11, 12", "S9R5 M3D9"),
    ];
    let middles = "7, 0.5, 0.\n8, 1., 0.5\n9, 0.5, 0.5\n10, 0.5, 1.\n11, 0., 0.5\n12, 0.5, 0.5\n";
    for (shape, nodes, types) in shapes {
        for name in types.split(' ') {
            let mesh = read(
                "a.inp",
                &format!("{NODES}{middles}*ELEMENT, TYPE={}, ELSET=e\n1, {nodes}\n", name.to_lowercase()),
            );
            assert_eq!((mesh.elements.len(), mesh.elements[0].kind), (1, shape), "{name}");
            assert!(mesh.skipped.is_empty(), "{name}");
        }
    }
    // The node between comes last here.
    let line = read("a.inp", &format!("{NODES}{middles}*ELEMENT, TYPE=T3D3\n1, 1, 7, 2\n"));
    assert_eq!(line.elements[0].nodes(), [0, 1, 6]);
    // A quadrilateral with a corner twice is a triangle, wherever it is.
    for nodes in ["1, 2, 3, 3", "1, 1, 2, 3", "1, 2, 3, 1", "1, 2, 2, 3"] {
        let mesh = read("a.inp", &format!("{NODES}*ELEMENT, TYPE=S4R\n1, {nodes}\n"));
        assert_eq!((mesh.elements[0].kind, mesh.elements[0].nodes()), (CellShape::Triangle, &[0, 1, 2][..]), "{nodes}");
    }
    // Elements of types that are not read, over lines with and without commas at their ends.
    let others = "*ELEMENT, TYPE=C3D8, ELSET=solid\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n2, 1, 2, 3, 4\n5, 6, 7, 8\n\
                  *ELEMENT, TYPE=SPRINGA, ELSET=springs\n3, 1, 2,\n4, 2, 3,\n*ELEMENT, TYPE=XYZ, ELSET=strange\n5, 1, 2,\n6, 2, 3,\n\
                  *ELSET, ELSET=some\n2, 4, 6\n";
    let mesh = read("a.inp", &format!("{NODES}{others}"));
    let skipped = |name: &str| mesh.group(name).unwrap().skipped;
    assert_eq!(["solid", "springs", "strange", "some"].map(skipped), [2, 2, 2, 3]);
}

/// A third node of a B31 gives the direction of its first axis, which is the second here: from the first node to that one.
#[test]
fn direction_nodes() {
    let mesh = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 2., 0., 0.\n99, 0., 1., 0.\n*ELEMENT, TYPE=B31, ELSET=rod\n\
                1, 1, 2, 99\n2, 2, 3\n*NSET, NSET=root\n1\n*NSET, NSET=tip\n3\n";
    let deck = |y: &str| {
        format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[mesh]\nfile = \"rod.inp\"\n[materials.m]\n\
             model = \"elastic\"\nyoungs_modulus = 1e9\npoisson_ratio = 0.3\n[sections.s]\nshape = \"rectangle\"\nwidth = 0.05\n\
             height = 0.1\n[[beams]]\ngroup = \"rod\"\nmaterial = \"m\"\nsection = \"s\"\norder = 1\norientation = {y}\n\
             [[supports]]\nat = \"root\"\nfix = \"all\"\n[[loads]]\nat = \"tip\"\nforce = [0.0, 0.0, 1.0]\n"
        )
    };
    let folder = Folder::with(&[("rod.inp", mesh)]);
    assert_eq!(read("rod.inp", mesh).elements[0].toward, Some(3));
    // What lies along the beam does not count.
    assert_eq!(folder.read(&deck("[0.3, 2.0, 0.0]")).1, "");
    insta::assert_snapshot!("directions_that_differ", folder.read(&deck("[0.0, 0.0, 1.0]")).1);
    let three = mesh.replace("2, 2, 3\n", "2, 2, 3, 99, 1\n");
    assert!(mesh::read("rod.inp", three.as_bytes()).unwrap_err()[0].message.contains("has 4 nodes; B31 has 2"));
    let lost = mesh.replace("1, 1, 2, 99", "1, 1, 2, 98");
    assert!(mesh::read("rod.inp", lost.as_bytes()).unwrap_err()[0].message.contains("direction node 98"));
}

/// Sections of Gmsh in a dress of their own: parametric nodes, a comment before everything, a byte order mark, blanks.
#[test]
fn sections_of_gmsh() {
    let plate = Plate { n: 2, m: 2, size: [2.0, 1.0] };
    let [two, four] = [plate.msh2(), plate.msh4()];
    let parametric = |text: &str| {
        let (head, rest) = text.split_once("$Nodes\n").unwrap();
        let (nodes, tail) = rest.split_once("$EndNodes").unwrap();
        // A point, two nodes on curves, and the others on a surface, as Gmsh writes with Mesh.SaveParametric = 1.
        let kinds = ["", " 0 1", " 1 2 0.5", " 1 3 0.25"];
        let lines = nodes.lines().enumerate();
        let lines = lines.map(|(at, line)| format!("{line}{}\n", kinds.get(at).unwrap_or(&" 2 1 0.5 0.5")));
        format!("{head}$ParametricNodes\n{}$EndParametricNodes{tail}", lines.collect::<String>())
    };
    for (text, dresses) in [
        (&two, vec![parametric(&two)]),
        (&four, vec![four.replace("2 1 0 9\n", "2 1 1 9\n").replace(" 0\n1 ", " 0 0.5 0.5\n1 ")]),
    ] {
        let wanted = content(&read("a.msh", text));
        let all = [
            format!("\u{feff}{text}"),
            format!("$Comments\nby hand\n$EndComments\n{text}"),
            text.replace('$', "  $"),
            text.replace('\n', "\r\n"),
        ];
        for dress in all.into_iter().chain(dresses) {
            assert_eq!(content(&read("a.msh", &dress)), wanted, "{dress}");
        }
    }
    let short = parametric(&two).replace(" 1 3 0.25\n", " 1 3\n");
    assert!(mesh::read("a.msh", short.as_bytes()).unwrap_err()[0].message.contains("lacks a parameter"));
}

/// Files within files: the same mesh as in one, places of messages in the file where the line stands, and an end to files that
/// include each other.
#[test]
fn included_files() {
    let deck = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 1.0\n[mesh]\nfile = \"a.inp\"\n[materials.m]\n\
                model = \"elastic\"\nyoungs_modulus = 1e9\npoisson_ratio = 0.3\n[[shells]]\ngroup = \"plate\"\nthickness = 0.01\n\
                material = \"m\"\n[[supports]]\nat = \"root\"\nfix = \"all\"\n";
    let places = |folder: &Folder| {
        let model = folder.model(deck);
        model.nodes.iter().map(|node| (node.label.clone(), node.x)).collect::<Vec<_>>()
    };
    let nodes = NODES.replace("*NODE\n", "");
    let main = format!("** a main file\n*Include, input=sub/mesh.inp\n{PLAIN}");
    let files = [("a.inp", main.as_str()), ("mesh.inp", "*NODE, INPUT=nodes.txt\n"), ("nodes.txt", nodes.as_str())];
    let folder = Folder::with(&files);
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    std::fs::rename(folder.path().join("mesh.inp"), folder.path().join("sub/mesh.inp")).unwrap();
    assert_eq!(places(&folder), places(&Folder::with(&[("a.inp", &format!("{NODES}{PLAIN}"))])));
    std::fs::write(folder.path().join("nodes.txt"), nodes.replace("3, 1., 1.", "3, 1., one")).unwrap();
    insta::assert_snapshot!("in_an_included_file", folder.read(deck).1);
    std::fs::write(folder.path().join("sub/mesh.inp"), "*INCLUDE, INPUT=a.inp\n").unwrap();
    assert!(folder.read(deck).1.contains("files include each other more than 9 deep"), "{}", folder.read(deck).1);
    std::fs::remove_file(folder.path().join("sub/mesh.inp")).unwrap();
    let said = folder.read(deck).1;
    assert!(said.starts_with("error: cannot read `sub/mesh.inp`: ") && said.contains("a.inp:2"), "{said}");
}
