//! The model in f64, straight from the papers: recursive as printed, with textbook amplitudes and angles. Written apart
//! from the crates that bake and evaluate, as the judge of the shipped arithmetic.

use std::f64::consts::PI;

use luthier_manifest::{Distribution, LayerKind, LayerRecord};
use num_complex::Complex64 as C;

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Reflectance of unpolarised light by a film on a base (Airy), indices relative to the medium above. Without a film: an
/// index of 1 and no thickness.
fn reflectance(film: C, base: C, waves: f64, cos_theta: f64) -> f64 {
    let one = C::new(1.0, 0.0);
    let cosine = |index: C| {
        let c = (one - (1.0 - cos_theta * cos_theta) / (index * index)).sqrt();
        if (index * c).im < 0.0 { -c } else { c }
    };
    let (above, within, below) = (C::new(cos_theta, 0.0), cosine(film), cosine(base));
    let round_trip = (C::i() * 4.0 * PI * waves * film * within).exp();
    let airy = |first: C, second: C| ((first + second * round_trip) / (one + first * second * round_trip)).norm_sqr();
    let perpendicular = |n: C, c: C, m: C, d: C| (n * c - m * d) / (n * c + m * d);
    let parallel = |n: C, c: C, m: C, d: C| (m * c - n * d) / (m * c + n * d);
    0.5 * (airy(perpendicular(one, above, film, within), perpendicular(film, within, base, below))
        + airy(parallel(one, above, film, within), parallel(film, within, base, below)))
}

/// Reflectance of the interface of a layer in a channel.
pub(crate) fn fresnel(layer: &LayerRecord, channel: usize, cos_theta: f64) -> f64 {
    let base = C::new(layer.ior_n[channel], layer.ior_k[channel]);
    if layer.film_ior_n[channel] == 0.0 {
        return reflectance(C::new(1.0, 0.0), base, 0.0, cos_theta);
    }
    let film = C::new(layer.film_ior_n[channel], layer.film_ior_k[channel]);
    reflectance(film, base, layer.film_thickness_waves[channel], cos_theta)
}

/// Normalised D.
fn slopes(layer: &LayerRecord, alpha: f64, cos: f64, sin_sq: f64) -> f64 {
    let tan_sq = sin_sq / (cos * cos);
    if layer.distribution == Distribution::Ggx {
        1.0 / (PI * alpha * alpha * cos.powi(4) * (1.0 + tan_sq / (alpha * alpha)).powi(2))
    } else {
        (-tan_sq / (alpha * alpha)).exp() / (PI * alpha * alpha * cos.powi(4))
    }
}

/// Oren and Nayar 1994, eq. 30, as printed there.
fn oren_nayar(rho: f64, sigma: f64, wi: V, wo: V) -> f64 {
    let (ti, to) = (wi[0].hypot(wi[1]).atan2(wi[2]), wo[0].hypot(wo[1]).atan2(wo[2]));
    let cos_phi = (wi[1].atan2(wi[0]) - wo[1].atan2(wo[0])).cos();
    let (alpha, beta, s) = (ti.max(to), ti.min(to), sigma * sigma);
    let c1 = 1.0 - 0.5 * s / (s + 0.33);
    let back = if cos_phi >= 0.0 { 0.0 } else { (2.0 * beta / PI).powi(3) };
    let c2 = 0.45 * s / (s + 0.09) * (alpha.sin() - back);
    let c3 = 0.125 * s / (s + 0.09) * (4.0 * alpha * beta / (PI * PI)).powi(2);
    let first = c1 + cos_phi * c2 * beta.tan() + (1.0 - cos_phi.abs()) * c3 * ((alpha + beta) / 2.0).tan();
    let second = 0.17 * s / (s + 0.13) * (1.0 - cos_phi * (2.0 * beta / PI).powi(2));
    (rho / PI * first + rho * rho / PI * second).max(0.0)
}

/// Elek 2010, eq. 2: what these layers send of light, RGB, without the cosine outside; `alpha` is the greatest above them. The light
/// goes down channel by channel, is sent on by the base, and what the base sends goes up channel by channel.
fn sent(layers: &[LayerRecord], light: V, alpha: f64, wi: V, wo: V) -> V {
    let Some(layer) = layers.first() else { return [0.0; 3] };
    if layer.kind == LayerKind::Diffuse {
        let shares = |rows: [V; 3]| rows.map(|row| dot(row, light) / PI);
        let plain = || [0, 1, 2].map(|c| light[c] * oren_nayar(layer.albedo[c], layer.sigma, wi, wo));
        return layer.reradiation.map_or_else(plain, shares);
    }
    let alpha = alpha.max(layer.alpha);
    let sum = [wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]];
    let wh = sum.map(|v| v / dot(sum, sum).sqrt());
    let cos_d = dot(wo, wh);
    let f: V = [0, 1, 2].map(|c| fresnel(layer, c, cos_d));
    let g = (2.0 * wh[2] * wi[2] / cos_d).min(2.0 * wh[2] * wo[2] / cos_d).min(1.0);
    let d = slopes(layer, alpha, wh[2], wh[0] * wh[0] + wh[1] * wh[1]);
    let own = [0, 1, 2].map(|c| light[c] * f[c] * d * g / (4.0 * wi[2] * wo[2]));
    let bend = |w: V| {
        let cos_sq = 1.0 - (1.0 - w[2] * w[2]) / (layer.eta * layer.eta);
        (cos_sq > 0.0).then(|| [w[0] / layer.eta, w[1] / layer.eta, cos_sq.sqrt()])
    };
    match (layer.kind, bend(wi), bend(wo)) {
        (LayerKind::Dielectric, Some(wi), Some(wo)) => {
            let absorbed = |c: usize, w: V| (-layer.optical_depth[c] / w[2]).exp();
            let down = [0, 1, 2].map(|c| light[c] * (1.0 - f[c]) * absorbed(c, wi));
            let below = sent(&layers[1..], down, alpha, wi, wo);
            [0, 1, 2].map(|c| own[c] + below[c] * absorbed(c, wo) * ((1.0 - g) + (1.0 - f[c]) * g))
        }
        _ => own,
    }
}

/// f cos_theta_i of a stack, RGB.
pub(crate) fn eval(layers: &[LayerRecord], wi: V, wo: V) -> V {
    eval_lit(layers, [1.0; 3], wi, wo)
}

/// [`eval`] for light of a colour.
pub(crate) fn eval_lit(layers: &[LayerRecord], light: V, wi: V, wo: V) -> V {
    sent(layers, light, 0.0, wi, wo).map(|value| wi[2] * value)
}
