//! Colours of a place, and rows of a family in them.

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::{DIELECTRIC_F0, F82, F82_COS_THETA, metallic_and_tinted, schlick, schlick_average};
use luthier_optics::stack::{Base, Stack};

use super::film::{FilmLight, sent_back_below_coat};
use super::shares::spread_by;
use super::trace::SODIUM_D_NM;
use super::{Family, WHITE, base_interface};
use crate::models::lobes::half_vector::refracted;
use crate::models::lobes::leaving::Leaving;
use crate::models::lobes::{BaseLight, Frame, Row};

/// The colours of a family at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// F0 of the metal, RGB.
    pub metal: Rgb,
    /// Edge tint of the metal, RGB; 1 without.
    pub tint: Rgb,
    /// Share of the metal in the base, 0 to 1.
    pub metallic: f64,
    /// F0 of the dielectric, RGB.
    pub dielectric: Rgb,
    /// Index of the dielectric over that above, by which it bends light.
    pub index: f64,
    /// Albedo of the diffuse base, RGB.
    pub albedo: Rgb,
    /// Optical depth of the slab below the coat along the normal, RGB.
    pub depth: Rgb,
    /// Factor on the thickness of the film on the base.
    pub film_factor: f64,
}

/// The base of a `metallic-roughness` surface at a place: a mix of two surfaces by area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mix {
    /// F0 of the metal, RGB.
    pub metal: Rgb,
    /// Edge tint of the metal, RGB; 1 without.
    pub tint: Rgb,
    /// F0 of the dielectric, RGB.
    pub dielectric: Rgb,
    /// Colour that the dielectric shows, RGB.
    pub matt: Rgb,
    /// Share of the metal.
    pub metallic: f64,
}

impl Mix {
    /// Curves of the reflectance of the interface of this base as one surface, which bends light by an index, and albedo of the diffuse base below it.
    pub fn surface(&self, index: f64) -> ([F82; 3], Rgb) {
        let curves = [0, 1, 2].map(|c: usize| F82 { f0: self.metal[c], tint: self.tint[c] });
        metallic_and_tinted(curves, self.dielectric, self.matt, self.metallic, index)
    }
}

impl Paint {
    /// The colours of a stack without metal.
    pub fn of(stack: &Stack) -> Self {
        let albedo = match stack.layers.last().map(|layer| &layer.base) {
            Some(Base::Diffuse(base)) => base.albedo,
            _ => [0.0; 3],
        };
        let depth = match stack.layers.first().map(|layer| &layer.base) {
            Some(Base::Dielectric { slab, .. }) => slab.optical_depth(),
            _ => [0.0; 3],
        };
        // A base of nothing but metal is one whose share of metal is 1.
        let metal = match stack.layers.last().map(|layer| &layer.base) {
            Some(Base::Conductor { ior }) => ior.f0(),
            _ => None,
        };
        let metallic = if metal.is_some() { 1.0 } else { 0.0 };
        let metal = metal.unwrap_or_default();
        let interface = base_interface(stack).map(|number| &stack.layers[number].base);
        let dielectric = match interface {
            Some(Base::Dielectric { ior, .. }) => ior.f0(),
            _ => None,
        };
        let dielectric = dielectric.unwrap_or([DIELECTRIC_F0; 3]);
        let index = base_index(stack);
        Self { metal, tint: [1.0; 3], metallic, dielectric, index, albedo, depth, film_factor: 1.0 }
    }

    /// These colours with a base of a `metallic-roughness` surface: a metal of an F0, and a dielectric whose diffuse base shows a colour, which is its
    /// share.
    #[must_use]
    pub fn mixed(self, mix: Mix) -> Self {
        let (_, albedo) = Mix { metallic: 0.0, ..mix }.surface(self.index);
        let Mix { metal, tint, dielectric, metallic, .. } = mix;
        Self { metal, tint, metallic, dielectric, albedo, ..self }
    }

    /// Curves of the reflectance of the metal.
    fn curves(&self) -> [F82; 3] {
        [0, 1, 2].map(|c: usize| F82 { f0: self.metal[c], tint: self.tint[c] })
    }

