//! The f64 twin of `luthier_eval_at`: a model with a shader, at one place of a surface that varies.

use std::cell::OnceCell;
use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use luthier_model::{Family, ModelPart, Reflectance, ShadingModel};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::ior::{Ior, IorSample};
use luthier_optics::schlick::DIELECTRIC_INDEX;
use luthier_optics::stack::{Base, Distribution, Film, FilmThickness, Layer, Stack, Surface};

use crate::effects::layer_sample::LayerSample;
use crate::effects::textured::TextureSample;
use crate::frame;
use crate::layers::ALPHA_MIN;
use crate::models::lobes::{self, Below, Cover, Fit, Lobes, Mix, Paint, Varied, Varying, base_below};
use crate::models::parts::{Chosen, Parts, Reflectances};
use crate::models::shade::ShaderTerms;
use crate::models::shade::Under;
use crate::models::statistics::diffuse_base::Veil;
use crate::models::statistics::energy::Energy;
use crate::terms::Terms;
use crate::twins::real_time::{Twin, seen_by};
use crate::twins::terms::Exact;

/// Values of textures and effects at one place of a surface: `LuthierPlace` of the shaders.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// Normal and factors.
    pub sample: TextureSample,
    /// Normals below the first interface.
    pub under: Under,
    /// Patina, or a coat with a weight; `None` for all layers, without the patina's diffuse term and tarnish.
    pub patina: Option<Growth>,
    /// Lobes of their own for the layers that such a coat, or a film, leaves bare; `None` where rows have both ends. Other models go by whether it is a film.
    pub side: Option<Side>,
    /// Albedo of a diffuse base; `None` leaves that of the material. Phong's coefficients do not follow it.
    pub base_color: Option<Rgb>,
    /// Rows of the matrix from light to light of a fluorescent base, see [`Twin::reradiating`]. They have no effect beside a base colour or patina.
    pub reradiation: Option<[Rgb; 3]>,
    /// Textures of single layers, from the top down; missing layers have none. Models show those of the layers that they read, and none beside patina.
    /// `phong` shows none. `lobes` shows slope parameters, F0 and the normals of the first layer, of the lowest interface and of a diffuse base; either side of
    /// a coat with a weight has the frame of its own first layer.
    pub layers: Vec<LayerSample>,
    /// Base of a `metallic-roughness` surface for `lobes`, which shows it as a mix of a metal and of a dielectric.
    pub metal: Option<Mix>,
}

impl Place {
    /// A place without textures and effects.
    pub const NONE: Self = Self {
        sample: TextureSample::NONE,
        under: Under::NONE,
        patina: None,
        side: None,
        base_color: None,
        reradiation: None,
        layers: Vec::new(),
        metal: None,
    };

    /// The weight of a coat or a film on layers that have lobes of their own, the place for all layers, and the place for those that are bare; `None` of
    /// another place.
    pub fn sides(&self) -> Option<(f64, Self, Self)> {
        let (weight, side) = (self.patina?.amount, self.side?);
        let coated = Self { patina: None, side: None, ..self.clone() };
        if side == Side::Film {
            let sample = TextureSample { film_factor: 1.0, ..self.sample };
            let bare = Self { sample, ..coated.clone() };
            return Some((weight, coated, bare));
        }
        let sample = TextureSample { slab_factor: 1.0, ..self.sample };
        let under = Under { flake_normal: DVec3::Z, ..self.under };
        let layers = self.layers.iter().skip(1).copied().collect();
        let bare = Self { sample, under, layers, ..coated.clone() };
        Some((weight, coated, bare))
    }
}

/// Index by which the interface of a `metallic-roughness` surface bends light, over that above, as a model sees it.
pub fn index_of_engine(model: ShadingModel) -> f64 {
    if model.is_fitted() { DIELECTRIC_INDEX } else { 1.0 }
}

/// Layers that a weight leaves bare, where these have lobes of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The layers below the first, a coat.
    Coat,
    /// The first layer, by the film on it.
    Film,
}

impl Side {
    /// The stack where it is bare.
    pub fn bare(self, stack: &Stack) -> Stack {
        match self {
            Self::Coat => stack.without_first(),
            Self::Film => stack.without_first_films(),
        }
    }

    /// Whether a stack has layers where it is bare.
    fn is_of(self, stack: &Stack) -> bool {
        self == Self::Film || stack.layers.len() > 1
    }
}

