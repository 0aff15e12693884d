//! Types of elements: the shapes of supported types, and the number of nodes of others.

use crate::mesh::data::CellShape;

/// Types by shape. The deck decides the kind of a group: a membrane or plane element is a face like a shell, and a truss is a line like a
/// beam. Axisymmetric elements are none: they stand for rings; but meshio names each quadrilateral CAX4P.
const SHAPES: &[(CellShape, &[&str])] = &[
    (
        CellShape::Segment,
        &[
            "B31", "B31H", "B31R", "B33", "B33H", "B21", "B21H", "B23", "B23H", "PIPE31", "PIPE31H", "PIPE21",
            "PIPE21H", "T3D2", "T3D2H", "T2D2", "T2D2H", "U1", "RB3D2", "RB2D2", "R2D2",
        ],
    ),
    (
        CellShape::CurvedSegment,
        &[
            "B32", "B32H", "B32R", "B22", "B22H", "PIPE32", "PIPE32H", "PIPE22", "PIPE22H", "T3D3", "T3D3H", "T2D3",
            "T2D3H",
        ],
    ),
    (
        CellShape::Triangle,
        &["S3", "S3R", "S3RS", "S3T", "STRI3", "US3", "CPS3", "CPE3", "CPE3H", "M3D3", "R3D3", "SFM3D3", "DS3"],
    ),
    (
        CellShape::Quadrilateral,
        &[
            "S4", "S4R", "S4RS", "S4RSW", "S4R5", "S4T", "S4RT", "CPS4", "CPS4R", "CPS4I", "CPE4", "CPE4R", "CPE4I",
            "CPE4H", "CPE4RH", "CPE4IH", "M3D4", "M3D4R", "R3D4", "SFM3D4", "SFM3D4R", "DS4", "CAX4P",
        ],
    ),
    (CellShape::CurvedTriangle, &["S6", "STRI65", "CPS6", "CPS6M", "CPE6", "CPE6H", "CPE6M", "M3D6", "SFM3D6", "DS6"]),
    (
        CellShape::Serendipity,
        &[
            "S8", "S8R", "S8R5", "S8RT", "CPS8", "CPS8R", "CPE8", "CPE8R", "CPE8H", "CPE8RH", "M3D8", "M3D8R",
            "SFM3D8", "SFM3D8R", "DS8",
        ],
    ),
    (CellShape::CurvedQuadrilateral, &["S9R5", "M3D9", "M3D9R"]),
];

/// Beginnings of the names of types that are not read; digits behind them count the nodes.
const COUNTED: &[&str] = &[
    "C3D", "CAX", "CGAX", "CPEG", "SC", "DC3D", "DC2D", "DCAX", "AC3D", "AC2D", "ACAX", "F3D", "F2D", "CSS", "COH3D",
    "COH2D", "COHAX", "MAX", "SFMAX", "RAX", "Q3D", "DCC3D", "DCC2D", "EC3D", "PC3D",
];

/// Other types that are not read, with their numbers of nodes.
const OTHERS: &[(&str, usize)] = &[
    ("MASS", 1),
    ("ROTARYI", 1),
    ("SPRING1", 1),
    ("DASHPOT1", 1),
    ("DCOUP3D", 1),
    ("DCOUP2D", 1),
    ("SPRING2", 2),
    ("SPRINGA", 2),
    ("DASHPOT2", 2),
    ("DASHPOTA", 2),
    ("GAPUNI", 2),
    ("JOINTC", 2),
    ("CONN3D2", 2),
    ("CONN2D2", 2),
    ("SAX1", 2),
    ("SAX2", 3),
    ("ELBOW31", 2),
    ("ELBOW32", 3),
    ("FRAME3D", 2),
    ("FRAME2D", 2),
    ("B31OS", 2),
    ("B31OSH", 2),
    ("B32OS", 3),
    ("B32OSH", 3),
    ("D", 3),
];

/// The shape of a type of element that is read; `name` in capitals.
pub fn shape(name: &str) -> Option<CellShape> {
    SHAPES.iter().find(|(_, names)| names.contains(&name)).map(|(shape, _)| *shape)
}

/// The number of nodes of an unsupported element type, if its name contains it.
pub fn nodes_of_other(name: &str) -> Option<usize> {
    let listed = OTHERS.iter().find(|(other, _)| *other == name).map(|(_, nodes)| *nodes);
    let counted = || {
        let rest = COUNTED.iter().filter_map(|beginning| name.strip_prefix(beginning));
        let digits = rest.map(|rest| rest.split(|c: char| !c.is_ascii_digit()).next().unwrap_or_default());
        digits.filter_map(|digits| digits.parse().ok()).find(|nodes| (1..=27).contains(nodes))
    };
    listed.or_else(counted)
}
