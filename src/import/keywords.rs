//! The table of all keywords: what reads each, or why none does. A keyword that has no row is refused.

use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::{
    amplitude_cards, base_motion, connector_cards, constraint_cards, contact_cards, harmonics, material_cards,
    mesh_cards, mesh_makers, model_changes, nodal_axes, pretension, property_cards, section_cards, step_cards,
    temperatures,
};
use base::text_file::cards::stands_for;
use std::fmt::Write;

/// The treatment of a keyword.
#[derive(Clone, Copy)]
pub enum Treatment {
    /// It is read.
    Read(fn(&mut Importer, &KeywordBlock)),
    /// It does not act on the motion.
    Ignore,
    /// The deck cannot say it.
    Refuse,
}

/// A row of the table.
pub struct KeywordRow {
    /// The keyword.
    pub word: &'static str,
    /// The parameters that do not act on the motion and that no reader asks for; `*`: all.
    pub harmless: &'static str,
    /// What happens to it.
    pub treatment: Treatment,
    /// Its counterpart in the deck, or the reason of the refusal.
    pub about: &'static str,
}

impl KeywordRow {
    /// True for a parameter that does not act on the motion.
    pub fn has_harmless(&self, parameter: &str) -> bool {
        self.harmless.split(' ').any(|harmless| harmless == "*" || stands_for(parameter, harmless))
    }
}

const fn read(
    word: &'static str,
    harmless: &'static str,
    read: fn(&mut Importer, &KeywordBlock),
    about: &'static str,
) -> KeywordRow {
    KeywordRow { word, harmless, treatment: Treatment::Read(read), about }
}

const fn ignore(word: &'static str, about: &'static str) -> KeywordRow {
    KeywordRow { word, harmless: "", treatment: Treatment::Ignore, about }
}

const fn refuse(word: &'static str, about: &'static str) -> KeywordRow {
    KeywordRow { word, harmless: "", treatment: Treatment::Refuse, about }
}

const OUTPUT: &str = "output of the other program; the deck has its own";
const SOLVER: &str = "settings of the other solver";
const HEAT: &str = "rdsolve computes no temperatures; give them by *TEMPERATURE";
const FLUID: &str = "rdsolve computes no fluids";
const FIELDS: &str = "rdsolve computes no electric or magnetic fields";
const LAW: &str = "rdsolve has elastic, plastic and viscoplastic materials alone";
const CONTACT: &str = "contact is translated by *CONTACT PAIR alone; give pairs, or add [[contacts]] to the deck";
const CYCLIC: &str = "rdsolve has no cyclic symmetry";
const PIECES: &str = "substructures and submodels are not translated; `[[superelements]]` take their matrices";
const MESH: &str = "makes nodes, elements or numbers; write the mesh as one flat file";
const OPTIMIZE: &str = "rdsolve computes no sensitivities";

