//! The light of numbers, by the formula of a format.

use luthier_layers::engines::facets::Facets;
use luthier_layers::engines::{gltf, open_pbr, standard_surface};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::dielectric_albedo::JointMasking;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::schlick;
use luthier_optics::stack;

use crate::light::Values;
use crate::numbers::Film;
use crate::{Format, Numbers};

/// Intervals of the cosine of a film's reflectance.
const INTERVALS: usize = 48;

/// The function of numbers in a format. Colours of films are those of `color`.
///
/// glTF has the height-correlated masking of most viewers.
pub(crate) fn values(format: Format, numbers: &Numbers, color: &Color) -> Values {
    let films = numbers.film.as_ref().map(|film| films(format, numbers, film, color));
    match format {
        Format::Gltf => gltf_values(numbers, films),
        Format::OpenPbr => open_pbr_values(numbers, films),
        Format::StandardSurface => standard_surface_values(numbers, films),
    }
}

fn gltf_values(numbers: &Numbers, films: Option<[Curve; 2]>) -> Values {
    let material = gltf::Material {
        base_color: numbers.base_color,
        metallic: numbers.metallic,
        alpha: gltf_alphas(numbers.roughness, numbers.anisotropy),
        turn: numbers.turn,
        f0: plastic_f0(Format::Gltf, numbers),
        specular: numbers.specular,
        coat: numbers
            .coat
            .as_ref()
            .map(|coat| gltf::Coat { weight: coat.weight, alpha: coat.roughness * coat.roughness }),
        masking: JointMasking::Correlated,
    };
    Box::new(move |wi, wo| {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; 3];
        }
        let base = match &films {
            None => material.base(wi, wo),
            Some(films) => {
                let cos = luthier_layers::engines::facets::cos_theta_d(wi, wo);
                material.base_by([films[0].at(cos), films[1].at(cos)], wi, wo)
            }
        };
        material.coated(base, wi, wo).map(|f| f * wi.z)
    })
}

fn open_pbr_values(numbers: &Numbers, films: Option<[Curve; 2]>) -> Values {
    let material = open_pbr::Material {
        base_color: numbers.base_color,
        metallic: numbers.metallic,
        diffuse_roughness: numbers.diffuse_roughness,
        specular_weight: numbers.specular,
        specular_color: numbers.specular_color,
        ior: numbers.ior,
        roughness: numbers.roughness,
        anisotropy: numbers.anisotropy,
        turn: numbers.turn,
        coat: numbers.coat.as_ref().map(|coat| open_pbr::Coat {
            weight: coat.weight,
            color: coat.color,
            facets: Facets { alpha: open_pbr::alphas(coat.roughness, coat.anisotropy), turn: coat.turn },
            ior: coat.ior,
            darkening: if coat.darkens { 1.0 } else { 0.0 },
        }),
    };
    let below = material.below();
    Box::new(move |wi, wo| {
        let reflect = films.as_ref().map(|[plastic, metal]| (|cos| plastic.at(cos), |cos| metal.at(cos)));
        let films = reflect.as_ref().map(|(plastic, metal)| [plastic as &dyn Fn(f64) -> Rgb, metal]);
        material.eval_with(&below, films, wi, wo)
    })
}

fn standard_surface_values(numbers: &Numbers, films: Option<[Curve; 2]>) -> Values {
    let facets = |roughness, anisotropy, turn| Facets { alpha: standard_surface::alphas(roughness, anisotropy), turn };
    let material = standard_surface::Material {
        base_color: numbers.base_color,
        metallic: numbers.metallic,
        diffuse_roughness: numbers.diffuse_roughness,
        specular: numbers.specular,
        specular_color: numbers.specular_color,
        ior: numbers.ior,
        facets: facets(numbers.roughness, numbers.anisotropy, numbers.turn),
        coat: numbers.coat.as_ref().map(|coat| standard_surface::Coat {
            weight: coat.weight,
            color: coat.color,
            facets: facets(coat.roughness, coat.anisotropy, coat.turn),
            ior: coat.ior,
        }),
    };
    Box::new(move |wi, wo| {
        let reflect = films.as_ref().map(|[plastic, metal]| (|cos| plastic.at(cos), |cos| metal.at(cos)));
        let films = reflect.as_ref().map(|(plastic, metal)| [plastic as &dyn Fn(f64) -> Rgb, metal]);
        material.eval_with([1.0; 3], films, wi, wo)
    })
}

/// Slope parameters along and across the direction of `KHR_materials_anisotropy`.
pub(crate) fn gltf_alphas(roughness: f64, strength: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    [alpha + (1.0 - alpha) * strength * strength, alpha]
}

/// F0 of an index in air.
pub(crate) fn f0_of(ior: f64) -> f64 {
    let root = (ior - 1.0) / (ior + 1.0);
    root * root
}

/// F0 of the dielectric, without the factor of its weight in glTF, whose formula has that.
fn plastic_f0(format: Format, numbers: &Numbers) -> Rgb {
    let of_index = f0_of(numbers.ior);
    match format {
        Format::Gltf => numbers.specular_color.map(|c| (c * of_index).min(1.0)),
        _ => [of_index * numbers.specular; 3],
    }
}

/// Reflectances of the film over plastic and over metal, in the share that it covers.
fn films(format: Format, numbers: &Numbers, film: &Film, color: &Color) -> [Curve; 2] {
    let plastic = match (format, &numbers.coat) {
        (Format::OpenPbr, Some(coat)) => {
            let ratio = (numbers.ior / coat.ior).max(coat.ior / numbers.ior);
            [f0_of(ratio) * numbers.specular; 3]
        }
        _ => plastic_f0(format, numbers),
    };
    [plastic, numbers.base_color].map(|f0| Curve::of(film, f0, color))
}

/// A reflectance by the cosine.
#[derive(Debug, Clone)]
struct Curve(Vec<Rgb>);

impl Curve {
    fn of(film: &Film, f0: Rgb, color: &Color) -> Self {
        let middle = 0.5 * (film.thickness_nm[0] + film.thickness_nm[1]);
        let thickness = stack::FilmThickness { min_nm: middle, max_nm: middle };
        let ior = Ior::constant(film.ior.max(1.0), 0.0).unwrap_or_else(|_| Ior::vacuum());
        let coated = Interface {
            above: Ior::vacuum(),
            films: vec![stack::Film { ior, thickness }],
            below: Ior::vacuum().with_f0(f0),
        };
        let sampled = coated.sampled(color);
        let nodes = (0..=INTERVALS).map(|node| {
            let cos = node as f64 / INTERVALS as f64;
            let filmed = sampled.rgb(cos);
            [0, 1, 2].map(|c: usize| {
                let bare = schlick(f0[c], cos);
                (bare + film.weight * (filmed[c] - bare)).max(0.0)
            })
        });
        Self(nodes.collect())
    }

    fn at(&self, cos_theta: f64) -> Rgb {
        let at = cos_theta.clamp(0.0, 1.0) * INTERVALS as f64;
        let node = (at as usize).min(INTERVALS - 1);
        let share = at - node as f64;
        [0, 1, 2].map(|c: usize| self.0[node][c] + share * (self.0[node + 1][c] - self.0[node][c]))
    }
}
