//! The validated material, with the places of its values in the file.

use std::borrow::Cow;

use luthier_model::{Family, ModelPart};
use luthier_optics::Rgb;
use luthier_optics::brightening::Brightening;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Film, Layer, Stack};

use luthier_manifest::{BeamsRecord, Budget, ColorMode, DiffuseTerm, LowerReflectance, MapSlot, ShadingModel};

use crate::bake_settings::{BakeSettings, Beams};
use crate::class::SurfaceClass;
use crate::diagnostic::{Diagnostic, Severity, Sink};
use crate::effects::{Effects, FlakeSource};
use crate::picture::{PictureRef, TexelUse, VariationSource};
use crate::places::Places;

/// A validated material.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name: letters, digits and hyphens.
    pub name: String,
    /// Label of the file that it was read from.
    pub source: String,
    /// Text of that file.
    pub text: String,
    /// The files that it names, by their paths relative to itself: indices and images, each once, sorted.
    pub files: Vec<String>,
    /// One or two sentences; empty when the file has none.
    pub description: String,
    /// Sources of the numbers.
    pub references: Vec<String>,
    /// The physics: interfaces from the top down.
    pub stack: Stack,
    /// Properties of each layer beyond physics; parallel to `stack.layers`. Only a base re-radiates.
    pub layers: Vec<LayerExtras>,
    /// Effects on top of the layered model.
    pub effects: Effects,
    /// Settings that the file asks of its tables.
    pub bake: BakeSettings,
    /// Limits on the error, bytes and cost of its tables.
    pub budget: Budget,
    /// Class of the surface.
    pub class: SurfaceClass,
    /// Where its values stand in the text.
    pub places: Places,
}

/// An image that a material names.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedImage<'m> {
    /// The key that names it, as in [`Places`].
    pub key: String,
    /// The picture.
    pub picture: &'m PictureRef,
    /// Meaning of its texels.
    pub texels: TexelUse,
}

impl Material {
    /// A diagnostic about a value of the file, for callers that know more than this crate; see [`Places`] for keys.
    pub fn diagnostic(
        &self,
        severity: Severity,
        key: &str,
        message: impl Into<String>,
        hint: Option<String>,
    ) -> Diagnostic {
        Sink::one(&self.source, &self.text, severity, self.places.span(key), message.into(), hint)
    }

    /// Sets the model, and drops parts of other models that the file chooses: for comparisons of models.
    pub fn shade_by(&mut self, model: ShadingModel) {
        self.bake.model = Some(model);
        self.bake.masking = self.bake.masking.filter(|masking| model.takes_masking(*masking));
        self.bake.reflectance = self.bake.reflectance.filter(|_| model.takes(ModelPart::Reflectance));
        self.bake.internal_reflection = self.bake.internal_reflection.filter(|_| model.is_path());
        self.bake.lower_reflectance = self.bake.lower_reflectance.filter(|_| model.is_path());
        self.bake.lower_cosine = self.bake.lower_cosine.filter(|_| model.takes(ModelPart::LowerCosine));
        self.bake.lower_facets = self.bake.lower_facets.filter(|_| model.takes(ModelPart::LowerFacets));
        self.bake.lower_alpha = self.bake.lower_alpha.filter(|_| model.takes(ModelPart::LowerAlpha));
        self.bake.diffuse_part = self.bake.diffuse_part.filter(|_| model.takes(ModelPart::DiffusePart));
        self.bake.diffuse_term = self.bake.diffuse_term.filter(|_| model.takes(ModelPart::DiffuseTerm));
        if !model.takes(ModelPart::Beams) {
            self.bake.beams = None;
            self.layers.iter_mut().for_each(|layer| (layer.exponents, layer.maps.lean) = (None, None));
        }
    }

    /// Whether the light of its diffuse base is added to that of the first interface, which its model reads alone.
    pub fn adds_base(&self) -> bool {
        self.bake.diffuse_term == Some(DiffuseTerm::Added)
    }

