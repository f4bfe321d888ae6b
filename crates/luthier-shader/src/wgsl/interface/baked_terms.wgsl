//? rows
/// Fresnel reflectance of a layer, from its row or, under a film that varies, its tile of the tables.
fn $fresnel_read(layer: LuthierLayer, cos_theta_i: f32) -> vec3<f32> {
    //? total_reflection
    {
        // Where light is totally reflected, tables are over the cosine of the refracted direction.
        let sin_theta_i_sq = (1.0 - cos_theta_i) * (1.0 + cos_theta_i);
        let cos_theta_d = sqrt(max(cos_theta_i * cos_theta_i - layer.critical_cot_sq * sin_theta_i_sq, 0.0));
    }
    //? else
    let cos_theta_d = cos_theta_i;
    //? fresnel
    {
        //? film_table
        if layer.film_tile >= 0.0 {
            let fraction = layer.film_thickness_nm / layer.film_thickness_max_nm;
            return luthier_lookup_film(layer.film_tile, cos_theta_d, fraction);
        }
        return luthier_lookup_fresnel(layer.fresnel_tile, cos_theta_d);
    }
    //? else
    {
        let fraction = layer.film_thickness_nm / layer.film_thickness_max_nm;
        return luthier_lookup_film(layer.film_tile, cos_theta_d, fraction);
    }
}

//? distribution, chain|smith|coat
/// pi alpha^2 D of a layer whose falloff is `sharper` times its own, from the table and squares of the half vector.
fn $distribution_read(layer: LuthierLayer, sharper: f32, z_sq: f32, across_sq: f32) -> f32 {
    //? anisotropic
    let alpha = layer.alpha * inverseSqrt(sharper);
    //? else
    let alpha = layer.alpha;
    let inverse_length_sq = 1.0 / (z_sq + across_sq);
    let cos_theta_h = sqrt(z_sq * inverse_length_sq);
    return luthier_lookup_distribution(layer.distribution_tile, cos_theta_h, across_sq * inverse_length_sq, alpha);
}
