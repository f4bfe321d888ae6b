//! Features: the words that conditions in the modules may name.

use std::collections::BTreeSet;

use luthier_lut::TableKind;
use luthier_manifest::{
    FunctionGroup, InternalReflection, LayerKind, LayerRecord, LobesRecord, MapSlot, Masking, MaterialEntry,
    PaintedRecord, Reflectance, ShadingModel, SwitchBy, VaryingFactor,
};
use luthier_model::{Family, Reach};

use crate::compose::masking;
use crate::{Form, MaterialSet};

/// Distributions beside those of Beckmann and of GGX.
const FREE: [&str; 3] = ["blinn", "abc", "sgd"];

/// Features that the materials of a set use: the words that conditions in the modules may name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Features(BTreeSet<&'static str>);

impl Features {
    /// Every word there is but the names of tables, for the check that modules name no other.
    #[cfg(test)]
    const ALL: &str = "abc absorption anisotropic bare base_color beckmann below bent bilinear blinn cavities chain chain_diffuse chain_patina clamped closed coat computed conductor critical_view diffuse environment exact face film film_table fitted flakes fluorescent folded free_slopes full ggx glitter granier granier_bare granier_base granier_film granier_own granier_schlick granier_tilted granier_transparent interface internal lazanyi lobes_axes lobes_bare_base lobes_base \
        lobes_diffuse lobes_film lobes_patina lobes_tilted mask_implicit mask_kelemen \
        mask_schlick_smith mask_smith mask_smith_separable mask_v_cavity masked media microfacet_diffuse mixed noise one_lobe \
        layered oren_nayar own_alphas own_angles own_f0 own_normals own_slabs packed particles patina phong picks place powers rows schlick schlick_base several several_maskings several_reflectances several_slopes sgd smith split_root statistics statistics_base surface tabled tangents theta_axis tilted \
        total_reflection two_lobes visible";

    pub(crate) fn of(set: &MaterialSet<'_>, form: Form) -> Self {
        let mut names = BTreeSet::new();
        for material in set.materials {
            names.extend(of_model(material));
            if material.varies() {
                names.insert("place");
            }
            for (_, slot) in material.shown_layer_maps(form) {
                names.extend(match slot {
                    MapSlot::Albedo if has_base_light(material) => &["base_color", "lobes_base"][..],
                    MapSlot::Albedo => &["base_color"],
                    MapSlot::BaseColor | MapSlot::Metallic => &["layered", "own_f0", "base_color"],
                    MapSlot::Bumps => &["layered", "own_normals"],
                    MapSlot::Tangent => &["layered", "tangents"],
                    MapSlot::Thickness => &["layered", "own_slabs"],
                    _ => &["layered", "own_alphas"],
                });
            }
            // Rows over a factor have the shape of the remainder beside the light of the base.
            if painted(material).is_some_and(|base| base.moments.is_some()) {
                names.insert("lobes_base");
            }
            if material.constants.glitter.is_some() {
                names.insert("glitter");
            }
        }
        if !set.surfaces.is_empty() {
            names.extend(["picks", "place"]);
        }
        if set.surfaces.iter().any(|surface| surface.glitter.is_some()) {
            names.insert("particles");
        }
        let mut switches = set.surfaces.iter().flat_map(|surface| &surface.switches);
        if switches.any(|switch| matches!(switch.by, SwitchBy::Noise { .. })) {
            names.insert("noise");
        }
        if set.models().any(|model| model.is_statistical() && has_base(set, model)) {
            names.insert("statistics_base");
        }
        if set.models().any(|model| is_mixed(set, model)) {
            names.insert("mixed");
        }
        if set.models().any(|model| model.is_path() && ends_early(set, model)) {
            names.insert("conductor");
        }
        if set.functions.has(FunctionGroup::Surface) {
            names.extend(["place", "surface"]);
            if names.contains("chain") && names.contains("below") {
                names.insert("flakes");
            }
            if set.materials.iter().any(has_coat) {
                names.extend(["flakes", "lobes_tilted"]);
            }
            if set.materials.iter().any(has_base_light) {
                names.insert("lobes_base");
            }
            if ["diffuse", "granier_base", "lobes_base"].iter().any(|name| names.contains(name)) {
                names.insert("base_color");
            }
        }
        if form == Form::Full {
            names.insert("full");
        }
        // The inner boundary of a film leans where a material says so, and where a place does.
        if names.contains("granier_transparent") && names.contains("place") {
            names.insert("granier_tilted");
        }
        let has = |name| names.contains(name);
        if has("lobes_tilted") || has("below") && has("statistics") || has("granier_schlick") {
            names.insert("bent");
        }
        for table in set.tables_read(form) {
            names.insert(feature(table.kind));
            if let (TableKind::Lobes, Some(parts)) = (table.kind, &table.layout.y) {
                // The last part is the albedo, and each lobe has two between it and part 0.
                names.extend(match parts.max as u32 {
                    3 => Some("one_lobe"),
                    5 => Some("two_lobes"),
                    _ => None,
                });
            }
            if !table.format.is_filterable() {
                names.insert("bilinear");
            }
        }
        // Without a table, D is computed; so it is for layers without a tile.
        let has_facets =
            names.contains("smith") || names.contains("coat") || names.contains("chain") && names.contains("interface");
        if form == Form::Full || has_facets && !names.contains("distribution") {
            names.insert("closed");
        }
        // Slope parameters that vary may come in any order; those along two axes are one for Elek's model.
        let has_elek = set.models().any(|model| model == ShadingModel::Elek);
        if has_elek && names.contains("chain") && ["place", "anisotropic"].iter().any(|name| names.contains(name)) {
            names.insert("clamped");
        }
        let free = FREE.iter().filter(|name| names.contains(**name)).count();
        if free > 0 {
            names.insert("free_slopes");
        }
        if free + ["beckmann", "ggx"].iter().filter(|name| names.contains(**name)).count() > 1 {
            names.insert("several_slopes");
        }
        if set.shows_environment(form) {
            names.insert("environment");
        }
        names.extend(of_parts(set, form, &names));
        if !set.functions.is_eval_alone() {
            names.extend(of_face(set, &names));
        }
        Self(names)
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.contains(name)
    }

