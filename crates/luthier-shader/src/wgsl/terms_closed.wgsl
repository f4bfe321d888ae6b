/// pi alpha^2 D of a layer, in closed form.
fn luthier_distribution_term(layer: LuthierLayer, alpha: f32, cos_theta_h: f32, sin_theta_h_sq: f32) -> f32 {
    if layer.distribution > 0.5 { //? beckmann, ggx
        return luthier_ggx(alpha, cos_theta_h, sin_theta_h_sq); //? ggx
    } //? beckmann, ggx
    return luthier_beckmann(alpha, cos_theta_h, sin_theta_h_sq); //? beckmann
}
