//! Random walk of light between the facets of a rough interface, until it leaves on either side.
//!
//! Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model". The height
//! enters as the depth `-ln c`, where `c` is the share of the surface that lies lower; it is 0 above everything.
//! Along a ray, facets are met at a rate of `visible area / |cos|` per depth. Below, the surface is seen upside down:
//! `c` becomes `1 - c`.

use super::chance::{Chance, Share};
use super::facets::{Facets, View};
use super::optics::Side;
use super::random::Stream;
use super::rough::{Rough, Sided};

/// Facet from which on a walk survives by chance.
const FACETS_SURE: u32 = 256;

/// Probability per facet with which a walk survives.
const SURVIVAL: f64 = 0.8;

/// Light fainter than this survives by chance too.
const FAINT: f64 = 0.1;

/// Least probability with which a ray of [`kernel`] meets another facet. Light that few rays would carry then comes in smaller parts from more of
/// them, with less noise.
const MEETS_MIN: f64 = 1.0 / 16.0;

/// Depth of a facet below the top, as its side counts it.
#[derive(Clone, Copy)]
enum Depth {
    /// `-ln u / rate`, of a ray that has come from outside; `rate >= 1`, `u` in 0..=1 but for 0. Most rays leave
    /// without its being worked out.
    Drawn { u: f64, rate: f64 },
    /// The depth itself.
    Known(f64),
}

impl Depth {
    fn value(self) -> f64 {
        match self {
            Self::Drawn { u, rate } => -libm::log(u) / rate,
            Self::Known(depth) => depth,
        }
    }

    /// The depth as the other side counts it: from `-ln c` to `-ln(1 - c)`.
    fn flipped(self) -> f64 {
        -libm::log((-libm::expm1(-self.value())).max(f64::MIN_POSITIVE))
    }

    /// Whether a ray of rate `lambda` certainly leaves from here: no wrong yes, some no that would be a yes. It
    /// leaves if `v < c^lambda`, with `1 - c` for `c` if it has crossed.
    ///
    /// `c` is `u^(1 / rate)`, at least `u` to any lesser power; `1 - c` is at least `(1 - u) / rate`, the tangent at
    /// 1. For a small `lambda` a root of these is compared with `v`: a power of `v` with these.
    #[inline]
    fn surely_leaves(self, lambda: f64, crossed: bool, v: f64) -> bool {
        let Self::Drawn { u, rate } = self else { return false };
        let (power, bound) = if crossed { (lambda, (1.0 - u) / rate) } else { (lambda / rate, u) };
        let v_4 = (v * v) * (v * v);
        if power <= 0.0625 {
            (v_4 * v_4) * (v_4 * v_4) < bound
        } else if power <= 0.25 {
            v_4 < bound
        } else {
            power <= 1.0 && v < bound
        }
    }

    /// Expected share of light that leaves from here along a ray of rate `lambda`. The mean over all depths where
    /// they are only drawn.
    fn leaving(self, lambda: f64, crossed: bool) -> f64 {
        match self {
            Self::Drawn { rate, .. } if !crossed => rate / (rate + lambda),
            _ => libm::exp(-lambda * if crossed { self.flipped() } else { self.value() }),
        }
    }
}

/// Light that has come to a facet.
struct Walker<S = f64> {
    side: Side,
    /// The facet as the light sees it: looks back along the ray.
    view: View,
    depth: Depth,
    weight: S,
}

/// Next step of light at a facet.
enum Next {
    Facet,
    Left(Sided),
    Died,
}

impl<S: Share> Walker<S> {
    /// The walker at its first facet, coming from `a`.
    #[inline(always)]
    fn enter(facets: &Facets, stream: &mut Stream, a: Sided) -> Self {
        let view = facets.view(a.direction);
        let rate = (view.area / a.direction.z).max(1.0);
        Self { side: a.side, depth: Depth::Drawn { u: 1.0 - stream.uniform(), rate }, view, weight: S::WHOLE }
    }