/// All keywords.
pub const KEYWORDS: &[KeywordRow] = &[
    read("NODE", "", mesh_cards::nodes, "nodes of the mesh"),
    read("ELEMENT", "", mesh_cards::elements, "elements of the mesh, by their type"),
    read("USER ELEMENT", "INTEGRATIONPOINTS", mesh_cards::user_element, "nothing: U1 of CalculiX is a beam"),
    read("NGEN", "", mesh_makers::between_nodes, "nodes of the mesh"),
    read("NFILL", "", mesh_makers::between_sets, "nodes of the mesh"),
    read("NCOPY", "", mesh_makers::copied_nodes, "nodes of the mesh"),
    read("ELGEN", "", mesh_makers::rows_of_elements, "elements of the mesh"),
    read("ELCOPY", "", mesh_makers::copied_elements, "elements of the mesh"),
    read("NSET", "INTERNAL UNSORTED", mesh_cards::node_sets, "a set of nodes"),
    read("ELSET", "INTERNAL UNSORTED", mesh_cards::element_sets, "a set of elements"),
    read("SURFACE", "INTERNAL", mesh_cards::surfaces, "where loads and couplings act"),
    read("PART", "NAME", mesh_cards::part, "nodes and elements of each of its instances"),
    read("END PART", "", mesh_cards::outside, "nothing of its own"),
    read("ASSEMBLY", "NAME", mesh_cards::outside, "nothing of its own"),
    read("END ASSEMBLY", "", mesh_cards::outside, "nothing of its own"),
    read("INSTANCE", "", mesh_cards::instance, "nodes and elements of its part where it stands"),
    read("END INSTANCE", "", mesh_cards::outside, "nothing of its own"),
    read("BEAM SECTION", "LUMPED", section_cards::beam, "[[beams]], [sections]"),
    read("BEAM GENERAL SECTION", "LUMPED ZERO", section_cards::general_beam, "[[beams]], [sections], [materials]"),
    read("SHELL SECTION", "SECTIONINTEGRATION THICKNESSMODULUS CONTROLS", section_cards::shell, "[[shells]]"),
    read(
        "SHELL GENERAL SECTION",
        "THICKNESSMODULUS CONTROLS",
        section_cards::general_shell,
        "[[shells]], of one material",
    ),
    read("SOLID SECTION", "CONTROLS", section_cards::solid, "[[bars]] area, of trusses"),
    read(
        "NODAL THICKNESS",
        "",
        section_cards::nodal_thickness,
        "[[shells]] thickness, where it is the same in each element",
    ),
    read("ORIENTATION", "", property_cards::orientation, "axes of joints, bushings and shells"),
    read("TRANSFORM", "", nodal_axes::transform, "[[supports]] axes, turned loads and equations"),
    read("MATERIAL", "", material_cards::material, "[materials]"),
    read("ELASTIC", "MODULI", material_cards::elastic, "[materials] youngs_modulus, poisson_ratio"),
    read("PLASTIC", "", material_cards::plastic, "[materials] hardening, kinematic_share"),
    read("RATE DEPENDENT", "", material_cards::rate_dependent, "[materials] viscosity"),
    read("DENSITY", "", material_cards::density, "[materials] density"),
    read("DAMPING", "", material_cards::damping, "damping of parts"),
    read("EXPANSION", "ZERO", material_cards::expansion, "[materials] expansion, where a temperature changes"),
    read("MASS", "", property_cards::mass, "[[masses]]"),
    read("ROTARY INERTIA", "", property_cards::inertia, "[[masses]] inertia, or that of a body"),
    read("SPRING", "", property_cards::spring, "[[links]]"),
    read("DASHPOT", "", property_cards::dashpot, "[[links]] damping"),
    read("JOINT", "", property_cards::joint, "[[links]] bushing"),
    read("GAP", "", property_cards::gap, "[[links]] with a gap"),
    read("RIGID BODY", "", constraint_cards::rigid_body, "[[bodies]], [[attachments]]"),
    read("TIE", "NOTHICKNESS", constraint_cards::tie, "[[ties]]"),
    read("COUPLING", "", constraint_cards::coupling, "a body at the reference node"),
    read("KINEMATIC", "", constraint_cards::kinematic, "[[attachments]] dofs"),
    read("DISTRIBUTING", "", constraint_cards::distributing, "[[loads]] at its nodes"),
    read("DISTRIBUTING COUPLING", "", constraint_cards::distributing_coupling, "[[loads]] at its nodes"),
    read("KINEMATIC COUPLING", "", constraint_cards::kinematic_coupling, "a body, [[attachments]] dofs"),
    read("MPC", "", constraint_cards::points, "nodes that are one, [[joints]], [[equations]] or a body"),
    read("PRE-TENSION SECTION", "", pretension::section, "[[joints]] effort or motion in a cut beam"),
    read("EQUATION", "", constraint_cards::equations, "nodes that are one, [[joints]], [[supports]] or [[equations]]"),
    read(
        "CONTACT PAIR",
        "SUPPLEMENTARYCONSTRAINTS TRACKING EXTENSIONZONE HCRIT MECHANICALCONSTRAINT",
        contact_cards::pair,
        "[[contacts]]",
    ),
    read("MODEL CHANGE", "ACTIVATE", model_changes::model_change, "`stages` of [[contacts]], [[links]] and [[joints]]"),
    read("SURFACE INTERACTION", "", contact_cards::interaction, "what acts in [[contacts]]"),
    read(
        "SURFACE BEHAVIOR",
        "AUGMENTEDLAGRANGE PENALTY DIRECT",
        contact_cards::behavior,
        "[[contacts]] stiffness, which rdsolve chooses",
    ),
    read("FRICTION", "SLIPTOLERANCE ELASTICSLIP LAGRANGE", contact_cards::friction, "[[contacts]] friction"),
    read("CONNECTOR SECTION", "", connector_cards::section, "[[joints]] or [[links]]"),
    read("CONNECTOR BEHAVIOR", "", connector_cards::behavior, "what acts in joints and bushings"),
    read("CONNECTOR ELASTICITY", "", connector_cards::elasticity, "stiffness of joints and bushings"),
    read("CONNECTOR DAMPING", "", connector_cards::damping, "damping of joints and bushings"),
    read("CONNECTOR STOP", "", connector_cards::stop, "[[joints]] limits"),
    read("CONNECTOR MOTION", "", connector_cards::motion, "[[joints]] motion"),
    read("CONNECTOR LOAD", "", connector_cards::load, "[[joints]] effort"),
    read("AMPLITUDE", "", amplitude_cards::amplitude, "[amplitudes]"),
    read("BOUNDARY", "REAL", step_cards::boundary, "[[supports]]"),
    read("INITIAL CONDITIONS", "", step_cards::initial_conditions, "[[initial]]"),
    read("STEP", "INC UNSYMM EXTRAPOLATION CONVERTSDI SOLVER DIRECT", step_cards::step, "[analysis] or [[stages]]"),
    read("END STEP", "", step_cards::end_step, "nothing of its own"),
    read("STATIC", "DIRECT ALLSDTOL CONTINUE SOLVER ADAPTIVE", step_cards::statics, "a static analysis"),
    read(
        "DYNAMIC",
        "HAFTOL NOHAF INITIAL SOLVER ELEMENTBYELEMENT FIXEDTIMEINCREMENTATION",
        step_cards::dynamic,
        "a dynamic analysis",
    ),
    read("FIXED MASS SCALING", "", step_cards::fixed_mass_scaling, "[integrator] mass_scaling_step"),
    read("MODAL DYNAMIC", "DIRECT SOLVER DELTMX", step_cards::modal_dynamic, "a dynamic analysis"),
    read(
        "FREQUENCY",
        "EIGENSOLVER NORMALIZATION SOLVER STORAGE NUMBERINTERVAL ACOUSTICCOUPLING GLOBAL NSET SIM",
        step_cards::frequency,
        "natural modes",
    ),
    read("COMPLEX FREQUENCY", "", step_cards::complex_frequency, "complex modes"),
    read("STEADY STATE DYNAMICS", "SOLVER", harmonics::steady_state, "a frequency response"),
    read("MODAL DAMPING", "", harmonics::modal_damping, "damping_ratio of the response, or [damping]"),
    read("BUCKLE", "EIGENSOLVER SOLVER", step_cards::buckle, "buckling factors"),
    read("BASE MOTION", "REAL", base_motion::base_motion, "[environment] base_acceleration"),
    read("CLOAD", "REAL", step_cards::forces, "[[loads]] force, moment"),
    read(
        "TEMPERATURE",
        "",
        temperatures::temperatures,
        "[[loads]] temperature, nodal_temperature, temperature_gradient",
    ),
    read("DLOAD", "REAL", step_cards::element_loads, "[[loads]] by length or area, or gravity"),
    read("DSLOAD", "REAL", step_cards::surface_loads, "[[loads]] pressure, force_per_area, or forces along edges"),
    read("NODE PRINT", "*", step_cards::node_output, "[output]"),
    read("NODE FILE", "*", step_cards::node_output, "[output]"),
    read("NODE OUTPUT", "*", step_cards::node_output, "[output]"),
    read("EL PRINT", "*", step_cards::element_output, "[output] sections"),
    read("EL FILE", "*", step_cards::element_output, "[output] sections"),
    read("ELEMENT OUTPUT", "*", step_cards::element_output, "[output] sections"),
    read("OUTPUT", "*", step_cards::output, "[output] fields"),
    read("HEADING", "", step_cards::heading, "title"),
    read("NO COMPRESSION", "", material_cards::no_compression, "[[bars]] tension_only"),
    ignore("PREPRINT", SOLVER),
    ignore("CONSTRAINT CONTROLS", SOLVER),
    ignore("RESTART", OUTPUT),
    ignore("PHYSICAL CONSTANTS", "constants of radiation and gravitation"),
    ignore("CONTROLS", SOLVER),
    ignore("SOLUTION TECHNIQUE", SOLVER),
    ignore("SECTION CONTROLS", SOLVER),
    ignore("BULK VISCOSITY", "damping of shock waves in explicit steps; rdsolve has none"),
    ignore("MONITOR", OUTPUT),
    ignore("FILE FORMAT", OUTPUT),
    ignore("FILE OUTPUT", OUTPUT),
    ignore("ENERGY OUTPUT", OUTPUT),
    ignore("ENERGY PRINT", OUTPUT),
    ignore("ENERGY FILE", OUTPUT),
    ignore("MODAL OUTPUT", OUTPUT),
    ignore("CONTACT OUTPUT", OUTPUT),
    ignore("CONTACT PRINT", OUTPUT),
    ignore("CONTACT FILE", OUTPUT),
    ignore("SECTION PRINT", OUTPUT),
    ignore("SECTION FILE", OUTPUT),
    ignore("FACE PRINT", OUTPUT),
    ignore("INTEGRATED OUTPUT", OUTPUT),
    ignore("TIME POINTS", OUTPUT),
    ignore("PRINT", OUTPUT),
    ignore("NORMAL", "normals at nodes: those of rdsolve follow from the mesh, and folds keep theirs"),
    ignore("SPECIFIC HEAT", "no temperature changes"),
    ignore("CONDUCTIVITY", "no temperature changes"),
    ignore("USER OUTPUT VARIABLES", OUTPUT),
    ignore("NO ANALYSIS", "the other program only checks the file"),
    refuse("MEMBRANE SECTION", "rdsolve has no membranes"),
    refuse("SURFACE SECTION", "rdsolve has no surface elements"),
    refuse("COHESIVE SECTION", "rdsolve has no cohesive elements"),
    refuse("GASKET SECTION", "rdsolve has no gaskets"),
    refuse("FRAME SECTION", "rdsolve has no frame elements; use beams"),
    refuse("TRANSVERSE SHEAR STIFFNESS", "shear stiffness follows from the section; give shear_areas in the deck"),
    refuse("TRANSVERSE SHEAR", "shear stiffness follows from the section; give shear_areas in the deck"),
    refuse("HOURGLASS STIFFNESS", "elements of rdsolve have no hourglass modes"),
    refuse("CONTACT", CONTACT),
    refuse("CONTACT INCLUSIONS", CONTACT),
    refuse("CONTACT PROPERTY ASSIGNMENT", CONTACT),
    refuse("CONTACT DAMPING", CONTACT),
    refuse("CHANGE FRICTION", CONTACT),
    refuse("CHANGE SURFACE BEHAVIOR", CONTACT),
    refuse("CLEARANCE", CONTACT),
    refuse("CREEP", LAW),
    refuse("VISCO", "steps with creep are not translated"),
    refuse("HYPERELASTIC", LAW),
    refuse("HYPERFOAM", LAW),
    refuse("VISCOELASTIC", LAW),
    refuse("USER MATERIAL", LAW),
    refuse("DEPVAR", LAW),
    refuse("CYCLIC HARDENING", LAW),
    refuse("DEFORMATION PLASTICITY", LAW),
    refuse("MOHR COULOMB", LAW),
    refuse("MOHR COULOMB HARDENING", LAW),
    refuse("DRUCKER PRAGER", LAW),
    refuse("DAMAGE INITIATION", "failure is not translated; give `failure_strain` of [materials]"),
    refuse("DAMAGE EVOLUTION", "failure is not translated; give `failure_strain` of [materials]"),
    refuse("CHANGE MATERIAL", LAW),
    refuse("CHANGE PLASTIC", LAW),
    refuse("CHANGE SOLID SECTION", LAW),
    refuse(
        "CONNECTOR FRICTION",
        "friction in connectors is not translated; give `friction` or `friction_moment` of [[joints]]",
    ),
    refuse("CONNECTOR PLASTICITY", "plastic connectors are not translated; give `yield_moment` of [[joints]]"),
    refuse("CONNECTOR LOCK", "locks of connectors are not translated"),
    refuse("CONNECTOR FAILURE", "failing connectors are not translated; give `failure` of [[links]]"),
    refuse("CONNECTOR HARDENING", "plastic connectors are not translated; give `yield_moment` of [[joints]]"),
    refuse("CONNECTOR CONSTITUTIVE REFERENCE", "reference lengths of connectors are not translated"),
    refuse("HEAT TRANSFER", HEAT),
    refuse("COUPLED TEMPERATURE-DISPLACEMENT", HEAT),
    refuse("UNCOUPLED TEMPERATURE-DISPLACEMENT", HEAT),
    refuse("CFLUX", HEAT),
    refuse("DFLUX", HEAT),
    refuse("FILM", HEAT),
    refuse("RADIATE", HEAT),
    refuse("VIEWFACTOR", HEAT),
    refuse("GAP CONDUCTANCE", HEAT),
    refuse("GAP HEAT GENERATION", HEAT),
    refuse("FLUID SECTION", FLUID),
    refuse("FLUID SECTIONS", FLUID),
    refuse("FLUID CONSTANTS", FLUID),
    refuse("SPECIFIC GAS CONSTANT", FLUID),
    refuse("CFD", FLUID),
    refuse("BOUNDARYF", FLUID),
    refuse("TRANSFORMF", FLUID),
    refuse("EQUATIONF", FLUID),
    refuse("MASS FLOW", FLUID),
    refuse("VALUES AT INFINITY", FLUID),
    refuse("ELECTROMAGNETICS", FIELDS),
    refuse("ELECTRICAL CONDUCTIVITY", FIELDS),
    refuse("MAGNETIC PERMEABILITY", FIELDS),
    refuse("CYCLIC SYMMETRY MODEL", CYCLIC),
    refuse("SELECT CYCLIC SYMMETRY MODES", CYCLIC),
    refuse("GREEN", PIECES),
    refuse("SUBMODEL", PIECES),
    refuse("SUBSTRUCTURE GENERATE", PIECES),
    refuse("SUBSTRUCTURE MATRIX OUTPUT", PIECES),
    refuse("RETAINED NODAL DOFS", PIECES),
    refuse("SENSITIVITY", OPTIMIZE),
    refuse("OBJECTIVE", OPTIMIZE),
    refuse("CONSTRAINT", OPTIMIZE),
    refuse("DESIGNVARIABLES", OPTIMIZE),
    refuse("DESIGN RESPONSE", OPTIMIZE),
    refuse("DESIGN VARIABLES", OPTIMIZE),
    refuse("FEASIBLE DIRECTION", OPTIMIZE),
    refuse("NMAP", MESH),
    refuse("SYSTEM", MESH),
    refuse("PARAMETER", MESH),
    refuse("INCLUDE", "this file could not be included"),
    refuse("IMPORT", "results of another run are not read"),
    refuse("INERTIA RELIEF", "free bodies are not balanced; hold the structure or compute its motion"),
    refuse("VARIABLE MASS SCALING", "mass scaling is not translated; give `mass_scaling_step` of [integrator]"),
    refuse("EMBEDDED ELEMENT", "embedded elements are not translated"),
    refuse("FASTENER", "fasteners are not translated; use [[joints]] or [[links]]"),
    refuse("DISTRIBUTION", "distributions over elements are not translated"),
    refuse("ROBUST DESIGN", OPTIMIZE),
    refuse("CORRELATION LENGTH", OPTIMIZE),
    refuse("GEOMETRIC TOLERANCES", OPTIMIZE),
    refuse("RANDOM FIELD", OPTIMIZE),
    refuse("CRACK PROPAGATION", "cracks are not computed"),
    refuse("RELATIVE CONTACT DISPLACEMENT", CONTACT),
    refuse("MATRIX ASSEMBLE", PIECES),
    refuse("HCF", "rdsolve computes no fatigue"),
    refuse("FILTER", OPTIMIZE),
];

/// The row of a keyword, by its name without blanks.
pub fn row(key: &str) -> Option<&'static KeywordRow> {
    KEYWORDS.iter().find(|row| row.word.bytes().filter(|byte| *byte != b' ').eq(key.bytes()))
}

/// The table of keywords as a page: what becomes of each.
pub fn page() -> String {
    let mut page = String::from("| keyword | what becomes of it |\n|---|---|\n");
    let mut rows: Vec<&KeywordRow> = KEYWORDS.iter().collect();
    rows.sort_by_key(|row| row.word);
    for row in rows {
        let verdict = match row.treatment {
            Treatment::Read(_) => "",
            Treatment::Ignore => "ignored: ",
            Treatment::Refuse => "refused: ",
        };
        let _ = writeln!(page, "| `*{}` | {verdict}{} |", row.word, row.about);
    }
    page
}
