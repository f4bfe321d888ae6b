//! Choice of the channels of an OpenEXR file that are its colours.

use ::exr::meta::header::Header;

/// The channels of a layer that are its colours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Colors {
    /// Numbers of the channels of red, green and blue; one number three times for grey.
    pub(super) places: [usize; 3],
    /// Name of the layer, for a note, if another layer has colours too.
    pub(super) told: Option<String>,
}

impl Colors {
    pub(super) fn is_grey(&self) -> bool {
        self.places[0] == self.places[2]
    }
}

/// Names of layers that hold the whole picture, as renderers and stereo cameras name them. The first counts most.
const WHOLE: [&str; 6] = ["combined", "beauty", "rgba", "rgb", "color", "left"];

/// The colours of a part: channels without a layer, else of a layer that holds the whole picture, else of the first
/// layer. Channels are named R, G, B, or Y alone, after their layer and a dot.
pub(super) fn colors(header: &Header) -> Option<Colors> {
    let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    let split: Vec<(&str, &str)> = names.iter().map(|name| name.rsplit_once('.').unwrap_or(("", name))).collect();
    let mut layers: Vec<&str> = split.iter().map(|(layer, _)| *layer).collect();
    layers.dedup();
    let mut found: Vec<(&str, [usize; 3])> =
        layers.into_iter().filter_map(|layer| Some((layer, places(&split, layer)?))).collect();
    found.sort_by_key(|(layer, _)| rank(layer));
    found.dedup();
    let &(layer, places) = found.first()?;
    let told = (found.len() > 1 && !layer.is_empty()).then(|| layer.to_owned());
    Some(Colors { places, told })
}

/// The numbers of a layer's channels of red, green and blue, among all channels by layer and name.
fn places(channels: &[(&str, &str)], layer: &str) -> Option<[usize; 3]> {
    let [r, g, b, y, others @ ..] = ["R", "G", "B", "Y", "RY", "BY", "X", "Z"]
        .map(|wanted| channels.iter().position(|(of, name)| *of == layer && name.eq_ignore_ascii_case(wanted)));
    if let (Some(r), Some(g), Some(b)) = (r, g, b) {
        return Some([r, g, b]);
    }
    // With chroma (RY, BY) or as a part of XYZ, Y is not grey.
    y.filter(|_| others.iter().all(Option::is_none)).map(|y| [y; 3])
}

fn rank(layer: &str) -> usize {
    let last = layer.rsplit('.').next().unwrap_or("").to_ascii_lowercase();
    let whole = WHOLE.iter().position(|name| *name == last).unwrap_or(WHOLE.len());
    if layer.is_empty() { 0 } else { 1 + whole }
}
