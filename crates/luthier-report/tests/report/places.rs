//! Materials that vary, at random places: shaders that ignore what varies, and rows of another stack.

use glam::DVec3;
use luthier_layers::models::lobes::{Critical, FitSettings, Varied, Varying};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::twins::shaded::Place;
use luthier_lut::{AtlasLayout, Image, Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::{
    ColorMode, FileEntry, LobesRecord, MapEntry, MapSlot, PlaceValues, ShadingModel, VaryingFactor, VaryingRecord,
};
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Layer, Slab, Stack, Surface};
use luthier_report::{
    AlbedoSettings, Asked, Device, Form, Pair, Places, Settings, SimulatedSettings, Site, Subject, SurfaceMap, Weights,
    albedos, at_places, judge, limits, simulated,
};

use crate::fixture::{Bake, WAVELENGTHS_NM, axis, table};

/// A map of two texels, the least and the greatest value of each channel.
fn map(bake: &mut Bake, material: usize, slot: MapSlot, layer: u32, texels: [[f32; 3]; 2]) -> SurfaceMap {
    let file = FileEntry::default();
    let entry = MapEntry {
        slot,
        layer: Some(layer),
        source: String::new(),
        file,
        width: 2,
        height: 1,
        factor: None,
        srgb: false,
        transform: None,
    };
    bake.manifest.materials[material].maps.push(entry);
    let mut image = Image::zeros(2, 1, 4);
    for (x, [r, g, b]) in (0..).zip(texels) {
        image.texel_mut(x, 0).copy_from_slice(&[r, g, b, 1.0]);
    }
    SurfaceMap { material: material as u32, slot, layer: Some(layer), picture: image.into() }
}

/// The bake of the fixture, whose first material has maps of normal, roughness, thickness and albedo.
fn textured() -> (Bake, Vec<SurfaceMap>) {
    let mut bake = Bake::new();
    let maps = [
        (MapSlot::Normal, 0, [[0.4, 0.35, 0.9], [0.6, 0.55, 1.0]]),
        (MapSlot::Roughness, 0, [[0.5; 3], [1.0; 3]]),
        (MapSlot::Thickness, 0, [[0.1; 3], [1.0; 3]]),
        (MapSlot::Albedo, 1, [[0.1, 0.2, 0.3], [0.9, 0.8, 0.5]]),
    ];
    let maps = maps.map(|(slot, layer, texels)| map(&mut bake, 0, slot, layer, texels));
    (bake, maps.to_vec())
}

/// A device that has another place in mind than it is told.
struct Forgetful<'a> {
    inner: &'a dyn Device,
    forgets: fn(&mut PlaceValues),
}

impl Device for Forgetful<'_> {
    fn identity(&self) -> String {
        self.name()
    }

    fn name(&self) -> String {
        "forgetful".to_owned()
    }

    fn evaluate(&self, form: Form, material: u32, pairs: &[Pair]) -> Result<Vec<[f32; 3]>, String> {
        self.inner.evaluate(form, material, pairs)
    }

    fn evaluate_at(&self, form: Form, material: u32, spots: &[(PlaceValues, Pair)]) -> Result<Vec<[f32; 3]>, String> {
        let mut spots = spots.to_vec();
        spots.iter_mut().for_each(|(place, _)| (self.forgets)(place));
        self.inner.evaluate_at(form, material, &spots)
    }
}

