//! Parts of a model that a material chooses: the masking of `microfacet`, the source of reflectances, the parts of a path, and the numbers of
//! `granier-heidrich`.

use glam::DVec3;
use luthier_model::{DiffuseTerm, LobeHeight, Masking, PathParts, Reflectance};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::schlick::Lazanyi;
use luthier_optics::stack::{Distribution, Stack};

use crate::formulas::interface_fresnel::Fresnel;
use crate::models::granier_heidrich::GranierHeidrich;
use crate::models::lobes::Below;
use crate::models::microfacet::Components;
use crate::models::shade::ShaderTerms;
use crate::models::statistics::diffuse_base::Veil;
use crate::models::statistics::energy::Energy;
use crate::terms::Terms;

/// Parts of the model of a shader. Models ignore parts that they have no choice of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parts {
    /// Masking of `microfacet`.
    pub masking: Masking,
    /// Reflectances of `elek`, `weidlich-wilkie` and `microfacet`, and energies of `belcour` and `yamaguchi`.
    pub reflectance: Reflectance,
    /// Parts of `elek` and `weidlich-wilkie`.
    pub path: PathParts,
    /// Light of the diffuse base of `microfacet`.
    pub diffuse_term: DiffuseTerm,
    /// Numbers of `granier-heidrich`.
    pub beams: GranierHeidrich,
}

impl Parts {
    /// The parts of a material that chooses none.
    pub const PLAIN: Self = Self {
        masking: Masking::Smith,
        reflectance: Reflectance::Table,
        path: PathParts::PLAIN,
        diffuse_term: DiffuseTerm::None,
        beams: GranierHeidrich::PLAIN,
    };

    /// The parts with numbers of `granier-heidrich`: the ratio of the slope parameters of inner and outer boundary, the weights of the specular and
    /// the diffuse part, the normal of the inner boundary, and the height of both lobes.
    #[must_use]
    pub fn with_beams(
        self,
        inner_alpha_ratio: f64,
        weights: [f64; 2],
        inner_normal: [f64; 3],
        lobe_height: LobeHeight,
    ) -> Self {
        let [specular_weight, diffuse_weight] = weights;
        let inner_normal = DVec3::from_array(inner_normal);
        let exponents = None;
        let beams = GranierHeidrich {
            inner_normal,
            exponents,
            inner_alpha_ratio,
            specular_weight,
            diffuse_weight,
            lobe_height,
        };
        Self { beams, ..self }
    }

    /// The components of the model `microfacet`, for one wavelength.
    pub const fn components(self) -> Components {
        let fresnel = match self.reflectance {
            Reflectance::Table | Reflectance::Exact => Fresnel::Exact,
            Reflectance::Approximate => Fresnel::ComplexF0,
            Reflectance::Lazanyi => Fresnel::Lazanyi,
        };
        Components { masking: self.masking, fresnel, diffuse_term: self.diffuse_term, ..Components::PLAIN }
    }
}

/// Reflectance of an interface, in place of the one in the terms.
#[derive(Debug, Clone)]
enum Own {
    /// Fresnel's equations at three wavelengths.
    Exact(Sampled),
    /// Schlick's form, channel by channel.
    Schlick([Lazanyi; 3]),
    /// Schlick's form less a correction, within 0 and 1.
    Corrected([Lazanyi; 3]),
}

impl Own {
    fn rgb(&self, cos_theta_d: f64) -> Rgb {
        match self {
            Self::Exact(sampled) => sampled.rgb(cos_theta_d),
            Self::Schlick(curves) => curves.map(|curve| luthier_optics::schlick::schlick(curve.f0, cos_theta_d)),
            Self::Corrected(curves) => curves.map(|curve| curve.eval(cos_theta_d)),
        }
    }
}

/// Reflectances of the interfaces of a stack, in place of those in the terms.
#[derive(Debug, Clone, Default)]
pub struct Reflectances(Vec<Option<Own>>);

impl Reflectances {
    /// The reflectances of a stack by a source. Curves leave films out, and have the colour `color`. Fresnel's equations are evaluated at
    /// `wavelengths_nm`.
    pub fn of(stack: &Stack, wavelengths_nm: [f64; 3], color: Color, reflectance: Reflectance) -> Self {
        let own = (0..stack.layers.len()).map(|layer| {
            let interface = Interface::of(stack, layer)?;
            let bare = Interface { films: Vec::new(), ..interface.clone() };
            match reflectance {
                Reflectance::Table => None,
                Reflectance::Exact => Some(Own::Exact(interface.sampled(&Color::ThreeWavelengths(wavelengths_nm)))),
                Reflectance::Approximate => Some(Own::Schlick(bare.sampled(&color).schlick())),
                Reflectance::Lazanyi => Some(Own::Corrected(bare.sampled(&color).lazanyi())),
            }
        });
        Self(own.collect())
    }

    /// Terms with these reflectances.
    pub fn over<'a>(&'a self, terms: &'a dyn ShaderTerms) -> Chosen<'a> {
        Chosen { terms, reflectances: self }
    }
}

/// Terms with chosen reflectances.
#[derive(Clone, Copy)]
pub struct Chosen<'a> {
    terms: &'a dyn ShaderTerms,
    reflectances: &'a Reflectances,
}

