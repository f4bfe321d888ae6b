//! Reflectance of thin films by characteristic matrices.
//!
//! Independent of [`coated`](luthier_optics::fresnel::coated), which has Airy's recursion.

use std::f64::consts::PI;

use luthier_optics::fresnel::{FilmLayer, Polarised};
use num_complex::Complex64;

/// Least wave number along the normal inside a film, over the vacuum's. At the film's critical angle it would be 0, and the matrix 0/0.
const FILM_Q_MIN: f64 = 1e-8;

/// Reflectance of an interface with any number of coherent films, listed from the top (Abeles 1950; Born and Wolf, section 1.6):
/// tangential fields at the two sides of a film are joined by a matrix of cos delta and i sin delta over its admittance,
/// `delta = 2 pi q d / lambda`.
///
/// Admittances are q for s and q/n^2 for p (fields exchanged), q the wave number along the normal over the vacuum's. Each matrix is
/// scaled by the decay in its film, so that thick absorbing films do not overflow. Within 1e-12 of the recursion.
pub fn transfer_matrix(above: f64, films: &[FilmLayer], below: Complex64, cos_theta_i: f64) -> Polarised {
    let q_above = above * cos_theta_i;
    let mut fields = admittances(below, wave_number(below, above, q_above)).map(|y| (Complex64::ONE, y));
    for film in films.iter().rev() {
        let q = wave_number(film.ior, above, q_above);
        let q = if q.norm_sqr() < FILM_Q_MIN * FILM_Q_MIN { Complex64::from(FILM_Q_MIN) } else { q };
        let delta = q * (2.0 * PI * film.waves);
        // e^{i delta} and e^{-i delta}, both times the decay.
        let (sin, cos) = libm::sincos(delta.re);
        let decayed = libm::exp(-2.0 * delta.im);
        let (forth, back) = (Complex64::new(cos, sin) * decayed, Complex64::new(cos, -sin));
        let (cosine, minus_i_sine) = (0.5 * (forth + back), 0.5 * (back - forth));
        for ((first, second), y) in fields.iter_mut().zip(admittances(film.ior, q)) {
            let joined = cosine * *first + minus_i_sine / y * *second;
            (*first, *second) = (joined, minus_i_sine * y * *first + cosine * *second);
        }
    }
    let tops = admittances(Complex64::from(above), Complex64::from(q_above));
    let [refl_s, refl_p] = [0, 1].map(|i: usize| {
        let (top, (first, second)) = (tops[i], fields[i]);
        let (down, up) = (top * first + second, top * first - second);
        // An index-matched interface at grazing incidence reflects nothing.
        if down == Complex64::ZERO { 0.0 } else { (up / down).norm_sqr().min(1.0) }
    });
    Polarised { refl_s, refl_p }
}

/// Admittances for s and p of a medium of index n.
fn admittances(n: Complex64, q: Complex64) -> [Complex64; 2] {
    [q, q / (n * n)]
}

/// Wave number along the normal in a medium of index n, over the vacuum's; `q_above` is the exterior's.
///
/// `q^2 = n^2 - (n_above sin)^2`, so written that nothing cancels between nearly equal indices.
fn wave_number(n: Complex64, above: f64, q_above: f64) -> Complex64 {
    root((n - above) * (n + above) + q_above * q_above)
}

/// The root with real and imaginary parts not negative: the wave that decays downward.
fn root(z: Complex64) -> Complex64 {
    let modulus = libm::hypot(z.re, z.im);
    if modulus == 0.0 {
        return Complex64::ZERO;
    }
    let larger = libm::sqrt(0.5 * (modulus + z.re.abs()));
    let smaller = z.im.abs() / (2.0 * larger);
    if z.re >= 0.0 { Complex64::new(larger, smaller) } else { Complex64::new(smaller, larger) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_optics::fresnel::coated;
    use proptest::prelude::*;

    fn index() -> impl Strategy<Value = Complex64> {
        (1.0..4.0, prop_oneof![Just(0.0), 0.0..0.2, 0.0..5.0]).prop_map(|(n, k)| Complex64::new(n, k))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn it_is_airys_recursion(
            above in prop_oneof![Just(1.0), 1.0..2.0],
            films in prop::collection::vec((index(), 0.0..30.0), 0..=6),
            below in index(),
            cos in 0.02..=1.0,
        ) {
            // Phases of many waves lose digits: 30 waves are 200 radians each way, in either formulation.
            let films: Vec<_> = films.into_iter().map(|(ior, waves)| FilmLayer { ior, waves }).collect();
            let found = transfer_matrix(above, &films, below, cos);
            let expected = coated(Complex64::new(above, 0.0), &films, below, cos);
            prop_assert!((found.refl_s - expected.refl_s).abs() < 1e-11, "s: {found:?} {expected:?}");
            prop_assert!((found.refl_p - expected.refl_p).abs() < 1e-11, "p: {found:?} {expected:?}");
        }
    }

    #[test]
    fn it_has_no_holes() {
        let film = |n, waves| FilmLayer { ior: Complex64::new(n, 0.0), waves };
        assert_eq!(transfer_matrix(1.0, &[], Complex64::ONE, 0.0).unpolarised(), 0.0);
        // Exactly at the film's critical angle: (3/4)^2 = (5/4)^2 (1 - (4/5)^2).
        let below = Complex64::new(1.5, 0.0);
        let found = transfer_matrix(1.25, &[film(0.75, 0.3)], below, 0.8);
        let expected = coated(Complex64::new(1.25, 0.0), &[film(0.75, 0.3)], below, 0.8);
        assert!((found.refl_s - expected.refl_s).abs() < 1e-7 && (found.refl_p - expected.refl_p).abs() < 1e-7);
    }
}