/// Every value that maps give is one that a shader has to take: without any of them it is far off, and the report says where.
#[test]
fn a_shader_that_forgets_what_varies_breaks_the_budget() {
    let (bake, maps) = textured();
    let subject = Subject { maps, ..bake.subject() };
    let device = bake.device(|_, _, _, value| value);
    type Forget = fn(&mut PlaceValues);
    let forgotten: [(&str, Forget); 5] = [
        ("nothing", |_| {}),
        ("normal", |place| place.normal = [0.0, 0.0, 1.0]),
        ("alpha_factor", |place| place.alpha_factor = 1.0),
        ("slab_factor", |place| place.slab_factor = 1.0),
        ("base_color", |place| place.base_color = None),
    ];
    for (what, forgets) in forgotten {
        let device = Forgetful { inner: &device, forgets };
        let at = at_places(&subject, 0, Some((&device, Weights::Exact)), 400, 1).unwrap().unwrap();
        let shader = at.shader.unwrap();
        let worst = shader.worst.unwrap();
        if what == "nothing" {
            // Values are rounded to f32.
            assert!(shader.relative.max < 2e-7 && at.varies.len() == 4, "{shader:?}", shader = shader.relative);
        } else {
            assert!(shader.relative.max > 0.05 && worst.place.contains(what), "{what}: {worst:?}");
        }
    }
    let device = Forgetful { inner: &device, forgets: |place| place.base_color = None };
    let settings = Settings { pairs_per_set: 100, budget: Some(2e-2), ..Settings::default() };
    let mut report = judge(&subject, Some(&device), &settings).unwrap();
    assert!(report.max_error() > 0.05, "{}", report.max_error());
    report.limits = limits(&report, &[], &Asked::default());
    assert_eq!(report.is_within_budget(), Some(false));
    let (material, at) = report.worst_place().unwrap();
    assert!(material == "red-lacquer" && at.shader.as_ref().unwrap().worst.is_some());
    assert!(report.to_markdown().contains("| red-lacquer | normal, roughness, thickness, albedo of layer 2 |"));
}

/// Tables at a place against exact terms there, which read none.
#[test]
fn tables_at_places_are_near_exact_terms() {
    let (bake, maps) = textured();
    let subject = Subject { maps, ..bake.subject() };
    let at = at_places(&subject, 0, None, 400, 2).unwrap().unwrap();
    let tables = at.tables.unwrap();
    assert!(at.shader.is_none() && tables.not_finite == 0);
    assert!(tables.relative.p99 < 1e-2 && tables.relative.max < 2e-2, "{:?}", tables.relative);
    assert!(at_places(&subject, 1, None, 10, 2).unwrap().is_none(), "nothing varies");
    let places = Places::of(&subject, 0).unwrap();
    assert_eq!(places.place(5, 3), places.place(5, 3));
    assert_ne!(places.place(5, 3), places.place(6, 3));
}

/// A metal under a lacquer whose thickness varies, in rows of lobes.
fn lacquered() -> (Bake, Vec<SurfaceMap>) {
    let slab = Slab { thickness_um: 20.0, absorption_per_um: [0.005, 0.02, 0.06] };
    let coat = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
    let layer =
        |distribution, alpha, base| Layer { films: vec![], surface: Surface::isotropic(distribution, alpha), base };
    let metal = Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() };
    // The fixture has tables of that coat.
    let layers = vec![layer(Distribution::Beckmann, 0.1, coat), layer(Distribution::Ggx, 0.2, metal)];
    let stack = Stack { exterior: Ior::vacuum(), layers };
    let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
    let settings = FitSettings { rows: 19, paths: 8192, seed: 3 };
    let varied = Varied::with(&stack, &color, Some(Varying::Slab), settings);

    let mut bake = Bake::new();
    bake.stacks[1] = stack;
    let entry = &mut bake.manifest.materials[1];
    (entry.model, entry.color) = (ShadingModel::Lobes, ColorMode::ThreeWavelengths);
    entry.layers[0].tiles[TableKind::Lobes] = Some(0);
    let lobes = &varied.nodes[0];
    let Critical { cot_sq, width, plain_share } = lobes.axis.critical();
    entry.constants.lobes = Some(LobesRecord {
        index: lobes.frame.index,
        falloff: lobes.frame.wide.falloff(),
        integral: lobes.frame.wide.integral(),
        critical_cot_sq: cot_sq,
        critical_width: width,
        critical_plain_share: plain_share,
        lobes: 2,
        inverse_tails: [1.0; 2],
        rise: None,
        short: None,
        reflectance: None,
        varying: Some(VaryingRecord {
            factor: VaryingFactor::SlabFactor,
            tiles: varied.nodes.len() as u32,
            least_spread: varied.least_spread(),
            factors: None,
            family: None,
        }),
        axes: None,
        painted: None,
        error: None,
    });
    let rows = lobes.axis.size() as u32;
    let parts = varied.stored(0, 0).to_parts().len() as u32;
    let layout = AtlasLayout {
        x: axis("cos_theta", 0.0, 1.0, rows, Mapping::Rational { bend: 1.0 }),
        y: Some(axis("part", 0.0, f64::from(parts - 1), parts, Mapping::Apart)),
        apron: 1,
        columns: 1,
        tiles: varied.nodes.len() as u32,
        base: RowBase::Zero,
    };
    let [width, height] = layout.size();
    let mut truth = Image::zeros(width, height, 4);
    for (tile, x) in (0..layout.tiles).flat_map(|tile| (0..rows + 2).map(move |x| (tile, x))) {
        let row = varied.stored(tile as usize, (x.max(1) - 1).min(rows - 1) as usize);
        for (part, values) in (0..).zip(row.to_parts()) {
            truth.texel_mut(part * (rows + 2) + x, tile).copy_from_slice(&values.map(|value| value as f32));
        }
    }
    let names = (0..layout.tiles).map(|tile| format!("lobes-{tile}")).collect();
    let (entry, texels) = table(TableKind::Lobes, layout, TexelFormat::Rgba16Float, names, &truth);
    bake.manifest.tables.push(entry);
    bake.textures.push((TableKind::Lobes, texels));
    let maps = vec![map(&mut bake, 1, MapSlot::Thickness, 0, [[0.0; 3], [1.0; 3]])];
    (bake, maps)
}

