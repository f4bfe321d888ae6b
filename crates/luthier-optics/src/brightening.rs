//! Colours below a coat that are to look through it as they look bare.
//!
//! A base below a smooth coat of index n meets its own light again: the coat sends a share K of it back. A diffuse base of the colour C so looks like
//! `(1 - K) C / (1 - K C)`. Engines draw a coat on top and leave the base as bright as its colour says. [`Brightening`] has the colour that looks so
//! here.
//!
//! Out of scope: absorption in the coat, and coats that are rough. Either is as it would be over a base of that colour.

use crate::Rgb;
use crate::fresnel;
use crate::microfacet::lambda;
use crate::quadrature::gauss_legendre;
use crate::schlick;
use crate::stack::Distribution;
use num_complex::Complex64;

/// Shares of its light that a base gets back from a coat: of the light of a diffuse base, and of that of a metal.
///
/// ```
/// use luthier_optics::brightening::Brightening;
///
/// // Varnish of index 1.5 over a diffuse base: K = 1 - (1 - 0.0918) / 1.5^2.
/// let varnish = Brightening::below(1.5, 0.25);
/// assert!((varnish.diffuse - 0.5963).abs() < 5e-5);
/// // The base needs 0.4 / (1 - K + 0.4 K) to look like 0.4.
/// assert!((varnish.matt([0.4; 3], 1.0)[0] - 0.6229).abs() < 5e-5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brightening {
    /// Share of the light of a diffuse base.
    pub diffuse: f64,
    /// Share of the light of a metal, less than that of a diffuse base: light that meets the coat straight goes out.
    pub metal: f64,
}

/// Nodes of the mean over the hemisphere.
const NODES: usize = 64;

/// Reflections of a metal that are averaged, of equal shares of its facets.
const FACETS: u32 = 4096;

impl Brightening {
    /// The shares below a smooth coat whose index over that of the exterior is `eta` > 0, for a base of the slope parameter `alpha`.
    ///
    /// Diffuse: `1 - (1 - E) / eta^2`, where E is the mean reflectance of the coat from outside, exact to 1e-9. Metal: the mean of what the coat
    /// reflects from inside over the light that facets of GGX reflect once, down to which eye and light from the normal lead. The slope parameter of
    /// these facets is sqrt 2 alpha, because light that comes back was reflected twice; the share is not above that of a diffuse base. Against the
    /// simulation of the stack this is an approximation: `docs/materials.md` has the errors.
    pub fn below(eta: f64, alpha: f64) -> Self {
        let diffuse = if eta < 1.0 { average(1.0 / eta) } else { 1.0 - (1.0 - average(eta)) / (eta * eta) };
        Self { diffuse, metal: of_facets(eta, (std::f64::consts::SQRT_2 * alpha).min(1.0)).min(diffuse) }
    }

    /// The colour of a diffuse base that looks like `color` where a coat covers the share `weight` of the surface, and the rest is bare.
    pub fn matt(&self, color: Rgb, weight: f64) -> Rgb {
        color.map(|color| brightened(color, self.diffuse, weight))
    }

    /// The F0 of such a metal.
    pub fn metal(&self, color: Rgb, weight: f64) -> Rgb {
        color.map(|color| brightened(color, self.metal, weight))
    }

    /// [`schlick::metallic_roughness`] of a surface that looks through the coat as its base colour says.
    pub fn metallic_roughness(&self, base_color: Rgb, metallic: f64, weight: f64) -> (Rgb, Rgb) {
        schlick::metallic_and_matt(self.metal(base_color, weight), self.matt(base_color, weight), metallic)
    }
}

/// The x for which `w (1 - K) x / (1 - K x) + (1 - w) x` is the colour: C / (1 - K + K C) at the weight 1, C at 0. Of the two roots the one in 0..=1,
/// in the form without a difference.
fn brightened(color: f64, share: f64, weight: f64) -> f64 {
    let sum = 1.0 - weight * share + share * color;
    let square = (sum * sum - 4.0 * (1.0 - weight) * share * color).max(0.0);
    2.0 * color / (sum + libm::sqrt(square))
}

/// Mean reflectance, weighted with the cosine, of an interface to a medium of higher index `eta`. [`fresnel::dielectric_average`] is its closed form,
/// which cancels near 1.
fn average(eta: f64) -> f64 {
    // Nodes in the root of the cosine: the reflectance falls steeply from the horizon on.
    gauss_legendre(NODES).iter().map(|&(u, weight)| weight * 4.0 * u * u * u * reflected(eta, u * u)).sum()
}

