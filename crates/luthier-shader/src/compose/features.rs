//! Features of a set, found in its materials.

use std::collections::BTreeSet;

use luthier_lut::TableKind;
use luthier_manifest::{
    DiffusePart, DiffuseTerm, Distribution, FamilyRecord, FunctionGroup, InternalReflection, LayerKind, LayerRecord,
    LobeHeight, LobesRecord, LowerAlpha, LowerCosine, LowerFacets, MapSlot, Masking, MaterialEntry, PaintedRecord,
    Reflectance, ShadingModel, SwitchBy, VaryingFactor,
};
use luthier_model::{Family, Reach};

use crate::compose::feature::Feature;
use crate::compose::masking;
use crate::compose::stacks::{depths, diffuse_at, is_diffuse, stacks};
use crate::{Form, MaterialSet};

/// Distributions beside those of Beckmann and of GGX.
const FREE: [Feature; 3] = [Feature::Blinn, Feature::Abc, Feature::Sgd];

/// Features of a set: the words that hold in conditions of modules.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Features {
    /// Those that some material has.
    any: BTreeSet<Feature>,
    /// Those that all materials have.
    all: BTreeSet<Feature>,
}

impl Features {
    pub(crate) fn of(set: &MaterialSet<'_>, form: Form) -> Self {
        let mut names = BTreeSet::new();
        let mut all: Option<BTreeSet<Feature>> = None;
        for material in &*set.materials {
            let side = material.side();
            let mut of_sides = of_sides(side.as_ref());
            if side.is_some() && material.shown_layer_maps(form).any(|(_, slot)| slot == MapSlot::Bumps) {
                of_sides.insert(Feature::LobesSideFrames);
            }
            // The layers below a coat with a weight are a material like others, if they have rows.
            let side = side.filter(|side| !side.layers.first().is_some_and(is_diffuse));
            for material in std::iter::once(material).chain(&side) {
                let own = &of_material(material, form) | &of_sides;
                all = Some(all.map_or_else(|| own.clone(), |all| &all & &own));
                names.extend(own);
            }
        }
        if !set.surfaces.is_empty() {
            names.extend([Feature::Picks, Feature::Place]);
        }
        if set.surfaces.iter().any(|surface| surface.glitter.is_some()) {
            names.insert(Feature::Particles);
        }
        let mut switches = set.surfaces.iter().flat_map(|surface| &surface.switches);
        if switches.any(|switch| matches!(switch.by, SwitchBy::Noise { .. })) {
            names.insert(Feature::Noise);
        }
        if set.models().any(|model| model.is_statistical() && has_base(set, model)) {
            names.insert(Feature::StatisticsBase);
        }
        if set.models().any(|model| is_mixed(set, model)) {
            names.insert(Feature::Mixed);
        }
        if set.models().any(|model| model.is_path() && ends_early(set, model)) {
            names.insert(Feature::Conductor);
        }
        if set.functions.has(FunctionGroup::Surface) {
            names.extend([Feature::Place, Feature::Surface]);
            if names.contains(&Feature::Chain) && names.contains(&Feature::Below) {
                names.insert(Feature::Flakes);
            }
            if set.materials.iter().any(has_coat) {
                names.extend([Feature::Flakes, Feature::LobesTilted]);
            }
            if set.materials.iter().any(has_base_light) {
                names.insert(Feature::LobesBase);
            }
            if [Feature::Diffuse, Feature::GranierBase, Feature::LobesBase, Feature::LobesFamily]
                .iter()
                .any(|name| names.contains(name))
            {
                names.insert(Feature::BaseColor);
            }
        }
        if form == Form::Full {
            names.insert(Feature::Full);
        }
        // The inner boundary of a film may lean in a material, and at a place.
        if names.contains(&Feature::GranierTransparent) && names.contains(&Feature::Place) {
            names.insert(Feature::GranierTilted);
        }
        let is_bent_below = names.contains(&Feature::Below) && names.contains(&Feature::Statistics);
        let bending = [Feature::LobesTilted, Feature::LobesLean, Feature::GranierSchlick];
        if is_bent_below || bending.iter().any(|name| names.contains(name)) {
            names.insert(Feature::Bent);
        }
        for table in set.tables_read(form) {
            names.extend(table_read(table.kind));
            if let (TableKind::Lobes, Some(parts)) = (table.kind, &table.layout.y) {
                let sides: Vec<MaterialEntry> = set.materials.iter().filter_map(MaterialEntry::side).collect();
                let records: Vec<LobesRecord> = set.materials.iter().chain(&sides).filter_map(rows_of).collect();
                let lobes: Vec<u32> = records.iter().map(|record| record.lobes).collect();
                // Part 0 is the remainder, and the last part of at most two lobes the albedo. In between are two parts for each lobe, or one where it has one
                // width in all rows. A short lobe has the first of these alone. A third lobe has two parts behind the albedo. Families have two lobes, whatever their parts.
                let (words, most): (&[Feature], u32) = match parts.max as u32 {
                    _ if lobes.contains(&3) => (&[Feature::TwoLobes, Feature::ThreeLobes], 3),
                    _ if names.contains(&Feature::LobesFamily) => (&[Feature::TwoLobes], 2),
                    2 if parts.min == 1.0 => (&[Feature::OneLobe, Feature::LobesOneWidth, Feature::LobesShort], 1),
                    2 => (&[Feature::OneLobe, Feature::LobesOneWidth], 1),
                    3 => (&[Feature::OneLobe], 1),
                    5.. => (&[Feature::TwoLobes], 2),
                    _ => (&[], 0),
                };
                names.extend(words);
                let all = all.get_or_insert_default();
                for (word, has) in FORMS {
                    let is_common = words.contains(&word);
                    if is_common || records.iter().any(has) {
                        names.insert(word);
                    }
                    if is_common || records.iter().all(has) {
                        all.insert(word);
                    }
                }
                if lobes.iter().any(|lobes| *lobes < most) {
                    names.insert(Feature::LobesMixed);
                }
            }
            if !table.format.is_filterable() && !table.format.has_steps() {
                names.insert(Feature::Bilinear);
            }
        }
        // D is computed without a table, and (as `of_model` finds) for layers without a tile.
        let has_facets = names.contains(&Feature::Smith)
            || names.contains(&Feature::Coat)
            || names.contains(&Feature::Chain) && names.contains(&Feature::Interface);
        if form == Form::Full || has_facets && !names.contains(&Feature::Distribution) {
            names.insert(Feature::Closed);
        }
        // Models with one slope parameter clamp it if slope parameters vary, and so may come in any order, or if they differ by axis.
        let has_one_slope = set.models().any(|model| model.is_path() && model.facts().is_isotropic);
        if has_one_slope
            && names.contains(&Feature::Chain)
            && [Feature::Place, Feature::Anisotropic].iter().any(|name| names.contains(name))
        {
            names.insert(Feature::Clamped);
        }
        let free = FREE.iter().filter(|name| names.contains(*name)).count();
        if free > 0 {
            names.insert(Feature::FreeSlopes);
        }
        if free + [Feature::Beckmann, Feature::Ggx].iter().filter(|name| names.contains(*name)).count() > 1 {
            names.insert(Feature::SeveralSlopes);
        }
        if set.shows_environment(form) {
            names.insert(Feature::Environment);
        }
        let mut features = Self { any: names, all: all.unwrap_or_default() };
        features.any.extend(of_parts(set, form, &features));
        if !set.functions.is_eval_alone() {
            features.any.extend(of_face(set, &features));
        }
        features
    }

