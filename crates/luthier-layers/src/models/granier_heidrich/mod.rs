//! The layered model of Granier and Heidrich: two beams, their interference, and a diffuse term.
//!
//! X. Granier and W. Heidrich, "A Simple Layered RGB BRDF Model", Graphical Models 65, 2003:
//!
//! ```text
//! rho = R + T + 2 cos(2 Phi) sqrt(R T)                                    (5)
//! R = F(i) <r_i, o>^e0                                                    (6)
//! T = (1 - F(i)) T(t_o) <r_ti, -t_o>^e1                                   (10)
//! Phi = pi r_1 d / lambda <t_i + t_o, -n_0>                               (3)
//! rho_d = 1 + 2 cos(4 pi r_1 d / lambda) sqrt(T_d (1 - T_d))              (18)
//! ```
//!
//! F is Schlick's. Directions t_i and t_o are refracted at the outer normal n_0 with the index of the wavelength, and r_ti is t_i mirrored at the
//! inner normal n_1. Unlike normals deviate the beam and spread colours, as a prism does.
//!
//! The paper's lobes have height one, and it does not say what share of the light they carry. At its exponents this is 1/76 or less of their
//! coefficients. [`GranierHeidrich`] scales each lobe so that it carries its coefficient. The transmitted lobe is scaled in the film, where its
//! directions are. [`LobeHeight::One`] leaves the lobes as printed.
//!
//! The remaining errors are the paper's, and the tests measure them:
//!
//! - Both beams are added at full strength. In phase, the specular part returns `F + T^2 + 2 sqrt(F) T` at its peak: for n = 1.5, 1.346 at the
//!   normal and 1.939 at 80 degrees. An eye under a white sky sees 1.316 and 1.483, because the transmitted lobe is the wider one.
//! - The object below is a perfect mirror for the transmitted beam, whatever it is. Without interference, the specular part of any stack is
//!   `F + T^2`, nearly one.
//! - The diffuse term is added to that, up to `1 + 2 sqrt(T_d R_d)` (1.560 for n = 1.5) times its weight. A white object without interference
//!   returns 1.96 at the normal.
//! - T is Schlick's at the angle inside (eq. 9 and 10) and F at the angle outside, so the model is not reciprocal. Lobes without a cosine are not,
//!   either.
//! - Half-wave shifts are missing: indices have to rise from outside to inside.

mod eval;

use std::array::from_fn;
use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;
use luthier_model::{LobeHeight, ShadingModel};
use luthier_optics::schlick::schlick_average;

use crate::formulas::normals::exponent;
use crate::formulas::refraction::refract;
use crate::layers::ALPHA_MIN;
use crate::model::{Claims, Input, Inputs, Kind, Model, ModelInfo};
use crate::models::phong::lobe;
use crate::models::room::{Kernels, Room};
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use crate::terms::Terms;

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels { eval: include_str!("eval.wgsl"), parts: include_str!("parts.wgsl"), ..Kernels::NONE },
    twin: eval::twin,
    models: || vec![Box::new(GranierHeidrich::default())],
    composed: |parts| Some(Box::new(parts.beams)),
};

/// A film as the model takes it, at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    /// Index r_1 over the index r_0 outside.
    pub eta: f64,
    /// Reflectance at normal incidence of the outer boundary, f in eq. 8; `None` takes that of `eta`.
    pub f0: Option<f64>,
    /// `r_1 d / lambda`, lambda in vacuum: number of wavelengths across the film; `None` for a layer too thick to interfere.
    pub waves_inside: Option<f64>,
    /// Normal n_1 of the inner boundary; n_0 is +z.
    pub inner_normal: DVec3,
    /// Phong exponents e_0 of the outer boundary and e_1 of the inner one.
    pub exponents: [f64; 2],
}

