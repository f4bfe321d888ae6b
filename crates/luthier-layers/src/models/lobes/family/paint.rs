//! Colours of a place, and rows of a family in them.

use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::{Base, Stack};

use super::{Family, base_interface};
use crate::models::lobes::{BaseLight, Lobe, Row};

/// The colours of a family at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// F0 of the base, RGB; of no use where that keeps its own colour.
    pub f0: Rgb,
    /// Albedo of the diffuse base below, RGB; 0 without one.
    pub albedo: Rgb,
    /// Optical depth of the slab below the coat along the normal, RGB.
    pub depth: Rgb,
}

impl Paint {
    /// The colours of a stack.
    pub fn of(stack: &Stack, color: &Color) -> Self {
        let f0 = base_interface(stack).and_then(|number| {
            let interface = Interface::of(stack, number)?;
            Some(interface.below.f0().unwrap_or_else(|| interface.sampled(color).rgb(1.0)))
        });
        let albedo = match stack.layers.last().map(|layer| &layer.base) {
            Some(Base::Diffuse(base)) => base.albedo,
            _ => [0.0; 3],
        };
        let depth = match stack.layers.first().map(|layer| &layer.base) {
            Some(Base::Dielectric { slab, .. }) => slab.optical_depth(),
            _ => [0.0; 3],
        };
        Self { f0: f0.unwrap_or([0.0; 3]), albedo, depth }
    }
}

impl Family {
    /// A row in colours, from a row of numbers; `spreads` are those of [`Self::spreads`]. The albedo is at most 1: what exceeds it is taken from the
    /// light from below.
    pub(in crate::models::lobes) fn painted(self, row: &Row, spreads: [f64; 2], paint: &Paint) -> Row {
        let mut here = row.clone();
        for (lobe, spread) in here.lobes.iter_mut().zip(spreads) {
            *lobe = Lobe {
                shift: lobe.shift * spread,
                sharpness: lobe.sharpness.map(|sharpness| sharpness * lobe.tail.sqrt() / spread),
                ..*lobe
            };
            if !self.is_colored {
                lobe.strength = lobe.strength.map(|energy| energy / lobe.share.max(SHARE_MIN));
            }
        }
        if !self.is_colored {
            return here;
        }
        let Paint { f0, albedo, depth } = *paint;
        let [first, once, more] = row.albedo_dir;
        let [_, slope, _] = row.albedo_dir;
        for c in 0..3 {
            let f = f0[c];
            let passed = |length: f64| libm::exp(-length * depth[c]);
            let base = row.base.map_or(0.0, |base| from_below(&base, f, albedo[c], depth[c]));
            here.wide[c] = chain(row.wide, f).max(0.0) + base;
            if let Some(lobe) = here.lobes.first_mut() {
                lobe.strength[c] = chain(row.lobes[0].strength, f).max(0.0) * passed(once) / lobe.share.max(SHARE_MIN);
            }
            if let Some(lobe) = here.lobes.get_mut(1) {
                lobe.strength[c] = trapped(row.lobes[1].strength, f) * passed(more) / lobe.share.max(SHARE_MIN);
            }
            let facet = if self.is_coated() { first } else { first + slope * f };
            let below = here.wide[c] + here.lobes.iter().map(|lobe| lobe.strength[c] * lobe.share).sum::<f64>();
            let kept = if facet + below > 1.0 { (1.0 - facet).max(0.0) / below } else { 1.0 };
            here.wide[c] *= kept;
            here.lobes.iter_mut().for_each(|lobe| lobe.strength[c] *= kept);
            here.albedo_dir[c] = facet + kept * below;
        }
        // The shape of the remainder stays: its light is in the remainder.
        here.base = row.base.map(|base| BaseLight { falloff: base.falloff, ..BaseLight::default() });
        here
    }
}

/// Least share above the horizon by which an energy is divided.
const SHARE_MIN: f64 = 1e-3;

/// Energy of light that visited the base once, from that at an F0 of 0 and of 1, and the pole.
pub(super) fn chain([none, whole, pole]: Rgb, f: f64) -> f64 {
    (none + f * (whole * (1.0 - pole) - none)) / (1.0 - pole * f).max(1e-3)
}

/// Energy of light that the base reflected twice and more, from that at an F0 of 1/2 and of 1, and the pole.
pub(super) fn trapped([half, whole, pole]: Rgb, f: f64) -> f64 {
    let [middle, bright] = [4.0 * half * (1.0 - 0.5 * pole), whole * (1.0 - pole)];
    f * f * (middle + (2.0 * f - 1.0) * (bright - middle)).max(0.0) / (1.0 - pole * f).max(1e-3)
}

/// Light of a diffuse base of an albedo below an interface of an F0.
fn from_below(base: &BaseLight, f: f64, albedo: f64, depth: f64) -> f64 {
    let [t0, t1, length] = base.energy;
    let [r0, r1, around] = base.internal;
    let sent_back = (r0 + f * (r1 + f * (1.0 - r0 - r1))) * libm::exp(-around * depth);
    let passed = (1.0 - f) * (1.0 - f) * (t0 + t1 * f) * libm::exp(-length * depth);
    passed.max(0.0) * albedo / (1.0 - sent_back * albedo).max(1e-3)
}