    /// A stack with the metal of these colours as its base.
    #[must_use]
    pub fn metal_of(&self, stack: &Stack) -> Stack {
        let mut metal = stack.clone();
        let Some(number) = base_interface(stack) else { return metal };
        metal.layers.truncate(number + 1);
        if let Base::Conductor { ior } | Base::Dielectric { ior, .. } = &metal.layers[number].base {
            metal.layers[number].base = Base::Conductor { ior: ior.clone().with_f82(self.curves()) };
        }
        metal
    }

    /// A stack without metal, with the F0 and the diffuse base of these colours.
    #[must_use]
    pub fn plastic_of(&self, stack: &Stack) -> Stack {
        let mut plastic = stack.clone();
        let interface = base_interface(stack).map(|number| &mut plastic.layers[number].base);
        if let Some(Base::Dielectric { ior, .. }) = interface {
            *ior = ior.clone().with_f0(self.dielectric);
        }
        if let Some(Base::Diffuse(base)) = plastic.layers.last_mut().map(|layer| &mut layer.base) {
            base.albedo = self.albedo;
        }
        plastic
    }

    /// The first interface of a family in these colours, if that is the base: F0 of the mix.
    pub(in crate::models::lobes) fn on(&self, stack: &Stack, family: Family) -> Stack {
        let mut painted = stack.clone();
        if let (true, Base::Conductor { ior } | Base::Dielectric { ior, .. }) =
            (family.is_metallic, &mut painted.layers[family.interface].base)
        {
            let curves = self.curves();
            *ior = ior
                .clone()
                .with_f82([0, 1, 2].map(|c: usize| curves[c].in_dielectric(self.dielectric[c], self.metallic)));
        }
        painted
    }
}

impl Family {
    /// A row in colours, from a row of numbers at a cosine of the view and at slope parameters of coat and base. The albedo is at most 1: what exceeds it is
    /// taken from the light from below.
    pub(in crate::models::lobes) fn painted(
        self,
        row: &Row,
        alphas: [f64; 2],
        (frame, cos_theta): (&Frame, f64),
        paint: &Paint,
        film: Option<&FilmLight>,
    ) -> Row {
        let mut here = row.clone();
        let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt();
        let leaving = Leaving::new(refracted(DVec3::new(sin_theta, 0.0, cos_theta), frame.index), frame.index);
        for (lobe, spread) in here.lobes.iter_mut().zip(Self::spreads(alphas)) {
            *lobe = spread_by(*lobe, spread);
            // Between rows the share is that of the shape there.
            lobe.share = (lobe.share * leaving.in_plane(lobe, sin_theta)).min(1.0);
        }
        let crossing = self.crossing(alphas[0], cos_theta);
        let simulated = frame.base.map_or([0.0; 3], |base| base.albedo);
        // The place of the shear of one lobe has the share of the light of the other that is wide.
        let [wide_once, wide_trapped] =
            [1, 0].map(|lobe: usize| row.lobes.get(lobe).map_or(0.0, |lobe| lobe.shear * lobe.tail.sqrt()));
        let base = row.base.unwrap_or_default();
        let other = FilmLight::without(row, paint).filter(|_| film.is_none() && self.is_metallic && !self.is_coated());
        let film = film.or(other.as_ref());
        let passed = self.passed(&base, simulated, paint.depth);
        let [more, mut met] = if self.has_lengths {
            base.dimmed(simulated, paint.albedo, [passed[1], passed[2]])
        } else {
            [base.more(simulated, paint.albedo), base.of_one_direction(simulated, paint.albedo)]
        };
        for (c, more) in more.into_iter().enumerate() {
            let [entering, wide, once, trapped] = if self.is_metallic {
                let [entering, wide, once, trapped, direct] =
                    self.mixed(row, &base, (alphas, cos_theta), paint, film, c);
                met[c] = direct;
                [entering, wide, once, trapped]
            } else {
                let [once, trapped] =
                    [0, 1].map(|lobe: usize| row.lobes.get(lobe).map_or(0.0, |lobe| lobe.strength[c]));
                // Above a diffuse base light of more visits passes the slab as often as its light does.
                let again = if simulated == [0.0; 3] { passed[1][c] } else { passed[0][c] * passed[2][c] };
                let [once, trapped] =
                    if self.has_lengths { [once * passed[0][c], trapped * again] } else { [once, trapped] };
                [row.albedo_dir[c], row.wide[c] + more.max(-row.wide[c]), once, trapped]
            };
            let [entering, wide, once, trapped] = [entering, wide, once, trapped].map(|energy| crossing * energy);
            let (facet, below) = (1.0 - entering, wide + once + trapped);
            // A facet of a mirror may be a last bit above 1, with nothing below.
            let kept = if facet + below > 1.0 { (1.0 - facet).max(0.0) / below.max(f64::MIN_POSITIVE) } else { 1.0 };
            met[c] *= crossing * kept;
            here.wide[c] = kept * (wide + wide_once * once + wide_trapped * trapped);
            for (lobe, energy) in here.lobes.iter_mut().zip([(1.0 - wide_once) * once, (1.0 - wide_trapped) * trapped])
            {
                lobe.strength[c] = kept * energy / lobe.share.max(SHARE_MIN);
            }
            here.albedo_dir[c] = facet + kept * below;
        }
        // The shape of the remainder stays: its light is in the remainder.
        let falloff = [base.falloff[0], frame.wide.falloff()[1]];
        here.base = row.base.map(|_| BaseLight { falloff, met: Some(met), ..BaseLight::default() });
        here
    }

