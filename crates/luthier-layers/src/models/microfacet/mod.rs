//! The model of Torrance and Sparrow for one rough interface and one bounce, by its components.

mod eval;

use glam::DVec3;
use luthier_model::{DiffuseTerm, Masking, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::stack::{Distribution, Surface};

use crate::formulas::facets::{Facets, Lobe};
use crate::formulas::interface_fresnel::{Fresnel, LazanyiMemo};
use crate::formulas::normals::{Normals, NormalsMemo};
use crate::formulas::oren_nayar;
use crate::frame::cos_theta_d;
use crate::layers::{Below, Layer};
use crate::memo::Memo;
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::models::room::{Kernels, Room};
use crate::monochrome::Monochrome;
use crate::terms::Terms;

/// The room of the model.
pub(crate) const ROOM: Room = Room {
    kernels: Kernels { eval: include_str!("eval.wgsl"), parts: include_str!("parts.wgsl"), ..Kernels::NONE },
    twin: eval::twin,
    models: || {
        VARIANTS.iter().map(|(_, components, _)| Box::new(Microfacet::new(*components)) as Box<dyn Model>).collect()
    },
    composed: |parts| Some(Box::new(Microfacet::new(parts.components()))),
};

/// Parts of a microfacet model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Components {
    /// Distribution of facet normals.
    pub normals: Normals,
    /// Masking and shadowing.
    pub masking: Masking,
    /// Reflectance of a facet.
    pub fresnel: Fresnel,
    /// Light of the diffuse base below the interface.
    pub diffuse_term: DiffuseTerm,
}

impl Components {
    /// The surface's own distribution, height-correlated Smith masking, exact reflectance.
    pub const PLAIN: Self = Self {
        normals: Normals::Surface,
        masking: Masking::Smith,
        fresnel: Fresnel::Exact,
        diffuse_term: DiffuseTerm::None,
    };
}

/// Variants of the model: name, components, source. Each differs from the first in one component.
pub const VARIANTS: [(&str, Components, &str); 18] = {
    const P: Components = Components::PLAIN;
    const BECKMANN: Normals = Normals::Slopes(Distribution::Beckmann);
    const GGX: Normals = Normals::Slopes(Distribution::Ggx);
    [
        (ShadingModel::Microfacet.name(), P, "Walter et al. 2007, eq. 20; masking of Heitz 2014, eq. 99"),
        (
            "microfacet-beckmann",
            Components { normals: BECKMANN, ..P },
            "Beckmann and Spizzichino 1963; anisotropic: Ward 1992, Heitz 2014, eq. 81",
        ),
        (
            "microfacet-ggx",
            Components { normals: GGX, ..P },
            "Trowbridge and Reitz 1975; Walter et al. 2007, eq. 33; anisotropic: Burley 2012, eq. 13",
        ),
        (
            "microfacet-blinn-phong",
            Components { normals: Normals::BlinnPhong, ..P },
            "Blinn 1977, normalised; exponent 2/alpha^2 - 2 (Walter et al. 2007); Smith masking by quadrature",
        ),
        (
            "microfacet-abc",
            Components { normals: Normals::Abc, ..P },
            "Low et al. 2012, normalised; b = 2/alpha^2, c = 2; Smith masking by quadrature",
        ),
        (
            "microfacet-sgd",
            Components { normals: Normals::Sgd, ..P },
            "Bagher et al. 2012; its alpha is alpha^2, p = 1; Smith masking by quadrature",
        ),
        (
            "microfacet-implicit",
            Components { masking: Masking::Implicit, ..P },
            "Hoffman 2013: masking cos_theta_i cos_theta_o",
        ),
        (
            "microfacet-v-cavity",
            Components { masking: Masking::VCavity, ..P },
            "Torrance and Sparrow 1967; Cook and Torrance 1982, eq. 9",
        ),
        (
            "microfacet-kelemen",
            Components { masking: Masking::Kelemen, ..P },
            "Kelemen and Szirmay-Kalos 2001: masking cos_theta_i cos_theta_o / cos_theta_d^2",
        ),
        (
            "microfacet-schlick-smith",
            Components { masking: Masking::SchlickSmith, ..P },
            "Schlick 1994: masking with k = alpha sqrt(2/pi)",
        ),
        (
            "microfacet-smith-separable",
            Components { masking: Masking::SmithSeparable, ..P },
            "Smith 1967; Walter et al. 2007, eq. 23",
        ),
        (
            "microfacet-schlick",
            Components { fresnel: Fresnel::Schlick, ..P },
            "Schlick 1994, from the exact reflectance at normal incidence, films included",
        ),
        (
            "microfacet-complex-f0",
            Components { fresnel: Fresnel::ComplexF0, ..P },
            "Elek 2010, FresnelTermNP: Schlick's form, F0 from n and k; films left out",
        ),
        (
            "microfacet-lazanyi",
            Components { fresnel: Fresnel::Lazanyi, ..P },
            "Lazanyi and Szirmay-Kalos 2005, correction fitted at each wavelength; films left out",
        ),
        (
            "microfacet-f82",
            Components { fresnel: Fresnel::F82, ..P },
            "Kutz, Hasan and Edmondson 2021: F82-tint through the exact reflectance at 0 and 81.8 degrees",
        ),
        (
            "microfacet-transfer-matrix",
            Components { fresnel: Fresnel::TransferMatrix, ..P },
            "Abeles 1950; Born and Wolf, section 1.6: films by characteristic matrices",
        ),
        (
            "microfacet-granier-film",
            Components { fresnel: Fresnel::TwoBeams, ..P },
            "Granier and Heidrich 2003, eq. 5: two beams of the first film; Schlick 1994 without one",
        ),
        (
            "microfacet-belcour-barla",
            Components { fresnel: Fresnel::BelcourBarla, ..P },
            "Belcour and Barla 2017: first film, two orders; prefiltered in spectral colour; exact without a film",
        ),
    ]
};

