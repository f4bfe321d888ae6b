//! Surfaces that cannot be baked with their materials, and doubts about them.

use std::collections::BTreeMap;

use luthier_layers::effects::heterogeneous::{Switch, SwitchShare, switch_shares};
use luthier_material::{Diagnostic, Material, NamedMaterial, Surface, SurfaceSwitch};

use super::surface::switch_of;
use super::{Source, SurfaceSource};

/// Makes surfaces unusable that cannot be baked with these materials, those of [`Sources::materials`](crate::Sources::materials): names that another
/// surface or material has, and particles whose material has a normal of its own.
pub(super) fn refuse_surfaces(surfaces: &mut [SurfaceSource], materials: &[Source]) {
    let parsed: Vec<Option<&Material>> = materials.iter().map(Source::material).collect();
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for material in parsed.iter().flatten() {
        let constant = luthier_shader::surface_identifier(&material.name).unwrap_or_default();
        names.insert(constant, format!("the material of {}", material.place("name")));
    }
    for source in surfaces {
        let Ok(surface) = &source.parsed else { continue };
        let mut errors = Vec::new();
        match luthier_shader::surface_identifier(&surface.name) {
            Err(error) => errors.push(surface.of_name(error.to_string())),
            Ok(constant) => {
                if let Some(other) = names.get(&constant) {
                    errors.push(surface.of_name(format!("{other} has this name, or one that is the same in a shader")));
                }
                names.insert(constant, format!("the surface {}", source.label));
            }
        }
        let grains = source.numbers.len() - surface.particles().len();
        let particles = surface.particles().iter().zip(&source.numbers[grains..]);
        errors.extend(particles.filter_map(|(named, number)| turned(surface, named, parsed.get(*number).copied()??)));
        if !errors.is_empty() {
            source.parsed = Err(errors);
        }
    }
}

/// An error about a particle that has a normal of its own.
fn turned(surface: &Surface, named: &NamedMaterial, material: &Material) -> Option<Diagnostic> {
    let has_map = material.layers.first().is_some_and(|layer| layer.maps.normal.is_some());
    let what = match (has_map, material.effects.glitter.is_some()) {
        (true, _) => "a normal map",
        (_, true) => "glitter",
        _ => return None,
    };
    let message = format!("{} has {what}, and a particle has the normal of its tilt", named.file);
    Some(surface.diagnostic(named, message, "name a material without it, or put this one into `cells`"))
}

/// Share of a surface below which grains count as unseen.
const UNSEEN: f64 = 1e-3;

/// Warns about switches whose grains cover less than a thousandth of a surface: the noise hardly reaches their range, their share of the tiles is
/// small, or earlier switches of the file take their places.
pub(super) fn doubt_surfaces(surfaces: &mut [SurfaceSource]) {
    for source in surfaces {
        let Ok(surface) = &source.parsed else { continue };
        source.warnings = unseen(surface);
    }
}

/// A warning for each switch with unseen grains.
fn unseen(surface: &Surface) -> Vec<Diagnostic> {
    let switches: Vec<Switch> = surface.switches.iter().map(|switch| switch_of(&switch.by)).collect();
    let shares = switch_shares(&switches);
    let unseen = surface.switches.iter().zip(&shares).filter(|(_, share)| share.seen < UNSEEN);
    unseen.map(|(switch, share)| unseen_grains(surface, switch, share)).collect()
}

/// The warning for grains that a switch hardly shows.
fn unseen_grains(surface: &Surface, switch: &SurfaceSwitch, share: &SwitchShare) -> Diagnostic {
    let message = format!("these grains are on less than {} % of the surface", 100.0 * UNSEEN);
    let hint = match share.noise {
        _ if share.own >= UNSEEN => "switches before it in the file have its places: put it before them".to_owned(),
        Some([least, most]) => {
            format!(
                "this noise is from {least:.2} to {most:.2} nearly everywhere: choose a range inside, or a wider one"
            )
        }
        None => "give it a larger `share`".to_owned(),
    };
    surface.of_switch(switch, message, hint)
}
