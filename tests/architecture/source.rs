//! The source as a compiler sees it, as far as is needed here: files, their modules, and which file defines a name.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree, Visibility};

/// The crates below src, each in the folder of its name; what lies beside them is the program itself.
pub const CRATES: [&str; 10] =
    ["base", "linear", "mechanics", "deck", "import", "model", "solve", "results", "study", "sweep"];

/// Folders of a crate that are rooms of their own; the rest of a crate is the room of its name.
const ROOMS: [&str; 21] = [
    "math",
    "names",
    "quantities",
    "diagnostic",
    "words",
    "text_file",
    "snapshot",
    "state",
    "sections",
    "solids",
    "materials",
    "amplitude",
    "elements",
    "constraints",
    "integrators",
    "mesh",
    "record",
    "system",
    "plan",
    "modes",
    "tolerances",
];

/// The room that a path of names lies in, the crate's own where no room of it is named.
pub fn room_of<'a>(crate_name: &'a str, next: Option<&'a str>) -> &'a str {
    // A crate has rooms of its own: `model/names.rs` is no room.
    let holds = |name: &str| match crate_name {
        "base" | "mechanics" => ROOMS.contains(&name),
        "model" => ["mesh", "record"].contains(&name),
        "solve" => ["system", "plan", "modes", "tolerances"].contains(&name),
        _ => false,
    };
    next.filter(|name| holds(name)).unwrap_or(crate_name)
}

/// Lines of all sources below a folder of src.
pub fn lines_below(folder: &str) -> usize {
    let sources =
        files(&root().join("src").join(folder)).into_iter().filter(|path| path.extension().is_some_and(|e| e == "rs"));
    sources.map(|path| std::fs::read_to_string(path).expect("a file of text").lines().count()).sum()
}

/// A path of names from the root of all crates.
pub type Names = Vec<String>;

/// A file of src, without its tests.
pub struct File {
    /// Path below src.
    pub path: String,
    /// The module that the file is, its crate first.
    pub module: Names,
    pub items: Vec<Item>,
}

impl File {
    /// The room that the file stands in.
    pub fn room(&self) -> &str {
        let mut names = self.path.split('/').map(|name| name.trim_end_matches(".rs"));
        room_of(names.next().expect("a name"), names.next())
    }
}

/// What a name stands for in a module.
enum Meaning {
    Defined,
    Import { target: Names, shown: bool },
}

/// A module of a file: the file itself, or braces inside it.
struct Module {
    file: usize,
    meanings: HashMap<String, Meaning>,
    globs: Vec<Names>,
}

pub struct Source {
    pub files: Vec<File>,
    modules: HashMap<Names, Module>,
}

impl Source {
    /// All of src.
    pub fn read() -> Source {
        let root = root().join("src");
        let mut paths = files(&root);
        paths.sort();
        let files: Vec<File> = paths
            .iter()
            .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
            .map(|path| {
                let text = std::fs::read_to_string(path).expect("a file of text");
                let path = path.strip_prefix(&root).expect("below src").to_str().expect("UTF-8").to_string();
                let items = syn::parse_file(&text).unwrap_or_else(|error| panic!("{path}: {error}")).items;
                let module = path.trim_end_matches(".rs").split('/').map(String::from);
                let module = module.filter(|name| !["mod", "lib"].contains(&name.as_str())).collect();
                File { path, module, items: items.into_iter().filter(|item| !is_test(attributes(item))).collect() }
            })
            .collect();
        let mut source = Source { files, modules: HashMap::new() };
        for index in 0..source.files.len() {
            let (module, items) = (source.files[index].module.clone(), source.files[index].items.clone());
            source.enter(index, module, &items);
        }
        source
    }

    fn enter(&mut self, file: usize, module: Names, items: &[Item]) {
        let mut here = Module { file, meanings: HashMap::new(), globs: Vec::new() };
        for item in items {
            if let Some(name) = defined(item) {
                here.meanings.insert(name, Meaning::Defined);
            }
        }
        for (tree, shown) in uses(items) {
            for (name, target) in leaves(&tree, &[]) {
                let declared = items.iter().any(|item| matches!(item, Item::Mod(inner) if inner.ident == target[0]));
                let Some(target) = absolute(&module, &target, declared) else { continue };
                match name {
                    Some(name) => {
                        here.meanings.insert(name, Meaning::Import { target, shown });
                    }
                    None => here.globs.push(target),
                }
            }
        }
        for item in items {
            if let Item::Mod(inner) = item
                && let Some((_, items)) = &inner.content
                && !is_test(&inner.attrs)
            {
                self.enter(file, [&module[..], &[inner.ident.to_string()]].concat(), items);
            }
        }
        self.modules.insert(module, here);
    }

    /// The file that defines what a path names, through all re-exports, and its name there; nothing for modules and other
    /// crates.
    fn definition(&self, path: &[String], depth: usize) -> Option<(usize, String)> {
        if depth > 8 {
            return None;
        }
        let mut at: Names = Vec::new();
        for (n, name) in path.iter().enumerate() {
            let inner = [&at[..], std::slice::from_ref(name)].concat();
            let module = self.modules.get(&at)?;
            let last = n + 1 == path.len();
            let meaning = module.meanings.get(name);
            if !last && self.modules.contains_key(&inner) {
                at = inner;
                continue;
            }
            return match meaning {
                Some(Meaning::Defined) => Some((module.file, name.clone())),
                Some(Meaning::Import { target, .. }) => {
                    self.definition(&[&target[..], &path[n + 1..]].concat(), depth + 1)
                }
                None => {
                    module.globs.iter().find_map(|glob| self.definition(&[&glob[..], &path[n..]].concat(), depth + 1))
                }
            };
        }
        None
    }

