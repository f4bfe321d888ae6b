//! Layers of the materials of a model, depth by depth: a shader has one step for each depth.

use luthier_manifest::{LayerKind, LayerRecord, ShadingModel};

use crate::MaterialSet;

/// Whether a layer is a diffuse base.
pub(super) fn is_diffuse(layer: &LayerRecord) -> bool {
    layer.kind == LayerKind::Diffuse
}

/// The layers of each material of a model.
pub(super) fn stacks<'a>(set: &'a MaterialSet<'_>, model: ShadingModel) -> Vec<&'a [LayerRecord]> {
    set.materials.iter().filter(|m| m.model == model).map(|m| m.layers.as_slice()).collect()
}

/// Whether each stack is a diffuse base alone.
pub(super) fn are_bases(stacks: &[&[LayerRecord]]) -> bool {
    stacks.iter().all(|layers| layers.first().is_some_and(is_diffuse))
}

/// Number of layers of the shortest and of the longest stack.
pub(super) fn depths(stacks: &[&[LayerRecord]]) -> (usize, usize) {
    let lengths = stacks.iter().map(|layers| layers.len());
    (lengths.clone().min().unwrap_or(0), lengths.max().unwrap_or(0))
}

/// Whether some, and whether all of the layers at a depth are diffuse bases.
pub(super) fn diffuse_at(stacks: &[&[LayerRecord]], depth: usize) -> (bool, bool) {
    let mut here = stacks.iter().filter_map(|layers| layers.get(depth));
    (here.clone().any(is_diffuse), here.all(is_diffuse))
}

/// Statements for the layers at a depth: those of a base, those of an interface, or a choice between them where stacks differ.
pub(super) fn step(
    diffuse: (bool, bool),
    layer: &str,
    base: impl IntoIterator<Item = String>,
    interface: impl IntoIterator<Item = String>,
) -> Vec<String> {
    match diffuse {
        (false, _) => interface.into_iter().collect(),
        (true, true) => base.into_iter().collect(),
        (true, false) => {
            let mut lines = vec![format!("if {layer}.kind == LUTHIER_DIFFUSE {{")];
            lines.extend(base.into_iter().map(|line| format!("    {line}")));
            lines.push("} else {".to_owned());
            lines.extend(interface.into_iter().map(|line| format!("    {line}")));
            lines.push("}".to_owned());
            lines
        }
    }
}
