//! What one can hold in one's head: public fields of a struct, files with methods of a type, lines of a function.

use super::ratchet::{Known, compare};
use super::source::{File, Source};
use std::collections::{BTreeMap, BTreeSet};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Item, Visibility};

/// Structs with more public fields than that are listed.
const FIELDS: usize = 15;
/// Types with methods in more files than that are listed.
const FILES: usize = 3;
/// Functions with more lines than that are listed.
const LINES: usize = 60;

/// Plain data: what a deck says or means, and what a step writes to.
const WIDE: Known = &[
    ("deck/amplitudes.rs: Amplitude", 19),
    ("deck/analysis.rs: Analysis", 20),
    ("deck/beams.rs: Beam", 24),
    ("deck/expect.rs: Expect", 16),
    ("deck/joints.rs: Joint", 25),
    ("deck/links.rs: Link", 31),
    ("deck/lib.rs: Deck", 39),
    ("deck/loads.rs: Load", 21),
    ("deck/shells.rs: Shell", 19),
    ("deck/stages.rs: Stage", 20),
    ("import/build.rs: Build", 16),
    ("import/file_content.rs: StepCard", 16),
    ("model/data/model.rs: Model", 18),
    ("model/data/output.rs: Output", 17),
    ("results/result_json.rs: RunResult", 18),
    ("solve/derived.rs: Derived", 16),
    ("solve/frame.rs: Frame", 17),
    ("solve/workspace.rs: Workspace", 17),
    ("solve/system/energy.rs: Energy", 16),
];

/// Types whose methods stand in many files: forces, inertia and inner nodes of superelements are rooms of their own.
const SCATTERED: Known = &[("mechanics/elements/superelement/mod.rs: FloatingElement", 4)];

/// Tables of numbers and formulas, which are read line by line; and what is still to be taken apart.
const LONG: Known = &[("base/math/quadrature.rs: gauss", 132)];

pub fn structs_have_few_public_fields(source: &Source) {
    let mut found = BTreeMap::new();
    for file in &source.files {
        for item in &file.items {
            if let Item::Struct(item) = item {
                let public = item.fields.iter().filter(|field| !matches!(field.vis, Visibility::Inherited)).count();
                if public > FIELDS {
                    found.insert(format!("{}: {}", file.path, item.ident), public);
                }
            }
        }
    }
    compare("public fields", WIDE, &found);
}

pub fn methods_of_a_type_stand_together(source: &Source) {
    let mut files = BTreeMap::<String, BTreeSet<&str>>::new();
    for file in &source.files {
        for item in &file.items {
            if let Item::Impl(item) = item
                && item.trait_.is_none()
                && let syn::Type::Path(of) = &*item.self_ty
            {
                let names: Vec<String> = of.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
                let (home, name) = source.seen_from(&file.module, &names).expect("a type of this crate");
                files.entry(format!("{}: {name}", source.files[home].path)).or_default().insert(&file.path);
            }
        }
    }
    files.retain(|_, files| files.len() > FILES);
    let found = files.into_iter().map(|(name, files)| (name, files.len())).collect();
    compare("files with methods of a type", SCATTERED, &found);
}

pub fn functions_are_short(source: &Source) {
    let mut found = BTreeMap::new();
    for file in &source.files {
        let mut functions = Functions { file, long: Vec::new() };
        file.items.iter().for_each(|item| functions.visit_item(item));
        for (name, lines) in functions.long {
            let most = found.entry(name).or_insert(0);
            *most = lines.max(*most);
        }
    }
    compare("lines of functions", LONG, &found);
}

/// Functions of a file that are too long.
struct Functions<'f> {
    file: &'f File,
    long: Vec<(String, usize)>,
}

impl Functions<'_> {
    fn weigh(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let lines = block.span().end().line - signature.fn_token.span.start().line + 1;
        if lines > LINES {
            self.long.push((format!("{}: {}", self.file.path, signature.ident), lines));
        }
    }
}

impl<'a> Visit<'a> for Functions<'_> {
    fn visit_item_fn(&mut self, item: &'a syn::ItemFn) {
        self.weigh(&item.sig, &item.block);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'a syn::ImplItemFn) {
        self.weigh(&item.sig, &item.block);
        visit::visit_impl_item_fn(self, item);
    }
}
