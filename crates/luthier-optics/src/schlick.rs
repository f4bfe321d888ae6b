//! Rational approximations of the Fresnel reflectance for real-time rendering: Schlick, Lazanyi, F82.
//!
//! None of them is exact anywhere but at normal and at grazing incidence. Largest errors against
//! [`fresnel::interface`] over all angles, from the tests:
//!
//! | index below vacuum | complex-F0 Schlick | Lazanyi, fitted | F82-tint |
//! |---|---|---|---|
//! | 0.213+4.05i, copper's red | 0.0240 | 0.0011 | 0.0053 |
//! | 1.04+2.583i, its green | 0.0404 | 0.0012 | 0.0056 |
//! | 1.17+2.362i, its blue | 0.0330 | 0.0018 | 0.0017 |
//! | 1+6.69i, aluminium | 0.0947 | 0.0063 | 0.0079 |
//! | 3.18+4.41i, chromium | 0.2149 | 0.0186 | 0.0275 |
//! | 1.33 | 0.0599 | 0.0098 | 0.0199 |
//! | 1.5 | 0.0357 | 0.0197 | 0.0276 |
//! | 1.01, all but matched | 0.5497 at 86 deg | 0.0837 | 0.2504 |
//!
//! Chromium's 0.215 is 35% of the reflectance there: "5% at most", which is said of the form, holds for few metals.

use crate::Rgb;
use num_complex::Complex64;

use crate::fresnel;

/// Schlick 1994: F0 + (1 - F0)(1 - cos)^5. `f0` in 0..=1 (or beyond, for colours out of gamut), `cos_theta` in 0..=1.
pub fn schlick(f0: f64, cos_theta: f64) -> f64 {
    f0 + (1.0 - f0) * fifth(1.0 - cos_theta)
}

/// Real index over that above whose reflectance at normal incidence is `f0`, in 0..1: `(1 + sqrt f0) / (1 - sqrt f0)`.
pub fn index_of_f0(f0: f64) -> f64 {
    let root = libm::sqrt(f0);
    (1.0 + root) / (1.0 - root)
}

/// Largest index over that above that a film lies on by [`index_below_film`]: it reflects all but 4e-4.
const FILM_BASE_MAX: f64 = 1e4;

/// Real index of the medium below a film where the interface has an F0 in place of an index: that of [`index_of_f0`] over the index above the film, at most
/// 10,000. Without the film the interface reflects F0 at normal incidence, but not more than .9996.
///
/// ```
/// use luthier_optics::{fresnel::{FilmLayer, coated}, num_complex::Complex64, schlick::index_below_film};
///
/// let [above, film] = [1.0, 1.3].map(|n| Complex64::new(n, 0.0));
/// let below = Complex64::new(index_below_film(1.0, 0.5), 0.0);
/// let thin = FilmLayer { ior: film, waves: 1e-6 };
/// assert!((coated(above, &[thin], below, 1.0).unpolarised() - 0.5).abs() < 1e-5);
/// ```
pub fn index_below_film(above: f64, f0: f64) -> f64 {
    let root = libm::sqrt(f0.clamp(0.0, 1.0));
    above * (1.0 + root) / (1.0 - root).max(2.0 / FILM_BASE_MAX)
}

/// F0 of the interface of a `metallic-roughness` surface, and albedo of the diffuse base below it (glTF 2.0, appendix B):
///
/// - F0 is `f = 0.04 + metallic (base_color - 0.04)`;
/// - the albedo of the base is `c / (t + c (1 - t))`, so that it shows `c = base_color (1 - metallic)` of the light that enters;
///   `t = (1 - f)(20/21) / n^2` is the share of the base's light that the smooth interface passes (Saunderson 1942), which bends it by the index
///   n = 1.5 ([`DIELECTRIC_INDEX`]).
pub fn metallic_roughness(base_color: Rgb, metallic: f64) -> (Rgb, Rgb) {
    metallic_and_matt(base_color, base_color, metallic)
}

