//! Checks a document against the grammar: keys, types, ranges, alternatives. Everything wrong is reported at once.

use std::fmt::Write;

use toml::Spanned;
use toml::de::DeValue;

use crate::correct::corrected;
use crate::diagnostic::Sink;
use crate::grammar::{
    Alternatives, Key, Kind, NAME_MAX, PATH_MAX, REFLECTANCE_READ_MAX, REFLECTANCES, Range, Table, TextForm, foreign,
};
use crate::section::{Section, integer, number, section};
use crate::suggest::{did_you_mean, one_of, short};

/// Checks a table and everything in it. `siblings` are tables that could stand in its place.
pub(crate) fn check_table(table: &'static Table, siblings: &[&'static Table], at: &Section<'_>, sink: &mut Sink<'_>) {
    // Known keys that misspelt keys probably stand for. They count as present, so that one mistake is reported once.
    let mut meant = Vec::new();
    for (key, value) in at.table {
        let name: &str = key.get_ref();
        match table.key(name) {
            Some(known) => check_value(known.name, &known.kind, value, false, sink),
            None => meant.extend(unknown_key(table, siblings, name, key.span(), sink)),
        }
    }
    let present = |name: &str| at.has(name) || meant.contains(&name);
    for key in table.keys.iter().filter(|k| k.required && !present(k.name)) {
        sink.error(at.span.clone(), format!("`{}` is missing from this {}", key.name, table.name), Some(add(key)));
    }
    for alternatives in table.alternatives() {
        check_alternatives(alternatives, table, at, &present, sink);
    }
}

/// Checks one key of a table alone, if it is there.
pub(crate) fn check_key(table: &'static Table, name: &str, at: &Section<'_>, sink: &mut Sink<'_>) {
    if let (Some(key), Some(value)) = (table.key(name), at.value(name)) {
        check_value(key.name, &key.kind, value, false, sink);
    }
}

fn check_alternatives(
    alternatives: &Alternatives,
    table: &'static Table,
    at: &Section<'_>,
    present: &dyn Fn(&str) -> bool,
    sink: &mut Sink<'_>,
) {
    let given: Vec<_> = alternatives.forms.iter().filter(|form| form.iter().any(|name| present(name))).collect();
    match given.as_slice() {
        [] => sink.error(
            at.span.clone(),
            format!("this {} has no {}", table.name, alternatives.what),
            Some(format!("give one of {}", alternatives.examples)),
        ),
        [form] => {
            for name in form.iter().filter(|name| !present(name)) {
                let there = form.iter().find(|name| at.has(name)).copied().unwrap_or(name);
                sink.error(at.key_span(there), format!("`{there}` needs `{name}` beside it"), table.key(name).map(add));
            }
        }
        [_, ..] if alternatives.together => {}
        [first, others @ ..] => {
            let first = first.iter().find(|name| at.has(name)).copied().unwrap_or(first[0]);
            for second in others.iter().filter_map(|form| form.iter().find(|name| at.has(name))) {
                sink.error(
                    at.key_span(second),
                    format!("a second {}: `{first}` is given already", alternatives.what),
                    Some(format!("keep one of `{first}` and `{second}`")),
                );
            }
        }
    }
}

/// Reports a key that the table does not have; the known key that it probably stands for, if any.
fn unknown_key(
    table: &'static Table,
    siblings: &[&'static Table],
    name: &str,
    span: std::ops::Range<usize>,
    sink: &mut Sink<'_>,
) -> Option<&'static str> {
    if sink.is_full() {
        sink.error(span, "", None);
        return None;
    }
    let mut nearest = did_you_mean(name, table.keys.iter().map(|k| k.name)).or_else(|| synonym(table, name));
    let advice = foreign::here(table, name).inspect(|_| nearest = None);
    if let Some(advice) = advice.or_else(|| foreign::key(name).filter(|_| nearest.is_none())) {
        sink.error(span, format!("unknown key `{name}` in {}", this(table)), Some(advice.to_owned()));
        return None;
    }
    if nearest.is_none() && layers_of(table).any(|layer| layer.key(name).is_some()) {
        let hint = format!("`{name}` is a key of layers: write it below a `[[layer]]`");
        sink.error(span, format!("unknown key `{name}` outside the layers"), Some(hint));
        return None;
    }
    let owners: Vec<&str> = siblings.iter().filter(|t| t.key(name).is_some()).map(|t| t.name).collect();
    if !owners.is_empty() {
        let hint = match (nearest, table.name) {
            (Some(nearest), _) => format!("did you mean `{nearest}`?"),
            (None, "thin-film") => "a thin film shares the surface of the layer that it coats: put it there".to_owned(),
            (None, _) => "leave it out, or change the `type`".to_owned(),
        };
        let message = format!("`{name}` belongs to {}, not to this {}", one_of(&owners), table.name);
        sink.error(span, message, Some(hint));
        return nearest;
    }
    let hint = match nearest {
        Some(nearest) => format!("did you mean `{nearest}`?"),
        None => {
            format!("it takes {}", table.keys.iter().map(|k| format!("`{}`", k.name)).collect::<Vec<_>>().join(", "))
        }
    };
    sink.error(span, format!("unknown key `{name}` in {}", this(table)), Some(hint));
    nearest
}

