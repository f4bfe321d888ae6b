//! Numbers of a surface in closed form: the rules of the import, turned round.

mod gltf;
mod open_pbr;
mod standard_surface;

use luthier_import::{Fate, Line};
use luthier_optics::Rgb;

use crate::fit::Free;
use crate::surface::{Coat, Film, Slopes, Surface};
use crate::{Format, Numbers, numbers};

/// Numbers in closed form, those that are left to a fit, and what became of each property.
pub(crate) struct Closed {
    pub(crate) numbers: Numbers,
    pub(crate) free: Vec<Free>,
    pub(crate) lines: Vec<Line>,
}

/// The numbers of a surface in a format.
pub(crate) fn closed(format: Format, surface: &Surface) -> Closed {
    match format {
        Format::Gltf => gltf::closed(surface),
        Format::OpenPbr => open_pbr::closed(surface),
        Format::StandardSurface => standard_surface::closed(surface),
    }
}

/// Roughness, anisotropy and turn of slopes in a format.
pub(crate) fn facets(format: Format, slopes: &Slopes) -> [f64; 3] {
    match format {
        Format::Gltf => gltf::facets(slopes),
        Format::OpenPbr => open_pbr::facets(slopes),
        Format::StandardSurface => standard_surface::facets(slopes),
    }
}

/// A film on a metal that is given by its index, in words, and what becomes of it in formats whose films lie on an F0.
const FILM_ON_METAL: &str = "film on a metal by its index";
const FITTED_BELOW_FILM: &str = "films lie on an F0: the colour is fitted";

/// Words for absorption below an interface, where the format has none.
const IN_THE_COLOR: &str = "it is in the colour of the base, at all angles alike";

/// A property that was taken over.
fn say(lines: &mut Vec<Line>, property: &str, fate: Fate, note: impl Into<String>) {
    lines.push(Line { property: property.to_owned(), fate, note: note.into() });
}

/// Lines on slopes, and whether a roughness is left to the fit.
fn say_slopes(lines: &mut Vec<Line>, of: &str, slopes: &Slopes, rule: &str) -> bool {
    let property = format!("{of}: slopes");
    if slopes.is_ggx {
        say(lines, &property, Fate::ClosedForm, rule);
        return false;
    }
    say(lines, &property, Fate::Approximated, "facets of formats are GGX's, which has a tail: the roughness is fitted");
    true
}

/// The film; its thickness is a range where a map may say so.
fn film(lines: &mut Vec<Line>, film: Option<&Film>) -> Option<numbers::Film> {
    let film = film?;
    if film.is_on_coat {
        say(lines, "film on the coat", Fate::Dropped, "formats have films on the base");
        return None;
    }
    say(lines, "film: index, thickness, weight", Fate::Kept, "engines have approximations of Airy's formula");
    Some(numbers::Film {
        weight: film.weight,
        ior: film.ior,
        thickness_nm: [film.thickness.min_nm, film.thickness.max_nm],
    })
}

/// Light that goes through a coat and back along the normal.
fn transmittance(depth: Rgb) -> Rgb {
    depth.map(|depth| libm::exp(-2.0 * depth))
}

/// The width of a base's lobe outside of a coat: to first order a facet of slope s below a coat of index n turns light by 2 n s outside, and each of two passages through facets
/// of the coat turns it by (n - 1) s. Variances add.
fn widened(alpha: f64, coat: &Coat) -> f64 {
    let (n, own) = (coat.ior, coat.slopes.facets.mean());
    let through = 0.5 * (n - 1.0) * (n - 1.0) * own * own;
    (n * n * alpha * alpha + through).sqrt().min(1.0)
}

/// Slope parameters with the larger along the direction, and the angle to it: a quarter of a turn where the file has the smaller there.
fn lengthwise(slopes: &Slopes) -> ([f64; 2], f64) {
    let [x, y] = slopes.facets.alpha;
    if y > x { ([y, x], slopes.facets.turn + std::f64::consts::FRAC_PI_2) } else { ([x, y], slopes.facets.turn) }
}

/// The greatest of three.
fn most(rgb: Rgb) -> f64 {
    rgb.into_iter().fold(0.0, f64::max)
}

/// An F0 as a share of the greatest channel, and that.
fn hue(f0: Rgb) -> (Rgb, f64) {
    let most = most(f0);
    if most > 0.0 { (f0.map(|f| f / most), most) } else { ([1.0; 3], 0.0) }
}

/// Holds a colour to 0 to 1, which spectra of metals may leave.
fn held(lines: &mut Vec<Line>, color: Rgb) -> Rgb {
    let held = color.map(|c| c.clamp(0.0, 1.0));
    if held != color {
        say(lines, "base: colour", Fate::Approximated, "the spectrum's colour is beyond Rec.709: held to 0 to 1");
    }
    held
}