    /// The colour of its tables: spectral, unless its file asks otherwise.
    pub fn color(&self) -> Color {
        match self.bake.color.unwrap_or_default() {
            ColorMode::Spectral => Color::Spectral,
            ColorMode::ThreeWavelengths => Color::ThreeWavelengths(self.bake.wavelengths_nm()),
        }
    }

    /// The stack as its model sees it.
    pub fn reflecting_stack(&self) -> Cow<'_, Stack> {
        self.stack_of(self.model())
    }

    /// The stack as a model sees it: with lower interfaces that reflect as in air if the file says so; and with a `metallic-roughness` surface that light crosses
    /// once ([`Stack::crossed_once`]), unless its light is simulated, or coefficients of the stack stand for it.
    pub fn stack_of(&self, model: ShadingModel) -> Cow<'_, Stack> {
        let is_in_air = model.is_path() && self.bake.lower_reflectance == Some(LowerReflectance::InAir);
        let here = if is_in_air { Cow::Owned(self.stack.with_lower_in_air()) } else { Cow::Borrowed(&self.stack) };
        let is_whole = model.is_fitted() || model.facts().family == Family::Coefficients;
        if is_whole || !here.bends_in_engine() { here } else { Cow::Owned(here.crossed_once()) }
    }

    /// Numbers of the model `granier-heidrich`, if the file gives some that differ from [`BeamsRecord::PLAIN`].
    pub fn beams(&self) -> Option<BeamsRecord> {
        let Beams { specular_weight, diffuse_weight, inner_tilt, inner_azimuth, lobe_height } =
            self.bake.beams.unwrap_or_default();
        let exponents = self.layers.first().and_then(|first| first.exponents);
        let (sin, cos) = (libm::sin(inner_tilt), libm::cos(inner_tilt));
        let beams = BeamsRecord {
            inner_alpha_ratio: exponents.map_or(1.0, |[outer, inner]| libm::sqrt((outer + 2.0) / (inner + 2.0))),
            specular_weight,
            diffuse_weight,
            inner_normal: [sin * libm::cos(inner_azimuth), sin * libm::sin(inner_azimuth), cos],
            lobe_height,
        };
        (beams != BeamsRecord::PLAIN).then_some(beams)
    }

    /// File and line of a value: `gilding.toml:8`.
    pub fn place(&self, key: &str) -> String {
        let Diagnostic { label, line, .. } = self.diagnostic(Severity::Error, key, "", None);
        format!("{label}:{line}")
    }

    /// Weight of its first layer, a coat, or of the film on it, if that is below 1 or a map multiplies it.
    pub fn weight(&self) -> Option<f64> {
        let first = self.layers.first()?;
        (first.weight < 1.0 || first.varies(MapSlot::Weight)).then_some(first.weight)
    }

    /// Whether its weight is that of the film on the first layer.
    pub fn weighs_film(&self) -> bool {
        self.layers.first().is_some_and(|first| first.weighs_film)
    }

    /// Number of a layer whose film only `lobes` shows: a film on a base whose maps give each place an F0, or one that varies below the first layer.
    pub fn film_of_lobes(&self) -> Option<usize> {
        let mut layers = self.layers.iter().zip(&self.stack.layers).enumerate();
        let found = layers.find(|(number, (extras, layer))| {
            let varies = layer.films.first().is_some_and(Film::varies);
            !layer.films.is_empty() && extras.varies_f0() || varies && *number > 0
        });
        found.map(|(number, _)| number)
    }

    /// Whether the film on its base has closed forms in the F0 there and in its thickness, see [`Self::family`].
    pub fn has_closed_film(&self) -> bool {
        self.family().is_some_and(|family| family.is_filmed)
    }

    /// A stack of it where a weight leaves it bare: without its first layer, or without the film on that.
    pub fn bare(&self, stack: &Stack) -> Stack {
        if self.weighs_film() { stack.without_first_films() } else { stack.without_first() }
    }

    /// Shares of its light that its base gets back from a coat that does not darken it.
    pub fn brightening(&self) -> Option<Brightening> {
        self.layers.iter().find_map(|layer| layer.brightening)
    }

    /// Whether its first layer leaves the others bare in places: a patina, or a coat with a weight; or a film leaves the first layer bare.
    pub fn is_bare_in_places(&self) -> bool {
        (self.stack.layers.len() > 1 || self.weighs_film())
            && (self.effects.patina.is_some() || self.weight().is_some())
    }

    /// Whether the layers below its first one, a coat with a weight, make lobes of their own in the model `lobes`: textures vary the surface in more than the
    /// weight, or a layer is anisotropic. Else rows of all layers have those of the bare ones at their end.
    pub fn has_side(&self) -> bool {
        let layers = &self.stack.layers;
        if self.weight().is_none() || self.effects.patina.is_some() {
            return false;
        }
        if self.weighs_film() || layers.len() < 2 {
            return self.weighs_film();
        }
        let first = &self.layers[0];
        self.family().is_some()
            || first.varies(MapSlot::Roughness)
            || first.varies_slab()
            || layers[0].films.first().is_some_and(Film::varies)
            || layers.iter().any(Layer::is_anisotropic)
            // Own normals make a frame for each of the two surfaces.
            || self.layers.iter().any(|layer| layer.varies(MapSlot::Albedo) || layer.varies(MapSlot::Bumps))
            // Flakes lie below the coat alone.
            || self.effects.flakes.is_some() && layers.len() > 2
    }

    /// The layers below its first one as a material of the model `lobes`, if that is its model, and they make lobes of their own: see [`Self::has_side`].
    pub fn side(&self) -> Option<Self> {
        let model = self.model();
        if !self.has_side() || !model.is_fitted() {
            return None;
        }
        let mut side = self.clone();
        side.bake.model = Some(model);
        if self.weighs_film() {
            side.stack = self.bare(&self.stack);
            let first = side.layers.first_mut()?;
            (first.weight, first.weighs_film, first.maps.weight, first.film_variation) = (1.0, false, None, None);
            return Some(side);
        }
        side.stack = self.stack.without_first();
        let coat = side.layers.remove(0);
        (side.effects.flakes, side.effects.patina) = (None, None);
        let first = side.layers.first_mut()?;
        first.weight = 1.0;
        (first.maps.weight, first.maps.thickness, first.maps.absorption) = (None, None, None);
        (first.maps.normal, first.maps.roughness) = (coat.maps.normal, coat.maps.roughness);
        first.texels.roughness = coat.texels.roughness;
        for slot in [MapSlot::Weight, MapSlot::Thickness, MapSlot::Absorption] {
            first.live.remove(slot);
        }
        first.live.take_surface(&coat.live);
        Some(side)
    }

    /// The ranges of slope parameters that textures give to the first interface and to the lowest one, if textures vary these, or base colour and metal, and
    /// nothing else that decides shapes of light varies. Model `lobes` then has rows over both slope parameters, with colours in closed form.
    ///
    /// Texels multiply slope parameters; those of a roughness map do so squared. The slope parameter of an anisotropic interface is the mean of its two.
    pub fn family(&self) -> Option<SlopeRanges> {
        let layers = &self.stack.layers;
        let interface = layers.iter().rposition(|layer| !matches!(layer.base, Base::Diffuse(_)))?;
        let has_slopes = |layer: &LayerExtras| {
            [MapSlot::Alpha, MapSlot::AlphaX, MapSlot::AlphaY, MapSlot::Tangent].iter().any(|slot| layer.varies(*slot))
        };
        let is_turned = layers.iter().any(Layer::is_anisotropic);
        let has_own_slopes = [0, interface].into_iter().any(|i| has_slopes(&self.layers[i]))
            || is_turned && self.layers[0].varies(MapSlot::Roughness);
        let is_turned_between = (1..interface).any(|i| layers[i].is_anisotropic() || has_slopes(&self.layers[i]));
        // Rows of a base that is metallic in places have shades of the metal in place of channels: nothing above it has a colour but the first slab.
        // A film on this base itself has closed forms.
        let has_color = |(number, layer): (usize, &Layer)| {
            let is_tinted = match &layer.base {
                Base::Dielectric { slab, .. } => number > 0 && slab.optical_depth() != [0.0; 3],
                Base::Conductor { .. } | Base::Diffuse(_) => false,
            };
            is_tinted || layer.films.len() > usize::from(number == interface)
        };
        // A dielectric whose F0 varies is such a base without metal, and a metal of an F0 below a film that varies one whose F0 varies.
        let base = &layers[interface];
        let varies = base.films.first().is_some_and(Film::varies);
        let is_metal = matches!(&base.base, Base::Conductor { ior } if ior.f0().is_some());
        let varies_f0 = self.layers[interface].varies_f0();
        let is_metallic = varies_f0 || varies && is_metal;
        let varies_slopes = has_own_slopes || self.layers[0].varies(MapSlot::Roughness);
        // Rows over the thickness of a slab have neither other slopes nor azimuths.
        let is_asked = has_own_slopes
            || varies_f0
            || varies && interface > 0
            || self.layers[0].varies_slab() && (is_turned || varies_slopes);
        let has_film = if is_metallic {
            layers.iter().enumerate().any(has_color) || !base.films.iter().all(Film::is_clear)
        } else {
            layers.iter().any(|layer| layer.films.first().is_some_and(Film::varies))
        };
        let first = &self.layers[0];
        let has_lengths = first.varies_slab() && !is_metallic;
        if !is_asked || is_turned_between || has_film || self.effects.patina.is_some() {
            return None;
        }
        let mut of_surface =
            if first.maps.roughness.is_some() { first.texels.roughness.map(|r| r * r) } else { [1.0; 2] };
        if first.live.of(MapSlot::Roughness).is_some() {
            of_surface[0] = 0.0;
        }
        let range = |number: usize| {
            let LayerExtras { maps, texels, live, .. } = &self.layers[number];
            let surface = layers[number].surface;
            let of = |map: &Option<PictureRef>, texels: [f64; 2], slot: MapSlot| {
                let texels = if map.is_some() { texels } else { [1.0; 2] };
                let factors = live.of(slot).and_then(|number| number.factors).unwrap_or([1.0; 2]);
                [0, 1].map(|end: usize| texels[end] * factors[end])
            };
            let (both, along, across) = (
                of(&maps.alpha, texels.alpha, MapSlot::Alpha),
                of(&maps.alpha_x, texels.alpha_x, MapSlot::AlphaX),
                of(&maps.alpha_y, texels.alpha_y, MapSlot::AlphaY),
            );
            [0, 1].map(|end: usize| {
                let mean = 0.5 * (surface.alpha_x * along[end] + surface.alpha_y * across[end]);
                mean * both[end] * of_surface[end]
            })
        };
        let is_tinted = self.layers[interface].metallic.is_some_and(|metallic| metallic.f82_tint != [1.0; 3]);
        let is_filmed = is_metallic && !base.films.is_empty();
        Some(SlopeRanges {
            interface,
            coat: range(0),
            base: range(interface),
            is_metallic,
            is_tinted,
            is_filmed,
            has_lengths,
        })
    }

    /// The re-radiation of its base, if that is fluorescent.
    pub fn reradiation(&self) -> Option<[Rgb; 3]> {
        self.layers.last().and_then(|layer| layer.reradiation)
    }

    /// The images that it names: of layers from the top down, then of effects.
    pub fn images(&self) -> Vec<NamedImage<'_>> {
        let mut found = Vec::new();
        for (i, LayerExtras { film_variation, maps, .. }) in self.layers.iter().enumerate() {
            for map in maps.named() {
                let of_film = if self.layers[i].weighs_film && map.slot == MapSlot::Weight { ".film.0" } else { "" };
                found.push((format!("layer.{i}{of_film}.maps.{}", map.key), map.texels(), map.picture));
            }
            if let Some(picture) = film_variation.as_ref().and_then(|variation| variation.source.image()) {
                found.push((format!("layer.{i}.film.0.thickness_nm.map.image"), TexelUse::Number, picture));
            }
        }
        match self.effects.flakes.as_ref().map(|flakes| &flakes.source) {
            Some(FlakeSource::NormalMap(picture)) => {
                found.push(("effects.flakes.normal_map".to_owned(), TexelUse::Normal, picture));
            }
            Some(FlakeSource::HeightMap { picture, .. }) => {
                found.push(("effects.flakes.height_map.image".to_owned(), TexelUse::Number, picture));
            }
            Some(FlakeSource::Cells { .. }) | None => {}
        }
        if let Some(picture) = self.effects.patina.as_ref().and_then(|patina| patina.map.image()) {
            found.push(("effects.patina.map.image".to_owned(), TexelUse::Number, picture));
        }
        found.into_iter().map(|(key, texels, picture)| NamedImage { key, picture, texels }).collect()
    }
}