    /// Leaves the facet for the next, or for good. With `MORE` the walker goes to the next facet at least as often as [`MEETS_MIN`], with a weight that
    /// makes up for it; a walker that leaves then has no valid weight.
    #[inline(always)]
    fn scatter<const MORE: bool>(
        &mut self,
        rough: &Rough<impl Chance<Share = S>>,
        stream: &mut Stream,
        facet: u32,
    ) -> Next {
        let (next, kept) = rough.scatter(stream, self.side, &self.view);
        let crossed = next.side != self.side;
        self.side = next.side;
        self.weight = self.weight.times(kept);
        let brightest = self.weight.brightest();
        if brightest < FAINT || facet >= FACETS_SURE {
            let mut survival = if facet < FACETS_SURE { 1.0 } else { SURVIVAL };
            if brightest < FAINT {
                survival *= brightest / FAINT;
            }
            if stream.uniform() >= survival {
                return Next::Died;
            }
            self.weight = self.weight.over(survival);
        }

        let up = next.direction.z;
        let v = 1.0 - stream.uniform();
        // Most rays leave: a bound of what they see tells without its being worked out.
        if !MORE && up > 0.0 {
            let most = rough.facets.most_seen_from_below(-next.direction);
            if most.is_some_and(|most| self.depth.surely_leaves(most / up, crossed, v)) {
                return Next::Left(next);
            }
        }
        self.view = rough.facets.view(-next.direction);
        let rate = self.view.area / up.abs();
        if MORE && up > 0.0 && rate > 0.0 && v > 1.0 - MEETS_MIN {
            let depth = if crossed { self.depth.flipped() } else { self.depth.value() };
            let meets = -libm::expm1(-rate * depth);
            if meets < MEETS_MIN {
                self.weight = self.weight.scaled(meets / MEETS_MIN);
                let free_path = -libm::log1p(-meets * ((1.0 - v) / MEETS_MIN)) / rate;
                self.depth = Depth::Known((depth - free_path).max(0.0));
                return Next::Facet;
            }
        }
        if up > 0.0 && (rate <= 0.0 || self.depth.surely_leaves(rate, crossed, v)) {
            return Next::Left(next);
        }
        let depth = if crossed { self.depth.flipped() } else { self.depth.value() };
        let free_path = -libm::log(v) / rate;
        if up > 0.0 {
            if free_path > depth {
                return Next::Left(next);
            }
            self.depth = Depth::Known(depth - free_path);
        } else {
            self.depth = Depth::Known(if free_path.is_finite() { depth + free_path } else { depth });
        }
        Next::Facet
    }
}

/// Direction in which light from `a` leaves the interface, its weight, and the facets that it met before its last one, by chance; `None`
/// when it dies.
#[inline(always)]
pub(crate) fn scatter<O: Chance>(rough: &Rough<O>, stream: &mut Stream, a: Sided) -> Option<(Sided, O::Share, u32)> {
    let mut walker = Walker::enter(&rough.facets, stream, a);
    let mut facet = 0;
    loop {
        match walker.scatter::<false>(rough, stream, facet) {
            Next::Facet => facet += 1,
            Next::Left(b) => return Some((b, walker.weight, facet)),
            Next::Died => return None,
        }
    }
}

/// An unbiased estimate of the density per solid angle of the light from `a` that leaves along `b`. Every facet of a walk adds the light that it
/// sends straight to `b`.
///
/// A walk may also start at `b`, against the light. It draws all facets of a path but the last, which is evaluated. If that facet mirrors most of
/// its light towards the other end, few walks find it and each is worth much, as with grazing light that goes from facet to facet. So either end
/// starts half of the walks, and balanced weights (Veach 1997) give each path to the end that finds it more often. Light that meets one facet alone
/// needs no weights.
pub(crate) fn kernel(rough: &Rough, stream: &mut Stream, a: Sided, b: Sided) -> f64 {
    let [reach_a, reach_b] = [a, b].map(|d| rough.optics.index(d.side) * rough.optics.index(d.side) * d.direction.z);
    // Reciprocity: the density from b to a over that from a to b.
    let turned = reach_a / reach_b;
    if stream.uniform() < 0.5 {
        from_one_end(rough, stream, a, b, turned)
    } else {
        from_one_end(rough, stream, b, a, 1.0 / turned) / turned
    }
}

