//! The readers by themselves.

use super::Plate;
use rdsolve::elements::pressure::Face;
use rdsolve::math::curved_faces::middle_of_eight;
use rdsolve::mesh::{self, CellShape, Mesh};

fn read(path: &str, text: &str) -> Mesh {
    mesh::read(path, text.as_bytes()).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn ids(mesh: &Mesh, group: &str) -> Vec<u64> {
    mesh.group(group).unwrap().nodes.iter().map(|&node| mesh.nodes[node as usize].id).collect()
}

#[test]
fn three_formats_say_the_same() {
    let plate = Plate { n: 3, m: 2, size: [3.0, 1.0] };
    let files = [("a.msh", plate.msh4()), ("b.msh", plate.msh2()), ("c.inp", plate.inp())];
    for (path, text) in &files {
        let mesh = read(path, text);
        assert_eq!(mesh.nodes.len(), 12);
        assert_eq!((mesh.nodes[5].id, mesh.nodes[5].x.as_slice()), (6, &[1.0, 0.5, 0.0][..]));
        let quads: Vec<_> = mesh.elements.iter().filter(|e| e.kind == CellShape::Quadrilateral).collect();
        assert_eq!((quads.len(), quads[0].nodes()), (6, &[0, 1, 5, 4][..]));
        assert_eq!(mesh.group("plate").unwrap().elements.len(), 6);
        assert_eq!(ids(&mesh, "root"), [1, 5, 9]);
        assert_eq!(ids(&mesh, "tip"), [4, 8, 12]);
        assert_eq!(ids(&mesh, if *path == "c.inp" { "Corner" } else { "corner" }), [12]);
        assert!(mesh.skipped.is_empty(), "{:?}", mesh.skipped);
        let segments = mesh.group("tip").unwrap().elements.len();
        assert_eq!(segments, if *path == "c.inp" { 0 } else { 2 });
    }
}

#[test]
fn groups_without_names_go_by_their_tag() {
    let text = Plate { n: 1, m: 1, size: [1.0, 1.0] }.msh4();
    let (head, rest) = text.split_once("$PhysicalNames").unwrap();
    let (_, tail) = rest.split_once("$EndPhysicalNames\n").unwrap();
    let mesh = read("a.msh", &format!("{head}{tail}"));
    let names: Vec<&str> = mesh.groups.iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["physical_1", "physical_2", "physical_3", "physical_4"]);
    // One tag in two dimensions.
    let same = format!("{head}{tail}").replace("0 1 4 2 1 2 \n", "0 1 2 2 1 2 \n");
    let mesh = read("a.msh", &same);
    let names: Vec<&str> = mesh.groups.iter().map(|group| group.name.as_str()).collect();
    assert_eq!(names, ["physical_1", "physical_2_lines", "physical_3", "physical_2_faces"]);
}

/// What Gmsh 4.15 writes of a square with a circle in it: two versions, an element in two groups, six-node triangles.
#[test]
fn files_of_gmsh_itself() {
    let (four, two) = (include_str!("square.msh"), include_str!("square_22.msh"));
    let [four, two] = [("a.msh", four), ("b.msh", two)].map(|(path, text)| read(path, text));
    for mesh in [&four, &two] {
        let all = mesh.group("everything").unwrap();
        let [inner, outer] = ["inner", "outer"].map(|name| mesh.group(name).unwrap().elements.len());
        assert_eq!(all.elements.len(), inner + outer);
        assert_eq!(mesh.group("rim").unwrap().elements.len(), mesh.group("rim").unwrap().nodes.len());
        assert_eq!(mesh.group("center").unwrap().nodes.len(), 1);
        assert_eq!(mesh.elements.iter().filter(|e| e.kind != CellShape::Segment).count(), inner + outer);
        let area = |e: &mesh::MeshElement| {
            let x = |k: usize| mesh.nodes[e.nodes()[k] as usize].x;
            let half = |a: usize, b: usize| 0.5 * (x(a) - x(0)).cross(&(x(b) - x(0))).z;
            half(1, 2) + if e.nodes().len() == 4 { half(2, 3) } else { 0.0 }
        };
        let sum: f64 = all.elements.iter().map(|&e| area(&mesh.elements[e as usize])).sum();
        // A square with sides of 2; sixteen digits in the file.
        assert!((sum - 4.0).abs() < 1e-13, "{sum}");
    }
    assert_eq!(four.nodes, two.nodes);
    let second = read("c.msh", include_str!("square_second.msh"));
    let all = second.group("everything").unwrap();
    assert_eq!((all.elements.len(), all.skipped, second.skipped.len()), (40, 0, 0));
    // Curved faces cover the square without gaps where their nodes come in the right order.
    let faces = all.elements.iter().map(|&e| &second.elements[e as usize]);
    let area = |e: &mesh::MeshElement| {
        let x: Vec<_> = e.nodes().iter().map(|&node| second.nodes[node as usize].x).collect();
        let mut x = x.to_vec();
        if x.len() == 8 {
            x.push(middle_of_eight(|a| x[a]));
        }
        Face::of(&(0..x.len()).collect::<Vec<_>>()).unwrap().areas(|a| x[a]).iter().map(|area| area.z).sum::<f64>()
    };
    assert!(faces.clone().all(|face| face.kind.order() == 2 && area(face) > 0.0));
    let sum: f64 = faces.map(area).sum();
    assert!((sum - 4.0).abs() < 1e-13, "{sum}");
}

