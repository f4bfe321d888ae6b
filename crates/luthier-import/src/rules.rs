//! Numbers that formats of one kind share, and how a material file says them.

use crate::draft::number;

/// Reflectance along the normal of the dielectric that a file need not name.
pub(crate) const F0: f64 = 0.04;

/// The largest F0 below which texels scale the light of a base.
pub(crate) const MAPPED_F0_MAX: f64 = 0.9;

/// Width of a repeat of a film's map, which no format states, um. Shaders do not show it.
const EXTENT_UM: f64 = 100_000.0;

/// Reflectance along the normal of an index; 1 where it is none.
pub(crate) fn f0(ior: f64) -> f64 {
    let root = (ior - 1.0) / (ior + 1.0);
    if root.is_finite() { (root * root).min(1.0) } else { 1.0 }
}

/// Slope parameters along and across the direction of `KHR_materials_anisotropy`.
pub(crate) fn gltf_alphas(roughness: f64, strength: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    [alpha + (1.0 - alpha) * strength * strength, alpha]
}

/// A film whose thickness varies, as TOML; `map` goes from the least to the most, nm.
pub(crate) fn thickness([least, most]: [f64; 2], map: &str) -> String {
    let [least, most, extent] = [least, most, EXTENT_UM].map(number);
    format!("{{ min = {least}, max = {most}, extent_um = {extent}, map = {map} }}")
}

/// A picture with what is said of it, as TOML.
pub(crate) fn picture(path: &str, words: impl IntoIterator<Item = Option<String>>) -> String {
    let words: Vec<String> =
        std::iter::once(format!("image = \"{path}\"")).chain(words.into_iter().flatten()).collect();
    format!("{{ {} }}", words.join(", "))
}

/// A placement of texture coordinates, which are scaled, then turned from u towards v, then moved; `None` for one that changes nothing.
pub(crate) fn placement(offset: [f64; 2], rotation_deg: f64, scale: [f64; 2]) -> Option<String> {
    let pair = |[u, v]: [f64; 2]| format!("[{}, {}]", number(u), number(v));
    let words = [
        (offset != [0.0; 2]).then(|| format!("offset = {}", pair(offset))),
        (rotation_deg != 0.0).then(|| format!("rotation_deg = {}", number(rotation_deg))),
        (scale != [1.0; 2]).then(|| format!("scale = {}", pair(scale))),
    ];
    let words: Vec<String> = words.into_iter().flatten().collect();
    (!words.is_empty()).then(|| format!("transform = {{ {} }}", words.join(", ")))
}
