//! Position-free paths of light through a stack.
//!
//! Between interfaces only directions matter (Guo, Hasan and Zhao 2018, "Position-Free Monte Carlo Simulation for Arbitrary Layered
//! BSDFs").

use glam::DVec3;

use super::InterfaceMode;
use super::interface::Interface;
use super::optics::Side;
use super::random::Stream;
use super::rough::Sided;
use crate::monochrome::Monochrome;

/// Event from which on a path survives by chance: late, because light that a lossless stack holds back would make noise.
pub(super) const EVENTS_SURE: usize = 4096;

/// Event from which on a path survives by chance if it is to be connected: connecting costs the square of its length.
const EVENTS_SURE_CONNECTED: usize = 64;

/// Probability per event with which a path survives.
const SURVIVAL: f64 = 0.9;

/// Light fainter than this survives by chance too.
const FAINT: f64 = 0.1;

/// A stack made ready for paths.
#[derive(Debug, Clone)]
pub(crate) struct Interfaces {
    interfaces: Vec<Interface>,
    /// Optical depth along the normal of the slab below each interface.
    optical_depths: Vec<f64>,
    exterior: f64,
}

/// Light that comes to an interface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arrival {
    /// Number of the interface, from the top.
    pub(crate) interface: usize,
    /// Side and direction that the light comes from.
    pub(crate) from: Sided,
    /// Weight that is left of the light.
    pub(crate) weight: f64,
    /// Sum over the earlier events of the density of the strategies that connect there, over the density of the one
    /// that connects here, but for the density of this event (Veach 1997, sec. 10.2, as a recursion).
    pub(crate) earlier: f64,
}

impl Interfaces {
    pub(crate) fn new(stack: &Monochrome, mode: InterfaceMode) -> Self {
        Self {
            interfaces: stack.layers.iter().map(|layer| Interface::new(layer, mode)).collect(),
            optical_depths: stack.layers.iter().map(|layer| layer.below.optical_depth()).collect(),
            exterior: stack.exterior,
        }
    }

    /// Whether any interface sends light into more directions than a smooth one.
    pub(crate) fn scatter(&self) -> bool {
        self.interfaces.iter().any(|interface| !interface.is_smooth() && !interface.is_black())
    }

    pub(crate) fn get(&self, interface: usize) -> &Interface {
        &self.interfaces[interface]
    }

    /// Index of the exterior.
    pub(crate) fn exterior(&self) -> f64 {
        self.exterior
    }

    /// Index of the medium on a side of an interface.
    pub(crate) fn index(&self, interface: usize, side: Side) -> f64 {
        let own = self.interfaces[interface].index(side);
        // A diffuse base has no index: the medium is the one below the interface before.
        own.or_else(|| self.interfaces[interface.checked_sub(1)?].index(Side::Below)).unwrap_or(self.exterior)
    }

    /// Follows light from `start` (above the stack, away from it) until it leaves: upward, with the direction and
    /// what is left of it; or else, `None`. Every arrival at an interface is shown to `visit`, the first included.
    ///
    /// `WEIGHTS` says whether [`Arrival::earlier`] is wanted.
    pub(crate) fn trace<const WEIGHTS: bool>(
        &self,
        stream: &mut Stream,
        start: DVec3,
        mut visit: impl FnMut(Arrival),
    ) -> Option<(DVec3, f64)> {
        let from = Sided { side: Side::Above, direction: start };
        let mut arrival = Arrival { interface: 0, from, weight: 1.0, earlier: 0.0 };
        let mut events = 0;
        loop {
            visit(arrival);
            let Arrival { interface: number, from, .. } = arrival;
            let interface = self.interfaces.get(number)?;
            let (to, kept) = interface.scatter(stream, from)?;
            let weight = arrival.weight * kept;
            let (next, slab, side) = match to.side {
                Side::Above if number == 0 => return Some((to.direction, weight)),
                Side::Above => (number - 1, number - 1, Side::Below),
                Side::Below => (number + 1, number, Side::Above),
            };
            if next >= self.interfaces.len() {
                return None;
            }
            if WEIGHTS {
                let own = if interface.is_smooth() { 0.0 } else { 1.0 };
                let (forth, back) = interface.densities(from, to);
                arrival.earlier = (own + back * arrival.earlier) / forth;
            }
            let optical_depth = self.optical_depths[slab];
            arrival.weight =
                if optical_depth > 0.0 { weight * libm::exp(-optical_depth / to.direction.z) } else { weight };
            let DVec3 { x, y, z } = to.direction;
            arrival.from = Sided { side, direction: DVec3::new(-x, -y, z) };
            arrival.interface = next;
            events += 1;
            let sure = if WEIGHTS { EVENTS_SURE_CONNECTED } else { EVENTS_SURE };
            arrival.weight /= survives(stream, arrival.weight, events < sure)?;
        }
    }
}

/// The probability with which light survives, if it does.
pub(super) fn survives(stream: &mut Stream, weight: f64, sure: bool) -> Option<f64> {
    if sure && weight >= FAINT {
        return Some(1.0);
    }
    let mut survival = if sure { 1.0 } else { SURVIVAL };
    if weight < FAINT {
        survival *= weight / FAINT;
    }
    (stream.uniform() < survival).then_some(survival)
}
