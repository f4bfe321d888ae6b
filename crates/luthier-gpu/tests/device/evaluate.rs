//! `luthier_eval` on the device against the model in f64.

use glam::DVec3;
use luthier_gpu::GpuError;
use luthier_layers::layers::Layer;
use luthier_layers::models::elek::Elek;
use luthier_layers::terms::Terms;
use luthier_lut::{AtlasLayout, Image, Mapping, TableKind, TexelFormat, WeightBits, bilinear};
use luthier_manifest::LayerRecord;
use luthier_optics::Rgb;
use luthier_optics::stack::Distribution;
use luthier_shader::Form;
use num_complex::Complex64;

use crate::adapter::gpu;
use crate::bake_by_hand::{Table, artefacts, axis, conductor, dielectric, diffuse};
use crate::record_terms::{RecordTerms, model_layers, reflectance};

/// Largest relative error of a device against f64.
const TOLERANCE: f64 = 1e-3;

/// Values of f cos_theta_i below this count as this: a hundredth of what a white Lambertian surface gives at 72
/// degrees. Only the tails of the narrowest Beckmann lobes need it: at exp(-30) the exponent multiplies every
/// rounding of f32 by 30.
const FLOOR: f64 = 1e-3;

pub(crate) type Pair = ([f32; 3], [f32; 3]);

/// Deterministic numbers in 0..1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        // SplitMix64 (Steele, Lea and Flood 2014).
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self, cos_theta: f64) -> DVec3 {
        let phi = std::f64::consts::TAU * self.next();
        let sin_theta = (1.0 - cos_theta * cos_theta).sqrt();
        DVec3::new(sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta)
    }

    /// Half of the directions over the solid angle, half close to the horizon, down to 1e-7.
    fn any(&mut self) -> DVec3 {
        let cos_theta = if self.next() < 0.5 { self.next() } else { 10f64.powf(-7.0 * self.next()) };
        self.direction(cos_theta)
    }
}

fn single(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// Random, grazing, and near the mirrored direction at all spreads from 1e-5 to 1.
pub(crate) fn pairs(seed: u64) -> Vec<Pair> {
    let mut numbers = Numbers(seed);
    let mut pairs = Vec::new();
    for _ in 0..4000 {
        pairs.push((single(numbers.any()), single(numbers.any())));
        let wi = numbers.any();
        let spread = 10f64.powf(-5.0 * numbers.next());
        let turned = DVec3::new(-wi.x, -wi.y, wi.z) + spread * (numbers.direction(0.0) * numbers.next());
        if let Some(wo) = turned.try_normalize().filter(|w| w.z > 0.0) {
            pairs.push((single(wi), single(wo)));
        }
    }
    pairs
}

/// Directions where formulas divide by zero: at and below the horizon, opposite, identical, the normal.
fn corners() -> Vec<Pair> {
    let tiny = f32::MIN_POSITIVE;
    let directions = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 1e-7],
        [-1.0, 0.0, 1e-7],
        [0.0, 1.0, tiny],
        [0.0, -1.0, tiny],
        [0.0, 1.0, 1e-40],
        [0.6, 0.0, 0.8],
        [-0.6, 0.0, 0.8],
        [0.6, 0.0, -0.8],
        [-0.6, 0.0, -0.8],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, -0.0],
    ];
    directions.iter().flat_map(|&wi| directions.iter().map(move |&wo| (wi, wo))).collect()
}

/// Whether the model leaves the device no freedom: not where a cosine is below the normal range of f32, which devices
/// may flush to zero, nor where the sum of both directions vanishes in f32 and the shader returns 0 for it.
fn is_determined((wi, wo): &Pair) -> bool {
    let sum: f32 = wi.iter().zip(wo).map(|(a, b)| (a + b) * (a + b)).sum();
    !wi[2].is_subnormal() && !wo[2].is_subnormal() && sum > 1e-24
}

/// Largest |device - f64| / max(|f64|, FLOOR) where the value is determined, and where. Every value is finite.
fn worst(layers: &[Layer], terms: &impl Terms, pairs: &[Pair], device: &[[f32; 3]]) -> (f64, String) {
    let mut worst = (0.0, String::new());
    for (pair, got) in pairs.iter().zip(device) {
        let (wi, wo) = pair;
        assert!(got.iter().all(|v| v.is_finite()), "wi {wi:?} wo {wo:?}: {got:?}");
        if !is_determined(pair) {
            continue;
        }
        let double = |v: &[f32; 3]| DVec3::from_array(v.map(f64::from));
        let expected = Elek::default().eval_with(layers, terms, double(wi), double(wo));
        for c in 0..3 {
            let error = (f64::from(got[c]) - expected[c]).abs() / expected[c].abs().max(FLOOR);
            if error > worst.0 {
                worst = (error, format!("wi {wi:?} wo {wo:?} channel {c}: device {} f64 {}", got[c], expected[c]));
            }
        }
    }
    worst
}