/// `f = F D G / (4 cos_theta_i cos_theta_o)` of the first interface (Torrance and Sparrow 1967; Walter et al. 2007, eq. 20), D
/// normalised. Light through the interface is lost. With [`DiffuseTerm::Added`] the diffuse base, if the last layer is one, comes on top as if no interface
/// lay above it. A diffuse first layer has Oren and Nayar's model.
///
/// Reciprocal. The albedo of an interface is at most one, except for the variant with two beams, which gains. An added base is not dimmed. V-cavities let `f cos_theta_i` grow
/// as 1/cos_theta_o towards grazing mirror directions.
#[derive(Debug)]
pub struct Microfacet {
    components: Components,
    normals: NormalsMemo,
    fits: LazanyiMemo,
}

impl Microfacet {
    /// The model of some components.
    pub const fn new(components: Components) -> Self {
        Self { components, normals: NormalsMemo::new(), fits: Memo::new() }
    }

    /// The lobe of the first layer for `wi` and `wo`.
    fn lobe<const C: usize>(&self, surface: &Surface, terms: &dyn Terms<C>, wi: DVec3, wo: DVec3) -> Option<Lobe> {
        let Components { normals, masking, .. } = self.components;
        match normals {
            Normals::Surface => Facets::new(surface).lobe_of(terms, 0, masking, wi, wo),
            _ => normals.lobe(&self.normals, surface, masking, wi, wo),
        }
    }

    /// [`Model::eval`] of layers, with terms in place of the exact reflectance and of the surface's own distribution.
    pub fn eval_with<const C: usize>(
        &self,
        layers: &[Layer<C>],
        terms: &dyn Terms<C>,
        wi: DVec3,
        wo: DVec3,
    ) -> [f64; C] {
        let [first, rest @ ..] = layers else { return [0.0; C] };
        let facets = self.eval_by(first, terms, |cos_theta_d| terms.fresnel(0, cos_theta_d), wi, wo);
        let base = rest.last().map_or([0.0; C], |last| self.added(last.below, wi, wo));
        std::array::from_fn(|c| facets[c] + base[c])
    }

    /// `f cos_theta_i` of the base below the interface, if it is diffuse and added.
    fn added<const C: usize>(&self, base: Below<C>, wi: DVec3, wo: DVec3) -> [f64; C] {
        match (self.components.diffuse_term, base) {
            (DiffuseTerm::Added, Below::Diffuse { albedo, sigma }) if wi.z > 0.0 && wo.z > 0.0 => {
                oren_nayar::brdf(albedo, sigma, wi, wo).map(|f| wi.z * f)
            }
            _ => [0.0; C],
        }
    }

    fn eval_by<const C: usize>(
        &self,
        layer: &Layer<C>,
        terms: &dyn Terms<C>,
        reflectance: impl FnOnce(f64) -> [f64; C],
        wi: DVec3,
        wo: DVec3,
    ) -> [f64; C] {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; C];
        }
        if let Below::Diffuse { albedo, sigma } = layer.below {
            return oren_nayar::brdf(albedo, sigma, wi, wo).map(|f| wi.z * f);
        }
        let Some(lobe) = self.lobe(&layer.surface, terms, wi, wo) else { return [0.0; C] };
        reflectance(lobe.cos_theta_d).map(|reflectance| reflectance * lobe.value)
    }
}

impl Model for Microfacet {
    fn info(&self) -> ModelInfo {
        let known = VARIANTS.iter().find(|(_, components, _)| *components == self.components);
        let (name, source) = known.map_or(("microfacet-composed", "see its components"), |v| (v.0, v.2));
        let claims = match self.components.fresnel {
            Fresnel::TwoBeams => Claims::RECIPROCAL,
            _ => Claims::BOTH,
        };
        ModelInfo {
            name,
            kind: Kind::Surface,
            claims,
            source,
            domain: match self.components.normals {
                Normals::Surface | Normals::Slopes(_) => {
                    "the first interface of any stack, anisotropic or not; alpha from 1e-4"
                }
                Normals::BlinnPhong | Normals::Abc | Normals::Sgd => {
                    "the first interface of any stack, isotropic; alpha from 1e-4"
                }
            },
            leaves_out: match self.components.diffuse_term {
                DiffuseTerm::None => "all layers below, and all bounces after the first",
                DiffuseTerm::Added => {
                    "layers between the first and the diffuse base, what the first takes from the base's light, and all bounces after the first"
                }
            },
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        let [layer, rest @ ..] = stack.layers.as_slice() else { return 0.0 };
        let fresnel = self.components.fresnel;
        let [value] = self.eval_by(&layer.into(), stack, |cos| [fresnel.reflectance(&self.fits, layer, cos)], wi, wo);
        let base = rest.last().map(|last| Layer::<1>::from(last).below);
        value + base.map_or(0.0, |base| self.added(base, wi, wo)[0])
    }

    fn eval_rgb(&self, channels: &[(f64, Monochrome); 3], wi: DVec3, wo: DVec3) -> Option<Rgb> {
        let reflectance = self.components.fresnel.rgb(channels, cos_theta_d(wi, wo))?;
        let first = &channels[0].1;
        let value = self.lobe(&first.layers.first()?.surface, first, wi, wo).map_or(0.0, |lobe| lobe.value);
        Some(reflectance.map(|r| r * value))
    }

    fn lossless(&self, stack: &Monochrome) -> Monochrome {
        stack.lossless_interface()
    }
}
