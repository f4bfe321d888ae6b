//! A material of glTF as layers: a coat, a film, a base.

use luthier_lut::srgb;

use super::document::{Anisotropy, Clearcoat, Iridescence, Material, Metallic, Specular, Texture};
use super::textures::{Textures, Use, is_odd, set};
use crate::draft::{Draft, Layer, Value};
use crate::rules::{self, F0, MAPPED_F0_MAX};
use crate::{Fate, Line};

/// Index of coats (`KHR_materials_clearcoat`).
const COAT_IOR: f64 = 1.5;

/// Shares, strengths and roughness.
pub(super) const UNIT: [f64; 2] = [0.0, 1.0];

/// Factors on the slope of normals.
const NORMAL_SCALE: [f64; 2] = [0.0, 100.0];

/// Indices of films.
const FILM_IOR: [f64; 2] = [1.0, 10.0];

/// Thicknesses of films, nm.
const FILM_NM: [f64; 2] = [0.0, 1e5];

/// Extensions that have nothing to do with reflectances, and what the note says of them.
const OF_HOST: [(&str, &str); 2] = [
    ("KHR_materials_emissive_strength", "light that the surface sends out itself"),
    ("KHR_materials_unlit", "how the material is drawn; its numbers are imported as those of a surface in light"),
];

/// Their names.
pub(super) const NONE_OF_REFLECTANCE: [&str; 2] = [OF_HOST[0].0, OF_HOST[1].0];

/// Extensions that are lost, and what is lost with them.
const LOST: [(&str, &str); 6] = [
    ("KHR_materials_volume", "a body behind the surface: nothing goes through"),
    ("KHR_materials_volume_scatter", "light from below the surface of a thick body"),
    ("KHR_materials_sheen", "cloth"),
    ("KHR_materials_diffuse_transmission", "light through the surface"),
    ("KHR_materials_dispersion", "colours of light that goes through"),
    (
        "KHR_materials_pbrSpecularGlossiness",
        "the older description is not read: the surface is that of the core, white rough metal where the file has none",
    ),
];

/// The layers of a material without its name, and what became of each property.
pub(super) fn surface(material: &Material, textures: &mut Textures<'_>) -> (Draft, Vec<Line>) {
    let mut reading = Reading { textures, lines: Vec::new() };
    let extensions = &material.extensions;
    let coat = extensions.clearcoat.as_ref().filter(|coat| coat.clearcoat_factor > 0.0);
    let film = extensions.iridescence.as_ref().filter(|film| film.iridescence_factor > 0.0);
    let film = film.and_then(|film| reading.film(film, coat.is_some()));
    let base = reading.base(material, coat.is_some(), film.as_ref());
    let mut layers = Vec::new();
    if let Some(coat) = coat {
        layers.push(reading.coat(coat, material.normal_texture.as_ref()));
    }
    layers.extend(film);
    layers.push(base);
    reading.others(material);
    reading.unknown(material);
    (Draft { layers, ..Draft::default() }, reading.lines)
}

struct Reading<'r, 'a> {
    textures: &'r mut Textures<'a>,
    lines: Vec<Line>,
}

impl Reading<'_, '_> {
    fn say(&mut self, property: &str, fate: Fate, note: impl Into<String>) {
        self.lines.push(Line::new(property, fate, note));
    }

    /// A number held to a range, with a line where that changes it.
    fn held(&mut self, property: &str, value: f64, [least, most]: [f64; 2]) -> f64 {
        let held = value.clamp(least, most);
        if held != value {
            let [value, least, most] = [value, least, most].map(crate::draft::number);
            self.say(
                property,
                Fate::Approximated,
                format!("{value} is beyond what is read: held to {least} to {most}"),
            );
        }
        held
    }

    /// Adds a normal map; none where its scale leaves the surface flat.
    fn normals(&mut self, layer: &mut Layer, key: &'static str, property: &str, texture: &Texture) {
        let scale = texture.scale.unwrap_or(1.0);
        if scale < 0.0 {
            self.say(property, Fate::Dropped, "normals of a negative scale are not read");
        } else if scale == 0.0 {
            self.say(property, Fate::Kept, "");
        } else {
            let scale = self.held(property, scale, NORMAL_SCALE);
            self.unchanged(layer, key, property, texture, Use { scale: Some(scale), ..Use::default() });
        }
    }

