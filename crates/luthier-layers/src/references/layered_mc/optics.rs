//! Fresnel split of light at one facet or at a smooth interface: reflected and transmitted shares, from both sides.

use luthier_optics::fresnel::{FilmLayer, coated, transmitted};
use luthier_optics::schlick::F82;
use num_complex::Complex64;

use crate::monochrome::{MonochromeBelow, MonochromeLayer};

/// Side of an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The side of the exterior.
    Above,
    /// The side of the base.
    Below,
}

impl Side {
    /// The opposite side.
    pub fn other(self) -> Self {
        match self {
            Self::Above => Self::Below,
            Self::Below => Self::Above,
        }
    }
}

/// Shares of the light at a facet; the rest to 1 is absorbed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Split {
    pub(crate) reflectance: f64,
    pub(crate) transmittance: f64,
    /// Cosine of the incident ray.
    pub(crate) cos_theta: f64,
    /// Cosine of the refracted ray; 0 where there is none.
    pub(crate) cos_theta_t: f64,
}

impl Split {
    /// The split of a facet that lets nothing through.
    fn opaque(reflectance: f64, cos_theta: f64) -> Self {
        Self { reflectance, transmittance: 0.0, cos_theta, cos_theta_t: 0.0 }
    }
}

/// Indices closer than this make no interface; with films between them, they are moved this far apart, so that light
/// that goes through has a density.
const INDEX_MATCH: f64 = 1e-5;

/// The optics of an interface.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Optics {
    /// Real index above.
    pub(crate) above: f64,
    /// Real index below; the index above if the medium is opaque.
    pub(crate) below: f64,
    below_over_above: f64,
    above_over_below: f64,
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// Bare, between transparent media.
    Dielectric,
    /// Bare, opaque: complex index relative to the medium above.
    Conductor(Complex64),
    /// Bare, by Schlick's formula with this F0 and edge tint.
    Schlick { curve: F82, opaque: bool },
    /// Films, or a trace of absorption in the medium below. The index below is that by which the interface reflects, which an F0 under films may decide.
    Coated { films: Vec<FilmLayer>, below: Complex64, opaque: bool, absorbing: bool },
}

impl Optics {
    /// The interface at the top of a layer, which is not diffuse: a diffuse base has none, and counts as nothing.
    pub(crate) fn of(layer: &MonochromeLayer) -> Self {
        if let Some(curve) = layer.bare_f0() {
            return Self::of_schlick(layer, curve);
        }
        if let (Some(_), Some(index)) = (layer.f0, layer.index_below()) {
            return Self::of_coated_schlick(layer, index);
        }
        match layer.below {
            MonochromeBelow::Conductor { ior } => Self::opaque(layer.above, &layer.films, ior),
            MonochromeBelow::Dielectric { complex_ior, .. } => {
                Self::transparent(layer.above, &layer.films, complex_ior)
            }
            MonochromeBelow::Diffuse { .. } => Self::between(layer.above, layer.above, Kind::Dielectric),
        }
    }

    /// An interface that reflects by Schlick's formula. Light from below is reflected as much as light from above along the refracted ray.
    fn of_schlick(layer: &MonochromeLayer, curve: F82) -> Self {
        let above = layer.above;
        match bending(layer) {
            Some(below) => Self::between(above, below, Kind::Schlick { curve, opaque: false }),
            None => Self::between(above, above, Kind::Schlick { curve, opaque: true }),
        }
    }

    /// An interface with films over an F0: they interfere by the index of the F0, and light is bent by the index of the medium, as it is without films.
    fn of_coated_schlick(layer: &MonochromeLayer, index: Complex64) -> Self {
        let films = layer.films.clone();
        let below = bending(layer);
        let absorbing = is_absorbing(&films);
        let kind = Kind::Coated { films, below: index, opaque: below.is_none(), absorbing };
        Self::between(layer.above, below.unwrap_or(layer.above), kind)
    }