    pub(crate) fn has(&self, name: Feature) -> bool {
        self.any.contains(&name)
    }

    /// Whether some materials have it, and others lack it.
    pub(crate) fn are_mixed_in(&self, name: Feature) -> bool {
        self.any.contains(&name) && !self.all.contains(&name)
    }

    /// The features, and a word that may hold for one module only.
    pub(crate) fn with(&self, name: Feature, holds: bool) -> Self {
        let mut features = self.clone();
        if holds {
            features.any.insert(name);
        }
        features
    }
}

/// The features of one material.
fn of_material(material: &MaterialEntry, form: Form) -> BTreeSet<Feature> {
    let mut own = of_model(material);
    if material.varies() {
        own.insert(Feature::Place);
    }
    for (_, slot) in material.shown_layer_maps(form) {
        own.extend(match slot {
            MapSlot::Albedo if has_base_light(material) => &[Feature::BaseColor, Feature::LobesBase][..],
            MapSlot::Albedo => &[Feature::BaseColor],
            MapSlot::BaseColor | MapSlot::Metallic => &[Feature::Layered, Feature::OwnF0, Feature::BaseColor],
            MapSlot::F0 => &[Feature::Layered, Feature::OwnF0, Feature::BaseColor, Feature::DielectricF0],
            MapSlot::Lean => &[],
            MapSlot::Bumps if !material.model.is_fitted() => &[Feature::Layered, Feature::OwnNormals],
            MapSlot::Bumps if has_base_light(material) => {
                &[Feature::Layered, Feature::OwnNormals, Feature::LobesBumps, Feature::LobesBase, Feature::LobesLean]
            }
            MapSlot::Bumps if family(material).is_some() && material.layers.last().is_some_and(is_diffuse) => {
                &[Feature::Layered, Feature::OwnNormals, Feature::LobesBumps, Feature::LobesLean]
            }
            MapSlot::Bumps => &[Feature::Layered, Feature::OwnNormals, Feature::LobesBumps],
            MapSlot::Tangent => &[Feature::Layered, Feature::Tangents],
            MapSlot::Thickness => &[Feature::Layered, Feature::OwnSlabs],
            MapSlot::Absorption if material.model.is_fitted() && family(material).is_none() => {
                &[Feature::Layered, Feature::OwnTints, Feature::LobesTints]
            }
            MapSlot::Absorption => &[Feature::Layered, Feature::OwnTints],
            MapSlot::AlphaX | MapSlot::AlphaY => &[Feature::Layered, Feature::OwnAlphas, Feature::OwnWidths],
            _ => &[Feature::Layered, Feature::OwnAlphas],
        });
    }
    if own.contains(&Feature::LobesBumps) && has_inner_interface(material) {
        own.insert(Feature::LobesTilted);
    }
    // Rows over a factor store the shape of the remainder with the light of the base.
    if painted(material).is_some_and(|base| base.moments.is_some()) {
        own.insert(Feature::LobesBase);
    }
    own.extend(of_family(material));
    let interface = material.layers.len().checked_sub(2).map(|number| &material.layers[number]);
    if own.contains(&Feature::OwnF0) && interface.and_then(|layer| layer.f0).is_some_and(|f0| f0 != [ENGINE_F0; 3]) {
        own.insert(Feature::DielectricF0);
    }
    let is_below = family(material).is_some_and(|family| family.interface > 0);
    if own.contains(&Feature::OwnF0) && !is_below {
        own.insert(Feature::FacetsF0);
    }
    if own.contains(&Feature::OwnF0) && material.layers.iter().any(|layer| layer.metal_f82_tint.is_some()) {
        own.insert(Feature::OwnEdge);
    }
    if material.constants.brightening.is_some() {
        own.insert(Feature::Brightened);
    }
    if material.constants.glitter.is_some() {
        own.insert(Feature::Glitter);
    }
    own
}