/// Rows that a bake ships are the simulated stack at every thickness. Rows that are one thickness's at all of them are found, with the place, and break a budget.
#[test]
fn rows_of_another_stack_break_the_budget() {
    let (mut bake, maps) = lacquered();
    // A judgement of lobes fits them anew, which takes seconds: the report is that of other materials, with the places of this one.
    let settings = Settings { pairs_per_set: 8, budget: Some(10.0), ..Settings::default() };
    let mut report = judge(&Bake::new().subject(), None, &settings).unwrap();
    let mut judged = |bake: &Bake| {
        let subject = Subject { maps: maps.clone(), ..bake.subject() };
        let mut at = at_places(&subject, 1, None, 8, 1).unwrap().unwrap();
        at.simulated = simulated(&subject, 1, &SimulatedSettings::default()).unwrap();
        report.materials[1].at_places = Some(at.clone());
        report.limits = limits(&report, &[], &Asked::default());
        (at.simulated.unwrap(), report.clone())
    };
    let (good, report) = judged(&bake);
    assert!(good.views.len() == 8 && good.misses().count() == 0, "{good:?}");
    assert_eq!(report.is_within_budget(), Some(true), "{:?}", report.limits);

    let layout = &bake.manifest.tables.last().unwrap().layout;
    let row = 4 * layout.tile_size()[0] as usize;
    let texels = bake.texels(TableKind::Lobes);
    let (nominal, others) = texels.split_at_mut(row);
    others.chunks_exact_mut(row).for_each(|tile| tile.copy_from_slice(nominal));
    let (wrong, report) = judged(&bake);
    assert_eq!(report.is_within_budget(), Some(false));
    let limit = report.limits.iter().find(|limit| !limit.is_held).unwrap();
    assert!(limit.quantity.starts_with("lacquered-copper: ") && limit.quantity.contains("slab_factor"), "{limit:?}");
    let worst = wrong.misses().next().unwrap().words();
    assert!(worst.contains("slab_factor") && worst.contains("degrees") && worst.contains("albedo"), "{worst}");
}

/// By hand: centres of two texels are at a quarter and three quarters, and half way between them lie means.
#[test]
fn places_have_the_texels_of_their_coordinates() {
    let (mut bake, maps) = textured();
    let moved = bake.manifest.materials[0].maps.iter_mut().find(|map| map.slot == MapSlot::Thickness).unwrap();
    moved.transform = Some([[1.0, 0.0, 0.5], [0.0, 1.0, 0.0]]);
    let subject = Subject { maps, ..bake.subject() };
    let places = Places::of(&subject, 0).unwrap();
    let close = |found: f32, expected: f32| assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    let least = places.at(&subject, 0, [0.25, 0.3]);
    close(least.alpha_factor, 0.25);
    close(least.slab_factor, 1.0);
    assert_eq!((least.base_color, least.normal), (Some([0.1, 0.2, 0.3]), PlaceValues::NONE.normal));
    let between = places.at(&subject, 0, [2.5, -0.7]);
    close(between.alpha_factor, 0.75 * 0.75);
    close(between.slab_factor, 0.55);
    close(between.base_color.unwrap()[1], 0.5);
    // Texels .4 and .35 are -.2 and -.3.
    let normal = places.normal_at(&subject, 0, [0.25, 0.3]);
    assert!((normal - DVec3::new(-0.2, -0.3, 0.87_f64.sqrt())).length() < 1e-6, "{normal}");
    assert_eq!(
        Places::of(&Subject { maps: Vec::new(), ..subject.clone() }, 0).unwrap().normal_at(&subject, 0, [0.25; 2]),
        DVec3::Z
    );
}

