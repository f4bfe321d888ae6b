//! Random walks on Smith micro-surfaces, with every bounce between facets.
//!
//! Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model". Heights
//! enter only through the fraction `c` of the surface that lies below: the result does not depend on the height
//! distribution. The coordinate here is the depth `-ln c`, 0 at the top: a ray that goes up with Smith's Lambda leaves
//! from there with probability `exp(-Lambda depth)`.

use glam::DVec3;

use crate::microfacet::lambda;
use crate::stack::Distribution;
use crate::visible_normals;

/// A walk ends when its remaining light falls below this fraction, which then counts as leaving at the last facet. The error of a
/// reflectance is below half of the fraction.
const REMAINDER: f64 = 1e-3;

/// Largest number of facets of a walk.
const MAX_FACETS: u32 = 64;

/// Number of sets of four Sobol dimensions; later facets use them again.
const SETS: u32 = 64;

/// Identity of a walk: its numbers are a function of this and nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Walk {
    /// Family of the walk; families are independent of each other.
    pub seed: u32,
    /// Number of the walk in its family; families are low-discrepancy in it (Owen-scrambled Sobol).
    pub index: u32,
}

impl Walk {
    /// The four numbers of a facet, each in 0..1: depth before it, two for its normal, and one to choose.
    fn numbers(self, facet: u32) -> [f64; 4] {
        sobol_burley::sample_4d(self.index, facet % SETS, self.seed).map(f64::from)
    }
}

/// A facet of a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// Cosine between the ray and the facet's normal: the argument of Fresnel's formulas.
    pub cos_theta_d: f64,
    /// Fraction of the incident light that leaves after this facet if all facets reflect everything. The fractions of
    /// a walk sum to 1.
    pub leaving: f64,
}

/// A walk of the light that falls at `cos_theta_i` on a perfectly reflecting surface: its facets in order.
///
/// The walk depends on the geometry only, so one walk serves every Fresnel term: multiply the reflectances of the facets
/// up to each, times what leaves there. `alpha` > 0, `cos_theta_i` > 0.
pub fn reflecting_walk(distribution: Distribution, alpha: f64, cos_theta_i: f64, walk: Walk, visit: impl FnMut(Facet)) {
    let distribution = distribution.walked();
    let ray = -incident(cos_theta_i);
    let numbers = walk.numbers(0);
    let depth = Passage::new(distribution, alpha, ray, 0.0).next_depth(numbers[0]);
    walk_from(distribution, alpha, Start { ray, depth, facet: 0, numbers }, walk, visit);
}

/// The rest of a walk whose first facet is known: light from `cos_theta_i`, whose Lambda is `lambda_i`, has left the facet along `ray` and will
/// meet the surface again.
///
/// First facets lie at heights of density `(1 + Lambda_i) c^Lambda_i`; a share `1 - c^Lambda_o` of the light goes on. In
/// `-ln c` the product of the two is the density of a sum of two exponential variables, of rates `1 + Lambda_i` and
/// `1 + Lambda_i + Lambda_o`, so the depth is drawn exactly and all walks weigh the same.
pub fn walk_after_first_facet(
    distribution: Distribution,
    alpha: f64,
    lambda_i: f64,
    ray: DVec3,
    walk: Walk,
    visit: impl FnMut(Facet),
) {
    let distribution = distribution.walked();
    let rate = 1.0 + lambda_i;
    let [first, .., second] = walk.numbers(0);
    let mut passage = Passage::new(distribution, alpha, ray, -libm::log(1.0 - first) / rate);
    if passage.is_up {
        passage.depth -= libm::log(1.0 - second) / (rate + passage.lambda);
    }
    let numbers = walk.numbers(1);
    let depth = passage.next_depth(numbers[0] * (1.0 - passage.escape()));
    walk_from(distribution, alpha, Start { ray, depth, facet: 1, numbers }, walk, visit);
}

/// A ray about to meet facet number `facet` at `depth`, and the numbers of that facet.
struct Start {
    ray: DVec3,
    depth: f64,
    facet: u32,
    numbers: [f64; 4],
}

fn walk_from(distribution: Distribution, alpha: f64, start: Start, walk: Walk, mut visit: impl FnMut(Facet)) {
    let Start { mut ray, mut depth, facet: first, mut numbers } = start;
    let mut light = 1.0;
    for facet in first..MAX_FACETS {
        let w = -ray;
        let m = visible_normals::sample(distribution, alpha, w, [numbers[1], numbers[2]]);
        let cos_theta_d = w.dot(m).max(0.0);
        ray = (2.0 * cos_theta_d * m - w).normalize();
        let passage = Passage::new(distribution, alpha, ray, depth);
        let escape = passage.escape();
        let left = light * (1.0 - escape);
        if left < REMAINDER || facet + 1 == MAX_FACETS {
            visit(Facet { cos_theta_d, leaving: light });
            return;
        }
        visit(Facet { cos_theta_d, leaving: light * escape });
        light = left;
        numbers = walk.numbers(facet + 1);
        depth = passage.next_depth(numbers[0] * (1.0 - escape));
    }
}

/// Branches of a walk that carry more light than this are split into their reflected and refracted halves; lesser ones take
/// one of them by chance.
const SPLIT: f64 = 0.02;

/// The interface between transparent media at the facets of a micro-surface.
#[derive(Clone, Copy)]
pub struct TransparentFacets<R> {
    /// Index below over index above.
    pub eta: f64,
    /// Reflectance from above by the cosine, films included. From below it is the same at the refracted angle (no absorption), and 1 under
    /// total reflection.
    pub from_above: R,
}

