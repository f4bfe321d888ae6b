/// Fresnel reflectance of a layer at three wavelengths, its film included.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    if layer.film_ior_n.x > 0.0 { //? film, bare
        return luthier_film(layer, cos_theta_d); //? film
    } //? film, bare
    return luthier_fresnel(layer.ior_n, layer.ior_k, cos_theta_d); //? bare
}

/// pi alpha^2 D of a layer. //? chain|smith
fn luthier_distribution_term(layer: LuthierLayer, alpha: f32, cos_theta_h: f32, sin_theta_h_sq: f32) -> f32 { //? chain|smith
    if layer.distribution > 0.5 { //? beckmann, ggx, chain|smith
        return luthier_ggx(alpha, cos_theta_h, sin_theta_h_sq); //? ggx, chain|smith
    } //? beckmann, ggx, chain|smith
    return luthier_beckmann(alpha, cos_theta_h, sin_theta_h_sq); //? beckmann, chain|smith
} //? chain|smith