/// The features of a coat with a weight whose layers below have lobes of their own, and of these if they are a diffuse base alone.
fn of_sides(side: Option<&MaterialEntry>) -> BTreeSet<Feature> {
    let Some(side) = side else { return BTreeSet::new() };
    let base = side.layers.first().filter(|first| is_diffuse(first));
    let words = [
        (Feature::LobesSides, true),
        (Feature::Weight, true),
        (Feature::Place, true),
        (Feature::LobesSideRows, base.is_none()),
        (Feature::LobesSideBases, base.is_some()),
        (Feature::Diffuse, base.is_some()),
        (Feature::OrenNayar, base.is_some_and(|base| base.sigma != 0.0)),
    ];
    words.into_iter().filter(|(_, holds)| *holds).map(|(word, _)| word).collect()
}

/// Words for the parts that materials choose: maskings, sources of reflectances, internal reflections.
fn of_parts(set: &MaterialSet<'_>, form: Form, features: &Features) -> Vec<Feature> {
    let is_tabled = features.has(Feature::Tabled);
    let is_read = is_tabled && (features.has(Feature::Fresnel) || features.has(Feature::FilmTable));
    let is_computed = features.has(Feature::Exact) || form == Form::Full && is_tabled;
    let sources = [is_read, is_computed, features.has(Feature::Fitted)].iter().filter(|holds| **holds).count();
    let maskings = masking::used(set);
    let is_masked = maskings.iter().any(|masking| *masking != Masking::default());
    let is_chain_over = features.has(Feature::Chain) && features.has(Feature::Below);
    let (mut is_packed, mut is_whole, mut is_own, mut is_inside) = (false, false, false, false);
    let (mut is_power, mut is_kelemen, mut is_complex) = (false, false, false);
    for material in set.materials.iter() {
        is_kelemen |= material.model.is_path() && material.records().any(|record| record.masking == Masking::Kelemen);
    }
    for record in set.materials.iter().flat_map(MaterialEntry::records) {
        let computes = record.reflectance == Reflectance::Exact || form == Form::Full;
        is_complex |= computes && !is_diffuse(record) && record.f0.is_none() && !record.has_one_index();
        is_packed |= (record.masking, record.reflectance) != (Masking::default(), Reflectance::default());
        is_whole |= record.internal_reflection != InternalReflection::default();
        is_whole |= record.diffuse_part == DiffusePart::Beside;
        is_power |= record.lower_facets != LowerFacets::default();
        is_own |= record.internal_reflection == InternalReflection::Directions;
        is_inside |= record.lower_cosine == LowerCosine::Inside;
    }
    let is_rougher = features.has(Feature::RougherBelow);
    let is_beyond = is_inside || is_power || is_rougher;
    let words = [
        (Feature::Rows, is_read),
        (Feature::Computed, is_computed),
        (Feature::ComplexIndex, is_complex),
        (Feature::SeveralReflectances, sources > 1),
        (Feature::Masked, is_masked),
        (Feature::SeveralMaskings, maskings.len() > 1),
        (Feature::Packed, is_whole || is_packed || is_beyond),
        (Feature::Beyond, is_beyond),
        (Feature::Internal, is_whole && is_chain_over),
        (Feature::OwnAngles, is_own && is_chain_over),
        (Feature::InnerCosine, is_inside && is_chain_over),
        (Feature::PowerFacets, is_power && is_chain_over),
        (Feature::KelemenCavities, is_kelemen && features.has(Feature::Chain)),
    ];
    let chosen = words.into_iter().filter(|(_, holds)| *holds).map(|(name, _)| name);
    chosen.chain(maskings.into_iter().filter(|_| is_masked).map(masking::word)).collect()
}