    /// The features, and a word that holds for one module only.
    pub(crate) fn with(&self, name: &'static str, holds: bool) -> Self {
        let mut names = self.0.clone();
        if holds {
            names.insert(name);
        }
        Self(names)
    }
}

/// Words for the parts that materials choose: the maskings of lobes, and where reflectances come from, of which each layer has one.
fn of_parts(set: &MaterialSet<'_>, form: Form, names: &BTreeSet<&'static str>) -> Vec<&'static str> {
    let has = |name| names.contains(name);
    let is_read = has("tabled") && (has("fresnel") || has("film_table"));
    let is_computed = has("exact") || form == Form::Full && has("tabled");
    let sources = [is_read, is_computed, has("fitted")].iter().filter(|holds| **holds).count();
    let maskings = masking::used(set);
    let is_masked = maskings.iter().any(|masking| *masking != Masking::default());
    let records = || set.materials.iter().flat_map(MaterialEntry::records);
    let is_packed =
        |record: &LayerRecord| (record.masking, record.reflectance) != (Masking::default(), Reflectance::default());
    let is_whole = |record: &LayerRecord| record.internal_reflection != InternalReflection::default();
    let is_own = |record: &LayerRecord| record.internal_reflection == InternalReflection::Directions;
    let has_whole = records().any(is_whole);
    let words = [
        ("rows", is_read),
        ("computed", is_computed),
        ("several_reflectances", sources > 1),
        ("masked", is_masked),
        ("several_maskings", maskings.len() > 1),
        ("packed", has_whole || records().any(is_packed)),
        ("internal", has_whole && has("chain") && has("below")),
        ("own_angles", records().any(is_own) && has("chain") && has("below")),
    ];
    let chosen = words.into_iter().filter(|(_, holds)| *holds).map(|(name, _)| name);
    chosen.chain(maskings.into_iter().filter(|_| is_masked).map(masking::word)).collect()
}

/// Words for functions beside `luthier_eval`: lobes of visible normals, those of V-cavities, and of powers of a cosine; whether some are below boundaries, and
/// tilted there; whether draws that do not leave are folded back; whether a material has to say which model it is of.
fn of_face(set: &MaterialSet<'_>, names: &BTreeSet<&'static str>) -> Vec<&'static str> {
    let has = |name| names.contains(name);
    let visible = has("chain") || has("smith") || has("statistics");
    let powers = has("phong") || has("granier") && has("interface");
    let tilted = has("flakes") || has("own_normals") || has("granier_tilted");
    let words = [
        ("face", true),
        ("visible", visible),
        ("cavities", visible && has("blinn") && (has("chain") || has("smith"))),
        ("powers", powers),
        ("media", has("chain") && has("below") || has("granier_transparent")),
        ("tilted", tilted),
        // Tilted boundaries have no cone about one normal through which all light leaves.
        ("folded", set.functions.has(FunctionGroup::Sample) && (visible || powers) && !tilted),
        ("several", set.models().count() > 1 || has("lobes") && has("lobes_diffuse")),
    ];
    words.into_iter().filter(|(_, holds)| *holds).map(|(name, _)| name).collect()
}

