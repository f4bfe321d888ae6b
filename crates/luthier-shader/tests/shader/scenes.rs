//! Material sets for the tests: small, with one material for every kind of layer.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

use luthier_lut::{AtlasLayout, Axis, Mapping, TableKind, TexelFormat};
use luthier_manifest::{
    AxesRecord, CoatRecord, Distribution, FlakesRecord, GlitterRecord, LayerKind, LayerRecord, LobesRecord, MapSlot,
    MaterialConstants, MaterialEntry, PatinaRecord, ShadingModel, SideRecord, Tiles, VaryingFactor, VaryingRecord,
};
use luthier_shader::{Form, MaterialSet, TableFace, Target, complete, emit, emit_constant};

use crate::features::with_map;

/// An interface without film: red-lacquer's coat.
pub(crate) fn dielectric() -> LayerRecord {
    LayerRecord {
        kind: LayerKind::Dielectric,
        distribution: Distribution::Beckmann,
        alpha: 0.02,
        eta: 1.5,
        optical_depth: [0.1, 0.5, 0.9],
        alpha_xy: [0.02; 2],
        ior_n: [1.49, 1.5, 1.51],
        tiles: Tiles::of([(TableKind::Fresnel, 0), (TableKind::Distribution, 0), (TableKind::Fgd, 0)]),
        ..LayerRecord::default()
    }
}

/// A coat that does not absorb.
pub(crate) fn clear() -> LayerRecord {
    LayerRecord { optical_depth: [0.0; 3], ..dielectric() }
}

/// Gold.
pub(crate) fn conductor() -> LayerRecord {
    LayerRecord {
        kind: LayerKind::Conductor,
        distribution: Distribution::Ggx,
        alpha: 0.3,
        alpha_xy: [0.3; 2],
        eta: 1.0,
        optical_depth: [0.0; 3],
        ior_n: [0.16, 0.42, 1.47],
        ior_k: [3.9, 2.4, 1.95],
        tiles: dielectric().tiles.with([
            (TableKind::Fresnel, Some(1)),
            (TableKind::Distribution, Some(1)),
            (TableKind::Fgd, Some(1)),
        ]),
        ..dielectric()
    }
}

/// A diffuse base; Lambert for `sigma` 0.
pub(crate) fn diffuse(sigma: f64) -> LayerRecord {
    LayerRecord {
        kind: LayerKind::Diffuse,
        eta: 1.0,
        optical_depth: [0.0; 3],
        albedo: [0.8, 0.5, 0.2],
        sigma,
        tiles: dielectric().tiles.with([
            (TableKind::Fresnel, None),
            (TableKind::Distribution, None),
            (TableKind::Fgd, None),
        ]),
        ..dielectric()
    }
}

/// A fluorescent base, whose red is brighter than white light, and has a little less than no blue.
pub(crate) fn fluorescent() -> LayerRecord {
    let rows = [[0.7, 0.3, 0.4], [0.02, 0.5, 0.1], [-0.01, 0.03, 0.2]];
    LayerRecord { albedo: [1.0, 0.62, 0.22], reradiation: Some(rows), ..diffuse(0.0) }
}

/// An interface under a film of varying thickness.
pub(crate) fn filmed() -> LayerRecord {
    LayerRecord {
        film_ior_n: [1.39, 1.4, 1.41],
        film_ior_k: [0.0, 0.0, 0.01],
        film_thickness_waves: [0.43, 0.55, 0.67],
        film_thickness_nm: 300.0,
        film_thickness_max_nm: 400.0,
        tiles: clear().tiles.with([
            (TableKind::Phase, Some(0)),
            (TableKind::Thickness, Some(0)),
            (TableKind::Film, Some(0)),
            (TableKind::Fresnel, Some(2)),
            (TableKind::Fgd, None),
        ]),
        ..clear()
    }
}

/// A layer of a material of the statistical models: with an escape tile.
pub(crate) fn with_escape(layer: LayerRecord) -> LayerRecord {
    LayerRecord {
        tiles: layer
            .tiles
            .with([(TableKind::Fgd, layer.tiles[TableKind::Fgd].or(Some(2))), (TableKind::Escape, Some(0))]),
        ..layer
    }
}

