//! A surface below a coat by the numbers that artists give, and the parts that formulas of engines share.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::dielectric_albedo::{JointMasking, reflected_dir};
use luthier_optics::fresnel::dielectric_average;
use luthier_optics::stack::Distribution;

/// Index of the coats, and of plastics below them.
pub(super) const INDEX: f64 = 1.5;

/// F0 of [`INDEX`] in air.
pub(super) const F0: f64 = 0.04;

/// `f cos_theta_i` of a surface by channel.
pub(super) type Shader = Box<dyn Fn(&Pair) -> Rgb + Send + Sync>;

/// Numbers that an artist gives.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    /// Slope parameter of the coat; none without a coat.
    pub(super) coat: Option<f64>,
    /// Slope parameter of the base.
    pub(super) alpha: f64,
    /// Base colour.
    pub(super) color: Rgb,
    pub(super) metallic: f64,
    /// The proposal of this page for the base below the coat, in place of what the engine does.
    pub(super) remedy: Option<Remedy>,
}

/// A base that is changed for its coat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Remedy {
    /// Slope parameter.
    pub(super) alpha: f64,
    /// Factor on the light of the base.
    pub(super) scale: Rgb,
}

impl Surface {
    /// The surface with a base that is widened and darkened.
    ///
    /// Width: to first order a facet of slope s below a coat of index n turns light by 2 n s outside, and each of two passages through facets of the
    /// coat turns it by (n - 1) s. Variances add: `n^2 alpha^2 + (n - 1)^2 alpha_c^2 / 2`.
    ///
    /// Factor: `(1 - K) / (1 - K c)`, OpenPBR 1.1's equation 65, with its K between that of mirrors (equation 67) and that of diffuse bases
    /// (equation 66), by the slope parameter above for metals.
    pub(super) fn remedied(&self) -> Self {
        let Some(coat) = self.coat else { return self.clone() };
        let through = 0.5 * (INDEX - 1.0) * (INDEX - 1.0) * coat * coat;
        let alpha = (INDEX * INDEX * self.alpha * self.alpha + through).sqrt().min(1.0);
        let mirror = dielectric_average(INDEX);
        let diffuse = 1.0 - (1.0 - mirror) / (INDEX * INDEX);
        let spread = 1.0 + (alpha - 1.0) * self.metallic;
        let within = mirror + (diffuse - mirror) * spread;
        let scale = self.color.map(|c| (1.0 - within) / (1.0 - within * c));
        Self { remedy: Some(Remedy { alpha, scale }), ..self.clone() }
    }

    /// Slope parameter of the base, the engine's unless this page proposes another.
    pub(super) fn alpha_or(&self, engine: f64) -> f64 {
        self.remedy.map_or(engine, |remedy| remedy.alpha)
    }

    /// Factor on the base, the engine's unless this page proposes another.
    pub(super) fn scale_or(&self, engine: Rgb) -> Rgb {
        self.remedy.map_or(engine, |remedy| remedy.scale)
    }

    /// F0 where an engine mixes the F0 of plastic and metal.
    pub(super) fn mixed_f0(&self) -> Rgb {
        self.color.map(|c| F0 + self.metallic * (c - F0))
    }

    /// Lambert's base: what metal leaves of the colour, over pi.
    pub(super) fn diffuse(&self) -> Rgb {
        self.color.map(|c| c * (1.0 - self.metallic) * FRAC_1_PI)
    }
}

/// A direction to the light and one to the eye, with their cosines against the normal, and those of the half vector against the normal and either direction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) wi: DVec3,
    pub(super) wo: DVec3,
    pub(super) i: f64,
    pub(super) o: f64,
    pub(super) h: f64,
    pub(super) d: f64,
}

impl Pair {
    /// Both directions above the horizon, else none.
    pub(super) fn of(wi: DVec3, wo: DVec3) -> Option<Self> {
        let half = (wi + wo).normalize();
        (wi.z > 0.0 && wo.z > 0.0).then(|| Self {
            wi,
            wo,
            i: wi.z,
            o: wo.z,
            h: half.z.min(1.0),
            d: half.dot(wo).clamp(0.0, 1.0),
        })
    }

