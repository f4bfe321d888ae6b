//! Reflectance of a plane interface, bare or coated with coherent thin films.

use std::f64::consts::PI;

use num_complex::Complex64;

/// Reflected power per polarisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polarised {
    /// Electric field normal to the plane of incidence.
    pub refl_s: f64,
    /// Electric field in the plane of incidence.
    pub refl_p: f64,
}

impl Polarised {
    /// Mean of both: unpolarised light.
    pub fn unpolarised(self) -> f64 {
        0.5 * (self.refl_s + self.refl_p)
    }
}

/// A film as the formulas see it: complex index and thickness over vacuum wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FilmLayer {
    /// Complex index of the film.
    pub ior: Complex64,
    /// Thickness divided by the vacuum wavelength.
    pub waves: f64,
}

/// Least wave number along the normal inside a film, over the vacuum's: see [`airy`].
const FILM_Q_MIN: f64 = 1e-8;

/// Reflectance of a bare interface, exact for any complex index below, total reflection included.
///
/// `above` and `below` are indices `n + i k`; `cos_theta_i` in 0..=1. Born and Wolf, Principles of Optics, 7th ed.,
/// sec. 1.5 and 14.2.
pub fn interface(above: Complex64, below: Complex64, cos_theta_i: f64) -> Polarised {
    coated(above, &[], below, cos_theta_i)
}

/// Reflectance of an interface with any number of coherent films, listed from the top.
///
/// Exact for absorbing films and bases and under (frustrated) total reflection; continuous as a thickness goes to zero.
pub fn coated(above: Complex64, films: &[FilmLayer], below: Complex64, cos_theta_i: f64) -> Polarised {
    let [r_s, r_p] = airy(
        above,
        films,
        below,
        cos_theta_i,
        sqrt,
        |r, _, _| r,
        |boundary, inner, q, waves| {
            // The wave crosses the film down and up.
            let round_trip = exp_i(q * (4.0 * PI * waves));
            let [echo_s, echo_p] = [inner[0] * round_trip, inner[1] * round_trip];
            [
                ratio(boundary[0] + echo_s, Complex64::ONE + boundary[0] * echo_s),
                ratio(boundary[1] + echo_p, Complex64::ONE + boundary[1] * echo_p),
            ]
        },
    );
    Polarised { refl_s: r_s.norm_sqr().min(1.0), refl_p: r_p.norm_sqr().min(1.0) }
}

/// Transmittance, for unpolarised light, of an interface with films between media that do not absorb: the transmitted amplitude
/// squared, times the ratio of the wave numbers along the normal (Born and Wolf sec. 1.6). From below it is the same at the refracted
/// angle; 0 under total reflection.
pub fn transmitted(above: f64, films: &[FilmLayer], below: f64, cos_theta_i: f64) -> f64 {
    let q_above = above * cos_theta_i;
    let q_below_sq = (below - above) * (below + above) + q_above * q_above;
    if q_above <= 0.0 || q_below_sq <= 0.0 {
        return 0.0;
    }
    let [above, below] = [above, below].map(|ior| Complex64::new(ior, 0.0));
    let [s, p] =
        airy(above, films, below, cos_theta_i, sqrt_by_halves, with_transmitted, |boundary, inner, q, waves| {
            let once = exp_i(q * (2.0 * PI * waves));
            [0, 1].map(|p: usize| {
                let ((r, t), echo) = (boundary[p], inner[p].0 * once * once);
                let sum = Complex64::ONE + r * echo;
                ((r + echo) / sum, t * once * inner[p].1 / sum)
            })
        });
    0.5 * (s.1.norm_sqr() + p.1.norm_sqr()) * libm::sqrt(q_below_sq) / q_above
}

/// The root that [`sqrt`] takes, for z with Im >= 0, by another formula. Manifests of scenes state errors to the last digit, in which the
/// two differ.
fn sqrt_by_halves(z: Complex64) -> Complex64 {
    let modulus = libm::hypot(z.re, z.im);
    let [re, im] = [z.re, -z.re].map(|x| libm::sqrt((0.5 * (modulus + x)).max(0.0)));
    Complex64::new(re, im)
}