    /// A picture, or a line that says why there is none.
    fn told(&mut self, property: &str, picture: Result<String, String>) -> Option<String> {
        picture.map_err(|reason| self.say(property, Fate::Dropped, reason)).ok()
    }

    /// Adds a picture as it is to a layer.
    fn unchanged(&mut self, layer: &mut Layer, key: &'static str, property: &str, texture: &Texture, used: Use) {
        let picture = self.textures.unchanged(texture, used);
        if let Some(picture) = self.told(property, picture) {
            layer.map(key, picture);
            self.placed(property, texture);
            self.say(property, Fate::Kept, "");
        }
    }

    /// Adds a computed picture to a layer.
    fn computed(
        &mut self,
        layer: &mut Layer,
        key: &'static str,
        property: &str,
        sources: [Option<&Texture>; 2],
        picture: Result<String, String>,
        note: &str,
    ) {
        if let Some(picture) = self.told(property, picture) {
            layer.map(key, picture);
            sources.into_iter().flatten().for_each(|texture| self.placed(property, texture));
            self.say(property, Fate::ClosedForm, note);
            if let [Some(first), Some(second)] = sources
                && (&first.extensions, first.tex_coord) != (&second.extensions, second.tex_coord)
            {
                let note = "its two textures are placed differently: both have the placement of the first";
                self.say(property, Fate::Approximated, note);
            }
        }
    }

    /// Lines on texture coordinates that shaders do not have.
    fn placed(&mut self, property: &str, texture: &Texture) {
        for name in texture.extensions.unknown.keys() {
            self.say(property, Fate::Dropped, format!("the extension {name} of its texture is not read"));
        }
        if set(texture) > 0 {
            let note = format!("its texture coordinates are set {}: shaders take one set for all maps", set(texture));
            self.say(property, Fate::Approximated, note);
        }
        if is_odd(texture) {
            self.say(
                property,
                Fate::Approximated,
                "a placement that shows no picture is left out: a scale of 0, or numbers of a million",
            );
        }
        if !self.textures.repeats(texture) {
            self.say(property, Fate::Approximated, "the texture ends or is mirrored at its edge: maps repeat");
        }
    }

    /// The base: colour, metal, roughness or anisotropy, F0, normals.
    fn base(&mut self, material: &Material, has_coat: bool, film: Option<&Layer>) -> Layer {
        let Metallic { base_color_factor: [r, g, b, _], base_color_texture, metallic_factor, .. } =
            &material.pbr_metallic_roughness;
        let mut base = Layer::new("metallic-roughness");
        let color = [*r, *g, *b].map(|c| self.held("baseColorFactor", c, UNIT));
        base.set("base_color", Value::color(color));
        self.say("baseColorFactor", Fate::Kept, "");
        let metallic = self.held("metallicFactor", *metallic_factor, UNIT);
        base.set("metallic", Value::Number(metallic));
        let metal = material.pbr_metallic_roughness.metallic_roughness_texture.as_ref().filter(|_| metallic > 0.0);
        self.say("metallicFactor", Fate::Kept, "");
        // A number between 0 and 1 means one interface, and a texel a blend of two surfaces, as in glTF.
        let is_blend = metallic > 0.0 && metallic < 1.0;
        let specular = material.extensions.specular.as_ref();
        let has_specular = specular.is_some_and(|s| s.specular_texture.is_some() || s.specular_color_texture.is_some());
        // A weight of the coat that varies brightens the base by place.
        let coat = material.extensions.clearcoat.as_ref().filter(|_| has_coat);
        let has_weights = coat.is_some_and(|coat| coat.clearcoat_texture.is_some());
        // Below a coat, or beside slopes that vary, a film varies on surfaces with maps of colour or metal alone.
        let has_rough = material.pbr_metallic_roughness.metallic_roughness_texture.is_some();
        let has_directions = material.extensions.anisotropy.as_ref().is_some_and(|a| a.anisotropy_texture.is_some());
        let has_uneven_film =
            film.is_some_and(|film| film.has_table("thickness_nm")) && (has_coat || has_rough || has_directions);
        let wants_maps = has_weights || has_uneven_film;
        let varies = base_color_texture.is_some() || metal.is_some() || is_blend || has_specular || wants_maps;
        if film.is_some() && varies {
            if specular.is_some() || material.extensions.ior.is_some() {
                let note = "a film on a surface with maps interferes by an F0 of .04 where the surface is no metal";
                self.say("KHR_materials_ior, KHR_materials_specular", Fate::Dropped, note);
            }
        } else {
            self.f0(material, &mut base);
        }
        self.facets(material, has_coat, &mut base);
        if let Some(texture) = base_color_texture {
            let used = Use { is_srgb: true, ..Use::default() };
            self.unchanged(&mut base, "base_color", "baseColorTexture", texture, used);
        }
        if let Some(texture) = metal {
            let used = Use { channel: Some("b"), ..Use::default() };
            self.unchanged(&mut base, "metallic", "metallicRoughnessTexture (metal)", texture, used);
        }
        base.complete(metallic, wants_maps, &mut || self.textures.white().ok());
        if let Some(texture) = &material.normal_texture {
            let is_of_both = coat.is_some_and(|coat| coat.clearcoat_normal_texture.as_ref() == Some(texture));
            if is_of_both {
                self.say("normalTexture", Fate::Kept, "");
            } else {
                let key = if has_coat { "bumps" } else { "normal" };
                self.normals(&mut base, key, "normalTexture", texture);
            }
        }
        base
    }

