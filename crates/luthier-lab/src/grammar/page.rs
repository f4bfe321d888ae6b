//! The page about the grammar.

use std::fmt::Write;

use luthier_material::KeyReference;
use luthier_terminal::Outcome;

use super::samples::Sample;
use super::{Entry, Sight, models};

/// Folder of the pictures, seen from the page.
const PICTURES: &str = "images/grammar";

const HEAD: &str = "\
# The grammar, key by key

Made by `luthier-lab grammar -o docs/grammar.md` from the tables that `luthier check` goes by; `--pictures docs/images/grammar` renders the pictures. \
[Material files](materials.md) explains how the keys work together, and `luthier schema` prints this grammar as JSON Schema.

A **unit** of 1 means a pure number. Lists of three numbers are R, G and B, linear Rec.709, where no other order is given. A **default** is the value of a key that is \
absent. Under each picture stand the values of the key from left to right. *Shown by* lists the models whose shaders show the key; `luthier check` warns of a key \
that the model of a file leaves out. Most pictures are by the model `elek`, which needs no simulation; the files are in \
`luthier-lab/src/grammar/samples`.

";

/// The page.
pub(crate) fn write(entries: &[Entry]) -> Outcome<String> {
    let mut page = HEAD.to_owned();
    let count =
        |is: fn(&Sight) -> bool| entries.iter().flat_map(|entry| &entry.sights).filter(|sight| is(sight)).count();
    let (strips, nothing) =
        (count(|sight| matches!(sight, Sight::Strip(_))), count(|sight| matches!(sight, Sight::Nothing(_))));
    let _ = writeln!(
        page,
        "The grammar has {} keys in {} tables. {strips} have pictures here, {nothing} have nothing to see, and the page says why. The others are keys of two tables or more, and stand under the first.\n",
        entries.iter().map(|entry| entry.table.keys.len()).sum::<usize>(),
        entries.len(),
    );
    for entry in entries {
        of_table(&mut page, entry)?;
    }
    Ok(page.trim_end().to_owned() + "\n")
}

fn of_table(page: &mut String, entry: &Entry) -> Outcome {
    let table = &entry.table;
    let _ = writeln!(page, "## {}\n\n{}", table.name, table.doc);
    for sentence in &table.alternatives {
        let _ = writeln!(page, "\n{sentence}");
    }
    let shared: Vec<String> = table
        .keys
        .iter()
        .zip(&entry.sights)
        .filter_map(|(key, sight)| match sight {
            Sight::As(owner) => Some(format!("[`{}`](#{})", key.name, anchor(key.name, owner))),
            _ => None,
        })
        .collect();
    if !shared.is_empty() {
        let _ = writeln!(page, "\nAs above: {}.", shared.join(", "));
    }
    page.push('\n');
    for (key, sight) in table.keys.iter().zip(&entry.sights) {
        match sight {
            Sight::As(_) => continue,
            Sight::Strip(sample) => {
                of_key(page, table.name, key);
                of_strip(page, key, sample)?;
            }
            Sight::Nothing(why) => {
                of_key(page, table.name, key);
                let _ = writeln!(page, "Nothing to see: {why}.\n");
            }
        }
    }
    Ok(())
}

fn of_key(page: &mut String, table: &str, key: &KeyReference) {
    let unit = key.unit.unwrap_or("–");
    let _ = write!(
        page,
        "### `{}` of {table}\n\n{}\n\n| value | unit | default |\n|---|---|---|\n| {} | {unit} | {} |\n\n",
        key.name, key.doc, key.value, key.default
    );
}

fn of_strip(page: &mut String, key: &KeyReference, sample: &Sample) -> Outcome {
    let labels: Vec<String> = sample.labels().map(label).collect();
    let _ = writeln!(page, "![{}]({PICTURES}/{})\n", key.name, sample.picture());
    let _ = writeln!(page, "{}. {}\n", labels.join(" · "), models::sentence(sample)?);
    Ok(())
}

/// A value as files have it; words of people stay words.
fn label(value: &str) -> String {
    let is_words = value != "true" && value.starts_with(|c: char| c.is_ascii_alphabetic());
    if is_words { value.to_owned() } else { format!("`{}`", value.replace('\'', "\"")) }
}

/// Anchor of a key's heading, as Markdown makes it.
fn anchor(key: &str, table: &str) -> String {
    format!("{key}-of-{table}")
}
