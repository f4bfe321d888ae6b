//! Films on interfaces with an F0: a smooth one on Lambert's surface in closed form, and white furnaces.

use luthier_layers::formulas::transfer_matrix::transfer_matrix;
use luthier_layers::model::Estimate;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::registry::model;
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::schlick::F82;
use luthier_optics::stack::Surface;
use num_complex::Complex64;

use crate::sphere::{albedo, at};
use crate::stacks::{dielectric, ggx, lambert};

/// A film over an F0, which bends light by `ior`, on a base.
fn filmed(surface: Surface, film: (f64, f64, f64), (ior, f0): (f64, f64), base: MonochromeBelow) -> Monochrome {
    let mut stack = Monochrome::bare(&[(surface, dielectric(ior, 0.0)), (Surface::smooth(), base)]);
    stack.layers[0].f0 = Some(F82 { f0, tint: 1.0 });
    stack.layers[0].films = vec![FilmLayer { ior: Complex64::new(film.0, film.1), waves: film.2 }];
    stack
}

fn mc(stack: &Monochrome, theta: f64) -> Estimate {
    LayeredMc { seed: 5, ..LayeredMc::new(InterfaceMode::SmithWalk) }.albedo(stack, at(theta), 100_000)
}

/// Powers by matrices, over the index of the F0 by hand. The film passes `t` of the base's light, whose mean is by Simpson's rule over the directions outside:
/// `t = 2 / n^2` times the integral of `(1 - F(mu)) mu`.
#[test]
fn a_smooth_film_on_lambert_is_its_closed_form() {
    for (film, ior, f0, rho) in
        [((1.5, 0.0, 0.7), 1.0, 0.04f64, 0.8), ((1.3, 0.0, 1.6), 1.0, 0.5, 0.9), ((2.2, 0.0, 0.3), 1.5, 0.04, 1.0)]
    {
        let root = f0.sqrt();
        let below = Complex64::new((1.0 + root) / (1.0 - root), 0.0);
        let layers = [FilmLayer { ior: Complex64::new(film.0, film.1), waves: film.2 }];
        let f = |mu: f64| transfer_matrix(1.0, &layers, below, mu).unpolarised();
        let steps = 2000;
        let sum: f64 = (0..=steps)
            .map(|i| {
                let mu = f64::from(i) / f64::from(steps);
                let weight = if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
                weight * (1.0 - f(mu)) * mu
            })
            .sum();
        let passed = 2.0 * sum / (3.0 * f64::from(steps)) / (ior * ior);
        let stack = filmed(Surface::smooth(), film, (ior, f0), lambert(rho));
        for theta in [0.0, 50.0] {
            let here = f(at(theta).z);
            let expected = here + (1.0 - here) * rho * passed / (1.0 - rho * (1.0 - passed));
            let found = mc(&stack, theta);
            assert!(
                (found.mean - expected).abs() < 4.0 * found.std_err + 1e-9,
                "{film:?} {theta}: {found:?} {expected}"
            );
            for name in ["weidlich-wilkie-corrected", "belcour", "yamaguchi"] {
                let found = albedo(model(name).unwrap().as_ref(), &stack, at(theta));
                assert!((found - expected).abs() < 2e-3, "{name} {film:?} {theta}: {found} {expected}");
            }
        }
    }
}

/// A clear film over any F0 on a white base returns all light, rough or not; one that absorbs returns less; a metal under it returns no more.
#[test]
fn films_on_an_f0_keep_the_light() {
    for surface in [Surface::smooth(), ggx(0.1), ggx(0.6)] {
        for (ior, f0) in [(1.0, 0.04), (1.0, 0.7), (1.4, 0.3)] {
            for theta in [0.0, 70.0] {
                let clear = mc(&filmed(surface, (1.8, 0.0, 0.9), (ior, f0), lambert(1.0)), theta);
                assert!((clear.mean - 1.0).abs() < 2e-3, "{ior} {f0} {theta}: {clear:?}");
                let absorbs = mc(&filmed(surface, (1.8, 0.2, 0.9), (ior, f0), lambert(1.0)), theta);
                assert!(absorbs.mean < 0.9 && absorbs.mean > 0.0, "{ior} {f0} {theta}: {absorbs:?}");
            }
        }
        let mut metal = Monochrome::bare(&[(surface, MonochromeBelow::Conductor { ior: Complex64::ONE })]);
        metal.layers[0].f0 = Some(F82 { f0: 1.0, tint: 1.0 });
        metal.layers[0].films = vec![FilmLayer { ior: Complex64::new(1.5, 0.0), waves: 0.8 }];
        let found = mc(&metal, 40.0);
        assert!(found.mean > 0.99 && found.mean <= 1.0 + 1e-9, "{found:?}");
        let white = mc(&metal.lossless(), 40.0);
        assert!((white.mean - 1.0).abs() < 1e-3, "{white:?}");
    }
}