/// Properties of a layer beyond its physics.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerExtras {
    /// Share of the surface that the layer covers, 0 to 1: of the first layer, where the others are bare elsewhere.
    pub weight: f64,
    /// Whether the weight, and the map of it, are those of the film on the layer.
    pub weighs_film: bool,
    /// Rows of the matrix from light to light of a fluorescent base, linear Rec.709 under D65 ([`luthier_optics::reradiation::rgb`]). The
    /// albedo in the stack is its colour under white light, within 0..1.
    pub reradiation: Option<[Rgb; 3]>,
    /// How the thickness of the top film varies over the surface.
    pub film_variation: Option<FilmVariation>,
    /// Exponents of the lobes of the outer boundary, whose slope parameter the surface has, and of the inner one.
    pub exponents: Option<[f64; 2]>,
    /// Texture slots.
    pub maps: Maps,
    /// Numbers that a program sets at run time.
    pub live: Live,
    /// Base colour and metal of a `metallic-roughness` surface, or F0 of a metal, if maps multiply them: the stack has the surface without metal.
    pub metallic: Option<Metallic>,
    /// Base colour and metal of a `metallic-roughness` surface, or F0 of a metal, as the file states them: the stack has what a coat above makes of them.
    pub stated: Option<Metallic>,
    /// Smallest and largest texel of the maps of slope parameters.
    pub texels: TexelRanges,
    /// Shares of its light that the base gets back from a coat that does not darken it: the stack has the base brighter than its colour.
    pub brightening: Option<Brightening>,
}

