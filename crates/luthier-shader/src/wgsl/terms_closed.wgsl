/// pi alpha^2 D of a layer, in closed form, from squares of the half vector. //? !anisotropic
/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, in closed form, from squares of the half vector. //? anisotropic
fn luthier_distribution_term(layer: LuthierLayer, z_sq: f32, across_sq: f32) -> f32 { //? !anisotropic
    let falloff = layer.falloff; //? !anisotropic
fn luthier_distribution_term(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 { //? anisotropic
    let falloff = layer.falloff * sharper; //? anisotropic
    if layer.distribution > 0.5 { //? beckmann, ggx
        return luthier_ggx(falloff, z_sq, across_sq); //? ggx
    } //? beckmann, ggx
    return luthier_beckmann(falloff, z_sq, across_sq); //? beckmann
}