/// Patina at a place (Elek 2010, section 4.2): the first layer has grown over the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// Amount of patina, 0..=1, see [`Patina::amount`](crate::effects::patina::Patina::amount).
    pub amount: f64,
    /// Diffuse reflectance that stands for scattering in the patina.
    pub diffuse_albedo: Rgb,
    /// Slope parameter of the layer below grown patina; `None` leaves that layer unchanged.
    pub base_alpha: Option<f64>,
    /// Factor on the reflection of the layers below grown patina.
    pub tarnish: Rgb,
}

impl Growth {
    /// A coat that covers a share of the surface, held to 0..=1.
    pub fn of_coat(weight: f64) -> Self {
        let Cover { diffuse_albedo, base_alpha, tarnish } = Cover::PLAIN;
        Self { amount: weight.clamp(0.0, 1.0), diffuse_albedo, base_alpha, tarnish }
    }
}

/// A model with a shader, at one place, with exact terms or those of tables.
#[derive(Debug)]
pub struct Shaded<T = Exact> {
    place: Place,
    layers: PartTwin<T>,
    /// The layers below the first, or those without a film, for the part that is bare.
    bare: Option<PartTwin<T>>,
    /// Whether the model is `lobes`, whose light is linear in the amount of patina.
    has_lobes: bool,
    /// Share of a place that is metal in a mix, and the metal: of the model `lobes`.
    metal: Option<(f64, Box<Shaded<T>>)>,
    /// Weight of a coat, and the layers below it, where these have lobes of their own.
    side: Option<(f64, Box<Shaded<T>>)>,
}

/// Part of a stack that covers a place, wholly or in part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// All layers, without patina.
    All,
    /// All layers, with the patina fully grown.
    Grown,
    /// The layers below the patina, or those without a film.
    Bare,
}

/// The twin of a part, with its terms, and reflectances in place of those in the terms.
#[derive(Debug)]
struct PartTwin<T> {
    twin: Twin,
    terms: T,
    reflectances: Reflectances,
}

impl<T: ShaderTerms> PartTwin<T> {
    fn terms(&self) -> Chosen<'_> {
        self.reflectances.over(&self.terms)
    }
}

impl Shaded {
    /// The model at a place; `None` for a model without a shader. `color` is that of the terms: spectral as in the tables of the baked form, or three
    /// wavelengths as in the form without tables. Belcour's and Yamaguchi's models have the energies of rough interfaces, as in the baked form. Over a
    /// diffuse base they have the veil of layers of nominal thickness and slope, because a material's record has no other.
    ///
    /// Effects are those of the model's shader: flakes and patina in `elek`, `weidlich-wilkie` and `lobes`, deviated films in `granier-heidrich`. `lobes`
    /// shows patina unless its rows are over something else: a film that varies, or the azimuth of an anisotropic stack.
    pub fn new(
        model: ShadingModel,
        stack: &Stack,
        wavelengths_nm: [f64; 3],
        color: Color,
        place: &Place,
    ) -> Option<Self> {
        Self::fitted_by(&Varied::of, model, stack, wavelengths_nm, color, place)
    }

    /// [`Self::new`] with parts that a material chooses. Curves in place of reflectances have the colour `color`.
    pub fn with(
        model: ShadingModel,
        stack: &Stack,
        wavelengths_nm: [f64; 3],
        color: Color,
        place: &Place,
        parts: Parts,
    ) -> Option<Self> {
        Self::exact(&Varied::of, model, stack, wavelengths_nm, color, place, parts)
    }

    /// [`Self::new`] with lobes from a function that fits them, for a model with lobes.
    pub fn fitted_by(
        fit: &Fit<'_>,
        model: ShadingModel,
        stack: &Stack,
        wavelengths_nm: [f64; 3],
        color: Color,
        place: &Place,
    ) -> Option<Self> {
        Self::exact(fit, model, stack, wavelengths_nm, color, place, Parts::PLAIN)
    }

    /// [`Self::eval`] of [`frame::each_pair`], three values each. It is not generic, so that the loop is compiled as this crate is, and not as its caller.
    pub fn eval_pairs(&self, wi: &[[f64; 3]], wo: &[[f64; 3]], values: &mut [f64]) {
        for ([wi, wo], row) in frame::each_pair(wi, wo).zip(values.chunks_exact_mut(3)) {
            row.copy_from_slice(&self.eval(wi, wo));
        }
    }