    /// The other files of which a file uses something, and the names it uses.
    pub fn uses(&self, file: usize) -> BTreeMap<usize, BTreeSet<String>> {
        let mut found = References { paths: Vec::new(), inline: Vec::new() };
        let module = &self.files[file].module;
        self.files[file].items.iter().for_each(|item| found.visit_item(item));
        let mut used = BTreeMap::<usize, BTreeSet<String>>::new();
        let mut add = |target: Option<(usize, String)>| {
            if let Some((target, name)) = target.filter(|(target, _)| *target != file) {
                used.entry(target).or_default().insert(name);
            }
        };
        found.paths.iter().for_each(|path| add(self.seen_from(module, path)));
        // A trait is imported for its methods: an import that is not shown to others counts as use.
        for meaning in self.modules[module].meanings.values() {
            if let Meaning::Import { target, shown: false } = meaning {
                add(self.definition(target, 0));
            }
        }
        for (name, target) in &found.inline {
            add(self.seen_from(module, target));
            for path in found.paths.iter().filter(|path| Some(&path[0]) == name.as_ref()) {
                add(self.seen_from(module, &[&target[..], &path[1..]].concat()));
            }
        }
        used
    }

    /// The file that defines what a path in a module names, and its name there.
    pub fn seen_from(&self, module: &[String], path: &[String]) -> Option<(usize, String)> {
        let child = [module, &path[..1]].concat();
        let here = &self.modules[module];
        let local = self.modules.contains_key(&child) || here.meanings.contains_key(&path[0]);
        self.definition(&absolute(module, path, local)?, 0)
    }
}

/// The paths of a file, and imports inside its functions.
struct References {
    paths: Vec<Names>,
    inline: Vec<(Option<String>, Names)>,
}

impl<'a> Visit<'a> for References {
    fn visit_item(&mut self, item: &'a Item) {
        if !is_test(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        if matches!(item.vis, Visibility::Inherited) {
            self.inline.extend(leaves(&item.tree, &[]));
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        self.paths.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'a syn::Macro) {
        paths_of(call.tokens.clone(), &mut self.paths);
        visit::visit_macro(self, call);
    }
}

/// Paths in what a macro is given: names joined by `::`, and single ones with a capital.
fn paths_of(tokens: TokenStream, paths: &mut Vec<Names>) {
    let mut path: Names = Vec::new();
    let mut colons = 0;
    let mut end = |path: &mut Names| {
        let found = std::mem::take(path);
        if found.len() > 1 || found.first().is_some_and(|name| name.starts_with(char::is_uppercase)) {
            paths.push(found);
        }
    };
    let mut groups = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                if colons != 2 {
                    end(&mut path);
                }
                path.push(name.to_string());
                colons = 0;
            }
            TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
            TokenTree::Group(group) => {
                end(&mut path);
                colons = 0;
                groups.push(group.stream());
            }
            _ => {
                end(&mut path);
                colons = 0;
            }
        }
    }
    end(&mut path);
    groups.into_iter().for_each(|group| paths_of(group, paths));
}

/// A path from the root of all crates; `local`: its first name is known in the module.
fn absolute(module: &[String], path: &[String], local: bool) -> Option<Names> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        "crate" => {
            let own = module.first().filter(|name| CRATES.contains(&name.as_str()));
            Some(own.into_iter().chain(rest).cloned().collect())
        }
        "rdsolve" => Some(rest.to_vec()),
        "self" => Some([module, rest].concat()),
        "super" => {
            let above = rest.iter().take_while(|name| *name == "super").count();
            let base = module.len().checked_sub(1 + above)?;
            Some([&module[..base], &rest[above..]].concat())
        }
        name if !local && CRATES.contains(&name) => Some(path.to_vec()),
        // Children of the module, which are found from the module, and foreign crates.
        _ => Some([module, path].concat()),
    }
}

/// Names and what they import; a glob has no name.
fn leaves(tree: &UseTree, before: &[String]) -> Vec<(Option<String>, Names)> {
    let with = |name: &syn::Ident| [before, &[name.to_string()]].concat();
    match tree {
        UseTree::Path(path) => leaves(&path.tree, &with(&path.ident)),
        UseTree::Name(name) if name.ident == "self" => vec![(before.last().cloned(), before.to_vec())],
        UseTree::Name(name) => vec![(Some(name.ident.to_string()), with(&name.ident))],
        UseTree::Rename(rename) => vec![(Some(rename.rename.to_string()), with(&rename.ident))],
        UseTree::Glob(_) => vec![(None, before.to_vec())],
        UseTree::Group(group) => group.items.iter().flat_map(|tree| leaves(tree, before)).collect(),
    }
}

fn uses(items: &[Item]) -> Vec<(UseTree, bool)> {
    let imports = items.iter().filter_map(|item| if let Item::Use(import) = item { Some(import) } else { None });
    imports.map(|import| (import.tree.clone(), !matches!(import.vis, Visibility::Inherited))).collect()
}

fn defined(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        _ => return None,
    };
    Some(name.to_string())
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Whether something stands there for tests alone.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.parse_args::<syn::Ident>().is_ok_and(|condition| condition == "test")
    })
}

/// The folder of the crate: of the one that is tested, wherever this program was compiled.
pub fn root() -> PathBuf {
    std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from)
}

pub fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}
