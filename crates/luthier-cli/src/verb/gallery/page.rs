//! Many materials as a page for browsers.

use std::path::{Path, PathBuf};

use luthier::refusals::of_domain;
use luthier::{Bake, lit, read_materials};
use luthier_export::{MANIFEST, Package, label, origin};
use luthier_gallery::{Exhibit, Gallery, Look, Scenery, hidden_maps};
use luthier_manifest::{Form, LobesForm, ShadingModel};
use luthier_material::{CrossSection, Diagnostic, Material};
use luthier_scene::CostTable;
use luthier_terminal::{Failure, Outcome, complain, deliver};

use crate::cli::GalleryOptions;
use crate::materials::{bakeable, is_shaded_by, shade_by};
use crate::store::store;

/// Surroundings that a page has beside the studio.
const SKIES: [Scenery; 2] = [Scenery::CloudySun, Scenery::EveningRoom];

/// Side of a simulated picture.
#[cfg(feature = "gpu")]
const SIMULATED_PIXELS: u32 = 192;

/// Writes the page.
pub(super) fn write(options: &GalleryOptions, html: &Path) -> Outcome {
    #[cfg(feature = "gpu")]
    if options.simulated.is_none() && options.sheet.look.adapter.is_some() {
        return Err(Failure::Usage(anyhow::anyhow!("a page is drawn by a browser: --adapter is for --simulated")));
    }
    let (bakes, rest): (Vec<_>, Vec<_>) = options.sources.paths.iter().partition(|path| path.join(MANIFEST).is_file());
    if let Some(bake) = bakes.first() {
        refuse_for_bakes(options, bake)?;
    }
    let mut gallery =
        Gallery { title: title(options), packages: Vec::new(), exhibits: Vec::new(), skies: SKIES.to_vec() };
    for folder in bakes {
        let mut package = Package::read(folder)?;
        for (number, entry) in (0..).zip(&mut package.manifest.materials) {
            // Pages name files by their paths from the current folder.
            entry.source = label(&origin(folder, &entry.source));
            let mut exhibit = Exhibit::new(&entry.name, vec![Look::new(gallery.packages.len(), number)]);
            exhibit.section = Some(CrossSection::recorded(entry));
            gallery.exhibits.push(exhibit);
        }
        gallery.packages.push(package);
    }
    if !rest.is_empty() {
        let paths: Vec<PathBuf> = rest.into_iter().cloned().collect();
        let materials = bakeable(read_materials(&paths)?, &options.shading.in_forms(&[]), false)?;
        add(&mut gallery, options, &materials)?;
    }
    left_out(&gallery);
    let page = gallery.html().map_err(Failure::input)?;
    deliver(&page, Some(html))
}

/// Refuses options that decide how materials are baked, or which: they have no effect on a bake that is read.
fn refuse_for_bakes(options: &GalleryOptions, bake: &Path) -> Outcome {
    let shading = &options.shading;
    let asked = [
        (shading.model.is_some(), "--model"),
        (shading.no_fit, "--no-fit"),
        (shading.fresnel.is_some(), "--fresnel"),
        (!shading.tables.is_empty(), "--tables"),
        (!options.compare.is_empty(), "--compare"),
        #[cfg(feature = "gpu")]
        (options.simulated.is_some(), "--simulated"),
    ];
    let asked: Vec<&str> = asked.into_iter().filter(|(is_asked, _)| *is_asked).map(|(_, name)| name).collect();
    if asked.is_empty() {
        return Ok(());
    }
    let (asked, are) = (asked.join(" and "), if asked.len() > 1 { "are" } else { "is" });
    Err(Failure::Usage(anyhow::anyhow!(
        "{asked} {are} for material files, and `{}` is a bake, whose models and tables stand: leave out {asked}, or name the material files in \
         place of the bake",
        bake.display()
    )))
}

/// Title of the page: the name of the only file or folder.
fn title(options: &GalleryOptions) -> String {
    match options.sources.paths.as_slice() {
        [one] => one.file_stem().map(|name| name.to_string_lossy().into_owned()).filter(|name| name != "materials"),
        _ => None,
    }
    .unwrap_or_else(|| "Materials".to_owned())
}

/// Warns about parts of materials that the page does not show.
fn left_out(gallery: &Gallery) {
    for manifest in gallery.packages.iter().map(|package| &package.manifest) {
        for surface in &manifest.surfaces {
            complain(&format!(
                "warning: {} is a surface of several materials; the page shows the materials",
                surface.name
            ));
        }
    }
    for exhibit in &gallery.exhibits {
        let Some(look) = exhibit.looks.first() else { continue };
        let entry = &gallery.packages[look.package].manifest.materials[look.material as usize];
        let hidden: Vec<String> =
            hidden_maps(entry).map(|(layer, slot)| format!("`{}` of layer {layer}", slot.name())).collect();
        if !hidden.is_empty() {
            complain(&format!("warning: {}: the page does not show the maps {}", entry.name, hidden.join(", ")));
        }
    }
}

