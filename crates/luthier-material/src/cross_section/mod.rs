//! Description of a cross-section through a material: its parts from the top down, with numbers, colours, heights and outlines. It draws
//! nothing: the window and pages draw it, each with its own lines and letters.

mod recorded;

use luthier_optics::Rgb;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Film, Layer, Surface};

use crate::bake_settings::SODIUM_D_NM;
use crate::effects::{Effects, FlakeSource};
use crate::material::{LayerExtras, Material};
use crate::picture::PictureRef;
use crate::suggest::short;

/// Cross-section through a material. Lengths are in widths of the drawing.
///
/// ```
/// let text = "schema = 1\nname = \"gilding\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nroughness = 0.3\n";
/// let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// let section = luthier_material::parse("gilding.toml", text, &no_files).unwrap().material.cross_section();
/// assert_eq!(section.parts.iter().map(|part| part.label.as_str()).collect::<Vec<_>>(), ["air", "conductor"]);
/// let [red, _, blue] = section.parts[1].color;
/// assert!(red > 2.0 * blue);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct CrossSection {
    /// Media from the exterior down to the base.
    pub parts: Vec<Part>,
    /// Effects of the whole surface, each with its numbers: `patina: extent 0.5, transition 0.2`.
    pub effects: Vec<String>,
}

/// One medium of a cross-section, between its upper boundary and that of the next part.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Kind of medium.
    pub kind: PartKind,
    /// Number of its layer in the stack, from 0; films have that of the interface that they coat, the exterior has none.
    pub layer: Option<usize>,
    /// Its name: `air`, `exterior`, `thin film`, `dielectric`, `conductor` or `diffuse`.
    pub label: String,
    /// Its numbers, each as a name and a value with its unit.
    pub numbers: Vec<PartNumber>,
    /// Linear Rec.709 in 0..=1: the share of light that a slab passes along the normal; the reflectance at normal incidence of an opaque medium
    /// without films, and of the coated interface for a film; the albedo of a diffuse base.
    pub color: Rgb,
    /// Height, which grows as the logarithm of the thickness and has room for the outlines: no drawing could show films and coats to scale.
    pub height: f64,
    /// Upper boundary from left to right: places across, 0 to 1, and heights above its mean. The slopes are to scale, and are those that the
    /// distribution of slopes has along the tangent: each segment has an equal share of them. Distributions other than Beckmann's are drawn as
    /// GGX. Two points where the boundary is smooth or has no facets.
    pub outline: Vec<[f64; 2]>,
}

/// Kind of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PartKind {
    /// Medium above the first layer.
    Exterior,
    /// Coherent film on the interface below.
    Film,
    /// Transparent or absorbing slab, down to the next layer.
    Slab,
    /// Transparent medium without an end: light that enters it is lost.
    HalfSpace,
    /// Opaque medium.
    Conductor,
    /// Opaque diffuse base.
    Diffuse,
}

/// A number of a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartNumber {
    /// Its name: `n`, `alpha`, `thickness`.
    pub name: &'static str,
    /// Its value with its unit; three values for red, green and blue.
    pub value: String,
}

/// Segments of an outline.
const SEGMENTS: usize = 48;

/// Ranks of the slopes of the segments, from the left: an irregular order in which the outline stays level.
const RANKS: [usize; SEGMENTS] = [
    10, 17, 20, 12, 44, 37, 9, 26, 32, 40, 41, 16, 33, 31, 6, 21, 25, 1, 5, 29, 7, 18, 38, 43, 42, 39, 24, 2, 47, 11,
    13, 34, 36, 8, 0, 14, 30, 15, 19, 3, 46, 22, 27, 35, 4, 23, 28, 45,
];

/// Extinction coefficient of clear media in data sets, which is too small to show.
const TRACE_OF_K: f64 = 1e-6;

/// Height of the exterior, and least heights of a film, of a slab and of a medium without a thickness.
const EXTERIOR: f64 = 0.12;
const FILM: f64 = 0.05;
const SLAB: f64 = 0.14;
const BASE: f64 = 0.26;

/// Added height of a film of ten times the thickness, in nm over [`FILM_UNIT_NM`], and of a slab, in um.
const FILM_DECADE: f64 = 0.05;
const SLAB_DECADE: f64 = 0.08;
const FILM_UNIT_NM: f64 = 100.0;

