//! Light that one interface splits by chance: at one wavelength, or at three on the same way.

use luthier_optics::Rgb;

use super::optics::{Optics, Side};
use super::random::Stream;

/// Light that is left on its way: of one wavelength or of several.
pub(crate) trait Share: Copy {
    /// The share of light that has lost nothing.
    const WHOLE: Self;

    /// Share of this share.
    fn times(self, other: Self) -> Self;

    /// The share times a factor.
    fn scaled(self, factor: f64) -> Self;

    /// The share divided by a probability.
    fn over(self, probability: f64) -> Self;

    /// The greatest of all wavelengths, which decides survival.
    fn brightest(self) -> f64;
}

impl Share for f64 {
    const WHOLE: Self = 1.0;

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        self * other
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn over(self, probability: f64) -> Self {
        self / probability
    }

    #[inline(always)]
    fn brightest(self) -> f64 {
        self
    }
}

impl Share for Rgb {
    const WHOLE: Self = [1.0; 3];

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        [self[0] * other[0], self[1] * other[1], self[2] * other[2]]
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        self.map(|share| share * factor)
    }

    #[inline(always)]
    fn over(self, probability: f64) -> Self {
        self.map(|share| share / probability)
    }

    #[inline(always)]
    fn brightest(self) -> f64 {
        self[0].max(self[1]).max(self[2])
    }
}

/// Reflection or refraction, as chance had it.
pub(crate) struct Chosen<S> {
    /// Cosines of the incident and of the refracted ray; `None` for reflection.
    pub(crate) refracted: Option<[f64; 2]>,
    /// Share of the light that is left.
    pub(crate) kept: S,
}

/// An interface whose facets reflect or refract by chance.
pub(crate) trait Chance {
    /// Light that is left.
    type Share: Share;

    /// Index of a side over that of the other.
    fn eta_it(&self, side: Side) -> f64;

    /// Chances of light that arrives on a side at a squared cosine.
    fn choose(&self, stream: &mut Stream, side: Side, cos_theta_sq: f64) -> Chosen<Self::Share>;
}

impl Chance for Optics {
    type Share = f64;

    #[inline(always)]
    fn eta_it(&self, side: Side) -> f64 {
        self.eta_it(side)
    }

    #[inline(always)]
    fn choose(&self, stream: &mut Stream, side: Side, cos_theta_sq: f64) -> Chosen<f64> {
        let split = self.split_sq(side, cos_theta_sq);
        let kept = split.reflectance + split.transmittance;
        let is_reflected = split.transmittance == 0.0 || stream.uniform() * kept < split.reflectance;
        Chosen { refracted: (!is_reflected).then_some([split.cos_theta, split.cos_theta_t]), kept }
    }
}

/// One interface at three wavelengths with equal directions: real indices are equal, reflectances need not be.
///
/// Chance goes by the means of reflectance and transmittance. So no wavelength has more than three times the weight of the mean.
#[derive(Debug, Clone)]
pub(crate) struct JointOptics {
    /// The optics: one entry for all three wavelengths if they are equal.
    optics: Vec<Optics>,
}

impl JointOptics {
    /// `None` if light has other directions at one wavelength than at another.
    pub(crate) fn new(optics: [Optics; 3]) -> Option<Self> {
        let [first, others @ ..] = &optics;
        if !others.iter().all(|other| first.is_parallel(other)) {
            return None;
        }
        let are_alike = others.iter().all(|other| other == first);
        Some(Self { optics: if are_alike { optics[..1].to_vec() } else { optics.to_vec() } })
    }

    /// Whether light goes straight through.
    pub(crate) fn is_absent(&self) -> bool {
        self.optics[0].is_absent()
    }

    /// Reflectance by wavelength.
    pub(crate) fn reflectance(&self, side: Side, cos_theta: f64) -> Rgb {
        [0, 1, 2].map(|c: usize| self.optics[c.min(self.optics.len() - 1)].split(side, cos_theta).reflectance)
    }
}

impl Chance for JointOptics {
    type Share = Rgb;

    #[inline(always)]
    fn eta_it(&self, side: Side) -> f64 {
        self.optics[0].eta_it(side)
    }

    #[inline(always)]
    fn choose(&self, stream: &mut Stream, side: Side, cos_theta_sq: f64) -> Chosen<Rgb> {
        let [first, others @ ..] = &self.optics[..] else { unreachable!("there are optics") };
        if others.is_empty() {
            let Chosen { refracted, kept } = first.choose(stream, side, cos_theta_sq);
            return Chosen { refracted, kept: [kept; 3] };
        }
        let splits = [0, 1, 2].map(|c: usize| self.optics[c].split_sq(side, cos_theta_sq));
        let [reflected, transmitted] = [splits.map(|split| split.reflectance), splits.map(|split| split.transmittance)];
        let [reflectance, transmittance] = [reflected, transmitted].map(|shares| shares.iter().sum::<f64>());
        let kept = reflectance + transmittance;
        if transmittance == 0.0 || stream.uniform() * kept < reflectance {
            let probability = if kept > 0.0 { reflectance / kept } else { 1.0 };
            return Chosen { refracted: None, kept: reflected.over(probability) };
        }
        let cosines = [splits[0].cos_theta, splits[0].cos_theta_t];
        Chosen { refracted: Some(cosines), kept: transmitted.over(transmittance / kept) }
    }
}
