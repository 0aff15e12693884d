//! Parameters that no reader asks for. Each is in the report: harmless ones in the row of their keyword, those that act on the motion here.

use crate::importer::Importer;
use crate::keyword_block::KeywordBlock;
use crate::keywords::KeywordRow;
use crate::verdicts::KeywordVerdict;
use base::text_file::cards::stands_for;

/// A parameter that changes the motion and has no reader.
struct UnreadParameter {
    /// The keywords that have it.
    keywords: &'static [&'static str],
    /// The parameter.
    name: &'static str,
    /// The values by which the deck computes the same.
    alike: &'static [&'static str],
    /// The verdict on other values, with its reason.
    verdict: KeywordVerdict,
    why: &'static str,
}

const fn changes(
    keywords: &'static [&'static str],
    name: &'static str,
    alike: &'static [&'static str],
    why: &'static str,
) -> UnreadParameter {
    UnreadParameter { keywords, name, alike, verdict: KeywordVerdict::Changed, why }
}

const fn refuses(
    keywords: &'static [&'static str],
    name: &'static str,
    alike: &'static [&'static str],
    why: &'static str,
) -> UnreadParameter {
    UnreadParameter { keywords, name, alike, verdict: KeywordVerdict::Refused, why }
}

const BEAMS: &[&str] = &["BEAMSECTION", "BEAMGENERALSECTION"];
const SHELLS: &[&str] = &["SHELLSECTION", "SHELLGENERALSECTION"];
const LOADS: &[&str] = &["DLOAD", "DSLOAD"];

/// Parameters that act on the motion.
const UNREAD: &[UnreadParameter] = &[
    refuses(
        BEAMS,
        "TEMPERATURE",
        &["GRADIENTS", "GRADIENT"],
        "temperatures of a section are a mean and gradients: give GRADIENTS",
    ),
    refuses(SHELLS, "TEMPERATURE", &[], "temperatures of a section are a mean and a gradient: leave it out"),
    changes(BEAMS, "POISSON", &["0", "0.", "0.0"], "sections keep their size; POISSON shrinks them at large strains"),
    changes(BEAMS, "ROTARYINERTIA", &["EXACT"], "beams have the rotary inertia of their section"),
    changes(SHELLS, "POISSON", &["MATERIAL"], "shells thin by their material; POISSON thins them at large strains"),
    changes(&["TIE"], "TYPE", &["NODETOSURFACE"], "each node is tied to a face; SURFACE TO SURFACE ties means"),
    changes(&["DISTRIBUTING"], "COUPLING", &["CONTINUUM"], "nodes take forces alone; STRUCTURAL gives them moments"),
    changes(&["CONTACTPAIR"], "WEIGHT", &[], "nodes of the first surface touch faces of the second one alone"),
    changes(&["CONTACTPAIR"], "SMOOTH", &["0", "0.", "0.0"], "faces are as the mesh has them; SMOOTH rounds them"),
    changes(&["CONTACTPAIR"], "CPSET", &[], "rdsolve chooses what CPSET names: stiffness and damping of contact"),
    changes(LOADS, "CONSTANTRESULTANT", &["YES"], "tractions are per area of the undeformed shape"),
    changes(&["FREQUENCY"], "RESIDUALMODES", &[], "no residual modes are added; give more modes"),
    refuses(
        &["COMPLEXFREQUENCY", "STEADYSTATEDYNAMICS"],
        "FRICTIONDAMPING",
        &["NO"],
        "friction does not damp modes here",
    ),
];

/// Judges the parameters that no reader has asked for: those that act on the motion, and those that are not known.
pub fn judge(im: &mut Importer, block: &KeywordBlock, row: &KeywordRow) {
    let line = block.keyword.line;
    // A reader that refuses its keyword asks for no more.
    let is_refused = im.verdicts.is_refused(line);
    for (name, value) in block.keyword.unread().filter(|(name, _)| !row.has_harmless(name)) {
        match unread(block, name) {
            Some(of) if of.is_alike(value) => {}
            Some(of) => im.verdicts.add(im.text, of.verdict, line, None, format!("{}: {}", of.name, of.why)),
            None if is_refused => {}
            None => im.refuse(line, &format!("{name} of *{} is not read", block.keyword.name)),
        }
    }
}

/// Reports the harmless parameters that no reader has asked for.
pub fn report(im: &mut Importer, block: &KeywordBlock, row: &KeywordRow) {
    let line = block.keyword.line;
    if im.verdicts.is_refused(line) {
        return;
    }
    let is_alike = |name: &str, value: &str| unread(block, name).is_some_and(|of| of.is_alike(value));
    for (name, _) in block.keyword.unread().filter(|(name, value)| row.has_harmless(name) || is_alike(name, value)) {
        im.verdicts.unread.insert(format!("{name} of *{}", block.keyword.name));
        im.ignore(line, &format!("{name} is not read, and does not act on the motion"));
    }
}

/// The row of a parameter that acts on the motion.
fn unread(block: &KeywordBlock, name: &str) -> Option<&'static UnreadParameter> {
    let key = block.keyword.key();
    UNREAD.iter().find(|of| of.keywords.contains(&&*key) && stands_for(name, of.name))
}

impl UnreadParameter {
    fn is_alike(&self, value: &str) -> bool {
        self.alike.contains(&&*value.to_ascii_uppercase())
    }
}