    /// An interface to an opaque medium of complex index `below`.
    pub(crate) fn opaque(above: f64, films: &[FilmLayer], below: Complex64) -> Self {
        if films.is_empty() {
            return Self::between(above, above, Kind::Conductor(below / above));
        }
        let kind = Kind::Coated { films: films.to_vec(), below, opaque: true, absorbing: is_absorbing(films) };
        Self::between(above, above, kind)
    }

    /// An interface to a medium that light enters. The slab has the medium's absorption; here it counts for the
    /// reflectance from above only.
    pub(crate) fn transparent(above: f64, films: &[FilmLayer], mut below: Complex64) -> Self {
        if films.is_empty() && below.im == 0.0 {
            return Self::between(above, below.re, Kind::Dielectric);
        }
        if (below.re / above - 1.0).abs() < INDEX_MATCH {
            below.re = above * (1.0 + INDEX_MATCH);
        }
        let kind = Kind::Coated { films: films.to_vec(), below, opaque: false, absorbing: is_absorbing(films) };
        Self::between(above, below.re, kind)
    }

    fn between(above: f64, below: f64, kind: Kind) -> Self {
        Self { above, below, below_over_above: below / above, above_over_below: above / below, kind }
    }

    /// Whether light goes through.
    pub(crate) fn is_transparent(&self) -> bool {
        match self.kind {
            Kind::Dielectric => true,
            Kind::Conductor(_) => false,
            Kind::Coated { opaque, .. } | Kind::Schlick { opaque, .. } => !opaque,
        }
    }

    /// Whether light goes straight through, as if there were nothing.
    pub(crate) fn is_absent(&self) -> bool {
        matches!(self.kind, Kind::Dielectric) && (self.below / self.above - 1.0).abs() < INDEX_MATCH
    }

    /// Whether light goes the same ways as at another interface.
    pub(crate) fn is_parallel(&self, other: &Self) -> bool {
        let [own, others] =
            [self, other].map(|optics| (optics.above, optics.below, optics.is_transparent(), optics.is_absent()));
        own == others
    }

    /// Index of the medium on a side.
    pub(crate) fn index(&self, side: Side) -> f64 {
        match side {
            Side::Above => self.above,
            Side::Below => self.below,
        }
    }

    /// Index of a side over that of the other.
    #[inline]
    pub(crate) fn eta_it(&self, side: Side) -> f64 {
        match side {
            Side::Above => self.above_over_below,
            Side::Below => self.below_over_above,
        }
    }

    /// Shares of unpolarised light that arrives on a side at a cosine in 0..=1.
    ///
    /// Without absorption in films the transmittance is the rest of the reflectance, and the reflectance is the same
    /// from both sides of a refracted ray. With it, both come from the amplitudes of a plane wave.
    pub(crate) fn split(&self, side: Side, cos_theta: f64) -> Split {
        self.split_sq(side, cos_theta * cos_theta)
    }

    /// [`Self::split`] of a squared cosine.
    #[inline(always)]
    pub(crate) fn split_sq(&self, side: Side, cos_theta_sq: f64) -> Split {
        let cos_sq = cos_theta_sq.clamp(0.0, 1.0);
        let cos = cos_sq.sqrt();
        match &self.kind {
            Kind::Dielectric => {
                let (eta_it, eta_ti) = (self.eta_it(side), self.eta_it(side.other()));
                let cos_t_sq = 1.0 - (1.0 - cos_sq) * (eta_it * eta_it);
                if cos_t_sq <= 0.0 || cos == 0.0 {
                    return Split::opaque(1.0, cos);
                }
                let cos_t = cos_t_sq.sqrt();
                let r_s = (cos - eta_ti * cos_t) / (cos + eta_ti * cos_t);
                let r_p = (eta_ti * cos - cos_t) / (eta_ti * cos + cos_t);
                let reflectance = 0.5 * (r_s * r_s + r_p * r_p);
                Split { reflectance, transmittance: 1.0 - reflectance, cos_theta: cos, cos_theta_t: cos_t }
            }
            Kind::Conductor(ior) => Split::opaque(conductor(*ior, cos, cos_sq), cos),
            Kind::Schlick { curve, opaque } => self.split_schlick(side, cos, *curve, *opaque),
            Kind::Coated { .. } => self.split_coated(side, cos),
        }
    }

