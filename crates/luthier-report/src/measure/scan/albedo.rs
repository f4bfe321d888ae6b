//! Scan of FGD tiles against new estimates of the directional albedo.

use luthier_layers::formulas::refraction::REFRACTION_WAVELENGTH_NM;
use luthier_optics::Rgb;
use luthier_optics::albedo::{Effort, FacetStatistics, ReflectanceCurves, crossed_albedo};
use luthier_optics::color::{Color, WavelengthNode, luminance};
use luthier_optics::interface::Interface;
use luthier_optics::microsurface::TransparentFacets;
use luthier_optics::stack::{Base, Distribution};
use rayon::prelude::*;

use super::{Measured, R2, fraction, users};
use crate::error::ReportError;
use crate::measure::subject::{Subject, Table, color};
use crate::measure::table_terms::{AngleAxis, Weights};

/// Most points of the scan.
const POINTS_MAX: u32 = 48;
/// Fewest points of the scan.
const POINTS_MIN: u32 = 4;
/// Pairs of directions in a set for each point of the scan, so that a quick judgement is quick in all its parts.
const PAIRS_PER_POINT: u32 = 64;
/// Independent estimates at every point; their spread is the uncertainty.
pub(crate) const REPEATS: u32 = 4;
/// Smallest cosine of the scan: 89.5 degrees.
pub(crate) const DOMAIN_COS_THETA: f64 = 0.0087;
/// Smallest alpha of the scan.
pub(crate) const DOMAIN_ALPHA: f64 = 0.01;
/// Calls of `step` in a scan.
pub(crate) const STEPS: u32 = 8;

/// Quadrature points of the first bounce, and first facets of the walks per direction, of one estimate: twice the baker's.
const EFFORT: Effort = Effort { first: 32, later: 64 };
/// Walks of one estimate of the light that crosses and returns, shared among wavelengths.
const CROSSED_WALKS: u32 = 4096;
/// Fewest walks for each wavelength.
const CROSSED_WALKS_MIN: u32 = 128;
/// Largest change of a product of reflectances that leaving out wavelengths may cause, for light that crosses and returns.
const CROSSED_TOLERANCE: f64 = 1e-3;
/// Cosines at which spectra are compared to decide which wavelengths are left out.
const CROSSED_COS_THETA: [f64; 5] = [1.0, 0.6, 0.3, 0.15, 0.05];
/// First seed of this scan.
const SEED: u32 = 0x6a75_6467;

/// Number of points of the scan. All tiles have equal points, so that they share walks.
pub(crate) fn points(pairs_per_set: u32) -> u32 {
    (pairs_per_set / PAIRS_PER_POINT).clamp(POINTS_MIN, POINTS_MAX)
}

/// Compares every wanted tile, at points of its own domain, with the directional albedo of the interfaces that read it. The albedo is estimated
/// wavelength by wavelength: the first bounce by quadrature, later bounces and crossed light by walks with the judge's own seeds.
pub(super) fn scan(
    table: &Table<'_>,
    subject: &Subject<'_>,
    is_wanted: &dyn Fn(u32) -> bool,
    count: u32,
    step: &mut dyn FnMut(),
) -> Result<Vec<Option<Measured>>, ReportError> {
    let angle = AngleAxis::of(table)?;
    let layout = &table.entry.layout;
    let readers = readers(table, subject, is_wanted);
    let mut measured: Vec<Option<Measured>> = (0..layout.tiles).map(|_| None).collect();
    for part in 0..STEPS {
        let points: Vec<u32> = (0..count).filter(|n| n * STEPS / count == part).collect();
        let estimates: Vec<(Point, Vec<Estimate>)> = points
            .into_par_iter()
            .map(|n| {
                let point = Point::new(n, table, angle);
                (point, estimates(&readers, point))
            })
            .collect();
        for (point, estimates) in estimates {
            for (reader, estimate) in readers.iter().zip(estimates) {
                let Measured { scan, uncertainty, .. } = measured[reader.tile as usize].get_or_insert_default();
                let sampled = table.read(reader.tile, point.values, Weights::EightBit);
                for (channel, &sampled) in sampled.iter().enumerate().take(table.entry.format.channels() as usize) {
                    if scan.add(&point.values, channel, estimate.mean[channel], sampled) {
                        *uncertainty = Some(estimate.standard_error[channel]);
                    }
                }
            }
        }
        step();
    }
    Ok(measured)
}

