//! Pages of the refractiveindex.info database: YAML with tables and formulas.

use saphyr_parser::{Event, Parser, ScalarStyle, Span};

use super::columns::{UM, clipped, number};
use super::curves::{Point, joined};
use super::{IndexFile, IndexFileError, ROWS_MAX, Reason};
use crate::color::VISIBLE_NM;
use crate::dispersion::Formula;
use crate::rows::{Row, rows};

/// Levels of lists and mappings; a page has four.
const DEPTH_MAX: usize = 32;

/// Entries of `DATA`; a page has two at most.
const ENTRIES_MAX: usize = 16;

/// A text of an entry of `DATA`, and the line in which its first line stands.
#[derive(Debug, Clone)]
struct Text {
    text: String,
    line: usize,
}

/// An entry of `DATA`.
#[derive(Debug, Clone, Default)]
struct Entry {
    line: usize,
    kind: Option<Text>,
    data: Option<Text>,
    coefficients: Option<Text>,
    wavelength_range: Option<Text>,
}

impl Entry {
    fn text(&mut self, key: &str) -> Option<&mut Option<Text>> {
        match key {
            "type" => Some(&mut self.kind),
            "data" => Some(&mut self.data),
            "coefficients" => Some(&mut self.coefficients),
            "wavelength_range" => Some(&mut self.wavelength_range),
            _ => None,
        }
    }

    fn missing(&self, key: &'static str) -> IndexFileError {
        Reason::Missing(key).at(self.line)
    }
}

/// Reads an index from a page of the refractiveindex.info database: entries of `DATA` of the types `tabulated nk`, `tabulated n`, `tabulated k`
/// and `formula 1` to `formula 9`, whose wavelengths are in um. Formulas are sampled so that lines between samples err by less than 1e-6. The
/// other keys of a page do not count.
///
/// ```
/// let page = "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 1\n    coefficients: 1.5046 0.0042 -2\n";
/// let file = luthier_optics::index_file::yaml(page).unwrap();
/// assert!((file.ior.at(587.6).re - 1.5168).abs() < 1e-4);
/// ```
///
/// # Errors
/// [`IndexFileError`], with the line.
pub fn yaml(text: &str) -> Result<IndexFile, IndexFileError> {
    let (mut n, mut k): (Vec<Point>, Vec<Point>) = (Vec::new(), Vec::new());
    for entry in entries(text)? {
        let kind = entry.kind.as_ref().ok_or_else(|| entry.missing("type"))?;
        let words: Vec<&str> = kind.text.split_whitespace().collect();
        let unknown = Reason::Type(clipped(&kind.text)).at(kind.line);
        let (has_n, has_k) = match words.as_slice() {
            ["tabulated", "nk"] => (true, true),
            ["tabulated", "n"] => (true, false),
            ["tabulated", "k"] => (false, true),
            ["formula", _] => (true, false),
            _ => return Err(unknown),
        };
        for (has, curve, name) in [(has_n, &n, "n"), (has_k, &k, "k")] {
            if has && !curve.is_empty() {
                return Err(Reason::Twice(name).at(kind.line));
            }
        }
        if words[0] == "formula" {
            let number = words[1].parse().map_err(|_| unknown)?;
            n = sampled(&entry, number, kind.line)?;
        } else {
            let data = entry.data.as_ref().ok_or_else(|| entry.missing("data"))?;
            table(data, has_n.then_some(&mut n), has_k.then_some(&mut k))?;
        }
    }
    let mut notes = Vec::new();
    let ior = joined(n, k, &mut notes)?;
    Ok(IndexFile { ior, notes })
}

/// The rows of a table: a wavelength in um, and a value for each curve.
fn table(data: &Text, n: Option<&mut Vec<Point>>, k: Option<&mut Vec<Point>>) -> Result<(), IndexFileError> {
    let mut curves: Vec<&mut Vec<Point>> = n.into_iter().chain(k).collect();
    let expected = curves.len() + 1;
    for (count, row) in rows(&data.text).enumerate() {
        let row = row.map_err(|error| Reason::TooManyCells.at(data.line + error.line - 1))?;
        // Faults name lines of the page, not of the text.
        let row = Row { line: data.line + row.line - 1, ..row };
        if count == ROWS_MAX {
            return Err(Reason::TooManyRows.at(row.line));
        }
        if row.cells.len() != expected {
            return Err(Reason::Columns { found: row.cells.len(), expected }.at(row.line));
        }
        let um = number(&row, 0)?;
        if um <= 0.0 {
            return Err(Reason::Wavelength(um).in_column(row.line, 1));
        }
        for (i, curve) in curves.iter_mut().enumerate() {
            let (line, column) = (Some(row.line), Some(i + 2));
            curve.push(Point { nm: UM.nm(um), unit: Some(UM), value: number(&row, i + 1)?, line, column });
        }
    }
    Ok(())
}

