//! Bidirectional estimate of a value: light paths from both directions, connected at every interface that both meet.
//!
//! A path with k events has one estimator per event that is not smooth: the directions before it are drawn from the
//! side of `wo`, those after it from the side of `wi`, and the event itself is evaluated. Balanced weights (Veach
//! 1997) keep whichever draws the narrow lobes, so smooth coats over rough bases, rough coats over smooth bases and
//! light through any number of interfaces are found alike.

use glam::DVec3;

use super::path::{Arrival, Interfaces};
use super::random::Stream;

/// Connections of less weight than this are evaluated by chance.
const SLIGHT: f64 = 0.1;

/// Buffers of [`sample`].
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    from_eye: Vec<Arrival>,
    from_light: Vec<Arrival>,
}

/// One sample of `f cos_theta_i`.
pub(crate) fn sample(stack: &Interfaces, scratch: &mut Scratch, stream: &mut Stream, wi: DVec3, wo: DVec3) -> f64 {
    let Scratch { from_eye, from_light } = scratch;
    from_eye.clear();
    from_light.clear();
    stack.trace::<true>(stream, wo, |arrival| from_eye.push(arrival));
    stack.trace::<true>(stream, wi, |arrival| from_light.push(arrival));

    let incident = stack.exterior() * stack.exterior() * wi.z;
    let mut sum = 0.0;
    for eye in from_eye.iter() {
        let interface = stack.get(eye.interface);
        if interface.is_smooth() {
            continue;
        }
        for light in from_light.iter().filter(|light| light.interface == eye.interface) {
            // The light's subpath was drawn against the light's way: reciprocity of all its kernels together.
            let index = stack.index(light.interface, light.from.side);
            let turned = incident / (index * index * light.from.direction.z);
            let (forth, back) = interface.densities(eye.from, light.from);
            let others = back * eye.earlier + forth * light.earlier;
            let mut weight = 1.0 / (1.0 + others);
            if weight < SLIGHT {
                if stream.uniform() * SLIGHT >= weight {
                    continue;
                }
                weight = SLIGHT;
            }
            let kernel = interface.kernel(stream, eye.from, light.from);
            sum += eye.weight * kernel * turned * light.weight * weight;
        }
    }
    sum
}

/// Whether both directions are above the stack.
pub(crate) fn both_above(wi: DVec3, wo: DVec3) -> bool {
    wi.z > 0.0 && wo.z > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::references::layered_mc::InterfaceMode;
    use crate::references::layered_mc::optics::Side;
    use crate::references::layered_mc::rough::Sided;

    #[test]
    fn weights_of_all_strategies_of_a_path_sum_to_one() {
        // A path of five events through a rough coat over a rough base, written out, and the weight of each strategy
        // from the recursions on both sides of it.
        let stack = Interfaces::new(
            &crate::references::layered_mc::fixtures::rough_coat_on_metal(0.3, 0.2),
            InterfaceMode::SmithWalk,
        );
        let d = |x: f64, y: f64| DVec3::new(x, y, libm::sqrt(1.0 - x * x - y * y));
        let turned = |d: DVec3| DVec3::new(-d.x, -d.y, d.z);
        let directions = [d(0.3, 0.1), d(-0.2, 0.1), d(0.1, 0.3), d(0.2, -0.5), d(0.4, 0.1), d(-0.6, 0.3)];
        let (above, below) = (Side::Above, Side::Below);
        // Where each event finds its light and sends it, by side, and its interface.
        let events = [(0, above, below), (1, above, above), (0, below, below), (1, above, above), (0, below, above)];
        let sided = |side, direction| Sided { side, direction };
        let ends: Vec<(usize, Sided, Sided)> = events
            .iter()
            .enumerate()
            .map(|(k, &(i, from, to))| {
                let before = if k == 0 { directions[0] } else { turned(directions[k]) };
                (i, sided(from, before), sided(to, directions[k + 1]))
            })
            .collect();
        let mut earlier = vec![0.0];
        for &(i, a, b) in &ends {
            let last = earlier[earlier.len() - 1];
            earlier.push((1.0 + stack.get(i).densities(a, b).1 * last) / stack.get(i).densities(a, b).0);
        }
        let mut later = vec![0.0];
        for &(i, a, b) in ends.iter().rev() {
            let last = later[later.len() - 1];
            later.push((1.0 + stack.get(i).densities(a, b).0 * last) / stack.get(i).densities(a, b).1);
        }
        let total: f64 = ends
            .iter()
            .enumerate()
            .map(|(k, &(i, a, b))| {
                let (before, after) = (earlier[k], later[ends.len() - 1 - k]);
                let (forth, back) = stack.get(i).densities(a, b);
                1.0 / (1.0 + back * before + forth * after)
            })
            .sum();
        assert!((total - 1.0).abs() < 1e-12, "{total}");
    }
}
