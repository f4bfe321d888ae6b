//! Shapes of stacks, by which costs are looked up.

use luthier_manifest::ShadingModel;
use luthier_model::Reach;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Stack};

/// The properties of a stack that decide which code its shader has, layer by layer from the top, joined by `/`.
///
/// | letter | says |
/// |---|---|
/// | `d`, `c`, `l`, `o` | dielectric, conductor, Lambert's base, Oren and Nayar's base |
/// | `b`, `g` | Beckmann's or GGX slopes |
/// | `a` | anisotropic |
/// | `f`, `v` | has a film; a film whose thickness varies |
/// | `x` | the slab below absorbs |
pub fn shape(stack: &Stack) -> String {
    let last = stack.layers.len().saturating_sub(1);
    let codes: Vec<String> = stack.layers.iter().enumerate().map(|(i, layer)| code(layer, i < last)).collect();
    codes.join("/")
}

/// The part of a shape that a model reads.
pub fn shape_of(model: ShadingModel, shape: &str) -> String {
    let facts = model.facts();
    let mut read = match facts.reach {
        Reach::None => String::new(),
        Reach::All => shape.to_owned(),
        Reach::First | Reach::FirstAndBase => shape.split('/').next().unwrap_or_default().replace('x', ""),
    };
    let base = shape.rsplit('/').next().filter(|base| base.starts_with(['l', 'o']));
    if facts.reach == Reach::FirstAndBase && base.is_some() {
        read += "/l";
    }
    // One anisotropic layer puts all lobes into axes.
    if facts.is_isotropic || model.is_fitted() {
        read = read.replace('a', "");
    }
    if model.is_fitted() && shape.contains('a') {
        read.push('a');
    }
    read
}

fn code(layer: &Layer, has_slab: bool) -> String {
    if let Base::Diffuse(Diffuse { sigma, .. }) = layer.base {
        return if sigma == 0.0 { "l" } else { "o" }.to_owned();
    }
    let mut code = String::new();
    code.push(if matches!(layer.base, Base::Conductor { .. }) { 'c' } else { 'd' });
    code.push(if layer.surface.distribution == Distribution::Ggx { 'g' } else { 'b' });
    if layer.surface.alpha_x != layer.surface.alpha_y {
        code.push('a');
    }
    if let Some(film) = layer.films.first() {
        code.push(if film.thickness.min_nm == film.thickness.max_nm { 'f' } else { 'v' });
    }
    if let Base::Dielectric { slab, .. } = &layer.base
        && has_slab
        && slab.optical_depth() != [0.0; 3]
    {
        code.push('x');
    }
    code
}

/// Distance of two shapes: the number of letters that only one of them has, layer by layer from the bottom. A missing layer counts as ten letters.
pub(crate) fn distance(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|shape| shape.rsplit('/').collect::<Vec<_>>());
    let pairs = a.iter().zip(&b).flat_map(|(a, b)| [(a, b), (b, a)]);
    let unlike: usize = pairs.map(|(a, b)| a.chars().filter(|c| !b.contains(*c)).count()).sum();
    unlike + 10 * a.len().abs_diff(b.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_see_what_they_use() {
        let shape = "dgax/cbf";
        assert_eq!(shape_of(ShadingModel::Phong, shape), "");
        assert_eq!(shape_of(ShadingModel::Microfacet, shape), "dga");
        assert_eq!(shape_of(ShadingModel::Elek, shape), "dgx/cbf");
        assert_eq!(
            ["dgax/cbf", "dgx/cba", "dgx/cb"].map(|shape| shape_of(ShadingModel::Lobes, shape)),
            ["dga", "dga", "dg"]
        );
        assert_eq!(shape_of(ShadingModel::Yamaguchi, shape), shape);
        assert_eq!(shape_of(ShadingModel::GranierHeidrich, "dgax/o"), "dg/l");
    }

    #[test]
    fn distance_is_least_for_the_same() {
        assert_eq!(distance("dgx/cb", "dgx/cb"), 0);
        assert_eq!(distance("dgx/cb", "dg/cb"), 1);
        assert_eq!(distance("dgx/cb", "dbx/cb"), 2);
        assert_eq!(distance("dgx/cb", "cb"), 10);
    }
}
