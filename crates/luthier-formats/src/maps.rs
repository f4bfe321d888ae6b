//! Textures from maps: unchanged where a format reads a picture as the material file does, computed otherwise.

use std::collections::BTreeMap;
use std::io;
use std::rc::Rc;

use luthier_import::{Fate, Line};
use luthier_lut::{Picture, PictureSamples, repeated, srgb};
use luthier_material::{Channel, FilmVariation, LayerExtras, Material, PictureRef, UvTransform, VariationSource};
use luthier_optics::Rgb;
use luthier_texture::{Container, picture, png};

use crate::closed::facets;
use crate::surface::{Slopes, Surface};
use crate::{Format, Numbers};

/// A place for a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slot {
    /// Colour of the base.
    BaseColor,
    /// Roughness of the base.
    Roughness,
    /// Share of the metal.
    Metal,
    /// Roughness in G and metal in B: glTF has both in one.
    RoughnessAndMetal,
    /// Anisotropy of the base; in glTF with its direction.
    Anisotropy,
    /// Normals.
    Normal,
    /// Weight of the coat.
    CoatWeight,
    /// Roughness of the coat.
    CoatRoughness,
    /// Normals of the coat.
    CoatNormal,
    /// Colour of the coat.
    CoatColor,
    /// Colour of the dielectric's interface.
    SpecularColor,
    /// Weight of the film.
    FilmWeight,
    /// Thickness of the film, from the thinnest to the thickest.
    FilmThickness,
}

impl Slot {
    fn name(self) -> &'static str {
        match self {
            Self::BaseColor => "base-color",
            Self::Roughness => "roughness",
            Self::Metal => "metal",
            Self::RoughnessAndMetal => "roughness-metal",
            Self::Anisotropy => "anisotropy",
            Self::Normal => "normal",
            Self::CoatWeight => "coat-weight",
            Self::CoatRoughness => "coat-roughness",
            Self::CoatNormal => "coat-normal",
            Self::CoatColor => "coat-color",
            Self::SpecularColor => "specular-color",
            Self::FilmWeight => "film-weight",
            Self::FilmThickness => "film-thickness",
        }
    }
}

/// A texture of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// Its place.
    pub slot: Slot,
    /// Name of its file, without a folder.
    pub name: String,
    /// The bytes of that file, PNG or JPEG.
    pub bytes: Vec<u8>,
    /// The channel that is read; none for colours and normals, and where the format fixes it.
    pub channel: Option<Channel>,
    /// Whether colours are stored by the sRGB curve.
    pub is_srgb: bool,
    /// Factor on the lean of normals.
    pub scale: f64,
    /// Its place on the surface.
    pub transform: Option<UvTransform>,
}

impl Texture {
    /// Whether its picture has one channel. A picture that is copied is looked at.
    pub(crate) fn is_grey(&self) -> bool {
        picture::decode(&self.bytes).is_ok_and(|decoded| decoded.picture.channels < 3)
    }
}

/// A picture with a reading of its texels.
#[derive(Clone)]
struct Source {
    picture: PictureRef,
    texels: Rc<Picture>,
    bytes: Rc<Vec<u8>>,
    container: Container,
}

impl Source {
    /// RGBA of the picture as the material file reads it, at texture coordinates.
    fn at(&self, [u, v]: [f64; 2]) -> [f64; 4] {
        let [(columns, s), (rows, t)] = [repeated(u, self.texels.width), repeated(v, self.texels.height)];
        let line = |y: u32| {
            let [a, b] = columns.map(|x| self.texel(x, y));
            [0, 1, 2, 3].map(|c: usize| a[c] + (b[c] - a[c]) * s)
        };
        let [top, bottom] = rows.map(line);
        [0, 1, 2, 3].map(|c: usize| top[c] + (bottom[c] - top[c]) * t)
    }

    fn texel(&self, x: u32, y: u32) -> [f64; 4] {
        let texel = self.texels.texel(x, y).map(f64::from);
        let one = self.picture.channel.map_or(texel, |channel| [texel[channel.index()]; 4]);
        one.map(|value| value * self.picture.scale)
    }