/// Powers of the two beams by the paper's eq. 6 and 10, with lobes of height one, and the sum that decides their phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beams {
    /// R.
    pub reflected: f64,
    /// T.
    pub transmitted: f64,
    /// Sum of the cosines of both directions in the film, in proportion to the phase; 0 if nothing is transmitted.
    pub cosines: f64,
    /// Ratio of the solid angles of incident light in the film and outside, `cos_theta_i / (eta^2 cos_theta_t)`; 0 if nothing is transmitted.
    pub compression: f64,
}

impl Film {
    /// The reflectance at normal incidence of the outer boundary, f in eq. 8.
    fn normal_reflectance(&self) -> f64 {
        let r = (1.0 - self.eta) / (1.0 + self.eta);
        self.f0.unwrap_or(r * r)
    }

    /// Eq. 3, 6 and 10. There is no transmitted beam in the cases of eq. 11, and under total reflection.
    pub fn beams(&self, wi: DVec3, wo: DVec3) -> Beams {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return Beams { reflected: 0.0, transmitted: 0.0, cosines: 0.0, compression: 0.0 };
        }
        let f = self.normal_reflectance();
        let fresnel = schlick(f, wi.z.min(1.0));
        let reflected = fresnel * lobe(DVec3::new(-wi.x, -wi.y, wi.z), wo, self.exponents[0]);
        let none = Beams { reflected, transmitted: 0.0, cosines: 0.0, compression: 0.0 };

        // t_i and t_o turned to point up: -t_i, -t_o.
        let (Some(ti), Some(to)) = (refract(wi, self.eta), refract(wo, self.eta)) else { return none };
        let n = self.inner_normal;
        if ti.dot(n) <= 0.0 || to.dot(n) <= 0.0 {
            return none;
        }
        let mirrored = 2.0 * ti.dot(n) * n - ti;
        let leaving = 1.0 - schlick(f, to.z.min(1.0));
        let transmitted = (1.0 - fresnel) * leaving * lobe(mirrored, to, self.exponents[1]);
        Beams { reflected, transmitted, cosines: ti.z + to.z, compression: wi.z / (self.eta * self.eta * ti.z) }
    }

    /// Eq. 5 as printed, with lobes of height one. A layer too thick to interfere has no interference.
    pub fn specular(&self, wi: DVec3, wo: DVec3) -> f64 {
        let Beams { reflected, transmitted, cosines, .. } = self.beams(wi, wo);
        superpose(reflected, transmitted, self.interference(cosines))
    }

    /// [`Film::specular`] with the lobes of [`GranierHeidrich`], which carry their coefficients.
    pub fn scaled_specular(&self, wi: DVec3, wo: DVec3) -> f64 {
        let beams = self.beams(wi, wo);
        let [r, t] = self.scaled(&beams);
        superpose(r, t, self.interference(beams.cosines))
    }

    /// Both powers, each times `(e + 1) / (2 pi)`. The factor of the transmitted beam is over solid angles in the film.
    fn scaled(&self, beams: &Beams) -> [f64; 2] {
        let [outer, inner] = self.exponents.map(|e| (e + 1.0) / (2.0 * PI));
        [outer * beams.reflected, inner * beams.compression * beams.transmitted]
    }

    /// Eq. 13 with eq. 14, 15 and 17: the paper's eq. 18.
    pub fn diffuse(&self) -> f64 {
        self.diffuse_by(self.interference(2.0))
    }

    /// [`Film::diffuse`] from `2 cos(2 Phi)` at the normal.
    fn diffuse_by(&self, interference: f64) -> f64 {
        let reflected = self.diffuse_reflectance();
        superpose(reflected, 1.0 - reflected, interference)
    }

    /// `2 cos(2 Phi)` for a sum of cosines in the film; 0 for a layer too thick to interfere.
    fn interference(&self, cosines: f64) -> f64 {
        self.waves_inside.map_or(0.0, |waves| 2.0 * libm::cos(2.0 * PI * waves * cosines))
    }

    /// Eq. 14: the cosine-weighted mean of Schlick's reflectance.
    pub fn diffuse_reflectance(&self) -> f64 {
        if let Some(f0) = self.f0 {
            return schlick_average(f0);
        }
        let (n, sum) = (self.eta, 1.0 + self.eta);
        (21.0 * (n * n + 1.0) - 38.0 * n) / (21.0 * sum * sum)
    }
}

