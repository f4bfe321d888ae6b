/// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    if layer.film_tile >= 0.0 { //? film_table
        let fraction = layer.film_thickness_nm / layer.film_thickness_max_nm; //? film_table
        return luthier_lookup_film(layer.film_tile, cos_theta_d, fraction); //? film_table
    } //? film_table
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_d);
}

/// pi alpha^2 D of a layer, from the table and squares of the half vector. //? chain|smith, !closed, !anisotropic
/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from the table and squares of the half vector. //? chain|smith, !closed, anisotropic
fn luthier_distribution_term(layer: LuthierLayer, z_sq: f32, across_sq: f32) -> f32 { //? chain|smith, !closed, !anisotropic
    let alpha = layer.alpha; //? chain|smith, !closed, !anisotropic
fn luthier_distribution_term(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 { //? chain|smith, !closed, anisotropic
    let alpha = layer.alpha * inverseSqrt(sharper); //? chain|smith, !closed, anisotropic
    let inverse_length_sq = 1.0 / (z_sq + across_sq); //? chain|smith, !closed
    let cos_theta_h = sqrt(z_sq * inverse_length_sq); //? chain|smith, !closed
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, across_sq * inverse_length_sq, alpha); //? chain|smith, !closed
} //? chain|smith, !closed
