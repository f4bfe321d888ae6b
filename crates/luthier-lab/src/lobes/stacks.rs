//! Stacks to fit: materials, their twins in the other distribution, and random ones.

use luthier_manifest::Budget;
use luthier_material::{BakeSettings, Effects, LayerExtras, Material, Places, SurfaceClass};
use luthier_optics::constants::dataset;
use luthier_optics::ior::Ior;
use luthier_optics::sampling::split_mix::SplitMix64;
use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Stack, Surface};
use luthier_report::ModelSubject;

/// Wavelengths of random stacks.
const WAVELENGTHS_NM: [f64; 3] = [630.0, 532.0, 465.0];

/// Conductors of random stacks.
const METALS: [&str; 7] = ["au", "ag", "cu", "al", "cr", "ti", "fe"];

/// Numbers from a seed.
struct Draw(SplitMix64);

impl Draw {
    /// A surface, anisotropic where it is brushed, and its slope parameters.
    fn brushed(&mut self, distribution: Distribution, is_brushed: bool, rotation_deg: f64) -> (Surface, [f64; 2]) {
        let [alpha_x, alpha_y] = [0; 2].map(|_| 0.02 * libm::pow(30.0, self.uniform()));
        let alpha_y = if is_brushed { alpha_y } else { alpha_x };
        (Surface { distribution, alpha_x, alpha_y, rotation: rotation_deg.to_radians() }, [alpha_x, alpha_y])
    }

