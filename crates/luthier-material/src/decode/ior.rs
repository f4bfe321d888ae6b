//! Decoder of indices: numbers, samples, files and built-in data sets.

use std::ops::Range as Span;

use luthier_optics::color::VISIBLE_NM;
use luthier_optics::constants::{dataset, datasets};
use luthier_optics::index_file::{IndexFile, IndexFileError, csv, yaml};
use luthier_optics::ior::{Ior, IorError, IorSample};
use toml::Spanned;
use toml::de::DeValue;

use crate::diagnostic::Sink;
use crate::doubt::Sources;
use crate::section::{Numbers, Section, section};
use crate::suggest::{did_you_mean, short};

/// Reads a file that a material refers to, by its path relative to the material file.
pub(super) type Read<'r> = &'r dyn Fn(&str) -> std::io::Result<String>;

/// The index under `key`, or `None` when it is absent or wrong.
pub(super) fn decode(
    at: &Section<'_>,
    key: &str,
    read: Read<'_>,
    sink: &mut Sink<'_>,
    sources: &mut Sources,
) -> Option<Ior> {
    let value = at.value(key)?;
    let ior = of_any_form(value, at, key, read, sink, sources)?;
    let (first, last) = (ior.samples().first()?.wavelength_nm, ior.samples().last()?.wavelength_nm);
    let (low, high) = VISIBLE_NM;
    if last < low || first > high {
        let message =
            format!("no sample of this index is visible: they lie from {} to {} nm", short(first), short(last));
        let hint = format!("give samples from {low} to {high} nm; a single index is written `{key} = 1.5`");
        sink.error(value.span(), message, Some(hint));
    }
    Some(ior)
}

/// Reports an index of 0: no light enters such a medium.
pub(super) fn check_clear(ior: &Ior, at: &Section<'_>, key: &str, sink: &mut Sink<'_>) {
    if let Some(sample) = ior.samples().iter().find(|sample| sample.n == 0.0) {
        let message =
            format!("n is 0 at {} nm, which is that of a metal: no light enters", short(sample.wavelength_nm));
        sink.error(at.value_span(key), message, Some("was `type = \"conductor\"` meant?".to_owned()));
    }
}

/// Samples that cover this middle of the visible range stand for all of it.
const MIDDLE_NM: (f64, f64) = (500.0, 600.0);

fn of_any_form(
    value: &Spanned<DeValue<'_>>,
    at: &Section<'_>,
    key: &str,
    read: Read<'_>,
    sink: &mut Sink<'_>,
    sources: &mut Sources,
) -> Option<Ior> {
    if let Some(number) = at.number(key) {
        return Ior::constant(number, 0.0).ok();
    }
    if let Some(text) = at.text(key) {
        let ior = by_name(text, value.span(), read, sink)?;
        if let Some(range) = ior.range_nm() {
            sources.spectra.push((text.to_owned(), range, value.span()));
        }
        return Some(ior);
    }
    let ior = sampled(&section(value)?, sink)?;
    if let Some(range) = ior.range_nm().filter(|(first, last)| *first > MIDDLE_NM.0 || *last < MIDDLE_NM.1) {
        sources.spectra.push((key.to_owned(), range, value.span()));
    }
    Some(ior)
}

/// `{ n, k, wavelengths_nm }`.
fn sampled(at: &Section<'_>, sink: &mut Sink<'_>) -> Option<Ior> {
    let n = at.numbers("n")?;
    let k = if at.has("k") { at.numbers("k")? } else { Numbers::One(0.0) };
    let wavelengths = match at.numbers("wavelengths_nm") {
        Some(Numbers::Many(w)) => w,
        Some(Numbers::One(_)) => return None,
        None => {
            if let (Numbers::One(n), Numbers::One(k)) = (&n, &k) {
                return checked(Ior::constant(*n, *k), at, "n", sink);
            }
            let list = if matches!(n, Numbers::Many(_)) { "n" } else { "k" };
            if !at.has("wavelengths_nm") {
                let hint = "say where they were sampled: `wavelengths_nm = [690, 550, 450]`";
                sink.error(at.value_span(list), "a list needs its wavelengths", Some(hint.to_owned()));
            }
            return None;
        }
    };
    if let (Numbers::One(_), Numbers::One(_)) = (&n, &k) {
        let hint = "leave them out: the index is constant".to_owned();
        sink.error(at.key_span("wavelengths_nm"), "wavelengths without a list of n or k", Some(hint));
        return None;
    }
    let n = as_many("n", n, &wavelengths, at, sink)?;
    let k = as_many("k", k, &wavelengths, at, sink)?;

    let mut samples: Vec<IorSample> = wavelengths
        .iter()
        .zip(n.iter().zip(&k))
        .map(|(&wavelength_nm, (&n, &k))| IorSample { wavelength_nm, n, k })
        .collect();
    samples.sort_by(|a, b| a.wavelength_nm.total_cmp(&b.wavelength_nm));
    checked(Ior::sampled(samples), at, "wavelengths_nm", sink)
}