impl Default for LayerExtras {
    /// A layer that is nothing but physics, and covers all of the surface.
    fn default() -> Self {
        let (reradiation, film_variation, exponents, brightening) = (None, None, None, None);
        let (metallic, stated) = (None, None);
        let (maps, live, texels) = (Maps::default(), Live::default(), TexelRanges::default());
        Self {
            weight: 1.0,
            weighs_film: false,
            reradiation,
            film_variation,
            exponents,
            maps,
            live,
            metallic,
            stated,
            texels,
            brightening,
        }
    }
}

/// Smallest and largest texel of maps of a layer: 0 and 1 unless the pictures were measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexelRanges {
    /// Texels of the map of its own slope parameters.
    pub alpha: [f64; 2],
    /// Texels of the map of its slope parameter along the tangent.
    pub alpha_x: [f64; 2],
    /// Texels of the map of its slope parameter along the bitangent.
    pub alpha_y: [f64; 2],
    /// Texels of the map of the roughness of the surface.
    pub roughness: [f64; 2],
}

impl Default for TexelRanges {
    fn default() -> Self {
        Self { alpha: [0.0, 1.0], alpha_x: [0.0, 1.0], alpha_y: [0.0, 1.0], roughness: [0.0, 1.0] }
    }
}

/// Ranges of slope parameters of a stack whose textures vary single layers, see [`Material::family`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopeRanges {
    /// Number of the base among the layers: the lowest interface.
    pub interface: usize,
    /// Least and greatest slope parameter of the first interface.
    pub coat: [f64; 2],
    /// Those of the base.
    pub base: [f64; 2],
    /// Whether the base is metallic in places.
    pub is_metallic: bool,
    /// Whether that metal has an edge tint.
    pub is_tinted: bool,
    /// Whether a film lies on such a base.
    pub is_filmed: bool,
    /// Whether the first slab varies above another base.
    pub has_lengths: bool,
}