    fn uniform(&mut self) -> f64 {
        self.0.unit()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.between([low, high])
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// A slope parameter, .001 to .8, each factor as often.
    fn alpha(&mut self) -> f64 {
        0.001 * libm::pow(800.0, self.uniform())
    }

    fn metal(&mut self) -> (&'static str, Ior) {
        let id = METALS[(self.uniform() * METALS.len() as f64) as usize];
        (id, dataset(id).map_or_else(|| constant(1.0), |data| data.ior.clone()))
    }

    fn rgb(&mut self, low: f64, high: f64) -> [f64; 3] {
        [0; 3].map(|_| self.between(low, high))
    }
}

/// A material as it is, or with the other distribution.
pub(crate) fn of(material: &Material, is_twin: bool) -> ModelSubject {
    let mut stack = material.stack.clone();
    if is_twin {
        for layer in &mut stack.layers {
            layer.surface.distribution = match layer.surface.distribution {
                Distribution::Beckmann => Distribution::Ggx,
                Distribution::Ggx => Distribution::Beckmann,
                other => other,
            };
        }
    }
    ModelSubject { name: material.name.clone(), stack, wavelengths_nm: material.bake.wavelengths_nm() }
}

/// A material without a file, for a bake of a stack.
pub(crate) fn material(name: String, stack: Stack, bake: BakeSettings) -> Material {
    Material {
        name,
        source: String::new(),
        text: String::new(),
        files: Vec::new(),
        description: String::new(),
        references: Vec::new(),
        class: SurfaceClass::of(&stack),
        layers: vec![LayerExtras::default(); stack.layers.len()],
        stack,
        effects: Effects::default(),
        budget: Budget::default(),
        places: Places::default(),
        bake,
    }
}

/// A plausible stack: up to four coats, some absorbing, some with a film, over a metal or a diffuse base. One coat in ten has a lower index than the
/// medium above it.
pub(crate) fn random(seed: u64) -> ModelSubject {
    let mut draw = Draw(SplitMix64::new(seed.wrapping_mul(0x5851_f42d_4c95_7f2d)));
    let distribution = if draw.chance(0.5) { Distribution::Ggx } else { Distribution::Beckmann };
    let mut name = format!("{seed} {}:", distribution.name());
    let mut layers = Vec::new();
    for _ in 0..(5.0 * draw.uniform()) as u32 {
        let alpha = draw.alpha();
        let index = draw.between(1.2, 2.6);
        let index = if draw.chance(0.1) { 1.0 / index } else { index };
        let absorption_per_um = if draw.chance(0.5) { draw.rgb(0.0, 0.7) } else { [0.0; 3] };
        let films = if draw.chance(0.1) {
            let nm = draw.between(100.0, 600.0);
            vec![Film { ior: constant(draw.between(1.3, 2.3)), thickness: FilmThickness { min_nm: nm, max_nm: nm } }]
        } else {
            Vec::new()
        };
        name += &format!(" {index:.2}/{alpha:.3}{}", if films.is_empty() { "" } else { " film" });
        let slab = Slab { thickness_um: 1.0, absorption_per_um };
        let base = Base::Dielectric { ior: constant(index), slab };
        layers.push(Layer { films, surface: Surface::isotropic(distribution, alpha), base });
    }
    if draw.chance(0.5) {
        let (id, ior) = draw.metal();
        let alpha = draw.alpha();
        name += &format!(" {id}/{alpha:.3}");
        let surface = Surface::isotropic(distribution, alpha);
        layers.push(Layer { films: Vec::new(), surface, base: Base::Conductor { ior } });
    } else {
        let albedo = draw.rgb(0.03, 0.9);
        name += " diffuse";
        let base = Base::Diffuse(Diffuse { albedo, sigma: if draw.chance(0.3) { 0.4 } else { 0.0 } });
        layers.push(Layer { films: Vec::new(), surface: Surface::smooth(), base });
    }
    ModelSubject { name, stack: Stack { exterior: Ior::vacuum(), layers }, wavelengths_nm: WAVELENGTHS_NM }
}

/// A coat over a metal or a diffuse base, one of them or both brushed; for odd seeds both, along other axes.
pub(crate) fn anisotropic(seed: u64) -> ModelSubject {
    let mut draw = Draw(SplitMix64::new((seed + 1).wrapping_mul(0x9fb2_1c65_1e98_df25)));
    let distribution = if draw.chance(0.5) { Distribution::Ggx } else { Distribution::Beckmann };
    let mut name = format!("{seed} {}:", distribution.name());
    let is_crossed = seed % 2 == 1;
    let is_metal = draw.chance(0.5) || is_crossed;
    let is_coat_brushed = is_crossed || !is_metal || draw.chance(0.5);
    let rotation_deg = if is_crossed { libm::round(draw.between(15.0, 75.0)) } else { 90.0 };
    let (mut coat, [x, y]) = draw.brushed(distribution, is_coat_brushed, rotation_deg);
    if !is_coat_brushed && draw.chance(0.5) {
        coat = Surface::smooth();
    }
    let index = draw.between(1.3, 1.8);
    let absorption_per_um = if draw.chance(0.5) { draw.rgb(0.0, 0.5) } else { [0.0; 3] };
    name += &format!(" {index:.2}");
    name += &match (is_coat_brushed, coat.is_smooth()) {
        (true, _) => format!("/{x:.3}x{y:.3}@{rotation_deg:.0}"),
        (false, true) => "/smooth".to_owned(),
        (false, false) => format!("/{x:.3}"),
    };
    let slab = Slab { thickness_um: 1.0, absorption_per_um };
    let mut layers =
        vec![Layer { films: Vec::new(), surface: coat, base: Base::Dielectric { ior: constant(index), slab } }];
    if is_metal {
        let (id, ior) = draw.metal();
        let (base, [x, y]) = draw.brushed(distribution, true, 0.0);
        name += &format!(" {id}/{x:.3}x{y:.3}");
        layers.push(Layer { films: Vec::new(), surface: base, base: Base::Conductor { ior } });
    } else {
        name += " diffuse";
        let base = Base::Diffuse(Diffuse { albedo: draw.rgb(0.03, 0.9), sigma: 0.0 });
        layers.push(Layer { films: Vec::new(), surface: Surface::smooth(), base });
    }
    ModelSubject { name, stack: Stack { exterior: Ior::vacuum(), layers }, wavelengths_nm: WAVELENGTHS_NM }
}

/// An index that does not depend on the wavelength.
fn constant(n: f64) -> Ior {
    Ior::constant(n, 0.0).unwrap_or_else(|_| Ior::vacuum())
}
