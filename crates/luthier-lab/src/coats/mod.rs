//! `coats`: coats of engines against the simulation: errors, energy and reciprocity of their formulas.

mod adobe;
mod cases;
mod disney;
mod filament;
mod gltf;
mod open_pbr;
mod page;
mod scaling;
mod standard_surface;
mod surface;

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use luthier_layers::models::lobes::Lobes;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::registry::model;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::sampling::split_mix::SplitMix64;
use luthier_report::{ModelSubject, Reference, Shown, ViewError};
use luthier_shader::Yardstick;
use luthier_terminal::{Bar, Failure, Outcome, deliver};
use rayon::prelude::*;

use self::cases::{Case, Group, WAVELENGTHS_NM, cases};
use self::surface::{Pair, Shader, Surface};
use crate::cli::CoatsOptions;
use crate::lobes::{JUDGE_SEED, judge_settings};

/// Angles of the eye against the normal, degrees.
const THETAS_DEG: [f64; 6] = [0.0, 30.0, 45.0, 60.0, 70.0, 80.0];

/// A formula of an engine.
struct Engine {
    name: &'static str,
    shader: fn(&Surface) -> Shader,
    /// A shader whose cost is known.
    yardstick: Option<Yardstick>,
    /// Name of the formula over a base that is changed once for its coat ([`Surface::remedied`]), which costs the same; of formulas with a shader.
    changed: Option<&'static str>,
}

const ENGINES: [Engine; 7] = [
    Engine {
        name: "glTF KHR_materials_clearcoat",
        shader: gltf::shader,
        yardstick: Some(Yardstick::GltfClearcoat),
        changed: Some("glTF, base changed"),
    },
    Engine {
        name: "Filament",
        shader: filament::shader,
        yardstick: Some(Yardstick::FilamentClearcoat),
        changed: Some("Filament, base changed"),
    },
    Engine { name: "Disney 2012", shader: disney::shader, yardstick: None, changed: None },
    Engine { name: "Standard Surface in MaterialX", shader: standard_surface::shader, yardstick: None, changed: None },
    Engine { name: "albedo scaling", shader: scaling::shader, yardstick: None, changed: None },
    Engine { name: "OpenPBR in MaterialX", shader: open_pbr::shader, yardstick: None, changed: None },
    Engine { name: "adobe/openpbr-bsdf", shader: adobe::shader, yardstick: None, changed: None },
];

/// Models of luthier, after the engines.
const OWN: [&str; 2] = ["belcour", "lobes"];

/// Random pairs of directions for each case, whose two orders are compared.
const PAIRS: usize = 200;

/// Least cosine of those directions.
const COS_MIN: f64 = 0.1;

/// Errors, energies and asymmetries of a formula on a case.
struct Judged {
    views: Vec<ViewError>,
    /// With the base that this page proposes; empty for models of luthier and without a coat.
    remedied: Vec<ViewError>,
    /// Relative difference of both orders of directions, the largest.
    asymmetry: f64,
}

/// A case, and what was judged in the order of [`ENGINES`] and [`OWN`].
struct Result {
    group: Group,
    models: Vec<Judged>,
    noise: f64,
}

/// A coat over a base as a stack, and as engines draw it.
pub(crate) struct Coated {
    pub(crate) subject: ModelSubject,
    pub(crate) drawn: Vec<Drawn>,
}

/// A surface by the formula of an engine.
pub(crate) struct Drawn {
    pub(crate) engine: &'static str,
    pub(crate) yardstick: Option<Yardstick>,
    shader: Shader,
}

impl Drawn {
    /// `f cos_theta_i`, of unit directions to the light and to the eye.
    pub(crate) fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        value(&self.shader, wi, wo)
    }
}

/// The coats of this page's first table.
pub(crate) fn coated() -> Vec<Coated> {
    let coated = cases().into_iter().filter(|case| page::COATED.contains(&case.group));
    let coated = (0_u32..).zip(coated).map(|(n, case)| {
        let changed = case.surface.remedied();
        let drawn = |engine: &Engine, name, surface| Drawn {
            engine: name,
            yardstick: engine.yardstick,
            shader: (engine.shader)(surface),
        };
        let engines = ENGINES.iter().flat_map(|engine| {
            let of = [(Some(engine.name), &case.surface), (engine.changed, &changed)];
            of.map(|(name, surface)| Some(drawn(engine, name?, surface)))
        });
        Coated { subject: subject(format!("coat-{n}"), &case), drawn: engines.flatten().collect() }
    });
    coated.collect()
}

fn subject(name: String, case: &Case) -> ModelSubject {
    ModelSubject { name, stack: case.stack(), wavelengths_nm: WAVELENGTHS_NM }
}

/// Judges, as a page.
pub(crate) fn run(options: &CoatsOptions) -> Outcome {
    let cases = cases();
    let (bar, done) = (Bar::new("judging coats"), AtomicU64::new(0));
    let results = cases.par_iter().map(|case| {
        let result = judge(case, options);
        bar.set(done.fetch_add(1, Ordering::Relaxed) + 1, cases.len() as u64);
        result
    });
    let results: Vec<Result> = results.collect();
    drop(bar);
    let page = page::page(&results, options).map_err(Failure::input)?;
    deliver(&page, options.destination.output.as_deref())
}