    /// `D G / (4 cos_theta_i cos_theta_o)` of GGX, with Smith's masking, height-correlated.
    pub(super) fn correlated(&self, alpha: f64) -> f64 {
        0.5 * ggx(alpha, self.h) / (self.i * root(alpha, self.o) + self.o * root(alpha, self.i))
    }

    /// The product of both masks in place of their correlation.
    pub(super) fn separable(&self, alpha: f64) -> f64 {
        ggx(alpha, self.h) / ((self.i + root(alpha, self.i)) * (self.o + root(alpha, self.o)))
    }
}

fn root(alpha: f64, cos_theta: f64) -> f64 {
    (alpha * alpha + (1.0 - alpha * alpha) * cos_theta * cos_theta).sqrt()
}

/// D of GGX.
pub(super) fn ggx(alpha: f64, cos_theta_h: f64) -> f64 {
    let fall = 1.0 - (1.0 - alpha * alpha) * cos_theta_h * cos_theta_h;
    alpha * alpha / (PI * fall * fall)
}

/// Schlick's `(1 - cos)^5`.
pub(super) fn grazing(cos_theta: f64) -> f64 {
    let c = 1.0 - cos_theta;
    let square = c * c;
    square * square * c
}

/// Each channel of three.
pub(super) fn rgb(of: impl Fn(usize) -> f64) -> Rgb {
    [of(0), of(1), of(2)]
}

/// Directional albedo of facets by the cosine, from quadrature: where engines have tables or fits of their own, this page has the integral.
#[derive(Debug)]
pub(super) struct Albedo {
    nodes: Vec<f64>,
    /// Over the hemisphere.
    pub(super) average: f64,
}

/// Intervals over the root of the cosine.
const INTERVALS: usize = 96;

impl Albedo {
    pub(super) fn new(masking: JointMasking, alpha: f64, reflectance: impl Fn(f64) -> f64) -> Self {
        let cos = |node: usize| (node as f64 / INTERVALS as f64) * (node as f64 / INTERVALS as f64);
        let nodes: Vec<f64> = (0..=INTERVALS)
            .map(|node| reflected_dir(Distribution::Ggx, masking, alpha, cos(node), &reflectance))
            .collect();
        let average = (0..INTERVALS)
            .map(|n| {
                let (low, high) = (cos(n), cos(n + 1));
                (high * high - low * low) * 0.5 * (nodes[n] + nodes[n + 1])
            })
            .sum();
        Self { nodes, average }
    }

    pub(super) fn at(&self, cos_theta: f64) -> f64 {
        let at = cos_theta.clamp(0.0, 1.0).sqrt() * INTERVALS as f64;
        let node = (at as usize).min(INTERVALS - 1);
        self.nodes[node] + (at - node as f64) * (self.nodes[node + 1] - self.nodes[node])
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::dielectric_albedo::{albedo_dir, fresnel_dielectric};

    use super::*;

    /// Oracle: the quadrature of `luthier-optics` between the nodes of the table, and its average.
    #[test]
    fn tables_have_the_albedo_of_clear_dielectrics() {
        for (masking, alpha) in [(JointMasking::Correlated, 0.05), (JointMasking::Separable, 0.4)] {
            let table = Albedo::new(masking, alpha, |cos| fresnel_dielectric(INDEX, cos));
            for cos in [0.03, 0.17, 0.5, 0.77, 0.99] {
                let exact = albedo_dir(Distribution::Ggx, masking, alpha, INDEX, cos).reflected;
                assert!((table.at(cos) - exact).abs() < 3e-4, "{alpha} {cos}: {} {exact}", table.at(cos));
            }
            let average =
                luthier_optics::dielectric_albedo::albedo_avg(Distribution::Ggx, masking, alpha, INDEX).reflected;
            assert!((table.average - average).abs() < 2e-4, "{alpha}: {} {average}", table.average);
        }
    }

    /// The remedy leaves a white base white, and a mirror of slope 0 below a smooth coat a mirror.
    #[test]
    fn remedies_keep_white_white() {
        let surface = Surface { coat: Some(0.0), alpha: 0.0, color: [1.0; 3], metallic: 1.0, remedy: None };
        let remedy = surface.remedied().remedy.unwrap();
        assert!(remedy.alpha == 0.0 && remedy.scale.iter().all(|scale| (scale - 1.0).abs() < 1e-15), "{remedy:?}");
    }
}