/// A table in words; those of maps have names of the schema alone.
fn this(table: &Table) -> String {
    match table.name.split_once('-') {
        Some((kind, key @ ("maps" | "live"))) => {
            let kind = if kind == "metallic" { "metallic-roughness" } else { kind };
            format!("the `{key}` of a {kind} layer")
        }
        _ => format!("this {}", table.name),
    }
}

/// The kinds of layers of a document.
fn layers_of(table: &'static Table) -> impl Iterator<Item = &'static Table> {
    let layers = table.key("layer").map(|key| &key.kind);
    let variants = match layers {
        Some(Kind::Tagged { variants, .. }) => *variants,
        _ => &[],
    };
    variants.iter().copied()
}

/// Other words for some keys, from neighbouring tools and papers.
fn synonym(table: &'static Table, name: &str) -> Option<&'static str> {
    const SYNONYMS: [(&str, &str); 31] = [
        ("color", "albedo"),
        ("colour", "albedo"),
        ("reflectance", "albedo"),
        ("reflectance", "f0"),
        ("specular", "f0"),
        ("F0", "f0"),
        ("color", "base_color"),
        ("colour", "base_color"),
        ("albedo", "base_color"),
        ("base_color", "albedo"),
        ("base_color", "f0"),
        ("color", "f0"),
        ("diffuse", "albedo"),
        ("diffuseColor", "albedo"),
        ("baseColor", "base_color"),
        ("baseColorFactor", "base_color"),
        ("metallicFactor", "metallic"),
        ("base_metalness", "metallic"),
        ("roughnessFactor", "roughness"),
        ("specular_roughness", "roughness"),
        ("metalness", "metallic"),
        ("metallicness", "metallic"),
        ("edge_color", "f82_tint"),
        ("edge_tint", "f82_tint"),
        ("specular_color", "f82_tint"),
        ("eta", "ior"),
        ("kappa", "k"),
        ("m", "alpha"),
        ("slope", "slope_deg"),
        ("absorption", "absorption_per_um"),
        ("thickness", "thickness_um"),
    ];
    let (_, meant) = SYNONYMS.iter().find(|(word, meant)| *word == name && table.key(meant).is_some())?;
    table.key(meant).map(|key| key.name)
}

fn check_value(
    name: &'static str,
    kind: &'static Kind,
    value: &Spanned<DeValue<'_>>,
    in_list: bool,
    sink: &mut Sink<'_>,
) {
    let span = value.span();
    match (kind, value.get_ref()) {
        (Kind::OneOf(kinds), found) => match kinds.iter().find(|kind| accepts(kind, found)) {
            Some(kind) => check_value(name, kind, value, in_list, sink),
            None => mismatch(name, kind, value, sink),
        },
        (Kind::True, DeValue::Boolean(true)) | (Kind::Flag, DeValue::Boolean(_)) => {}
        (Kind::True, DeValue::Boolean(false)) => {
            sink.error(span, format!("`{name}` can only be true"), Some(format!("leave `{name}` out")));
        }
        (Kind::Number(range), found @ (DeValue::Float(_) | DeValue::Integer(_))) => match number(found) {
            Some(v) if range.contains(v) => {}
            Some(v) if REFLECTANCES.contains(&name) && v > range.max && v <= REFLECTANCE_READ_MAX => {
                let message = format!("`{name}` is {}, more light than falls in: it is read as 1", short(v));
                let hint = "colours of wide gamuts are above 1 in Rec.709; write 1 if that is meant".to_owned();
                sink.warn(span, message, Some(hint));
            }
            Some(v) => {
                let message = format!("`{name}` must be {}, found {}", bounds(*range, v), short(v));
                sink.error(span, message, corrected(name, *range, v, in_list));
            }
            None => sink.error(span, format!("`{name}` is too large a number"), None),
        },
        (Kind::Integer(min, max), found @ DeValue::Integer(_)) => match integer(found) {
            Some(v) if (*min..=*max).contains(&v) => {}
            v => {
                let found = v.map_or_else(|| "more".to_owned(), |v| v.to_string());
                let nearest = if v.is_some_and(|v| v < *min) { min } else { max };
                let (bounds, hint) = if min == max {
                    (format!("{min}"), format!("this version reads `{name} = {min}`"))
                } else if in_list {
                    (format!("from {min} to {max}"), format!("the nearest allowed is `{nearest}`"))
                } else {
                    (format!("from {min} to {max}"), format!("the nearest allowed is `{name} = {nearest}`"))
                };
                sink.error(span, format!("`{name}` must be {bounds}, found {found}"), Some(hint));
            }
        },
        (Kind::Text(form), DeValue::String(text)) => check_text(name, *form, text, span, sink),
        (Kind::Choice(names), DeValue::String(text)) => {
            if !names.contains(&&**text) {
                let hint = did_you_mean(text, names.iter().copied()).map_or_else(
                    || format!("write {}", one_of(names)),
                    |nearest| {
                        let value = format!("\"{nearest}\"");
                        let written = if in_list { value } else { format!("{name} = {value}") };
                        format!("did you mean `{written}`?")
                    },
                );
                sink.error(span, format!("`{text}` is no value of `{name}`"), Some(hint));
            }
        }
        (Kind::List { item, min, max }, DeValue::Array(array)) => {
            if array.len() < *min || array.len() > *max {
                let wanted = if min == max { format!("{min}") } else { format!("{min} to {max}") };
                let hint = (*min == 3 && *max == 3).then(|| "one each for R, G and B".to_owned());
                sink.error(span, format!("`{name}` takes {wanted} values, found {}", array.len()), hint);
            }
            for value in array {
                check_value(name, item, value, true, sink);
            }
        }
        (Kind::Table(table), DeValue::Table(_)) => {
            if let Some(at) = section(value) {
                check_table(table, &[], &at, sink);
            }
        }
        (Kind::Tagged { tag, variants, max }, DeValue::Array(array)) => {
            if array.is_empty() {
                sink.error(span, format!("there is no `{name}`"), Some(format!("add a [[{name}]]")));
            }
            if let Some(first) = array.get(*max) {
                let hint = Some(format!("leave {} of them out", array.len() - max));
                sink.error(first.span(), format!("{} times [[{name}]]: at most {max} are read", array.len()), hint);
            }
            for value in array.iter().take(*max) {
                check_tagged(name, tag, variants, value, sink);
            }
        }
        _ => mismatch(name, kind, value, sink),
    }
}

fn check_tagged(
    name: &str,
    tag: &'static str,
    variants: &'static [&'static Table],
    value: &Spanned<DeValue<'_>>,
    sink: &mut Sink<'_>,
) {
    let names: Vec<&str> = variants.iter().map(|v| v.name).collect();
    let Some(at) = section(value) else {
        sink.error(value.span(), format!("each `{name}` must be a table"), Some(format!("write [[{name}]]")));
        return;
    };
    let Some(given) = at.value(tag) else {
        let hint = format!("add `{tag} = ...` with {}", one_of(&names));
        sink.error(at.span.clone(), format!("this {name} does not say its `{tag}`"), Some(hint));
        return;
    };
    let Some(text) = given.get_ref().as_str() else {
        sink.error(given.span(), format!("`{tag}` must be a string"), Some(format!("write {}", one_of(&names))));
        return;
    };
    match variants.iter().find(|v| v.name == text) {
        Some(variant) => check_table(variant, variants, &at, sink),
        None => {
            let hint = match (did_you_mean(text, names.iter().copied()), foreign::kind(text)) {
                (Some(near), _) => format!("did you mean `{tag} = \"{near}\"`?"),
                (None, Some(advice)) if name == "layer" => advice.to_owned(),
                (None, _) => format!("write {}", one_of(&names)),
            };
            sink.error(given.span(), format!("`{text}` is no `{tag}` of a {name}"), Some(hint));
        }
    }
}

fn check_text(name: &str, form: TextForm, text: &str, span: std::ops::Range<usize>, sink: &mut Sink<'_>) {
    match form {
        TextForm::Prose => {}
        TextForm::Path if text.is_empty() => sink.error(span, format!("`{name}` is empty"), None),
        TextForm::Path => {
            let longest = text.split(['/', '\\']).map(str::len).max().unwrap_or(0);
            for (bytes, most) in [longest, text.len()].into_iter().zip(PATH_MAX) {
                if bytes > most {
                    let hint = Some("give the file a shorter name".to_owned());
                    sink.error(span, format!("`{name}` names a file by {bytes} bytes: file systems take {most}"), hint);
                    return;
                }
            }
        }
        TextForm::Name if text.len() > NAME_MAX => {
            let message =
                format!("`{name}` has {} characters: files and shaders are named after it", text.chars().count());
            sink.error(span, message, Some(format!("at most {NAME_MAX} are allowed")));
        }
        TextForm::Name => {
            let fixed = text.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
            if text.is_empty() || text.starts_with('-') || fixed != text {
                let fixed = fixed.trim_matches('-');
                let hint = (!fixed.is_empty()).then(|| format!("write `{name} = \"{fixed}\"`"));
                sink.error(span, format!("`{name}` is made of letters, digits and hyphens"), hint);
            }
        }
    }
}

fn mismatch(name: &str, kind: &Kind, value: &Spanned<DeValue<'_>>, sink: &mut Sink<'_>) {
    let found = match value.get_ref() {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "a boolean",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    };
    let hint = match (kind, value.get_ref()) {
        (Kind::Tagged { .. }, DeValue::Table(_)) => Some(format!("write [[{name}]], with double brackets")),
        (_, DeValue::String(text)) if text.trim().parse::<f64>().is_ok() && accepts_number(kind) => {
            Some(format!("write `{name} = {}`, without quotes", text.trim()))
        }
        _ => None,
    };
    sink.error(value.span(), format!("`{name}` must be {}, found {found}", describe(kind)), hint);
}

fn accepts(kind: &Kind, value: &DeValue<'_>) -> bool {
    match value {
        DeValue::Boolean(_) => matches!(kind, Kind::True | Kind::Flag),
        DeValue::Integer(_) => matches!(kind, Kind::Number(_) | Kind::Integer(..)),
        DeValue::Float(_) => matches!(kind, Kind::Number(_)),
        DeValue::String(_) => matches!(kind, Kind::Text(_) | Kind::Choice(_)),
        DeValue::Array(_) => matches!(kind, Kind::List { .. } | Kind::Tagged { .. }),
        DeValue::Table(_) => matches!(kind, Kind::Table(_)),
        DeValue::Datetime(_) => false,
    }
}

fn accepts_number(kind: &Kind) -> bool {
    match kind {
        Kind::Number(_) | Kind::Integer(..) => true,
        Kind::OneOf(kinds) => kinds.iter().any(accepts_number),
        _ => false,
    }
}

fn describe(kind: &Kind) -> String {
    match kind {
        Kind::True => "true".to_owned(),
        Kind::Flag => "true or false".to_owned(),
        Kind::Number(_) => "a number".to_owned(),
        Kind::Integer(..) => "a whole number".to_owned(),
        Kind::Text(_) => "a string".to_owned(),
        Kind::Choice(names) => one_of(names),
        Kind::List { item, min, max } if min == max => format!("an array of {min}, each {}", describe(item)),
        Kind::List { item, .. } => format!("an array, each {}", describe(item)),
        Kind::Table(table) => {
            let mut text = "a table {".to_owned();
            for (i, key) in table.keys.iter().enumerate() {
                // Writing to a String does not fail.
                let _ = write!(text, "{} {}", if i == 0 { "" } else { "," }, key.name);
            }
            text + " }"
        }
        Kind::Tagged { .. } => "an array of tables".to_owned(),
        Kind::OneOf(kinds) => kinds.iter().map(describe).collect::<Vec<_>>().join(" or "),
    }
}

/// Messages leave out upper bounds from here on, unless a value is above them.
const FAR: f64 = 1e6;

fn bounds(range: Range, found: f64) -> String {
    match (range.min.is_finite(), range.max < FAR || found > range.max) {
        (true, true) if range.above => format!("above {} and at most {}", short(range.min), short(range.max)),
        (true, true) => format!("from {} to {}", short(range.min), short(range.max)),
        (true, false) if range.above => format!("above {}", short(range.min)),
        (true, false) => format!("at least {}", short(range.min)),
        (false, _) => "a finite number".to_owned(),
    }
}

/// How to add a missing key.
fn add(key: &Key) -> String {
    let doc = key.doc.split(". ").next().unwrap_or(key.doc).trim_end_matches('.');
    match &key.kind {
        Kind::Integer(min, max) if min == max => format!("add `{} = {min}`", key.name),
        Kind::Tagged { .. } => format!("add a `[[{}]]`", key.name),
        _ => format!("add `{} = ...`: {}", key.name, lower_first(doc)),
    }
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    // Symbols and acronyms keep their case: only a capital before a small letter is the start of a sentence.
    match (chars.next(), text.chars().nth(1)) {
        (Some(first), Some(second)) if second.is_lowercase() => first.to_lowercase().chain(chars).collect(),
        _ => text.to_owned(),
    }
}