    /// The reflectance of the dielectric along the normal.
    fn f0(&mut self, material: &Material, base: &mut Layer) {
        let extensions = &material.extensions;
        if extensions.ior.is_none() && extensions.specular.is_none() {
            return;
        }
        let ior = extensions.ior.as_ref().map(|ior| self.held("KHR_materials_ior", ior.ior, [0.0, 1e6]));
        // An index of 0 is that of materials that were described by specular and glossiness: they reflect all of their specular colour.
        let of_ior = ior.map_or(F0, rules::f0);
        if extensions.ior.is_some() {
            self.say("KHR_materials_ior", Fate::ClosedForm, "f0 = ((n - 1)/(n + 1))^2");
        }
        let Specular { specular_factor, specular_texture, specular_color_factor, specular_color_texture, .. } =
            extensions.specular.clone().unwrap_or_default();
        let tinted = specular_color_factor.map(|c: f64| specular_factor * (of_ior * c).min(1.0));
        let is_mapped = specular_texture.is_some() || specular_color_texture.is_some();
        let most = if is_mapped { MAPPED_F0_MAX } else { 1.0 };
        let f0 = tinted.map(|f| self.held("KHR_materials_specular", f, [0.0, most]));
        base.set("f0", Value::color(f0));
        if extensions.specular.is_some() {
            let is_grey = specular_color_texture.is_none() && f0[0] == f0[1] && f0[1] == f0[2];
            let mut note = "f0 = min(f0 of the index times specularColor, 1) times specular".to_owned();
            if !is_grey {
                note += "; the base loses what the interface reflects of each channel, where glTF takes the brightest";
            }
            let is_whole = specular_factor == 1.0 && specular_texture.is_none();
            if !is_whole {
                note += "; glTF scales what the edge reflects by specular, too, which is all here";
            }
            let fate = if is_grey && is_whole { Fate::ClosedForm } else { Fate::Approximated };
            self.say("KHR_materials_specular", fate, note);
        }
        match [specular_color_texture, specular_texture] {
            [None, None] => {}
            [Some(color), None] => {
                let used = Use { is_srgb: true, ..Use::default() };
                self.unchanged(base, "f0", "specularColorTexture", &color, used);
            }
            // A picture without alpha says 1 everywhere.
            [None, Some(weight)] if self.textures.texels(&weight).is_ok_and(|texels| texels.is_opaque()) => {
                self.say("specularTexture", Fate::Kept, "");
            }
            [None, Some(weight)] => {
                let used = Use { channel: Some("a"), ..Use::default() };
                self.unchanged(base, "f0", "specularTexture", &weight, used);
            }
            [Some(color), Some(weight)] => {
                let picture = self.textures.color("f0", "f0", [Some(&color), Some(&weight)], |color, weight| {
                    [0, 1, 2].map(|c: usize| f64::from(srgb::linear(color[c] as f32)) * weight[3])
                });
                let note = "the product of both textures";
                self.computed(
                    base,
                    "f0",
                    "specularColorTexture, specularTexture",
                    [Some(&color), Some(&weight)],
                    picture,
                    note,
                );
            }
        }
    }

