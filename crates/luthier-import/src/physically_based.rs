//! Materials of the database physicallybased.info.

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use std::collections::BTreeMap;

use crate::draft::{Draft, Layer, Value as Setting};
use crate::name::Names;
use crate::rules;
use crate::{Fate, Import, ImportError, Imported, Line};

/// The colours that luthier has: linear Rec.709.
const SPACE: &str = "srgb-linear";

#[derive(Debug, Deserialize)]
struct Database {
    data: Vec<Entry>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Entry {
    name: String,
    color: Vec<Color>,
    metalness: f64,
    roughness: f64,
    ior: Option<f64>,
    #[serde(default)]
    transmission: f64,
    #[serde(default)]
    specular_color: Vec<Edge>,
    /// Least and greatest, and a usual one after these.
    #[serde(default)]
    thin_film_thickness: Vec<f64>,
    thin_film_ior: Option<f64>,
    description: Option<String>,
    #[serde(default)]
    references: Vec<Reference>,
    #[serde(flatten)]
    others: BTreeMap<String, IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Color {
    color_space: String,
    color: [f64; 3],
}

#[derive(Debug, Deserialize)]
struct Edge {
    format: Vec<String>,
    color: Vec<Color>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Reference {
    author: String,
    title: String,
    url: String,
}

/// Members that are no reflectances, and members that are lost.
const OF_HOST: [&str; 9] = [
    "acousticAbsorption",
    "category",
    "density",
    "group",
    "images",
    "surfaceTension",
    "tags",
    "viscosity",
    "complexIor",
];
const LOST: [&str; 4] = ["subsurfaceRadius", "transmissionDepth", "transmissionDispersion", "volumeCoefficients"];

/// Whether a text is a file of the database.
pub(crate) fn is_database(text: &Value) -> bool {
    text["data"].as_array().is_some_and(|all| all.iter().all(|entry| entry["metalness"].is_number()))
}

/// The materials of a file of the database physicallybased.info, version 2 of its format. `label` names it in the texts.
///
/// A metal has its colour as F0, and the colour that its edge has at 82 degrees; its complex index is of three wavelengths, and as far as .07 from that colour. Any other material is a
/// `metallic-roughness` surface whose dielectric has the F0 of its index.
///
/// # Errors
/// [`ImportError`], with line and column.
pub fn physically_based(label: &str, bytes: &[u8]) -> Result<Import, ImportError> {
    let Database { data } = serde_json::from_slice(bytes).map_err(ImportError::Json)?;
    if data.is_empty() {
        return Err(ImportError::Empty(String::new()));
    }
    let mut names = Names::default();
    let materials = data.into_iter().enumerate().map(|(number, entry)| {
        let name = names.unique(&entry.name, &format!("material-{number}"));
        let (draft, lines) = surface(&entry);
        let mut comments = vec![format!("Source: {label}, `{}`, physicallybased.info (CC0-1.0)", entry.name)];
        comments.extend(crate::told(&lines));
        let text = Draft { name: name.clone(), comments, ..draft }.toml();
        Imported { name, source_name: entry.name, text, lines }
    });
    Ok(Import { materials: materials.collect(), ..Import::default() })
}

fn surface(entry: &Entry) -> (Draft, Vec<Line>) {
    let mut lines = Vec::new();
    let mut say = |property: &str, fate: Fate, note: &str| lines.push(Line::new(property, fate, note));
    let in_space = |colors: &[Color]| colors.iter().find(|color| color.color_space == SPACE).map(|color| color.color);
    let given = in_space(&entry.color).unwrap_or([0.5; 3]);
    let color = given.map(|c| c.clamp(0.0, 1.0));
    if color == given {
        say("color", Fate::Kept, "");
    } else {
        say("color", Fate::Approximated, "it is beyond linear Rec.709, and held to it");
    }
    let metallic = entry.metalness.clamp(0.0, 1.0);
    let film = entry.thin_film_ior.zip(entry.thin_film_thickness.get(2).or(entry.thin_film_thickness.last()));
    let film = film.filter(|(_, thickness)| **thickness > 0.0);
    let mut base = Layer::new(if metallic == 1.0 { "conductor" } else { "metallic-roughness" });
    if metallic == 1.0 {
        base.set("f0", Setting::color(color));
        let edge = entry.specular_color.iter().find(|edge| edge.format.iter().any(|format| format == "F82"));
        match edge.and_then(|edge| in_space(&edge.color)) {
            Some(tint) if film.is_none() => {
                base.set("f82_tint", Setting::color(tint.map(|c| c.clamp(0.0, 1.0))));
                say("specularColor", Fate::Kept, "");
            }
            Some(_) => say("specularColor", Fate::Dropped, "below a film a metal has no edge tint"),
            None => {}
        }
    } else {
        base.set("base_color", Setting::color(color));
        base.set("metallic", Setting::Number(metallic));
        if let Some(ior) = entry.ior {
            base.set("f0", Setting::Number(rules::f0(ior)));
            say("ior", Fate::ClosedForm, "f0 = ((n - 1)/(n + 1))^2");
        }
    }
    say("metalness", Fate::Kept, "");
    let roughness = entry.roughness.clamp(0.0, 1.0);
    match roughness {
        0.0 => base.set("smooth", Setting::Bool(true)),
        _ => base.set("roughness", Setting::Number(roughness)),
    }
    say("roughness", Fate::Kept, "");
    let mut layers = Vec::new();
    if let Some((ior, &thickness)) = film {
        let mut layer = Layer::new("thin-film");
        layer.set("ior", Setting::Number(ior.clamp(1.0, 10.0)));
        layer.set("thickness_nm", Setting::Number(thickness));
        layers.push(layer);
        say("thinFilmThickness", Fate::Approximated, "the usual one of its range, everywhere");
    }
    layers.push(base);
    if entry.transmission > 0.0 {
        say("transmission", Fate::Dropped, "light that goes through: the base is opaque");
    }
    for name in entry.others.keys() {
        if name == "complexIor" {
            say(name, Fate::Host, "not taken: colour and edge are nearer to the spectrum");
        } else if OF_HOST.contains(&name.as_str()) {
            say(name, Fate::Host, "no reflectance");
        } else if LOST.contains(&name.as_str()) {
            say(name, Fate::Dropped, "light within a body");
        } else {
            say(name, Fate::Dropped, "the property is not read");
        }
    }
    let references = entry.references.iter().map(|Reference { author, title, url }| {
        let parts = [author, title, url].into_iter().filter(|part| !part.is_empty());
        parts.map(String::as_str).collect::<Vec<_>>().join(". ")
    });
    let draft =
        Draft { layers, description: entry.description.clone(), references: references.collect(), ..Draft::default() };
    (draft, lines)
}
