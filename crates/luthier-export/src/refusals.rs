//! All that is known of materials before any work begins: what `bake` refuses, and so does `check`, and what is doubtful.

use std::collections::BTreeMap;

use luthier_bake::{BakeError, MemoryStore};
use luthier_material::{Diagnostic, Material, NamedImage, Severity};
use rayon::prelude::*;

use crate::pictures::{self, read_image};
use crate::sources::Source;

/// Adds `doubts`, and makes files unusable that cannot be baked: one by one, then, where each is usable, as a set.
pub fn refuse(sources: &mut [Source], doubts: impl Fn(&Material) -> Vec<Diagnostic> + Sync) {
    sources.par_iter_mut().for_each(|source| {
        let Ok(parsed) = &source.parsed else { return };
        let mut found = doubts(&parsed.material);
        found.extend(of_pictures(&parsed.material));
        add(source, found);
    });
    let Some(materials) = usable(sources) else { return };
    for (number, diagnostic) in of_set(&materials) {
        add(&mut sources[number], vec![diagnostic]);
    }
}

/// Makes the first file unusable where the material buffer or a texture cannot hold all of them. A bake plans its tables, and says so itself.
pub fn refuse_too_many(sources: &mut [Source], shaded: impl Fn(Vec<Material>) -> Vec<Material>) {
    let Some(materials) = usable(sources) else { return };
    let materials = shaded(materials);
    let options = luthier_bake::Options { search: false, fits: false, ..luthier_bake::Options::default() };
    // Anything else has been told.
    if let Err(error @ (BakeError::TooManyTiles { .. } | BakeError::TooManyLayers { .. })) =
        luthier_bake::outline_with(&materials, &options, &read_image, &MemoryStore::default())
    {
        let diagnostic = materials[0].diagnostic(Severity::Error, "name", error.to_string(), None);
        add(&mut sources[0], vec![diagnostic]);
    }
}

/// The materials, if each file has one.
fn usable(sources: &[Source]) -> Option<Vec<Material>> {
    sources.iter().map(|source| source.parsed.as_ref().ok().map(|parsed| parsed.material.clone())).collect()
}

fn add(source: &mut Source, found: Vec<Diagnostic>) {
    match &mut source.parsed {
        Ok(parsed) => {
            parsed.warnings.extend(found);
            parsed.warnings.sort_by_key(|d| (d.span.start, d.span.end));
            if parsed.warnings.iter().any(Diagnostic::is_error) {
                let all = std::mem::take(&mut parsed.warnings);
                source.parsed = Err(all.into_iter().filter(Diagnostic::is_error).collect());
            }
        }
        Err(errors) => errors.extend(found),
    }
}

/// Diagnostics of the pictures that a material names.
pub(crate) fn of_pictures(material: &Material) -> Vec<Diagnostic> {
    material.images().iter().flat_map(|image| told(material, image)).collect()
}

/// Diagnostics of a picture that a material names: why it cannot be used, or doubts about it.
fn told(material: &Material, image: &NamedImage<'_>) -> Vec<Diagnostic> {
    let NamedImage { key, picture, texels } = image;
    let path = &picture.path;
    match pictures::read(&material.source, picture, *texels) {
        Ok(read) => {
            let doubts = pictures::doubts(&read, picture, *texels).into_iter();
            let warning = |(sentence, hint)| {
                material.diagnostic(Severity::Warning, key, format!("the map `{path}`: {sentence}"), Some(hint))
            };
            doubts.map(warning).collect()
        }
        Err(reason) => {
            let hint = "name a PNG, JPEG or WebP file by its path relative to the material file".to_owned();
            let message = format!("cannot use the map `{path}`: {reason}");
            vec![material.diagnostic(Severity::Error, key, message, Some(hint))]
        }
    }
}

/// Diagnostics of materials together, each with the number of the material that it is said of.
fn of_set(materials: &[Material]) -> Vec<(usize, Diagnostic)> {
    let mut found = Vec::new();
    let mut tell = |number: usize, key: &str, message: String| {
        found.extend(materials.get(number).map(|m| (number, m.diagnostic(Severity::Error, key, message, None))));
    };
    for error in luthier_bake::check(materials, &luthier_bake::Options::default()).err().unwrap_or_default() {
        let (number, key) = error.place().unwrap_or((0, "name"));
        tell(number, key, error.to_string());
    }
    let mut named: BTreeMap<String, &Material> = BTreeMap::new();
    for (number, material) in materials.iter().enumerate() {
        let identifier = match luthier_shader::identifier(&material.name) {
            Ok(identifier) => identifier,
            Err(error) => {
                tell(number, "name", error.to_string());
                continue;
            }
        };
        match named.get(&identifier) {
            // Equal names have been told.
            Some(first) if first.name != material.name => {
                let (name, other, place) = (&material.name, &first.name, first.place("name"));
                tell(number, "name", format!("`{name}` and `{other}` of {place} are both `{identifier}` in a shader"));
            }
            Some(_) => {}
            None => drop(named.insert(identifier, material)),
        }
    }
    found
}
