//! Fits of lobes to reflections.

use super::Lobe;
use super::simplex::minimise;
use super::target::Target;

/// Width of the first simplex: in logarithms of scales, in widths of the lobe, in radians.
const STEPS: [f64; 4] = [0.15, 0.15, 0.3, 0.15];
/// Loss of shared energy from one shape to the next that starts a second search.
const JUMP: f64 = 0.004;
/// Turn of the second start, as a share of the mirror direction's angle.
const MIRROR_TURN: f64 = 0.6;

/// A lobe by the parameters of a fit: M is a rotation about y times a matrix of scales and skew (section 4 of the
/// paper, whose rotation is not fitted).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shape {
    /// Logarithm of the scale in the plane of incidence.
    ln_along: f64,
    /// Logarithm of the scale across.
    ln_across: f64,
    /// Angle from the normal to the image of the cosine's axis, towards the mirror direction.
    centre: f64,
    /// Angle of the rotation.
    turn: f64,
}

impl Shape {
    /// A lobe about the normal.
    fn upright(ln_scale: f64) -> Self {
        Self { ln_along: ln_scale, ln_across: ln_scale, centre: 0.0, turn: 0.0 }
    }

    pub(super) fn lobe(self) -> Lobe {
        let skew = libm::tan(self.turn - self.centre);
        let (sin, cos) = (libm::sin(self.turn), libm::cos(self.turn));
        let across = libm::exp(self.ln_across);
        let ratio = libm::exp(self.ln_across - self.ln_along);
        Lobe { m11: ratio * (cos + skew * sin), m13: ratio * (sin - skew * cos), m31: -across * sin, m33: across * cos }
    }

    /// This shape, for a mirror direction `by` radians farther from the normal.
    fn turned(self, by: f64) -> Self {
        Self { centre: self.centre + by, turn: self.turn + by, ..self }
    }

    fn moved(self, by: [f64; 4]) -> Self {
        Self {
            ln_along: self.ln_along + by[0],
            ln_across: self.ln_across + by[1],
            centre: self.centre + by[2] * libm::exp(self.ln_along).min(1.0),
            turn: self.turn + by[3],
        }
    }
}

/// The lobe about the normal that shares most energy with a reflection, for normal incidence. A golden-section search.
pub(super) fn fit_upright(target: &Target) -> Shape {
    let golden = 0.5 * (libm::sqrt(5.0) - 1.0);
    // The scale is 2 alpha for smooth surfaces, and less for rough ones.
    let middle = libm::log(2.0 * target.alpha);
    let (mut from, mut to) = (middle - 1.6, middle + 0.8);
    let mut inner = [to - golden * (to - from), from + golden * (to - from)];
    let mut values = inner.map(|ln_scale| upright_loss(target, ln_scale));
    while to - from > 1e-7 {
        if values[0] < values[1] {
            to = inner[1];
            inner = [to - golden * (to - from), inner[0]];
            values = [upright_loss(target, inner[0]), values[0]];
        } else {
            from = inner[0];
            inner = [inner[1], from + golden * (to - from)];
            values = [values[1], upright_loss(target, inner[1])];
        }
    }
    Shape::upright(0.5 * (from + to))
}

/// The share of energy that an upright lobe misses.
fn upright_loss(target: &Target, ln_scale: f64) -> f64 {
    1.0 - target.shared(Shape::upright(ln_scale).lobe(), 1.0)
}

/// The shape that shares most energy with a reflection, found from another: the simplex search of Nelder and Mead 1965, twice.
pub(super) fn fit_from(target: &Target, start: Shape) -> Shape {
    let first = search(target, start, STEPS);
    search(target, first, STEPS.map(|step| 0.3 * step))
}