/// A material of these layers.
pub(crate) fn material(name: &str, layers: &[LayerRecord]) -> MaterialEntry {
    MaterialEntry {
        name: name.to_owned(),
        wavelengths_nm: [645.0, 525.0, 445.0],
        layers: layers.to_vec(),
        ..MaterialEntry::default()
    }
}

pub(crate) const FLAKES: FlakesRecord =
    FlakesRecord { seed: 0xfedc_ba98, count: 64, tiling: 10.0, spread: 0.25, scale: 0.8, fade_start: 2.0 };

pub(crate) const GLITTER: GlitterRecord = GlitterRecord { seed: 0x8000_0001, frequency: 20.0, filled: 0.3, tilt: 0.35 };

/// A tinted coat with flakes over gold.
pub(crate) fn flaked() -> MaterialEntry {
    let constants = MaterialConstants { flakes: Some(FLAKES), ..MaterialConstants::default() };
    MaterialEntry { constants, ..material("flakes", &[achromatic(), conductor()]) }
}

/// A coat of one index for all channels.
fn achromatic() -> LayerRecord {
    LayerRecord { ior_n: [1.5; 3], ..dielectric() }
}

/// A coat that has grown over gold.
pub(crate) fn patina() -> MaterialEntry {
    let base = LayerRecord {
        ior_n: conductor().ior_n.map(|n| n / 1.5),
        ior_k: conductor().ior_k.map(|k| k / 1.5),
        ..conductor()
    };
    let patina = PatinaRecord {
        extent: 0.4,
        transition: 0.2,
        diffuse_albedo: [0.3, 0.5, 0.2],
        base_alpha: Some(0.5),
        tarnish: [0.9, 0.5, 0.3],
        bare: conductor(),
    };
    let constants = MaterialConstants { patina: Some(patina), ..MaterialConstants::default() };
    MaterialEntry { constants, ..material("patina", &[LayerRecord { alpha: 0.2, ..achromatic() }, base]) }
}

/// A coat that covers 0.6 of gold.
pub(crate) fn weighted() -> MaterialEntry {
    let MaterialEntry { layers, constants, .. } = patina();
    let coat = constants.patina.map(|patina| CoatRecord { weight: 0.6, bare: patina.bare, side: None });
    MaterialEntry {
        constants: MaterialConstants { coat, ..MaterialConstants::default() },
        ..material("weighted", &layers)
    }
}

/// Gold in cells, some of them tilted.
pub(crate) fn glitter() -> MaterialEntry {
    let constants = MaterialConstants { glitter: Some(GLITTER), ..MaterialConstants::default() };
    MaterialEntry { constants, ..material("glitter", &[conductor()]) }
}

/// A film on a coat on gold.
fn oiled() -> MaterialEntry {
    material("oiled-varnish", &[with_escape(filmed()), conductor()])
}

/// Two absorbing coats of different indices on gold.
fn coats() -> MaterialEntry {
    let under = LayerRecord { eta: 1.2, ior_n: [1.19, 1.2, 1.21], ..dielectric() };
    material("two-coats", &[with_escape(dielectric()), with_escape(under), conductor()])
}

/// Anisotropic surfaces with two tangents.
fn coated_brushed() -> MaterialEntry {
    let coat = LayerRecord { alpha_xy: [0.3, 0.05], alpha: 0.122474487, rotation: -0.3, ..dielectric() };
    let base = LayerRecord { alpha_xy: [0.1, 0.4], alpha: 0.2, rotation: 0.5, ..conductor() };
    material("coated-brushed", &[with_escape(coat), base])
}

/// From a dense medium into a thinner one.
fn inward() -> LayerRecord {
    LayerRecord { eta: 1.0 / 1.5, critical_cot_sq: 1.25, ..clear() }
}

/// A material with normals of all of its layers.
pub(crate) fn bumpy(material: MaterialEntry) -> MaterialEntry {
    let layers = 0..material.layers.len() as u32;
    let maps = layers.flat_map(|layer| with_map(material.clone(), MapSlot::Bumps, layer).maps);
    let maps = material.maps.iter().cloned().chain(maps).collect();
    MaterialEntry { maps, ..material }
}