/// Samples of a formula over the visible part of its range.
fn sampled(entry: &Entry, number: usize, line: usize) -> Result<Vec<Point>, IndexFileError> {
    let coefficients = entry.coefficients.as_ref().ok_or_else(|| entry.missing("coefficients"))?;
    let range = entry.wavelength_range.as_ref().ok_or_else(|| entry.missing("wavelength_range"))?;
    let formula =
        Formula::new(number, numbers(coefficients)?).map_err(|error| Reason::from(error).at(coefficients.line))?;
    let ends: Vec<f64> = numbers(range)?.into_iter().map(|um| UM.nm(um)).collect();
    let [first, last] = match ends.as_slice() {
        [first, last] if 0.0 < *first && first < last => [*first, *last],
        _ => return Err(Reason::Range(clipped(&range.text)).at(range.line)),
    };
    if last < VISIBLE_NM.0 || first > VISIBLE_NM.1 {
        return Err(Reason::NotVisible(first, last).at(range.line));
    }
    let found = formula.samples(first.max(VISIBLE_NM.0), last.min(VISIBLE_NM.1));
    let found = found.map_err(|nm| Reason::Pole(super::error::plain(nm)).at(line))?;
    Ok(found
        .into_iter()
        .map(|(nm, value)| Point { nm, unit: Some(UM), value, line: Some(line), column: None })
        .collect())
}

/// Finite numbers apart by spaces. The first hundred are read: no formula takes as many.
fn numbers(text: &Text) -> Result<Vec<f64>, IndexFileError> {
    let words = text.text.split_whitespace().take(100);
    let numbers = words.map(|word| match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(Reason::Number(clipped(word)).at(text.line)),
    });
    numbers.collect()
}

/// The entries of `DATA` of the first document. Aliases are not followed.
fn entries(text: &str) -> Result<Vec<Entry>, IndexFileError> {
    // Lists and mappings that are open; of a mapping, the key whose value comes next.
    let mut open: Vec<Option<Option<String>>> = Vec::new();
    let mut entries: Vec<Entry> = Vec::new();
    let mut has_data = false;
    for event in Parser::new_from_str(text.strip_prefix('\u{feff}').unwrap_or(text)) {
        let (event, span) = event.map_err(|error| Reason::Yaml(error.info().to_owned()).at(error.marker().line()))?;
        let line = span.start.line();
        let depth = open.len();
        let is_in_data = matches!(open.first(), Some(Some(Some(key))) if key == "DATA");
        let is_in_entry = is_in_data && depth == 3 && matches!(open[1..], [None, Some(_)]);
        match event {
            Event::Scalar(value, style, ..) => {
                if let Some(Some(key)) = open.last_mut() {
                    match key.take() {
                        None => *key = Some(value.into_owned()),
                        Some(key) if is_in_entry => {
                            let line = first_line(&value, style, &span);
                            let text = Text { text: value.into_owned(), line };
                            if let Some(place) = entries.last_mut().and_then(|entry| entry.text(&key)) {
                                *place = Some(text);
                            }
                        }
                        Some(_) => {}
                    }
                }
            }
            Event::Alias(_) => {
                if is_in_data {
                    return Err(Reason::Alias.at(line));
                }
                if let Some(Some(key)) = open.last_mut() {
                    *key = if key.is_some() { None } else { Some(String::new()) };
                }
            }
            Event::SequenceStart(..) | Event::MappingStart(..) => {
                if depth == DEPTH_MAX {
                    return Err(Reason::TooDeep(DEPTH_MAX).at(line));
                }
                let is_mapping = matches!(event, Event::MappingStart(..));
                has_data |= is_in_data && depth == 1 && !is_mapping;
                if is_in_data && depth == 2 && is_mapping && open[1].is_none() {
                    if entries.len() == ENTRIES_MAX {
                        return Err(Reason::TooManyRows.at(line));
                    }
                    entries.push(Entry { line, ..Entry::default() });
                }
                open.push(is_mapping.then_some(None));
            }
            Event::SequenceEnd | Event::MappingEnd => {
                open.pop();
                // A list or a mapping is a value, or a key that no page has.
                if let Some(Some(key)) = open.last_mut() {
                    *key = if key.is_some() { None } else { Some(String::new()) };
                }
            }
            Event::DocumentEnd => break,
            _ => {}
        }
    }
    if has_data && !entries.is_empty() { Ok(entries) } else { Err(Reason::NoData.at(None)) }
}

/// The line of the first line of a scalar's text. A block is marked at its first line that is not blank.
fn first_line(text: &str, style: ScalarStyle, span: &Span) -> usize {
    let is_block = matches!(style, ScalarStyle::Literal | ScalarStyle::Folded);
    let blank = if is_block { text.len() - text.trim_start_matches('\n').len() } else { 0 };
    span.start.line() - blank
}
