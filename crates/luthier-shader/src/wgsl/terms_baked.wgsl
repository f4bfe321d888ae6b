/// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    if layer.film_tile >= 0.0 { //? film_table
        let fraction = layer.film_thickness_nm / layer.film_thickness_max_nm; //? film_table
        return luthier_lookup_film(layer.film_tile, cos_theta_d, fraction); //? film_table
    } //? film_table
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_d);
}

/// pi alpha^2 D of a layer, from the table. //? chain|smith, !closed
fn luthier_distribution_term(layer: LuthierLayer, alpha: f32, cos_theta_h: f32, sin_theta_h_sq: f32) -> f32 { //? chain|smith, !closed
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, sin_theta_h_sq, alpha); //? chain|smith, !closed
} //? chain|smith, !closed
