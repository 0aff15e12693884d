//! Types of elements: what each becomes, and the number of its nodes.

/// The element of the deck for a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ElementUse {
    /// Beams of two nodes.
    StraightBeam,
    /// Beams of three nodes.
    CurvedBeam,
    /// Bars.
    Truss,
    /// Shells.
    Face,
    /// Nodes of a rigid body, and its faces where these are in contact.
    RigidFace,
    /// A point mass.
    PointMass,
    /// Moments of inertia at a point.
    PointInertia,
    /// A spring from a node to the ground.
    GroundSpring,
    /// A spring between two nodes along degrees of freedom.
    DirectedSpring,
    /// A spring along the line of two nodes.
    AxialSpring,
    /// A damper from a node to the ground.
    GroundDamper,
    /// A damper between two nodes along degrees of freedom.
    DirectedDamper,
    /// A damper along the line of two nodes.
    AxialDamper,
    /// A gap between two nodes.
    Gap,
    /// Springs along local axes.
    JointC,
    /// A connector.
    Connector,
    /// The reference node of a distributing coupling.
    Coupling,
    /// Nothing that a deck says.
    Foreign,
}

impl ElementUse {
    /// True for springs, dampers, gaps and connectors.
    pub fn is_between_nodes(self) -> bool {
        use ElementUse as Use;
        let is_spring = matches!(self, Use::GroundSpring | Use::DirectedSpring | Use::AxialSpring | Use::JointC);
        let is_damper = matches!(self, Use::GroundDamper | Use::DirectedDamper | Use::AxialDamper);
        is_spring || is_damper || matches!(self, Use::Gap | Use::Connector)
    }
}

/// A type of elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementType {
    /// The name in capitals.
    pub name: String,
    /// What its elements become.
    pub becomes: ElementUse,
    /// The number of nodes; 0 where it is not known.
    pub nodes: usize,
    /// Why elements of the type differ in the deck; empty where they do not.
    pub changed: &'static str,
}

const FLEXIBLE: &str = "beams of this type bend without shear; here they deform in shear";
/// How rigid elements without contact differ.
pub const SHAPE: &str = "the shape of rigid elements is not used, their nodes go with the body";

/// The types: names, number of nodes, difference.
const TYPES: &[(ElementUse, usize, &str, &str)] = &[
    (ElementUse::StraightBeam, 2, "B31 B31H B31R B21 B21H PIPE31 PIPE31H PIPE21 PIPE21H U1", ""),
    (ElementUse::StraightBeam, 2, "B33 B33H B23 B23H", FLEXIBLE),
    (ElementUse::CurvedBeam, 3, "B32 B32H B32R B22 B22H PIPE32 PIPE32H PIPE22 PIPE22H", ""),
    (ElementUse::Truss, 2, "T3D2 T3D2H T2D2 T2D2H", ""),
    (ElementUse::Truss, 3, "T3D3 T3D3H T2D3 T2D3H", "the middle node of a truss is left out"),
    (ElementUse::Face, 3, "S3 S3R S3RS STRI3 US3", ""),
    (ElementUse::Face, 4, "S4 S4R S4R5 S4RS S4RSW", ""),
    (ElementUse::Face, 6, "S6 STRI65", ""),
    (ElementUse::Face, 8, "S8 S8R S8R5", ""),
    (ElementUse::Face, 9, "S9R5", ""),
    (ElementUse::RigidFace, 3, "R3D3", ""),
    (ElementUse::RigidFace, 4, "R3D4", ""),
    (ElementUse::RigidFace, 2, "RB3D2 RB2D2 R2D2", ""),
    (ElementUse::PointMass, 1, "MASS", ""),
    (ElementUse::PointInertia, 1, "ROTARYI", ""),
    (ElementUse::GroundSpring, 1, "SPRING1", ""),
    (ElementUse::DirectedSpring, 2, "SPRING2", ""),
    (ElementUse::AxialSpring, 2, "SPRINGA", ""),
    (ElementUse::GroundDamper, 1, "DASHPOT1", ""),
    (ElementUse::DirectedDamper, 2, "DASHPOT2", ""),
    (ElementUse::AxialDamper, 2, "DASHPOTA", ""),
    (ElementUse::Gap, 2, "GAPUNI", ""),
    (ElementUse::JointC, 2, "JOINTC", ""),
    (ElementUse::Connector, 2, "CONN3D2 CONN2D2", ""),
    (ElementUse::Foreign, 2, "SAX1 ELBOW31 FRAME3D FRAME2D B31OS B31OSH ITSUNI ITT31", ""),
    (ElementUse::Coupling, 1, "DCOUP3D", ""),
    (ElementUse::Foreign, 1, "DCOUP2D", ""),
    (ElementUse::Foreign, 3, "SAX2 ELBOW32 B32OS B32OSH D", ""),
];

/// Beginnings of the names of other types; digits behind them count the nodes.
const COUNTED: &[&str] = &[
    "C3D", "CPS", "CPE", "M3D", "CAX", "CGAX", "CPEG", "SC", "DC3D", "DC2D", "DCAX", "AC3D", "AC2D", "ACAX", "F3D",
    "F2D", "CSS", "COH3D", "COH2D", "COHAX", "MAX", "SFM3D", "SFMAX", "RAX", "Q3D", "DCC3D", "DCC2D", "EC3D", "PC3D",
    "DS",
];

impl ElementType {
    /// The type of a name.
    pub fn new(name: &str) -> Self {
        let name = name.to_ascii_uppercase();
        if let Some((becomes, nodes, _, changed)) = TYPES.iter().find(|row| row.2.split(' ').any(|known| known == name))
        {
            return ElementType { name, becomes: *becomes, nodes: *nodes, changed };
        }
        let rest = COUNTED.iter().filter_map(|beginning| name.strip_prefix(beginning));
        let digits = rest.map(|rest| rest.split(|c: char| !c.is_ascii_digit()).next().unwrap_or_default());
        let nodes = digits.filter_map(|digits| digits.parse().ok()).find(|nodes| (1..=27).contains(nodes));
        ElementType { name, becomes: ElementUse::Foreign, nodes: nodes.unwrap_or(0), changed: "" }
    }

    /// The reason why the deck has no such elements.
    pub fn reason(&self) -> &'static str {
        let begins = |words: &[&str]| words.iter().any(|word| self.name.starts_with(word));
        match () {
            () if begins(&["C3D", "SC", "CSS", "COH"]) => "rdsolve has no solid elements",
            () if begins(&["CPS", "CPE"]) => "rdsolve has no plane elements",
            () if begins(&["CAX", "CGAX", "SAX", "MAX", "RAX", "SFMAX"]) => "rdsolve has no axisymmetric elements",
            () if begins(&["M3D", "SFM3D"]) => "rdsolve has no membranes",
            () if begins(&["DC", "DS", "AC", "F3D", "F2D", "Q3D", "EC", "PC", "D"]) => {
                "rdsolve computes no heat, fluids or fields"
            }
            () => "rdsolve has no elements of this type",
        }
    }

    /// True where a further node may give the direction of the section.
    pub fn takes_direction(&self) -> bool {
        matches!(self.becomes, ElementUse::StraightBeam | ElementUse::CurvedBeam)
    }
}