/// Adds materials with their own models, and with the models to compare.
fn add(gallery: &mut Gallery, options: &GalleryOptions, materials: &[Material]) -> Outcome {
    let costs = CostTable::rdna2();
    let first = gallery.exhibits.len();
    let own = package(materials)?;
    for (number, material) in (0..).zip(materials) {
        let mut exhibit = Exhibit::new(&material.name, vec![look(gallery, &own, number, material, &costs)]);
        exhibit.description.clone_from(&material.description);
        exhibit.text = Some(material.text.clone());
        exhibit.section = Some(material.cross_section());
        gallery.exhibits.push(exhibit);
    }
    gallery.packages.push(own);
    for model in ShadingModel::ALL {
        let (mut numbers, mut shaded) = (Vec::new(), Vec::new());
        for (number, material) in materials.iter().enumerate() {
            if !is_wanted(material, model, &options.compare) || !is_shaded_by(material, model, &options.compare) {
                continue;
            }
            let mut material = material.clone();
            shade_by(&mut material, model, options.shading.fresnel)?;
            if let Some(outside) = of_domain(&material, None).into_iter().find(Diagnostic::is_error) {
                complain(&format!("warning: {} is left out of {}: {}", material.name, model.name(), outside.message));
                continue;
            }
            numbers.push(first + number);
            shaded.push(material);
        }
        if shaded.is_empty() {
            continue;
        }
        let compared = package(&shaded)?;
        for (i, (number, material)) in (0..).zip(numbers.into_iter().zip(&shaded)) {
            let look = look(gallery, &compared, i, material, &costs);
            gallery.exhibits[number].looks.push(look);
        }
        gallery.packages.push(compared);
    }
    #[cfg(feature = "gpu")]
    if let Some(samples) = options.simulated {
        simulate(&mut gallery.exhibits[first..], materials, samples, options.sheet.look.adapter.as_deref())?;
    }
    Ok(())
}

/// A bake for the page, with the tables of blurred surroundings and without shaders, which the page emits itself.
fn package(materials: &[Material]) -> Outcome<Package> {
    let bake = Bake { targets: Vec::new(), ..Bake::default() };
    Ok(bake.package(&lit(materials), store()?)?)
}

/// A look of a material of the next package, with the cycles of its shaders.
fn look(gallery: &Gallery, package: &Package, number: u32, material: &Material, costs: &CostTable) -> Look {
    let shape = luthier_scene::shape(&material.stack);
    let lobes = package.manifest.materials[number as usize].constants.lobes.as_ref().and_then(LobesForm::of);
    let costs = costs.clone().reading(&package.manifest);
    let cycles = Form::ALL.into_iter().filter_map(|form| {
        let (cycles, is_of_similar) = costs.cost(material.model(), form, &shape, lobes)?;
        let about = if is_of_similar { "about " } else { "" };
        Some((form, format!("{about}{cycles:.0}")))
    });
    Look { cycles: cycles.collect(), ..Look::new(gallery.packages.len(), number) }
}

/// True where a model is to be compared with the material's own. If none is asked for, that is `belcour`, or `elek` for a material of `belcour`.
fn is_wanted(material: &Material, model: ShadingModel, asked: &[ShadingModel]) -> bool {
    let other = if material.model() == ShadingModel::Belcour { ShadingModel::Elek } else { ShadingModel::Belcour };
    let asked = if asked.is_empty() { &[other] } else { asked };
    material.model() != model && asked.contains(&model)
}

/// Adds pictures by simulation to the exhibits of materials.
#[cfg(feature = "gpu")]
fn simulate(exhibits: &mut [Exhibit], materials: &[Material], samples: u32, adapter: Option<&str>) -> Outcome {
    use luthier_gpu::{RenderSettings, Shape, Shown};

    use crate::simulated;

    let gpu = luthier_terminal::open(adapter)?;
    let settings = RenderSettings { size: SIMULATED_PIXELS, ..RenderSettings::new(Shape::Sphere)? };
    for (exhibit, material) in exhibits.iter_mut().zip(materials) {
        if let Some(refusal) = simulated::beyond(material).first() {
            complain(&format!("warning: {} has no simulated picture: {}", material.name, refusal.message));
            continue;
        }
        let package = simulated::package(vec![material.clone()])?;
        let picture = simulated::picture(&gpu, &package, &[Shown::Material(0)], &settings, samples, |_| Ok(()))?;
        exhibit.simulated = Some(luthier_gallery::Simulated { image: picture.image, samples });
    }
    Ok(())
}