/// Base colour and metal of a `metallic-roughness` surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metallic {
    /// F0 of the metal and diffuse colour of the dielectric, RGB.
    pub base_color: Rgb,
    /// 0 is a dielectric, 1 a metal.
    pub metallic: f64,
    /// Edge tint of the metal, RGB; 1 is none.
    pub f82_tint: Rgb,
    /// F0 of the dielectric, RGB.
    pub dielectric: Rgb,
    /// Whether the layer is a `conductor`: a metal everywhere, whose base colour is its `f0`.
    pub is_metal: bool,
}

/// Pictures that modulate a layer.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Maps {
    /// Tangent-space normal map.
    pub normal: Option<PictureRef>,
    /// Multiplies the layer's roughness.
    pub roughness: Option<PictureRef>,
    /// Multiplies the slab's thickness.
    pub thickness: Option<PictureRef>,
    /// Multiplies what the slab absorbs.
    pub absorption: Option<PictureRef>,
    /// Multiplies the layer's weight.
    pub weight: Option<PictureRef>,
    /// Tangent-space normal map of this layer alone.
    pub bumps: Option<PictureRef>,
    /// Multiplies the slope parameters of this layer alone.
    pub alpha: Option<PictureRef>,
    /// Multiplies its slope parameter along the tangent.
    pub alpha_x: Option<PictureRef>,
    /// Multiplies its slope parameter along the bitangent.
    pub alpha_y: Option<PictureRef>,
    /// Directions of its tangent: cosine and sine of the doubled angle.
    pub tangent: Option<PictureRef>,
    /// Multiplies the albedo of a diffuse base.
    pub albedo: Option<PictureRef>,
    /// Multiplies the base colour of a metallic-roughness surface.
    pub base_color: Option<PictureRef>,
    /// Multiplies how metallic it is.
    pub metallic: Option<PictureRef>,
    /// Multiplies the F0 of an interface: of a metal, or of the dielectric above a diffuse base.
    pub f0: Option<PictureRef>,
    /// Normals of the inner boundary of the film or slab.
    pub lean: Option<PictureRef>,
}