    /// The number of a texel.
    fn number(texel: [f64; 4]) -> f64 {
        texel[0].clamp(0.0, 1.0)
    }
}

/// The textures of a material by slot.
pub(crate) fn textures(
    material: &Material,
    format: Format,
    surface: &Surface,
    numbers: &mut Numbers,
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    lines: &mut Vec<Line>,
) -> Vec<Texture> {
    let writer = Writer { material, format, files, lines, read: BTreeMap::new(), textures: Vec::new() };
    writer.all(surface, numbers)
}

/// A picture that was read: its texels as stored, its bytes, its format.
type Read = (Rc<Picture>, Rc<Vec<u8>>, Container);

struct Writer<'w> {
    material: &'w Material,
    format: Format,
    files: &'w dyn Fn(&str) -> io::Result<Vec<u8>>,
    lines: &'w mut Vec<Line>,
    read: BTreeMap<String, Option<Read>>,
    textures: Vec<Texture>,
}

impl Writer<'_> {
    fn say(&mut self, property: impl Into<String>, fate: Fate, note: impl Into<String>) {
        self.lines.push(Line { property: property.into(), fate, note: note.into() });
    }

    /// A map; `None` where there is none, or where it cannot be read, which is told.
    fn source(&mut self, map: Option<&PictureRef>) -> Option<Source> {
        let reference = map?.clone();
        let files = self.files;
        let read = self.read.entry(reference.path.clone()).or_insert_with(|| {
            let bytes = files(&reference.path).ok()?;
            let decoded = picture::decode(&bytes).ok()?;
            Some((Rc::new(decoded.picture), Rc::new(bytes), decoded.container))
        });
        let Some((texels, bytes, container)) = read.clone() else {
            self.say(format!("picture {}", reference.path), Fate::Dropped, "it cannot be read");
            return None;
        };
        let is_curved = reference.srgb == Some(true) && reference.channel != Some(Channel::A);
        let texels = if is_curved { Rc::new(Picture { is_srgb: true, ..(*texels).clone() }) } else { texels };
        Some(Source { picture: reference, texels, bytes, container })
    }

    fn all(mut self, surface: &Surface, numbers: &mut Numbers) -> Vec<Texture> {
        let material = self.material;
        let first = &material.layers[0].maps;
        let [coat_number, base_number] = surface.numbers;
        let base = &material.layers[base_number];
        let maps = &base.maps;
        let has_coat = numbers.coat.is_some();
        // The base below a coat that formats have is another layer, or the diffuse one below a dielectric.
        let is_split = has_coat && base_number == 0;
        let below = material.layers.get(base_number + 1).map(|layer| &layer.maps);

        let color = maps.base_color.as_ref().or_else(|| base.metallic.filter(|of| of.is_metal).and(maps.f0.as_ref()));
        let color = color.or(maps.albedo.as_ref()).or_else(|| below.and_then(|maps| maps.albedo.as_ref()));
        if let Some(source) = self.source(color) {
            self.color(Slot::BaseColor, "map of the base's colour", &source);
        }
        if base.metallic.is_none_or(|of| !of.is_metal)
            && let Some(source) = self.source(maps.f0.as_ref())
        {
            self.color(Slot::SpecularColor, "map of the base's F0", &source);
        }
        let metal = self.source(maps.metallic.as_ref()).filter(|_| numbers.metallic > 0.0);
        let rough = self.rough(surface, numbers, base, is_split);
        self.rough_and_metal(rough, metal, numbers);
        // The normal of the first layer is that of the whole surface.
        let whole = first.normal.as_ref();
        let own = maps.bumps.as_ref().or(if is_split { below.and_then(|maps| maps.bumps.as_ref()) } else { None });
        self.normal(Slot::Normal, own.or(whole));
        if has_coat {
            self.normal(Slot::CoatNormal, first.bumps.as_ref().filter(|_| !is_split || own.is_some()).or(whole));
        }
        if has_coat {
            let coat = &material.layers[coat_number];
            self.coat(surface, coat, is_split || base_number > 0, numbers);
        }
        self.film(&material.layers[base_number], numbers);
        self.textures
    }

    /// Roughness of the base by place.
    fn rough(
        &mut self,
        surface: &Surface,
        numbers: &mut Numbers,
        base: &LayerExtras,
        is_split: bool,
    ) -> Option<(Vec<Source>, Scalar)> {
        if is_split || numbers.roughness == 0.0 {
            return None;
        }
        let whole = self.source(self.material.layers[0].maps.roughness.as_ref());
        let both = self.source(base.maps.alpha.as_ref());
        let [along, across] = [&base.maps.alpha_x, &base.maps.alpha_y].map(|map| map.as_ref());
        let tangent = base.maps.tangent.as_ref();
        if along.or(across).or(tangent).is_some() {
            return self.directed(surface, numbers, base, whole.or(both));
        }
        match (whole, both) {
            (Some(whole), None) => Some((vec![whole], Box::new(|t| Source::number(t[0])))),
            (None, Some(both)) => Some((vec![both], Box::new(|t| Source::number(t[0]).sqrt()))),
            (Some(whole), Some(both)) => {
                Some((vec![whole, both], Box::new(|t| Source::number(t[0]) * Source::number(t[1]).sqrt())))
            }
            (None, None) => None,
        }
    }

    /// Roughness of a base whose slopes vary along and across a direction; writes the anisotropy.
    fn directed(
        &mut self,
        surface: &Surface,
        numbers: &mut Numbers,
        base: &LayerExtras,
        both: Option<Source>,
    ) -> Option<(Vec<Source>, Scalar)> {
        let [along, across, tangent] =
            [&base.maps.alpha_x, &base.maps.alpha_y, &base.maps.tangent].map(|map| self.source(map.as_ref()));
        if both.is_some() {
            self.say("map of roughness", Fate::Dropped, "beside maps of both slopes");
        }
        let plain: Vec<Option<Source>> = vec![along, across, tangent];
        let sources: Vec<Source> = plain.iter().flatten().cloned().collect();
        let place = |number: usize| plain[..number].iter().flatten().count();
        let numbers_of = [0, 1].map(|number| plain[number].as_ref().map(|_| place(number)));
        let turned = plain[2].as_ref().map(|_| place(2));
        let (format, slopes) = (self.format, surface.slopes);
        let at = move |texels: &[[f64; 4]]| {
            let mut here = slopes.facets;
            for (axis, number) in numbers_of.into_iter().enumerate() {
                here.alpha[axis] *= number.map_or(1.0, |number| Source::number(texels[number]));
            }
            let [roughness, strength, turn] = facets(format, &Slopes { facets: here, ..slopes });
            // Cosine and sine of twice the angle, which the file has.
            let own = turned.map_or(0.0, |number| {
                let [x, y, ..] = texels[number].map(|v| 2.0 * v - 1.0);
                0.5 * libm::atan2(y, x)
            });
            [roughness, strength, turn - slopes.facets.turn + own]
        };
        let [mut most, mut strongest] = [0.0_f64; 2];
        self.each(&sources, |texels| {
            let [roughness, strength, _] = at(texels);
            (most, strongest) = (most.max(roughness), strongest.max(strength));
        });
        if most == 0.0 {
            return None;
        }
        numbers.roughness = most;
        numbers.anisotropy = strongest;
        numbers.turn = slopes.facets.turn;
        if strongest > 0.0 {
            let note = "computed from both slopes and the direction";
            if format == Format::Gltf {
                self.computed(Slot::Anisotropy, "maps of alpha_x, alpha_y and tangent", note, &sources, 3, &|t| {
                    let [_, strength, turn] = at(t);
                    let (sin, cos) = libm::sincos(turn);
                    [0.5 + 0.5 * cos, 0.5 + 0.5 * sin, strength / strongest]
                });
            } else {
                self.computed(Slot::Anisotropy, "maps of alpha_x and alpha_y", note, &sources, 1, &|t| {
                    [at(t)[1] / strongest; 3]
                });
                if turned.is_some() {
                    self.say("map of the tangent", Fate::Dropped, "shaders of MaterialX take tangents from the mesh");
                }
            }
        }
        Some((sources, Box::new(move |texels| at(texels)[0] / most)))
    }

    fn rough_and_metal(&mut self, rough: Option<(Vec<Source>, Scalar)>, metal: Option<Source>, numbers: &Numbers) {
        if self.format != Format::Gltf {
            if let Some((sources, of)) = rough {
                self.number(Slot::Roughness, "map of the base's slopes", &sources, &of);
            }
            if let Some(metal) = metal {
                self.number(Slot::Metal, "map of metallic", &[metal], &|t| Source::number(t[0]));
            }
            return;
        }
        let property = match (&rough, &metal) {
            (None, None) => return,
            (Some(_), None) => "map of the base's slopes",
            (None, Some(_)) => "map of metallic",
            (Some(_), Some(_)) => "maps of the base's slopes and of metallic",
        };
        let slot = Slot::RoughnessAndMetal;
        // A picture that has both in the channels of the format stays as it is.
        let is = |source: &Source, channel| source.picture.channel == Some(channel) && source.picture.scale == 1.0;
        let rough_as_is = rough.as_ref().map(|(sources, of)| {
            let [source] = sources.as_slice() else { return None };
            let is_plain = (of(&[[0.5; 4]]) - 0.5).abs() < 1e-12;
            (is_plain && is(source, Channel::G)).then(|| source.clone())
        });
        let metal_as_is = metal.as_ref().map(|source| is(source, Channel::B).then(|| source.clone()));
        let whole = match (&rough_as_is, &metal_as_is) {
            (Some(Some(rough)), Some(Some(metal))) => (rough.picture.path == metal.picture.path
                && rough.picture.transform == metal.picture.transform)
                .then_some(rough),
            (Some(Some(rough)), None) if numbers.metallic == 0.0 => Some(rough),
            _ => None,
        };
        if let Some(source) = whole {
            return self.unchanged(slot, property, source, false, 1.0);
        }
        let (mut sources, of) = rough.unwrap_or_else(|| (Vec::new(), Box::new(|_| 1.0)));
        let count = sources.len();
        if let Some(metal) = metal {
            if sources.first().is_some_and(|first| first.picture.transform != metal.picture.transform) {
                let note = "its placement is that of the roughness: glTF has both in one texture";
                self.say("map of metallic", Fate::Approximated, note);
            }
            sources.push(metal);
        }
        self.computed(slot, property, "in G and B of one picture, of 16 bits", &sources, 3, &|texels| {
            let metal = texels.get(count).map_or(1.0, |texel| Source::number(*texel));
            [1.0, of(&texels[..count]), metal]
        });
    }

    fn coat(&mut self, surface: &Surface, coat: &LayerExtras, has_slopes: bool, numbers: &Numbers) {
        if !coat.weighs_film
            && let Some(source) = self.source(coat.maps.weight.as_ref())
        {
            self.number(Slot::CoatWeight, "map of the coat's weight", &[source], &|t| Source::number(t[0]));
        }
        let alpha = self.source(coat.maps.alpha.as_ref());
        let whole = self.source(coat.maps.roughness.as_ref());
        let rough = numbers.coat.as_ref().is_some_and(|coat| coat.roughness > 0.0) && has_slopes;
        match (whole, alpha) {
            (Some(whole), None) if rough => {
                self.number(Slot::CoatRoughness, "map of roughness", &[whole], &|t| Source::number(t[0]));
            }
            (None, Some(alpha)) if rough => {
                self.number(Slot::CoatRoughness, "map of the coat's alpha", &[alpha], &|t| Source::number(t[0]).sqrt());
            }
            (Some(whole), Some(alpha)) if rough => {
                let of = |t: &[[f64; 4]]| Source::number(t[0]) * Source::number(t[1]).sqrt();
                self.number(Slot::CoatRoughness, "maps of the coat's slopes", &[whole, alpha], &of);
            }
            _ => {}
        }
        if coat.maps.alpha_x.is_some() || coat.maps.alpha_y.is_some() || coat.maps.tangent.is_some() {
            self.say("maps of the coat's directions", Fate::Dropped, "the coat has the numbers of the file");
        }
        let [thickness, absorption] =
            [&coat.maps.thickness, &coat.maps.absorption].map(|map| self.source(map.as_ref()));
        if thickness.is_none() && absorption.is_none() {
            return;
        }
        if self.format == Format::Gltf {
            let note = "coats of glTF are clear";
            return self.say("map of the coat's absorption", Fate::Dropped, note);
        }
        let depth = surface.coat.map_or_else(|| [0.0; 3], |coat| coat.depth);
        let depth = if depth == [0.0; 3] { depth_of(self.material) } else { depth };
        let (has_thickness, has_absorption) = (thickness.is_some(), absorption.is_some());
        let sources: Vec<Source> = thickness.into_iter().chain(absorption).collect();
        let note = "what goes through it and back along the normal, texel by texel";
        // Colours of textures stand in place of the number.
        self.computed(Slot::CoatColor, "map of the coat's absorption", note, &sources, 3, &|texels| {
            let thick = if has_thickness { Source::number(texels[0]) } else { 1.0 };
            let taken = if has_absorption { texels[texels.len() - 1] } else { [1.0; 4] };
            [0, 1, 2].map(|c: usize| libm::exp(-2.0 * depth[c] * thick * taken[c].clamp(0.0, 1.0)))
        });
    }

    fn film(&mut self, base: &LayerExtras, numbers: &mut Numbers) {
        let Some(film) = &mut numbers.film else { return };
        if base.weighs_film
            && let Some(source) = self.source(base.maps.weight.as_ref())
        {
            if self.format == Format::StandardSurface {
                self.say("map of the film's weight", Fate::Dropped, "films cover all of the surface here");
            } else {
                self.number(Slot::FilmWeight, "map of the film's weight", &[source], &|t| Source::number(t[0]));
            }
        }
        let middle = 0.5 * (film.thickness_nm[0] + film.thickness_nm[1]);
        match &base.film_variation {
            Some(FilmVariation { source: VariationSource::Image(map), .. }) => match self.source(Some(map)) {
                Some(source) => {
                    self.number(Slot::FilmThickness, "map of the film's thickness", &[source], &|t| {
                        Source::number(t[0])
                    });
                }
                None => film.thickness_nm = [middle; 2],
            },
            Some(FilmVariation { source: VariationSource::Noise { .. }, .. }) => {
                film.thickness_nm = [middle; 2];
                self.say("film: noise of its thickness", Fate::Dropped, "the middle of its range");
            }
            None => {}
        }
    }

    fn color(&mut self, slot: Slot, property: &str, source: &Source) {
        let is_plain = source.picture.keeps_texels() && source.container != Container::WebP;
        if is_plain && source.picture.srgb == Some(true) {
            return self.unchanged(slot, property, source, true, 1.0);
        }
        if is_plain && self.format != Format::Gltf {
            return self.unchanged(slot, property, source, false, 1.0);
        }
        self.computed(slot, property, "by the sRGB curve, in 16 bits", std::slice::from_ref(source), 3, &|texels| {
            [texels[0][0], texels[0][1], texels[0][2]]
        });
    }

    fn normal(&mut self, slot: Slot, map: Option<&PictureRef>) {
        let Some(source) = self.source(map) else { return };
        let property = if slot == Slot::Normal { "map of normals" } else { "map of the coat's normals" };
        if source.picture.channel.is_some() || source.container == Container::WebP {
            return self.say(property, Fate::Dropped, "a picture of WebP, or one channel of a picture");
        }
        let scale = source.picture.scale;
        self.unchanged(slot, property, &source, false, scale);
    }

    /// Numbers of texels, in the channels of the format.
    fn number(&mut self, slot: Slot, property: &str, sources: &[Source], of: &dyn Fn(&[[f64; 4]]) -> f64) {
        if let [source] = sources {
            let is_plain = (of(&[[0.5; 4]]) - 0.5).abs() < 1e-12 && source.picture.scale == 1.0;
            let is_plain = is_plain && source.picture.srgb != Some(true) && source.container != Container::WebP;
            let wanted = match slot {
                Slot::CoatWeight | Slot::FilmWeight => Channel::R,
                _ => Channel::G,
            };
            let has = source.picture.channel == Some(wanted) || source.texels.channels < 3;
            if is_plain && (self.format != Format::Gltf || has) {
                return self.unchanged(slot, property, source, false, 1.0);
            }
        }
        self.computed(slot, property, "in 16 bits", sources, 1, &|texels| [of(texels); 3]);
    }

    fn unchanged(&mut self, slot: Slot, property: &str, source: &Source, is_srgb: bool, scale: f64) {
        let ending = if source.container == Container::Jpeg { "jpg" } else { "png" };
        let stem = source.picture.path.rsplit('/').next().unwrap_or_default();
        let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
        let texture = Texture {
            slot,
            name: format!("{}.{ending}", plain(stem)),
            bytes: source.bytes.to_vec(),
            channel: source.picture.channel.or((source.texels.channels < 3).then_some(Channel::R)),
            is_srgb,
            scale,
            transform: source.picture.transform,
        };
        self.textures.push(texture);
        self.say(property, Fate::Kept, "");
    }

    fn computed(
        &mut self,
        slot: Slot,
        property: &str,
        note: &str,
        sources: &[Source],
        channels: u32,
        of: &dyn Fn(&[[f64; 4]]) -> Rgb,
    ) {
        let is_srgb = matches!(slot, Slot::BaseColor | Slot::SpecularColor);
        // Numbers of one channel are grey, so that they stand in whichever channel a format reads.
        let mut samples = Vec::new();
        let [width, height] = self.each(sources, |texels| {
            let texel = of(texels).map(|v| v.clamp(0.0, 1.0));
            let stored = texel.map(|v| if is_srgb { srgb::code(v as f32) } else { v });
            samples.extend(stored[..channels as usize].iter().map(|v| libm::round(v * f64::from(u16::MAX)) as u16));
        });
        let samples = PictureSamples::Bits16(samples);
        let Ok(bytes) = png::encode_picture(&Picture { width, height, channels, is_srgb: false, samples }) else {
            return self.say(property, Fate::Dropped, "the picture cannot be written");
        };
        let name = format!("{}-{}.png", self.material.name, slot.name());
        let transform = sources.first().and_then(|source| source.picture.transform);
        let channel = (channels == 1).then_some(Channel::R);
        self.textures.push(Texture { slot, name, bytes, channel, is_srgb, scale: 1.0, transform });
        self.say(property, Fate::ClosedForm, note);
    }

    /// Visits the texels of pictures that lie on each other, and returns the size of the largest.
    fn each(&self, sources: &[Source], mut visit: impl FnMut(&[[f64; 4]])) -> [u32; 2] {
        let sizes = sources.iter().map(|source| source.texels.size());
        let [width, height] = sizes.fold([1; 2], |most, size| [0, 1].map(|i: usize| most[i].max(size[i])));
        for y in 0..height {
            for x in 0..width {
                let texel = |source: &Source| {
                    if source.texels.size() == [width, height] {
                        return source.texel(x, y);
                    }
                    let place = |at: u32, size: u32| (f64::from(at) + 0.5) / f64::from(size);
                    source.at([place(x, width), place(y, height)])
                };
                visit(&sources.iter().map(texel).collect::<Vec<_>>());
            }
        }
        [width, height]
    }
}

/// A number of texels.
type Scalar = Box<dyn Fn(&[[f64; 4]]) -> f64>;

/// Optical depth of the first slab.
fn depth_of(material: &Material) -> Rgb {
    match material.stack.layers.first().map(|layer| &layer.base) {
        Some(luthier_optics::stack::Base::Dielectric { slab, .. }) => slab.optical_depth(),
        _ => [0.0; 3],
    }
}

/// A name of ASCII letters, digits, hyphens and underscores.
fn plain(stem: &str) -> String {
    stem.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' }).collect()
}
