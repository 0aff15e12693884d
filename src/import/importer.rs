//! The content of a file read so far, and how its lines are read.

use crate::dialect::Dialect;
use crate::file_content::{
    AmplitudeCard, ConnectorCards, ConstraintCards, MaterialCards, PropertyCard, SectionCard, StepCards,
};
use crate::scopes::{NamedTarget, Scopes};
use crate::verdicts::{KeywordVerdict, Verdicts};
use base::math::Vec3;
use base::text_file::cards::{Data, name_in};
use base::text_file::{Text, Word};
use std::collections::HashMap;

/// A system of axes: local 1 and a vector in the plane of 1 and 2; `None` where it is not Cartesian.
pub type SystemOfAxes = Option<[Vec3; 2]>;

/// A file as far as it has been read.
pub struct Importer<'a, 't> {
    /// The file, which draws messages.
    pub text: &'a Text<'t>,
    /// The verdicts on its lines.
    pub verdicts: Verdicts,
    /// The program that the file is for, if that is known.
    pub dialect: Option<Dialect>,
    /// The first line of `*HEADING`.
    pub title: String,
    /// Nodes, elements and sets.
    pub scopes: Scopes,
    /// Systems of axes by name in small letters.
    pub axes: HashMap<String, SystemOfAxes>,
    /// Lines of systems of axes that stand in parts, with the index of the part.
    pub axes_of_parts: Vec<(usize, usize)>,
    /// Materials.
    pub materials: MaterialCards,
    /// Sections of beams, shells and bars.
    pub sections: Vec<SectionCard>,
    /// Thickness of shells at nodes.
    pub thicknesses: Vec<(NamedTarget, f64)>,
    /// Masses, springs, dampers and gaps.
    pub properties: Vec<PropertyCard>,
    /// Rigid bodies, couplings and other constraints.
    pub constraints: ConstraintCards,
    /// Connectors.
    pub connectors: ConnectorCards,
    /// Functions of time.
    pub amplitudes: Vec<AmplitudeCard>,
    /// The loads of each step.
    pub steps: StepCards,
}

impl<'a, 't> Importer<'a, 't> {
    /// An importer before the first line.
    pub fn new(text: &'a Text<'t>, verdicts: Verdicts, dialect: Option<Dialect>, scopes: Scopes) -> Self {
        Importer {
            text,
            verdicts,
            dialect,
            title: String::new(),
            scopes,
            axes: HashMap::new(),
            axes_of_parts: Vec::new(),
            materials: MaterialCards::default(),
            sections: Vec::new(),
            thicknesses: Vec::new(),
            properties: Vec::new(),
            constraints: ConstraintCards::default(),
            connectors: ConnectorCards::default(),
            amplitudes: Vec::new(),
            steps: StepCards::default(),
        }
    }
}

impl Importer<'_, '_> {
    /// Refuses a line.
    pub fn refuse(&mut self, line: usize, why: &str) {
        self.verdicts.add(self.text, KeywordVerdict::Refused, line, None, why.to_owned());
    }

    /// Refuses a word.
    pub fn refuse_at(&mut self, word: &Word, why: &str) {
        self.verdicts.at(self.text, KeywordVerdict::Refused, word, why.to_owned());
    }

    /// True after a refusal: a missing name may then stand in a refused line.
    pub fn is_incomplete(&self) -> bool {
        self.verdicts.count(KeywordVerdict::Refused) > 0
    }

    /// Says that a line is computed otherwise, and how.
    pub fn change(&mut self, line: usize, how: &str) {
        self.verdicts.add(self.text, KeywordVerdict::Changed, line, None, how.to_owned());
    }

    /// Says that a line does not act on the motion.
    pub fn ignore(&mut self, line: usize, why: &str) {
        self.verdicts.add(self.text, KeywordVerdict::Ignored, line, None, why.to_owned());
    }

    /// The number of a node or an element; refuses other words.
    pub fn id(&mut self, data: &Data, at: usize) -> Option<u64> {
        match data.words.get(at) {
            Some(word) => {
                let id = word.whole().filter(|id| *id <= u64::from(u32::MAX));
                if id.is_none() {
                    self.refuse_at(word, "this must be a whole number");
                }
                id
            }
            None => {
                self.refuse(data.line, "this line lacks a number");
                None
            }
        }
    }

    /// A number of a line; `None` where the field is blank or missing, or refused as no number.
    pub fn number_at(&mut self, data: &Data, at: usize) -> Option<f64> {
        let word = data.words.get(at).filter(|word| !word.bytes.is_empty())?;
        let number = word.fortran_number();
        if number.is_none() {
            self.refuse_at(word, "this must be a number");
        }
        number
    }

    /// All numbers of a line, blank ones as zero.
    pub fn numbers(&mut self, data: &Data) -> Vec<f64> {
        (0..data.filled()).map(|at| self.number_at(data, at).unwrap_or(0.0)).collect()
    }

    /// Nodes or elements that a field names.
    pub fn target(&self, word: &Word) -> NamedTarget {
        NamedTarget { scope: self.scopes.at, name: name_in(word), is_set: false, line: word.line }
    }

    /// The set that a parameter names.
    pub fn set_target(&self, name: &str, line: usize) -> NamedTarget {
        NamedTarget { scope: self.scopes.at, name: name.to_owned(), is_set: true, line }
    }

    /// The node that `P-1.3` stands for.
    pub fn node_of_instance(&self, word: &Word) -> Option<u64> {
        let name = name_in(word);
        let (instance, id) = name.split_once('.')?;
        let offset = self.scopes.instances[self.scopes.instance(instance)?].offset;
        Some(self.scopes.shifted(id.parse().ok()?, offset))
    }
}