/// Words for functions beside `luthier_eval`: the kinds of lobes to draw from, their place below level or tilted boundaries, and the number of
/// models.
fn of_face(set: &MaterialSet<'_>, features: &Features) -> Vec<Feature> {
    let is_faceted = features.has(Feature::Chain) || features.has(Feature::Smith);
    let visible = is_faceted || features.has(Feature::Statistics);
    let powers = features.has(Feature::Phong) || features.has(Feature::Granier) && features.has(Feature::Interface);
    let tilts = [Feature::Flakes, Feature::OwnNormals, Feature::GranierTilted];
    let tilted = tilts.into_iter().any(|name| features.has(name));
    let media = features.has(Feature::Chain) && features.has(Feature::Below);
    let several = features.has(Feature::Lobes) && features.has(Feature::LobesDiffuse);
    let words = [
        (Feature::Face, true),
        (Feature::Visible, visible),
        (Feature::Cavities, is_faceted && features.has(Feature::Blinn)),
        (Feature::Powers, powers),
        (Feature::Media, media || features.has(Feature::GranierTransparent)),
        (Feature::Tilted, tilted),
        // Tilted boundaries have no cone about one normal through which all light leaves.
        (Feature::Folded, set.functions.has(FunctionGroup::Sample) && (visible || powers) && !tilted),
        (Feature::Several, several || set.models().count() > 1),
    ];
    words.into_iter().filter(|(_, holds)| *holds).map(|(name, _)| name).collect()
}

