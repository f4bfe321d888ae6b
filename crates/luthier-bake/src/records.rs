//! Layer records: the numbers of each layer for shaders.

use luthier_layers::layers::ALPHA_MIN;
use luthier_layers::layers::{Below, Layers};
use luthier_manifest::ModelPart;
use luthier_manifest::{LayerKind, LayerRecord, LowerReflectance, Masking, PathParts, Reflectance, ReflectanceCurve};
use luthier_material::Material;
use luthier_model::INDEX_MAX;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::Stack;
use num_complex::Complex64;

/// Least modulus of a relative index. Below it, Fresnel's formulas in single precision are 0/0 at normal incidence.
const INDEX_MIN: f64 = 1e-3;

/// Clamps a relative index, so that single precision can square it twice: both parts at most [`INDEX_MAX`], and not
/// both next to nothing. A total reflector still reflects all light, within 4e-3.
fn storable(ior: Complex64) -> (f64, f64) {
    let (n, k) = (ior.re.min(INDEX_MAX), ior.im.min(INDEX_MAX));
    (if n.max(k) < INDEX_MIN { INDEX_MIN } else { n }, k)
}

/// Largest optical depth. Nothing comes through it in any precision; a larger one would be infinite in a shader.
const DEPTH_MAX: f64 = 1e4;

/// Parts of a model that a material chooses, as far as the model offers a choice, and the colour mode of curves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Parts {
    pub(crate) masking: Masking,
    pub(crate) reflectance: Reflectance,
    pub(crate) lower_reflectance: LowerReflectance,
    pub(crate) path: PathParts,
    pub(crate) color: Color,
    /// Whether reflectances that are as cheap as a read have no rows: in the model `lobes`, whose other functions are rows.
    pub(crate) computes: bool,
}

impl Parts {
    /// The parts of a material.
    pub(crate) fn of(material: &Material) -> Self {
        let (model, bake) = (material.model(), &material.bake);
        let path = bake.path_parts(model);
        Self {
            masking: bake.masking.filter(|_| model.takes(ModelPart::Masking)).unwrap_or(path.masking),
            reflectance: bake.reflectance.filter(|_| model.takes(ModelPart::Reflectance)).unwrap_or_default(),
            lower_reflectance: bake.lower_reflectance.filter(|_| model.is_path()).unwrap_or_default(),
            path,
            color: material.color(),
            computes: model.is_fitted(),
        }
    }

    /// Writes the choices, and the curve of an approximate reflectance, into the record of an interface.
    fn write(&self, interface: &Interface, record: &mut LayerRecord) {
        let is_computed = self.computes && (record.f0.is_some() || has_one_index(interface));
        (record.masking, record.reflectance) =
            (self.masking, if is_computed { Reflectance::Exact } else { self.reflectance });
        record.internal_reflection = self.path.internal_reflection;
        let curves = match record.reflectance {
            Reflectance::Table | Reflectance::Exact => return,
            Reflectance::Approximate => interface.sampled(&self.color).schlick(),
            Reflectance::Lazanyi => interface.sampled(&self.color).lazanyi(),
        };
        record.curve = Some(ReflectanceCurve {
            f0: curves.map(|curve| curve.f0),
            weight: curves.map(|curve| curve.a),
            exponent: curves.map(|curve| curve.exponent),
        });
    }
}

/// Whether an interface without films is one of transparent media with the same relative index at all wavelengths.
fn has_one_index(interface: &Interface) -> bool {
    let indices = Color::Spectral.nodes().into_iter().map(|node| {
        let here = interface.at(node.wavelength_nm, 0);
        here.below / here.above
    });
    let indices: Vec<Complex64> = indices.collect();
    interface.films.is_empty() && indices.iter().all(|index| index.im == 0.0 && *index == indices[0])
}

/// An edge tint, if it is one.
pub(crate) fn tint(tint: Rgb) -> Option<Rgb> {
    (tint != [1.0; 3]).then_some(tint)
}

