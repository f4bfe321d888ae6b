//! The layered model of Weidlich and Wilkie, as printed.
//!
//! A. Weidlich and A. Wilkie, "Exploring the potential of layered BRDF models", SIGGRAPH Asia 2009 course, eq. 3.1-3.3
//! (first in "Arbitrarily layered micro-facet surfaces", GRAPHITE 2007):
//!
//! ```text
//! f = f_1(wi, wo) + T_12 f_2(wi', wo') a t
//! a = exp(-sigma d (1/cos_theta_i' + 1/cos_theta_o'))      t = (1 - G) + T_21 G
//! ```
//!
//! f_2 is again a layered surface. T_12 = T_21 = 1 - F at the half vector, as in the course's shader (see [`InternalReflection`]). G is of
//! V-cavities. The course leaves the distribution free, and each surface has its own.
//!
//! The model errs in two ways, which the tests measure. Radiance is not compressed by 1/n^2 on its way out: a smooth coat over a white base returns
//! about twice the light that it receives. Light that an interface returns downward is lost, except for the share that `t` makes up for, by how far
//! facets hide each other. [`crate::models::weidlich_wilkie::corrected`] mends both.

pub mod corrected;
pub mod sampling;

use glam::DVec3;
use luthier_model::{InternalReflection, LowerAlpha, LowerFacets, PathParts, ShadingModel};

use crate::formulas::facets::{Facets, Lobe};
use crate::formulas::refraction::{refract, refract_at};
use crate::frame::half_vector;
use crate::layers::{Layer, Layers};
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::models::parts::Parts;
use crate::models::path::{PathModel, Tilts, eval, power_lobe, walk};
use crate::models::room::{Kernels, Room};
use crate::monochrome::Monochrome;
use crate::terms::Terms;
use corrected::WeidlichWilkieCorrected;

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels { eval: include_str!("eval.wgsl"), ..Kernels::NONE },
    twin: |given| eval::twin(WeidlichWilkie::of(given.parts), Layers::rgb(given.stack)),
    models: || {
        vec![
            Box::new(WeidlichWilkie::default()),
            Box::new(WeidlichWilkie {
                parts: PathParts { internal_reflection: InternalReflection::Directions, ..PathParts::PLAIN },
                ..WeidlichWilkie::default()
            }),
            Box::new(WeidlichWilkie { refraction: Refraction::Facet, ..WeidlichWilkie::default() }),
            Box::new(WeidlichWilkieCorrected),
        ]
    },
    composed: |parts| Some(Box::new(WeidlichWilkie::of(parts))),
};

/// Normal at which both directions are refracted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Refraction {
    /// The normal of the surface, as in Elek's form of the model and in the sampling of this crate.
    #[default]
    Surface,
    /// The half vector: both rays pass through their common facet (the course's first simplification, read by the letter). The lower layer then has
    /// the same half vector, whatever the index.
    Facet,
}

/// The recursive model, faithful to the course.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WeidlichWilkie {
    /// Normal at which directions are refracted.
    pub refraction: Refraction,
    /// The parts that a material chooses.
    pub parts: PathParts,
}

impl WeidlichWilkie {
    /// The model with the parts that a material chooses.
    fn of(parts: Parts) -> Self {
        Self { parts: parts.path, ..Self::default() }
    }
}

impl PathModel for WeidlichWilkie {
    fn parts(&self) -> PathParts {
        self.parts
    }

    /// The cosine is a factor on returned light. Interfaces get it over that of the medium above, because lobes carry the cosine of their own medium.
    fn cosines(&self, cos_theta_i: f64) -> [f64; 2] {
        [1.0, cos_theta_i]
    }

    fn facets<const C: usize>(&self, layers: &[Layer<C>], terms: &dyn Terms<C>, wi: DVec3, wo: DVec3) -> Option<Lobe> {
        let (last, above) = layers.split_last()?;
        let mut surface = last.surface;
        if self.parts.lower_alpha == LowerAlpha::AtLeastAbove {
            let rougher = above.iter().map(|layer| layer.surface.alpha_isotropic()).fold(0.0, f64::max);
            (surface.alpha_x, surface.alpha_y) = (surface.alpha_x.max(rougher), surface.alpha_y.max(rougher));
        }
        let own = if above.is_empty() { LowerFacets::TorranceSparrow } else { self.parts.lower_facets };
        if let Some(value) = power_lobe(own, surface.alpha_isotropic(), wi, wo) {
            let (_, cos_theta_d) = half_vector(wi, wo)?;
            return Some(Lobe { cos_theta_d, masking: 1.0, value: value * wi.z });
        }
        Facets::new(&surface).lobe_of(terms, above.len(), self.parts.cavity_masking(), wi, wo)
    }

    fn refracted(&self, eta: f64, wi: DVec3, wo: DVec3) -> Option<[DVec3; 2]> {
        let pair = match self.refraction {
            Refraction::Surface => [refract(wi, eta)?, refract(wo, eta)?],
            Refraction::Facet => {
                let m = (wi + wo).try_normalize()?;
                [refract_at(m, wi, eta)?, refract_at(m, wo, eta)?]
            }
        };
        pair.iter().all(|w| w.z > 0.0).then_some(pair)
    }

    fn sent(&self, passed: f64, cosines: f64, reflectance: f64, lobe: f64) -> f64 {
        passed * cosines * reflectance * lobe
    }

    fn kept(&self, entered: f64, left: f64, absorbed: f64) -> f64 {
        entered * left * absorbed
    }
}

impl Model for WeidlichWilkie {
    fn info(&self) -> ModelInfo {
        let at_directions = self.parts.internal_reflection == InternalReflection::Directions;
        let (name, domain) = match (self.refraction, at_directions) {
            (Refraction::Surface, false) => {
                (ShadingModel::WeidlichWilkie.name(), "any stack; refraction at the surface normal; alpha from 1e-4")
            }
            (Refraction::Surface, true) => {
                ("weidlich-wilkie-directions", "any stack; transmission at the directions' own angles; alpha from 1e-4")
            }
            (Refraction::Facet, false) => {
                ("weidlich-wilkie-facet", "any stack; refraction at the half vector; alpha from 1e-4")
            }
            (Refraction::Facet, true) => {
                ("weidlich-wilkie-facet-directions", "any stack; refraction at the half vector, transmission not")
            }
        };
        ModelInfo {
            name,
            kind: Kind::Layered,
            claims: Claims::RECIPROCAL,
            source: "Weidlich and Wilkie 2009, eq. 3.1-3.3; Elek 2010, eq. 2-4",
            domain,
            leaves_out: "1/n^2 (up to n^2 times too bright), bounces between layers, blur by refraction",
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let [value] = walk(self, &Layers::from(stack).layers, stack, wi, wo, Tilts::NONE, false).value();
        value
    }
}