    fn exact(
        fit: &Fit<'_>,
        model: ShadingModel,
        stack: &Stack,
        wavelengths_nm: [f64; 3],
        color: Color,
        place: &Place,
        parts: Parts,
    ) -> Option<Self> {
        let stack = &*seen_by(model, stack);
        let side = place.side.filter(|side| model.is_fitted() && side.is_of(stack));
        if let Some((side, (weight, coated, bare))) = side.zip(place.sides()) {
            let exact =
                |stack: &Stack, place: &Place| Self::exact(fit, model, stack, wavelengths_nm, color, place, parts);
            return Some(exact(stack, &coated)?.beside(weight, exact(&side.bare(stack), &bare)?));
        }
        if let (true, Some(mix), Some(_)) = (model.is_fitted(), place.metal, base_below(stack)) {
            let paint = Paint::of(stack).mixed(mix);
            let layers = place.layers.iter().map(|own| LayerSample { f0: None, ..*own }).collect();
            let of_plastic = Place { metal: None, base_color: Some(paint.albedo), layers, ..place.clone() };
            let of_metal = Place { base_color: None, ..of_plastic.clone() };
            let exact =
                |stack: &Stack, place: &Place| Self::exact(fit, model, stack, wavelengths_nm, color, place, parts);
            if mix.metallic >= 1.0 {
                return exact(&paint.metal_of(stack), &of_metal);
            }
            let plastic = exact(&paint.plastic_of(stack), &of_plastic)?;
            let metal = if mix.metallic > 0.0 {
                Some((mix.metallic, Box::new(exact(&paint.metal_of(stack), &of_metal)?)))
            } else {
                None
            };
            return Some(Self { metal, ..plastic });
        }
        let ends: OnceCell<Vec<Lobes>> = OnceCell::new();
        let terms = |part: Part, here: &Stack, whole: &Stack| {
            if !model.is_fitted() || part == Part::All && Interface::of(here, 0).is_none() {
                let terms = Exact::new(here, color);
                return Some(if model.is_statistical() { terms.veiled_by(stack) } else { terms });
            }
            let lobes = match (part, place.patina) {
                (Part::All, _) | (_, None) => fit(here, &color, None).nominal(),
                (_, Some(Growth { diffuse_albedo, base_alpha, tarnish, .. })) => {
                    let over = Varying::Patina(Cover { diffuse_albedo, base_alpha, tarnish });
                    let nodes = ends.get_or_init(|| fit(whole, &color, Some(over)).nodes);
                    let before_last = usize::from(part == Part::Grown);
                    nodes.iter().rev().nth(before_last)?.clone()
                }
            };
            Some(Exact::with_lobes(here, color, lobes))
        };
        Self::of_terms(terms, model, stack, wavelengths_nm, color, place, parts)
    }
}

impl<T: ShaderTerms> Shaded<T> {
    /// [`Shaded::with`] with terms of any source. `terms` gets a part, the stack of this part at the place, and the stack of all layers there.
    pub fn of_terms(
        terms: impl Fn(Part, &Stack, &Stack) -> Option<T>,
        model: ShadingModel,
        stack: &Stack,
        wavelengths_nm: [f64; 3],
        color: Color,
        place: &Place,
        parts: Parts,
    ) -> Option<Self> {
        let is_shown = model.is_path() || model.is_fitted() && !is_over_another(stack);
        // Two surfaces with lobes of their own are no ends of one: `Self::beside`.
        let side = place.side.filter(|side| *side == Side::Film && model.is_path()).unwrap_or(Side::Coat);
        let patina = place.patina.filter(|_| is_shown && side.is_of(stack));
        let reradiation = place.reradiation.filter(|_| place.base_color.is_none() && patina.is_none());
        let whole = at(stack, model, place, patina);
        let own: Vec<DVec3> = place.layers.iter().map(|layer| layer.normal).collect();
        // Lobes have the frame of the first interface.
        let (normal, own) = match (model.is_fitted(), patina) {
            (false, _) => (place.sample.normal, own),
            (true, None) => frame::on_first(place.sample.normal, &own, stack.layers.len()),
            (true, Some(_)) => (place.sample.normal, Vec::new()),
        };
        let layers = |part: Part, here: &Stack| {
            // The variance of normals widens fitted lobes one by one; the first interface, which is beside them, is widened here.
            let mut first = here.clone();
            if model.is_fitted() {
                first.layers.iter_mut().for_each(|layer| widen(&mut layer.surface, &place.sample));
            }
            // The twin takes chosen reflectances from its terms, because tarnish dims these, too.
            let facets = Parts { reflectance: Reflectance::Table, ..parts };
            let above = usize::from(part == Part::Bare && side == Side::Coat);
            let normals = own.iter().skip(above).copied().collect();
            let twin =
                Twin::with(model, &first, wavelengths_nm, color, facets).reradiating(reradiation).tilting(normals);
            let reflectance = if model.takes(ModelPart::Reflectance) { parts.reflectance } else { Reflectance::Table };
            let reflectances = Reflectances::of(here, wavelengths_nm, color, reflectance);
            Some(PartTwin { twin, terms: terms(part, here, &whole)?, reflectances })
        };
        let (all, bare) = match patina {
            None => (layers(Part::All, &whole)?, None),
            Some(_) => (layers(Part::Grown, &whole)?, Some(layers(Part::Bare, &side.bare(&whole))?)),
        };
        let under = Under { slope_variance: place.sample.slope_variance, base_color: place.base_color, ..place.under };
        let sample = TextureSample { normal, ..place.sample };
        let place = Place { sample, patina, under, ..place.clone() };
        Some(Self { place, layers: all, bare, has_lobes: model.is_fitted(), metal: None, side: None })
    }