/// Gold-like and glass-like stacks, one per feature of the model.
fn stacks() -> Vec<(&'static str, Vec<LayerRecord>)> {
    let glass = |alpha, n| LayerRecord { distribution: Distribution::Beckmann, ..dielectric(alpha, n) };
    let absorbing = LayerRecord { optical_depth: [0.2, 0.9, 2.5], ..glass(0.05, 1.5) };
    // Relative to a coat of index 1.5.
    let gold = |alpha| conductor(alpha, [0.12, 0.35, 0.97], [2.32, 1.6, 1.25]);
    let filmed = |base: LayerRecord| LayerRecord {
        film_ior_n: [1.41, 1.45, 1.48],
        film_ior_k: [0.0, 0.01, 0.05],
        film_thickness_waves: [400.0 / 645.0, 400.0 / 525.0, 400.0 / 445.0],
        film_thickness_nm: 400.0,
        film_thickness_max_nm: 400.0,
        ..base
    };
    vec![
        ("dielectric over diffuse", vec![dielectric(0.1, 1.5), diffuse([0.8, 0.1, 0.05], 0.0)]),
        ("smooth coat with absorption over Oren-Nayar", vec![absorbing.clone(), diffuse([0.9, 0.6, 0.3], 0.5)]),
        ("dielectric over conductor", vec![glass(0.02, 1.5), gold(0.3)]),
        ("film on a conductor", vec![filmed(conductor(0.15, [0.2, 0.9, 1.4], [3.9, 2.4, 1.9]))]),
        ("film on a dielectric over diffuse", vec![filmed(dielectric(0.4, 1.6)), diffuse([0.5; 3], 0.2)]),
        ("three layers", vec![absorbing, dielectric(0.3, 1.2), diffuse([0.2, 0.7, 0.9], 0.3)]),
        ("lower index below: total reflection", vec![dielectric(0.2, 0.75), diffuse([0.7; 3], 0.0)]),
        ("Lambert", vec![diffuse([0.18, 0.5, 1.0], 0.0)]),
        ("Oren-Nayar, very rough", vec![diffuse([0.9; 3], 1.2)]),
        ("smoothest GGX", vec![dielectric(1e-3, 1.5), diffuse([0.5; 3], 0.0)]),
        ("smoothest Beckmann over smoothest conductor", vec![glass(1e-3, 1.33), gold(1e-3)]),
        ("roughest", vec![dielectric(1.0, 1.5), conductor(1.0, [3.1; 3], [4.4; 3])]),
        ("nearly index-matched", vec![glass(0.1, 1.01), diffuse([0.5; 3], 0.0)]),
    ]
}

