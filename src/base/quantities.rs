//! Quantities of results: meaning, unit, axes and sign of columns.
//!
//! Decks, files, comparisons and the generated page of results all read these lists, so a name has one meaning. A table of results is a row
//! of such lists; columns of one table stand with that table.

use std::fmt;

/// Unit of a column in any consistent system: a product of force, length, mass and time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Name or number of a row.
    Label,
    /// A whole number of things.
    Count,
    /// A number without dimension.
    One,
    /// An angle in radians.
    Radian,
    /// An angle in degrees.
    Degree,
    /// A time; along a path by arc length, the load factor.
    Time,
    /// A length.
    Length,
    /// A length per time.
    Velocity,
    /// An angle in radians per time.
    AngularVelocity,
    /// A length per time squared.
    Acceleration,
    /// An angle in radians per time squared.
    AngularAcceleration,
    /// A force.
    Force,
    /// A force times a length.
    Moment,
    /// A force in rows of translations, a moment in rows of rotations.
    ForceOrMoment,
    /// A length, or an angle in radians.
    LengthOrAngle,
    /// A length per time, or an angle in radians per time.
    LengthOrAngleRate,
    /// A force per length of a section through a shell.
    ForcePerLength,
    /// A moment per length of a section through a shell.
    MomentPerLength,
    /// A force per area.
    Stress,
    /// A force times a length.
    Energy,
    /// An energy per time.
    Power,
    /// A number per time.
    Frequency,
    /// A mass.
    Mass,
    /// A mass times a length squared.
    Inertia,
    /// A mass times a velocity.
    Momentum,
    /// A mass times a velocity times a length.
    AngularMomentum,
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Unit::Label => "",
            Unit::Count => "count",
            Unit::One => "1",
            Unit::Radian => "rad",
            Unit::Degree => "°",
            Unit::Time => "time",
            Unit::Length => "length",
            Unit::Velocity => "length/time",
            Unit::AngularVelocity => "rad/time",
            Unit::Acceleration => "length/time²",
            Unit::AngularAcceleration => "rad/time²",
            Unit::Force => "force",
            Unit::Moment => "force·length",
            Unit::ForceOrMoment => "force, or force·length",
            Unit::LengthOrAngle => "length, or rad",
            Unit::LengthOrAngleRate => "length/time, or rad/time",
            Unit::ForcePerLength => "force/length",
            Unit::MomentPerLength => "force·length/length",
            Unit::Stress => "force/length²",
            Unit::Energy => "force·length",
            Unit::Power => "force·length/time",
            Unit::Frequency => "1/time",
            Unit::Mass => "mass",
            Unit::Inertia => "mass·length²",
            Unit::Momentum => "mass·length/time",
            Unit::AngularMomentum => "mass·length²/time",
        })
    }
}

/// A system of units by the symbols of its quantities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitSystem {
    /// The word of the deck.
    pub name: &'static str,
    /// Length, mass, time and force.
    pub base: [&'static str; 4],
    /// Stress and energy, which have names.
    pub named: [&'static str; 2],
    /// Standard gravity.
    pub gravity: f64,
}

/// All systems of units.
pub const UNIT_SYSTEMS: [UnitSystem; 5] = [
    UnitSystem { name: "SI", base: ["m", "kg", "s", "N"], named: ["Pa", "J"], gravity: 9.80665 },
    UnitSystem { name: "m-kg-s", base: ["m", "kg", "s", "N"], named: ["Pa", "J"], gravity: 9.80665 },
    UnitSystem { name: "mm-t-s", base: ["mm", "t", "s", "N"], named: ["MPa", "mJ"], gravity: 9806.65 },
    UnitSystem { name: "mm-kg-s", base: ["mm", "kg", "s", "mN"], named: ["kPa", "µJ"], gravity: 9806.65 },
    UnitSystem { name: "mm-kg-ms", base: ["mm", "kg", "ms", "kN"], named: ["GPa", "J"], gravity: 9.80665e-3 },
];

impl UnitSystem {
    /// The system with a name; `None` if there is none.
    pub fn find(name: &str) -> Option<&'static UnitSystem> {
        UNIT_SYSTEMS.iter().find(|system| system.name == name)
    }

    /// Its unit of stress, in Pa.
    pub fn pascals(&self) -> f64 {
        match self.named[0] {
            "GPa" => 1e9,
            "MPa" => 1e6,
            "kPa" => 1e3,
            _ => 1.0,
        }
    }
}

