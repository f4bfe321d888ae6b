//! `grammar`: the reference of every key of material, surface and scene files, with a strip of pictures for each that can be seen.

mod models;
mod page;
mod samples;
mod strips;

use luthier_material::{KeyReference, TableReference, reference};
use luthier_terminal::{Failure, Outcome, deliver};

use crate::cli::GrammarOptions;
use samples::{Sample, UNSEEN, samples};

/// Writes the page, after the pictures if a folder for them is named.
pub(crate) fn run(options: &GrammarOptions) -> Outcome {
    let entries = entries(&reference(), &samples())?;
    if let Some(folder) = &options.pictures {
        strips::render(&shown(&entries), folder, options)?;
    }
    deliver(&page::write(&entries)?, options.destination.output.as_deref())
}

/// A table, with the sights of its keys.
pub(crate) struct Entry {
    table: TableReference,
    sights: Vec<Sight>,
}

/// The sight of a key: pictures, or the reason why there are none.
pub(crate) enum Sight {
    /// Pictures.
    Strip(Sample),
    /// Nothing, for a reason.
    Nothing(&'static str),
    /// The key is one of an earlier table, too.
    As(&'static str),
}

/// The samples that the page shows, in its order.
pub(crate) fn shown(entries: &[Entry]) -> Vec<Sample> {
    let sights = entries.iter().flat_map(|entry| &entry.sights);
    sights.filter_map(|sight| if let Sight::Strip(sample) = sight { Some(*sample) } else { None }).collect()
}

/// Every table with a sight for each of its keys.
///
/// # Errors
/// Keys that have no sight or two, and samples and reasons for keys that do not exist.
fn entries(tables: &[TableReference], samples: &[Sample]) -> Outcome<Vec<Entry>> {
    let mut wrong = Vec::new();
    let mut used = vec![false; samples.len()];
    let mut entries: Vec<Entry> = Vec::new();
    for table in tables {
        let mut sights = Vec::new();
        for key in &table.keys {
            let name = format!("{}.{}", table.name, key.name);
            let earlier = entries.iter().find(|entry| is_shared(&entry.table, table, key));
            let sample = samples.iter().position(|sample| sample.key == name);
            let why = UNSEEN.iter().find(|unseen| unseen.keys.iter().any(|listed| covers(listed, &name)));
            sights.push(match (earlier, sample, why) {
                (Some(entry), None, None) => Sight::As(entry.table.name),
                (None, Some(number), None) => {
                    used[number] = true;
                    Sight::Strip(samples[number])
                }
                (None, None, Some(unseen)) => Sight::Nothing(unseen.why),
                (None, None, None) => {
                    wrong.push(format!("`{name}` has neither a sample nor a reason why there is nothing to see"));
                    Sight::Nothing("")
                }
                _ => {
                    wrong.push(format!("`{name}` has more than one sample or reason"));
                    Sight::Nothing("")
                }
            });
        }
        entries.push(Entry { table: table.clone(), sights });
    }
    let keys = tables.iter().flat_map(|table| table.keys.iter().map(move |key| format!("{}.{}", table.name, key.name)));
    let keys: Vec<String> = keys.collect();
    let unused = samples.iter().zip(used).filter(|(_, used)| !used).map(|(sample, _)| sample.key);
    wrong.extend(unused.map(|key| format!("a sample is of `{key}`, which has no place of its own")));
    let reasons = UNSEEN.iter().flat_map(|unseen| unseen.keys);
    let reasons = reasons.filter(|listed| !keys.iter().any(|key| covers(listed, key)));
    wrong.extend(reasons.map(|listed| format!("a reason is of `{listed}`, which does not exist")));
    if wrong.is_empty() { Ok(entries) } else { Err(Failure::Input(anyhow::anyhow!(wrong.join("\n")))) }
}

/// Whether a list names a key, by itself or with all of its table.
fn covers(listed: &str, name: &str) -> bool {
    listed == name || listed.strip_suffix('*').is_some_and(|table| name.starts_with(table))
}

/// Whether a key is one of an earlier table of the same family, word for word.
fn is_shared(earlier: &TableReference, table: &TableReference, key: &KeyReference) -> bool {
    let [earlier_family, family] = [earlier.name, table.name].map(|name| match name {
        "dielectric" | "conductor" | "diffuse" | "metallic-roughness" => "layers",
        name if name.ends_with("-maps") => "maps",
        "picture" | "map" | "flake-heights" => "pictures",
        name => name,
    });
    earlier_family == family && earlier.keys.contains(key)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every new key of the grammar needs a sample, or a reason why there is nothing to see.
    #[test]
    fn a_key_without_a_sample_is_told() {
        let all = samples();
        let tables = reference();
        assert!(entries(&tables, &all).is_ok_and(|entries| entries.len() == tables.len()));
        let Err(Failure::Input(error)) = entries(&tables, &all[1..]) else { panic!("nothing was missed") };
        assert!(error.to_string().contains(&format!("`{}` has neither", all[0].key)), "{error}");
    }

    /// The pictures of the page are of the samples as they are; `scripts/pages.sh grammar` renders them.
    #[test]
    fn pictures_are_of_these_samples() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images/grammar");
        let Ok(entries) = entries(&reference(), &samples()) else { panic!("a key is missing") };
        let shown = shown(&entries);
        let kept = std::fs::read_to_string(folder.join(strips::HASHES)).unwrap().replace("\r\n", "\n");
        assert_eq!(kept, strips::hashes(&shown));
        let pictures = std::fs::read_dir(folder).unwrap().count() - 1;
        assert_eq!(pictures, shown.len(), "pictures of no sample");
    }

    /// A file of a sample differs from the next in the value, and all are materials or surfaces.
    #[test]
    fn samples_differ() {
        for sample in samples() {
            let texts = sample.texts();
            assert!(texts.len() >= 2 && sample.text.contains('@'), "{}", sample.key);
            assert!((1..texts.len()).all(|i| !texts[..i].contains(&texts[i])), "{}", sample.key);
        }
    }
}