    #[inline(never)]
    fn split_schlick(&self, side: Side, cos: f64, curve: F82, opaque: bool) -> Split {
        if opaque {
            return Split::opaque(curve.eval(cos), cos);
        }
        let eta_it = self.eta_it(side);
        let cos_t = (1.0 - (1.0 - cos * cos) * (eta_it * eta_it)).clamp(0.0, 1.0).sqrt();
        if cos_t <= 0.0 || cos == 0.0 {
            return Split::opaque(1.0, cos);
        }
        let reflectance = curve.eval(if side == Side::Above { cos } else { cos_t });
        Split { reflectance, transmittance: 1.0 - reflectance, cos_theta: cos, cos_theta_t: cos_t }
    }

    #[inline(never)]
    fn split_coated(&self, side: Side, cos: f64) -> Split {
        let Kind::Coated { films, below, opaque, absorbing } = &self.kind else { return Split::opaque(1.0, cos) };
        let above = Complex64::new(self.above, 0.0);
        if *opaque {
            return Split::opaque(coated(above, films, *below, cos).unpolarised(), cos);
        }
        let eta_it = self.eta_it(side);
        let cos_t = (1.0 - (1.0 - cos * cos) * (eta_it * eta_it)).clamp(0.0, 1.0).sqrt();
        let cos_above = if side == Side::Above { cos } else { cos_t };
        if !absorbing {
            if cos_t <= 0.0 || cos == 0.0 {
                return Split::opaque(1.0, cos);
            }
            let reflectance = coated(above, films, *below, cos_above).unpolarised();
            return Split { reflectance, transmittance: 1.0 - reflectance, cos_theta: cos, cos_theta_t: cos_t };
        }
        let reflectance = match side {
            Side::Above => coated(above, films, *below, cos).unpolarised(),
            Side::Below => {
                let upward: Vec<FilmLayer> = films.iter().rev().copied().collect();
                // Over an F0 the ray has its own direction in the medium of the index of that F0.
                let sin = (1.0 - cos_above * cos_above).max(0.0).sqrt() * self.above / below.re;
                let cos = if below.re == self.below { cos } else { (1.0 - sin * sin).max(0.0).sqrt() };
                coated(Complex64::new(below.re, 0.0), &upward, above, cos).unpolarised()
            }
        };
        let transmittance = if cos_t > 0.0 && cos > 0.0 {
            transmitted(self.above, films, below.re, cos_above).clamp(0.0, 1.0 - reflectance)
        } else {
            0.0
        };
        Split { reflectance, transmittance, cos_theta: cos, cos_theta_t: cos_t }
    }
}

/// The index that bends light which enters by an interface with an F0; `None` if none enters. Light that goes through an index match has no density.
fn bending(layer: &MonochromeLayer) -> Option<f64> {
    let MonochromeBelow::Dielectric { ior, .. } = layer.below else { return None };
    let is_match = (ior / layer.above - 1.0).abs() < INDEX_MATCH;
    Some(if is_match { layer.above * (1.0 + INDEX_MATCH) } else { ior })
}

fn is_absorbing(films: &[FilmLayer]) -> bool {
    films.iter().any(|f| f.ior.im != 0.0)
}

