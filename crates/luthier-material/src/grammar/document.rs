//! Grammar of a material file, top level.

use super::bake::{BAKE, BUDGET};
use super::effects::EFFECTS;
use super::layers::{CONDUCTOR, DIELECTRIC, DIFFUSE, IOR, METALLIC_ROUGHNESS, THIN_FILM};
use super::table::{Key, Kind, LAYERS_MAX, SCHEMA_VERSION, Table, TextForm};

/// The whole file.
pub(crate) static DOCUMENT: Table = Table {
    name: "material",
    doc: "A luthier material: a layered surface, described from the top down.",
    keys: &[
        Key::required("schema", Kind::Integer(SCHEMA_VERSION, SCHEMA_VERSION), "Version of this grammar."),
        Key::required("name", Kind::Text(TextForm::Name), "Name of the material: letters, digits and hyphens."),
        Key::optional("description", Kind::Text(TextForm::Prose), "What it is, in a sentence or two."),
        Key::optional(
            "references",
            Kind::List { item: &Kind::Text(TextForm::Prose), min: 0, max: usize::MAX },
            "Sources of the numbers.",
        ),
        Key::with_default("exterior", IOR, "1.0", "Index of the medium above the first layer; it must be transparent."),
        Key::required(
            "layer",
            Kind::Tagged {
                tag: "type",
                variants: &[&DIELECTRIC, &THIN_FILM, &CONDUCTOR, &DIFFUSE, &METALLIC_ROUGHNESS],
                max: LAYERS_MAX,
            },
            "The layers from the top down: each an interface and what is below it.",
        ),
        Key::optional("effects", Kind::Table(&EFFECTS), "Effects on top of the layered model."),
        Key::optional("bake", Kind::Table(&BAKE), "How the tables of this material are to be baked."),
        Key::optional("budget", Kind::Table(&BUDGET), "What its tables may err, weigh and cost."),
    ],
    exactly_one: None,
};
