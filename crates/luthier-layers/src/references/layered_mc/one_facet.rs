//! A rough interface with one facet per event: light in the facets' shadows is lost.
//!
//! Reflection and refraction have the height-correlated masking `G2 = 1 / (1 + Lambda_i + Lambda_o)`, the form that
//! fast models use for both (for refraction Smith's model itself has a Beta function, Heitz et al. 2016, eq. 46).

use glam::DVec3;

use super::facets::Facets;
use super::random::Stream;
use super::rough::{Rough, Sided};

/// Direction in which light from `a` leaves the interface, and its weight, by chance; `None` when it is lost.
pub(crate) fn scatter(rough: &Rough, stream: &mut Stream, a: Sided) -> Option<(Sided, f64)> {
    let (b, kept) = rough.scatter(stream, a.side, &rough.facets.view(a.direction));
    (b.direction.z > 0.0).then(|| (b, kept * masking(&rough.facets, a.direction, b.direction)))
}

/// Density per solid angle of the light from `a` that leaves along `b`.
pub(crate) fn kernel(rough: &Rough, a: Sided, b: Sided) -> f64 {
    rough.phase(a.side, &rough.facets.view(a.direction), b) * masking(&rough.facets, a.direction, b.direction)
}

/// G2 / G1.
pub(super) fn masking(facets: &Facets, a: DVec3, b: DVec3) -> f64 {
    let visible = 1.0 + facets.lambda(a);
    visible / (visible + facets.lambda(b))
}