/// The records of a stack, without tiles.
pub(crate) fn records(stack: &Stack, wavelengths_nm: [f64; 3], parts: &Parts) -> Vec<LayerRecord> {
    let nodes = Color::ThreeWavelengths(wavelengths_nm).nodes();
    let layers = Layers::isotropic_rgb(stack).layers;
    let is_base = |i: usize| layers.get(i).is_some_and(|layer| matches!(layer.below, Below::Diffuse { .. }));
    layers
        .iter()
        .enumerate()
        .map(|(i, layer)| {
            let surface = &stack.layers[i].surface;
            let mut record = LayerRecord {
                kind: LayerKind::Conductor,
                distribution: layer.surface.distribution,
                alpha: layer.surface.alpha_x,
                alpha_xy: [surface.alpha_x, surface.alpha_y].map(|alpha| alpha.clamp(ALPHA_MIN, 1.0)),
                rotation: surface.rotation,
                eta: 1.0,
                ior_n: [1.0; 3],
                ..LayerRecord::default()
            };
            match layer.below {
                Below::Dielectric { optical_depth, .. } => {
                    record.kind = LayerKind::Dielectric;
                    record.eta = layer.eta().clamp(1.0 / INDEX_MAX, INDEX_MAX);
                    record.optical_depth = optical_depth.map(|depth| depth.min(DEPTH_MAX));
                }
                Below::Conductor => {}
                Below::Diffuse { albedo, sigma } => {
                    (record.kind, record.albedo, record.sigma) = (LayerKind::Diffuse, albedo, sigma);
                }
            }
            if let Some(interface) = Interface::of(stack, i) {
                // Films interfere by the index of the F0, which stands in the record like any other.
                record.f0 = interface.below.f0().filter(|_| interface.films.is_empty());
                record.f82_tint = record.f0.and(tint(interface.below.f82_tint()));
                if i > 0 {
                    record.lower_reflectance = parts.lower_reflectance;
                    record.lower_cosine = parts.path.lower_cosine;
                    record.lower_facets = parts.path.lower_facets;
                    record.lower_alpha = parts.path.lower_alpha;
                }
                if is_base(i + 1) {
                    record.diffuse_part = parts.path.diffuse_part;
                }
                parts.write(&interface, &mut record);
                for (c, node) in nodes.iter().enumerate() {
                    let here = interface.at(node.wavelength_nm, c);
                    let below = here.below / here.above;
                    (record.ior_n[c], record.ior_k[c]) = storable(below);
                    if let Some(film) = here.films.first() {
                        let relative = film.ior / here.above;
                        (record.film_ior_n[c], record.film_ior_k[c]) = storable(relative);
                        record.film_thickness_waves[c] = film.waves * here.above.re;
                    }
                }
                if let Some(film) = interface.films.first() {
                    record.film_thickness_nm = film.thickness.nominal_nm();
                    record.film_thickness_max_nm = film.thickness.max_nm;
                }
            }
            record
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fresnel's formulas as the shader has them, in single precision.
    fn fresnel(n: f32, k: f32, cos: f32) -> f32 {
        let square = (n - 1.0) * (n + 1.0) - k * k + cos * cos;
        let product = n * k;
        let modulus = (square * square + 4.0 * product * product).sqrt();
        let large = 0.5 * (modulus + square.abs());
        let small = product * product / large.max(1e-30);
        let (re_sq, im_sq) = if square >= 0.0 { (large, small) } else { (small, large) };
        let (re, sin_sq) = (re_sq.sqrt(), 1.0 - cos * cos);
        let refl_s = ((re - cos) * (re - cos) + im_sq) / ((re + cos) * (re + cos) + im_sq);
        let (along, across) = (re * cos, im_sq * cos * cos);
        let ratio = ((along - sin_sq) * (along - sin_sq) + across) / ((along + sin_sq) * (along + sin_sq) + across);
        0.5 * refl_s * (1.0 + ratio)
    }

    /// Indices from nothing to the largest double reflect a share of the light in single precision; as they are, they do not.
    #[test]
    fn stored_indices_can_be_evaluated_in_single_precision() {
        assert!(fresnel(0.0, 0.0, 1.0).is_nan() && fresnel(1.5, 1e15, 0.5).is_nan());
        let values = [0.0, 5e-324, 1e-30, 1e-3, 1.0, 1e3, 1e15, 1e150, f64::MAX];
        for n in values {
            for k in values {
                let (n, k) = storable(Complex64::new(n, k));
                for cos in [1e-7f32, 1e-3, 0.5, 0.999_999_9, 1.0] {
                    let found = fresnel(n as f32, k as f32, cos);
                    assert!((0.0..=1.0 + 1e-6).contains(&found), "{n} {k} {cos}: {found}");
                }
            }
        }
    }
}