/// The word for a table that is read; `film` is whether any layer has one.
pub(crate) fn feature(table: TableKind) -> &'static str {
    if table == TableKind::Film { "film_table" } else { table.name() }
}

/// The features of the layers that a material's model reads.
fn of_model(material: &MaterialEntry) -> BTreeSet<&'static str> {
    let mut names = BTreeSet::new();
    let is_diffuse = |layer: &LayerRecord| layer.kind == LayerKind::Diffuse;
    let facts = material.model.facts();
    let layers = match facts.reach {
        Reach::None => {
            names.insert("phong");
            return names;
        }
        Reach::First | Reach::FirstAndBase => &material.layers[..material.layers.len().min(1)],
        Reach::All => material.layers.as_slice(),
    };
    let is_path = material.model.is_path();
    let is_covered = is_under_patina(material);
    let shows_patina = is_path || is_covered;
    let bare = material.constants.patina.as_ref().filter(|_| shows_patina).map(|patina| &patina.bare);
    for layer in layers.iter().chain(bare) {
        if is_diffuse(layer) && facts.reach == Reach::FirstAndBase {
            continue;
        }
        if is_diffuse(layer) {
            names.insert("diffuse");
            if layer.sigma != 0.0 {
                names.insert("oren_nayar");
            }
            if layer.reradiation.is_some() && is_path {
                names.insert("fluorescent");
            }
            continue;
        }
        names.insert("interface");
        names.insert(layer.distribution.name());
        names.extend(match layer.reflectance {
            Reflectance::Table => &["tabled"][..],
            Reflectance::Exact => &["exact"],
            Reflectance::Approximate => &["fitted"],
            Reflectance::Lazanyi => &["fitted", "lazanyi"],
        });
        names.insert(match layer.f0 {
            Some(_) => "schlick",
            None if layer.film_ior_n[0] > 0.0 => "film",
            None => "bare",
        });
        if layer.critical_cot_sq > 0.0 {
            names.insert("total_reflection");
        }
        let rows = material.constants.lobes.filter(|_| material.model.is_fitted());
        if rows.is_some_and(|rows| rows.critical_cot_sq > 0.0) {
            names.insert("critical_view");
        }
        if rows.is_some_and(|rows| rows.axes.is_some()) {
            names.insert("lobes_axes");
        }
        if rows.is_some_and(|rows| is_over_film(&rows)) {
            names.insert("lobes_film");
        }
        if material.model.reads_some(TableKind::Distribution) && layer.tiles[TableKind::Distribution].is_none() {
            names.insert("closed");
        }
        if layer.kind == LayerKind::Conductor && !is_path {
            names.insert("conductor");
        }
        let turns = [MapSlot::AlphaX, MapSlot::AlphaY, MapSlot::Tangent];
        let is_turned = material.maps.iter().any(|map| turns.contains(&map.slot));
        if !facts.is_isotropic && (layer.alpha_xy[0] != layer.alpha_xy[1] || is_turned) {
            names.insert("anisotropic");
        }
    }
    for pair in layers.windows(2) {
        if pair[0].kind == LayerKind::Dielectric {
            names.insert("below");
            if pair[0].optical_depth.iter().any(|&depth| depth != 0.0) {
                names.insert("absorption");
            }
        }
    }
    let (has_interface, has_diffuse) = (names.contains("interface"), names.contains("diffuse"));
    match facts.family {
        Family::Facets if has_interface => names.insert("smith"),
        Family::Lobes if has_interface => {
            if material.constants.flakes.is_some() && has_coat(material) {
                names.extend(["flakes", "lobes_tilted"]);
            }
            if is_covered {
                names.extend(["patina", "lobes_patina"]);
            }
            if is_covered && has_diffuse {
                names.insert("lobes_bare_base");
            }
            names.insert("coat")
        }
        Family::Lobes => names.insert("lobes_diffuse"),
        Family::Facets => names.insert("microfacet_diffuse"),
        // Beside a coat it is a step of the chain; alone in its set it needs none.
        Family::Path if !has_interface => names.insert("chain_diffuse"),
        Family::Path => {
            if has_diffuse {
                names.insert("chain_diffuse");
            }
            if material.model == ShadingModel::Elek && gets_smoother(layers) {
                names.insert("clamped");
            }
            // Beside these and `lobes`, models have no layer below the first interface that flakes could tilt or patina cover.
            if material.constants.flakes.is_some() && names.contains("below") {
                names.insert("flakes");
            }
            if material.constants.patina.is_some() {
                names.extend(["patina", "chain_patina"]);
            }
            names.insert("chain")
        }
        Family::Statistics if has_interface => names.insert("statistics"),
        Family::Beams => {
            let first = &material.layers[0];
            let has_film = first.film_ior_n[0] > 0.0;
            if has_film {
                names.insert("granier_film");
            }
            if first.f0.is_some() && first.kind == LayerKind::Dielectric {
                names.insert("granier_schlick");
            }
            if let Some(beams) = &material.constants.beams {
                names.insert("granier_own");
                if beams.inner_normal[2] < 1.0 {
                    names.insert("granier_tilted");
                }
            }
            match first.kind {
                _ if has_film => names.insert("granier_transparent"),
                LayerKind::Dielectric => names.insert("granier_transparent"),
                LayerKind::Conductor => names.insert("granier_bare"),
                LayerKind::Diffuse => false,
            };
            if material.layers.last().is_some_and(is_diffuse) {
                names.insert("granier_base");
            }
            names.insert("granier")
        }
        _ => false,
    };
    names
}