/// A point of the scan.
#[derive(Clone, Copy)]
struct Point {
    number: u32,
    cos_theta: f64,
    alpha: f64,
    /// Values on the axes of the table.
    values: [f64; 2],
}

impl Point {
    /// Point `number` of an additive recurrence over the part of the table that lies in the domain.
    fn new(number: u32, table: &Table<'_>, angle: AngleAxis) -> Self {
        let x = &table.entry.layout.x;
        let u = [0, 1].map(|k: usize| fraction(0.5 + f64::from(number) * R2[k]));
        let [from, to] = [DOMAIN_COS_THETA, 1.0].map(|cos| x.encode(angle.value_at(cos)));
        let value = x.decode(from + (to - from) * u[0]);
        let alpha = table.entry.layout.y.as_ref().map_or(0.0, |y| {
            let [from, to] = [DOMAIN_ALPHA, 1.0].map(|alpha| y.encode(alpha));
            y.decode(from + (to - from) * u[1])
        });
        Self { number, cos_theta: angle.cos_and_sin_sq(value).0.clamp(0.0, 1.0), alpha, values: [value, alpha] }
    }
}

/// An interface that reads a tile, ready to evaluate. Users with equal interfaces are one reader.
struct Reader {
    tile: u32,
    interface: Interface,
    color: Color,
    distribution: Distribution,
    weights: Vec<Rgb>,
    curves: ReflectanceCurves,
    /// Wavelengths at which light crosses; none for opaque bases.
    crossing: Vec<Crossing>,
}

/// A transparent interface at one wavelength.
struct Crossing {
    weight: Rgb,
    eta: f64,
    curve: ReflectanceCurves,
}

fn readers(table: &Table<'_>, subject: &Subject<'_>, is_wanted: &dyn Fn(u32) -> bool) -> Vec<Reader> {
    let mut readers: Vec<Reader> = Vec::new();
    for tile in (0..table.entry.layout.tiles).filter(|tile| is_wanted(*tile)) {
        for (m, l) in users(subject, table.entry.kind, tile) {
            let stack = &subject.stacks[m];
            let (Some(layer), Some(interface)) = (stack.layers.get(l), Interface::of(stack, l)) else { continue };
            let entry = &subject.manifest.materials[m];
            let color = color(entry);
            let distribution = layer.surface.distribution;
            let is_known = readers.iter().any(|r| {
                r.tile == tile && r.interface == interface && r.color == color && r.distribution == distribution
            });
            if is_known {
                continue;
            }
            let transparent = matches!(layer.base, Base::Dielectric { .. });
            let (weights, at): (Vec<Rgb>, Vec<_>) = interface.sampled(&color).nodes.into_iter().unzip();
            let curves = ReflectanceCurves::new(at.len(), |k, cos_theta| at[k].reflectance(cos_theta));
            let crossing = if transparent { crossing(&interface, &color) } else { Vec::new() };
            readers.push(Reader { tile, interface, color, distribution, weights, curves, crossing });
        }
    }
    readers
}