/// Shapes of one roughness, from normal to grazing incidence, each found from the last. If a shape shares less energy
/// than the last by more than [`JUMP`], a second search starts at the mirror direction, and the better of both is
/// taken.
pub(super) fn fit_column(targets: impl Iterator<Item = Target>) -> Vec<Shape> {
    let mut shapes: Vec<Shape> = Vec::new();
    let (mut upright, mut last_theta, mut last_cos, mut last_shared) = (0.0, 0.0, 1.0, 1.0);
    for target in targets {
        let (theta, cos) = (libm::acos(target.cos_theta_o), target.cos_theta_o);
        let shape = match shapes.last() {
            Some(last) => {
                // A reflected lobe narrows across by the cosine.
                let across = last.ln_across + libm::log(cos / last_cos);
                let next = Shape { ln_across: across, ..last.turned(theta - last_theta) };
                let found = fit_from(&target, next);
                let shared = target.shared(found.lobe(), 1.0);
                if shared + JUMP > last_shared {
                    found
                } else {
                    let mirror = Shape {
                        ln_along: upright,
                        ln_across: upright + libm::log(cos),
                        centre: theta,
                        turn: MIRROR_TURN * theta,
                    };
                    let other = fit_from(&target, mirror);
                    if target.shared(other.lobe(), 1.0) > shared { other } else { found }
                }
            }
            None => {
                let shape = fit_upright(&target);
                upright = shape.ln_along;
                if cos == 1.0 { shape } else { fit_from(&target, shape.turned(theta)) }
            }
        };
        (last_theta, last_cos, last_shared) = (theta, cos, target.shared(shape.lobe(), 1.0));
        shapes.push(shape);
    }
    shapes
}

fn search(target: &Target, start: Shape, steps: [f64; 4]) -> Shape {
    start.moved(minimise(steps, |by| {
        let lobe = start.moved(by).lobe();
        // Excludes lobes that are turned inside out or away from the normal: reads between texels could not pass
        // through them.
        if lobe.determinant() > 0.0 && lobe.m11 > 0.0 && lobe.m33 > 0.0 { 1.0 - target.shared(lobe, 1.0) } else { 1.0 }
    }))
}

#[cfg(test)]
mod tests {
    use luthier_optics::masking::Correlation;
    use luthier_optics::stack::Distribution;

    use super::super::target::{Rules, Surface};
    use super::*;

    const GGX: Surface = Surface { distribution: Distribution::Ggx, correlation: Correlation::Height };

    #[test]
    fn a_lobe_is_fitted_by_itself() {
        for shape in [
            Shape { ln_along: -1.2, ln_across: -1.6, centre: 0.7, turn: 0.5 },
            Shape { ln_along: -2.5, ln_across: -3.0, centre: 0.3, turn: 0.4 },
            Shape { ln_along: -0.4, ln_across: -0.6, centre: 0.9, turn: 0.2 },
        ] {
            let mut target = Target::new(&Rules::fitting(), GGX, 0.3, libm::cos(shape.centre));
            for node in &mut target.nodes {
                node.density = shape.lobe().pdf_solid_angle(node.w);
            }
            let found = fit_from(&target, shape.moved([0.4, -0.3, 0.8, -0.2])).lobe().texel();
            for (found, expected) in found.into_iter().zip(shape.lobe().texel()) {
                assert!((found - expected).abs() < 1e-3 * (1.0 + expected.abs()), "{shape:?}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_lobe_about_the_normal_is_fitted_by_itself() {
        for ln_scale in [-4.0, -1.5, -0.2] {
            let mut target = Target::new(&Rules::fitting(), GGX, (0.6 * libm::exp(ln_scale)).min(1.0), 1.0);
            for node in &mut target.nodes {
                node.density = Shape::upright(ln_scale).lobe().pdf_solid_angle(node.w);
            }
            let found = fit_upright(&target);
            assert!((found.ln_along - ln_scale).abs() < 1e-4, "{ln_scale}: {found:?}");
        }
    }

    /// The column's path ends no worse than searches that start elsewhere.
    #[test]
    fn fits_are_the_best_of_many_starts() {
        let rules = Rules::fitting();
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            let surface = Surface { distribution, ..GGX };
            for alpha in [0.01, 0.15, 0.8] {
                let at = |j: i32| Target::new(&rules, surface, alpha, 1.0 - f64::from(j * j) / (21.0 * 21.0));
                let shapes = fit_column((0..21).map(at));
                for j in [3, 10, 17, 20] {
                    let target = at(j);
                    let loss = |shape: Shape| 1.0 - target.shared(shape.lobe(), 1.0);
                    let shape = shapes[j as usize];
                    for by in [[0.7, 0.3, 0.0, 0.5], [-0.7, -0.3, 0.5, -0.5], [0.0, 0.5, -1.0, 0.0]] {
                        let other = fit_from(&target, shape.moved(by));
                        let (found, other) = (loss(shape), loss(other));
                        assert!(found < other + 1e-3, "{distribution:?} {alpha} {j}: {found} {other}");
                    }
                }
            }
        }
    }
}
