/// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_i: f32) -> vec3<f32> { //? total_reflection
    // Where light is totally reflected, tables are over the cosine of the refracted direction. //? total_reflection
    let sin_theta_i_sq = (1.0 - cos_theta_i) * (1.0 + cos_theta_i); //? total_reflection
    let cos_theta_d = sqrt(max(cos_theta_i * cos_theta_i - layer.critical_cot_sq * sin_theta_i_sq, 0.0)); //? total_reflection
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> { //? !total_reflection
    if layer.film_tile >= 0.0 { //? film_table, fresnel
        let fraction = layer.film_thickness_nm / layer.film_thickness_max_nm; //? film_table
        return luthier_lookup_film(layer.film_tile, cos_theta_d, fraction); //? film_table
    } //? film_table, fresnel
    return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_d); //? fresnel
}

/// pi alpha^2 D of a layer, from the table and squares of the half vector. //? distribution, chain|smith, !anisotropic
/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from the table and squares of the half vector. //? distribution, chain|smith, anisotropic
fn luthier_distribution_term(layer: LuthierLayer, z_sq: f32, across_sq: f32) -> f32 { //? distribution, chain|smith, !closed, !anisotropic
fn luthier_distribution_term(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 { //? distribution, chain|smith, !closed, anisotropic
fn luthier_distribution_read(layer: LuthierLayer, z_sq: f32, across_sq: f32) -> f32 { //? distribution, chain|smith, closed, !anisotropic
fn luthier_distribution_read(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 { //? distribution, chain|smith, closed, anisotropic
    let alpha = layer.alpha; //? distribution, chain|smith, !anisotropic
    let alpha = layer.alpha * inverseSqrt(sharper); //? distribution, chain|smith, anisotropic
    let inverse_length_sq = 1.0 / (z_sq + across_sq); //? distribution, chain|smith
    let cos_theta_h = sqrt(z_sq * inverse_length_sq); //? distribution, chain|smith
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, across_sq * inverse_length_sq, alpha); //? distribution, chain|smith
} //? distribution, chain|smith