/// The wavelengths that crossed light needs: they keep reflectances and their squares. Colours of films cross in full, because a film lets those
/// wavelengths through that it does not reflect.
fn crossing(interface: &Interface, color: &Color) -> Vec<Crossing> {
    let nodes = color.nodes();
    let mut spectra = Vec::new();
    for cos_theta in CROSSED_COS_THETA {
        for channel in interface.channels() {
            let at = |n: &WavelengthNode| interface.at(n.wavelength_nm, channel).reflectance(cos_theta);
            let once: Vec<f64> = nodes.iter().map(at).collect();
            let twice = once.iter().map(|r| r * r).collect();
            spectra.extend([once, twice]);
        }
    }
    let sampled = interface.at_nodes(&color.sparse_nodes(&spectra, CROSSED_TOLERANCE));
    let bent = interface.eta_under_films(REFRACTION_WAVELENGTH_NM);
    let crossings = sampled.nodes.into_iter().map(|(weight, at)| Crossing {
        weight,
        eta: bent.unwrap_or(at.below.re / at.above.re),
        curve: ReflectanceCurves::new(1, |_, cos_theta| at.reflectance(cos_theta)),
    });
    crossings.collect()
}

/// A table's value at a point, estimated: RGB, and the luminance of the part that never crossed.
struct Estimate {
    mean: [f64; 4],
    standard_error: [f64; 4],
}

/// One estimate per reader.
fn estimates(readers: &[Reader], point: Point) -> Vec<Estimate> {
    let mut repeats: Vec<Vec<[f64; 4]>> = vec![Vec::new(); readers.len()];
    for repeat in 0..REPEATS {
        let seed = SEED.wrapping_add(point.number * REPEATS + repeat);
        for distribution in [Distribution::Beckmann, Distribution::Ggx] {
            if readers.iter().all(|r| r.distribution != distribution) {
                continue;
            }
            let facets = FacetStatistics::new(distribution, point.alpha, point.cos_theta, EFFORT, seed);
            for (reader, found) in readers.iter().zip(&mut repeats).filter(|(r, _)| r.distribution == distribution) {
                let [r, g, b] = sum(reader.weights.iter().zip(facets.albedo(&reader.curves)));
                let back = crossed(reader, point, seed);
                found.push([r + back[0], g + back[1], b + back[2], luminance([r, g, b])]);
            }
        }
    }
    repeats.iter().map(|values| estimate(values)).collect()
}

fn crossed(reader: &Reader, point: Point, seed: u32) -> Rgb {
    let walks = (CROSSED_WALKS / reader.crossing.len().max(1) as u32).max(CROSSED_WALKS_MIN);
    let each = reader.crossing.iter().zip(0..).map(|(crossing, wavelength): (_, u32)| {
        let facets = TransparentFacets { eta: crossing.eta, from_above: |cos| crossing.curve.at(0, cos) };
        // Every wavelength has walks of its own, so that their noise averages out. The factor is 2^32 over the golden ratio.
        let seed = seed.wrapping_add((wavelength + 1).wrapping_mul(0x9e37_79b9));
        let value = crossed_albedo(reader.distribution, point.alpha, facets, point.cos_theta, walks, seed);
        (&crossing.weight, value)
    });
    sum(each)
}

fn sum<'a>(terms: impl Iterator<Item = (&'a Rgb, f64)>) -> Rgb {
    let mut rgb = [0.0; 3];
    for (weight, value) in terms {
        for c in 0..3 {
            rgb[c] += weight[c] * value;
        }
    }
    rgb
}

/// Mean of independent values and its standard error.
fn estimate(values: &[[f64; 4]]) -> Estimate {
    let count = values.len() as f64;
    let mean = [0, 1, 2, 3].map(|c: usize| values.iter().map(|v| v[c]).sum::<f64>() / count);
    let standard_error = [0, 1, 2, 3].map(|c: usize| {
        let squares: f64 = values.iter().map(|v| (v[c] - mean[c]) * (v[c] - mean[c])).sum();
        (squares / (count * (count - 1.0)).max(1.0)).sqrt()
    });
    Estimate { mean, standard_error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_errors_by_hand() {
        // Variance of 1, 2, 3, 6 is 14/3; divided by four and rooted.
        let e = estimate(&[[1.0; 4], [2.0; 4], [3.0; 4], [6.0; 4]]);
        assert_eq!(e.mean, [3.0; 4]);
        assert!((e.standard_error[2] - (14.0_f64 / 12.0).sqrt()).abs() < 1e-15);
    }
}