    /// The surface where it covers a share of the place as a coat, beside that of the layers below it.
    #[must_use]
    pub fn beside(self, weight: f64, bare: Self) -> Self {
        Self { side: Some((weight, Box::new(bare))), ..self }
    }

    /// Radiance under light of a colour, see [`Twin::eval_lit`]. Places with patina have no fluorescent base.
    pub fn eval_lit(&self, light: Rgb, wi: DVec3, wo: DVec3) -> Rgb {
        let [wi_here, wo_here] = [wi, wo].map(|w| frame::local(self.place.sample.normal, w));
        if self.bare.is_some() || [wi, wo, wi_here, wo_here].iter().any(|w| w.z <= 0.0) {
            let plain = self.eval(wi, wo);
            return [0, 1, 2].map(|c| plain[c] * light[c]);
        }
        self.layers.twin.eval_lit(&self.layers.terms(), &self.place.under, light, wi_here, wo_here)
    }

    /// `f cos_theta_i`, RGB, with the cosine against the place's normal. It is zero if either direction is at or below the horizon of the surface or of
    /// the place.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        let mut value = self.eval_unmixed(wi, wo);
        if let Some((share, metal)) = &self.metal {
            let metal = metal.eval_unmixed(wi, wo);
            value = [0, 1, 2].map(|c: usize| value[c] + share * (metal[c] - value[c]));
        }
        let Some((weight, bare)) = &self.side else { return value };
        let bare = bare.eval(wi, wo);
        [0, 1, 2].map(|c: usize| weight * value[c] + (1.0 - weight) * bare[c])
    }

    fn eval_unmixed(&self, wi: DVec3, wo: DVec3) -> Rgb {
        let normal = self.place.sample.normal;
        let [wi_here, wo_here] = [wi, wo].map(|w| if normal == DVec3::Z { w } else { frame::local(normal, w) });
        if [wi, wo, wi_here, wo_here].iter().any(|w| w.z <= 0.0) {
            return [0.0; 3];
        }
        let (wi, wo, under) = (wi_here, wo_here, &self.place.under);
        let (twin, terms) = (&self.layers.twin, &self.layers.terms());
        let (Some(patina), Some(bare)) = (&self.place.patina, &self.bare) else {
            return twin.eval_over(terms, under, wi, wo);
        };
        let amount = patina.amount;
        if let Some(variance) = self.has_lobes.then_some(under.slope_variance) {
            // The lobes of grown patina include scattering and tarnish.
            let covered = twin.eval_over(terms, under, wi, wo);
            let bare = bare.twin.eval_over(&bare.terms, &Under { slope_variance: variance, ..Under::NONE }, wi, wo);
            return [0, 1, 2].map(|c: usize| amount * covered[c] + (1.0 - amount) * bare[c]);
        }
        let dull = patina.tarnish.map(|tarnish| 1.0 + (tarnish - 1.0) * amount);
        let passed = terms.fresnel(0, frame::cos_theta_d(wi, wo)).map(|reflected| 1.0 - reflected);
        let mut value = [0, 1, 2].map(|c| amount * passed[c] * patina.diffuse_albedo[c] * FRAC_1_PI * wi.z);
        // Without its film the first layer is still there, and so are its flakes.
        let under_bare = if self.place.side == Some(Side::Film) { under } else { &Under::NONE };
        let ends = [(1.0 - amount, bare, dull, under_bare), (amount, &self.layers, [1.0; 3], under)];
        for (share, layers, first, under) in ends.into_iter().filter(|(share, ..)| *share > 0.0) {
            let tarnished = Tarnished { terms: layers.terms(), first, below: dull };
            let part = layers.twin.eval_over(&tarnished, under, wi, wo);
            (0..3).for_each(|c| value[c] += share * part[c]);
        }
        value
    }
}

