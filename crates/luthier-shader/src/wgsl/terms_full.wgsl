/// Fresnel reflectance of a layer at three wavelengths, its film included.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    if layer.film_ior_n.x > 0.0 { //? film, bare
        return luthier_film(layer, cos_theta_d); //? film
    } //? film, bare
    return luthier_fresnel(layer.ior_n, layer.ior_k, cos_theta_d); //? bare
}
