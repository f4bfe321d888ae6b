//! The shaders of a package.

use std::ops::Range;

use luthier_export::{Map, Package, Shader};
use luthier_manifest::{Form, Interface, MaterialTexture, Names, Target, material_buffer};
use luthier_shader::{MaterialSet, ShaderError};
use rayon::prelude::*;

use crate::Error;

/// Emits and validates the shaders, and lists the bindings of the first form in the manifest.
pub(super) fn emit(package: &mut Package, targets: &[Target], forms: &[Form]) -> Result<(), Error> {
    let manifest = &mut package.manifest;
    manifest.material_texture = MaterialTexture::of(material_buffer(&manifest.materials).len());
    let names = manifest.names.clone();
    let set = MaterialSet { names: names.clone(), ..MaterialSet::from_manifest(manifest) };
    // A form has one interface in all languages.
    let sets = forms.par_iter().map(|&form| {
        let set = set.in_form(form);
        let mut interface = luthier_shader::interface(&set, form)?;
        names.in_interface(Names::named, &mut interface);
        Ok((form, set, interface))
    });
    let sets = sets.collect::<Result<Vec<_>, ShaderError>>()?;
    let wanted: Vec<_> = sets.iter().flat_map(|set| targets.iter().map(move |&to| (set, to))).collect();
    let shaders = wanted.into_par_iter().map(|((form, set, interface), target)| shader(set, *form, interface, target));
    package.shaders = shaders.collect::<Result<_, ShaderError>>()?;
    let mut bindings = luthier_shader::bindings(&set, forms.first().copied().unwrap_or(Form::Baked));
    bindings.iter_mut().for_each(|entry| entry.name = names.named(&entry.name));
    manifest.bindings = bindings;
    Ok(())
}

/// The text or the SPIR-V of a set of materials in a form, with the interface of the form.
fn shader(set: &MaterialSet, form: Form, interface: &Interface, target: Target) -> Result<Shader, ShaderError> {
    let bytes = match target {
        Target::SpirV => luthier_shader::emit_spirv(set, form),
        _ => luthier_shader::emit(set, form, target).map(String::into_bytes),
    };
    Ok(Shader { form, target, bytes: bytes?, interface: interface.clone(), checks: luthier_shader::checks(target) })
}

/// A package of some materials of another, by number: with all tables, without surfaces, and with shaders for these materials alone, in the forms that some of
/// them have.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, of_materials, parse};
///
/// let plain = |name: &str| format!("schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n");
/// let materials = [parse("chalk.toml", &plain("chalk"))?, parse("plaster.toml", &plain("plaster"))?];
/// let all = Bake::wgsl(&[Form::Full]).package(&materials, &MemoryStore::default())?;
/// let plaster = of_materials(&all, 1..2)?;
/// assert_eq!(plaster.manifest.material_index("plaster"), Some(0));
/// assert!(!plaster.wgsl(Form::Full)?.contains("CHALK"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Shader`].
pub fn of_materials(all: &Package, numbers: Range<usize>) -> Result<Package, Error> {
    let mut package = all.clone();
    package.manifest.materials = all.manifest.materials[numbers.clone()].to_vec();
    package.manifest.surfaces.clear();
    package.maps.retain(|map| numbers.contains(&(map.material as usize)));
    package.maps.iter_mut().for_each(|map: &mut Map| map.material -= numbers.start as u32);
    let (mut targets, mut forms) = (Vec::new(), Vec::new());
    for Shader { form, target, .. } in &all.shaders {
        if !targets.contains(target) {
            targets.push(*target);
        }
        if !forms.contains(form) {
            forms.push(*form);
        }
    }
    forms.retain(|&form| package.manifest.has(form));
    emit(&mut package, &targets, &forms)?;
    Ok(package)
}