/// Two powers and their interference (eq. 4), from `2 cos(2 Phi)`.
fn superpose(r: f64, t: f64, interference: f64) -> f64 {
    (r + t + interference * libm::sqrt(r * t)).max(0.0)
}

/// The model on a stack.
///
/// The film is the first coherent film of the first interface. If there is none, it is the slab below, without interference: the mean over
/// thicknesses.
///
/// Lobes are Phong's of 1975, without a cosine, times `(e + 1) / (2 pi)`. By this factor an eye at any angle sees of a white sky the coefficient of
/// each lobe, less the light from below the horizon. The transmitted lobe is scaled over solid angles in the film. With [`LobeHeight::One`] there are no
/// such factors, and values are those of eq. 5 ([`Film::specular`]).
///
/// Exponents are `2/alpha^2 - 2` unless given, and the inner boundary has its own alpha, as in the material of the paper's figure 4. About the mirror
/// direction such a lobe is half as wide as the surface's.
///
/// The diffuse weight is the albedo of the diffuse base, zero without one. A first interface with neither film nor slab (a bare conductor) has the
/// reflected beam alone, with its own reflectance at normal incidence. Layers and slabs below the film do not count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GranierHeidrich {
    /// Normal n_1 of the inner boundary, unit.
    pub inner_normal: DVec3,
    /// Exponents instead of those of the surface.
    pub exponents: Option<[f64; 2]>,
    /// Ratio of the slope parameters of inner and outer boundary. The exponents of a surface follow from both.
    pub inner_alpha_ratio: f64,
    /// Weight of the specular part.
    pub specular_weight: f64,
    /// Weight of the diffuse part, beside the albedo of the base.
    pub diffuse_weight: f64,
    /// Height of both lobes.
    pub lobe_height: LobeHeight,
}

impl Default for GranierHeidrich {
    fn default() -> Self {
        Self::PLAIN
    }
}

impl GranierHeidrich {
    /// Parallel boundaries of one slope parameter, both parts at full weight.
    pub const PLAIN: Self = Self {
        inner_normal: DVec3::Z,
        exponents: None,
        inner_alpha_ratio: 1.0,
        specular_weight: 1.0,
        diffuse_weight: 1.0,
        lobe_height: LobeHeight::Scaled,
    };

    /// The model with an inner boundary that leans by `normal` (unit, above the surface) at a place. Slopes of heights add up: those of `normal` are
    /// added to the model's own.
    #[must_use]
    pub fn leaning(self, normal: DVec3) -> Self {
        if self.inner_normal == DVec3::Z || normal == DVec3::Z {
            let inner_normal = if normal == DVec3::Z { self.inner_normal } else { normal };
            return Self { inner_normal, ..self };
        }
        let [own, here] = [self.inner_normal, normal].map(|n| n.truncate() / n.z);
        Self { inner_normal: (own + here).extend(1.0).normalize(), ..self }
    }

    /// The exponents e_0 and e_1 of a surface of a slope parameter.
    fn exponents_of(&self, alpha: f64) -> [f64; 2] {
        self.exponents.unwrap_or_else(|| {
            // Shaders have slope parameters within these limits.
            let inner = if self.inner_alpha_ratio == 1.0 {
                alpha
            } else {
                (alpha * self.inner_alpha_ratio).clamp(ALPHA_MIN, 1.0)
            };
            [exponent(alpha), exponent(inner)]
        })
    }

    /// The film of a stack; `None` if its first interface has neither a film nor a transparent medium below.
    pub fn film(&self, stack: &Monochrome) -> Option<Film> {
        let layer = stack.layers.first()?;
        let (ior, waves_inside) = match (layer.films.first(), layer.below) {
            (Some(first), _) => (first.ior.re, Some(first.ior.re * first.waves)),
            (None, MonochromeBelow::Dielectric { ior, .. }) => (ior, None),
            (None, MonochromeBelow::Conductor { .. } | MonochromeBelow::Diffuse { .. }) => return None,
        };
        let exponents = self.exponents_of(layer.surface.alpha_isotropic());
        let inner_normal = self.inner_normal;
        Some(Film {
            eta: ior / layer.above,
            f0: layer.bare_f0().map(|curve| curve.f0),
            waves_inside,
            inner_normal,
            exponents,
        })
    }
}