/// The word for a table that is read. That for the table of films is not its name: `film` says that an interface has a film.
fn table_read(table: TableKind) -> Option<Feature> {
    if table == TableKind::Film { Some(Feature::FilmTable) } else { Feature::from_name(table.name()) }
}

/// The word for a distribution of slopes.
fn slopes(distribution: Distribution) -> Feature {
    match distribution {
        Distribution::Beckmann => Feature::Beckmann,
        Distribution::Ggx => Feature::Ggx,
        Distribution::Blinn => Feature::Blinn,
        Distribution::Abc(_) => Feature::Abc,
        Distribution::Sgd(_) => Feature::Sgd,
    }
}

/// The features of the layers that a material's model reads.
fn of_model(material: &MaterialEntry) -> BTreeSet<Feature> {
    let mut names = BTreeSet::new();
    let facts = material.model.facts();
    let layers = match facts.reach {
        Reach::None => {
            names.insert(Feature::Phong);
            return names;
        }
        Reach::First | Reach::FirstAndBase => &material.layers[..material.layers.len().min(1)],
        Reach::All => material.layers.as_slice(),
    };
    let is_path = material.model.is_path();
    let is_covered = is_under_patina(material);
    let shows_patina = is_path || is_covered;
    let bare = material.constants.bare().filter(|_| shows_patina);
    for layer in layers.iter().chain(bare) {
        if is_diffuse(layer) && facts.reach == Reach::FirstAndBase {
            continue;
        }
        if is_diffuse(layer) {
            names.insert(Feature::Diffuse);
            if layer.sigma != 0.0 {
                names.insert(Feature::OrenNayar);
            }
            if layer.reradiation.is_some() && is_path {
                names.insert(Feature::Fluorescent);
            }
            continue;
        }
        names.insert(Feature::Interface);
        names.insert(slopes(layer.distribution));
        names.extend(match layer.reflectance {
            Reflectance::Table => &[Feature::Tabled][..],
            Reflectance::Exact => &[Feature::Exact],
            Reflectance::Approximate => &[Feature::Fitted],
            Reflectance::Lazanyi => &[Feature::Fitted, Feature::Lazanyi],
        });
        names.insert(match layer.f0 {
            Some(_) => Feature::Schlick,
            None if layer.film_ior_n[0] > 0.0 => Feature::Film,
            None => Feature::Bare,
        });
        if layer.f82_tint.is_some() {
            names.insert(Feature::EdgeTint);
        }
        if layer.critical_cot_sq > 0.0 {
            names.insert(Feature::TotalReflection);
        }
        let rows = material.constants.lobes.filter(|_| material.model.is_fitted());
        if rows.is_some_and(|rows| rows.critical_cot_sq > 0.0) {
            names.insert(Feature::CriticalView);
        }
        if rows.is_some_and(|rows| rows.axes.is_some() || rows.varying.is_some()) {
            names.insert(Feature::LobesRows);
        }
        if rows.is_some_and(|rows| is_over_film(&rows)) {
            names.insert(Feature::LobesFilm);
        }
        if material.model.reads_some(TableKind::Distribution) && layer.tiles[TableKind::Distribution].is_none() {
            names.insert(Feature::Closed);
        }
        if layer.kind == LayerKind::Conductor && !is_path {
            names.insert(Feature::Conductor);
        }
        let turns = [MapSlot::AlphaX, MapSlot::AlphaY, MapSlot::Tangent];
        let mut varied = material.maps.iter().map(|map| map.slot).chain(material.live.iter().map(|live| live.slot));
        let is_turned = varied.any(|slot| turns.contains(&slot));
        // Lobes of a family are stretched by all interfaces, of which the model reads the first alone.
        let is_family = rows.is_some_and(|rows| rows.family().is_some());
        let below = if is_family { material.layers.as_slice() } else { &[] };
        let is_stretched = std::iter::once(layer).chain(below).any(|layer| layer.alpha_xy[0] != layer.alpha_xy[1]);
        let is_anisotropic = !facts.is_isotropic && (is_stretched || is_turned);
        if is_anisotropic {
            names.insert(Feature::Anisotropic);
        }
        // Rows have axes, or shapes of a family are stretched along some.
        if rows.is_some_and(|rows| rows.axes.is_some() || is_anisotropic && is_family) {
            names.insert(Feature::LobesAxes);
        }
    }
    for pair in layers.windows(2) {
        if pair[0].kind == LayerKind::Dielectric {
            names.insert(Feature::Below);
            if pair[0].optical_depth.iter().any(|&depth| depth != 0.0) {
                names.insert(Feature::Absorption);
            }
        }
    }
    let (has_interface, has_diffuse) = (names.contains(&Feature::Interface), names.contains(&Feature::Diffuse));
    match facts.family {
        Family::Facets if has_interface => {
            let added = material.layers.last().filter(|last| is_diffuse(last));
            if let (DiffuseTerm::Added, Some(base)) = (material.constants.diffuse_term, added) {
                names.extend([Feature::MicrofacetBase, Feature::Diffuse]);
                if base.sigma != 0.0 {
                    names.insert(Feature::OrenNayar);
                }
            }
            names.insert(Feature::Smith)
        }
        Family::Lobes if has_interface => {
            if material.constants.flakes.is_some() && has_coat(material) {
                names.extend([Feature::Flakes, Feature::LobesTilted]);
            }
            if is_covered {
                names.extend([cover(material), Feature::LobesPatina]);
            }
            if is_covered && has_diffuse {
                names.insert(Feature::LobesBareBase);
            }
            names.insert(Feature::Coat)
        }
        Family::Lobes => names.insert(Feature::LobesDiffuse),
        Family::Facets => names.insert(Feature::MicrofacetDiffuse),
        // A base in a chain is a step of it. A set of bare bases has no chain.
        Family::Path if !has_interface => names.insert(Feature::ChainDiffuse),
        Family::Path => {
            if has_diffuse {
                names.insert(Feature::ChainDiffuse);
            }
            if facts.is_isotropic && gets_smoother(layers) {
                names.insert(Feature::Clamped);
            }
            if layers.iter().any(|layer| layer.lower_alpha == LowerAlpha::AtLeastAbove) {
                names.extend([Feature::RougherBelow, Feature::Clamped]);
            }
            // These models and `lobes` alone have layers below the first interface that flakes tilt and patina covers.
            if material.constants.flakes.is_some() && names.contains(&Feature::Below) {
                names.insert(Feature::Flakes);
            }
            if material.constants.bare().is_some() {
                names.insert(cover(material));
            }
            if material.weighs_film_of_path() {
                names.insert(Feature::WeightFilm);
            }
            if material.constants.patina.is_some() {
                names.insert(Feature::ChainPatina);
            }
            names.insert(Feature::Chain)
        }
        Family::Statistics if has_interface => {
            if layers.iter().any(|layer| !is_diffuse(layer) && layer.reflectance != Reflectance::Table) {
                names.insert(Feature::Level);
            }
            names.insert(Feature::Statistics)
        }
        Family::Beams => {
            let first = &material.layers[0];
            let has_film = first.film_ior_n[0] > 0.0;
            if has_film {
                names.insert(Feature::GranierFilm);
            }
            if first.f0.is_some() && first.kind == LayerKind::Dielectric {
                names.insert(Feature::GranierSchlick);
            }
            if let Some(beams) = &material.constants.beams {
                names.insert(Feature::GranierOwn);
                if beams.inner_normal[2] < 1.0 {
                    names.insert(Feature::GranierTilted);
                }
                if beams.lobe_height == LobeHeight::One {
                    names.insert(Feature::GranierHeight);
                }
            }
            match first.kind {
                _ if has_film => names.insert(Feature::GranierTransparent),
                LayerKind::Dielectric => names.insert(Feature::GranierTransparent),
                LayerKind::Conductor => names.insert(Feature::GranierBare),
                LayerKind::Diffuse => false,
            };
            if material.layers.last().is_some_and(is_diffuse) {
                names.insert(Feature::GranierBase);
            }
            names.insert(Feature::Granier)
        }
        _ => false,
    };
    names
}

