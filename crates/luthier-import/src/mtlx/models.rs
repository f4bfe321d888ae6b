//! Surface shaders of MaterialX as surfaces.

use std::sync::Arc;

use super::expression::Expression;
use super::inputs::{Inputs, Note};
use super::surface::{Coat, Facets, Film, Surface};
use super::value::Value;
use crate::Fate::{Approximated, ClosedForm, Dropped, Host};
use crate::Line;
use crate::rules::{f0, gltf_alphas};

type Input = Arc<Expression>;

/// Index of coats of formats that fix it.
const COAT_IOR: f64 = 1.5;

const THROUGH: &str = "light that goes through: the base is opaque";
const CLOTH: &str = "cloth";
const BENEATH: &str = "shown as the colour of the base: light leaves where it enters";
const SENT: &str = "light that the surface sends out itself";
const CUT: &str = "where the surface is cut out or blended";
const F0: &str = "f0 = ((n - 1)/(n + 1))^2";
const TURN: &str = "turned from the surface's tangent, counter-clockwise";
const CLOCKWISE: &str = "turned from the surface's tangent, clockwise, as the graph of the format does";
const DIRECTIONS: &str = "directions of the tangent are those of the mesh";
const NO_EDGE: &str = "the edge tint of a metal is one for all places: with a picture there is none";
const BRIGHT_EDGE: &str = "the format's curve is brighter than Schlick's formula between 30 and 85 degrees, and an edge tint only darkens: Schlick's formula";
const UNDARKENED: &str = "the coat is layered, with light that goes to and fro below it; the base stays as bright as its colour (`darkening = false`)";
const EDGE_TOO: &str = "the format scales what the edge reflects, too, which is all here";