impl Material {
    /// A cross-section through the material as it is: after edits, other than in its file.
    pub fn cross_section(&self) -> CrossSection {
        let mut parts = vec![Part {
            kind: PartKind::Exterior,
            layer: None,
            label: if is_vacuum(&self.stack.exterior) { "air".to_owned() } else { "exterior".to_owned() },
            numbers: self.index("exterior", &self.stack.exterior),
            color: [1.0; 3],
            height: EXTERIOR,
            outline: level(),
        }];
        for (number, layer) in self.stack.layers.iter().enumerate() {
            let has_facets = !matches!(layer.base, Base::Diffuse(_)) && !layer.surface.is_smooth();
            let outline = if has_facets { outline(&layer.surface) } else { level() };
            for i in 0..layer.films.len() {
                parts.push(self.film(number, i, outline.clone()));
            }
            parts.push(self.medium(number, layer, outline));
        }
        CrossSection { parts: with_room(parts), effects: effects(&self.effects) }
    }

    fn film(&self, number: usize, i: usize, outline: Vec<[f64; 2]>) -> Part {
        let Film { ior, thickness } = &self.stack.layers[number].films[i];
        let (least, most) = (thickness.min_nm, thickness.max_nm);
        let mut numbers = self.index(&format!("layer.{number}.film.{i}.ior"), ior);
        let range = if least < most { format!("{} to {} nm", short(least), short(most)) } else { nm(least) };
        numbers.insert(0, PartNumber { name: "thickness", value: range });
        if let Some(variation) = self.layers[number].film_variation.as_ref().filter(|_| i == 0) {
            let map = variation.source.image().map_or_else(|| "noise".to_owned(), PictureRef::label);
            numbers.push(PartNumber { name: "map", value: format!("{map}, {} µm", short(variation.extent_um)) });
        }
        Part {
            kind: PartKind::Film,
            layer: Some(number),
            label: "thin film".to_owned(),
            numbers,
            color: self.reflected(number, true),
            height: film_height(thickness.nominal_nm()),
            outline,
        }
    }

    fn medium(&self, number: usize, layer: &Layer, outline: Vec<[f64; 2]>) -> Part {
        let key = format!("layer.{number}.ior");
        let is_last = number + 1 == self.stack.layers.len();
        let (kind, label, mut numbers, color, height) = match &layer.base {
            Base::Dielectric { ior, slab } if !is_last => {
                let mut numbers = self.index(&key, ior);
                let depth = slab.optical_depth();
                if slab.thickness_um > 0.0 {
                    numbers
                        .insert(0, PartNumber { name: "thickness", value: format!("{} µm", short(slab.thickness_um)) });
                }
                if slab.absorption_per_um != [0.0; 3] {
                    numbers
                        .push(PartNumber {
                            name: "absorption", value: format!("{} /µm", rgb(slab.absorption_per_um))
                        });
                }
                let height = SLAB + SLAB_DECADE * libm::log10(1.0 + slab.thickness_um);
                (PartKind::Slab, "dielectric", numbers, depth.map(|depth| libm::exp(-depth)), height)
            }
            Base::Dielectric { ior, .. } => {
                (PartKind::HalfSpace, "dielectric", self.index(&key, ior), self.reflected(number, false), BASE)
            }
            Base::Conductor { ior } => {
                (PartKind::Conductor, "conductor", self.index(&key, ior), self.reflected(number, false), BASE)
            }
            Base::Diffuse(diffuse) => {
                let mut numbers = vec![PartNumber { name: "albedo", value: rgb(diffuse.albedo) }];
                if diffuse.sigma > 0.0 {
                    numbers.push(PartNumber { name: "facet angle", value: format!("{} rad", short(diffuse.sigma)) });
                }
                (PartKind::Diffuse, "diffuse", numbers, diffuse.albedo, BASE)
            }
        };
        if kind != PartKind::Diffuse {
            numbers.extend(roughness(&layer.surface));
        }
        numbers.extend(beyond(&self.layers[number]));
        Part {
            kind,
            layer: Some(number),
            label: label.to_owned(),
            numbers,
            color: color.map(|c| c.clamp(0.0, 1.0)),
            height,
            outline,
        }
    }

    /// Reflectance of an interface at normal incidence, with its films or without, in the colour of the bake.
    fn reflected(&self, number: usize, has_films: bool) -> Rgb {
        let Some(mut interface) = Interface::of(&self.stack, number) else { return [0.0; 3] };
        interface.films.truncate(if has_films { interface.films.len() } else { 0 });
        interface.sampled(&self.color()).rgb(1.0).map(|c| c.clamp(0.0, 1.0))
    }

