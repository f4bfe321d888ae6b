//! Units of the numbers of the grammar.

use super::table::{Key, Kind, Table};

/// Unit of a pure number: a share, an index, a slope, an exponent.
pub(crate) const PURE: &str = "1";

/// Endings of keys, and the unit that each states; the longer ending is first.
const SUFFIXES: [(&str, &str); 5] =
    [("_per_um", "1/um"), ("_um", "um"), ("_nm", "nm"), ("_deg", "degrees"), ("_bytes", "bytes")];

/// Keys that do not say their unit; with the table, where tables differ.
const NAMES: [(&str, &str, &str); 14] = [
    ("noise", "frequency", "cells per repeat"),
    ("budget", "max_cost", "operations"),
    ("film-thickness", "min", "nm"),
    ("film-thickness", "max", "nm"),
    ("", "frequency", "cells per unit of texture coordinate"),
    ("", "max_cost", "ps or cycles per wave of 64"),
    ("", "sigma", "radians"),
    ("", "size", "texels"),
    ("", "count", "cells"),
    ("", "octaves", "octaves"),
    ("", "tiling", "repeats per unit of texture coordinate"),
    ("", "fade_start", "scene units"),
    ("", "delta_e", "CIEDE2000"),
    ("", "height", "widths of the picture"),
];

/// Keys of pure numbers.
const PURES: [&str; 38] = [
    "offset",
    "f0",
    "f82_tint",
    "roughness",
    "alpha",
    "alpha_x",
    "alpha_y",
    "exponent",
    "exponents",
    "b",
    "c",
    "p",
    "albedo",
    "base_color",
    "metallic",
    "filled",
    "scale",
    "extent",
    "transition",
    "diffuse_albedo",
    "diffuse_remainder",
    "base_alpha",
    "tarnish",
    "max_rel",
    "max_lobe_err",
    "max_albedo_err",
    "specular_weight",
    "diffuse_weight",
    "weight",
    "n",
    "k",
    "ior",
    "exterior",
    "seed",
    "between",
    "share",
    "neighbours_differ",
    "max_abs",
];

/// Unit of a key's numbers; `None` for a key without numbers, and for one that these lists lack, which a test refuses.
pub(crate) fn unit(table: &Table, key: &Key) -> Option<&'static str> {
    if !is_numeric(&key.kind) {
        return None;
    }
    let suffix = SUFFIXES.iter().find(|(ending, _)| key.name.ends_with(ending)).map(|(_, unit)| *unit);
    let mut named =
        NAMES.iter().filter(|(owner, name, _)| *name == key.name && (owner.is_empty() || *owner == table.name));
    let named = named.next().map(|(_, _, unit)| *unit);
    suffix.or(named).or_else(|| PURES.contains(&key.name).then_some(PURE))
}

/// Whether a value has numbers of its own; a version is none.
pub(crate) fn is_numeric(kind: &Kind) -> bool {
    match kind {
        Kind::Number(_) => true,
        Kind::Integer(min, max) => min != max,
        Kind::List { item, .. } => is_numeric(item),
        Kind::OneOf(kinds) => kinds.iter().any(is_numeric),
        _ => false,
    }
}