/// The index of a table, or an error at one of its keys, unless one is reported already.
fn checked(ior: Result<Ior, IorError>, at: &Section<'_>, key: &str, sink: &mut Sink<'_>) -> Option<Ior> {
    ior.map_err(|error| {
        if !sink.has_error_in(&at.span) {
            let hint = matches!(error, IorError::NotPhysical { .. }).then(|| "vacuum has n = 1".to_owned());
            sink.error(at.value_span(key), error.to_string(), hint);
        }
    })
    .ok()
}

fn as_many(
    name: &str,
    numbers: Numbers,
    wavelengths: &[f64],
    at: &Section<'_>,
    sink: &mut Sink<'_>,
) -> Option<Vec<f64>> {
    match numbers {
        Numbers::One(value) => Some(vec![value; wavelengths.len()]),
        Numbers::Many(values) if values.len() == wavelengths.len() => Some(values),
        Numbers::Many(values) => {
            let message = format!("{} values of `{name}` for {} wavelengths", values.len(), wavelengths.len());
            sink.error(at.value_span(name), message, Some("give one value for each wavelength".to_owned()));
            None
        }
    }
}

/// The text of a file that the material names.
pub(super) fn named_text(name: &str, span: &Span<usize>, read: Read<'_>, sink: &mut Sink<'_>) -> Option<String> {
    let text = read(name).map_err(|error| {
        let hint = "the path is relative to the material file".to_owned();
        sink.error(span.clone(), format!("cannot read `{name}`: {error}"), Some(hint));
    });
    text.ok()
}

/// A file, or a built-in data set.
fn by_name(name: &str, span: Span<usize>, read: Read<'_>, sink: &mut Sink<'_>) -> Option<Ior> {
    if let Some(parse) = reader(name) {
        let text = named_text(name, &span, read, sink)?;
        return match parse(&text) {
            Ok(IndexFile { ior, notes }) => {
                notes.iter().for_each(|note| sink.warn(span.clone(), format!("`{name}`: {note}"), None));
                Some(ior)
            }
            Err(error) => {
                sink.error(span, format!("`{name}`: {error}"), Some(error.hint()));
                None
            }
        };
    }
    if let Some(set) = dataset(name) {
        return Some(set.ior.clone());
    }
    if name.is_empty() {
        return None;
    }
    let hint = match nearest_dataset(name) {
        Some((id, called)) => format!("did you mean `\"{id}\"` ({called})?"),
        None if name.parse::<f64>().is_ok() => format!("write the number {} without quotes", short(name.parse().ok()?)),
        None => "`luthier ior` lists the data sets; a path must end in `.csv`, `.yml` or `.yaml`".to_owned(),
    };
    sink.error(span, format!("there is no data set `{name}`"), Some(hint));
    None
}

type Reader = fn(&str) -> Result<IndexFile, IndexFileError>;

/// Reads the file that a path names, by its ending; `None` for the name of a data set.
fn reader(name: &str) -> Option<Reader> {
    let (_, ending) = name.rsplit_once('.')?;
    match ending.to_ascii_lowercase().as_str() {
        "csv" => Some(csv),
        "yml" | "yaml" => Some(yaml),
        _ => None,
    }
}

/// The data set that a name probably means: by id, or by what people call it.
fn nearest_dataset(name: &str) -> Option<(&'static str, &'static str)> {
    let lower = name.to_lowercase();
    let called = datasets().iter().filter(|set| {
        let name = set.name.to_lowercase();
        name.split(|c: char| !c.is_alphanumeric()).any(|word| word.len() > 2 && word == lower)
    });
    if let Some(set) = datasets().iter().filter(|set| set.id == lower).chain(called).next() {
        return Some((set.id, set.name));
    }
    let words = datasets().iter().flat_map(|d| {
        std::iter::once(d.id).chain(d.name.split(|c: char| !c.is_alphanumeric()).filter(|w| w.len() > 2))
    });
    let word = did_you_mean(name, words)?;
    let set =
        datasets().iter().find(|d| d.id == word || d.name.split(|c: char| !c.is_alphanumeric()).any(|w| w == word))?;
    Some((set.id, set.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_call_data_sets_by_other_names() {
        assert_eq!(nearest_dataset("Au").map(|d| d.0), Some("au"));
        assert_eq!(nearest_dataset("gold").map(|d| d.0), Some("au"));
        assert_eq!(nearest_dataset("aluminum").map(|d| d.0), Some("al"));
        assert_eq!(nearest_dataset("brass_7030").map(|d| d.0), Some("brass_70_30"));
        assert_eq!(nearest_dataset("unobtainium"), None);
    }
}
