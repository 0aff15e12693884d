//! The step reads as the algorithm: the function that iterates is short, thresholds stand in one file, and few functions take the
//! whole workspace to write to.

use super::ratchet::{Known, compare};
use super::source::Source;
use std::collections::BTreeMap;
use syn::Type;
use syn::spanned::Spanned;
use syn::visit::Visit;

/// Lines of the function that iterates, its signature included. They may only become fewer.
const STEP: usize = 39;

/// Functions of `solve` that take the whole workspace to write to, by how many. They may only become fewer.
const WRITERS: Known = &[("solve", 169)];

/// Constants that are no thresholds: weights of formulas, and numbers that scatter.
const FORMULAS: Known = &[
    ("solve/control/intervals.rs: GOLDEN", 1),
    ("solve/modes/buckling.rs: DIFFERENCES", 1),
    ("solve/modes/matrices.rs: RATE", 1),
    ("solve/system/penalties.rs: INDEFINITE", 1),
];

pub fn the_step_is_short(source: &Source) {
    let file = source.files.iter().find(|file| file.path == "solve/step/newton.rs").expect("the iteration");
    let mut lines = Lines { of: "iterate", found: Vec::new() };
    file.items.iter().for_each(|item| lines.visit_item(item));
    assert_eq!(lines.found, [STEP], "lines of the step");
}

pub fn thresholds_stand_in_one_file(source: &Source) {
    let mut found = BTreeMap::new();
    for file in source.files.iter().filter(|file| file.path.starts_with("solve/") && file.path != "solve/tolerances.rs")
    {
        let mut constants = Constants::default();
        file.items.iter().for_each(|item| constants.visit_item(item));
        for name in constants.found {
            *found.entry(format!("{}: {name}", file.path)).or_insert(0) += 1;
        }
    }
    compare("thresholds outside of solve/tolerances.rs", FORMULAS, &found);
}

pub fn few_functions_take_the_workspace(source: &Source) {
    let mut writers = Writers(0);
    let files = source.files.iter().filter(|file| file.path.starts_with("solve/"));
    files.for_each(|file| file.items.iter().for_each(|item| writers.visit_item(item)));
    compare("functions with &mut Workspace", WRITERS, &BTreeMap::from([("solve".to_owned(), writers.0)]));
}

/// The lines of the functions of a name.
struct Lines<'l> {
    of: &'l str,
    found: Vec<usize>,
}

impl<'a> Visit<'a> for Lines<'_> {
    fn visit_impl_item_fn(&mut self, item: &'a syn::ImplItemFn) {
        if item.sig.ident == self.of {
            self.found.push(item.block.span().end().line - item.sig.fn_token.span.start().line + 1);
        }
    }
}

/// Constants that are numbers or arrays of numbers.
#[derive(Default)]
struct Constants {
    found: Vec<String>,
}

impl<'a> Visit<'a> for Constants {
    fn visit_item_const(&mut self, item: &'a syn::ItemConst) {
        let of = match &*item.ty {
            Type::Array(array) => &*array.elem,
            of => of,
        };
        if matches!(of, Type::Path(of) if of.path.is_ident("f64")) {
            self.found.push(item.ident.to_string());
        }
    }
}

/// The number of functions with the whole workspace to write to.
struct Writers(usize);

impl<'a> Visit<'a> for Writers {
    fn visit_signature(&mut self, signature: &'a syn::Signature) {
        let writes = |input: &syn::FnArg| {
            let syn::FnArg::Typed(input) = input else { return false };
            let Type::Reference(to) = &*input.ty else { return false };
            to.mutability.is_some() && matches!(&*to.elem, Type::Path(of) if of.path.is_ident("Workspace"))
        };
        self.0 += usize::from(signature.inputs.iter().any(writes));
    }
}
