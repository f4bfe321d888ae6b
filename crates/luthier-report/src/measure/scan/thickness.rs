//! Check of thickness tiles: ranges and normalisation.

use super::User;
use crate::measure::subject::{Subject, Table};
use crate::text::format::number;

/// Largest relative error of a shipped value: half a unit in the last place of a half float, with room for one more rounding.
const HALF_FLOAT: f64 = 1e-3;

/// Impossible contents of a thickness texture: a thickness outside the range of its film, or a normalisation factor that is not
/// `sqrt(1 + dx^2 + dy^2)` of its slopes, if it has slopes. The map itself is unknown here: only the material file names it.
pub(super) fn doubts(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Vec<String> {
    let mut doubts = Vec::new();
    let [x0, y0] = table.entry.layout.origin(tile);
    let [width, height] = table.entry.layout.tile_size();
    let name = &table.entry.tiles[tile as usize].name;
    let has_slopes = match table.texels.channels {
        1 => false,
        4 => true,
        channels => return vec![format!("thickness tile {name}: it has {channels} channels, not one or four.")],
    };
    let (mut low, mut high, mut tilted) = (f64::INFINITY, f64::NEG_INFINITY, 0_u64);
    for (x, y) in (y0..y0 + height).flat_map(|y| (x0..x0 + width).map(move |x| (x, y))) {
        let texel = table.texels.texel(x, y);
        let d = f64::from(texel[0]);
        (low, high) = (low.min(d), high.max(d));
        // Written so that NaN is a doubt.
        let agrees = d.is_finite() && (!has_slopes || is_norm([1, 2, 3].map(|c: usize| f64::from(texel[c]))));
        tilted += u64::from(!agrees);
    }
    if tilted > 0 {
        doubts.push(format!(
            "thickness tile {name}: in {tilted} texels the thickness or the normalisation factor of its slopes is wrong."
        ));
    }
    for &(material, layer) in users {
        let Some(film) = subject.stacks[material].layers.get(layer).and_then(|l| l.films.first()) else { continue };
        let to_nm = 2.0 * film.thickness.max_nm;
        let (found_low, found_high) = (low * to_nm, high * to_nm);
        let slack = HALF_FLOAT * film.thickness.max_nm;
        if found_low < film.thickness.min_nm - slack || found_high > film.thickness.max_nm + slack {
            doubts.push(format!(
                "thickness tile {name}: it holds {} to {} nm, the film is {} to {} nm.",
                number(found_low),
                number(found_high),
                number(film.thickness.min_nm),
                number(film.thickness.max_nm)
            ));
        }
    }
    doubts
}

/// Whether a factor is `sqrt(1 + dx^2 + dy^2)`, within the rounding of half floats.
fn is_norm([dx, dy, factor]: [f64; 3]) -> bool {
    let expected = libm::sqrt(1.0 + dx * dx + dy * dy);
    (factor - expected).abs() <= HALF_FLOAT * expected
}
