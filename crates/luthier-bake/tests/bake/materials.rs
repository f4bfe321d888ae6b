//! Materials for tests, written as files.

use std::sync::LazyLock;

use luthier_bake::{BakeError, Baked, MemoryStore, Options, Silent, bake, bake_with};
use luthier_lut::{Atlas, TableKind};
use luthier_material::{Material, parse};

/// Tables small enough to be baked in a moment.
pub(crate) const SMALL: &str = "
[bake.fresnel]
size = 24
[bake.distribution]
size = [24, 16]
[bake.fgd]
size = [8, 8]
[bake.phase]
size = 32
[bake.thickness]
size = 16
";

/// Every kind of table that an interface without a film has.
pub(crate) const ASKED: &str = "[bake]\ntables = [\"fresnel\", \"distribution\", \"fgd\"]\n";

/// A material of that name with these layers (TOML) and settings. Without a model it has one that reads tables of every interface.
pub(crate) fn material(name: &str, layers: &str, settings: &str) -> Material {
    let text = format!("schema = 1\nname = \"{name}\"\n{layers}\n{settings}\n");
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    match parse(&format!("{name}.toml"), &text, &no_files) {
        Ok(parsed) => unfitted(parsed.material),
        Err(errors) => panic!("{}", errors.iter().map(|e| e.render(&text)).collect::<String>()),
    }
}

/// A material with the model that it has without a fit.
pub(crate) fn unfitted(mut material: Material) -> Material {
    material.bake.model = Some(material.model_without_fit());
    material
}

/// One conductor, GGX.
pub(crate) fn conductor(ior: &str, alpha: f64) -> String {
    format!("[[layer]]\ntype = \"conductor\"\nior = {ior}\nalpha = {alpha}\n")
}

/// A half-infinite dielectric.
pub(crate) fn dielectric(ior: &str, alpha: f64) -> String {
    format!("[[layer]]\ntype = \"dielectric\"\nior = {ior}\nalpha = {alpha}\n")
}

/// Results that tests share: facets of a slope distribution are costly, and many need them.
pub(crate) static STORE: LazyLock<MemoryStore> = LazyLock::new(MemoryStore::default);

pub(crate) fn no_images(_: &str, _: &luthier_material::PictureRef) -> Result<luthier_lut::Image, String> {
    Err("no images here".to_owned())
}

pub(crate) fn try_bake(materials: &[Material]) -> Result<Baked, BakeError> {
    bake_with(materials, &Options::default(), &no_images, &Silent, &*STORE)
}

/// A bake that computes everything itself, to be compared with another.
pub(crate) fn bake_anew(materials: &[Material]) -> Baked {
    bake(materials, &no_images, &Silent).unwrap()
}

pub(crate) fn bake_all(materials: &[Material]) -> Baked {
    try_bake(materials).unwrap()
}

pub(crate) fn atlas(bake: &Baked, kind: TableKind) -> &Atlas {
    bake.atlases.iter().find(|a| a.kind == kind).unwrap()
}