/// The material with the model `lobes`, which has its first tile of rows.
fn with_lobes(mut material: MaterialEntry) -> MaterialEntry {
    material.model = ShadingModel::Lobes;
    material.layers[0].tiles[TableKind::Lobes] = Some(0);
    let critical_cot_sq = material.layers[0].critical_cot_sq;
    material.constants.lobes = Some(LobesRecord {
        index: 1.5,
        falloff: [0.6, 0.2],
        integral: 0.9,
        critical_cot_sq,
        critical_width: 0.02,
        critical_plain_share: 0.25,
        lobes: 2,
        inverse_tails: [1.0, 40.0],
        rise: None,
        short: None,
        reflectance: None,
        varying: None,
        axes: None,
        painted: None,
        error: None,
    });
    material
}

/// The material with rows over the amount of its patina, which are all that its three tiles have.
pub(crate) fn covered(material: MaterialEntry) -> MaterialEntry {
    let mut material = with_lobes(material);
    material.layers[0].alpha_xy = [material.layers[0].alpha; 2];
    let over =
        VaryingRecord { factor: VaryingFactor::Patina, tiles: 3, least_spread: 1.0, factors: None, family: None };
    material.constants.lobes = material.constants.lobes.map(|lobes| LobesRecord { varying: Some(over), ..lobes });
    material
}

/// The material with rows over the weight of its coat, which are all that its two tiles have.
pub(crate) fn weighed(material: MaterialEntry) -> MaterialEntry {
    let mut material = covered(material);
    let over =
        VaryingRecord { factor: VaryingFactor::WeightFactor, tiles: 2, least_spread: 1.0, factors: None, family: None };
    material.constants.lobes = material.constants.lobes.map(|lobes| LobesRecord { varying: Some(over), ..lobes });
    material
}

/// The material with lobes of its own for the layers below its coat, in another medium and with its tile; none for a diffuse base alone.
pub(crate) fn sided(material: MaterialEntry) -> MaterialEntry {
    let mut material = with_lobes(material);
    material.layers[0].alpha_xy = [material.layers[0].alpha; 2];
    let lobes = material.constants.lobes.map(|lobes| LobesRecord { index: 1.1, falloff: [0.4, 0.1], ..lobes });
    if let Some(coat) = &mut material.constants.coat {
        let lobes = lobes.filter(|_| coat.bare.kind != LayerKind::Diffuse);
        coat.bare.tiles[TableKind::Lobes] = lobes.map(|_| 0);
        coat.side = Some(SideRecord { lobes, without_film: coat.side.is_some_and(|side| side.without_film) });
    }
    material
}

/// A film that covers 0.6 of a coat on gold.
pub(crate) fn weighted_film() -> MaterialEntry {
    let side = Some(SideRecord { lobes: None, without_film: true });
    let constants = MaterialConstants {
        coat: Some(CoatRecord { weight: 0.6, bare: clear(), side }),
        ..MaterialConstants::default()
    };
    MaterialEntry { constants, ..material("weighted-film", &[filmed(), conductor()]) }
}

/// A coat that covers 0.6 of paint, which has a map.
pub(crate) fn weighted_paint(sigma: f64) -> MaterialEntry {
    let mut material = weighted();
    "weighted-paint".clone_into(&mut material.name);
    material.layers[1] = diffuse(sigma);
    if let Some(coat) = &mut material.constants.coat {
        coat.bare = diffuse(sigma);
    }
    with_map(material, MapSlot::Albedo, 1)
}

/// Paint under a patina.
pub(crate) fn covered_paint(sigma: f64) -> MaterialEntry {
    let mut material = covered(patina());
    "covered-paint".clone_into(&mut material.name);
    material.layers[1] = diffuse(sigma);
    if let Some(patina) = &mut material.constants.patina {
        patina.bare = diffuse(sigma);
    }
    material
}

/// The material by another name.
fn named(name: &str, material: MaterialEntry) -> MaterialEntry {
    MaterialEntry { name: name.to_owned(), ..material }
}