/// Oracles: the albedo of a diffuse formula in closed form, and that of the stack at one wavelength by other paths.
#[test]
fn albedos_are_means_over_places() {
    let (bake, maps) = textured();
    let subject = Subject { maps, ..bake.subject() };
    let places = Places::of(&subject, 0).unwrap();
    let matt = |share: f64| move |wi: DVec3, _: DVec3| [share * wi.z / std::f64::consts::PI; 3];
    let here = [([0.25, 0.5], 0.2), ([0.75, 0.5], 0.6)].map(|(uv, share)| (places.at(&subject, 0, uv), matt(share)));
    let settings = AlbedoSettings { thetas_deg: vec![0.0, 60.0], paths: 1 << 15, seed: 3 };
    let found = albedos(&subject, 0, &here, &settings).unwrap();
    for at in &found {
        let (sin, cos) = libm::sincos(at.theta_deg.to_radians());
        let wo = DVec3::new(sin, 0.0, cos);
        assert!(at.formula.iter().all(|albedo| (albedo - 0.4).abs() < 1e-4), "{at:?}");
        for (c, nm) in WAVELENGTHS_NM.into_iter().enumerate() {
            let exact = here.each_ref().map(|(values, _)| {
                let mut place = Place::NONE;
                place.sample.alpha_factor = values.alpha_factor.into();
                place.sample.slab_factor = values.slab_factor.into();
                place.base_color = values.base_color.map(|color| color.map(f64::from));
                let stack = Monochrome::new(&place.stack(&bake.stacks[0]), nm, c);
                LayeredMc::new(InterfaceMode::SmithWalk).albedo(&stack, wo, 1 << 14).mean
            });
            let (mean, noise) = (0.5 * (exact[0] + exact[1]), at.std_err[c]);
            assert!((at.simulated[c] - mean).abs() < 5.0 * noise && noise < 4e-3, "{at:?} {mean}");
        }
    }
}

/// In a white furnace the light of a place is its albedo in every way, and a dark half of the surroundings takes half of what a matt formula shows.
#[test]
fn places_are_lit_as_their_albedos_say() {
    let (bake, maps) = textured();
    let subject = Subject { maps, ..bake.subject() };
    let values = Places::of(&subject, 0).unwrap().at(&subject, 0, [0.5, 0.5]);
    let matt = |wi: DVec3, _: DVec3| [0.4 * wi.z / std::f64::consts::PI; 3];
    let wo = DVec3::new(0.6, 0.0, 0.8);
    let site = Site::new(&subject, 0, &values).unwrap();
    let settings = AlbedoSettings { thetas_deg: vec![libm::acos(0.8).to_degrees()], paths: 1 << 14, seed: 1 };
    let albedo = albedos(&subject, 0, &[(values, matt)], &settings).unwrap()[0];
    let alphas = [0.05 * 0.5625];
    let lit = |radiance: &dyn Fn(DVec3) -> [f64; 3]| site.lit(&matt, &alphas, wo, radiance, 1 << 14, 5);
    let white = lit(&|_| [1.0; 3]);
    for (way, expected) in [(white.formula, [0.4; 3]), (white.model, albedo.model), (white.simulated, albedo.simulated)]
    {
        assert!(way.iter().zip(expected).all(|(way, expected)| (way - expected).abs() < 0.01), "{white:?} {albedo:?}");
    }
    let half = lit(&|wi| [if wi.y > 0.0 { 1.0 } else { 0.0 }; 3]);
    assert!(
        (half.formula[0] - 0.2).abs() < 0.01 && (half.simulated[0] / white.simulated[0] - 0.5).abs() < 0.03,
        "{half:?}"
    );
}