/// [`metallic_roughness`] with a base colour of its own for the metal, and another for the dielectric.
pub fn metallic_and_matt(metal: Rgb, matt: Rgb, metallic: f64) -> (Rgb, Rgb) {
    let (curves, albedo) = metallic_and_tinted(
        metal.map(|f0| F82 { f0, tint: 1.0 }),
        [DIELECTRIC_F0; 3],
        matt,
        metallic,
        DIELECTRIC_INDEX,
    );
    (curves.map(|curve| curve.f0), albedo)
}

/// [`metallic_and_matt`] with a metal that has an edge tint, and a dielectric of another F0: the interface is [`F82::in_dielectric`], and passes
/// `1 / n^2` of what it does not reflect on average, where it bends light by an index n.
pub fn metallic_and_tinted(metal: [F82; 3], dielectric: Rgb, matt: Rgb, metallic: f64, index: f64) -> ([F82; 3], Rgb) {
    let curves = [0, 1, 2].map(|c: usize| metal[c].in_dielectric(dielectric[c], metallic));
    let albedo = [0, 1, 2].map(|i: usize| {
        let seen = matt[i] * (1.0 - metallic);
        let passed = (1.0 - curves[i].average()) / (index * index);
        let sum = passed + seen * (1.0 - passed);
        if sum > 0.0 { seen / sum } else { 0.0 }
    });
    (curves, albedo)
}

/// F0 of the dielectric of a `metallic-roughness` surface whose file names no other.
pub const DIELECTRIC_F0: f64 = 0.04;

/// Index over that above by which the interface of a `metallic-roughness` surface bends light, whatever it reflects: that of [`DIELECTRIC_F0`].
pub const DIELECTRIC_INDEX: f64 = 1.5;

/// Schlick's cosine-weighted mean over the hemisphere: F0 + (1 - F0)/21.
pub fn schlick_average(f0: f64) -> f64 {
    f0 + (1.0 - f0) / 21.0
}

/// Reflectance at normal incidence from a transparent medium of index `above` onto `below`: |(n_b - n_a)/(n_b + n_a)|^2.
pub fn f0(above: f64, below: Complex64) -> f64 {
    ((below - above) / (below + above)).norm_sqr()
}

/// Schlick's form with the F0 of a complex index: the `FresnelTermNP` of Elek 2010, and the first term of Lazanyi and
/// Szirmay-Kalos 2005, ((n - 1)^2 + 4 n (1 - cos)^5 + k^2)/((n + 1)^2 + k^2).
pub fn complex_f0(above: f64, below: Complex64, cos_theta: f64) -> f64 {
    schlick(f0(above, below), cos_theta)
}

/// Lazanyi and Szirmay-Kalos 2005, "Fresnel Term Approximations for Metals": [`complex_f0`] less a correction
/// `a cos (1 - cos)^exponent`, both chosen per material and wavelength. [`Lazanyi::fit`] chooses them for any index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lazanyi {
    /// Reflectance at normal incidence.
    pub f0: f64,
    /// Weight of the correction; 0 is Schlick.
    pub a: f64,
    /// Exponent of the correction, the paper's alpha.
    pub exponent: f64,
}

/// Angles that a fit looks at.
const FIT_ANGLES: u32 = 256;

/// Exponents that a fit tries: 1 to 16 in steps of 1/8.
const FIT_EXPONENTS: std::ops::RangeInclusive<u32> = 8..=128;

impl Lazanyi {
    /// The reflectance, in 0..=1: where the correction overshoots it is clamped.
    pub fn eval(&self, cos_theta: f64) -> f64 {
        (schlick(self.f0, cos_theta) - self.a * correction(self.exponent, cos_theta)).clamp(0.0, self.f0.max(1.0))
    }

    /// The least-squares correction for an interface: for each exponent the weight in closed form, over equal steps of the
    /// cosine; the best exponent to an eighth.
    pub fn fit(above: f64, below: Complex64) -> Self {
        let index = Complex64::new(above, 0.0);
        let exact = Self::cosines().map(|cos| fresnel::interface(index, below, cos).unpolarised());
        Self::through(f0(above, below), &exact.collect::<Vec<_>>())
    }