/// A map of a layer with its key in the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedMap<'m> {
    /// Key below `maps`.
    pub key: &'static str,
    /// Quantity that it varies.
    pub slot: MapSlot,
    /// The picture.
    pub picture: &'m PictureRef,
}

impl NamedMap<'_> {
    /// Meaning of its texels.
    pub fn texels(&self) -> TexelUse {
        match self.slot {
            MapSlot::Normal | MapSlot::Bumps | MapSlot::FlakeNormal | MapSlot::Lean => TexelUse::Normal,
            MapSlot::Tangent => TexelUse::Direction,
            MapSlot::Albedo | MapSlot::BaseColor | MapSlot::F0 | MapSlot::Absorption => TexelUse::Color,
            _ => TexelUse::Number,
        }
    }
}

impl Maps {
    /// The maps that are there.
    pub fn named(&self) -> impl Iterator<Item = NamedMap<'_>> {
        [
            ("normal", MapSlot::Normal, &self.normal),
            ("roughness", MapSlot::Roughness, &self.roughness),
            ("thickness", MapSlot::Thickness, &self.thickness),
            ("absorption", MapSlot::Absorption, &self.absorption),
            ("weight", MapSlot::Weight, &self.weight),
            ("bumps", MapSlot::Bumps, &self.bumps),
            ("alpha", MapSlot::Alpha, &self.alpha),
            ("alpha_x", MapSlot::AlphaX, &self.alpha_x),
            ("alpha_y", MapSlot::AlphaY, &self.alpha_y),
            ("tangent", MapSlot::Tangent, &self.tangent),
            ("albedo", MapSlot::Albedo, &self.albedo),
            ("base_color", MapSlot::BaseColor, &self.base_color),
            ("metallic", MapSlot::Metallic, &self.metallic),
            ("f0", MapSlot::F0, &self.f0),
            ("lean", MapSlot::Lean, &self.lean),
        ]
        .into_iter()
        .filter_map(|(key, slot, picture)| Some(NamedMap { key, slot, picture: picture.as_ref()? }))
    }
}

/// Numbers of a layer that a program sets at run time, without a bake.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Live(Vec<LiveNumber>);