    /// Slope parameters: `alpha = roughness^2`, along and across the direction of anisotropy.
    fn facets(&mut self, material: &Material, has_coat: bool, base: &mut Layer) {
        let Metallic { roughness_factor, metallic_roughness_texture, .. } = &material.pbr_metallic_roughness;
        let roughness = self.held("roughnessFactor", *roughness_factor, UNIT);
        let rough = metallic_roughness_texture.as_ref().filter(|_| roughness > 0.0);
        let anisotropy = material.extensions.anisotropy.as_ref().filter(|found| found.anisotropy_strength > 0.0);
        if let Some(anisotropy) = anisotropy {
            return self.anisotropic(roughness, rough, anisotropy, base);
        }
        self.say("roughnessFactor", Fate::Kept, "");
        if roughness == 0.0 {
            base.set("smooth", Value::Bool(true));
            return;
        }
        let Some(texture) = rough else {
            base.set("roughness", Value::Number(roughness));
            return;
        };
        let property = "metallicRoughnessTexture (roughness)";
        if !has_coat {
            base.set("roughness", Value::Number(roughness));
            let used = Use { channel: Some("g"), ..Use::default() };
            self.unchanged(base, "roughness", property, texture, used);
            return;
        }
        let most = self.textures.texels(texture).map_or(1.0, |texels| texels.most(1)).max(1e-3);
        base.set("roughness", Value::Number(roughness * most));
        let picture = self.squared(texture, 1, most);
        self.computed(base, "alpha", property, [Some(texture), None], picture, "alpha = roughness^2, in 16 bits");
    }

    /// Squares of a channel over the square of its largest value.
    fn squared(&mut self, texture: &Texture, channel: usize, most: f64) -> Result<String, String> {
        let key = format!("squared {channel}");
        self.textures.number("alpha", &key, [Some(texture), None], |texel, _| {
            let share = texel[channel] / most;
            share * share
        })
    }