/// The material with lobes in axes of its own.
fn with_axes(material: MaterialEntry) -> MaterialEntry {
    let mut material = with_lobes(material);
    let axes = AxesRecord { turn: [0.6, 0.8], is_mirrored: true, tiles: 8 };
    material.constants.lobes = material.constants.lobes.map(|lobes| LobesRecord { axes: Some(axes), ..lobes });
    material
}

/// The forms that the models of some materials have.
pub(crate) fn forms(materials: &[MaterialEntry]) -> impl Iterator<Item = Form> {
    Form::ALL.into_iter().filter(|&form| materials.iter().all(|material| material.model.has(form)))
}

/// Sets by name, from the simplest to the richest.
pub(crate) fn sets() -> Vec<(&'static str, Vec<MaterialEntry>)> {
    let lacquer = || material("red-lacquer", &[dielectric(), diffuse(0.0)]);
    let house = || material("house-paint", &[dielectric(), clear(), diffuse(0.4)]);
    let gold = || material("gold", &[conductor()]);
    let oil = || material("oil-film-2", &[filmed(), conductor()]);
    let chalk = || material("chalk", &[diffuse(0.0)]);
    let brushed = || material("brushed", &[LayerRecord { alpha_xy: [0.1, 0.4], rotation: 0.5, ..conductor() }]);
    let of = |model, material: MaterialEntry| MaterialEntry { model, ..material };
    vec![
        ("lambert", vec![chalk()]),
        ("clay", vec![material("clay", &[diffuse(0.3)])]),
        ("glass", vec![material("glass", &[dielectric()])]),
        ("gold", vec![gold()]),
        ("lacquer", vec![lacquer()]),
        ("varnish", vec![material("varnish", &[clear(), conductor()])]),
        ("soap", vec![material("soap", &[filmed()])]),
        ("flakes", vec![flaked()]),
        ("patina", vec![patina(), lacquer()]),
        ("weight", vec![weighted(), lacquer()]),
        ("weight-and-patina", vec![patina(), of(ShadingModel::WeidlichWilkie, weighted()), flaked()]),
        ("glitter", vec![glitter()]),
        ("effects", vec![of(ShadingModel::WeidlichWilkie, patina()), flaked(), glitter(), house(), oil()]),
        ("effects-without-layers", [flaked(), patina()].map(|m| of(ShadingModel::Microfacet, m)).into()),
        ("mixed-depths", vec![gold(), lacquer(), house()]),
        ("mixed-tops", vec![chalk(), lacquer()]),
        ("chalk-and-metal", vec![chalk(), gold()]),
        (
            "weidlich-wilkie",
            vec![of(ShadingModel::WeidlichWilkie, house()), of(ShadingModel::WeidlichWilkie, brushed())],
        ),
        ("fluorescent", vec![material("dye", &[dielectric(), fluorescent()])]),
        ("fluorescent-bare", vec![material("dye", &[fluorescent()])]),
        (
            "fluorescent-mixed",
            vec![
                of(ShadingModel::WeidlichWilkie, material("dye", &[clear(), dielectric(), fluorescent()])),
                material("bare-dye", &[fluorescent()]),
                MaterialEntry {
                    constants: flaked().constants,
                    ..material("flaked-dye", &[dielectric(), fluorescent()])
                },
                patina(),
                house(),
                of(ShadingModel::Belcour, material("blue-house", &[dielectric(), diffuse(0.4)])),
            ],
        ),
        ("granier-film", vec![of(ShadingModel::GranierHeidrich, oil())]),
        ("granier-coat", vec![of(ShadingModel::GranierHeidrich, house())]),
        ("granier-mixed", [oil(), house(), gold(), chalk()].map(|m| of(ShadingModel::GranierHeidrich, m)).into()),
        ("granier-base", vec![of(ShadingModel::GranierHeidrich, chalk())]),
        ("phong", vec![of(ShadingModel::Phong, lacquer())]),
        ("phong-film", vec![of(ShadingModel::Phong, oil())]),
        ("microfacet", vec![of(ShadingModel::Microfacet, gold()), of(ShadingModel::Microfacet, brushed())]),
        ("microfacet-mixed", vec![of(ShadingModel::Microfacet, chalk()), of(ShadingModel::Microfacet, lacquer())]),
        ("belcour", vec![of(ShadingModel::Belcour, gold())]),
        ("belcour-base", vec![of(ShadingModel::Belcour, house())]),
        ("belcour-bare", vec![of(ShadingModel::Belcour, chalk())]),
        ("belcour-chalk-and-metal", [chalk(), gold()].map(|m| of(ShadingModel::Belcour, m)).into()),
        (
            "belcour-coat",
            vec![of(ShadingModel::Belcour, material("varnish", &[with_escape(dielectric()), conductor()]))],
        ),
        ("belcour-mixed", [chalk(), oiled(), coats(), house()].map(|m| of(ShadingModel::Belcour, m)).into()),
        ("yamaguchi", vec![of(ShadingModel::Yamaguchi, coated_brushed())]),
        ("yamaguchi-isotropic", vec![of(ShadingModel::Yamaguchi, coats())]),
        (
            "statistics",
            vec![of(ShadingModel::Yamaguchi, coated_brushed()), of(ShadingModel::Belcour, oiled()), brushed(), house()],
        ),
        (
            "models",
            vec![
                of(ShadingModel::Belcour, coats()),
                of(ShadingModel::Yamaguchi, coated_brushed()),
                lacquer(),
                of(ShadingModel::Phong, gold()),
                of(ShadingModel::Microfacet, brushed()),
                of(ShadingModel::WeidlichWilkie, house()),
                oil(),
            ],
        ),
        ("lobes", vec![with_lobes(house())]),
        ("lobes-film", vec![with_lobes(oil())]),
        ("lobes-place", vec![with_lobes(glitter())]),
        ("lobes-flakes", vec![with_lobes(flaked())]),
        ("lobes-bumps", vec![bumpy(with_lobes(house()))]),
        (
            "lobes-bumps-mixed",
            vec![bumpy(with_lobes(house())), of(ShadingModel::Microfacet, gold()), with_lobes(chalk())],
        ),
        ("lobes-axes", vec![with_axes(coated_brushed())]),
        ("lobes-axes-mixed", vec![with_lobes(house()), with_axes(coated_brushed()), with_lobes(chalk())]),
        (
            "lobes-mixed",
            vec![
                with_lobes(brushed()),
                of(ShadingModel::Lobes, chalk()),
                of(ShadingModel::Microfacet, gold()),
                with_lobes(glitter()),
                lacquer(),
            ],
        ),
        ("lobes-patina", vec![covered(patina())]),
        ("lobes-patina-base", vec![covered_paint(0.3)]),
        ("lobes-patina-mixed", vec![house(), covered_paint(0.0), covered(patina()), with_axes(coated_brushed())]),
        ("lobes-patina-chains", vec![covered(patina()), named("grown", patina()), with_lobes(house())]),
        ("lobes-weight", vec![weighed(weighted())]),
        ("lobes-weight-mixed", vec![weighed(weighted()), covered(patina()), named("weighted-chain", weighted())]),
        ("lobes-sides", vec![sided(weighted())]),
        ("lobes-sides-base", vec![sided(weighted_paint(0.3))]),
        ("lobes-sides-film", vec![sided(weighted_film())]),
        (
            "lobes-sides-mixed",
            vec![
                sided(weighted_paint(0.0)),
                sided(weighted()),
                sided(weighted_film()),
                named("by-amount", weighed(weighted())),
                gold(),
            ],
        ),
        (
            "lobes-sides-bumps",
            vec![bumpy(sided(weighted())), bumpy(sided(weighted_paint(0.3))), with_lobes(house()), gold()],
        ),
        ("weighted-film", vec![weighted_film()]),
        ("weighted-film-mixed", vec![weighted_film(), weighted(), flaked(), house()]),
        ("lobes-inward", vec![with_lobes(material("inward", &[inward(), diffuse(0.0)]))]),
        ("everything", vec![lacquer(), house(), gold(), oil(), material("clay", &[diffuse(0.3)])]),
    ]
}