/// Numbers of the rows of a material, if it has any.
fn rows_of(material: &MaterialEntry) -> Option<LobesRecord> {
    let has_rows = material.layers.first().is_some_and(|layer| layer.tiles[TableKind::Lobes].is_some());
    material.constants.lobes.filter(|_| has_rows)
}

/// Whether rows are of a form.
type Has = fn(&LobesRecord) -> bool;

/// Words for forms of rows that are marked in the words of a material, where materials differ in them.
const FORMS: [(Feature, Has); 3] = [
    (Feature::LobesOneWidth, |record| record.rise.is_some()),
    (Feature::LobesShort, |record| record.short.is_some()),
    (Feature::LobesCurve, |record| record.reflectance.is_some()),
];

/// The word for what leaves the layers below the first bare in places.
fn cover(material: &MaterialEntry) -> Feature {
    if material.constants.patina.is_some() { Feature::Patina } else { Feature::Weight }
}

/// Whether rows are over the amount of patina or of a coat, so that bare places show the layer below it.
fn is_under_patina(material: &MaterialEntry) -> bool {
    let lobes = material.constants.lobes.filter(|_| material.model.is_fitted());
    lobes.and_then(|lobes| lobes.varying).is_some_and(|varying| varying.factor.is_cover())
        && material.constants.bare().is_some()
}

