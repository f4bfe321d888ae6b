//! Integrals of the estimated values against moments of the traced paths.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_layers::references::layered_mc::LayeredMc;
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

use crate::scenes::{MODES, at, conductor, cosine, dielectric, evenly, ggx, mc, mean_of};

/// Functions of the direction that tell lobes apart.
fn moments(w: DVec3) -> [f64; 5] {
    [1.0, w.x, w.y, w.z, (w.x - 0.4 * w.y) * w.z]
}

fn compare(what: &str, stack: &Monochrome, wo: DVec3) {
    for mode in MODES {
        let count = 20_000;
        let mut values: [Vec<f64>; 5] = Default::default();
        let mut carried: [Vec<f64>; 5] = Default::default();
        for i in 0..count {
            let wi = cosine(evenly(i));
            let value = LayeredMc { seed: i, ..mc(mode, 1) }.estimate(stack, wi, wo).mean * PI / wi.z;
            values.iter_mut().zip(moments(wi)).for_each(|(all, m)| all.push(m * value));
        }
        for path in mc(mode, 4 * count).paths(stack, wo) {
            let (wi, weight) = path.unwrap_or((DVec3::Z, 0.0));
            carried.iter_mut().zip(moments(wi)).for_each(|(all, m)| all.push(m * weight));
        }
        for (k, (values, carried)) in values.iter().zip(&carried).enumerate() {
            let (a, b) = (mean_of(values), mean_of(carried));
            let sigma = a.std_err.hypot(b.std_err);
            assert!(sigma < 2e-2, "{what} {mode:?} moment {k}: {a:?}");
            assert!((a.mean - b.mean).abs() < 4.0 * sigma, "{what} {mode:?} moment {k}: {a:?} {b:?}");
        }
    }
}

#[test]
fn rough_coat_over_rough_conductor() {
    compare(
        "coat",
        &Monochrome::bare(&[(ggx(0.4), dielectric(1.5, 0.1)), (ggx(0.6), conductor(0.2, 3.5))]),
        at(50.0, 20.0),
    );
}

#[test]
fn smooth_coat_over_rough_conductor() {
    // Values leave out what the coat mirrors at once: so do the paths here, where it is one direction.
    let coated = Monochrome::bare(&[(Surface::smooth(), dielectric(1.5, 0.05)), (ggx(0.6), conductor(0.2, 3.5))]);
    let wo = at(30.0, 0.0);
    for mode in MODES {
        let mirrored = DVec3::new(-wo.x, -wo.y, wo.z);
        let count = 40_000;
        let paths: Vec<f64> = mc(mode, count)
            .paths(&coated, wo)
            .map(|path| path.filter(|(wi, _)| wi.distance(mirrored) > 1e-9).map_or(0.0, |(_, weight)| weight))
            .collect();
        let values: Vec<f64> = (0..count)
            .map(|i| {
                let wi = cosine(evenly(i));
                LayeredMc { seed: i, ..mc(mode, 1) }.estimate(&coated, wi, wo).mean * PI / wi.z
            })
            .collect();
        let (a, b) = (mean_of(&values), mean_of(&paths));
        assert!((a.mean - b.mean).abs() < 4.0 * a.std_err.hypot(b.std_err), "{mode:?} {a:?} {b:?}");
        assert!(a.std_err < 1e-2, "{a:?}");
    }
}

#[test]
fn rough_coat_over_smooth_conductor() {
    compare(
        "mirror",
        &Monochrome::bare(&[(ggx(0.5), dielectric(1.5, 0.2)), (Surface::smooth(), conductor(0.2, 3.5))]),
        at(40.0, 0.0),
    );
}

#[test]
fn three_anisotropic_layers_with_films_over_oren_nayar() {
    let tilted = |x, y, rotation| Surface { distribution: Distribution::Beckmann, alpha_x: x, alpha_y: y, rotation };
    let base = MonochromeBelow::Diffuse { albedo: 0.7, sigma: 0.4 };
    let mut layered = Monochrome::bare(&[
        (tilted(0.6, 0.3, 0.7), dielectric(1.4, 0.1)),
        (tilted(0.4, 0.7, 2.0), dielectric(1.8, 0.0)),
        (ggx(0.0), base),
    ]);
    // One film that absorbs, on the second interface: the two sides differ.
    layered.layers[0].films.push(FilmLayer { ior: Complex64::new(2.0, 0.0), waves: 0.4 });
    layered.layers[1].films.push(FilmLayer { ior: Complex64::new(1.6, 0.3), waves: 0.1 });
    compare("three", &layered, at(55.0, 100.0));
}

#[test]
fn denser_exterior_with_total_reflection_at_the_top() {
    let mut wet = Monochrome::bare(&[(ggx(0.5), dielectric(1.1, 0.0)), (ggx(0.4), conductor(0.2, 3.5))]);
    wet.exterior = 1.5;
    wet.layers[0].above = 1.5;
    compare("wet", &wet, at(50.0, 20.0));
}
