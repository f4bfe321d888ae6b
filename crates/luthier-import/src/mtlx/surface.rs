//! A surface as layers of a material file: a coat, a film, a base, whose numbers may vary.

use std::sync::Arc;

use super::expression::{self, Expression};
use super::pictured::{Pictured, Scaled};
use super::value::Value;
use crate::draft::{Layer, Value as Setting, number};
use crate::rules::{self, F0, MAPPED_F0_MAX};
use crate::{Fate, Line};

type Input = Arc<Expression>;

/// Thickest film, nm.
const THICKNESS_MAX_NM: f64 = 1e5;

/// The largest slope deviation, radians.
const SIGMA_MAX: f64 = 1.57;

/// Least transmittance of a coat to and fro: black absorbs without end.
const TRANSMITTANCE_MIN: f64 = 1e-4;

/// Numbers of a surface.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    /// Colour of the base, of its metal and of its diffuse part.
    pub(super) color: Input,
    pub(super) metallic: Input,
    /// Reflectance of the dielectric along the normal, RGB.
    pub(super) f0: Input,
    /// Edge tint of the metal.
    pub(super) edge: [f64; 3],
    /// Slope deviation of the diffuse part, radians.
    pub(super) sigma: f64,
    pub(super) facets: Facets,
    pub(super) normal: Option<Input>,
    pub(super) coat: Option<Coat>,
    pub(super) film: Option<Film>,
}

/// Slopes of an interface.
#[derive(Debug, Clone)]
pub(super) struct Facets {
    pub(super) roughness: Input,
    /// Slope parameters along and across; `None` where both are the square of roughness.
    pub(super) alphas: Option<[Input; 2]>,
    /// Turn of the first axis, in turns counter-clockwise.
    pub(super) turn: Input,
}

impl Facets {
    /// Facets by the rule of a format: slope parameters of a roughness and an anisotropy.
    pub(super) fn new(roughness: Input, anisotropy: &Input, turn: Input, rule: fn(f64, f64) -> [f64; 2]) -> Self {
        if anisotropy.constant().is_some_and(|value| value.first() <= 0.0) {
            return Self { roughness, alphas: None, turn };
        }
        let alpha = |c: usize| {
            Expression::of(&[&roughness, anisotropy], move |v| {
                let [roughness, anisotropy] = [v[0], v[1]].map(|value| value.first().clamp(0.0, 1.0));
                Value::number(rule(roughness, anisotropy)[c])
            })
        };
        let alphas = [alpha(0), alpha(1)];
        Self { roughness, alphas: Some(alphas), turn }
    }
}

/// A clear layer above.
#[derive(Debug, Clone)]
pub(super) struct Coat {
    pub(super) weight: Input,
    pub(super) ior: f64,
    pub(super) facets: Facets,
    /// Transmittance to and fro along the normal, RGB.
    pub(super) color: Input,
    /// Whether the base is darker for the light that comes back to it.
    pub(super) darkens: bool,
    pub(super) normal: Option<Input>,
}

/// A film on the base.
#[derive(Debug, Clone)]
pub(super) struct Film {
    pub(super) weight: Input,
    pub(super) thickness_nm: Input,
    pub(super) ior: f64,
}

/// Layers from surfaces, and lines on what was lost.
pub(super) struct Writer<'w, 'a> {
    pub(super) pictured: &'w mut Pictured<'a>,
    pub(super) lines: &'w mut Vec<Line>,
}

fn varies(input: &Input) -> bool {
    input.constant().is_none()
}

fn is_zero(input: &Input) -> bool {
    input.constant().is_some_and(|value| value.all().iter().all(|v| *v <= 0.0))
}

impl Writer<'_, '_> {
    fn say(&mut self, property: &str, fate: Fate, note: impl Into<String>) {
        let line = Line::new(property, fate, note);
        if !self.lines.contains(&line) {
            self.lines.push(line);
        }
    }

