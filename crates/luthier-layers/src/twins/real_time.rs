//! Twins in f64 of the emitted shaders: models in three colour channels, with optical terms computed or read from tables.
//!
//! This module contains no model: a twin evaluates the model of its room, channel by channel, under the rules of shaders:
//!
//! - Slope parameters are at least [`ALPHA_MIN`](crate::layers::ALPHA_MIN), and channels share them.
//! - One index at [`REFRACTION_WAVELENGTH_NM`](crate::formulas::refraction::REFRACTION_WAVELENGTH_NM) bends the directions of all channels. Granier and
//!   Heidrich's model bends each channel by the index of its own wavelength, unless the first interface is Schlick's.
//! - Reflectances come from [`Terms`](crate::terms::Terms).
//! - Channels share the spreads of Belcour's and Yamaguchi's models.

use std::borrow::Cow;
use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use luthier_model::{ModelPart, Reflectance, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;

use crate::models::parts::{Parts, Reflectances};
use crate::models::path::Tilts;
use crate::models::room;
use crate::models::shade::{Given, Shade, ShaderTerms, Under};

/// The twin of a shader, for one surface.
#[derive(Debug)]
pub struct Twin {
    model: ShadingModel,
    shade: Box<dyn Shade>,
    /// Reflectances in place of those in the terms, if a material chooses them.
    reflectances: Option<Reflectances>,
    /// Rows of the matrix from light to light of a fluorescent base.
    reradiation: Option<[Rgb; 3]>,
    /// Own normals of interfaces, from the top down.
    normals: Vec<DVec3>,
    /// Weight of the first layer, a coat, and the twin of the layers below it.
    cover: Option<(f64, Box<Twin>)>,
}

/// A stack as a model sees it: unless its light is simulated, of a `metallic-roughness` surface that light crosses once ([`Stack::crossed_once`]).
pub(super) fn seen_by(model: ShadingModel, stack: &Stack) -> Cow<'_, Stack> {
    if model.is_fitted() || !stack.bends_in_engine() { Cow::Borrowed(stack) } else { Cow::Owned(stack.crossed_once()) }
}

impl Twin {
    /// The twin of the shader of a model. `wavelengths_nm` are those of the three channels. `color` is the colour of Phong's coefficients, which both
    /// forms of the shader read from the material. Everything else has the colour of the [`Terms`](crate::terms::Terms).
    pub fn new(model: ShadingModel, stack: &Stack, wavelengths_nm: [f64; 3], color: Color) -> Self {
        Self::with(model, stack, wavelengths_nm, color, Parts::PLAIN)
    }

    /// [`Twin::new`] with parts that a material chooses. Curves in place of reflectances have the colour `color`, too.
    pub fn with(model: ShadingModel, stack: &Stack, wavelengths_nm: [f64; 3], color: Color, parts: Parts) -> Self {
        let stack = &*seen_by(model, stack);
        let is_chosen = model.takes(ModelPart::Reflectance) && parts.reflectance != Reflectance::Table;
        let reflectances = is_chosen.then(|| Reflectances::of(stack, wavelengths_nm, color, parts.reflectance));
        let shade = (room(model).twin)(&Given { stack, wavelengths_nm, color, parts });
        Self { model, shade, reflectances, reradiation: None, normals: Vec::new(), cover: None }
    }

    /// The twin over a fluorescent base, given rows of a matrix from light to light (linear Rec.709, [`luthier_optics::reradiation::rgb`]). They replace
    /// the albedo in `elek` and `weidlich-wilkie`; other models ignore them.
    #[must_use]
    pub fn reradiating(self, rows: Option<[Rgb; 3]>) -> Self {
        Self { reradiation: rows.filter(|_| self.model.is_path()), ..self }
    }

    /// The twin with normals of single interfaces, from the top down: unit, in the frame of the surface. `elek` and `weidlich-wilkie` show them.
    #[must_use]
    pub fn tilting(self, normals: Vec<DVec3>) -> Self {
        Self { normals, ..self }
    }

    /// The twin of a surface that the first layer covers by a weight. `bare` is the twin of the layers below it, and its terms are those that the terms of
    /// this one have beside them ([`ShaderTerms::bare`]).
    #[must_use]
    pub fn covering(self, weight: f64, bare: Self) -> Self {
        Self { cover: Some((weight, Box::new(bare))), ..self }
    }

    /// `f cos_theta_i`, RGB; zero if either direction is at or below the horizon. Each term is asked for once, for all channels.
    pub fn eval(&self, terms: &dyn ShaderTerms, wi: DVec3, wo: DVec3) -> Rgb {
        self.eval_over(terms, &Under::NONE, wi, wo)
    }

