//! Materials of a glTF file as the judge takes them: bakes in memory, and the formula of the format.

use luthier_export::Package;
use luthier_import::GltfPoint;
use luthier_layers::engines::gltf;
use luthier_material::{Material, VariationSource};
use luthier_optics::Rgb;
use luthier_optics::dielectric_albedo::JointMasking;
use luthier_report::{FilmMap, FilmSource, Subject, SurfaceMap};
use luthier_terminal::{Failure, Outcome};

use super::scene_file::Laid;

/// Bakes in memory as the judge takes them.
pub(crate) fn subject<'a>(package: &'a Package, laid: &Laid) -> Outcome<Subject<'a>> {
    let of = |name: &str| laid.materials.iter().find(|material| material.name == name);
    let entries = package.manifest.materials.iter();
    let named: Vec<&Material> = entries.filter_map(|entry| of(&entry.name)).collect();
    let stacks = named.iter().map(|material| material.reflecting_stack().into_owned()).collect();
    let maps = package.maps.iter().map(|map| SurfaceMap {
        material: map.material,
        slot: map.slot,
        layer: map.layer,
        picture: map.picture.clone(),
    });
    let mut films = Vec::new();
    for (material, own) in (0..).zip(&named) {
        for (layer, extras) in (0..).zip(&own.layers) {
            let Some(variation) = &extras.film_variation else { continue };
            let VariationSource::Image(picture) = &variation.source else { continue };
            let image = luthier::read_image(&own.source, picture)
                .map_err(|reason| Failure::Input(anyhow::anyhow!("{}: {reason}", picture.path)))?;
            films.push(FilmMap { material, layer, source: FilmSource::Image(image), extent_um: variation.extent_um });
        }
    }
    Ok(Subject { manifest: &package.manifest, textures: package.textures()?, stacks, maps: maps.collect(), films })
}

/// The formula at a place, with the masking that its text prints: the extension for anisotropy has another than the appendix.
pub(crate) fn formula(point: &GltfPoint) -> impl Fn(glam::DVec3, glam::DVec3) -> Rgb + use<> {
    let GltfPoint { base_color, metallic, alpha, turn, f0, specular, coat } = *point;
    let coat = coat.map(|[weight, alpha]| gltf::Coat { weight, alpha });
    let masking = if alpha[0] == alpha[1] { JointMasking::Separable } else { JointMasking::Correlated };
    let material = gltf::Material { base_color, metallic, alpha, turn, f0, specular, coat, masking };
    move |wi, wo| material.eval(wi, wo)
}