    /// The index of a medium: F0, or n and k, at the sodium line if they vary, with the name of the data set.
    fn index(&self, key: &str, ior: &Ior) -> Vec<PartNumber> {
        if let Some(f0) = ior.f0() {
            let mut numbers = vec![PartNumber { name: "F0", value: rgb(f0) }];
            if ior.f82_tint() != [1.0; 3] {
                numbers.push(PartNumber { name: "edge tint", value: rgb(ior.f82_tint()) });
            }
            return numbers;
        }
        let mut numbers = Vec::new();
        let index = ior.at(SODIUM_D_NM);
        let at = if ior.is_constant() { String::new() } else { format!(" at {} nm", short(SODIUM_D_NM)) };
        if let Some(name) = self.data_set(key).filter(|_| !ior.is_constant()) {
            numbers.push(PartNumber { name: "data", value: name.to_owned() });
        }
        numbers.push(PartNumber { name: "n", value: format!("{}{at}", short(index.re)) });
        if index.im > TRACE_OF_K {
            numbers.push(PartNumber { name: "k", value: format!("{}{at}", short(index.im)) });
        }
        numbers
    }

    /// The name of a data set or of a file, if the index at a key is given by one.
    fn data_set(&self, key: &str) -> Option<&str> {
        let text = self.places.has(key).then(|| self.text.get(self.places.span(key)))??;
        text.strip_prefix(['"', '\''])?.strip_suffix(['"', '\''])
    }
}

fn is_vacuum(ior: &Ior) -> bool {
    ior.is_constant() && ior.at(SODIUM_D_NM).re == 1.0
}

/// Slope parameters, and the distribution where it is not the default; `smooth` where they are 0.
fn roughness(surface: &Surface) -> Vec<PartNumber> {
    if surface.is_smooth() {
        return vec![PartNumber { name: "surface", value: "smooth".to_owned() }];
    }
    let Surface { distribution, alpha_x, alpha_y, rotation } = *surface;
    let value = match (alpha_x == alpha_y, rotation == 0.0) {
        (true, _) => short(alpha_x),
        (false, true) => format!("{} × {}", short(alpha_x), short(alpha_y)),
        (false, false) => format!("{} × {}, turned {}°", short(alpha_x), short(alpha_y), short(rotation.to_degrees())),
    };
    let mut numbers = vec![PartNumber { name: "alpha", value }];
    if distribution != Distribution::Ggx {
        numbers.push(PartNumber { name: "distribution", value: distribution.name().to_owned() });
    }
    numbers
}

/// Properties of a layer beyond its physics.
fn beyond(extras: &LayerExtras) -> Vec<PartNumber> {
    let mut numbers = Vec::new();
    if extras.weight < 1.0 {
        numbers.push(PartNumber { name: "weight", value: short(extras.weight) });
    }
    if extras.reradiation.is_some() {
        numbers.push(PartNumber { name: "light", value: "fluorescent".to_owned() });
    }
    if extras.brightening.is_some() {
        numbers.push(PartNumber { name: "darkening", value: "undone".to_owned() });
    }
    if let Some(metallic) = extras.metallic {
        let color = if metallic.is_metal { "F0" } else { "base colour" };
        numbers.push(PartNumber { name: color, value: rgb(metallic.base_color) });
        if !metallic.is_metal {
            numbers.push(PartNumber { name: "metallic", value: short(metallic.metallic) });
        }
        if metallic.f82_tint != [1.0; 3] {
            numbers.push(PartNumber { name: "edge tint", value: rgb(metallic.f82_tint) });
        }
    }
    if let Some([outer, inner]) = extras.exponents {
        numbers.push(PartNumber { name: "exponents", value: format!("{}, {}", short(outer), short(inner)) });
    }
    numbers.extend(
        extras.maps.named().map(|map| PartNumber { name: map.key, value: format!("× {}", map.picture.label()) }),
    );
    numbers
}

fn effects(effects: &Effects) -> Vec<String> {
    let mut found = Vec::new();
    if let Some(record) = &effects.patina {
        found.push(patina(record.extent, record.transition));
    }
    if let Some(record) = &effects.flakes {
        let source = match &record.source {
            FlakeSource::NormalMap(picture) | FlakeSource::HeightMap { picture, .. } => picture.label(),
            FlakeSource::Cells { count, spread, .. } => flake_cells(*count, *spread),
        };
        found.push(flakes(&source, record.scale, record.tiling));
    }
    if let Some(record) = &effects.glitter {
        found.push(glitter(record.frequency, record.filled, record.tilt));
    }
    found
}