/// Amplitudes (s, p) that a boundary reflects, each with the amplitude that it transmits.
fn with_transmitted([r_s, r_p]: [Complex64; 2], (na, qa): Medium, (nb, qb): Medium) -> [(Complex64, Complex64); 2] {
    [(r_s, 2.0 * qa / (qa + qb)), (r_p, 2.0 * na * nb * qa / (nb * nb * qa + na * na * qb))]
}

/// Amplitudes (s, p) that a bare interface reflects.
pub(crate) fn amplitudes(above: Complex64, below: Complex64, cos_theta_i: f64) -> [Complex64; 2] {
    airy(above, &[], below, cos_theta_i, sqrt, |r, _, _| r, |boundary, _, _, _| boundary)
}

/// Index, and wave number along the normal over the vacuum's, `q = n cos theta`.
type Medium = (Complex64, Complex64);

/// Amplitudes (s, p) that the boundary between two media reflects. Inlined, because a call makes the whole a tenth slower.
#[inline(always)]
fn reflected((na, qa): Medium, (nb, qb): Medium) -> [Complex64; 2] {
    [ratio(qa - qb, qa + qb), ratio(nb * nb * qa - na * na * qb, nb * nb * qa + na * na * qb)]
}

/// Squared wave number along the normal in a medium of index `ior`, `q^2 = n^2 - (n_above sin theta_above)^2`: written so that nothing cancels
/// between nearly equal indices.
#[inline(always)]
fn q_squared((above, q_above): Medium, ior: Complex64) -> Complex64 {
    (ior - above) * (ior + above) + q_above * q_above
}

/// Airy's formula from the bottom up: r = (r_ab + r_below e^{i delta}) / (1 + r_ab r_below e^{i delta}) with
/// delta = 4 pi n cos d / lambda (Born and Wolf sec. 7.6; Parratt 1954).
///
/// - `root` takes the square root whose real and imaginary parts are not negative.
/// - `boundary` turns the reflected amplitudes of a boundary, with the media above and below it, into the amplitudes to combine.
/// - `join` combines the amplitudes of a film's upper boundary with the amplitudes of everything below, by the film's q and its thickness in
///   waves.
fn airy<A>(
    above: Complex64,
    films: &[FilmLayer],
    below: Complex64,
    cos_theta_i: f64,
    root: impl Fn(Complex64) -> Complex64,
    boundary: impl Fn([Complex64; 2], Medium, Medium) -> A,
    join: impl Fn(A, A, Complex64, f64) -> A,
) -> A {
    // A film of the index of a clear medium above it has no upper boundary: it delays the wave. At grazing incidence its q is 0 too.
    let matched = films.iter().take_while(|film| above.im == 0.0 && film.ior == above).count();
    let films = &films[matched..];

    let top = (above, above * cos_theta_i);
    // The medium above the i-th film. Airy's formula is 0/0 for a film exactly at its critical angle. The reflectance is even in q, so a q
    // kept off zero errs by its square only, and by rounding over q.
    let medium = |i: usize| {
        let Some(FilmLayer { ior, .. }) = i.checked_sub(1).map(|film| films[film]) else { return top };
        let q = root(q_squared(top, ior));
        (ior, if q.norm_sqr() < FILM_Q_MIN * FILM_Q_MIN { Complex64::new(FILM_Q_MIN, 0.0) } else { q })
    };

    let base = (below, root(q_squared(top, below)));
    let mut lower = medium(films.len());
    let mut inner = boundary(reflected(lower, base), lower, base);
    for (i, film) in films.iter().enumerate().rev() {
        let upper = medium(i);
        inner = join(boundary(reflected(upper, lower), upper, lower), inner, lower.1, film.waves);
        lower = upper;
    }
    inner
}

/// a / b, and 0 for 0/0: an index-matched interface at grazing incidence reflects nothing. Inlined, as is the root: these take most of the time.
#[inline(always)]
fn ratio(a: Complex64, b: Complex64) -> Complex64 {
    if b == Complex64::ZERO {
        return Complex64::ZERO;
    }
    // Division needs the squared modulus, which underflows for moduli below 1e-154 and overflows above 1e154.
    if b.norm_sqr().is_normal() {
        return a / b;
    }
    let scale = b.re.abs().max(b.im.abs());
    (a / scale) / (b / scale)
}