    fn anisotropic(&mut self, roughness: f64, rough: Option<&Texture>, given: &Anisotropy, base: &mut Layer) {
        let strength = self.held("anisotropyStrength", given.anisotropy_strength, UNIT);
        let direction = given.anisotropy_texture.as_ref();
        let most = |texture: Option<&Texture>, channel: usize, textures: &mut Textures<'_>| {
            texture.and_then(|texture| textures.texels(texture).ok()).map_or(1.0, |texels| texels.most(channel))
        };
        let [most_rough, most_strong] = [most(rough, 1, self.textures), most(direction, 2, self.textures)];
        // Both grow with roughness, and the first with the strength.
        let [alpha_x, alpha_y] =
            rules::gltf_alphas(roughness * most_rough, strength * most_strong).map(|alpha| alpha.max(1e-6));
        base.set("alpha_x", Value::Number(alpha_x));
        base.set("alpha_y", Value::Number(alpha_y));
        let turn = libm::fmod(given.anisotropy_rotation, std::f64::consts::TAU);
        if turn != 0.0 {
            base.set("rotation_deg", Value::Number(turn.to_degrees()));
        }
        let note = "alpha_x = alpha + (1 - alpha) strength^2 along the direction, alpha_y = alpha = roughness^2";
        self.say("roughnessFactor, KHR_materials_anisotropy", Fate::ClosedForm, note);
        if rough.or(direction).is_some() {
            let key = format!("alpha-x {roughness} {strength} {most_rough} {most_strong}");
            let picture = self.textures.number("alpha-x", &key, [rough, direction], move |rough, direction| {
                rules::gltf_alphas(roughness * rough[1], strength * direction[2])[0] / alpha_x
            });
            self.computed(base, "alpha_x", "textures of roughness and strength", [rough, direction], picture, note);
        }
        if let Some(texture) = rough {
            let picture = self.squared(texture, 1, most_rough.max(1e-3));
            self.computed(
                base,
                "alpha_y",
                "metallicRoughnessTexture (roughness)",
                [Some(texture), None],
                picture,
                "alpha = roughness^2, in 16 bits",
            );
        }
        if let Some(texture) = direction {
            let picture = self.textures.color("tangent", "tangent", [Some(texture), None], |texel, _| {
                let [x, y] = [2.0 * texel[0] - 1.0, 2.0 * texel[1] - 1.0];
                let square = x * x + y * y;
                if square < 1e-6 {
                    return [0.5, 0.5, 0.0];
                }
                // Cosine and sine of the doubled angle.
                [0.5 + 0.5 * (x * x - y * y) / square, 0.5 + x * y / square, 0.0]
            });
            self.computed(
                base,
                "tangent",
                "anisotropyTexture (direction)",
                [Some(texture), None],
                picture,
                "texels of the doubled angle",
            );
        }
    }

    fn coat(&mut self, given: &Clearcoat, base_normals: Option<&Texture>) -> Layer {
        let mut coat = Layer::new("dielectric");
        coat.set("ior", Value::Number(COAT_IOR));
        let roughness = self.held("clearcoatRoughnessFactor", given.clearcoat_roughness_factor, UNIT);
        let rough = given.clearcoat_roughness_texture.as_ref().filter(|_| roughness > 0.0);
        match rough {
            None if roughness == 0.0 => coat.set("smooth", Value::Bool(true)),
            None => coat.set("roughness", Value::Number(roughness)),
            Some(texture) => {
                let most = self.textures.texels(texture).map_or(1.0, |texels| texels.most(1)).max(1e-3);
                coat.set("roughness", Value::Number(roughness * most));
                let picture = self.squared(texture, 1, most);
                let note = "alpha = roughness^2, in 16 bits";
                self.computed(&mut coat, "alpha", "clearcoatRoughnessTexture", [Some(texture), None], picture, note);
            }
        }
        let weight = self.held("clearcoatFactor", given.clearcoat_factor, UNIT);
        if weight < 1.0 {
            coat.set("weight", Value::Number(weight));
        }
        coat.set("darkening", Value::Bool(false));
        self.say("clearcoatFactor, clearcoatRoughnessFactor", Fate::Kept, "");
        let note = "the coat is layered, with light that goes to and fro below it; the base stays as bright as its colour (`darkening = false`)";
        self.say("KHR_materials_clearcoat", Fate::Approximated, note);
        if let Some(texture) = &given.clearcoat_texture {
            let used = Use { channel: Some("r"), ..Use::default() };
            self.unchanged(&mut coat, "weight", "clearcoatTexture", texture, used);
        }
        if let Some(texture) = &given.clearcoat_normal_texture {
            let key = if base_normals == Some(texture) { "normal" } else { "bumps" };
            self.normals(&mut coat, key, "clearcoatNormalTexture", texture);
        }
        coat
    }

    /// The film; none without thickness.
    fn film(&mut self, given: &Iridescence, has_coat: bool) -> Option<Layer> {
        let least = self.held("iridescenceThicknessMinimum", given.iridescence_thickness_minimum, FILM_NM);
        let most = self.held("iridescenceThicknessMaximum", given.iridescence_thickness_maximum, FILM_NM);
        let is_even = given.iridescence_thickness_texture.is_none() || least == most;
        if most == 0.0 && (is_even || least == 0.0) {
            return None;
        }
        let mut film = Layer::new("thin-film");
        let ior = self.held("iridescenceIor", given.iridescence_ior, FILM_IOR);
        film.set("ior", Value::Number(ior));
        let thick = given.iridescence_thickness_texture.as_ref().filter(|_| least != most);
        let map = thick.and_then(|texture| {
            // Maps go from the thinnest to the thickest, and have no placement of their own.
            let plain = Texture { extensions: Default::default(), ..texture.clone() };
            let picture = if least < most {
                self.textures.unchanged(&plain, Use { channel: Some("g"), ..Use::default() })
            } else {
                self.textures.number("thickness", "turned over", [Some(&plain), None], |texel, _| 1.0 - texel[1])
            };
            let picture = self.told("iridescenceThicknessTexture", picture)?;
            self.placed("iridescenceThicknessTexture", texture);
            self.say("iridescenceThicknessTexture", Fate::Kept, "");
            if texture.extensions.transform.is_some() {
                self.say("iridescenceThicknessTexture", Fate::Approximated, "its placement is left out");
            }
            Some(picture)
        });
        let thickness = match map {
            Some(map) => Value::Table(rules::thickness([least.min(most), least.max(most)], &map)),
            None if most == 0.0 => return None,
            None => Value::Number(most),
        };
        self.say("iridescenceIor, iridescenceThicknessMinimum, iridescenceThicknessMaximum", Fate::Kept, "");
        film.set("thickness_nm", thickness);
        let note = "the film interferes by the index that its base's F0 stands for, by Airy's formula: glTF has a fit of two orders";
        self.say("KHR_materials_iridescence", Fate::Approximated, note);
        let weight = self.held("iridescenceFactor", given.iridescence_factor, UNIT);
        if has_coat && (weight < 1.0 || given.iridescence_texture.is_some()) {
            self.say("iridescenceFactor", Fate::Dropped, "below a coat a film covers the whole surface");
        } else {
            if weight < 1.0 {
                film.set("weight", Value::Number(weight));
            }
            self.say("iridescenceFactor", Fate::Kept, "");
            if let Some(texture) = &given.iridescence_texture {
                let used = Use { channel: Some("r"), ..Use::default() };
                self.unchanged(&mut film, "weight", "iridescenceTexture", texture, used);
            }
        }
        Some(film)
    }

    /// Lines on members that are not known.
    fn unknown(&mut self, material: &Material) {
        let extensions = &material.extensions;
        let all = [
            ("", Some(&material.unknown)),
            ("pbrMetallicRoughness.", Some(&material.pbr_metallic_roughness.unknown)),
            ("KHR_materials_clearcoat.", extensions.clearcoat.as_ref().map(|found| &found.unknown)),
            ("KHR_materials_ior.", extensions.ior.as_ref().map(|found| &found.unknown)),
            ("KHR_materials_specular.", extensions.specular.as_ref().map(|found| &found.unknown)),
            ("KHR_materials_anisotropy.", extensions.anisotropy.as_ref().map(|found| &found.unknown)),
            ("KHR_materials_iridescence.", extensions.iridescence.as_ref().map(|found| &found.unknown)),
            ("KHR_materials_transmission.", extensions.transmission.as_ref().map(|found| &found.unknown)),
        ];
        for (of, name) in
            all.into_iter().flat_map(|(of, unknown)| unknown.into_iter().flatten().map(move |(n, _)| (of, n)))
        {
            match name.as_str() {
                "extras" => self.say(&format!("{of}extras"), Fate::Host, "notes of a program"),
                "alphaCutoff" => self.say(name, Fate::Host, "where the surface is cut out"),
                "transmissionTexture" => {}
                _ => self.say(&format!("{of}{name}"), Fate::Dropped, "the member is not known"),
            }
        }
    }

    /// Lines on all that is no reflectance, and on what is lost.
    fn others(&mut self, material: &Material) {
        let Material {
            emissive_texture, emissive_factor, occlusion_texture, alpha_mode, double_sided, extensions, ..
        } = material;
        if *emissive_factor != [0.0; 3] || emissive_texture.is_some() {
            self.say("emissiveFactor, emissiveTexture", Fate::Host, "light that the surface sends out itself");
        }
        if occlusion_texture.is_some() {
            self.say("occlusionTexture", Fate::Host, "how much of the surroundings a place sees");
        }
        if alpha_mode.as_deref().is_some_and(|mode| mode != "OPAQUE") {
            self.say("alphaMode, baseColorFactor.a", Fate::Host, "where the surface is cut out or blended");
        }
        if *double_sided {
            self.say("doubleSided", Fate::Host, "which sides are drawn");
        }
        for (property, value) in [
            ("clearcoatFactor", extensions.clearcoat.as_ref().map(|found| found.clearcoat_factor)),
            ("iridescenceFactor", extensions.iridescence.as_ref().map(|found| found.iridescence_factor)),
            ("anisotropyStrength", extensions.anisotropy.as_ref().map(|found| found.anisotropy_strength)),
            ("transmissionFactor", extensions.transmission.as_ref().map(|found| found.transmission_factor)),
        ] {
            if value.is_some_and(|value| value < 0.0) {
                self.say(property, Fate::Approximated, "a negative number is read as 0");
            }
        }
        if extensions.transmission.as_ref().is_some_and(|found| found.transmission_factor > 0.0) {
            self.say("KHR_materials_transmission", Fate::Dropped, "light that goes through: the base is opaque");
        }
        for name in extensions.others.keys() {
            let find =
                |table: &[(&str, &'static str)]| table.iter().find(|(known, _)| known == name).map(|(_, note)| *note);
            if let Some(note) = find(&OF_HOST) {
                self.say(name, Fate::Host, note);
            } else if let Some(note) = find(&LOST) {
                self.say(name, Fate::Dropped, note);
            } else {
                self.say(name, Fate::Dropped, "the extension is not read");
            }
        }
    }
}
