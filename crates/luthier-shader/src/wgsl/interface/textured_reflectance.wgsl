//? film_f0
{
    /// Whether the film of a layer lies on a base whose maps give each place an F0: its tile is over the root of that F0.
    fn luthier_is_film_over(layer: LuthierLayer) -> bool {
        return layer.film_tile >= 0.0 && layer.ior_k.x < 0.0;
    }

    /// Reflectance of such a film over the dielectric, of an F0 of 0.04.
    fn luthier_film_over_plastic(layer: LuthierLayer, cos_theta: f32) -> vec3<f32> {
        return luthier_lookup_film(layer.film_tile, cos_theta, 0.2);
    }

    /// Reflectance of such a film over the metal of the place, each channel by its own F0.
    fn luthier_film_over_metal(layer: LuthierLayer, cos_theta: f32) -> vec3<f32> {
        let red = luthier_lookup_film(layer.film_tile, cos_theta, layer.film_roots.x);
        let green = luthier_lookup_film(layer.film_tile, cos_theta, layer.film_roots.y);
        let blue = luthier_lookup_film(layer.film_tile, cos_theta, layer.film_roots.z);
        return vec3<f32>(red.x, green.y, blue.z);
    }
}

/// Reflectance of a layer as it is at a place: Schlick's form with another F0 leaves a constant factor of what it left,
/// less what an edge tint keeps.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    //? film_f0
    if luthier_is_film_over(layer) {
        var reflected = luthier_film_over_plastic(layer, cos_theta_d);
        if layer.film_roots.w > 0.0 {
            reflected = mix(reflected, luthier_film_over_metal(layer, cos_theta_d), layer.film_roots.w);
        }
        return reflected;
    }
    //? own_edge
    {
        let away = 1.0 - saturate(cos_theta_d);
        let cubed = away * away * away;
        let kept = layer.edge * (saturate(cos_theta_d) * cubed * cubed);
        return max(1.0 - layer.passing * (1.0 - luthier_fresnel_given(layer, cos_theta_d)) - kept, vec3<f32>(0.0));
    }
    //? else
    return 1.0 - layer.passing * (1.0 - luthier_fresnel_given(layer, cos_theta_d));
}