fn patina(extent: f64, transition: f64) -> String {
    format!("patina: extent {}, transition {}", short(extent), short(transition))
}

fn flakes(source: &str, scale: f64, tiling: f64) -> String {
    format!("flakes: {source}, weight {}, tiling {}", short(scale), short(tiling))
}

/// Flakes in cells, whose slope angle has a standard deviation in radians.
fn flake_cells(count: u32, spread: f64) -> String {
    format!("{count} cells, spread {}°", short(spread.to_degrees()))
}

/// Glitter with a largest tilt in radians.
fn glitter(frequency: f64, filled: f64, tilt: f64) -> String {
    format!("glitter: {} cells, filled {}, tilt {}°", short(frequency), short(filled), short(tilt.to_degrees()))
}

fn film_height(thickness_nm: f64) -> f64 {
    FILM + FILM_DECADE * libm::log10(1.0 + thickness_nm / FILM_UNIT_NM)
}

/// Outline of a boundary without facets.
fn level() -> Vec<[f64; 2]> {
    vec![[0.0, 0.0], [1.0, 0.0]]
}

/// Parts with room for outlines that rise into them from below and fall into them from above.
fn with_room(mut parts: Vec<Part>) -> Vec<Part> {
    let outlines = parts.iter().map(|part| part.outline.iter());
    let reaches: Vec<f64> = outlines.map(|line| line.fold(0.0, |most: f64, [_, y]| most.max(y.abs()))).collect();
    for (i, part) in parts.iter_mut().enumerate() {
        let next = reaches.get(i + 1).copied().unwrap_or(0.0);
        // Lines of films run in parallel with the interface that they coat.
        part.height += if part.kind == PartKind::Film { 0.0 } else { reaches[i] + next };
    }
    parts
}

fn nm(value: f64) -> String {
    format!("{} nm", short(value))
}

/// Three numbers, or one for three that are equal.
fn rgb(rgb: Rgb) -> String {
    let [r, g, b] = rgb;
    if r == g && g == b { short(r) } else { format!("{}, {}, {}", short(r), short(g), short(b)) }
}

/// Upper boundary of a rough surface: see [`Part::outline`].
fn outline(surface: &Surface) -> Vec<[f64; 2]> {
    let quantile = if surface.distribution == Distribution::Beckmann { beckmann_slope } else { ggx_slope };
    let step = 1.0 / SEGMENTS as f64;
    let mut heights = vec![0.0];
    for i in 0..SEGMENTS {
        let rank = RANKS[i];
        let u = 2.0 * (rank as f64 + 0.5) * step - 1.0;
        heights.push(heights[i] + surface.alpha_x * quantile(u) * step);
    }
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    heights.iter().enumerate().map(|(i, height)| [i as f64 * step, height - mean]).collect()
}

/// The slope along a line of GGX of alpha 1 that `(1 + u)/2` of all slopes stay below: its density is `(1 + x^2)^(-3/2) / 2`.
fn ggx_slope(u: f64) -> f64 {
    u / (1.0 - u * u).sqrt()
}