impl Unit {
    /// The unit in symbols of a system, such as `N/mm`; in words without one, such as `force/length`.
    pub fn text(self, system: Option<&UnitSystem>) -> String {
        let Some(UnitSystem { base: [length, mass, time, force], named: [stress, energy], .. }) = system else {
            return self.to_string();
        };
        match self {
            Unit::Stress => (*stress).to_owned(),
            Unit::Energy => (*energy).to_owned(),
            Unit::Power => format!("{energy}/{time}"),
            _ => {
                let words = [("length", length), ("mass", mass), ("time", time), ("force", force)];
                words.into_iter().fold(self.to_string(), |text, (word, symbol)| text.replace(word, symbol))
            }
        }
    }
}

/// The axes that components refer to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// The column is a scalar, or its components need no axes.
    None,
    /// The global axes x, y and z.
    Global,
    /// Beam axis x and the section's local y and z, turning with the section.
    Section,
    /// Axis 1, axis 2 and the normal of a shell element, turning with its surface.
    Surface,
}

impl fmt::Display for Axes {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Axes::None => "",
            Axes::Global => "global",
            Axes::Section => "section",
            Axes::Surface => "shell",
        })
    }
}

/// A column of a table of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// The name in the header, which is also the quantity of `[[expect]]`.
    pub name: &'static str,
    /// The meaning in words. Components of one vector share them.
    pub meaning: &'static str,
    /// The unit of its numbers.
    pub unit: Unit,
    /// The axes that a component refers to.
    pub axes: Axes,
    /// Meaning of a positive number, if it is not obvious; otherwise empty.
    pub sign: &'static str,
    /// Columns of one kind are components of one vector or amounts of one balance. A constant column is measured against the largest of its
    /// kind.
    pub kind: &'static str,
}

impl Column {
    /// A label column of the rows.
    pub const fn key(name: &'static str, meaning: &'static str) -> Column {
        Column::scalar(name, meaning, Unit::Label)
    }

    /// A number without axes, and with a separate kind.
    pub const fn scalar(name: &'static str, meaning: &'static str, unit: Unit) -> Column {
        Column { name, meaning, unit, axes: Axes::None, sign: "", kind: name }
    }

    /// Returns the column with the meaning of a positive number.
    pub const fn positive(self, sign: &'static str) -> Column {
        Column { sign, ..self }
    }

    /// Returns the column with a kind.
    pub const fn kind(self, kind: &'static str) -> Column {
        Column { kind, ..self }
    }

    /// Returns the column as a component along axes.
    pub const fn in_axes(self, axes: Axes) -> Column {
        Column { axes, ..self }
    }

    /// True for a label column.
    pub fn is_key(&self) -> bool {
        self.unit == Unit::Label
    }
}

