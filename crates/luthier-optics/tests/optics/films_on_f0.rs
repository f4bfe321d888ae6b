//! Films on interfaces with an F0, against characteristic matrices over an index that is found by halving.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Film, FilmThickness};

use crate::transfer_matrix::{Plane, c, powers};

const COPPER: Rgb = [0.955, 0.638, 0.538];

fn film_on(above: f64, ior: f64, thickness_nm: f64, f0: Rgb) -> Interface {
    let thickness = FilmThickness { min_nm: thickness_nm, max_nm: thickness_nm };
    let film = Film { ior: Ior::constant(ior, 0.0).unwrap(), thickness };
    Interface {
        above: Ior::constant(above, 0.0).unwrap(),
        films: vec![film],
        below: Ior::constant(1.7, 0.0).unwrap().with_f0(f0),
    }
}

/// The real index, above `above`, whose interface reflects `f0` at the normal.
fn index(above: f64, f0: f64) -> f64 {
    let (mut low, mut high) = (above, 1e9);
    for _ in 0..200 {
        let middle = (low * high).sqrt();
        let r = (middle - above) / (middle + above);
        *if r * r < f0 { &mut low } else { &mut high } = middle;
    }
    (low * high).sqrt()
}

fn reflected(above: f64, film: FilmLayer, f0: f64, cos: f64) -> f64 {
    let below = c(index(above, f0), 0.0);
    0.5 * [Plane::S, Plane::P].map(|plane| powers(above, &[film], below, cos, plane)[0]).iter().sum::<f64>()
}

/// At three wavelengths and in the spectrum, where the oracle goes in steps of 1 nm between the nodes of the colour.
#[test]
fn a_film_interferes_by_the_index_of_the_f0() {
    let nodes = Color::Spectral.nodes();
    let wavelengths = [645.0, 525.0, 445.0];
    for (above, n, nm) in [(1.0, 1.5, 400.0), (1.0, 1.2, 870.0), (1.5, 1.8, 500.0), (1.0, 1.0, 1000.0)] {
        for f0 in [COPPER, [0.04; 3], [0.1; 3]] {
            let interface = film_on(above, n, nm, f0);
            for cos in [1.0, 0.7, 0.3, 0.05] {
                let at = |c: usize, wavelength_nm: f64| {
                    reflected(
                        above,
                        FilmLayer { ior: crate::transfer_matrix::c(n, 0.0), waves: nm / wavelength_nm },
                        f0[c],
                        cos,
                    )
                };
                let three = interface.sampled(&Color::ThreeWavelengths(wavelengths)).rgb(cos);
                let spectral = interface.sampled(&Color::Spectral).rgb(cos);
                for c in 0..3 {
                    assert!((three[c] - at(c, wavelengths[c])).abs() < 1e-9, "{above} {n} {nm} {f0:?} {cos} {c}");
                    let mut sum = 0.0;
                    for pair in nodes.windows(2) {
                        for step in 0..5 {
                            let t = (f64::from(step) + 0.5) / 5.0;
                            let between = |a: f64, b: f64| a + (b - a) * t;
                            let weight = between(pair[0].weight[c], pair[1].weight[c]);
                            sum += 0.2 * weight * at(c, between(pair[0].wavelength_nm, pair[1].wavelength_nm));
                        }
                    }
                    assert!(
                        (spectral[c] - sum).abs() < 1e-3,
                        "{above} {n} {nm} {f0:?} {cos} {c}: {} {sum}",
                        spectral[c]
                    );
                }
            }
        }
    }
}

/// Without thickness the normal shows F0, whatever lies above: all but 4e-4 of a perfect mirror.
#[test]
fn no_film_leaves_the_f0() {
    for above in [1.0, 1.5] {
        for f0 in [[0.0; 3], [0.04; 3], COPPER, [1.0; 3]] {
            for color in [Color::Spectral, Color::ThreeWavelengths([645.0, 525.0, 445.0])] {
                let found = film_on(above, 1.3, 1e-6, f0).sampled(&color).rgb(1.0);
                for c in 0..3 {
                    assert!((found[c] - f0[c].min(0.9996)).abs() < 1e-5, "{above} {f0:?}: {found:?}");
                }
            }
        }
    }
}

/// No film reflects more than all light over any F0.
#[test]
fn no_film_gains_light() {
    for f0 in [0.0, 0.2, 0.9, 1.0, 1.3] {
        for nm in [1.0, 100.0, 555.0, 5000.0] {
            let interface = film_on(1.0, 2.2, nm, [f0; 3]);
            for cos in [0.0, 0.2, 1.0] {
                let found = interface.at(500.0, 0).reflectance(cos);
                assert!((0.0..=1.0).contains(&found), "{f0} {nm} {cos}: {found}");
            }
        }
    }
}