    /// The layers from the top down.
    pub(super) fn layers(&mut self, surface: &Surface) -> Vec<Layer> {
        let coat = surface.coat.as_ref().filter(|coat| !is_zero(&coat.weight));
        let film = surface.film.as_ref().filter(|film| !is_zero(&film.weight) && !is_zero(&film.thickness_nm));
        // Schlick's formula has an edge even where F0 is 0. Below a coat a diffuse base has neither a map of the weight nor, undarkened, one of its colour.
        let is_matte = is_zero(&surface.f0) && is_zero(&surface.metallic);
        if is_matte && coat.is_none_or(|coat| !varies(&coat.weight) && (coat.darkens || !varies(&surface.color))) {
            if film.is_some() {
                self.say("the film", Fate::Dropped, "nothing below it reflects");
            }
            let base = self.matte(surface, coat);
            return coat.map(|coat| self.coat(coat, surface.normal.as_ref())).into_iter().chain([base]).collect();
        }
        let film_layer = film.and_then(|film| self.film(film, coat.is_some()));
        let base = self.base(surface, coat, film_layer.as_ref());
        let mut layers = Vec::new();
        if let Some(coat) = coat {
            layers.push(self.coat(coat, surface.normal.as_ref()));
        }
        layers.extend(film_layer);
        layers.push(base);
        layers
    }

    /// Holds a number to a range, with a line where that changes it.
    fn held(&mut self, property: &str, value: f64, [least, most]: [f64; 2]) -> f64 {
        let held = value.clamp(least, most);
        if (held - value).abs() > 1e-6 {
            let note =
                format!("{} is beyond what is read: held to {} to {}", number(value), number(least), number(most));
            self.say(property, Fate::Approximated, note);
        }
        held
    }