/// A negative tag turns the elements of a group round, as Gmsh itself does when it writes version 2.2.
#[test]
fn a_negative_group_is_turned_round() {
    let text = Plate { n: 2, m: 1, size: [2.0, 1.0] }.msh4();
    let turned = read("a.msh", &text.replace("0 1 4 2 1 2 \n", "0 1 -4 2 1 2 \n"));
    let (straight, group) = (read("a.msh", &text), turned.group("plate").unwrap());
    assert_eq!(group.elements.len(), 2);
    for &e in &group.elements {
        let (one, two) = (straight.elements[e as usize].nodes(), turned.elements[e as usize].nodes());
        assert!(one.iter().eq(two.iter().rev()), "{one:?} {two:?}");
    }
}

#[test]
fn sets_of_sets_and_other_keywords() {
    let text = "\
*NODE, NSET=nall
1, 0., 0., 0.
2, 1., 0.
 3, 1.D0, 1.0d0
4, 0., 1., 0.
5, 2., 0., 0.
*MATERIAL, NAME=steel
*ELASTIC
210000., 0.3
*Element, type=S4, Elset=left
10, 1, 2, 3, 4
*ELEMENT, TYPE=S3,
 ELSET=right
11, 2, 5, 3
*ELEMENT, TYPE=B31, ELSET=strut
12, 1, 5
*ELEMENT, TYPE=C3D8, ELSET=solid
13, 1, 2, 3, 4,
 5, 6, 7, 8
14, 1, 2, 3, 4, 5, 6, 7, 8
*ELSET, ELSET=BOTH
LEFT, right
*ELSET, ELSET=some
10, 13
*NSET, NSET=ends
1, 5
*NSET, NSET=EndsAndMore
ends, 3
*STEP
*STATIC
1., 1.
*NODE FILE
U
*END STEP
*STEP
";
    let mesh = read("a.inp", text);
    let group = |name: &str| mesh.group(name).unwrap();
    assert_eq!((group("BOTH").elements.as_slice(), group("some").elements.as_slice()), (&[0, 1][..], &[0][..]));
    assert_eq!((group("some").skipped, group("solid").skipped, group("nall").nodes.len()), (1, 2, 5));
    assert_eq!(group("strut").elements, [2]);
    assert_eq!(ids(&mesh, "EndsAndMore"), [3, 1, 5]);
    assert_eq!(mesh.nodes[2].x.as_slice(), [1.0, 1.0, 0.0]);
    let skipped: Vec<(&str, usize, usize)> = mesh.skipped.iter().map(|s| (s.what.as_str(), s.count, s.line)).collect();
    let wanted = [
        ("*MATERIAL", 1, 7),
        ("*ELASTIC", 1, 8),
        ("elements of type C3D8", 2, 18),
        ("*STEP", 2, 29),
        ("*STATIC", 1, 30),
        ("*NODE FILE", 1, 32),
        ("*END STEP", 1, 34),
    ];
    assert_eq!(skipped, wanted);
}