/// Whether rows are over the thickness of a film.
fn is_over_film(lobes: &LobesRecord) -> bool {
    lobes.varying.is_some_and(|varying| varying.factor == VaryingFactor::FilmFactor)
}

/// Whether places may recolour the base below lobes.
fn has_base_light(material: &MaterialEntry) -> bool {
    painted(material).is_some()
}

/// The base below lobes that places may recolour, beside those of families, which have a way of their own.
fn painted(material: &MaterialEntry) -> Option<PaintedRecord> {
    let is_covered = material.constants.bare().is_some() && material.side().is_none();
    let is_plain = !is_covered && family(material).is_none();
    material.constants.lobes.filter(|_| is_plain)?.painted
}

/// The axes of the family that a material's rows of lobes are.
fn family(material: &MaterialEntry) -> Option<FamilyRecord> {
    material.constants.lobes.filter(|_| material.model.is_fitted())?.family()
}

/// The features of a family.
fn of_family(material: &MaterialEntry) -> Vec<Feature> {
    let Some(family) = family(material) else { return Vec::new() };
    let absorbs = material.layers.first().is_some_and(|first| first.optical_depth != [0.0; 3]);
    let (is_tinted, has_lengths) = (family.is_metallic && absorbs, family.has_lengths && absorbs);
    let words = [
        (Feature::LobesFamily, true),
        (Feature::LobesCoats, family.has_two_axes()),
        (Feature::LobesCoatSlopes, has_coat_slopes(material, family)),
        (Feature::LobesMetallic, family.is_metallic),
        (Feature::LobesTinted, is_tinted),
        (Feature::LobesLengths, has_lengths),
        (Feature::LobesTails, family.has_tail),
        (Feature::FilmF0, material.layers.iter().any(LayerRecord::has_film_over_f0)),
    ];
    words.into_iter().filter(|(_, holds)| *holds).map(|(word, _)| word).collect()
}