    /// Shares of light that the first slab lets through: of one visit, of the diffuse base or of more visits without one, and of what is sent back to the base.
    fn passed(self, base: &BaseLight, simulated: Rgb, depth: Rgb) -> [Rgb; 3] {
        let [once, second, around] = base.lengths;
        let straight = |length: f64| depth.map(|depth| libm::exp(-length * depth));
        let spread = |g: f64, spread: f64| depth.map(|depth| libm::pow(1.0 + g * depth, -spread));
        let second = if simulated == [0.0; 3] { spread(second, MORE_SPREAD) } else { straight(second) };
        [straight(once), second, spread(around, AROUND_SPREADS[usize::from(self.is_coated())])]
    }

    /// Energies of a base that is metallic in places, by channel: light but that of one facet of the first interface, the remainder without trapped light, and
    /// light that the base reflected once, and more often; and light of the diffuse base that came through the coat, and not back from it.
    fn mixed(
        self,
        row: &Row,
        base: &BaseLight,
        (alphas, cos_theta): ([f64; 2], f64),
        paint: &Paint,
        film: Option<&FilmLight>,
        c: usize,
    ) -> [f64; 5] {
        let (metal, tint, metallic, f0) = (paint.metal[c], paint.tint[c], paint.metallic, paint.dielectric[c]);
        // The F0 of the metal where facets see this dip of its edge tint; a film has no tint below it.
        let at = |dip: f64| film.map_or_else(|| dimmed(metal, tint, dip), |film| film.mean[0][c]);
        let [white, dip, first_dip] = row.wide;
        let mix = |of_metal: f64, of_plastic: f64| of_plastic + metallic * (of_metal - of_plastic);
        let passed = |length: f64| libm::exp(-length * paint.depth[c]);
        let ([bright, length, _], [_, around, _]) = (base.energy, base.internal);
        // Rows have the light of a base of one albedo, which no error of this share changes.
        let sent_back = self.back(alphas);
        let light = bright * (1.0 / WHITE - sent_back);
        let [of_once, of_more] = [0, 1].map(|lobe: usize| row.lobes.get(lobe).map_or([0.0; 3], |lobe| lobe.strength));
        let [facet, once_length, more_length] = row.albedo_dir;
        let [several, slope, _] = of_once;
        let again = passed(more_length);
        let (light, sent_back, once, plastic_more, entering) = match film {
            Some(film) if self.is_coated() => {
                let once = [0, 1].map(|i: usize| chain(of_once, film.seen[i][c]));
                let reflected = [chain(of_once, DIELECTRIC_F0), once[1] + trapped(of_more, film.mean[1][c])];
                let [leaving, staying] = film.crossed(c, light / (1.0 - sent_back), reflected);
                let (light, sent_back) = (leaving * light, 1.0 - staying * (1.0 - sent_back));
                let more = trapped(of_more, film.mean[1][c] * again);
                (light, sent_back, mix(once[0], once[1]) * passed(once_length), more, facet)
            }
            None if self.is_coated() => {
                let once = [at(dip), f0].map(|f0| chain(of_once, f0));
                let (light, sent_back, more) = if paint.dielectric == [DIELECTRIC_F0; 3] {
                    (light, sent_back, 0.0)
                } else {
                    // What facets do not reflect enters.
                    let sent_back = sent_back_below_coat(sent_back, f0, paint.index);
                    let entering = facet - white - once[1] - trapped(of_more, f0);
                    (entering.max(0.0) * (1.0 - sent_back), sent_back, trapped(of_more, f0 * again))
                };
                (light, sent_back, mix(once[0], once[1]) * passed(once_length), more, facet)
            }
            Some(film) => {
                let filmed = between_facets(several, of_more, facet / (facet + slope).max(ALL_MIN), film.mean[1][c]);
                let all = facet + slope;
                let [light, sent_back] = film.below(c, all, [several, filmed], sent_back);
                let facet = all * mix(film.seen[0][c], film.seen[1][c]);
                (light, sent_back, mix(0.0, filmed), 0.0, 1.0 - facet)
            }
            None => {
                let kept = metallic * edge(metal, tint) * first_dip;
                (light, sent_back, mix(0.0, several), 0.0, 1.0 - (facet + slope * mix(metal, DIELECTRIC_F0) - kept))
            }
        };
        let direct = light * passed(length) * paint.albedo[c];
        // What the dielectric itself sends back does not pass the slab.
        let kept = if self.is_coated() { kept_by_base(self.back(alphas), paint.index) } else { 0.0 };
        let sent_back = sent_back * (kept + (1.0 - kept) * passed(around));
        let diffuse = direct / (1.0 - sent_back * paint.albedo[c]);
        // Trapped light passes the slab again before each visit: it is as dark as over a darker base. A dielectric of the F0 that rows know reflects hardly any.
        // Light that a coat keeps meets the metal flatly.
        let flat = at(if self.is_coated() { trapped_dip(alphas, cos_theta) } else { dip });
        let more = mix(trapped(of_more, flat * again), plastic_more);
        [entering, white + mix(0.0, diffuse), once, more, mix(0.0, direct)]
    }
}

