//! Exact values of the terms of shaders.

use std::sync::OnceLock;

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::{Interface, Sampled};
use luthier_optics::schlick::{F82, edge_dip};
use luthier_optics::stack::{Base, Stack};

use crate::layers::Layers;
use crate::models::lobes::{Below, Lobes, Varied, Varying};
use crate::models::shade::ShaderTerms;
use crate::models::statistics::diffuse_base::Veil;
use crate::models::statistics::energy::{ColorEnergy, Energy};
use crate::terms::Terms;

/// Exact terms. Fresnel and distribution terms are evaluated at every call. Energies ([`ColorEnergy`]) are computed at their first use, and lobes are
/// simulated at theirs ([`Varied::of`]).
#[derive(Debug, Clone)]
pub struct Exact {
    stack: Stack,
    color: Color,
    interfaces: Vec<Option<Sampled>>,
    energies: Energies,
    varying: Option<Varying>,
    lobes: OnceLock<Lobes>,
    /// The stack whose layers veil a diffuse base, if it is another one.
    nominal: Option<Box<Exact>>,
    /// Terms of the stack without its first layer, if that covers a share of it.
    bare: Option<Box<Exact>>,
}

#[derive(Debug, Clone)]
enum Energies {
    Facets(OnceLock<(ColorEnergy, Veil<3>)>),
    Level(Veil<3>),
}

impl Exact {
    /// The terms of a stack, in the given colour mode.
    pub fn new(stack: &Stack, color: Color) -> Self {
        Self::with(stack, color, Energies::Facets(OnceLock::new()))
    }

    /// The terms of a stack with the energies of shaders without tables: facets count as level, and nothing of a lobe is totally reflected. `veil` is the
    /// effect of layers on a diffuse base in the material's record.
    pub fn level(stack: &Stack, color: Color, veil: Veil<3>) -> Self {
        Self::with(stack, color, Energies::Level(veil))
    }

    /// The terms of a stack whose lobes are fitted together with those at other factors of what varies.
    pub fn varying(stack: &Stack, color: Color, varying: Option<Varying>) -> Self {
        Self { varying, ..Self::new(stack, color) }
    }

    /// The terms with those of a stack beside them ([`ShaderTerms::bare`]): the one without the first layer, or without the film on it. Where the terms vary
    /// with the amount of the first layer, lobes of both are fitted together. Else lobes of the bare stack are fitted with those at other factors of what
    /// varies there.
    #[must_use]
    pub fn over_bare(self, bare: &Stack, varying: Option<Varying>) -> Self {
        Self { bare: Some(Box::new(Self::varying(bare, self.color, varying))), ..self }
    }

    /// The terms of the layers below the first, if they are beside these and have lobes of their own.
    pub fn side(&self) -> Option<&Self> {
        self.bare.as_deref().filter(|_| !matches!(self.varying, Some(Varying::Patina(_))))
    }

    /// The terms with the tables and the record of a nominal stack, as in shaders. The record has the veil of a diffuse base for layers of nominal
    /// thickness and slope. Tables have energies for the nominal F0. For another F0, the light that is not reflected is scaled by a constant factor;
    /// what an edge tint keeps is taken off as at a level facet.
    #[must_use]
    pub(crate) fn veiled_by(mut self, nominal: &Stack) -> Self {
        let is_other = self.stack != *nominal;
        self.nominal = is_other.then(|| Box::new(Self::new(nominal, self.color)));
        self
    }

    /// The terms of a stack with given lobes.
    pub fn with_lobes(stack: &Stack, color: Color, lobes: Lobes) -> Self {
        Self { lobes: OnceLock::from(lobes), ..Self::new(stack, color) }
    }

    fn with(stack: &Stack, color: Color, energies: Energies) -> Self {
        let interfaces = (0..stack.layers.len())
            .map(|i| Interface::of(stack, i).map(|interface| interface.sampled(&color)))
            .collect();
        let (varying, lobes, nominal, bare) = (None, OnceLock::new(), None, None);
        Self { stack: stack.clone(), color, interfaces, energies, varying, lobes, nominal, bare }
    }

    /// The lobes of the stack.
    pub fn lobes(&self) -> &Lobes {
        self.lobes_by(&|| Varied::of(&self.stack, &self.color, self.varying).ends())
    }

    /// Takes lobes from a function, in place of a fit, unless the terms have some already: what [`Varied::ends`] returns.
    pub fn take_lobes(&self, ends: &dyn Fn() -> (Lobes, Option<Lobes>)) {
        self.lobes_by(ends);
    }