impl Model for GranierHeidrich {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: ShadingModel::GranierHeidrich.name(),
            kind: Kind::Layered,
            claims: Claims::NONE,
            inputs: &[Input::InnerNormal],
            source: "Granier and Heidrich 2003, eq. 3-18",
            domain: "one film, or one transparent layer, on an object; indices rising inwards",
            leaves_out: "the object's reflectance, absorption, bounces, reciprocity; the specular part returns all light, beams in \
                         phase up to twice that, and the diffuse term comes on top",
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let [value] = self.eval_with(std::array::from_ref(stack), stack, wi, wo);
        value
    }

    fn with_inputs(&self, inputs: &Inputs) -> Option<Box<dyn Model>> {
        Some(Box::new(Self { inner_normal: inputs.inner_normal.unwrap_or(self.inner_normal), ..*self }))
    }
}

impl GranierHeidrich {
    /// [`Model::eval`] in channels, with reflectances and interference from terms. Each channel bends directions by the index of its own wavelength.
    pub fn eval_with<const C: usize>(
        &self,
        stacks: &[Monochrome; C],
        terms: &dyn Terms<C>,
        wi: DVec3,
        wo: DVec3,
    ) -> [f64; C] {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; C];
        }
        let films = stacks.each_ref().map(|stack| self.film(stack));
        let bare = if films.iter().all(Option::is_none) { terms.fresnel(0, 1.0) } else { [0.0; C] };
        from_fn(|c| {
            let stack = &stacks[c];
            let base = match stack.layers.last().map(|l| l.below) {
                Some(MonochromeBelow::Diffuse { albedo, .. }) => albedo,
                _ => 0.0,
            };
            let (specular, diffuse) = match (films[c], stack.layers.first()) {
                (Some(film), Some(layer)) => {
                    let beams = film.beams(wi, wo);
                    let [r, t] = match self.lobe_height {
                        LobeHeight::Scaled => film.scaled(&beams),
                        LobeHeight::One => [beams.reflected, beams.transmitted],
                    };
                    let [specular, diffuse] = [beams.cosines, 2.0].map(|cosines| match film.waves_inside {
                        Some(_) => terms.interference(0, c, cosines).unwrap_or_else(|| layer.interference(cosines)),
                        None => 0.0,
                    });
                    (superpose(r, t, specular), film.diffuse_by(diffuse))
                }
                (None, Some(layer)) => (self.bare_specular(layer, bare[c], wi, wo), 1.0),
                (_, None) => (0.0, 0.0),
            };
            self.specular_weight * specular + self.diffuse_weight * base * diffuse * FRAC_1_PI * wi.z
        })
    }

    /// Specular light of an object without a film, with reflectance `f` at normal incidence.
    fn bare_specular(&self, layer: &MonochromeLayer, f: f64, wi: DVec3, wo: DVec3) -> f64 {
        if matches!(layer.below, MonochromeBelow::Diffuse { .. }) {
            return 0.0;
        }
        let [e, _] = self.exponents_of(layer.surface.alpha_isotropic());
        let height = match self.lobe_height {
            LobeHeight::Scaled => (e + 1.0) / (2.0 * PI),
            LobeHeight::One => 1.0,
        };
        schlick(f, wi.z.min(1.0)) * height * lobe(DVec3::new(-wi.x, -wi.y, wi.z), wo, e)
    }
}

/// Schlick 1994. `luthier_optics::schlick` multiplies in another order: its last digit differs, and manifests of scenes state errors to that digit.
fn schlick(normal: f64, cos: f64) -> f64 {
    let q = (1.0 - cos).max(0.0);
    normal + (1.0 - normal) * (q * q) * (q * q) * q
}