    /// The cosines that a fit looks at.
    pub fn cosines() -> impl Iterator<Item = f64> {
        (0..FIT_ANGLES).map(|i| (f64::from(i) + 0.5) / f64::from(FIT_ANGLES))
    }

    /// [`Lazanyi::fit`] to any reflectance, from its values at normal incidence and at [`Lazanyi::cosines`].
    pub fn through(f0: f64, values: &[f64]) -> Self {
        let angles = Self::cosines().zip(values).map(|(cos, exact)| (cos, schlick(f0, cos) - exact));
        let angles: Vec<(f64, f64)> = angles.collect();
        let mut best = (f64::INFINITY, Self { f0, a: 0.0, exponent: 1.0 });
        for exponent in FIT_EXPONENTS.map(|e| f64::from(e) / 8.0) {
            let (mut cross, mut square) = (0.0, 0.0);
            for &(cos, excess) in &angles {
                let g = correction(exponent, cos);
                cross += g * excess;
                square += g * g;
            }
            let a = cross / square;
            let squares: f64 = angles
                .iter()
                .map(|&(cos, excess)| {
                    let left = excess - a * correction(exponent, cos);
                    left * left
                })
                .sum();
            if squares < best.0 {
                best = (squares, Self { f0, a, exponent });
            }
        }
        best.1
    }
}

/// Cosine at which F82 is given: the maximum of cos (1 - cos)^6, 81.8 degrees.
pub const F82_COS_THETA: f64 = 1.0 / 7.0;

/// The edge tint of Kutz, Hasan and Edmondson 2021, "Novel Aspects of the Adobe Standard Material" (OpenPBR, glTF and MaterialX
/// since): Lazanyi's correction with exponent 6, its weight from the reflectance wanted at [`F82_COS_THETA`] (Hoffman 2019,
/// "Fresnel Equations Considered Harmful").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct F82 {
    /// Reflectance at normal incidence.
    pub f0: f64,
    /// Reflectance at 81.8 degrees over Schlick's there, 0..=1: 1 is Schlick.
    pub tint: f64,
}

impl F82 {
    /// The curve through a reflectance wanted at 81.8 degrees.
    pub fn through(f0: f64, f82: f64) -> Self {
        let there = schlick(f0, F82_COS_THETA);
        Self { f0, tint: if there > 0.0 { f82 / there } else { 1.0 } }
    }

    /// The curve through an interface's exact reflectance at normal incidence and at 81.8 degrees. A tint above 1 is kept.
    pub fn of(above: f64, below: Complex64) -> Self {
        let f82 = fresnel::interface(Complex64::new(above, 0.0), below, F82_COS_THETA).unpolarised();
        Self::through(f0(above, below), f82)
    }

    /// The reflectance, not below 0.
    pub fn eval(&self, cos_theta: f64) -> f64 {
        if self.tint == 1.0 {
            return schlick(self.f0, cos_theta).max(0.0);
        }
        (schlick(self.f0, cos_theta) - self.dip() * edge_dip(cos_theta)).max(0.0)
    }

    /// Weight of the correction `cos (1 - cos)^6`: 0 is Schlick, and 17.7 the most.
    pub fn dip(&self) -> f64 {
        schlick(self.f0, F82_COS_THETA) * (1.0 - self.tint) / edge_dip(F82_COS_THETA)
    }

    /// Cosine-weighted mean over the hemisphere; the integral of the correction is `2 B(3, 7) = 1/126`.
    pub fn average(&self) -> f64 {
        schlick_average(self.f0) - self.dip() / 126.0
    }

    /// The curve of F0 whose correction has a weight.
    pub fn of_dip(f0: f64, dip: f64) -> Self {
        let there = schlick(f0, F82_COS_THETA);
        Self { f0, tint: if there > 0.0 { 1.0 - dip * edge_dip(F82_COS_THETA) / there } else { 1.0 } }
    }