/// `f cos_theta_i` of a shader, 0 below the horizon.
fn value(shader: &Shader, wi: DVec3, wo: DVec3) -> Rgb {
    Pair::of(wi, wo).map_or([0.0; 3], |at| shader(&at))
}

fn judge(case: &Case, options: &CoatsOptions) -> Result {
    let subject = subject(String::new(), case);
    let stack = subject.stack.clone();
    let reference = Reference::new(&subject, &THETAS_DEG, judge_settings(&options.precision, JUDGE_SEED));
    let shown = |surface: &Surface, engine: &Engine| {
        let shader = (engine.shader)(surface);
        let values = |wi, wo| value(&shader, wi, wo);
        (reference.errors(Shown::Values(&values)), asymmetry(&values))
    };
    let mut models: Vec<Judged> = ENGINES
        .iter()
        .map(|engine| {
            let (views, asymmetry) = shown(&case.surface, engine);
            let remedied = case.surface.coat.map(|_| shown(&case.surface.remedied(), engine).0);
            Judged { views, remedied: remedied.unwrap_or_default(), asymmetry }
        })
        .collect();
    let stacks = [0, 1, 2].map(|c: usize| Monochrome::new(&stack, WAVELENGTHS_NM[c], c));
    if let Some(belcour) = model(OWN[0]) {
        let values = |wi, wo| [0, 1, 2].map(|c: usize| belcour.eval(&stacks[c], wi, wo));
        let views = reference.errors(Shown::Model(belcour.as_ref()));
        models.push(Judged { views, remedied: Vec::new(), asymmetry: asymmetry(&values) });
    }
    let lobes = Lobes::of(&stack, &Color::ThreeWavelengths(WAVELENGTHS_NM));
    let values = |wi, wo| lobes.seen(&stacks, wo)(wi);
    let views = reference.errors(Shown::Lobes(&lobes));
    let noise = views.iter().map(|view| view.lobe_floor).fold(0.0, f64::max);
    models.push(Judged { views, remedied: Vec::new(), asymmetry: asymmetry(&values) });
    Result { group: case.group, models, noise }
}

/// The largest `|f(i, o) - f(o, i)|` over the larger of both, of random pairs.
fn asymmetry(values: &dyn Fn(DVec3, DVec3) -> Rgb) -> f64 {
    let mut random = SplitMix64::new(7);
    let mut direction = || {
        let (cos, turn) = (random.between([COS_MIN, 1.0]), random.between([0.0, std::f64::consts::TAU]));
        let sin = (1.0 - cos * cos).sqrt();
        DVec3::new(sin * libm::cos(turn), sin * libm::sin(turn), cos)
    };
    let mut most = 0.0_f64;
    for _ in 0..PAIRS {
        let [a, b] = [direction(), direction()];
        let (there, back) = (values(a, b), values(b, a));
        for (there, back) in there.iter().zip(&back) {
            let [there, back] = [there / a.z, back / b.z];
            most = most.max((there - back).abs() / there.max(back).max(1e-9));
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(coat: Option<f64>, metallic: f64) -> Surface {
        Surface { coat, alpha: 0.2, color: [0.7, 0.4, 0.1], metallic, remedy: None }
    }

    /// Formulas whose factors at both directions are alike are reciprocal, those with an albedo at the eye alone are not.
    #[test]
    fn formulas_are_reciprocal_where_they_should_be() {
        for (engine, is_reciprocal) in ENGINES.iter().zip([false, false, true, false, false, false, true]) {
            let shader = (engine.shader)(&surface(Some(0.2), 0.5));
            let found = asymmetry(&|wi, wo| value(&shader, wi, wo));
            assert_eq!(found < 1e-12, is_reciprocal, "{}: {found}", engine.name);
        }
        // Bare, glTF has no albedo at the eye.
        let shader = (gltf::shader)(&surface(None, 0.5));
        assert!(asymmetry(&|wi, wo| value(&shader, wi, wo)) < 1e-12);
    }

    /// A bare metal of slope parameter .2 has the same lobe everywhere, but for light between facets and the masking: a tenth at most at this pair.
    #[test]
    fn bare_metals_agree() {
        let (wi, wo) = (DVec3::new(0.3, 0.1, 0.9).normalize(), DVec3::new(-0.2, 0.0, 0.9).normalize());
        let plain = value(&gltf::shader(&surface(None, 1.0)), wi, wo);
        for engine in &ENGINES {
            let found = value(&(engine.shader)(&surface(None, 1.0)), wi, wo);
            for (found, plain) in found.iter().zip(&plain) {
                assert!((found / plain - 1.0).abs() < 0.1, "{}: {found} {plain}", engine.name);
            }
        }
    }

    /// Oracle: the WGSL of the yardstick is glTF's formula, written by another hand; here its terms at one pair, by hand. At normal incidence of both,
    /// D G / 4 is 1 / (4 pi alpha^2).
    #[test]
    fn gltf_at_the_normal_is_by_hand() {
        let shader = gltf::shader(&surface(Some(0.1), 1.0));
        let found = value(&shader, DVec3::Z, DVec3::Z);
        let lobe = |alpha: f64| 0.25 / (std::f64::consts::PI * alpha * alpha);
        for (c, color) in [0.7, 0.4, 0.1].into_iter().enumerate() {
            let expected = 0.96 * color * lobe(0.2) + 0.04 * lobe(0.1);
            assert!((found[c] / expected - 1.0).abs() < 1e-12, "{} {expected}", found[c]);
        }
    }
}