    /// Radiance to the eye, linear Rec.709, under light whose irradiance on a plane across `wi` is `light`. This is [`Twin::eval`] times the light, unless
    /// the base is fluorescent: light of one channel then leaves in others. With the rows M of [`Twin::reradiating`], the share `down` of light that
    /// reaches the base, and the share `up` of its light that leaves,
    ///
    /// ```text
    /// L_i = f_i cos_theta_i light_i + cos_theta_i / pi up_i sum over j of M_ij down_j light_j
    /// ```
    ///
    /// with f of the interfaces. The result is linear in the light; [`Twin::eval_over`] is that for white light.
    pub fn eval_lit(&self, terms: &dyn ShaderTerms, under: &Under, light: Rgb, wi: DVec3, wo: DVec3) -> Rgb {
        match &self.reflectances {
            Some(reflectances) => self.lit_on(&reflectances.over(terms), under, light, wi, wo),
            None => self.lit_on(terms, under, light, wi, wo),
        }
    }

    fn lit_on(&self, terms: &dyn ShaderTerms, under: &Under, light: Rgb, wi: DVec3, wo: DVec3) -> Rgb {
        let walked = self.reradiation.and_then(|_| self.shade.walked(terms, self.tilts(under), wi, wo));
        let Some(walked) = walked else {
            let plain = self.eval_on(terms, under, wi, wo);
            return [0, 1, 2].map(|c| plain[c] * light[c]);
        };
        let rows = self.reradiation.unwrap_or_default();
        let (down, up) = walked.base.map(|base| (base.down, base.up)).unwrap_or_default();
        [0, 1, 2].map(|i: usize| {
            let emitted: f64 = (0..3).map(|j| rows[i][j] * down[j] * light[j]).sum();
            walked.interfaces[i] * light[i] + wi.z * FRAC_1_PI * up[i] * emitted
        })
    }

    /// [`Twin::eval`] with other normals below the first interface, and a base that may be fluorescent, under white light.
    pub fn eval_over(&self, terms: &dyn ShaderTerms, under: &Under, wi: DVec3, wo: DVec3) -> Rgb {
        if self.reradiation.is_some() {
            return self.eval_lit(terms, under, [1.0; 3], wi, wo);
        }
        let covered = match &self.reflectances {
            Some(reflectances) => self.eval_on(&reflectances.over(terms), under, wi, wo),
            None => self.eval_on(terms, under, wi, wo),
        };
        let (Some((weight, twin)), Some(bare)) = (&self.cover, terms.bare()) else { return covered };
        let bare = twin.eval(bare, wi, wo);
        [0, 1, 2].map(|c: usize| weight * covered[c] + (1.0 - weight) * bare[c])
    }

    fn eval_on(&self, terms: &dyn ShaderTerms, under: &Under, wi: DVec3, wo: DVec3) -> Rgb {
        self.shade.eval(terms, under, self.tilts(under), wi, wo)
    }

