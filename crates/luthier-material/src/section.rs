//! Sections of a TOML document, read by key and with spans.

use std::ops::Range as Span;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::Sink;

/// The document of a text; faults of its TOML go to the sink. Broken TOML gives no document: a recovered one is not what was meant, and its
/// other mistakes would mislead.
pub(crate) fn parse_toml<'t>(text: &'t str, sink: &mut Sink<'_>) -> Option<Spanned<DeTable<'t>>> {
    let (document, errors) = DeTable::parse_recoverable(text);
    if let (Some(first), Some(format)) = (errors.first(), format_of(text)) {
        let start = first.span().map_or(0, |span| span.start);
        let hint = "`luthier import` writes material files from glTF, MaterialX and the JSON of physicallybased.info";
        sink.error(start..start, format!("not TOML: this is {format}"), Some(hint.to_owned()));
        return None;
    }
    for error in &errors {
        let hint = error.message().contains("duplicate key").then(|| "keep one of the two".to_owned());
        sink.error(error.span().unwrap_or(0..0), format!("not TOML: {}", error.message()), hint);
    }
    errors.is_empty().then_some(document)
}

/// The format of a text that is none of TOML, by how it begins.
fn format_of(text: &str) -> Option<&'static str> {
    let formats = [("glTF", "binary glTF"), ("{", "JSON"), ("<", "XML")];
    formats.into_iter().find_map(|(start, format)| text.trim_start().starts_with(start).then_some(format))
}

/// A table of the document and where it stands, read by key. A value of another type reads as absent: the checker has
/// reported it.
#[derive(Clone)]
pub(crate) struct Section<'t> {
    pub(crate) table: &'t DeTable<'t>,
    pub(crate) span: Span<usize>,
}

impl<'t> Section<'t> {
    /// The whole of a document. Its span is the start of the text, where missing keys are reported.
    pub(crate) fn document(document: &'t Spanned<DeTable<'t>>) -> Self {
        Self { table: document.get_ref(), span: 0..0 }
    }

    pub(crate) fn value(&self, key: &str) -> Option<&'t Spanned<DeValue<'t>>> {
        self.table.get(key)
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.value(key).is_some()
    }

    /// The span of a key, or of the table when it lacks the key.
    pub(crate) fn key_span(&self, key: &str) -> Span<usize> {
        self.table.get_key_value(key).map_or_else(|| self.span.clone(), |(k, _)| k.span())
    }

    /// The span of a value, or of the table when it lacks the key.
    pub(crate) fn value_span(&self, key: &str) -> Span<usize> {
        self.value(key).map_or_else(|| self.span.clone(), Spanned::span)
    }

    pub(crate) fn section(&self, key: &str) -> Option<Section<'t>> {
        section(self.value(key)?)
    }

    pub(crate) fn sections(&self, key: &str) -> Vec<Section<'t>> {
        self.array(key).into_iter().flat_map(|array| array.iter()).filter_map(section).collect()
    }

    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        number(self.value(key)?.get_ref())
    }

    pub(crate) fn integer(&self, key: &str) -> Option<u32> {
        integer(self.value(key)?.get_ref()).and_then(|i| u32::try_from(i).ok())
    }

    pub(crate) fn flag(&self, key: &str) -> Option<bool> {
        self.value(key)?.get_ref().as_bool()
    }

    pub(crate) fn text(&self, key: &str) -> Option<&'t str> {
        self.value(key)?.get_ref().as_str()
    }

    pub(crate) fn path(&self, key: &str) -> Option<String> {
        self.text(key).map(str::to_owned)
    }

    pub(crate) fn texts(&self, key: &str) -> Vec<String> {
        let array = self.array(key);
        array.into_iter().flat_map(|a| a.iter()).filter_map(|v| Some(v.get_ref().as_str()?.to_owned())).collect()
    }

    /// The strings of an array, and where they stand.
    pub(crate) fn spanned_texts(&self, key: &str) -> impl Iterator<Item = (String, Span<usize>)> {
        let array = self.array(key);
        array.into_iter().flat_map(|a| a.iter()).filter_map(|v| Some((v.get_ref().as_str()?.to_owned(), v.span())))
    }

    /// A number, or an array of numbers.
    pub(crate) fn numbers(&self, key: &str) -> Option<Numbers> {
        let value = self.value(key)?.get_ref();
        if let Some(one) = number(value) {
            return Some(Numbers::One(one));
        }
        value.as_array()?.iter().map(|v| number(v.get_ref())).collect::<Option<Vec<f64>>>().map(Numbers::Many)
    }

    /// Two numbers.
    pub(crate) fn two_numbers(&self, key: &str) -> Option<[f64; 2]> {
        match self.numbers(key)? {
            Numbers::Many(pair) => pair.try_into().ok(),
            Numbers::One(_) => None,
        }
    }

    /// A triple of numbers; one number stands for three.
    pub(crate) fn rgb(&self, key: &str) -> Option<[f64; 3]> {
        match self.numbers(key)? {
            Numbers::One(v) => Some([v; 3]),
            Numbers::Many(v) => v.try_into().ok(),
        }
    }

    /// A triple of reflectances. A value a little above 1, of which the checker has warned, counts as 1.
    pub(crate) fn reflectance(&self, key: &str) -> Option<[f64; 3]> {
        self.rgb(key).map(|rgb| rgb.map(|value| value.min(1.0)))
    }

    /// A pair of whole numbers.
    pub(crate) fn pair(&self, key: &str) -> Option<[u32; 2]> {
        let items = self.array(key)?.iter().map(|v| u32::try_from(integer(v.get_ref())?).ok());
        items.collect::<Option<Vec<u32>>>()?.try_into().ok()
    }

    fn array(&self, key: &str) -> Option<&'t DeArray<'t>> {
        self.value(key)?.get_ref().as_array()
    }
}

/// One number or several.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Numbers {
    One(f64),
    Many(Vec<f64>),
}

pub(crate) fn section<'t>(value: &'t Spanned<DeValue<'t>>) -> Option<Section<'t>> {
    Some(Section { table: value.get_ref().as_table()?, span: value.span() })
}

/// A float or an integer; TOML lets people write 1 for 1.0.
pub(crate) fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(_) => integer(value).map(|i| i as f64),
        _ => None,
    }
}

pub(crate) fn integer(value: &DeValue<'_>) -> Option<i64> {
    match value {
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix()).ok(),
        _ => None,
    }
}
