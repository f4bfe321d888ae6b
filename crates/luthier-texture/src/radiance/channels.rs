//! Which channels of an OpenEXR file are its colours.

use ::exr::meta::header::Header;

/// The channels of a layer that are its colours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Colors {
    /// Numbers of the channels of red, green and blue; one number three times for grey.
    pub(super) places: [usize; 3],
    /// The layer, where another one has colours, too.
    pub(super) told: Option<String>,
}

impl Colors {
    pub(super) fn is_grey(&self) -> bool {
        self.places[0] == self.places[2]
    }
}

/// Names of layers that hold the picture as a whole, as renderers and stereo cameras name them; the first counts most.
const WHOLE: [&str; 6] = ["combined", "beauty", "rgba", "rgb", "color", "left"];

/// The colours of a part: those without a layer, or else of a layer that holds the whole picture, or else of the first one. Names of
/// channels are R, G, B, or Y alone; their layers stand before a dot.
pub(super) fn colors(header: &Header) -> Option<Colors> {
    let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    let split =
        |name: &str| name.rsplit_once('.').map_or(("".to_owned(), name.to_owned()), |(a, b)| (a.into(), b.into()));
    let split: Vec<(String, String)> = names.iter().map(|name| split(name)).collect();
    let mut layers: Vec<&str> = split.iter().map(|(layer, _)| layer.as_str()).collect();
    layers.dedup();
    let of_layer = |layer: &str| {
        let place = |wanted: &str| split.iter().position(|(of, name)| of == layer && name.eq_ignore_ascii_case(wanted));
        if let (Some(r), Some(g), Some(b)) = (place("R"), place("G"), place("B")) {
            return Some([r, g, b]);
        }
        let others = ["RY", "BY", "X", "Z"].iter().any(|other| place(other).is_some());
        place("Y").filter(|_| !others).map(|y| [y; 3])
    };
    let rank = |layer: &str| {
        let last = layer.rsplit('.').next().unwrap_or("").to_ascii_lowercase();
        let whole = WHOLE.iter().position(|name| *name == last).unwrap_or(WHOLE.len());
        if layer.is_empty() { 0 } else { 1 + whole }
    };
    let mut found: Vec<(&str, [usize; 3])> =
        layers.iter().filter_map(|layer| of_layer(layer).map(|places| (*layer, places))).collect();
    found.sort_by_key(|(layer, _)| rank(layer));
    found.dedup();
    let &(layer, places) = found.first()?;
    let told = (found.len() > 1 && !layer.is_empty()).then(|| layer.to_owned());
    Some(Colors { places, told })
}