impl Terms for Chosen<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        match self.reflectances.0.get(layer) {
            Some(Some(own)) => own.rgb(cos_theta_d),
            _ => self.terms.fresnel(layer, cos_theta_d),
        }
    }

    fn distribution(&self, layer: usize, d: Distribution, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        self.terms.distribution(layer, d, alpha, cos_theta_h, sin_theta_h_sq)
    }

    fn interference(&self, layer: usize, channel: usize, cosines: f64) -> Option<f64> {
        self.terms.interference(layer, channel, cosines)
    }
}

impl Energy<3> for Chosen<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> Rgb {
        match self.reflectances.0.get(layer) {
            // Facets as level.
            Some(Some(own)) => own.rgb(cos_theta_i).map(|energy| energy.clamp(0.0, 1.0)),
            _ => self.terms.fgd(layer, cos_theta_i, alpha),
        }
    }

    fn escaping(&self, layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        match self.reflectances.0.get(layer) {
            Some(Some(_)) => 1.0,
            _ => self.terms.escaping(layer, cos_theta_i, alpha, eta),
        }
    }
}

impl ShaderTerms for Chosen<'_> {
    fn veil(&self) -> Veil<3> {
        self.terms.veil()
    }

    fn below(&self, wo: DVec3) -> Option<Below> {
        self.terms.below(wo)
    }
}

#[cfg(test)]
mod tests {
    use luthier_model::ShadingModel;
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Base, Layer, Surface};

    use super::*;
    use crate::monochrome::Monochrome;
    use crate::registry;
    use crate::twins::real_time::Twin;
    use crate::twins::terms::Exact;

    const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

    fn metal() -> Stack {
        let surface = Surface { distribution: Distribution::Ggx, alpha_x: 0.4, alpha_y: 0.2, rotation: 0.3 };
        let base = Base::Conductor { ior: Ior::constant(3.18, 4.41).unwrap() };
        Stack { exterior: Ior::vacuum(), layers: vec![Layer { films: Vec::new(), surface, base }] }
    }

    fn directions() -> (DVec3, DVec3) {
        (DVec3::new(0.7, 0.1, 0.3).normalize(), DVec3::new(-0.8, 0.2, 0.25).normalize())
    }

    /// Oracle: the models of the registry that have one other part each.
    #[test]
    fn parts_are_those_of_the_models_by_name() {
        let (wi, wo) = directions();
        let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
        let exact = Exact::new(&metal(), color);
        for (masking, reflectance, name) in [
            ("smith", "table", "microfacet"),
            ("smith", "exact", "microfacet"),
            ("smith-separable", "table", "microfacet-smith-separable"),
            ("schlick-smith", "table", "microfacet-schlick-smith"),
            ("v-cavity", "table", "microfacet-v-cavity"),
            ("kelemen", "table", "microfacet-kelemen"),
            ("implicit", "table", "microfacet-implicit"),
            ("smith", "approximate", "microfacet-complex-f0"),
            ("smith", "lazanyi", "microfacet-lazanyi"),
        ] {
            let (masking, reflectance) = (masking.parse().unwrap(), reflectance.parse().unwrap());
            let parts = Parts { masking, reflectance, ..Parts::PLAIN };
            let twin = Twin::with(ShadingModel::Microfacet, &metal(), WAVELENGTHS_NM, color, parts);
            let expected = registry::model(name).unwrap().eval(&Monochrome::new(&metal(), 525.0, 1), wi, wo);
            let found = twin.eval(&exact, wi, wo);
            assert!(expected > 1e-3 && found.iter().all(|f| (f / expected - 1.0).abs() < 1e-12), "{name}: {found:?}");
            let plain = Twin::new(ShadingModel::Microfacet, &metal(), WAVELENGTHS_NM, color).eval(&exact, wi, wo);
            assert_eq!((plain[1] - found[1]).abs() < 1e-9, name == "microfacet", "{name}");
        }
    }

    /// Oracle: Schlick's form is linear in F0, so that its colour is the sum over wavelengths.
    #[test]
    fn curves_have_the_colour_of_the_stack() {
        let samples = [(400.0, 1.2, 1.0), (500.0, 0.9, 2.0), (700.0, 0.2, 4.0)];
        let samples = samples.map(|(wavelength_nm, n, k)| luthier_optics::ior::IorSample { wavelength_nm, n, k });
        let mut stack = metal();
        stack.layers[0].base = Base::Conductor { ior: Ior::sampled(samples.to_vec()).unwrap() };
        let here = Reflectances::of(&stack, WAVELENGTHS_NM, Color::Spectral, Reflectance::Approximate);
        let exact = Exact::new(&stack, Color::Spectral);
        let sampled = Interface::of(&stack, 0).unwrap().sampled(&Color::Spectral);
        for cos in [0.1, 0.4, 1.0] {
            let expected = sampled.sum(|at| luthier_optics::schlick::complex_f0(1.0, at.below, cos));
            let found = here.over(&exact).fresnel(0, cos);
            assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 1e-6), "{found:?} {expected:?}");
        }
    }
}