#[test]
fn the_full_form_equals_f64() {
    let Some(gpu) = gpu() else { return };
    let stacks = stacks();
    let materials = stacks.iter().map(|(_, layers)| layers.clone()).collect();
    let scene = gpu.scene(&artefacts(Form::Full, materials, &[]), Form::Full).unwrap();
    let pairs: Vec<Pair> = pairs(7).into_iter().chain(corners()).collect();
    let mut failures = Vec::new();
    for (i, (name, records)) in stacks.iter().enumerate() {
        let device = scene.evaluate(i as u32, &pairs).unwrap();
        let (error, at) = worst(&model_layers(records), &RecordTerms(records), &pairs, &device);
        eprintln!("{name}: {error:.2e} at {at}");
        if error > TOLERANCE {
            failures.push(format!("{name}: {error:.2e} at {at}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The terms as the tables give them, read in f64.
struct TableTerms<'a> {
    records: &'a [LayerRecord],
    fresnel: (&'a Table, Image),
    distribution: (&'a Table, Image),
}

impl Terms for TableTerms<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        let (table, texels) = &self.fresnel;
        let tile = self.records[layer].tiles[TableKind::Fresnel].unwrap();
        let cos_theta_d = self.records[layer].row_cosine(cos_theta_d);
        let [r, g, b, _] = bilinear(texels, table.layout.position(tile, [cos_theta_d, 0.0]), WeightBits::Exact);
        [r, g, b]
    }

    fn distribution(
        &self,
        _: usize,
        distribution: Distribution,
        alpha: f64,
        cos_theta_h: f64,
        sin_theta_h_sq: f64,
    ) -> f64 {
        let (table, texels) = &self.distribution;
        let theta_h = sin_theta_h_sq.sqrt().atan2(cos_theta_h);
        let tile = u32::from(distribution == Distribution::Ggx);
        bilinear(texels, table.layout.position(tile, [theta_h, alpha]), WeightBits::Exact)[0]
    }
}

/// The baked form against f64 that reads the same tables: what remains is the arithmetic of the device. Formats
/// without filtering, so that the weights of the hardware play no part.
#[test]
fn the_baked_form_equals_f64_on_the_same_tables() {
    let Some(gpu) = gpu() else { return };
    let row = AtlasLayout {
        x: axis("cos_theta", 1.0, 128, Mapping::Linear),
        y: None,
        apron: 0,
        columns: 1,
        tiles: 2,
        base: luthier_lut::RowBase::Zero,
    };
    let fresnel = Table::new(TableKind::Fresnel, row.clone(), TexelFormat::Rgba32Float, |tile, [cos, _]| {
        let below = if tile == 0 { Complex64::new(1.5, 0.0) } else { Complex64::new(0.35, 1.6) };
        [reflectance(below, 0.0, below, cos) as f32; 4]
    });
    let square = AtlasLayout {
        x: axis("theta_h", std::f64::consts::FRAC_PI_2, 512, Mapping::Power { exponent: 8.0 }),
        y: Some(axis("alpha", 1.0, 256, Mapping::Power { exponent: 2.0 })),
        ..row
    };
    let distribution = Table::new(TableKind::Distribution, square, TexelFormat::R32Float, |tile, [theta_h, alpha]| {
        let kind = if tile == 0 { Distribution::Beckmann } else { Distribution::Ggx };
        let (sin, cos) = theta_h.sin_cos();
        [RecordTerms(&[]).distribution(0, kind, alpha.max(1e-3), cos, sin * sin) as f32; 4]
    });
    let tables = [fresnel.clone(), distribution.clone()];

    let tiled = |layer: LayerRecord, fresnel: u32| {
        let ggx = u32::from(layer.distribution == Distribution::Ggx);
        LayerRecord {
            tiles: layer.tiles.with([(TableKind::Fresnel, Some(fresnel)), (TableKind::Distribution, Some(ggx))]),
            ..layer
        }
    };
    let beckmann = LayerRecord { distribution: Distribution::Beckmann, ..dielectric(0.1, 1.5) };
    let materials = vec![
        vec![tiled(dielectric(0.03, 1.5), 0), diffuse([0.8, 0.4, 0.2], 0.3)],
        vec![tiled(beckmann, 0), tiled(conductor(0.25, [0.35; 3], [1.6; 3]), 1)],
        // Down in index, over the cosine of the refracted direction, the row is that of the other side.
        vec![
            tiled(LayerRecord { critical_cot_sq: 1.25, ..dielectric(0.1, 1.0 / 1.5) }, 0),
            tiled(conductor(0.25, [0.35; 3], [1.6; 3]), 1),
        ],
    ];
    let scene = gpu.scene(&artefacts(Form::Baked, materials.clone(), &tables), Form::Baked).unwrap();
    let pairs: Vec<Pair> = pairs(11).into_iter().chain(corners()).collect();
    for (i, records) in materials.iter().enumerate() {
        let texels = |t: &Table| t.texels();
        let terms = TableTerms {
            records,
            fresnel: (&fresnel, texels(&fresnel)),
            distribution: (&distribution, texels(&distribution)),
        };
        let device = scene.evaluate(i as u32, &pairs).unwrap();
        let (error, at) = worst(&model_layers(records), &terms, &pairs, &device);
        eprintln!("{i}: {error:.2e} at {at}");
        assert!(error <= TOLERANCE, "{i}: {error:.2e} at {at}");
    }
}

#[test]
fn any_number_of_pairs_and_no_others_materials() {
    let Some(gpu) = gpu() else { return };
    let materials = vec![vec![diffuse([0.5, 0.25, 0.125], 0.0)], vec![diffuse([1.0; 3], 0.0)]];
    let scene = gpu.scene(&artefacts(Form::Full, materials, &[]), Form::Full).unwrap();
    assert!(scene.evaluate(0, &[]).unwrap().is_empty());
    let up = [0.0, 0.0, 1.0];
    for count in [1, 63, 64, 65, (1 << 18) + 1] {
        let values = scene.evaluate(0, &vec![(up, up); count]).unwrap();
        assert_eq!(values.len(), count);
        let pi = std::f32::consts::PI;
        assert!(values.iter().all(|v| (v[0] * pi - 0.5).abs() < 1e-6 && (v[2] * pi - 0.125).abs() < 1e-6));
    }
    assert!(matches!(scene.evaluate(2, &[(up, up)]), Err(GpuError::NoMaterial { material: 2, count: 2 })));
}