/// The walk of [`kernel`] that begins at `a`.
fn from_one_end(rough: &Rough, stream: &mut Stream, a: Sided, b: Sided, turned: f64) -> f64 {
    let lambda = rough.facets.lambda(b.direction);
    let mut walker = Walker::<f64>::enter(&rough.facets, stream, a);
    let entered = walker.depth;
    let mut value = sent(rough, &walker, b, lambda);
    let mut next = walker.scatter::<true>(rough, stream, 0);
    let Next::Facet = next else { return value };
    // The density that a walk from b would find at this first facet, which is its last.
    let back = Sided { side: walker.side, direction: -walker.view.direction };
    let depth_of_a = libm::exp(-rough.facets.lambda(a.direction) * entered.value());
    let found_from_b = rough.phase(back.side, &rough.facets.view(back.direction), a) * depth_of_a;
    let mut facet = 1;
    while let Next::Facet = next {
        let found = sent(rough, &walker, b, lambda);
        if found > 0.0 {
            value += 2.0 * walker.weight * found * (found_from_b / (found_from_b + turned * found));
        }
        next = walker.scatter::<true>(rough, stream, facet);
        facet += 1;
    }
    value
}

/// [`kernel`] without weights between the ends: for tests.
#[cfg(test)]
pub(crate) fn one_ended(rough: &Rough, stream: &mut Stream, a: Sided, b: Sided) -> f64 {
    let lambda = rough.facets.lambda(b.direction);
    let mut walker = Walker::<f64>::enter(&rough.facets, stream, a);
    let (mut value, mut facet) = (0.0, 0);
    loop {
        value += walker.weight * sent(rough, &walker, b, lambda);
        match walker.scatter::<false>(rough, stream, facet) {
            Next::Facet => facet += 1,
            Next::Left(_) | Next::Died => return value,
        }
    }
}

/// Light that the walker's facet sends straight to `b`, whose Lambda is `lambda`, of a unit of light.
#[inline(always)]
fn sent(rough: &Rough, walker: &Walker, b: Sided, lambda: f64) -> f64 {
    let phase = rough.phase(walker.side, &walker.view, b);
    if phase > 0.0 { phase * walker.depth.leaving(lambda, walker.side != b.side) } else { 0.0 }
}

/// A guess at the density along `b` of light that meets more than one facet: cosine-distributed, and about as strong as
/// alpha squared. Only weights between strategies use it.
pub(crate) fn later_density(rough: &Rough, b: Sided) -> f64 {
    0.1 * rough.facets.alpha_sq() * b.direction.z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_surely_leaves_does_leave() {
        let grid: Vec<f64> = (1..=40).map(|i| f64::from(i) / 40.0).collect();
        let mut quick = 0;
        for &u in &grid {
            for rate in [1.0, 1.1, 3.0, 40.0] {
                for lambda in [1e-6, 0.05, 0.0625, 0.2, 0.25, 0.9, 1.0, 7.0] {
                    let depth = Depth::Drawn { u, rate };
                    for &v in &grid {
                        for (crossed, counted) in [(false, depth.value()), (true, depth.flipped())] {
                            if depth.surely_leaves(lambda, crossed, v) {
                                quick += 1;
                                assert!(-libm::log(v) >= lambda * counted * (1.0 - 1e-12), "{u} {rate} {lambda} {v}");
                            }
                        }
                    }
                }
            }
        }
        assert!(quick > 20_000, "{quick}");
    }
}
