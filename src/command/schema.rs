//! `rdsolve schema`: the JSON Schema of the deck, or of the file of a sweep, for completion and checks in editors; and the columns of results.

use base::quantities::{Column, UNIT_SYSTEMS};
use clap::Args;
use serde_json::{Map, Value, json};

use super::console::print;
use super::exit::Exit;
use deck::{Deck, aliases};
use results::tables::TABLES;
use sweep::file::SCHEMA;

#[derive(Debug, Args)]
pub struct SchemaArgs {
    /// The schema of the file that `rdsolve sweep` reads
    #[arg(long)]
    sweep: bool,
    /// The columns of the tables of results instead, with meaning, sign, and unit by system of units
    #[arg(long, conflicts_with = "sweep")]
    results: bool,
}

/// Prints a JSON Schema on standard output.
///
/// # Errors
/// [`Exit::InputOutput`] where standard output cannot be written.
pub fn schema(args: &SchemaArgs) -> Result<(), Exit> {
    if args.sweep {
        return print(SCHEMA);
    }
    if args.results {
        let text = serde_json::to_string_pretty(&columns()).map_err(|_| Exit::Internal)?;
        return print(&format!("{text}\n"));
    }
    let mut schema = schemars::schema_for!(Deck).to_value();
    aliases::describe(&mut schema);
    without_null(&mut schema);
    let text = serde_json::to_string_pretty(&schema).map_err(|_| Exit::Internal)?;
    print(&format!("{text}\n"))
}

/// The columns of each table by its file. A unit in words has the empty name.
fn columns() -> Value {
    let units = |column: &Column| {
        let words = (String::new(), Value::from(column.unit.text(None)));
        let systems = UNIT_SYSTEMS.iter().map(|system| (system.name.to_owned(), column.unit.text(Some(system)).into()));
        Value::Object(std::iter::once(words).chain(systems).collect())
    };
    let column = |column: Column| {
        let about = json!({ "meaning": column.meaning, "sign": column.sign, "unit": units(&column) });
        (column.name.to_owned(), about)
    };
    let tables =
        TABLES.iter().map(|table| (table.file.to_owned(), table.columns().map(column).collect::<Map<_, _>>().into()));
    Value::Object(tables.collect())
}

/// Takes `null` out of a schema: a key of the deck may be left out, but cannot be null, for TOML has none.
fn without_null(schema: &mut Value) {
    let is_null = |value: &Value| *value == "null" || value.get("type").is_some_and(|kind| kind == "null");
    match schema {
        Value::Object(entries) => {
            for key in ["type", "anyOf"] {
                let Some(Value::Array(options)) = entries.get_mut(key) else { continue };
                options.retain(|option| !is_null(option));
                if options.len() > 1 {
                    continue;
                }
                match entries.remove(key).and_then(|mut options| options.as_array_mut()?.pop()) {
                    Some(Value::Object(only)) => only.into_iter().for_each(|(key, value)| {
                        // The description of the key says more than that of its type.
                        entries.entry(key).or_insert(value);
                    }),
                    Some(only) => entries.extend([(key.to_owned(), only)]),
                    None => {}
                }
            }
            entries.values_mut().for_each(without_null);
        }
        Value::Array(list) => list.iter_mut().for_each(without_null),
        _ => {}
    }
}