fn axis(quantity: &str, min: f64, max: f64, size: u32, mapping: Mapping) -> Axis {
    Axis { quantity: quantity.to_owned(), unit: String::new(), min, max, size, mapping }
}

/// Kind of a text of a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    Snippet,
    Complete,
    Constant,
}

/// A text of one of [`sets`] with the [`tables`], composed once for all tests of a run: several look at each.
pub(crate) fn text((name, set): (&str, &MaterialSet<'_>), form: Form, target: Target, part: Part) -> Arc<str> {
    type Texts = BTreeMap<String, Arc<OnceLock<Arc<str>>>>;
    static TEXTS: Mutex<Texts> = Mutex::new(BTreeMap::new());
    assert_eq!(set.materials.len(), sets().iter().find(|(known, _)| *known == name).unwrap().1.len());
    let formats: Vec<TexelFormat> = set.tables.iter().map(|table| table.format).collect();
    let key = format!("{name} {form} {target} {part:?} {:?} {formats:?}", set.functions);
    let text = Arc::clone(TEXTS.lock().unwrap().entry(key).or_default());
    let compose = match part {
        Part::Snippet => emit,
        Part::Complete => complete,
        Part::Constant => emit_constant,
    };
    let composed = || compose(set, form, target).unwrap_or_else(|e| panic!("{name} {form} {target} {part:?}: {e}"));
    Arc::clone(text.get_or_init(|| composed().into()))
}

/// [`tables`] with rows of lobes in a buffer.
pub(crate) fn stepped_tables() -> Vec<TableFace> {
    let face = |table: TableFace| match table.kind {
        TableKind::Lobes => TableFace { format: TexelFormat::Rgba16FloatSteps, ..table },
        _ => table,
    };
    tables().into_iter().map(face).collect()
}

/// The tables of a bake with default settings.
pub(crate) fn tables() -> Vec<TableFace> {
    let cos_theta = |size| axis("cos_theta", 0.0, 1.0, size, Mapping::Linear);
    let alpha = |mapping, size| axis("alpha", 1e-3, 1.0, size, mapping);
    let half_pi = std::f64::consts::FRAC_PI_2;
    let face = |kind, x, y, apron, columns, tiles, format| TableFace {
        kind,
        layout: AtlasLayout { x, y, apron, columns, tiles, base: luthier_lut::RowBase::Zero },
        format,
    };
    vec![
        face(TableKind::Fresnel, cos_theta(128), None, 0, 1, 3, TexelFormat::Rgba16Float),
        face(
            TableKind::Distribution,
            axis("theta_h", 0.0, half_pi, 512, Mapping::Power { exponent: 8.0 }),
            Some(alpha(Mapping::Logarithmic, 512)),
            0,
            1,
            2,
            TexelFormat::R16Float,
        ),
        face(
            TableKind::Fgd,
            axis("cos_theta", 0.0, 1.0, 32, Mapping::Power { exponent: 2.0 }),
            Some(alpha(Mapping::Linear, 32)),
            0,
            4,
            6,
            TexelFormat::Rgba16Float,
        ),
        face(TableKind::Phase, axis("s", 0.0, 1.0, 256, Mapping::Linear), None, 0, 1, 1, TexelFormat::Rgba16Float),
        face(
            TableKind::Thickness,
            axis("u", 0.0, 1.0, 256, Mapping::Periodic),
            Some(axis("v", 0.0, 1.0, 256, Mapping::Periodic)),
            1,
            1,
            1,
            TexelFormat::Rgba8Unorm,
        ),
        face(
            TableKind::Film,
            cos_theta(64),
            Some(axis("fraction", 0.0, 1.0, 64, Mapping::Linear)),
            0,
            1,
            1,
            TexelFormat::Rgba16Float,
        ),
        face(TableKind::Escape, cos_theta(32), Some(alpha(Mapping::Linear, 32)), 0, 1, 1, TexelFormat::R16Float),
        face(
            TableKind::Lobes,
            axis("cos_theta", 0.0, 1.0, 20, Mapping::Rational { bend: 1.0 }),
            Some(axis("part", 0.0, 5.0, 6, Mapping::Apart)),
            1,
            1,
            1,
            TexelFormat::Rgba16Float,
        ),
    ]
}