/// Index of the base of a stack over that above, 1 without an interface.
pub(super) fn base_index(stack: &Stack) -> f64 {
    let at = |ior: &Ior| ior.at(SODIUM_D_NM).re;
    let interface = base_interface(stack).and_then(|number| Interface::of(stack, number));
    interface.map_or(1.0, |interface| at(&interface.below) / at(&interface.above))
}

/// Share that the dielectric itself sends back, of all light of a diffuse base that is sent back to it below a coat: by that share and the index of the dielectric over that
/// of the coat, at the F0 that rows know.
pub(super) fn kept_by_base(sent_back: f64, index: f64) -> f64 {
    let kept = 1.0 - (1.0 - schlick_average(DIELECTRIC_F0)) / (index * index);
    (kept / sent_back.max(f64::MIN_POSITIVE)).clamp(0.0, KEPT_MAX)
}

/// Largest such share: all light would pass no slab, and have no length.
const KEPT_MAX: f64 = 0.98;

/// Spreads of the lengths of light that is sent back to a diffuse base, which is below the first interface, or below another one that sends some of it back before
/// it comes to the slab: a slab of depth d lets `(1 + g d)^-spread` of it through. An exponential of the mean would be too bright in thin slabs, and too dark in
/// thick ones.
pub(super) const AROUND_SPREADS: [f64; 2] = [4.0, 1.5];

/// Spread of light of more visits to a metal, which are many where it is bright.
pub(super) const MORE_SPREAD: f64 = 4.5;