    fn tilts(&self, under: &Under) -> Tilts<'_> {
        Tilts { below: under.flake_normal, own: &self.normals }
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::{Ior, IorSample};
    use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Surface};

    use super::*;
    use crate::model::Model;
    use crate::models::lobes::Below;
    use crate::models::statistics::diffuse_base::Veil;
    use crate::models::statistics::energy::Energy;
    use crate::models::statistics::evaluate::Prepared;
    use crate::models::weidlich_wilkie::WeidlichWilkie;
    use crate::monochrome::Monochrome;
    use crate::registry;
    use crate::terms::Terms;
    use crate::twins::terms::Exact;

    const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

    fn dispersive(n: f64) -> Ior {
        let samples = [(400.0, n + 0.05, 0.0), (700.0, n - 0.05, 0.0)];
        Ior::sampled(samples.map(|(wavelength_nm, n, k)| IorSample { wavelength_nm, n, k }).to_vec()).unwrap()
    }

    fn layer(surface: Surface, base: Base) -> Layer {
        Layer { films: Vec::new(), surface, base }
    }

    fn coat(ior: Ior) -> Layer {
        let surface = Surface { distribution: Distribution::Ggx, alpha_x: 0.3, alpha_y: 0.1, rotation: 0.4 };
        layer(
            surface,
            Base::Dielectric { ior, slab: Slab { thickness_um: 10.0, absorption_per_um: [0.01, 0.02, 0.03] } },
        )
    }

    fn directions() -> [(DVec3, DVec3); 2] {
        let unit = |x, y, z| DVec3::new(x, y, z).normalize();
        [(unit(0.3, 0.1, 0.7), unit(-0.2, 0.2, 0.9)), (unit(0.9, 0.0, 0.1), unit(-0.8, 0.3, 0.2))]
    }

    /// The energies that the models at one wavelength compute, in all channels.
    struct Grey(Prepared);

    impl Terms for Grey {
        fn fresnel(&self, _: usize, _: f64) -> Rgb {
            [f64::NAN; 3]
        }

        fn distribution(&self, _: usize, _: Distribution, _: f64, _: f64, _: f64) -> f64 {
            f64::NAN
        }
    }

    impl Energy<3> for Grey {
        fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> Rgb {
            let [grey] = self.0.energy().fgd(layer, cos_theta_i, alpha);
            [grey; 3]
        }
    }

    impl ShaderTerms for Grey {
        fn veil(&self) -> Veil<3> {
            let Some(Veil { internal: [internal], upward: [upward] }) = self.0.veil() else { return Veil::NONE };
            Veil { internal: [internal; 3], upward: [upward; 3] }
        }

        fn below(&self, _: DVec3) -> Option<Below> {
            None
        }
    }

    /// Oracle: the model at each wavelength alone. Coats and metals are grey, because the shaders' channels share their spreads.
    #[test]
    fn exact_twins_of_the_statistical_models_are_the_models() {
        let grey = Ior::constant(1.5, 0.0).unwrap();
        let metal = |distribution| {
            let surface = Surface { distribution, alpha_x: 0.05, alpha_y: 0.2, rotation: -0.3 };
            layer(surface, Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() })
        };
        let base = layer(Surface::smooth(), Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.3 }));
        let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.1; 3] };
        let rough = layer(
            Surface { distribution: Distribution::Ggx, alpha_x: 0.3, alpha_y: 0.1, rotation: 0.4 },
            Base::Dielectric { ior: grey, slab },
        );
        for layers in
            [vec![rough.clone(), metal(Distribution::Ggx)], vec![metal(Distribution::Beckmann)], vec![rough, base]]
        {
            let stack = Stack { exterior: Ior::vacuum(), layers };
            let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
            let grey = Grey(Prepared::new(&Monochrome::new(&stack, 550.0, 1)));
            let exact = Exact::new(&stack, color);
            for name in [ShadingModel::Belcour, ShadingModel::Yamaguchi] {
                let twin = Twin::new(name, &stack, WAVELENGTHS_NM, color);
                let model = registry::model(name.name()).unwrap();
                for (wi, wo) in directions() {
                    let found = twin.eval(&grey, wi, wo);
                    let fine = twin.eval(&exact, wi, wo);
                    for (c, nm) in WAVELENGTHS_NM.into_iter().enumerate() {
                        let expected = model.eval(&Monochrome::new(&stack, nm, c), wi, wo);
                        assert!(expected > 1e-6, "{name}: {expected}");
                        assert!((found[c] / expected - 1.0).abs() < 1e-9, "{name}, {c}: {} for {expected}", found[c]);
                        // The models compute energies to 2e-3; finer ones are no other energies.
                        assert!((fine[c] / expected - 1.0).abs() < 5e-3, "{name}, {c}: {} for {expected}", fine[c]);
                    }
                }
            }
        }
    }

    /// Oracle: the model at each wavelength alone. Where nothing disperses, bending all channels alike changes nothing.
    #[test]
    fn exact_twins_are_the_models_at_three_wavelengths() {
        let metal = layer(
            Surface::isotropic(Distribution::Beckmann, 0.4),
            Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() },
        );
        let film = Film { ior: dispersive(1.6), thickness: FilmThickness { min_nm: 300.0, max_nm: 300.0 } };
        let filmed = Layer { films: vec![film], ..metal.clone() };
        let base = layer(Surface::smooth(), Base::Diffuse(Diffuse { albedo: [0.2, 0.5, 0.8], sigma: 0.3 }));
        let stack = |layers| Stack { exterior: Ior::vacuum(), layers };
        let plain = Ior::constant(1.5, 0.0).unwrap();
        let dispersive_coat = stack(vec![coat(dispersive(1.5)), base.clone()]);
        let cases = [
            (ShadingModel::Elek, stack(vec![coat(plain.clone()), metal.clone()])),
            (ShadingModel::WeidlichWilkie, stack(vec![coat(plain), metal])),
            (ShadingModel::Microfacet, stack(vec![filmed.clone()])),
            (ShadingModel::Microfacet, dispersive_coat.clone()),
            (ShadingModel::GranierHeidrich, stack(vec![filmed, base])),
            (ShadingModel::GranierHeidrich, dispersive_coat),
        ];
        for (name, stack) in cases {
            let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
            let twin = Twin::new(name, &stack, WAVELENGTHS_NM, color);
            let model = registry::model(name.name()).unwrap();
            for (wi, wo) in directions() {
                let found = twin.eval(&Exact::new(&stack, color), wi, wo);
                for (c, nm) in WAVELENGTHS_NM.into_iter().enumerate() {
                    let expected = model.eval(&Monochrome::new(&stack, nm, c), wi, wo);
                    assert!(expected > 1e-6, "{name}: {expected}");
                    assert!((found[c] / expected - 1.0).abs() < 1e-12, "{name}, {c}: {} for {expected}", found[c]);
                }
            }
        }
    }

    /// Dispersion moves what lies below a coat, channel by channel, but for the models whose shaders bend all alike.
    #[test]
    fn one_index_bends_all_channels() {
        let metal = Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() };
        let smooth = layer(Surface::isotropic(Distribution::Beckmann, 0.05), metal);
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![coat(dispersive(1.5)), smooth] };
        let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
        let twin = Twin::new(ShadingModel::WeidlichWilkie, &stack, WAVELENGTHS_NM, color);
        let (wi, wo) = directions()[1];
        let found = twin.eval(&Exact::new(&stack, color), wi, wo);
        let own = WeidlichWilkie::default().eval(&Monochrome::new(&stack, 645.0, 0), wi, wo);
        assert!((found[0] / own - 1.0).abs() > 1e-4, "{} {own}", found[0]);
    }
}