/// Whether rows are over the amount of patina, so that the layer below it is seen bare.
fn is_under_patina(material: &MaterialEntry) -> bool {
    let lobes = material.constants.lobes.filter(|_| material.model.is_fitted());
    lobes.and_then(|lobes| lobes.varying).is_some_and(|varying| varying.factor == VaryingFactor::Patina)
        && material.constants.patina.is_some()
}

/// Whether rows are over the thickness of a film.
fn is_over_film(lobes: &LobesRecord) -> bool {
    lobes.varying.is_some_and(|varying| varying.factor == VaryingFactor::FilmFactor)
}

/// Whether the base below lobes may have another colour.
fn has_base_light(material: &MaterialEntry) -> bool {
    painted(material).is_some()
}

/// The base below lobes that may have another colour.
fn painted(material: &MaterialEntry) -> Option<PaintedRecord> {
    material.constants.lobes.filter(|_| material.constants.patina.is_none())?.painted
}

/// Whether what lies below patina is a diffuse base alone.
fn is_bare_base(material: &MaterialEntry) -> bool {
    material.constants.patina.as_ref().is_some_and(|patina| patina.bare.kind == LayerKind::Diffuse)
}

/// Whether lobes come from below a slab, in which what is there may be tilted.
fn has_coat(material: &MaterialEntry) -> bool {
    material.model.is_fitted() && material.layers.first().is_some_and(|first| first.kind == LayerKind::Dielectric)
}

/// Whether an interface is smoother than one above it.
fn gets_smoother(layers: &[LayerRecord]) -> bool {
    let interfaces = || layers.iter().filter(|layer| layer.kind != LayerKind::Diffuse);
    interfaces().zip(interfaces().skip(1)).any(|(above, below)| below.alpha < above.alpha)
}

/// Whether a conductor of a chain lies where another stack goes on: elsewhere what would follow it is not there.
fn ends_early(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    let materials = || set.materials.iter().filter(|m| m.model == model);
    let depth = materials().map(|m| m.layers.len()).max().unwrap_or(0);
    let is_conductor = |layer: &LayerRecord| layer.kind == LayerKind::Conductor;
    materials().any(|m| m.layers.iter().take(depth.saturating_sub(1)).any(is_conductor))
}

/// Whether a model of statistics meets diffuse bases, those of materials without an interface too, in a set that has interfaces.
fn has_base(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    let layers = || set.materials.iter().filter(|m| m.model == model).flat_map(|m| &m.layers);
    let is_diffuse = |layer: &LayerRecord| layer.kind == LayerKind::Diffuse;
    layers().any(is_diffuse) && !layers().all(is_diffuse)
}

/// Whether the layers at some depth of the materials of a model are diffuse bases and interfaces.
fn is_mixed(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    let layers = || set.materials.iter().filter(|m| m.model == model).map(|m| &m.layers);
    let depth = match model.facts().reach {
        Reach::None => 0,
        Reach::First => 1,
        Reach::FirstAndBase | Reach::All => layers().map(Vec::len).max().unwrap_or(0),
    };
    (0..depth).any(|i| {
        let kinds = || layers().filter_map(|layers| layers.get(i)).map(|layer| layer.kind == LayerKind::Diffuse);
        kinds().any(|diffuse| diffuse) && kinds().any(|diffuse| !diffuse)
    }) || set.materials.iter().filter(|m| m.model == model && is_under_patina(m)).any(is_bare_base)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compose::blocks::{features_named, modules, prune};

    #[test]
    fn modules_have_whole_blocks_and_name_no_unknown_feature() {
        for (path, module) in modules() {
            prune(&module, &Features(BTreeSet::new()));
            for word in features_named(&module) {
                let is_known =
                    Features::ALL.split(' ').any(|known| known == word) || TableKind::from_name(word).is_some();
                assert!(is_known, "`{word}` in {}", path.display());
            }
        }
    }
}
