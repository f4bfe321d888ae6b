/// pi alpha^2 D of a layer, in closed form, from squares of the half vector. //? !anisotropic, !distribution
/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, in closed form, from squares of the half vector. //? anisotropic, !distribution
/// pi alpha^2 D of a layer, from its tile or in closed form, from squares of the half vector. //? !anisotropic, distribution
/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from its tile or in closed form, from squares of the half vector. //? anisotropic, distribution
fn luthier_distribution_term(layer: LuthierLayer, z_sq: f32, across_sq: f32) -> f32 { //? !anisotropic
    if layer.distribution_tile >= 0.0 { //? !anisotropic, distribution
        return luthier_distribution_read(layer, z_sq, across_sq); //? !anisotropic, distribution
    } //? !anisotropic, distribution
    let falloff = layer.falloff; //? !anisotropic
fn luthier_distribution_term(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 { //? anisotropic
    if layer.distribution_tile >= 0.0 { //? anisotropic, distribution
        return luthier_distribution_read(layer, sharper, z_sq, across_sq); //? anisotropic, distribution
    } //? anisotropic, distribution
    let falloff = layer.falloff * sharper; //? anisotropic
    if layer.distribution > 0.5 { //? beckmann, ggx
        return luthier_ggx(falloff, z_sq, across_sq); //? ggx
    } //? beckmann, ggx
    return luthier_beckmann(falloff, z_sq, across_sq); //? beckmann
}
