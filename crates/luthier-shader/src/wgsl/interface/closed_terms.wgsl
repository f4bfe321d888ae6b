/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from squares of the half vector.
fn luthier_distribution_term(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 {
    //? distribution
    if layer.distribution_tile >= 0.0 {
        return luthier_distribution_read(layer, sharper, z_sq, across_sq);
    }
    //? anisotropic
    let falloff = layer.falloff * sharper;
    //? else
    let falloff = layer.falloff;
    //? free_slopes
    $free_slopes
    //? else
    //? beckmann
    {
        //? ggx
        if layer.distribution > 0.5 {
            return luthier_ggx(falloff, z_sq, across_sq);
        }
        return luthier_beckmann(falloff, z_sq, across_sq);
    }
    //? else
    return luthier_ggx(falloff, z_sq, across_sq);
}