/// The slope along a line of Beckmann's distribution of alpha 1 that `(1 + u)/2` of all slopes stay below: the inverse of `erf`, by bisection.
fn beckmann_slope(u: f64) -> f64 {
    let (mut low, mut high) = (-4.0, 4.0);
    for _ in 0..48 {
        let middle = 0.5 * (low + high);
        if libm::erf(middle) < u { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;

    const STACK: &str = r#"
schema = 1
name = "m"

[[layer]]
type = "thin-film"
ior = 2.2
thickness_nm = 300

[[layer]]
type = "dielectric"
ior = 1.5
alpha = 0.3
thickness_um = 20
absorption_per_um = [0.01, 0.02, 0.1]

[[layer]]
type = "conductor"
ior = "au"
slope_deg = 4
distribution = "beckmann"
"#;

    fn material(text: &str) -> Material {
        parse("m.toml", text, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap().material
    }

    fn number<'p>(part: &'p Part, name: &str) -> Option<&'p str> {
        part.numbers.iter().find(|number| number.name == name).map(|number| number.value.as_str())
    }

    #[test]
    fn parts_go_down_with_their_numbers() {
        let section = material(STACK).cross_section();
        let kinds: Vec<PartKind> = section.parts.iter().map(|part| part.kind).collect();
        assert_eq!(kinds, [PartKind::Exterior, PartKind::Film, PartKind::Slab, PartKind::Conductor]);
        let [air, film, slab, gold] = &section.parts[..] else { panic!("four parts") };
        assert_eq!((air.label.as_str(), number(air, "n")), ("air", Some("1")));
        assert_eq!([number(film, "thickness"), number(film, "n")], [Some("300 nm"), Some("2.2")]);
        assert_eq!(number(slab, "absorption"), Some("0.01, 0.02, 0.1 /µm"));
        assert_eq!([number(slab, "thickness"), number(slab, "alpha")], [Some("20 µm"), Some("0.3")]);
        assert!((slab.color[2] - libm::exp(-2.0)).abs() < 1e-12, "light that passes: {:?}", slab.color);
        assert_eq!([number(gold, "data"), number(gold, "distribution")], [Some("au"), Some("beckmann")]);
        assert!(number(gold, "n").unwrap().ends_with(" at 589.3 nm"));
        assert!(gold.color[0] > 1.5 * gold.color[2], "gold is yellow: {:?}", gold.color);
        assert!(
            film.color != slab.color && film.color[0] > 0.0,
            "a film has the colour of interference: {:?}",
            film.color
        );
        assert_eq!(film.outline, slab.outline, "a film has the surface of the interface below");
    }

    /// The window shows edits before any file has them.
    #[test]
    fn it_shows_the_material_and_not_its_text() {
        let mut edited = material(STACK);
        edited.stack.layers[0].surface = Surface::smooth();
        let Base::Dielectric { slab, .. } = &mut edited.stack.layers[0].base else { panic!("a dielectric") };
        slab.thickness_um = 200.0;
        let [before, after] = [material(STACK), edited].map(|material| material.cross_section().parts[2].clone());
        assert_eq!([number(&after, "thickness"), number(&after, "surface")], [Some("200 µm"), Some("smooth")]);
        assert_eq!(after.outline, [[0.0, 0.0], [1.0, 0.0]]);
        let reach = |part: &Part| part.outline.iter().fold(0.0, |most: f64, [_, y]| most.max(y.abs()));
        let added = (after.height - reach(&after)) - (before.height - reach(&before));
        assert!((added - SLAB_DECADE * libm::log10(201.0 / 21.0)).abs() < 1e-12, "{added}");
    }

    /// Slopes of the segments against the second moment of Beckmann's distribution, alpha^2 / 2 along a line (Heitz 2014), and the quartiles
    /// of GGX, alpha / sqrt(3).
    #[test]
    fn outlines_have_the_slopes_of_the_distribution() {
        let slopes = |distribution, alpha| -> Vec<f64> {
            let outline = outline(&Surface::isotropic(distribution, alpha));
            assert_eq!(outline.len(), SEGMENTS + 1);
            assert!((outline[0][1] - outline[SEGMENTS][1]).abs() < 1e-12, "it ends as high as it begins");
            let mut slopes: Vec<f64> =
                outline.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])).collect();
            slopes.sort_by(f64::total_cmp);
            slopes
        };
        for alpha in [0.05, 0.3, 1.0] {
            let beckmann = slopes(Distribution::Beckmann, alpha);
            let moment = beckmann.iter().map(|slope| slope * slope).sum::<f64>() / SEGMENTS as f64;
            assert!((moment / (0.5 * alpha * alpha) - 1.0).abs() < 0.05, "{moment}");
            let ggx = slopes(Distribution::Ggx, alpha);
            let quartile = 0.5 * (ggx[SEGMENTS * 3 / 4 - 1] + ggx[SEGMENTS * 3 / 4]);
            assert!((quartile / (alpha / 3.0_f64.sqrt()) - 1.0).abs() < 0.02, "{quartile}");
        }
    }

    #[test]
    fn each_slope_is_drawn_once() {
        let mut ranks = RANKS;
        ranks.sort_unstable();
        assert!(ranks.iter().enumerate().all(|(i, rank)| i == *rank));
    }

    #[test]
    fn outlines_stay_within_their_parts() {
        for alpha in [0.1, 1.0] {
            let text = STACK.replace("alpha = 0.3", &format!("alpha = {alpha}"));
            let section = material(&text).cross_section();
            for pair in section.parts.windows(2) {
                let reach = |part: &Part| part.outline.iter().fold(0.0, |most: f64, [_, y]| most.max(y.abs()));
                let room = if pair[0].kind == PartKind::Film { f64::INFINITY } else { pair[0].height };
                assert!(reach(&pair[0]) + reach(&pair[1]) < room, "{pair:?}");
            }
        }
    }
}