/// Unpolarised reflectance of a bare conductor of relative index `ior`, in real arithmetic.
///
/// With `(a + i b)^2 = ior^2 - sin^2`: `R_s = ((a - cos)^2 + b^2) / ((a + cos)^2 + b^2)`, and `R_p / R_s` is the same
/// with `sin tan` for `cos` (Born and Wolf sec. 14.2).
#[inline(always)]
fn conductor(ior: Complex64, cos: f64, c_sq: f64) -> f64 {
    let (n_sq, k_sq) = (ior.re * ior.re, ior.im * ior.im);
    let sin_sq = (1.0 - c_sq).max(0.0);
    let difference = n_sq - k_sq - sin_sq;
    let modulus = (difference * difference + 4.0 * n_sq * k_sq).sqrt();
    // The smaller of a^2 and b^2 from the product, which does not cancel.
    let a_sq = if difference >= 0.0 {
        0.5 * (modulus + difference)
    } else {
        let b_sq = 0.5 * (modulus - difference);
        n_sq * k_sq / b_sq
    };
    let twice_a_cos = 2.0 * cos * a_sq.sqrt();
    let (s, p) = (modulus + c_sq, c_sq * modulus + sin_sq * sin_sq);
    if s + twice_a_cos == 0.0 || p + twice_a_cos * sin_sq == 0.0 {
        return 0.0;
    }
    let refl_s = (s - twice_a_cos) / (s + twice_a_cos);
    let ratio = (p - twice_a_cos * sin_sq) / (p + twice_a_cos * sin_sq);
    0.5 * refl_s * (1.0 + ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_optics::fresnel::interface;

    fn c(re: f64, im: f64) -> Complex64 {
        Complex64::new(re, im)
    }

    #[test]
    fn bare_interfaces_are_those_of_the_optics_crate() {
        for cos in [0.0, 1e-3, 0.2, 0.7, 1.0] {
            let o = Optics::transparent(1.0, &[], c(1.5, 0.0));
            let expected = interface(c(1.0, 0.0), c(1.5, 0.0), cos).unpolarised();
            assert!((o.split(Side::Above, cos).reflectance - expected).abs() < 1e-13, "{cos}");
            let expected = interface(c(1.5, 0.0), c(1.0, 0.0), cos).unpolarised();
            assert!((o.split(Side::Below, cos).reflectance - expected).abs() < 1e-13, "{cos}");
            for ior in [c(0.05, 4.0), c(3.2, 3.3), c(1.0, 1e6), c(1.5, 0.0)] {
                let expected = interface(c(1.4, 0.0), ior, cos).unpolarised();
                let got = Optics::opaque(1.4, &[], ior).split(Side::Above, cos).reflectance;
                assert!((got - expected).abs() < 1e-11, "{ior} {cos}: {got} {expected}");
            }
        }
    }

    #[test]
    fn film_amplitudes_conserve_energy_without_absorption() {
        for (films, n3) in [(vec![(1.38, 0.3)], 1.5), (vec![(2.2, 0.17), (1.3, 0.6)], 1.7), (vec![], 2.0)] {
            let films: Vec<FilmLayer> =
                films.into_iter().map(|(n, waves)| FilmLayer { ior: c(n, 0.0), waves }).collect();
            for cos in [0.05, 0.4, 1.0] {
                let r = coated(c(1.0, 0.0), &films, c(n3, 0.0), cos).unpolarised();
                let t = transmitted(1.0, &films, n3, cos);
                assert!((r + t - 1.0).abs() < 1e-12, "{cos}: {r} + {t}");
            }
        }
    }

    #[test]
    fn absorbing_films_transmit_the_same_from_both_sides_and_lose_some() {
        let films = vec![FilmLayer { ior: c(0.2, 3.5), waves: 0.03 }, FilmLayer { ior: c(1.8, 0.2), waves: 0.2 }];
        let o = Optics::transparent(1.0, &films, c(1.5, 0.0));
        let upward: Vec<FilmLayer> = films.into_iter().rev().collect();
        for cos in [0.1, 0.6, 1.0] {
            let down = o.split(Side::Above, cos);
            let up = o.split(Side::Below, down.cos_theta_t);
            // The recursion from the other side, which the code does not run.
            let turned = transmitted(1.5, &upward, 1.0, down.cos_theta_t);
            assert!((down.transmittance - turned).abs() < 1e-12 && (up.transmittance - turned).abs() < 1e-12);
            assert!(down.transmittance > 0.01 && down.reflectance + down.transmittance < 0.999);
            assert!(up.reflectance + up.transmittance < 0.999);
            assert!((down.reflectance - up.reflectance).abs() > 1e-3);
        }
    }
}
