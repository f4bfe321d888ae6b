//! Live numbers of a material for a page: sliders, and the words of the shader that they decide.

use luthier_manifest::{LiveEntry, LiveRange, MapSlot, MaterialEntry};
use serde::Serialize;

/// Words of `view_live` before those of layers, see `view.glsl`.
const WHOLE_WORDS: usize = 4;

/// Words of each layer.
const LAYER_WORDS: usize = 2;

/// End of the slider of a factor that nothing bounds.
const FACTOR_MOST: f64 = 4.0;

/// Live numbers of a look.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct PageLive {
    /// Numbers of `view_live` that differ from those of a material without live numbers, each with its place.
    set: Vec<(usize, f64)>,
    sliders: Vec<PageSlider>,
}

/// A slider.
#[derive(Debug, PartialEq, Serialize)]
struct PageSlider {
    label: String,
    /// Member of `LuthierPlace` that it decides.
    member: String,
    least: f64,
    most: f64,
    value: f64,
    /// Places of its number.
    places: Vec<usize>,
}

impl PageLive {
    /// Those of a material; `None` where it has none that a page shows. Normals have no slider.
    pub(crate) fn of(entry: &MaterialEntry) -> Option<Self> {
        let mut found = Self { set: Vec::new(), sliders: Vec::new() };
        for live in &entry.live {
            let layer = WHOLE_WORDS + LAYER_WORDS * live.layer as usize;
            // The first of its places, and whether it is a number of the whole surface that says by another one that it counts.
            let (first, counts) = match live.slot {
                MapSlot::Thickness if live.layer == 0 => (0, None),
                MapSlot::Weight => (1, None),
                MapSlot::Roughness => (2, None),
                MapSlot::Albedo => (4, Some((7, 1.0))),
                MapSlot::BaseColor => (8, None),
                MapSlot::Metallic => (11, None),
                MapSlot::Alpha | MapSlot::AlphaX => (4 * layer, None),
                MapSlot::AlphaY => (4 * layer + 1, None),
                MapSlot::Thickness => (4 * layer + 2, None),
                MapSlot::Tangent => (4 * layer + 3, None),
                MapSlot::Absorption => (4 * layer + 4, None),
                MapSlot::Normal
                | MapSlot::Bumps
                | MapSlot::Lean
                | MapSlot::FlakeNormal
                | MapSlot::Patina
                | MapSlot::F0 => continue,
            };
            found.set.extend(counts);
            for (part, value) in values(live).into_iter().enumerate() {
                let mut places = vec![first + part];
                if live.slot == MapSlot::Alpha {
                    places.push(first + 1);
                }
                found.set.extend(places.iter().map(|place| (*place, value)));
                let (least, most) = match (live.slot, live.range) {
                    (MapSlot::Tangent, _) | (_, None) => (-90.0, 90.0),
                    (_, Some(LiveRange { least, most })) => (least, most.unwrap_or(FACTOR_MOST)),
                };
                let (label, member) = (label(live, part), live.member.clone());
                found.sliders.push(PageSlider { label, member, least, most, value, places });
            }
        }
        (!found.sliders.is_empty()).then_some(found)
    }
}

/// Numbers of the sliders of a live number: those of the file. A direction is an angle in degrees.
fn values(live: &LiveEntry) -> Vec<f64> {
    match (live.slot, live.default.as_slice()) {
        (MapSlot::Tangent, [x, y]) => vec![libm::atan2(*y, *x).to_degrees()],
        (_, values) => values.to_vec(),
    }
}

fn label(live: &LiveEntry, part: usize) -> String {
    let (layer, name) = (live.layer + 1, live.slot.name());
    let part = if live.default.len() == 3 { [" r", " g", " b"][part] } else { "" };
    let unit = match (live.slot, live.number.is_empty()) {
        (MapSlot::Tangent, _) => " °",
        (_, false) => " ×",
        _ => "",
    };
    format!("{layer} · {name}{part}{unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_places_of_their_own() {
        let slots = [
            (MapSlot::Thickness, 0, 1),
            (MapSlot::Thickness, 1, 1),
            (MapSlot::Absorption, 0, 3),
            (MapSlot::Absorption, 1, 3),
            (MapSlot::Weight, 0, 1),
            (MapSlot::Roughness, 0, 1),
            (MapSlot::Alpha, 0, 1),
            (MapSlot::AlphaX, 2, 1),
            (MapSlot::AlphaY, 2, 1),
            (MapSlot::Tangent, 2, 2),
            (MapSlot::BaseColor, 2, 3),
            (MapSlot::Metallic, 2, 1),
            (MapSlot::Bumps, 2, 3),
        ];
        let live = slots.map(|(slot, layer, count)| LiveEntry {
            slot,
            layer,
            member: LiveEntry::member_of(slot, layer),
            default: vec![1.0; count],
            range: Some(LiveRange { least: 0.0, most: None }),
            number: Vec::new(),
        });
        let page = PageLive::of(&MaterialEntry { live: live.to_vec(), ..MaterialEntry::default() }).unwrap();
        let mut places: Vec<usize> = page.sliders.iter().flat_map(|slider| slider.places.clone()).collect();
        places.sort_unstable();
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
        // Bumps have none, and the slope parameter of an isotropic layer has two.
        assert_eq!((page.sliders.len(), places.len()), (18, 19));
        assert!(PageLive::of(&MaterialEntry::default()).is_none());
    }
}