    fn lobes_by(&self, ends: &dyn Fn() -> (Lobes, Option<Lobes>)) -> &Lobes {
        self.lobes.get_or_init(|| {
            let (lobes, of_bare) = ends();
            if let (Some(bare), Some(of_bare)) = (&self.bare, of_bare) {
                bare.lobes.get_or_init(|| of_bare);
            }
            lobes
        })
    }

    /// The inputs of the fit of lobes: the stack, its colour, and what varies.
    pub fn fitted(&self) -> (&Stack, &Color, &Option<Varying>) {
        (&self.stack, &self.color, &self.varying)
    }

    /// Curves of a Schlick interface here and in the nominal stack, whose energies are in tables.
    fn f0(&self, layer: usize) -> Option<[[F82; 3]; 2]> {
        let nominal = &self.nominal.as_ref()?.stack;
        let [here, nominal] = [Interface::of(&self.stack, layer)?, Interface::of(nominal, layer)?];
        if !here.films.is_empty() {
            return None;
        }
        Some([here.below.f82_rgb()?, nominal.below.f82_rgb()?])
    }

    /// The stack whose energies are in tables: this one, with the F0 of the nominal stack.
    fn tabulated(&self) -> Stack {
        let mut stack = self.stack.clone();
        for (number, layer) in stack.layers.iter_mut().enumerate() {
            if let (Base::Dielectric { ior, .. } | Base::Conductor { ior }, Some([_, nominal])) =
                (&mut layer.base, self.f0(number))
            {
                *ior = ior.clone().with_f82(nominal);
            }
        }
        stack
    }

    fn facets<'a>(&self, prepared: &'a OnceLock<(ColorEnergy, Veil<3>)>) -> &'a (ColorEnergy, Veil<3>) {
        prepared.get_or_init(|| {
            let energy = ColorEnergy::new(&self.tabulated(), self.color);
            let veil = match &self.nominal {
                Some(nominal) => nominal.veil(),
                None => Veil::new(&Layers::rgb(&self.stack), &energy).unwrap_or(Veil::NONE),
            };
            (energy, veil)
        })
    }
}

impl Terms for Exact {
    /// Lobes may have a reflectance of the first interface of their own.
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        if let Some(curve) = self.lobes.get().and_then(|lobes| lobes.frame.curve).filter(|_| layer == 0) {
            return [curve.at(cos_theta_d); 3];
        }
        self.interfaces.get(layer).and_then(Option::as_ref).map_or([0.0; 3], |i| i.rgb(cos_theta_d))
    }
}

impl Energy<3> for Exact {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> Rgb {
        match &self.energies {
            Energies::Facets(prepared) => {
                let given = self.facets(prepared).0.fgd(layer, cos_theta_i, alpha);
                let Some([here, nominal]) = self.f0(layer) else { return given };
                [0, 1, 2].map(|c: usize| {
                    let passing = (1.0 - here[c].f0) / (1.0 - nominal[c].f0).max(1e-6);
                    // An edge tint is taken off as at a level facet.
                    let dip = (here[c].dip() - passing * nominal[c].dip()) * edge_dip(cos_theta_i);
                    if dip == 0.0 {
                        return 1.0 - passing * (1.0 - given[c]);
                    }
                    (1.0 - passing * (1.0 - given[c]) - dip).max(0.0)
                })
            }
            Energies::Level(_) => self.fresnel(layer, cos_theta_i),
        }
    }

    fn escaping(&self, layer: usize, cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
        match &self.energies {
            Energies::Facets(prepared) => self.facets(prepared).0.escaping(layer, cos_theta_i, alpha, eta),
            Energies::Level(_) => 1.0,
        }
    }
}

impl ShaderTerms for Exact {
    fn veil(&self) -> Veil<3> {
        match &self.energies {
            Energies::Facets(prepared) => self.facets(prepared).1,
            Energies::Level(veil) => *veil,
        }
    }

    fn below(&self, wo: DVec3) -> Option<Below> {
        self.lobes().below(wo)
    }

    fn bare(&self) -> Option<&dyn ShaderTerms> {
        if let (Some(_), Some(Varying::Patina(_))) = (&self.bare, self.varying) {
            self.lobes();
        }
        self.bare.as_deref().map(|bare| bare as &dyn ShaderTerms)
    }
}