/// A shader as a surface, with what became of each input.
pub(super) type Model = fn(Inputs<'_>) -> (Surface, Vec<Line>);

/// The function of a shader; `None` where it is none that is read.
pub(super) fn model(category: &str) -> Option<Model> {
    Some(match category {
        "standard_surface" => standard_surface,
        "open_pbr_surface" => open_pbr,
        "gltf_pbr" => gltf,
        "UsdPreviewSurface" => usd,
        "disney_principled" => disney,
        _ => return None,
    })
}

fn mix(a: &Input, b: &Input, share: &Input) -> Input {
    if share.constant().is_some_and(|share| share.first() <= 0.0) {
        return Arc::clone(a);
    }
    Expression::of(&[a, b, share], |v| {
        let [x, y] = [v[0], v[1]].map(|value| Value::rgb(value.three()));
        x.zip(v[2], |x, s| x * (1.0 - s)).zip(y.zip(v[2], |y, s| y * s), |x, y| x + y)
    })
}

/// A share of what is no metal.
fn not_metal(share: &Input, metallic: &Input) -> Input {
    if share.constant().is_some_and(|share| share.first() <= 0.0) {
        return Arc::clone(share);
    }
    Expression::of(&[share, metallic], |v| Value::number(v[0].first() * (1.0 - v[1].first().clamp(0.0, 1.0))))
}

/// A number as a grey.
fn rgb(number: &Input) -> Input {
    Expression::of(&[number], |v| Value::rgb(v[0].three()))
}

fn white() -> Input {
    Expression::rgb([1.0; 3])
}

/// alpha = roughness^2, stretched by the aspect of an anisotropy (Standard Surface; `roughness_anisotropy` of MaterialX).
fn aspect_alphas(roughness: f64, anisotropy: f64) -> [f64; 2] {
    let (alpha, aspect) = (roughness * roughness, (1.0 - anisotropy.clamp(0.0, 0.98)).sqrt());
    [(alpha / aspect).min(1.0), alpha * aspect]
}

/// OpenPBR 1.1, section 3.1.
fn open_pbr_alphas(roughness: f64, anisotropy: f64) -> [f64; 2] {
    let rest = 1.0 - anisotropy;
    let along = roughness * roughness * (2.0 / (1.0 + rest * rest)).sqrt();
    [along.min(1.0), rest * along]
}

/// A coat of formats whose coats have no direction, and leave the base as bright as it is.
fn clear(weight: Input, ior: f64, roughness: Input, normal: Option<Input>) -> Coat {
    let none = Expression::number(0.0);
    let facets = Facets::new(roughness, &none, none.clone(), gltf_alphas);
    Coat { weight, ior, facets, color: white(), darkens: false, normal }
}

/// Schlick's reflectance of a metal at 82 degrees, a cosine of 1/7.
fn schlick_edge(f0: f64) -> f64 {
    f0 + (1.0 - f0) * libm::pow(6.0 / 7.0, 5.0)
}

/// The edge tint that meets the reflectance of Gulbrandsen's metal at 82 degrees; above 1 where that is brighter than Schlick's formula.
fn artistic_edge(reflectivity: f64, edge: f64) -> f64 {
    let (r, g) = (reflectivity.clamp(0.0, 0.99), edge.clamp(0.0, 1.0));
    let root = r.sqrt();
    let n = g * (1.0 - r) / (1.0 + r) + (1.0 - g) * (1.0 + root) / (1.0 - root);
    let k_sq = ((r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r)).max(0.0);
    let cos = 1.0 / 7.0;
    // Fresnel's equations of a metal, from n^2 - k^2 and n^2 k^2.
    let (cos_sq, sin_sq) = (cos * cos, 1.0 - cos * cos);
    let t0 = n * n - k_sq - sin_sq;
    let both = (t0 * t0 + 4.0 * n * n * k_sq).sqrt();
    let a = (0.5 * (both + t0)).max(0.0).sqrt();
    let s = (both + cos_sq - 2.0 * a * cos) / (both + cos_sq + 2.0 * a * cos);
    let p = s * (cos_sq * both + sin_sq * sin_sq - 2.0 * a * cos * sin_sq)
        / (cos_sq * both + sin_sq * sin_sq + 2.0 * a * cos * sin_sq);
    (0.5 * (s + p) / schlick_edge(r)).max(0.0)
}

fn standard_surface(mut of: Inputs<'_>) -> (Surface, Vec<Line>) {
    // The first release of the shader has other defaults.
    let [weight, grey] = if of.version() == Some("1.0.0") { [0.8, 1.0] } else { [1.0, 0.8] };
    let [base, base_color] = [of.number("base", weight), of.color("base_color", [grey; 3])];
    let color = base_color.times(&base);
    let subsurface = of.number("subsurface", 0.0);
    let beneath = of.color("subsurface_color", [1.0; 3]);
    let metallic = of.number("metalness", 0.0);
    let [coat, coat_color] = [of.number("coat", 0.0), of.color("coat_color", [1.0; 3])];
    let coat_roughness = of.number("coat_roughness", 0.1);
    let diffuse = mix(&color, &beneath, &not_metal(&subsurface, &metallic));
    let affect = of.number("coat_affect_color", 0.0);
    let diffuse = match affect.constant() {
        Some(value) if value.first() <= 0.0 => diffuse,
        _ => Expression::of(&[&diffuse, &affect, &coat, &metallic], |v| {
            let gamma = 1.0 + v[1].first() * v[2].first().clamp(0.0, 1.0) * (1.0 - v[3].first().clamp(0.0, 1.0));
            Value::rgb(v[0].three().map(|c| libm::pow(c.max(0.0), gamma)))
        }),
    };
    // Below the coat everything takes its colour.
    let tint = mix(&white(), &coat_color, &coat);
    let specular = of.number("specular", 1.0);
    let specular_color = of.color("specular_color", [1.0; 3]);
    let of_index = f0(of.fixed("specular_IOR", 1.5));
    let is_metal = !metallic.constant().is_some_and(|value| value.first() <= 0.0);
    let edge = match (color.constant(), specular.constant(), specular_color.constant()) {
        (Some(color), Some(specular), Some(edge)) => {
            let (color, edge) = (color.three(), edge.three().map(|c| c * specular.first()));
            let tint = [0, 1, 2].map(|c: usize| artistic_edge(color[c], edge[c]));
            if is_metal && tint.iter().any(|tint| *tint > 1.0) {
                of.lines.push(Line::new("the edge of a metal", Approximated, BRIGHT_EDGE));
            }
            tint.map(|tint| tint.min(1.0))
        }
        _ => {
            if is_metal {
                of.lines.push(Line::new("the edge of a metal", Approximated, NO_EDGE));
            }
            [1.0; 3]
        }
    };
    let roughness = of.number("specular_roughness", 0.2);
    let affect = of.number("coat_affect_roughness", 0.0);
    let roughness = match affect.constant() {
        Some(value) if value.first() <= 0.0 => roughness,
        _ => Expression::of(&[&roughness, &affect, &coat, &coat_roughness], |v| {
            let share = v[1].first() * v[2].first() * v[3].first();
            v[0].map(|r| r + (1.0 - r) * share)
        }),
    };
    let [anisotropy, turn] = [of.number("specular_anisotropy", 0.0), of.number("specular_rotation", 0.0)];
    let [coat_anisotropy, coat_turn] = [of.number("coat_anisotropy", 0.0), of.number("coat_rotation", 0.0)];
    let [turn, coat_turn] = [turn, coat_turn].map(|turn| Expression::of(&[&turn], |v| v[0].map(|t| -t)));
    let thickness_nm = of.number("thin_film_thickness", 0.0);
    let surface = Surface {
        color: diffuse.times(&tint),
        metallic,
        f0: rgb(&specular.times(&Expression::number(of_index))).times(&specular_color).times(&tint),
        edge,
        sigma: of.fixed("diffuse_roughness", 0.0),
        facets: Facets::new(roughness, &anisotropy, turn, aspect_alphas),
        normal: of.normal("normal"),
        coat: Some(Coat {
            weight: coat,
            ior: of.fixed("coat_IOR", 1.5),
            facets: Facets::new(coat_roughness, &coat_anisotropy, coat_turn, aspect_alphas),
            color: white(),
            darkens: false,
            normal: of.normal("coat_normal"),
        }),
        film: Some(Film { weight: Expression::number(1.0), thickness_nm, ior: of.fixed("thin_film_IOR", 1.5) }),
    };
    of.lost("transmission", THROUGH);
    of.lost("sheen", CLOTH);
    of.unread("tangent", DIRECTIONS);
    const NOTES: &[Note] = &[
        ("specular", Approximated, EDGE_TOO),
        (
            "specular_color",
            Approximated,
            "tints the F0 of a dielectric; of a metal the edge tint that meets the format's at 82 degrees",
        ),
        ("specular_IOR", ClosedForm, F0),
        ("specular_anisotropy", ClosedForm, "alpha = roughness^2 over and times sqrt(1 - anisotropy)"),
        ("specular_rotation", ClosedForm, CLOCKWISE),
        ("coat_rotation", ClosedForm, CLOCKWISE),
        ("coat", Approximated, UNDARKENED),
        ("coat_color", ClosedForm, "colour and F0 of the base times it, as the format means it"),
        ("subsurface", Approximated, BENEATH),
        ("thin_film_thickness", Approximated, "the film interferes by Airy's formula, over the F0 of the base"),
        ("emission", Host, SENT),
        ("emission_color", Host, SENT),
        ("opacity", Host, CUT),
        ("thin_walled", Host, "which sides are drawn"),
    ];
    (surface, of.finish(NOTES, &["transmission_", "sheen_", "subsurface_", "caustics"]))
}

/// Slope deviation of Oren and Nayar's diffuse light over the roughness of OpenPBR's, which gives back the light that facets catch: at a roughness of 1 the albedo is within
/// .03 of that, and Fujii's deviation of the same shape would lose two fifths.
const SIGMA: f64 = 0.3;

fn open_pbr(mut of: Inputs<'_>) -> (Surface, Vec<Line>) {
    let color = of.color("base_color", [0.8; 3]).times(&of.number("base_weight", 1.0));
    let metallic = of.number("base_metalness", 0.0);
    let [beneath, share] = [of.color("subsurface_color", [0.8; 3]), of.number("subsurface_weight", 0.0)];
    let color = mix(&color, &beneath, &not_metal(&share, &metallic));
    let specular_color = of.color("specular_color", [1.0; 3]);
    let specular_weight = of.number("specular_weight", 1.0);
    let coat_weight = of.number("coat_weight", 0.0);
    let [ior, coat_ior] = [of.fixed("specular_ior", 1.5), of.fixed("coat_ior", 1.6)];
    // Below a coat the index is relative to it, and turned over where it is below 1, as the format has it against total reflection.
    let below = (ior / coat_ior).max(coat_ior / ior);
    let reflectance = Expression::of(&[&coat_weight, &specular_weight], move |v| {
        let weight = v[0].first().clamp(0.0, 1.0);
        Value::number((v[1].first() * f0(ior + (below - ior) * weight)).clamp(0.0, 1.0))
    });
    let edge = if metallic.constant().is_none_or(|value| value.first() > 0.0) {
        specular_color.constant().map_or_else(
            || {
                of.lines.push(Line::new("the edge of a metal", Approximated, NO_EDGE));
                [1.0; 3]
            },
            Value::three,
        )
    } else {
        [1.0; 3]
    };
    // A metal loses all of its light, a dielectric what its interface reflects.
    let color = match specular_weight.constant() {
        Some(weight) if weight.first() == 1.0 => color,
        _ => color.times(&Expression::of(&[&specular_weight, &metallic], |v| {
            let metal = v[1].first().clamp(0.0, 1.0);
            Value::number(1.0 - metal + metal * v[0].first())
        })),
    };
    let [anisotropy, coat_anisotropy] =
        [of.number("specular_roughness_anisotropy", 0.0), of.number("coat_roughness_anisotropy", 0.0)];
    let [roughness, coat_roughness] = [of.number("specular_roughness", 0.3), of.number("coat_roughness", 0.0)];
    let darkening = of.fixed("coat_darkening", 1.0);
    let microns = of.number("thin_film_thickness", 0.5);
    let no_turn = || Expression::number(0.0);
    let surface = Surface {
        color,
        metallic,
        f0: rgb(&reflectance).times(&specular_color),
        edge,
        sigma: SIGMA * of.fixed("base_diffuse_roughness", 0.0).clamp(0.0, 1.0),
        facets: Facets::new(roughness, &anisotropy, no_turn(), open_pbr_alphas),
        normal: of.normal("geometry_normal"),
        coat: Some(Coat {
            weight: coat_weight,
            ior: coat_ior,
            facets: Facets::new(coat_roughness, &coat_anisotropy, no_turn(), open_pbr_alphas),
            color: of.color("coat_color", [1.0; 3]),
            darkens: darkening >= 0.5,
            normal: of.normal("geometry_coat_normal"),
        }),
        film: Some(Film {
            weight: of.number("thin_film_weight", 0.0),
            thickness_nm: Expression::of(&[&microns], |v| v[0].map(|t| 1000.0 * t)),
            ior: of.fixed("thin_film_ior", 1.4),
        }),
    };
    of.lost("transmission_weight", THROUGH);
    of.lost("fuzz_weight", CLOTH);
    of.unread("geometry_tangent", DIRECTIONS);
    of.unread("geometry_coat_tangent", DIRECTIONS);
    const NOTES: &[Note] = &[
        ("specular_weight", ClosedForm, "scales F0"),
        (
            "specular_color",
            Approximated,
            "the edge tint of a metal; of a dielectric it tints F0, where the format tints what the edge reflects, too",
        ),
        ("specular_ior", ClosedForm, "f0 = ((n - 1)/(n + 1))^2, below a coat of the index over that of the coat"),
        (
            "specular_roughness_anisotropy",
            ClosedForm,
            "alpha_x = r^2 sqrt(2/(1 + (1 - a)^2)), alpha_y = (1 - a) alpha_x",
        ),
        (
            "base_diffuse_roughness",
            Approximated,
            "a slope deviation of Oren and Nayar of .3 times it, which loses as little light; the edge is not as flat",
        ),
        ("coat_color", ClosedForm, "a slab that absorbs -ln(colour)/2 along the normal"),
        ("subsurface_weight", Approximated, BENEATH),
        ("thin_film_weight", Approximated, "the film interferes by Airy's formula, over the F0 of the base"),
        ("emission_luminance", Host, SENT),
        ("emission_color", Host, SENT),
        ("geometry_opacity", Host, CUT),
        ("geometry_thin_walled", Host, "which sides are drawn"),
    ];
    let mut lines = of.finish(NOTES, &["transmission_", "fuzz_", "subsurface_"]);
    if darkening > 0.0 && darkening < 1.0 {
        lines.retain(|line| line.property != "coat_darkening");
        lines.push(Line::new("coat_darkening", Approximated, "a coat darkens its base or not: the nearer of both"));
    }
    (surface, lines)
}

fn gltf(mut of: Inputs<'_>) -> (Surface, Vec<Line>) {
    let of_index = f0(of.fixed("ior", 1.5));
    let specular_color = of.color("specular_color", [1.0; 3]);
    let specular = of.number("specular", 1.0);
    let reflectance = Expression::of(&[&specular_color, &specular], move |v| {
        Value::rgb(v[0].three().map(|c| (of_index * c).min(1.0) * v[1].first()))
    });
    let radians = of.number("anisotropy_rotation", 0.0);
    let turn = Expression::of(&[&radians], |v| v[0].map(|t| t / std::f64::consts::TAU));
    let [strength, coat_roughness] = [of.number("anisotropy_strength", 0.0), of.number("clearcoat_roughness", 0.0)];
    let surface = Surface {
        color: of.color("base_color", [1.0; 3]),
        metallic: of.number("metallic", 1.0),
        f0: reflectance,
        edge: [1.0; 3],
        sigma: 0.0,
        facets: Facets::new(of.number("roughness", 1.0), &strength, turn, gltf_alphas),
        normal: of.normal("normal"),
        coat: Some(clear(of.number("clearcoat", 0.0), COAT_IOR, coat_roughness, of.normal("clearcoat_normal"))),
        film: Some(Film {
            weight: of.number("iridescence", 0.0),
            thickness_nm: of.number("iridescence_thickness", 100.0),
            ior: of.fixed("iridescence_ior", 1.3),
        }),
    };
    of.lost("transmission", THROUGH);
    of.lost("sheen_color", CLOTH);
    of.unread("tangent", DIRECTIONS);
    const NOTES: &[Note] = &[
        ("ior", ClosedForm, F0),
        ("specular", Approximated, EDGE_TOO),
        (
            "specular_color",
            Approximated,
            "the base loses what the interface reflects of each channel, where glTF takes the brightest",
        ),
        ("anisotropy_strength", ClosedForm, "alpha_x = alpha + (1 - alpha) strength^2, alpha_y = alpha = roughness^2"),
        ("anisotropy_rotation", ClosedForm, TURN),
        ("clearcoat", Approximated, UNDARKENED),
        ("iridescence", Approximated, "the film interferes by Airy's formula: glTF has a fit of two orders"),
        ("emissive", Host, SENT),
        ("emissive_strength", Host, SENT),
        ("occlusion", Host, "how much of the surroundings a place sees"),
        ("alpha", Host, CUT),
        ("alpha_mode", Host, CUT),
        ("alpha_cutoff", Host, CUT),
    ];
    (surface, of.finish(NOTES, &["sheen_", "thickness", "attenuation_", "dispersion"]))
}

fn usd(mut of: Inputs<'_>) -> (Surface, Vec<Line>) {
    let ior = of.fixed("ior", 1.5);
    let has_specular = of.fixed("useSpecularWorkflow", 0.0) > 0.5;
    let [metallic, specular] = [of.number("metallic", 0.0), of.color("specularColor", [0.0; 3])];
    let none = Expression::number(0.0);
    let [roughness, coat_roughness] = [of.number("roughness", 0.5), of.number("clearcoatRoughness", 0.01)];
    let color = of.color("diffuseColor", [0.18; 3]);
    // A metal reflects its colour at the edge, too.
    let edge = match color.constant() {
        Some(color) => color.three().map(|c| c / schlick_edge(c)),
        None => {
            if !has_specular && !metallic.constant().is_some_and(|value| value.first() <= 0.0) {
                of.lines.push(Line::new("the edge of a metal", Approximated, NO_EDGE));
            }
            [1.0; 3]
        }
    };
    let surface = Surface {
        color,
        metallic: if has_specular { none.clone() } else { metallic },
        f0: if has_specular { specular } else { Expression::rgb([f0(ior); 3]) },
        edge,
        sigma: 0.0,
        facets: Facets::new(roughness, &none, none.clone(), gltf_alphas),
        normal: of.normal("normal"),
        coat: Some(clear(of.number("clearcoat", 0.0), ior, coat_roughness, None)),
        film: None,
    };
    const NOTES: &[Note] = &[
        ("ior", ClosedForm, F0),
        ("clearcoat", Approximated, UNDARKENED),
        ("emissiveColor", Host, SENT),
        ("opacity", Host, CUT),
        ("opacityMode", Host, CUT),
        ("opacityThreshold", Host, CUT),
        ("occlusion", Host, "how much of the surroundings a place sees"),
        ("displacement", Dropped, "the form of the surface"),
    ];
    (surface, of.finish(NOTES, &[]))
}

fn disney(mut of: Inputs<'_>) -> (Surface, Vec<Line>) {
    let color = of.color("baseColor", [0.16; 3]);
    let tint = mix(&white(), &color, &of.number("specularTint", 0.0));
    let specular = of.number("specular", 0.5);
    let none = Expression::number(0.0);
    let gloss = of.number("clearcoatGloss", 1.0);
    let coat_roughness = Expression::of(&[&gloss], |v| v[0].map(|gloss| 1.0 - gloss));
    let anisotropy = of.number("anisotropic", 0.0);
    let surface = Surface {
        metallic: of.number("metallic", 0.0),
        f0: rgb(&specular.times(&Expression::number(0.08))).times(&tint),
        color,
        edge: [1.0; 3],
        sigma: 0.0,
        facets: Facets::new(of.number("roughness", 0.5), &anisotropy, none.clone(), aspect_alphas),
        normal: of.normal("normal"),
        coat: Some(clear(of.number("clearcoat", 0.0), COAT_IOR, coat_roughness, None)),
        film: None,
    };
    of.lost("specTrans", THROUGH);
    of.lost("sheen", CLOTH);
    const NOTES: &[Note] = &[
        ("specular", Approximated, "f0 = .08 specular; the edge reflects all here, and 0.08 specular in MaterialX"),
        ("specularTint", ClosedForm, "F0 times the mix of white and the colour"),
        ("anisotropic", ClosedForm, "alpha = roughness^2 over and times sqrt(1 - anisotropic)"),
        (
            "roughness",
            Approximated,
            "facets are its square; the diffuse part is Lambert's, where the format brightens its edge by roughness",
        ),
        ("clearcoat", Approximated, UNDARKENED),
        ("clearcoatGloss", Approximated, "alpha = (1 - gloss)^2 of GGX"),
        ("subsurface", Approximated, BENEATH),
    ];
    (surface, of.finish(NOTES, &["sheen", "ior", "subsurfaceDistance"]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, wanted: f64, within: f64) {
        assert!((found - wanted).abs() <= within, "{found}, wanted {wanted}");
    }

    /// The four conventions of anisotropy at r = .4, a = .5, as published: none is another one.
    #[test]
    fn conventions_of_anisotropy_differ() {
        let rows = [
            (aspect_alphas as fn(f64, f64) -> [f64; 2], [0.226, 0.113]),
            (gltf_alphas, [0.370, 0.160]),
            (open_pbr_alphas, [0.202, 0.101]),
        ];
        for (rule, wanted) in rows {
            let found = rule(0.4, 0.5);
            near(found[0], wanted[0], 5e-4);
            near(found[1], wanted[1], 5e-4);
        }
    }

    /// Fresnel's equations in complex numbers, which this crate computes otherwise.
    #[test]
    fn edges_of_artistic_metals_are_fresnels() {
        // r = .5, g = .5: n = .5/3 + .5 (1 + sqrt .5)/(1 - sqrt .5), k^2 as Gulbrandsen 2014.
        let (n, r): (f64, f64) = (0.5 / 3.0 + 0.5 * (1.0 + 0.5_f64.sqrt()) / (1.0 - 0.5_f64.sqrt()), 0.5);
        let k = ((r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r)).sqrt();
        // At 82 degrees the angle of refraction of so high an index is nearly the normal: cos_t = sqrt(1 - sin^2/(n - ik)^2).
        let cos = 1.0 / 7.0_f64;
        let mul = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
        let div = |a: (f64, f64), (c, d): (f64, f64)| {
            let square = c * c + d * d;
            let (x, y) = mul(a, (c, -d));
            (x / square, y / square)
        };
        let index = (n, k);
        let (x, y) = div((1.0 - cos * cos, 0.0), mul(index, index));
        let (x, y) = (1.0 - x, -y);
        let length = libm::hypot(x, y);
        let inside = (((length + x) / 2.0).sqrt(), y.signum() * ((length - x) / 2.0).sqrt());
        let power = |(a, b): (f64, f64)| a * a + b * b;
        let ratio = |a: (f64, f64), b: (f64, f64)| power(div((a.0 - b.0, a.1 - b.1), (a.0 + b.0, a.1 + b.1)));
        let [s, p] = [ratio((cos, 0.0), mul(index, inside)), ratio(mul(index, (cos, 0.0)), inside)];
        let schlick = r + (1.0 - r) * libm::pow(1.0 - cos, 5.0);
        near(artistic_edge(0.5, 0.5), 0.5 * (s + p) / schlick, 1e-9);
    }

    /// Gold of the format's default, a white `specular_color`, is brighter there than Schlick's formula; and a metal of `UsdPreviewSurface` as bright as its colour.
    #[test]
    fn edges_beyond_schlicks_formula_are_told() {
        assert!(artistic_edge(0.34, 1.0) > 1.2);
        let said = |text: &str| {
            let text = format!("<materialx version=\"1.39\">{text}</materialx>");
            let none = |_: &str| Err(std::io::ErrorKind::NotFound.into());
            crate::materialx("x.mtlx", text.as_bytes(), &none).unwrap().materials.remove(0)
        };
        let gold = |more: &str| {
            said(&format!(
                "<standard_surface name=\"gold\" type=\"surfaceshader\"><input name=\"base_color\" type=\"color3\" value=\"1, .78, .34\"/>\
                 <input name=\"metalness\" type=\"float\" value=\"1\"/>{more}</standard_surface>"
            ))
        };
        let told = |found: &crate::Imported| found.lines.iter().any(|line| line.note == BRIGHT_EDGE);
        assert!(told(&gold("")));
        assert!(!told(&gold("<input name=\"specular_color\" type=\"color3\" value=\".2, .2, .2\"/>")));
        let usd = said(
            "<UsdPreviewSurface name=\"grey\" type=\"surfaceshader\"><input name=\"diffuseColor\" type=\"color3\" value=\".5, .5, .5\"/>\
             <input name=\"metallic\" type=\"float\" value=\"1\"/></UsdPreviewSurface>",
        );
        // .5 / (.5 + .5 (6/7)^5) by hand.
        assert!(usd.text.contains("f82_tint = 0.68368"), "{}", usd.text);
    }
}