impl Place {
    /// The stack of a material file at the place, without patina: with factors on slope parameters, slab and film, and with the albedo of a diffuse base.
    /// Rows of lobes stand for the simulation of this stack.
    ///
    /// Where the base is a mix of a metal and a dielectric, it is the one with the larger share.
    pub fn stack(&self, stack: &Stack) -> Stack {
        if let (Some(mix), Some(_)) = (self.metal, base_below(stack)) {
            let paint = Paint::of(stack).mixed(mix);
            let layers = self.layers.iter().map(|own| LayerSample { f0: None, ..*own }).collect();
            let plain = Self { metal: None, base_color: None, layers, ..self.clone() }.stack(stack);
            return if mix.metallic >= 0.5 { paint.metal_of(&plain) } else { paint.plastic_of(&plain) };
        }
        let mut here = at(stack, ShadingModel::Lobes, self, None);
        let base = here.layers.last_mut().map(|layer| &mut layer.base);
        if let (Some(color), Some(Base::Diffuse(base))) = (self.base_color, base) {
            base.albedo = color;
        }
        here
    }
}

/// Whether rows of lobes are over something else than patina: an azimuth, or the thickness of a film.
fn is_over_another(stack: &Stack) -> bool {
    let film = stack.layers.first().and_then(|layer| layer.films.first());
    stack.layers.iter().any(Layer::is_anisotropic) || film.is_some_and(Film::varies)
}

/// Widens a surface by the variance of the normals in a pixel.
fn widen(surface: &mut Surface, sample: &TextureSample) {
    if sample.slope_variance > 0.0 {
        for alpha in [&mut surface.alpha_x, &mut surface.alpha_y] {
            *alpha = sample.widened(alpha.clamp(ALPHA_MIN, 1.0)).clamp(ALPHA_MIN, 1.0);
        }
    }
}