impl<R: Fn(f64) -> f64> TransparentFacets<R> {
    /// Reflectance, and cosine of the refracted ray on the other side.
    fn split(&self, above: bool, cos_theta: f64) -> (f64, f64) {
        let eta_ti = if above { self.eta } else { 1.0 / self.eta };
        let cos_t_sq = 1.0 - (1.0 - cos_theta * cos_theta) / (eta_ti * eta_ti);
        if cos_t_sq <= 0.0 {
            return (1.0, 0.0);
        }
        let cos_t = libm::sqrt(cos_t_sq);
        ((self.from_above)(if above { cos_theta } else { cos_t.min(1.0) }), cos_t)
    }
}

/// Fraction of the light of a walk that crosses an interface between transparent media and returns upward.
///
/// Light that leaves counts by its expectation; strong branches are followed both ways, weak ones reflect or refract by chance.
/// `alpha` > 0, `cos_theta_i` > 0.
pub fn crossed_and_returned(
    distribution: Distribution,
    alpha: f64,
    facets: TransparentFacets<impl Fn(f64) -> f64>,
    cos_theta_i: f64,
    walk: Walk,
) -> f64 {
    let distribution = distribution.walked();
    let ray = -incident(cos_theta_i);
    let depth = Passage::new(distribution, alpha, ray, 0.0).next_depth(walk.numbers(0)[0]);
    let mut branches = vec![Branch { ray, depth, light: 1.0, facet: 0, above: true, crossed: false }];
    let mut returned = 0.0;
    while let Some(branch) = branches.pop() {
        let Branch { ray, depth, light, facet, above, .. } = branch;
        let w = -ray;
        let [_, u, v, choice] = walk.numbers(facet);
        let m = visible_normals::sample(distribution, alpha, w, [u, v]);
        let cos_theta_d = w.dot(m).max(0.0);
        let eta_ti = if above { facets.eta } else { 1.0 / facets.eta };
        let (reflectance, cos_t) = facets.split(above, cos_theta_d);

        let reflected = (2.0 * cos_theta_d * m - w).normalize();
        let mirror = Branch { ray: reflected, light: light * reflectance, ..branch };
        let refracted = (m * (cos_theta_d / eta_ti - cos_t) - w / eta_ti).normalize();
        let through = Branch {
            // In the frame of the other side, where the surface is flipped and heights count from the other end.
            ray: DVec3::new(refracted.x, refracted.y, -refracted.z),
            depth: flipped(depth),
            light: light * (1.0 - reflectance),
            above: !above,
            crossed: true,
            ..branch
        };
        let both = if light > SPLIT {
            [Some(mirror), Some(through)]
        } else if choice < reflectance {
            [Some(Branch { light, ..mirror }), None]
        } else {
            [None, Some(Branch { light, ..through })]
        };
        for next in both.into_iter().flatten() {
            let passage = Passage::new(distribution, alpha, next.ray, next.depth);
            let escape = passage.escape();
            if next.above && next.crossed {
                returned += next.light * escape;
            }
            let left = next.light * (1.0 - escape);
            if left > REMAINDER && facet + 1 < MAX_FACETS {
                let u = walk.numbers(facet + 1)[0] * (1.0 - escape);
                let depth = passage.next_depth(u);
                branches.push(Branch { depth, light: left, facet: facet + 1, ..next });
            }
        }
    }
    returned
}

/// Light on its way between facets, in the frame of the side it is on.
#[derive(Clone, Copy)]
struct Branch {
    ray: DVec3,
    depth: f64,
    light: f64,
    facet: u32,
    above: bool,
    crossed: bool,
}

fn incident(cos_theta_i: f64) -> DVec3 {
    DVec3::new(libm::sqrt((1.0 - cos_theta_i * cos_theta_i).max(0.0)), 0.0, cos_theta_i)
}

/// A ray that goes from a depth to the next facet, or out.
struct Passage {
    depth: f64,
    /// Whether it goes up.
    is_up: bool,
    /// Lambda of its slope, up or down.
    lambda: f64,
}

impl Passage {
    fn new(distribution: Distribution, alpha: f64, ray: DVec3, depth: f64) -> Self {
        Self { depth, is_up: ray.z > 0.0, lambda: lambda(distribution, alpha, ray.z.abs()) }
    }

    /// Probability that it leaves the surface without meeting it again (Heitz et al. 2016, eq. 20).
    fn escape(&self) -> f64 {
        if self.is_up { libm::exp(-self.depth * self.lambda) } else { 0.0 }
    }

    /// Depth at which it meets the surface again, given that it does: `u` is uniform in 0..(1 - probability to leave).
    fn next_depth(&self, u: f64) -> f64 {
        let Self { depth, is_up, lambda } = *self;
        match (is_up, lambda) {
            (false, _) => depth - libm::log(1.0 - u) / (1.0 + lambda),
            (true, 0.0) => 0.0,
            (true, _) => (depth + libm::log(1.0 - u) / lambda).max(0.0),
        }
    }
}

/// The depth of a place in the frame of the other side: from `-ln c` to `-ln(1 - c)`, which stays finite at depth 0.
fn flipped(depth: f64) -> f64 {
    -libm::log((-libm::expm1(-depth)).max(f64::MIN_POSITIVE))
}