/// Reflectance that an edge tint keeps at 81.8 degrees: the weight of the correction times its largest value.
pub(super) fn edge(f0: f64, tint: f64) -> f64 {
    schlick(f0, F82_COS_THETA) * (1.0 - tint)
}

/// The F0 without an edge tint that stands for one with it, where facets see this dip.
pub(super) fn dimmed(f0: f64, tint: f64, dip: f64) -> f64 {
    (f0 - edge(f0, tint) * dip).max(0.0)
}

/// The dip of light of more visits below a coat, by slope parameters of coat and base and the cosine of the view. Wherever it comes from, such light meets the
/// metal beyond the critical angle: the dip is .14 within .03, but for flat views through a rough coat (up to .22) and mirrors below a smooth one (.09).
fn trapped_dip([coat, base]: [f64; 2], cos_theta: f64) -> f64 {
    let spread = coat * coat + base * base;
    let away = 1.0 - cos_theta;
    let flat = away * away * away * (1.0 - base) * coat / (coat + 0.1);
    0.15 * (spread / (spread + 0.006) + flat)
}

/// Least share above the horizon by which an energy is divided.
const SHARE_MIN: f64 = 1e-3;

/// Energy of light of one visit to the base at an F0, by its [`chain_numbers`]: `w (1 - R) f / (1 - R f)`. Below a coat light meets the base so steeply that
/// without F0 it reflects nothing.
pub(super) fn chain([white, pole, _]: Rgb, f: f64) -> f64 {
    white * (1.0 - pole) * f / (1.0 - pole * f)
}

/// Numbers of light of one visit: its energy w at an F0 of 1, and the pole R by which that at .8 is as given.
pub(super) fn chain_numbers([bright, white]: [f64; 2]) -> Rgb {
    let beyond = (0.8 * (white - bright)).max(BEYOND_MIN);
    [white, ((0.8 * white - bright) / beyond).clamp(0.0, POLE_MAX), 0.0]
}

/// Energy of light of more visits at an F0, by its [`trapped_numbers`]: `f^2 (p + q f) / (1 - R f)`.
pub(super) fn trapped([low, high, pole]: Rgb, f: f64) -> f64 {
    f * f * (low + (2.0 * f - 1.0) * (high - low)).max(0.0) / (1.0 - pole * f)
}

/// Numbers of light of more visits from its energies at an F0 of .5, .9 and 1: `p + q f` at .5 and at 1, and the pole R.
pub(super) fn trapped_numbers([half, bright, white]: Rgb) -> Rgb {
    let [half, bright] = [4.0 * half, bright / 0.81];
    let beyond = 0.4 * (white - 0.9 * bright) - 0.1 * (0.9 * bright - 0.5 * half);
    let curve = 0.4 * (white - bright) - 0.1 * (bright - half);
    // Light that grows less than with the square has no pole.
    let pole = if white > half { (curve / beyond.max(BEYOND_MIN)).clamp(0.0, POLE_MAX) } else { 0.0 };
    [half * (1.0 - 0.5 * pole), white * (1.0 - pole), pole]
}

/// Energy of light of several facets of a dielectric at an F0: that of a metal, and light that crossed some of them. `known` is all of it at the F0 that rows
/// know, and `steep` the mean of Schlick's `(1 - cos)^5` at the facets that the eye sees.
///
/// Light that one facet reflects and others let through grows with the F0, and ends where they let nothing through: about as `f (1 - f)^1.5`.
pub(super) fn between_facets(known: f64, energies: Rgb, steep: f64, f: f64) -> f64 {
    let crossed = |f: f64| (f + (1.0 - f) * steep) * (1.0 - f) * (1.0 - f).max(0.0).sqrt();
    let excess = (known - trapped(energies, DIELECTRIC_F0)) / crossed(DIELECTRIC_F0);
    (trapped(energies, f) + excess * crossed(f)).max(0.0)
}

/// Least divisor of a pole.
const BEYOND_MIN: f64 = 1e-9;

/// Least light of one facet of a mirror by which light is divided.
pub(super) const ALL_MIN: f64 = 0.02;

/// Largest pole.
const POLE_MAX: f64 = 0.99;