/// Comments between the lines of one element or keyword, blank fields, commas at the end of lines that are whole.
#[test]
fn comments_and_blank_fields() {
    let text = "\
*NODE, NSET=nall
1, , ,
** between nodes
2, 1., , 0.,
3, 1., 1.
4,, 1., 0., ,
*ELEMENT,
** of a keyword
 TYPE=S4, ELSET=plate
10, 1, 2,
** of an element

** and one more
 3, 4
11, 1, 2, 3, 4,
12, 4, 3, 2, 1, ,
*NSET, NSET=some, GENERATE
1, 3, ,
*NSET, NSET=more
 4, , 2,
** of a set
1
";
    let mesh = read("a.inp", text);
    let x: Vec<[f64; 3]> = mesh.nodes.iter().map(|node| node.x.into()).collect();
    assert_eq!(x, [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    let elements: Vec<&[u32]> = mesh.elements.iter().map(|e| e.nodes()).collect();
    assert_eq!(elements, [[0, 1, 2, 3], [0, 1, 2, 3], [3, 2, 1, 0]]);
    assert_eq!((ids(&mesh, "some"), ids(&mesh, "more")), (vec![1, 2, 3], vec![4, 2, 1]));
    assert!(mesh.skipped.is_empty());
    // A blank among the nodes of an element is none.
    let problems = mesh::read("a.inp", text.replace("11, 1, 2, 3, 4,", "11, 1, , 3, 4").as_bytes()).unwrap_err();
    assert_eq!(problems[0].message, "this must be a whole number");
}

/// A small file cut off after every byte, with every byte changed, and with every line left out or doubled: a mesh or
/// messages, never a panic, and never a mesh with nodes out of range.
#[test]
fn broken_files_never_panic() {
    let plate = Plate { n: 2, m: 1, size: [2.0, 1.0] };
    let try_one = |path: &str, bytes: &[u8]| match mesh::read(path, bytes) {
        Ok(mesh) => {
            let nodes = mesh.elements.iter().flat_map(|e| e.nodes()).chain(mesh.groups.iter().flat_map(|g| &g.nodes));
            assert!(nodes.copied().all(|node| (node as usize) < mesh.nodes.len()));
            assert!(mesh.nodes.iter().all(|node| node.x.iter().all(|x| x.is_finite())));
            true
        }
        Err(problems) => {
            assert!(!problems.is_empty() && problems.iter().all(|problem| !problem.message.is_empty()));
            false
        }
    };
    for (path, text) in [("a.msh", plate.msh4()), ("b.msh", plate.msh2()), ("c.inp", plate.inp())] {
        let bytes = text.as_bytes();
        assert!(try_one(path, bytes));
        for cut in 0..bytes.len() {
            let whole = try_one(path, &bytes[..cut]);
            // The end mark of a Gmsh file is its last line.
            assert!(!whole || path == "c.inp" || cut + 1 == bytes.len(), "{path} cut at {cut}");
        }
        for at in 0..bytes.len() {
            for other in [b'0', b'9', b'-', b' ', b'\n', b',', b'*', b'$', b'"', b'.', b'e', 0x00, 0xff] {
                let mut changed = bytes.to_vec();
                changed[at] = other;
                try_one(path, &changed);
            }
        }
        let lines: Vec<&str> = text.lines().collect();
        for at in 0..lines.len() {
            let without: Vec<&str> = [&lines[..at], &lines[at + 1..]].concat();
            try_one(path, without.join("\n").as_bytes());
            let twice: Vec<&str> = [&lines[..=at], &lines[at..]].concat();
            try_one(path, twice.join("\r\n").as_bytes());
            for number in ["18446744073709551615", "-1", "4294967296", "1e400", "99999999"] {
                let mut changed: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
                let words: Vec<&str> = lines[at].split(' ').collect();
                for word in 0..words.len() {
                    let mut words = words.clone();
                    words[word] = number;
                    changed[at] = words.join(" ");
                    try_one(path, changed.join("\n").as_bytes());
                }
            }
        }
    }
}

/// A million nodes and elements: what grows with the square of their number would not come to an end.
#[test]
fn a_million_nodes_are_read() {
    let plate = Plate { n: 1000, m: 1000, size: [1.0, 1.0] };
    for (path, text) in [("a.msh", plate.msh4()), ("b.msh", plate.msh2()), ("c.inp", plate.inp())] {
        let mesh = read(path, &text);
        assert_eq!(mesh.nodes.len(), 1001 * 1001, "{path}");
    }
}
