//! The exact terms of the model, in f64, from a layer record: textbook formulas, written independently of shader and
//! baker.

use std::f64::consts::PI;

use luthier_layers::layers::{Below, Layer};
use luthier_layers::terms::Terms;
use luthier_manifest::{LayerKind, LayerRecord};
use luthier_optics::Rgb;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

pub(crate) struct RecordTerms<'a>(pub(crate) &'a [LayerRecord]);

impl Terms for RecordTerms<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        let r = &self.0[layer];
        [0, 1, 2].map(|c| {
            let below = Complex64::new(r.ior_n[c], r.ior_k[c]);
            let film = Complex64::new(r.film_ior_n[c], r.film_ior_k[c]);
            reflectance(film, r.film_thickness_waves[c], below, cos_theta_d)
        })
    }

    fn distribution(
        &self,
        _: usize,
        distribution: Distribution,
        alpha: f64,
        cos_theta_h: f64,
        sin_theta_h_sq: f64,
    ) -> f64 {
        let cos_sq = cos_theta_h * cos_theta_h;
        let tan_sq_over_alpha_sq = sin_theta_h_sq / (cos_sq * alpha * alpha);
        match distribution {
            Distribution::Beckmann => (-tan_sq_over_alpha_sq).exp() / (cos_sq * cos_sq),
            Distribution::Ggx => 1.0 / (cos_sq * (1.0 + tan_sq_over_alpha_sq)).powi(2),
            other => panic!("no oracle of {}", other.name()),
        }
    }
}

/// Unpolarised reflectance of an interface with at most one film, from a medium of index 1 (Airy; Born and Wolf, sec.
/// 1.6 and 14.4).
pub(crate) fn reflectance(film: Complex64, waves: f64, below: Complex64, cos: f64) -> f64 {
    let cosine = |n: Complex64| {
        let c = root(1.0 - (1.0 - cos * cos) / (n * n));
        if (n * c).im < 0.0 { -c } else { c }
    };
    let one = Complex64::new(1.0, 0.0);
    let s = |a: Complex64, ca: Complex64, b: Complex64, cb: Complex64| (a * ca - b * cb) / (a * ca + b * cb);
    let p = |a: Complex64, ca: Complex64, b: Complex64, cb: Complex64| (b * ca - a * cb) / (b * ca + a * cb);
    let (c1, c3) = (Complex64::new(cos, 0.0), cosine(below));
    if waves == 0.0 {
        return 0.5 * (s(one, c1, below, c3).norm_sqr() + p(one, c1, below, c3).norm_sqr());
    }
    let c2 = cosine(film);
    let phase = 4.0 * PI * film * c2 * waves;
    let turn = (-phase.im).exp() * Complex64::new(phase.re.cos(), phase.re.sin());
    let join = |top: Complex64, bottom: Complex64| ((top + bottom * turn) / (1.0 + top * bottom * turn)).norm_sqr();
    let sum = join(s(one, c1, film, c2), s(film, c2, below, c3)) + join(p(one, c1, film, c2), p(film, c2, below, c3));
    0.5 * sum
}

/// Square root with a real part that is not negative.
fn root(z: Complex64) -> Complex64 {
    let (radius, angle) = (z.re.hypot(z.im), z.im.atan2(z.re));
    radius.sqrt() * Complex64::new((0.5 * angle).cos(), (0.5 * angle).sin())
}

/// The layers that the f64 model evaluates for these records.
pub(crate) fn model_layers(records: &[LayerRecord]) -> Vec<Layer> {
    records
        .iter()
        .map(|r| Layer {
            surface: Surface::isotropic(r.distribution, r.alpha),
            above: 1.0,
            below: match r.kind {
                LayerKind::Dielectric => Below::Dielectric { ior: r.eta, optical_depth: r.optical_depth },
                LayerKind::Conductor => Below::Conductor,
                LayerKind::Diffuse => Below::Diffuse { albedo: r.albedo, sigma: r.sigma },
            },
        })
        .collect()
}

/// Numbers computed elsewhere with transfer matrices.
#[test]
fn airy_gives_the_published_numbers() {
    let n = |re: f64, im: f64| Complex64::new(re, im);
    // A soap film at 0 and 60 degrees, a film over copper at 70.
    let cases = [
        (n(1.33, 0.0), 300.0 / 550.0, n(1.0, 0.0), 0.0, 0.075_430_20),
        (n(1.33, 0.0), 300.0 / 550.0, n(1.0, 0.0), 60.0, 0.5 * (0.053_628_88 + 0.001_712_59)),
        (n(1.5, 0.0), 200.0 / 690.0, n(0.213, 4.05), 70.0, 0.941_184_56),
    ];
    for (film, waves, below, deg, expected) in cases {
        let got = reflectance(film, waves, below, f64::cos(deg * PI / 180.0));
        assert!((got - expected).abs() < 5e-8, "{film} {deg}: {got} {expected}");
    }
}