    /// Adds one or three numbers that may vary. `absent` holds where a picture cannot be read.
    fn put(
        &mut self,
        layer: &mut Layer,
        [key, map]: [&'static str; 2],
        input: &Input,
        channels: usize,
        [absent, most]: [f64; 2],
    ) {
        let scaled = self.pictured.scaled(map, input, channels, most);
        let Some(Scaled { factor, map: picture, notes, is_computed }) = self.told(map, scaled) else {
            layer.set(key, Setting::Number(absent));
            let note = format!("{} is taken in its place", number(absent));
            self.say(&format!("picture of {map}"), Fate::Approximated, note);
            return;
        };
        let held: Vec<f64> = factor.all().iter().map(|v| self.held(key, *v, [0.0, most])).collect();
        let value = if let [r, g, b] = held[..] { Setting::color([r, g, b]) } else { Setting::Number(held[0]) };
        layer.set(key, value);
        if let Some(picture) = picture {
            layer.map(map, picture);
            self.pictured_as(map, is_computed, notes);
        }
    }

    fn told(&mut self, map: &str, found: Result<Scaled, String>) -> Option<Scaled> {
        found.map_err(|reason| self.say(&format!("picture of {map}"), Fate::Dropped, reason)).ok()
    }

    fn pictured_as(&mut self, map: &str, is_computed: bool, notes: Vec<&str>) {
        let fate = if is_computed { Fate::ClosedForm } else { Fate::Kept };
        let note = if is_computed { "computed, in 16 bits" } else { "" };
        self.say(&format!("picture of {map}"), fate, note);
        for note in notes {
            self.say(&format!("picture of {map}"), Fate::Approximated, note);
        }
    }

    fn normals(&mut self, layer: &mut Layer, key: &'static str, normal: Option<&Input>) {
        let Some(normal) = normal.filter(|normal| varies(normal)) else { return };
        let found = self.pictured.normals(normal);
        if let Some(Scaled { map: Some(picture), notes, is_computed, .. }) = self.told(key, found) {
            layer.map(key, picture);
            self.pictured_as(key, is_computed, notes);
        }
    }

    /// A diffuse base without an interface.
    fn matte(&mut self, surface: &Surface, coat: Option<&Coat>) -> Layer {
        let mut layer = Layer::new("diffuse");
        self.put(&mut layer, ["albedo", "albedo"], &surface.color, 3, [0.5, 1.0]);
        self.sigma(&mut layer, surface.sigma);
        self.own_normals(&mut layer, surface.normal.as_ref(), coat);
        layer
    }

    /// Normals of a base: of the whole surface where nothing lies above it, or both have the same.
    fn own_normals(&mut self, layer: &mut Layer, normal: Option<&Input>, coat: Option<&Coat>) {
        let is_of_both = coat.is_some_and(|coat| same(coat.normal.as_ref(), normal));
        if !is_of_both {
            self.normals(layer, if coat.is_some() { "bumps" } else { "normal" }, normal);
        }
    }

    fn sigma(&mut self, layer: &mut Layer, sigma: f64) {
        let sigma = self.held("diffuse roughness", sigma, [0.0, SIGMA_MAX]);
        if sigma > 0.0 {
            layer.set("sigma", Setting::Number(sigma));
        }
    }

    fn base(&mut self, surface: &Surface, coat: Option<&Coat>, film: Option<&Layer>) -> Layer {
        let mut base = Layer::new("metallic-roughness");
        let Surface { color, metallic, f0, edge, sigma, facets, normal, .. } = surface;
        self.put(&mut base, ["base_color", "base_color"], color, 3, [0.5, 1.0]);
        self.put(&mut base, ["metallic", "metallic"], metallic, 1, [0.0, 1.0]);
        let share = metallic.constant().map_or(1.0, |value| value.first().clamp(0.0, 1.0));
        // A number between 0 and 1 means one interface, and a texel a blend of two surfaces, as in all of these formats.
        let is_blend = share > 0.0 && share < 1.0;
        let has_weights = coat.is_some_and(|coat| varies(&coat.weight));
        let has_uneven_film = film.is_some_and(|film| film.has_table("thickness_nm"))
            && (coat.is_some() || varies(&facets.roughness) || facets.alphas.as_ref().is_some_and(|[x, _]| varies(x)));
        let wants_maps = has_weights || has_uneven_film;
        let has_maps = base.has_map("base_color") || base.has_map("metallic") || is_blend || varies(f0) || wants_maps;
        // An F0 of .04 needs no word, and a metal has none.
        let has_dielectric = share < 1.0 || varies(metallic);
        let is_told = f0.constant().is_none_or(|value| value.three().iter().any(|f| (f - F0).abs() > 1e-9));
        if film.is_some() && has_maps {
            if has_dielectric && is_told {
                let note = "a film on a surface with maps interferes by an F0 of .04 where the surface is no metal";
                self.say("index and specular weight", Fate::Dropped, note);
            }
        } else if has_dielectric && is_told {
            let most = if varies(f0) { MAPPED_F0_MAX } else { 1.0 };
            self.put(&mut base, ["f0", "f0"], f0, 3, [F0, most]);
        }
        if *edge != [1.0; 3] && !is_zero(metallic) {
            if film.is_some() {
                self.say("edge tint", Fate::Dropped, "below a film a metal has no edge tint");
            } else {
                let edge = edge.map(|tint| self.held("edge tint", tint, [0.0, 1.0]));
                base.set("f82_tint", Setting::color(edge));
            }
        }
        self.facets(&mut base, facets, coat.is_none() && film.is_none());
        self.sigma(&mut base, *sigma);
        let mut whites = Vec::new();
        base.complete(share, wants_maps, &mut || {
            let white = self.pictured.white();
            white.map_err(|reason| whites.push(reason)).ok()
        });
        whites.into_iter().for_each(|reason| self.say("white texels", Fate::Dropped, reason));
        self.own_normals(&mut base, normal.as_ref(), coat);
        base
    }

    /// Slopes of a layer. The roughness of the whole surface takes the picture as it is.
    fn facets(&mut self, layer: &mut Layer, facets: &Facets, is_alone: bool) {
        let Facets { roughness, alphas, turn } = facets;
        let Some(alphas) = alphas else {
            if is_zero(roughness) {
                layer.set("smooth", Setting::Bool(true));
            } else if !varies(roughness) || is_alone && roughness.scaled().is_some() {
                self.put(layer, ["roughness", "roughness"], roughness, 1, [0.3, 1.0]);
            } else {
                let alpha = Expression::of(&[roughness], |v| {
                    let r = v[0].first().clamp(0.0, 1.0);
                    Value::number(r * r)
                });
                self.put(layer, ["alpha", "alpha"], &alpha, 1, [0.1, 1.0]);
            }
            return;
        };
        for (key, alpha) in ["alpha_x", "alpha_y"].into_iter().zip(alphas) {
            let alpha = Expression::of(&[alpha], |v| Value::number(v[0].first().max(1e-6)));
            self.put(layer, [key, key], &alpha, 1, [0.1, 1.0]);
        }
        match turn.constant() {
            Some(turn) => {
                let turn = turn.first() - libm::round(turn.first());
                if turn.abs() > 1e-9 {
                    layer.set("rotation_deg", Setting::Number(turn * 360.0));
                }
            }
            None => {
                let doubled = Expression::of(&[turn], |v| {
                    let (sin, cos) = libm::sincos(2.0 * std::f64::consts::TAU * v[0].first());
                    Value::rgb([0.5 + 0.5 * cos, 0.5 + 0.5 * sin, 0.0])
                });
                let found = self.pictured.plain("tangent", &doubled);
                if let Some(Scaled { map: Some(picture), notes, .. }) = self.told("tangent", found) {
                    layer.map("tangent", picture);
                    self.pictured_as("tangent", true, notes);
                }
            }
        }
    }

    fn coat(&mut self, given: &Coat, base_normal: Option<&Input>) -> Layer {
        let mut coat = Layer::new("dielectric");
        let ior = self.held("index of the coat", given.ior, [1.001, 10.0]);
        coat.set("ior", Setting::Number(ior));
        self.facets(&mut coat, &given.facets, false);
        if given.weight.constant().is_none_or(|value| value.first() < 1.0) {
            self.put(&mut coat, ["weight", "weight"], &given.weight, 1, [1.0, 1.0]);
        }
        if !given.darkens {
            coat.set("darkening", Setting::Bool(false));
        }
        if given.color.constant().is_none_or(|value| value.three() != [1.0; 3]) {
            // Light goes through the slab twice.
            let absorption = Expression::of(&[&given.color], |v| {
                Value::rgb(v[0].three().map(|c| -0.5 * libm::log(c.clamp(TRANSMITTANCE_MIN, 1.0))))
            });
            coat.set("thickness_um", Setting::Number(1.0));
            self.put(&mut coat, ["absorption_per_um", "absorption"], &absorption, 3, [0.0, 100.0]);
        }
        let key = if same(given.normal.as_ref(), base_normal) { "normal" } else { "bumps" };
        self.normals(&mut coat, key, given.normal.as_ref());
        coat
    }

    /// The film; none where its thickness cannot be read.
    fn film(&mut self, given: &Film, has_coat: bool) -> Option<Layer> {
        let mut film = Layer::new("thin-film");
        let ior = self.held("index of the film", given.ior, [1.0, 10.0]);
        film.set("ior", Setting::Number(ior));
        let held = Expression::of(&[&given.thickness_nm], |v| v[0].map(|t| t.clamp(0.0, THICKNESS_MAX_NM)));
        let thickness = match given.thickness_nm.constant() {
            Some(value) => Setting::Number(self.held("thickness of the film", value.first(), [0.0, THICKNESS_MAX_NM])),
            None => match self.pictured.spread("thickness", &held) {
                Ok((range, Scaled { map: Some(map), notes, .. })) => {
                    self.pictured_as("thickness", true, notes);
                    Setting::Table(rules::thickness(range, &map))
                }
                Ok(([least, _], _)) if least > 0.0 => Setting::Number(least),
                Ok(_) => return None,
                Err(reason) => {
                    self.say("picture of the film's thickness", Fate::Dropped, reason);
                    return None;
                }
            },
        };
        film.set("thickness_nm", thickness);
        let is_whole = given.weight.constant().is_some_and(|value| value.first() >= 1.0);
        if !is_whole && has_coat {
            self.say("weight of the film", Fate::Dropped, "below a coat a film covers the whole surface");
        } else if !is_whole {
            self.put(&mut film, ["weight", "weight"], &given.weight, 1, [1.0, 1.0]);
        }
        Some(film)
    }
}

/// Whether two normal maps are one.
fn same(a: Option<&Input>, b: Option<&Input>) -> bool {
    a.zip(b).is_some_and(|(a, b)| expression::same(a, b))
}