/// Mean of the reflectance of the coat from inside over the light that facets of GGX mirror from along the normal.
fn of_facets(eta: f64, alpha: f64) -> f64 {
    let alpha_sq = alpha * alpha;
    // Facets that lean by 45 degrees and more mirror downwards.
    let most = 1.0 / (1.0 + alpha_sq);
    let (mut sum, mut norm) = (0.0, 0.0);
    for i in 0..FACETS {
        let share = most * (f64::from(i) + 0.5) / f64::from(FACETS);
        // D cos_theta_h has this share below the squared tangent.
        let tan_sq = alpha_sq * share / (1.0 - share);
        let cos = 2.0 / (1.0 + tan_sq) - 1.0;
        let seen = 1.0 / (1.0 + lambda(Distribution::Ggx, alpha, cos));
        sum += seen * reflected(1.0 / eta, cos);
        norm += seen;
    }
    sum / norm
}

fn reflected(eta: f64, cos_theta: f64) -> f64 {
    fresnel::interface(Complex64::ONE, Complex64::new(eta, 0.0), cos_theta).unpolarised()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a midpoint rule of 400000 steps in another language, which printed these digits: 0.528985, 0.596346, 0.650877.
    #[test]
    fn shares_of_a_diffuse_base() {
        for (eta, expected) in [(1.33, 0.471_949), (1.4, 0.528_985), (1.5, 0.596_346), (1.6, 0.650_877)] {
            let found = Brightening::below(eta, 0.5).diffuse;
            assert!((found - expected).abs() < 1e-6, "{eta}: {found}");
            let closed = 1.0 - (1.0 - fresnel::dielectric_average(eta)) / (eta * eta);
            assert!((found - closed).abs() < 1e-9, "{eta}: {found} {closed}");
        }
        assert!(Brightening::below(1.0, 0.5).diffuse.abs() < 1e-12);
        // No total reflection from inside a thinner medium: by reciprocity the closed form of the inverse index.
        let thinner = Brightening::below(0.8, 0.5).diffuse;
        assert!((thinner - fresnel::dielectric_average(1.25)).abs() < 1e-9, "{thinner}");
    }

    /// A mirror meets the coat along the normal, which reflects (0.5/2.5)^2; a rough metal is as a diffuse base at most.
    #[test]
    fn shares_of_a_metal() {
        let shares = [0.0, 0.01, 0.1, 0.3, 0.6, 1.0].map(|alpha| Brightening::below(1.5, alpha).metal);
        assert!((shares[0] - 0.04).abs() < 1e-12, "{shares:?}");
        assert!(shares.is_sorted() && shares[5] <= Brightening::below(1.5, 1.0).diffuse, "{shares:?}");
    }

    /// By hand at K = 1/2: C = 1/2 needs 0.5 / 0.75 below the whole coat; a coat of no weight needs nothing; half a coat over x = 0.5 shows
    /// 0.5 x 0.5 (0.5 / 0.75) + 0.5 x 0.5 = 5/12.
    #[test]
    fn what_shows_is_the_colour() {
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(brightened(0.5, 0.5, 1.0), 2.0 / 3.0);
        close(brightened(0.5, 0.5, 0.0), 0.5);
        close(brightened(5.0 / 12.0, 0.5, 0.5), 0.5);
        for weight in [0.0, 0.3, 1.0] {
            for share in [0.0, 0.6] {
                [0.0, 1.0].into_iter().for_each(|end| close(brightened(end, share, weight), end));
            }
        }
    }

    #[test]
    fn a_surface_is_metal_or_matt() {
        let both = Brightening { diffuse: 0.5, metal: 0.25 };
        let (f0, albedo) = both.metallic_roughness([0.5; 3], 1.0, 1.0);
        assert!((f0[0] - 0.5 / 0.875).abs() < 1e-12 && albedo == [0.0; 3], "{f0:?} {albedo:?}");
        let (f0, albedo) = both.metallic_roughness([0.5; 3], 0.0, 1.0);
        assert_eq!((f0, albedo), schlick::metallic_roughness([2.0 / 3.0; 3], 0.0));
    }
}