/// Whether the coat of a family has slope parameters other than the one of its layer, or numbers over them.
fn has_coat_slopes(material: &MaterialEntry, family: FamilyRecord) -> bool {
    let (Some(coat), Some(first)) = (family.coat, material.layers.first()) else { return false };
    let is_one = coat.nodes == 1 && family.sent_back[1] == 0.0;
    !is_one || (coat.most - first.alpha).abs() > SLOPES_ALIKE * coat.most
}

/// Relative difference of slope parameters that single precision does not tell.
const SLOPES_ALIKE: f64 = 1e-7;

/// F0 of the dielectric of a `metallic-roughness` surface whose file names no other.
const ENGINE_F0: f64 = 0.04;

/// Whether patina or a coat covers a diffuse base alone.
fn is_bare_base(material: &MaterialEntry) -> bool {
    material.constants.bare().is_some_and(is_diffuse)
}

/// Whether lobes come from below a slab, in which flakes may tilt them.
fn has_coat(material: &MaterialEntry) -> bool {
    material.model.is_fitted() && material.layers.first().is_some_and(|first| first.kind == LayerKind::Dielectric)
}

/// Whether there is an interface below the first one.
fn has_inner_interface(material: &MaterialEntry) -> bool {
    material.layers.iter().skip(1).any(|layer| !is_diffuse(layer))
}

/// Whether an interface is smoother than one above it.
fn gets_smoother(layers: &[LayerRecord]) -> bool {
    let interfaces = layers.iter().filter(|layer| !is_diffuse(layer));
    interfaces.clone().zip(interfaces.skip(1)).any(|(above, below)| below.alpha < above.alpha)
}

/// Whether a conductor of a chain lies above the depth of the deepest stack. Only there do steps follow that it has to end.
fn ends_early(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    let stacks = stacks(set, model);
    let (_, depth) = depths(&stacks);
    let mut above = stacks.iter().flat_map(|layers| layers.iter().take(depth.saturating_sub(1)));
    above.any(|layer| layer.kind == LayerKind::Conductor)
}

/// Whether the materials of a model have both diffuse bases and interfaces, in one material or in several.
fn has_base(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    let mut layers = stacks(set, model).into_iter().flatten();
    layers.clone().any(is_diffuse) && !layers.all(is_diffuse)
}

/// Whether some materials of a model have a diffuse base at a depth where others have an interface.
fn is_mixed(set: &MaterialSet<'_>, model: ShadingModel) -> bool {
    let stacks = stacks(set, model);
    let depth = match model.facts().reach {
        Reach::None => 0,
        Reach::First => 1,
        Reach::FirstAndBase | Reach::All => depths(&stacks).1,
    };
    (0..depth).any(|i| diffuse_at(&stacks, i) == (true, false))
        || set.materials.iter().filter(|m| m.model == model && is_under_patina(m)).any(is_bare_base)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compose::blocks::{modules, prune};

    #[test]
    fn modules_have_whole_blocks_and_name_known_features() {
        for (_, module) in modules() {
            prune(&module, &Features::default());
        }
    }
}