/// The stack of a model's shader at a place.
fn at(stack: &Stack, model: ShadingModel, place: &Place, patina: Option<Growth>) -> Stack {
    let factors = &place.sample;
    if model.is_fitted() {
        let mut here = Varying::Alpha.apply(&lobes::shown(stack), factors.alpha_factor);
        // A bare base has a closed form. A base below interfaces is in the lobes, which `Under` recolours.
        if let ([Layer { base: Base::Diffuse(base), .. }], Some(color)) = (here.layers.as_mut_slice(), place.base_color)
        {
            base.albedo = color;
        }
        let is_family = place.layers.iter().any(LayerSample::has_slopes_or_f0);
        for (number, layer) in here.layers.iter_mut().enumerate().filter(|_| is_family) {
            let own = place.layers.get(number).unwrap_or(&LayerSample::NONE);
            own.apply(layer);
            layer.surface = lobes::scaled_along(layer.surface, own.alpha_factors);
            // Lobes of a family are those of the base in its colour.
            if let (Base::Diffuse(base), Some(color)) = (&mut layer.base, place.base_color) {
                base.albedo = color;
            }
        }
        // A family has tinted its slabs above. Other rows are over what the first one absorbs.
        let first = here.layers.first_mut().zip(place.layers.first()).filter(|_| !is_family);
        if let Some((Layer { base: Base::Dielectric { slab, .. }, .. }, own)) = first {
            own.tint(slab);
        }
        let mut here = Varying::Slab.apply(&here, factors.slab_factor);
        for film in here.layers.iter_mut().filter_map(|layer| layer.films.first_mut()).filter(|film| film.varies()) {
            let nm = factors.film_factor * film.thickness.nominal_nm();
            film.thickness = FilmThickness { min_nm: nm, max_nm: nm };
        }
        return here;
    }
    // The material buffer has Phong's coefficients for the nominal stack.
    let shows_place = model.facts().family != Family::Coefficients;
    let mut here = stack.clone();
    if let (Some(color), Some(Base::Diffuse(base))) =
        (place.base_color, here.layers.last_mut().map(|layer| &mut layer.base))
    {
        base.albedo = if shows_place { color } else { base.albedo };
    }
    for (i, layer) in here.layers.iter_mut().enumerate() {
        let base_alpha = patina.filter(|_| i == 1).and_then(|p| Some((p.base_alpha?, p.amount)));
        let own = place.layers.get(i).filter(|_| shows_place).unwrap_or(&LayerSample::NONE);
        own.apply(layer);
        if factors.alpha_factor == 1.0
            && factors.slope_variance == 0.0
            && base_alpha.is_none()
            && own.alpha_factors == [1.0; 2]
        {
            continue;
        }
        if model == ShadingModel::Elek {
            layer.surface = Surface::isotropic(layer.surface.distribution, layer.surface.alpha_isotropic());
        }
        let one = own.alpha_factor();
        let both = if is_isotropic(model, &layer.surface) { [one; 2] } else { own.alpha_factors };
        for (alpha, own) in [&mut layer.surface.alpha_x, &mut layer.surface.alpha_y].into_iter().zip(both) {
            // As in shaders: records hold clamped slope parameters, and factors act on these.
            *alpha = factors.widened(alpha.clamp(ALPHA_MIN, 1.0) * (factors.alpha_factor * own)).clamp(ALPHA_MIN, 1.0);
            if let Some((base_alpha, amount)) = base_alpha {
                *alpha += (base_alpha - *alpha) * amount;
            }
        }
    }
    if let Some(layer) = here.layers.first_mut().filter(|_| shows_place) {
        for film in &mut layer.films {
            film.thickness.min_nm *= factors.film_factor;
            film.thickness.max_nm *= factors.film_factor;
        }
        if let Base::Dielectric { slab, .. } = &mut layer.base {
            slab.thickness_um *= factors.slab_factor;
        }
    }
    here
}

/// Whether a model reads one slope parameter of a surface.
fn is_isotropic(model: ShadingModel, surface: &Surface) -> bool {
    model.facts().is_isotropic && surface.alpha_x == surface.alpha_y
}

/// The stack with its indices at one wavelength held for all. Its shaders then bend directions by these indices, not by those of the common
/// wavelength.
pub fn at_wavelength(stack: &Stack, wavelength_nm: f64) -> Stack {
    let mut here = stack.clone();
    hold(&mut here.exterior, wavelength_nm);
    for layer in &mut here.layers {
        layer.films.iter_mut().for_each(|film| hold(&mut film.ior, wavelength_nm));
        if let Base::Dielectric { ior, .. } | Base::Conductor { ior } = &mut layer.base {
            hold(ior, wavelength_nm);
        }
    }
    here
}

/// Holds an index at its value at one wavelength.
fn hold(ior: &mut Ior, wavelength_nm: f64) {
    let here = ior.at(wavelength_nm);
    // A valid index is valid at every single wavelength.
    if let Ok(still) = ior.with_samples(vec![IorSample { wavelength_nm, n: here.re, k: here.im }]) {
        *ior = still;
    }
}

/// Terms with dimmed reflectances, by one factor for the first layer and another for the layers below.
struct Tarnished<'a> {
    terms: Chosen<'a>,
    first: Rgb,
    below: Rgb,
}

impl Terms for Tarnished<'_> {
    fn fresnel(&self, layer: usize, cos_theta_d: f64) -> Rgb {
        let factor = if layer == 0 { self.first } else { self.below };
        let bright = self.terms.fresnel(layer, cos_theta_d);
        [0, 1, 2].map(|c| factor[c] * bright[c])
    }

    fn distribution(&self, layer: usize, d: Distribution, alpha: f64, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        self.terms.distribution(layer, d, alpha, cos_theta_h, sin_theta_h_sq)
    }
}

impl Energy<3> for Tarnished<'_> {
    fn fgd(&self, layer: usize, cos_theta_i: f64, alpha: f64) -> Rgb {
        self.terms.fgd(layer, cos_theta_i, alpha)
    }
}

impl ShaderTerms for Tarnished<'_> {
    fn veil(&self) -> Veil<3> {
        self.terms.veil()
    }

    fn below(&self, wo: DVec3) -> Option<Below> {
        self.terms.below(wo)
    }
}

#[cfg(test)]
mod tests;