/// Global components of a vector.
const fn vector(names: [&'static str; 3], meaning: &'static str, unit: Unit) -> [Column; 3] {
    let [x, y, z] = names;
    [
        Column::scalar(x, meaning, unit).kind(meaning).in_axes(Axes::Global),
        Column::scalar(y, meaning, unit).kind(meaning).in_axes(Axes::Global),
        Column::scalar(z, meaning, unit).kind(meaning).in_axes(Axes::Global),
    ]
}

const fn energy(name: &'static str, meaning: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Energy).kind("energy")
}

/// The first column of every table.
pub const STEP: Column = Column::scalar("step", "number of accepted steps, 0 in the initial state", Unit::Count);
/// The second column of every table.
pub const TIME: Column =
    Column::scalar("time", "time at the end of the step, or the load factor of a path by arc length", Unit::Time);

/// The position of a node or a body, x y z.
pub const POSITION: [Column; 3] = vector(["x", "y", "z"], "position", Unit::Length);
/// The displacement of a node, x y z.
pub const DISPLACEMENT: [Column; 3] = vector(["ux", "uy", "uz"], "displacement since the initial state", Unit::Length);
/// The rotation vector of a node, x y z.
pub const ROTATION: [Column; 3] = {
    let [x, y, z] = vector(
        ["rx", "ry", "rz"],
        "rotation vector since the initial state: the shortest one, of length at most π",
        Unit::Radian,
    );
    [x.positive("right-handed"), y.positive("right-handed"), z.positive("right-handed")]
};
/// The rotation of a body, w x y z.
pub const QUATERNION: [Column; 4] = {
    const fn component(name: &'static str) -> Column {
        Column::scalar(name, "unit quaternion that turns body axes into global axes; `qw` is never negative", Unit::One)
            .kind("quaternion")
            .in_axes(Axes::Global)
    }
    [component("qw"), component("qx"), component("qy"), component("qz")]
};
/// The velocity of a node or a body, x y z.
pub const VELOCITY: [Column; 3] = vector(["vx", "vy", "vz"], "velocity", Unit::Velocity);
/// The angular velocity of a node or a body, x y z.
pub const ANGULAR_VELOCITY: [Column; 3] = vector(["wx", "wy", "wz"], "angular velocity", Unit::AngularVelocity);
/// The acceleration of a node or a body, x y z.
pub const ACCELERATION: [Column; 3] = vector(["ax", "ay", "az"], "acceleration", Unit::Acceleration);
/// The angular acceleration of a node or a body, x y z.
pub const ANGULAR_ACCELERATION: [Column; 3] =
    vector(["alphax", "alphay", "alphaz"], "angular acceleration", Unit::AngularAcceleration);

/// Coordinate, its rate and the effort of a joint that has one.
pub const JOINT_COORDINATE: [Column; 3] = [
    Column::scalar("coordinate", "angle about the axis, turns counted, or distance along it, since t = 0", Unit::LengthOrAngle)
        .positive("`to` ahead of `from`"),
    Column::scalar("rate", "rate of the coordinate", Unit::LengthOrAngleRate).positive("`to` ahead of `from`"),
    Column::scalar(
        "effort",
        "moment or force along the coordinate on `to`: of the drive, the motor, spring, damper, stops and friction together",
        Unit::ForceOrMoment,
    )
    .positive("along the axis, on `to`"),
];
/// The power of a joint's drive or motor, in joints that have one.
pub const JOINT_POWER: Column = Column::scalar(
    "power",
    "power of the drive (`motion`) or the motor (`effort`): its force or moment times `rate`; in statics rates are zero",
    Unit::Power,
)
.positive("it gives energy to the model");
/// All that a joint exerts on its first part.
pub const JOINT_REACTION: [Column; 6] = wrench(
    "force of the joint on its first part (`from`): of all that it is, drive, motor, spring and friction included",
    "moment of the joint on its first part, about that end, likewise",
);
/// All that a tie exerts on its nodes.
pub const TIE: [Column; 6] = wrench(
    "force of the tie on its nodes together",
    "moment of the tie on its nodes together, about the mean of their places",
);
/// Forces and moments of supports at a point.
pub const REACTION: [Column; 6] = wrench(
    "force of the supports on the structure at this point",
    "moment of the supports on the structure at this point",
);

/// Elongation, its rate and force of a link, then force and moment on its first end.
pub const LINK: [Column; 10] = {
    let [fx, fy, fz, mx, my, mz] =
        wrench("force of the link on its first end", "moment of the link on its first end (bushings only)");
    [
        Column::scalar("elongation", "length beyond the free length; of a bushing, along its first axis", Unit::Length)
            .positive("longer"),
        Column::scalar("rate", "rate of the elongation", Unit::Velocity).positive("growing longer"),
        Column::scalar(
            "force",
            "force along the line of the link, dampers included; of a bushing, along its first axis",
            Unit::Force,
        )
        .kind("force")
        .positive("tension"),
        fx,
        fy,
        fz,
        mx,
        my,
        mz,
        Column::scalar("failed", "1 if the link has failed, otherwise 0; only in decks with failure", Unit::One),
    ]
};

/// A displacement relative to another node.
pub const DRIFT: [Column; 6] = {
    const MOVED: &str = "displacement of `to` less that of `from`";
    [
        Column::scalar("ux", MOVED, Unit::Length).kind(MOVED).in_axes(Axes::Global),
        Column::scalar("uy", MOVED, Unit::Length).kind(MOVED).in_axes(Axes::Global),
        Column::scalar("uz", MOVED, Unit::Length).kind(MOVED).in_axes(Axes::Global),
        Column::scalar("distance", "change of the distance between both", Unit::Length).positive("apart"),
        Column::scalar(
            "lateral",
            "size of the relative displacement across the line from `from` to `to` at t = 0",
            Unit::Length,
        ),
        Column::scalar(
            "ratio",
            "`lateral` over the distance at t = 0, the drift ratio of a storey; empty where both lie at one place",
            Unit::One,
        ),
    ]
};

/// Points in contact, those that slip and least clearance of a contact, then force and moment on its surface.
pub const CONTACT: [Column; 9] = {
    let [fx, fy, fz, mx, my, mz] = wrench(
        "force on the surface",
        "moment on the surface, about the centre of mass of the body that carries it, about the ground surface's own point, or, on faces \
         and lines of parts, about the origin",
    );
    [
        Column::scalar("touching", "number of points in contact", Unit::Count),
        Column::scalar("slipping", "number of these whose friction is at its limit; 0 without `friction`", Unit::Count),
        Column::scalar("gap", "least clearance of all points", Unit::Length)
            .positive("clear of each other; negative: penetration"),
        fx,
        fy,
        fz,
        mx,
        my,
        mz,
    ]
};

/// Touches between two parts, then force and moment on the first.
pub const CONTACT_PAIR: [Column; 7] = {
    let [fx, fy, fz, mx, my, mz] = wrench("force on the first", "moment on the first, about the origin");
    [Column::scalar("touching", "number of places at which they touch", Unit::Count), fx, fy, fz, mx, my, mz]
};

/// Magnitude of a contact force, only for `[[expect]]`.
pub const CONTACT_FORCE: Column =
    Column::scalar("force", "magnitude of the force on the surface", Unit::Force).kind("force");

/// The energies of the scene and their balance, then linear and angular momentum.
pub const ENERGY: [Column; 19] = {
    let [px, py, pz] = vector(["px", "py", "pz"], "linear momentum", Unit::Momentum);
    let [lx, ly, lz] = vector(["lx", "ly", "lz"], "angular momentum about the origin", Unit::AngularMomentum);
    [
        energy("kinetic", "kinetic energy"),
        energy("strain", "elastic energy of beams, bars and shells, and what kinematic hardening stores"),
        energy("plastic", "dissipated so far by rate-independent plastic flow").positive("dissipated"),
        energy("viscoplastic", "dissipated so far by the overstress of viscoplastic flow").positive("dissipated"),
        energy("damping", "dissipated so far by dampers, nodal and Rayleigh damping").positive("dissipated"),
        energy("links", "stored in links"),
        energy("contact", "stored in contacts"),
        energy("friction", "dissipated so far by friction in contacts").positive("dissipated"),
        energy("impact", "dissipated so far in impacts, by contact damping and restitution").positive("dissipated"),
        energy(
            "external",
            "work of loads, gravity and prescribed motion so far, with the energy that stages add at their start",
        )
        .positive("put in"),
        energy(
            "numerical",
            "algorithmic dissipation, the remainder of the balance: initial + external − dissipated − `mechanical`",
        )
        .positive("taken by the time integration; negative: energy growth"),
        energy("mechanical", "kinetic + strain + links + contact"),
        px,
        py,
        pz,
        lx,
        ly,
        lz,
        energy("eroded", "energy that failed elements had stored; only in decks with failure").positive("lost"),
    ]
};

/// A mode: its frequency and what else there is of it.
pub const MODE: [Column; 21] = {
    const fn factor(name: &'static str) -> Column {
        let meaning = "participation factor: φᵀ M r over the modal mass, for a unit rigid motion r along or about an axis through \
            the centre of mass";
        Column::scalar(name, meaning, Unit::One).in_axes(Axes::Global)
    }
    const fn mass(name: &'static str) -> Column {
        let meaning = "effective mass for a rigid motion along the axis";
        Column::scalar(name, meaning, Unit::Mass).kind("effective mass").in_axes(Axes::Global)
    }
    const fn inertia(name: &'static str) -> Column {
        let meaning = "effective moment of inertia, likewise, about an axis through the centre of mass";
        Column::scalar(name, meaning, Unit::Inertia).kind("effective inertia").in_axes(Axes::Global)
    }
    [
        Column::scalar(
            "frequency",
            "frequency; 0 of a motion without stiffness, and of one that does not oscillate",
            Unit::Frequency,
        ),
        Column::scalar("period", "period; empty where nothing oscillates", Unit::Time),
        Column::scalar("angular_frequency", "2π times the frequency", Unit::AngularVelocity),
        Column::scalar(
            "damping_ratio",
            "part of critical damping; empty where nothing oscillates nor decays",
            Unit::One,
        )
        .positive("decays"),
        Column::scalar("growth", "growth rate of the motion, exp(growth t)", Unit::Frequency)
            .positive("grows: the state is unstable"),
        Column::scalar("factor", "factor of the loads for buckling; empty for natural modes", Unit::One),
        Column::scalar("modal_mass", "φᵀ M φ, with a shape φ whose largest displacement is 1", Unit::Mass),
        factor("participation_x"),
        factor("participation_y"),
        factor("participation_z"),
        factor("participation_rx"),
        factor("participation_ry"),
        factor("participation_rz"),
        mass("mass_x"),
        mass("mass_y"),
        mass("mass_z"),
        inertia("inertia_x"),
        inertia("inertia_y"),
        inertia("inertia_z"),
        Column::scalar(
            "strain",
            "share of strain energy in beams, bars, shells and links; stressed joints and follower loads have the rest",
            Unit::One,
        ),
        WHIRL,
    ]
};

/// The sense of the orbits of a mode.
const WHIRL: Column = Column::scalar(
    "whirl",
    "sense of the orbits: 1 circular with the spin of bodies, -1 circular against it, 0 along lines; empty where nothing spins",
    Unit::One,
)
.positive("forward");

/// The speed of rotation of a row of campbell.csv.
pub const CAMPBELL_SPEED: Column =
    Column::scalar("speed", "speed of rotation of the body that spins fastest", Unit::AngularVelocity);

/// A mode at a speed of rotation.
pub const CAMPBELL: [Column; 5] = [
    Column::scalar("frequency", "frequency; 0 of what does not oscillate", Unit::Frequency),
    Column::scalar("angular_frequency", "2π times the frequency", Unit::AngularVelocity),
    Column::scalar("damping_ratio", "part of critical damping; empty where nothing oscillates nor decays", Unit::One)
        .positive("decays"),
    Column::scalar("growth", "growth rate of the motion, exp(growth t)", Unit::Frequency).positive("grows"),
    WHIRL,
];

/// A critical speed.
pub const CRITICAL_SPEED: [Column; 4] = [
    Column::scalar("speed", "speed of rotation that is the angular frequency of a mode", Unit::AngularVelocity),
    Column::scalar("frequency", "speed over 2π", Unit::Frequency),
    Column::scalar("damping_ratio", "part of critical damping of the mode", Unit::One).positive("decays"),
    WHIRL,
];

/// The steady motion of a node at a frequency: amplitudes, then phases.
pub const RESPONSE: [Column; 12] = steady(
    ["ux", "uy", "uz", "rx", "ry", "rz"],
    ["ux_phase", "uy_phase", "uz_phase", "rx_phase", "ry_phase", "rz_phase"],
    [
        ("amplitude of the displacement about the state", Unit::Length),
        ("amplitude of the small rotation about the state", Unit::Radian),
    ],
);
/// The steady force and moment of a link on its first end at a frequency: amplitudes, then phases.
pub const RESPONSE_LINK: [Column; 12] = steady(
    ["fx", "fy", "fz", "mx", "my", "mz"],
    ["fx_phase", "fy_phase", "fz_phase", "mx_phase", "my_phase", "mz_phase"],
    [
        ("amplitude of the force of the link on its first end, about the force in the state", Unit::Force),
        ("amplitude of the moment of the link on its first end, about the moment in the state", Unit::Moment),
    ],
);

/// Amplitudes of two vectors by their meaning, then the phases of their components.
const fn steady(
    names: [&'static str; 6],
    phases: [&'static str; 6],
    vectors: [(&'static str, Unit); 2],
) -> [Column; 12] {
    let meaning =
        "phase φ of the same: it is amplitude × cos(ωt + φ) where excitations are cos(ωt + phase); from −180 to 180";
    let mut columns = [Column::scalar("", meaning, Unit::Degree).in_axes(Axes::Global); 12];
    let mut i = 0;
    while i < 6 {
        let (amplitude, unit) = vectors[i / 3];
        columns[i] = Column::scalar(names[i], amplitude, unit).kind(amplitude).in_axes(Axes::Global);
        columns[6 + i].name = phases[i];
        columns[6 + i].kind = phases[i];
        columns[6 + i].sign = "ahead of the excitation";
        i += 1;
    }
    columns
}
/// The frequency of a response.
pub const RESPONSE_FREQUENCY: Column = Column::scalar("frequency", "frequency of the excitation", Unit::Frequency);

/// The plastic strain of beams, bars and shells.
pub const PLASTIC_STRAIN: Column = Column::scalar("plastic_strain", "largest accumulated plastic strain", Unit::One);
/// Stress of a layer of a shell; `[[expect]]` uses the largest of a whole shell.
pub const VON_MISES: Column = Column::scalar("von_mises", "von Mises stress", Unit::Stress).kind("stress");

/// Stress resultants per length of a shell, and stresses at its faces.
pub const SHELL_RESULTANTS: [Column; 10] = [
    membrane("N11"),
    membrane("N22"),
    membrane("N12"),
    bending("M11"),
    bending("M22"),
    bending("M12"),
    shear("Q1"),
    shear("Q2"),
    surface_stress("von_mises_bottom", "von Mises stress in the lowest layer; of an elastic shell, at the surface"),
    surface_stress("von_mises_top", "von Mises stress in the highest layer; of an elastic shell, at the surface"),
];

const fn membrane(name: &'static str) -> Column {
    Column::scalar(name, "membrane force per length", Unit::ForcePerLength)
        .kind("membrane force")
        .in_axes(Axes::Surface)
        .positive("tension")
}

const fn bending(name: &'static str) -> Column {
    Column::scalar(name, "bending moment per length", Unit::MomentPerLength)
        .kind("bending moment")
        .in_axes(Axes::Surface)
        .positive("tension at the top, the side of the normal")
}

const fn shear(name: &'static str) -> Column {
    Column::scalar(name, "transverse shear force per length", Unit::ForcePerLength)
        .kind("shear force")
        .in_axes(Axes::Surface)
        .positive("∂M11/∂1 + ∂M12/∂2 = Q1")
}

const fn surface_stress(name: &'static str, meaning: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Stress).kind("surface stress")
}

/// The force in an element of a bar.
pub const AXIAL_FORCE: Column = section_force("N", "axial force, damping included", "tension");

/// Forces and moments in a section of a beam.
pub const SECTION_FORCES: [Column; 6] = [
    section_force("N", "normal force", "tension"),
    section_force("Vy", "shear force along y", "along +y"),
    section_force("Vz", "shear force along z", "along +z"),
    section_moment("T", "torsional moment", "right-handed about the beam axis"),
    section_moment("My", "bending moment about y", "tension on the side of +z"),
    section_moment("Mz", "bending moment about z", "tension on the side of −y"),
];

/// Extreme stresses in a section of a beam.
pub const SECTION_STRESSES: [Column; 4] = [
    section_stress("sigma_max", "largest normal stress at the extreme points of the section").positive("tension"),
    section_stress("sigma_min", "smallest normal stress at the extreme points of the section").positive("tension"),
    section_stress(
        "tau_max",
        "largest shear stress, of shear forces and torsion, at the extreme points of the section",
    ),
    section_stress("von_mises", "largest von Mises stress at the extreme points of the section"),
];

const fn section_stress(name: &'static str, meaning: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Stress).kind("section stress")
}

const fn section_force(name: &'static str, meaning: &'static str, sign: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Force).kind("section force").in_axes(Axes::Section).positive(sign)
}

const fn section_moment(name: &'static str, meaning: &'static str, sign: &'static str) -> Column {
    Column::scalar(name, meaning, Unit::Moment).kind("section moment").in_axes(Axes::Section).positive(sign)
}

/// Global components of a force and a moment.
const fn wrench(force: &'static str, moment: &'static str) -> [Column; 6] {
    let [fx, fy, fz] = vector(["fx", "fy", "fz"], force, Unit::Force);
    let [mx, my, mz] = vector(["mx", "my", "mz"], moment, Unit::Moment);
    [fx.kind("force"), fy.kind("force"), fz.kind("force"), mx.kind("moment"), my.kind("moment"), mz.kind("moment")]
}

/// The motion of a node, in the order of nodes.csv.
pub const MOTION: [&[Column]; 7] =
    [&POSITION, &DISPLACEMENT, &ROTATION, &VELOCITY, &ANGULAR_VELOCITY, &ACCELERATION, &ANGULAR_ACCELERATION];

/// Names of columns, in their order.
pub fn names(groups: &[&'static [Column]]) -> Vec<&'static str> {
    groups.iter().copied().flatten().map(|column| column.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_symbols() {
        let text = |unit: Unit, name: &str| unit.text(UnitSystem::find(name));
        assert_eq!(text(Unit::Acceleration, "mm-kg-ms"), "mm/ms²");
        assert_eq!(text(Unit::MomentPerLength, "mm-t-s"), "N·mm/mm");
        assert_eq!(text(Unit::Stress, "mm-kg-s"), "kPa");
        assert_eq!(text(Unit::Energy, "SI"), "J");
        assert_eq!(text(Unit::Moment, "unknown"), "force·length");
        assert_eq!(text(Unit::Radian, "SI"), "rad");
    }
}