/// One of these numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiveNumber {
    /// Key below `live`, that of a map of the same quantity.
    pub key: &'static str,
    /// The quantity.
    pub slot: MapSlot,
    /// Least and greatest factor on the number of the file, of slope parameters.
    pub factors: Option<[f64; 2]>,
}

impl Live {
    /// Numbers, in the order of their keys.
    pub fn new(numbers: Vec<LiveNumber>) -> Self {
        Self(numbers)
    }

    /// The numbers.
    pub fn numbers(&self) -> &[LiveNumber] {
        &self.0
    }

    /// The number of a quantity.
    pub fn of(&self, slot: MapSlot) -> Option<LiveNumber> {
        self.0.iter().copied().find(|number| number.slot == slot)
    }

    /// Takes the number of a quantity away; whether it was there.
    pub fn remove(&mut self, slot: MapSlot) -> bool {
        let count = self.0.len();
        self.0.retain(|number| number.slot != slot);
        self.0.len() < count
    }

    /// Takes numbers of quantities of the whole surface from another layer.
    fn take_surface(&mut self, of: &Self) {
        let is_whole = |number: &&LiveNumber| matches!(number.slot, MapSlot::Normal | MapSlot::Roughness);
        self.0.extend(of.0.iter().filter(is_whole));
    }
}

impl LayerExtras {
    /// Whether a map or a program varies a quantity.
    pub fn varies(&self, slot: MapSlot) -> bool {
        self.live.of(slot).is_some() || self.maps.named().any(|map| map.slot == slot)
    }

    /// Takes the map of a quantity away, and the number that a program sets; whether one was there.
    pub fn take(&mut self, slot: MapSlot) -> bool {
        let Maps {
            normal,
            roughness,
            thickness,
            absorption,
            weight,
            bumps,
            alpha,
            alpha_x,
            alpha_y,
            tangent,
            albedo,
            base_color,
            metallic,
            f0,
            lean,
        } = &mut self.maps;
        let map = match slot {
            MapSlot::Normal => normal,
            MapSlot::Roughness => roughness,
            MapSlot::Thickness => thickness,
            MapSlot::Absorption => absorption,
            MapSlot::Weight => weight,
            MapSlot::Bumps => bumps,
            MapSlot::Alpha => alpha,
            MapSlot::AlphaX => alpha_x,
            MapSlot::AlphaY => alpha_y,
            MapSlot::Tangent => tangent,
            MapSlot::Albedo => albedo,
            MapSlot::BaseColor => base_color,
            MapSlot::Metallic => metallic,
            MapSlot::F0 => f0,
            MapSlot::Lean => lean,
            MapSlot::Patina | MapSlot::FlakeNormal => return false,
        };
        let had_map = map.take().is_some();
        self.live.remove(slot) || had_map
    }

    /// Whether maps give each place of its interface an F0.
    pub fn varies_f0(&self) -> bool {
        self.metallic.is_some() || self.maps.f0.is_some()
    }

    /// Whether maps or a program vary the optical depth of the slab.
    pub fn varies_slab(&self) -> bool {
        self.varies(MapSlot::Thickness) || self.varies(MapSlot::Absorption)
    }

    /// The quantities that maps or a program vary, each with its key: `maps.alpha`, `live.alpha`. A key of a map stands for both.
    pub fn varied(&self) -> impl Iterator<Item = (String, MapSlot)> {
        let maps = self.maps.named().map(|map| (format!("maps.{}", map.key), map.slot));
        let has_map = |slot| self.maps.named().any(|map| map.slot == slot);
        let live = self.live.0.iter().filter(move |number| !has_map(number.slot));
        maps.chain(live.map(|number| (format!("live.{}", number.key), number.slot)))
    }

    /// The key of the map of a quantity, or of the number that a program sets.
    pub fn varied_key(&self, slot: MapSlot) -> Option<String> {
        self.varied().find_map(|(key, varied)| (varied == slot).then_some(key))
    }
}

/// How the thickness of a film varies between its extremes.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmVariation {
    /// Source of the variation; 0 is the thinnest, 1 the thickest.
    pub source: VariationSource,
    /// Width of one repeat of the map on the surface.
    pub extent_um: f64,
}