    /// The mean of this curve, with the share `metallic`, and that of a dielectric of an F0 without a tint: a `metallic-roughness` interface. Both are linear
    /// in F0 and in the weight of the correction, so that the mean is such a curve, too, where none is held to 0.
    #[must_use]
    pub fn in_dielectric(&self, dielectric: f64, metallic: f64) -> Self {
        let f0 = dielectric + metallic * (self.f0 - dielectric);
        if self.tint == 1.0 { Self { f0, tint: 1.0 } } else { Self::of_dip(f0, metallic * self.dip()) }
    }
}

/// `cos (1 - cos)^6`, the shape of the correction by an edge tint.
pub fn edge_dip(cos_theta: f64) -> f64 {
    let away = 1.0 - cos_theta;
    cos_theta * away * fifth(away)
}

fn correction(exponent: f64, cos_theta: f64) -> f64 {
    cos_theta * libm::pow(1.0 - cos_theta, exponent)
}

fn fifth(x: f64) -> f64 {
    let square = x * x;
    square * square * x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn max_error(below: Complex64, f: impl Fn(f64) -> f64) -> (f64, f64) {
        (0..=20_000)
            .map(|i| {
                let deg = f64::from(i) * 90.0 / 20_000.0;
                let cos = libm::cos(deg.to_radians());
                let exact = fresnel::interface(Complex64::ONE, below, cos).unpolarised();
                ((f(cos) - exact).abs(), deg)
            })
            .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
    }

    /// Index, and the largest errors of complex-F0 Schlick, the fitted Lazanyi and F82. The first column was measured by another
    /// program too: .024-.041 for copper, .095, .215, .060 and .55.
    const ERRORS: [((f64, f64), [f64; 3]); 8] = [
        ((0.213, 4.05), [0.0240, 0.0011, 0.0053]),
        ((1.04, 2.583), [0.0404, 0.0012, 0.0056]),
        ((1.17, 2.362), [0.0330, 0.0018, 0.0017]),
        ((1.0, 6.69), [0.0947, 0.0063, 0.0079]),
        ((3.18, 4.41), [0.2149, 0.0186, 0.0275]),
        ((1.33, 0.0), [0.0599, 0.0098, 0.0199]),
        ((1.5, 0.0), [0.0357, 0.0197, 0.0276]),
        ((1.01, 0.0), [0.5497, 0.0837, 0.2504]),
    ];

    #[test]
    fn largest_errors_are_the_documented_ones() {
        for ((n, k), expected) in ERRORS {
            let below = Complex64::new(n, k);
            let (lazanyi, f82) = (Lazanyi::fit(1.0, below), F82::of(1.0, below));
            let found = [
                max_error(below, |cos| complex_f0(1.0, below, cos)).0,
                max_error(below, |cos| lazanyi.eval(cos)).0,
                max_error(below, |cos| f82.eval(cos)).0,
            ];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-4, "{below}: {found} against {expected}");
            }
        }
    }

    #[test]
    fn an_index_match_is_worst_at_86_degrees() {
        let below = Complex64::new(1.01, 0.0);
        let (error, deg) = max_error(below, |cos| complex_f0(1.0, below, cos));
        assert!((error - 0.55).abs() < 2e-3 && (deg - 86.0).abs() < 0.1, "{error} at {deg}");
    }

    #[test]
    fn chromium_is_a_third_off() {
        let below = Complex64::new(3.18, 4.41);
        let (error, deg) = max_error(below, |cos| complex_f0(1.0, below, cos));
        let exact = fresnel::interface(Complex64::ONE, below, libm::cos(deg.to_radians())).unpolarised();
        assert!((error / exact - 0.35).abs() < 0.01, "{}", error / exact);
    }

    /// ((n - 1)^2 + 4 n (1 - cos)^5 + k^2)/((n + 1)^2 + k^2), as the paper prints it.
    #[test]
    fn complex_f0_is_lazanyis_first_term() {
        for cos in [0.0, 0.2, 0.7, 1.0] {
            let (n, k) = (1.17, 2.362);
            let paper = ((n - 1.0) * (n - 1.0) + 4.0 * n * fifth(1.0 - cos) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
            assert!((complex_f0(1.0, Complex64::new(n, k), cos) - paper).abs() < 1e-15);
        }
    }

    #[test]
    fn f82_passes_through_its_points() {
        let below = Complex64::new(3.18, 4.41);
        let f82 = F82::of(1.0, below);
        for cos in [1.0, F82_COS_THETA, 0.0] {
            let exact = fresnel::interface(Complex64::ONE, below, cos).unpolarised();
            assert!((f82.eval(cos) - exact).abs() < 1e-14, "{cos}");
        }
    }

    /// Glass by hand: (0.5 / 2.5)^2 = 0.04.
    #[test]
    fn an_f0_has_an_index() {
        assert!((index_of_f0(0.04) - 1.5).abs() < 1e-15);
        assert_eq!(index_of_f0(0.0), 1.0);
    }

    /// OpenPBR 1.1, metal, typed from the page with its numbers: `F0 + (1 - F0)(1 - mu)^5 - mu (1 - mu)^6 (F_schlick(1/7) (1 - t)) / ((1/7) (6/7)^6)`.
    /// Along the normal the reflectance is F0, at 81.8 degrees the tint times Schlick's, at the horizon 1; it is never out of 0..=1.
    #[test]
    fn f82_is_the_specifications() {
        let sixth = |x: f64| x * x * x * x * x * x;
        for f0 in [0.0, 0.04, 0.5, 0.955, 1.0] {
            for tint in [0.0, 0.25, 0.6, 1.0] {
                let curve = F82 { f0, tint };
                let at_edge = f0 + (1.0 - f0) * fifth(6.0 / 7.0);
                for i in 0..=1000 {
                    let mu = f64::from(i) / 1000.0;
                    let expected = f0 + (1.0 - f0) * fifth(1.0 - mu)
                        - mu * sixth(1.0 - mu) * at_edge * (1.0 - tint) / ((1.0 / 7.0) * sixth(6.0 / 7.0));
                    let found = curve.eval(mu);
                    // Dark tints of dark metals are below 0 next to the edge.
                    assert!((found - expected.max(0.0)).abs() < 1e-14, "{f0} {tint} {mu}: {found} {expected}");
                    assert!((0.0..=1.0 + 1e-15).contains(&found), "{f0} {tint} {mu}: {found}");
                }
                assert!((curve.eval(1.0) - f0).abs() < 1e-15 && (curve.eval(0.0) - 1.0).abs() < 1e-15);
                assert!((curve.eval(F82_COS_THETA) - tint * at_edge).abs() < 1e-14);
                let again = F82::of_dip(f0, curve.dip());
                assert!((again.tint - tint).abs() < 1e-12);
            }
        }
    }

    /// A mix by area reflects the mean at every angle; Simpson's rule has its average.
    #[test]
    fn a_mix_with_a_tinted_metal_is_the_mean() {
        let metal = F82 { f0: 0.7, tint: 0.3 };
        for metallic in [0.0, 0.25, 0.5, 1.0] {
            let mixed = metal.in_dielectric(DIELECTRIC_F0, metallic);
            let n = 2000;
            let mut sum = 0.0;
            for i in 0..=n {
                let mu = f64::from(i) / f64::from(n);
                let expected = metallic * metal.eval(mu) + (1.0 - metallic) * schlick(0.04, mu);
                assert!((mixed.eval(mu) - expected).abs() < 1e-14, "{metallic} {mu}");
                let weight = if i == 0 || i == n { 1.0 } else { [2.0, 4.0][usize::from(i % 2 == 1)] };
                sum += weight * 2.0 * mu * expected / (3.0 * f64::from(n));
            }
            assert!((mixed.average() - sum).abs() < 1e-12, "{metallic}: {} {sum}", mixed.average());
        }
    }

    #[test]
    fn average_matches_quadrature() {
        let n = 20_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let cos = (f64::from(i) + 0.5) / f64::from(n);
                2.0 * cos * schlick(0.04, cos) / f64::from(n)
            })
            .sum();
        assert!((sum - schlick_average(0.04)).abs() < 1e-8);
    }
}
