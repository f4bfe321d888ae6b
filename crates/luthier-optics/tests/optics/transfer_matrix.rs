//! Characteristic matrices of films, an oracle independent of Airy's recursion.

use std::f64::consts::PI;

use luthier_optics::fresnel::{FilmLayer, Polarised, coated, transmitted};
use num_complex::Complex64;
use proptest::prelude::*;

pub(crate) fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

/// Polarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Plane {
    S,
    P,
}

/// Reflected and transmitted power of a stack (Abeles 1950; Born and Wolf, section 1.6): fields at the two sides of a film
/// are joined by a matrix of cos delta and i sin delta over its admittance. T is Re(admittance below) |t|^2 / admittance
/// above.
pub(crate) fn powers(above: f64, films: &[FilmLayer], below: Complex64, cos_theta_i: f64, plane: Plane) -> [f64; 2] {
    let sine = c(above * (1.0 - cos_theta_i * cos_theta_i).sqrt(), 0.0);
    // Normal component of the wave vector, decaying downward, and the admittance that belongs to it.
    let normal = |n: Complex64| {
        let q = (n * n - sine * sine).sqrt();
        if q.im < 0.0 { -q } else { q }
    };
    let admittance = |n: Complex64, q: Complex64| if plane == Plane::S { q } else { n * n / q };
    let top = admittance(c(above, 0.0), c(above * cos_theta_i, 0.0));
    let bottom = admittance(below, normal(below));
    let (mut electric, mut magnetic) = (c(1.0, 0.0), bottom);
    for film in films.iter().rev() {
        let q = normal(film.ior);
        let delta = q * (2.0 * PI * film.waves);
        let (cos, i_sin, y) = (delta.cos(), c(0.0, -1.0) * delta.sin(), admittance(film.ior, q));
        (electric, magnetic) = (cos * electric + i_sin / y * magnetic, i_sin * y * electric + cos * magnetic);
    }
    let sum = top * electric + magnetic;
    let r = (top * electric - magnetic) / sum;
    let t = 2.0 * top / sum;
    [r.norm_sqr(), bottom.re / top.re * t.norm_sqr()]
}

/// The crate's reflectance in one polarisation.
pub(crate) fn reflectance(p: Polarised, plane: Plane) -> f64 {
    if plane == Plane::S { p.refl_s } else { p.refl_p }
}

/// Index of a film or base: a third of them transparent.
fn index() -> impl Strategy<Value = Complex64> {
    (1.0..4.0, prop_oneof![Just(0.0), 0.0..0.2, 0.0..5.0]).prop_map(|(n, k)| c(n, k))
}

prop_compose! {
    fn film()(ior in index(), waves in 0.0..1.5) -> FilmLayer {
        FilmLayer { ior, waves }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn airy_recursion_agrees_with_matrices(
        above in prop_oneof![Just(1.0), 1.0..2.0],
        films in prop::collection::vec(film(), 1..=3),
        below in index(),
        cos in 0.02..=1.0,
    ) {
        let found = coated(c(above, 0.0), &films, below, cos);
        for plane in [Plane::S, Plane::P] {
            let expected = powers(above, &films, below, cos, plane)[0];
            let error = (reflectance(found, plane) - expected).abs();
            prop_assert!(error < 1e-12, "{:?}: {} against {}", plane, reflectance(found, plane), expected);
        }
    }

    /// Through absorbing films too. The root of an index that hardly absorbs loses digits by cancellation: 4e-11 for k = 1.4e-5.
    #[test]
    fn transmittance_agrees_with_matrices(
        above in prop_oneof![Just(1.0), 1.0..2.0],
        films in prop::collection::vec(film(), 0..=3),
        below in 1.0..4.0,
        cos in 0.02..=1.0,
    ) {
        let found = transmitted(above, &films, below, cos);
        let [s, p] = [Plane::S, Plane::P].map(|plane| powers(above, &films, c(below, 0.0), cos, plane)[1]);
        let total = above * (1.0 - cos * cos).sqrt() >= below;
        prop_assert!((found - if total { 0.0 } else { 0.5 * (s + p) }).abs() < 1e-10, "{found} against {s} and {p}");
    }
}

/// The wave of a film at its critical angle does not advance along the normal, and both roads divide zero by zero. In the limit the
/// matrices are [1, -i 2 pi d/lambda; 0, 1] for s and [1, 0; -i n^2 2 pi d/lambda, 1] for p.
#[test]
fn a_film_at_its_critical_angle() {
    // (3/4)^2 = (5/4)^2 (1 - (4/5)^2), in floating point too.
    let (above, film, below, cos, waves) = (1.25, 0.75, c(1.5, 0.0), 0.8, 0.3);
    let found = coated(c(above, 0.0), &[FilmLayer { ior: c(film, 0.0), waves }], below, cos);
    let phase = c(0.0, -2.0 * PI * waves);
    let q = (2.25f64 - 0.5625).sqrt();
    let expected = |top: f64, bottom: f64, electric: Complex64, magnetic: Complex64| {
        let (e, h) = (c(1.0, 0.0) + electric * bottom, c(bottom, 0.0) + magnetic);
        ((top * e - h) / (top * e + h)).norm_sqr()
    };
    let s = expected(above * cos, q, phase, c(0.0, 0.0));
    let p = expected(above / cos, 2.25 / q, c(0.0, 0.0), phase * film * film);
    assert!((found.refl_s - s).abs() < 1e-7, "{} against {s}", found.refl_s);
    assert!((found.refl_p - p).abs() < 1e-7, "{} against {p}", found.refl_p);
}