/// Principal square root, real part not negative; for the arguments here, Im >= 0, the imaginary part is not negative
/// either, which is the decaying branch.
#[inline(always)]
fn sqrt(z: Complex64) -> Complex64 {
    let modulus = libm::hypot(z.re, z.im);
    if modulus == 0.0 {
        return Complex64::ZERO;
    }
    if z.re >= 0.0 {
        let t = libm::sqrt(0.5 * (modulus + z.re));
        Complex64::new(t, z.im / (2.0 * t))
    } else {
        let t = libm::sqrt(0.5 * (modulus - z.re));
        Complex64::new(z.im.abs() / (2.0 * t), libm::copysign(t, z.im))
    }
}

/// e^{i z}.
fn exp_i(z: Complex64) -> Complex64 {
    let amplitude = libm::exp(-z.im);
    let (sin, cos) = libm::sincos(z.re);
    Complex64::new(amplitude * cos, amplitude * sin)
}

/// Cosine-weighted mean reflectance of a dielectric seen from outside, in closed form, for `eta` > 1 (Walsh 1926; printed
/// in d'Eon and Irving 2011, Duntley 1942).
pub fn dielectric_average(eta: f64) -> f64 {
    let n = eta;
    let n2 = n * n;
    let (sum, quartic) = (n2 + 1.0, n2 * n2 - 1.0);
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * (n2 - 1.0) * (n2 - 1.0) / (sum * sum * sum) * libm::log((n - 1.0) / (n + 1.0))
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / (sum * quartic)
        + 8.0 * n2 * n2 * (n2 * n2 + 1.0) / (sum * quartic * quartic) * libm::log(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn c(re: f64, im: f64) -> Complex64 {
        Complex64::new(re, im)
    }

    fn film(n1: f64, n2: f64, n3: Complex64, d_nm: f64, wavelength_nm: f64, deg: f64) -> Polarised {
        let films = [FilmLayer { ior: c(n2, 0.0), waves: d_nm / wavelength_nm }];
        coated(c(n1, 0.0), &films, n3, libm::cos(deg.to_radians()))
    }

    /// Closed form: without a real part all light comes back, at any angle.
    #[test]
    fn a_metal_of_no_real_index_is_a_mirror() {
        for k in [0.5, 2.0, 6.6] {
            for cos in [0.0, 1e-3, 0.3, 0.7, 1.0] {
                let found = interface(Complex64::ONE, Complex64::new(0.0, k), cos);
                assert!(
                    (found.refl_s - 1.0).abs() < 1e-12 && (found.refl_p - 1.0).abs() < 1e-12,
                    "{k} {cos}: {found:?}"
                );
            }
        }
    }

    #[test]
    fn airy_oracles() {
        // Oracle: Airy sums evaluated independently in two formulations that agree to ten digits.
        let cases = [
            (film(1.0, 1.33, c(1.0, 0.0), 300.0, 550.0, 0.0).unpolarised(), 0.07543020),
            (film(1.0, 1.33, c(1.0, 0.0), 300.0, 550.0, 60.0).refl_s, 0.05362888),
            (film(1.0, 1.33, c(1.0, 0.0), 300.0, 550.0, 60.0).refl_p, 0.00171259),
            (film(1.0, 1.38, c(1.5, 0.0), 550.0 / 4.0 / 1.38, 550.0, 0.0).unpolarised(), 0.01411046),
            (film(1.0, 1.5, c(1.33, 0.0), 400.0, 600.0, 45.0).unpolarised(), 0.05199553),
            (film(1.0, 1.5, c(0.213, 4.05), 200.0, 690.0, 0.0).unpolarised(), 0.95536574),
            (film(1.0, 1.5, c(0.213, 4.05), 200.0, 690.0, 70.0).unpolarised(), 0.94118456),
            (film(1.0, 2.5, c(1.5, 0.0), 100.0, 450.0, 80.0).unpolarised(), 0.38974125),
            // Frustrated total reflection through an air gap.
            (film(1.5, 1.0, c(1.5, 0.0), 100.0, 550.0, 60.0).unpolarised(), 0.63127563),
        ];
        for (i, (got, expected)) in cases.into_iter().enumerate() {
            assert!((got - expected).abs() < 1e-8, "case {i}: {got} against {expected}");
        }
    }

    #[test]
    fn coated_mirror_fresnel_at_45_degrees() {
        let f = interface(c(1.0, 0.0), c(1.5, 0.0), libm::cos(45f64.to_radians())).unpolarised();
        assert!((f - 0.0502399110).abs() < 1e-10);
    }

    #[test]
    fn brewster_angle_reflects_no_p() {
        let p = interface(c(1.0, 0.0), c(1.5, 0.0), libm::cos(libm::atan(1.5))).refl_p;
        assert!(p < 1e-30);
    }

    #[test]
    fn total_reflection_from_inside() {
        let inside = |deg: f64| interface(c(1.5, 0.0), c(1.0, 0.0), libm::cos(deg.to_radians())).unpolarised();
        assert!((inside(42.0) - 1.0).abs() < 1e-14);
        assert!(inside(41.0) < 0.5);
    }

    #[test]
    fn averages_match_published_digits_and_quadrature() {
        for (n, expected) in [(1.33, 0.0659308493), (1.5, 0.0917779593), (2.0, 0.1605966371)] {
            assert!((dielectric_average(n) - expected).abs() < 1e-10, "n = {n}");
            // Simpson in u = cos^2, the other way to the same number.
            let m = 20_000;
            let f = |i: u32| {
                let mu = libm::sqrt(f64::from(i) / f64::from(m));
                interface(c(1.0, 0.0), c(n, 0.0), mu).unpolarised()
            };
            let sum: f64 = (1..m).map(|i| if i % 2 == 0 { 2.0 } else { 4.0 } * f(i)).sum::<f64>() + f(0) + f(m);
            assert!((sum / (3.0 * f64::from(m)) - expected).abs() < 1e-5);
        }
    }

    #[test]
    fn index_matched_reflects_nothing_even_at_grazing() {
        for mu in [0.0, 1e-7, 0.5, 1.0] {
            assert_eq!(interface(c(1.3, 0.0), c(1.3, 0.0), mu).unpolarised(), 0.0);
            let film = [FilmLayer { ior: c(1.3, 0.0), waves: 0.7 }];
            assert_eq!(coated(c(1.3, 0.0), &film, c(1.3, 0.0), mu).unpolarised(), 0.0);
        }
    }

    /// A film of the index above it delays the wave, and another below it acts as it does alone.
    #[test]
    fn a_matched_film_changes_nothing() {
        let [matched, film] = [c(1.3, 0.0), c(1.7, 0.01)].map(|ior| FilmLayer { ior, waves: 0.4 });
        for mu in [0.0, 1e-7, 0.1, 0.5, 1.0] {
            let alone = coated(c(1.3, 0.0), &[film], c(2.4, 1.1), mu);
            assert_eq!(coated(c(1.3, 0.0), &[matched, film], c(2.4, 1.1), mu), alone);
        }
    }

    /// Squares overflow and vanish there: an ideal metal reflects everything, and so does a medium that is next to nothing.
    #[test]
    fn huge_and_tiny_indices_reflect_everything() {
        for below in [c(1.5, 1e10), c(1.5, 1e100), c(1.5, 1e150), c(1e100, 0.0), c(1e-160, 1e-160)] {
            for mu in [1e-3, 0.5, 1.0] {
                let Polarised { refl_s, refl_p } = interface(c(1.0, 0.0), below, mu);
                assert!((refl_s - 1.0).abs() < 1e-8 && (refl_p - 1.0).abs() < 1e-8, "{below} {mu}: {refl_s} {refl_p}");
            }
        }
    }

    #[test]
    fn a_vanishing_film_is_the_bare_interface() {
        for mu in [0.05, 0.4, 0.9] {
            let bare = interface(c(1.0, 0.0), c(1.5, 2.0), mu).unpolarised();
            let coat = coated(c(1.0, 0.0), &[FilmLayer { ior: c(2.2, 0.1), waves: 1e-9 }], c(1.5, 2.0), mu);
            assert!((bare - coat.unpolarised()).abs() < 1e-7);
        }
    }
}
