//! The f64 evaluation of shipped tables at a place.

use glam::{DVec2, DVec3};
use luthier_layers::effects::layer_sample::LayerSample;
use luthier_layers::effects::textured::TextureSample;
use luthier_layers::models::lobes::Mix;
use luthier_layers::models::shade::Under;
use luthier_layers::twins::shaded::{Growth, Place, Shaded};
use luthier_layers::twins::terms::Exact;
use luthier_manifest::{BrighteningRecord, MaterialEntry, PlaceValues};
use luthier_optics::Rgb;
use luthier_optics::brightening::Brightening;
use luthier_optics::schlick::{DIELECTRIC_F0, F82};

use crate::error::ReportError;
use crate::measure::directions::wide;
use crate::measure::references::{bare_stack, parts, side_of};
use crate::measure::subject::{Subject, color};
use crate::measure::table_terms::{TableTerms, Weights};

/// A material at a place, in f64: its model, with terms that are read from the tables of the package as its shader reads them.
#[derive(Debug)]
pub struct Rows<'a>(Shaded<TableTerms<'a>>);

impl<'a> Rows<'a> {
    /// A material, by its number, at a place.
    ///
    /// # Errors
    /// A model without a twin, a table that does not fit its layout, a layer that needs a tile and has none.
    pub fn new(
        subject: &'a Subject<'_>,
        material: usize,
        values: &PlaceValues,
        weights: Weights,
    ) -> Result<Self, ReportError> {
        Self::at(subject, material, &place(values, &subject.manifest.materials[material]), weights)
    }

    /// [`Self::new`] at a place of the f64 twin.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn at(subject: &'a Subject<'_>, material: usize, place: &Place, weights: Weights) -> Result<Self, ReportError> {
        let entry = &subject.manifest.materials[material];
        if let (Some((weight, coated, below)), Some(side)) = (place.sides(), entry.side()) {
            let coated = Self::at(subject, material, &coated, weights)?.0;
            let terms = |_, _: &_, _: &_| TableTerms::of_side(subject, &side, weights, &below).ok();
            let (stack, nm) = (bare_stack(entry, &subject.stacks[material]), entry.wavelengths_nm);
            let bare = Shaded::of_terms(terms, side.model, &stack, nm, color(entry), &below, parts(&side));
            let bare = bare.ok_or_else(|| ReportError::Model { material: entry.name.clone(), model: entry.model })?;
            return Ok(Self(coated.beside(weight, bare)));
        }
        // Terms at a place are an `Option`: errors of the tables are reported here, without a place.
        TableTerms::new(subject, material, weights)?;
        let (stack, nm) = (&subject.stacks[material], entry.wavelengths_nm);
        let terms = |part, _: &_, _: &_| TableTerms::at(subject, material, weights, place, part).ok();
        let shaded = Shaded::of_terms(terms, entry.model, stack, nm, color(entry), place, parts(entry));
        shaded.map(Self).ok_or_else(|| ReportError::Model { material: entry.name.clone(), model: entry.model })
    }

    /// `f cos_theta_i`, RGB, of unit directions to the light and to the eye.
    pub fn eval(&self, wi: DVec3, wo: DVec3) -> Rgb {
        self.0.eval(wi, wo)
    }
}

/// A material at a place with exact terms.
pub(super) fn exact(subject: &Subject<'_>, material: usize, values: &PlaceValues) -> Option<Shaded<Exact>> {
    let entry = &subject.manifest.materials[material];
    let (stack, nm) = (&subject.stacks[material], entry.wavelengths_nm);
    Shaded::with(entry.model, stack, nm, color(entry), &place(values, entry), parts(entry))
}

/// The share of the first layer at a place: of a patina, or of a coat.
fn cover(values: &PlaceValues, entry: &MaterialEntry) -> Option<Growth> {
    if let Some(coat) = &entry.constants.coat {
        return Some(Growth::of_coat(coat.weight * f64::from(values.weight_factor)));
    }
    let (amount, patina) = (values.patina?, entry.constants.patina.as_ref()?);
    let (diffuse_albedo, base_alpha, tarnish) = (patina.diffuse_albedo, patina.base_alpha, patina.tarnish);
    Some(Growth { amount: amount.into(), diffuse_albedo, base_alpha, tarnish })
}

/// The place of the f64 twin, with exactly the numbers of the device.
pub(super) fn place(values: &PlaceValues, entry: &MaterialEntry) -> Place {
    let layers = values.layers.iter().map(|own| LayerSample {
        normal: wide(own.normal),
        alpha_factors: own.alpha_factors.map(f64::from),
        tangent: match own.tangent.map(f64::from) {
            [1.0, 0.5] => DVec2::X,
            texel => LayerSample::tangent_of(texel),
        },
        slab_factor: own.slab_factor.into(),
        absorption_factors: own.absorption_factors.map(f64::from),
        f0: None,
    });
    let mut place = Place {
        sample: TextureSample {
            normal: wide(values.normal),
            alpha_factor: values.alpha_factor.into(),
            slab_factor: values.slab_factor.into(),
            film_factor: values.film_factor.into(),
            slope_variance: values.slope_variance.into(),
        },
        under: Under {
            flake_normal: wide(values.flake_normal),
            inner_normal: wide(values.inner_normal),
            ..Under::NONE
        },
        patina: cover(values, entry),
        side: side_of(entry),
        base_color: values.base_color.map(|color| color.map(f64::from)),
        reradiation: entry.layers.last().and_then(|layer| layer.reradiation),
        layers: layers.collect(),
        metal: None,
    };
    let Some(interface) = entry.layers.len().checked_sub(2) else { return place };
    let own_f0 = values.f0.map(|f0| f0.map(f64::from));
    if let Some(f0) = own_f0 {
        place.layers.resize(place.layers.len().max(interface + 1), LayerSample::NONE);
        place.layers[interface].f0 = Some(f0.map(|f0| F82 { f0, tint: 1.0 }));
    }
    if let Some((color, metallic)) = values.metallic {
        let dielectric = own_f0.or(entry.layers[interface].f0).unwrap_or([DIELECTRIC_F0; 3]);
        let (color, metallic) = (color.map(f64::from), metallic.into());
        let tint = entry.layers[interface].metal_f82_tint.unwrap_or([1.0; 3]);
        let mix = match entry.constants.brightening {
            Some(BrighteningRecord { diffuse, metal, .. }) => {
                let coat = entry.constants.coat.as_ref();
                let weight = coat.map_or(1.0, |coat| (coat.weight * f64::from(values.weight_factor)).clamp(0.0, 1.0));
                let shares = Brightening { diffuse, metal };
                Mix { metal: shares.metal(color, weight), tint, dielectric, matt: shares.matt(color, weight), metallic }
            }
            None => Mix { metal: color, tint, dielectric, matt: color, metallic },
        };
        let (curves, albedo) = mix.surface(entry.layers[interface].eta);
        place.metal = Some(mix);
        place.base_color = Some(albedo);
        place.layers.resize(place.layers.len().max(interface + 1), LayerSample::NONE);
        place.layers[interface].f0 = Some(curves);
    }
    place
}
