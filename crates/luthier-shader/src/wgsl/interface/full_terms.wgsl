/// Fresnel reflectance of a layer at three wavelengths, its film included.
fn $fresnel_computed(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    //? schlick
    //? bare|film
    if layer.ior_k.x < 0.0 {
        //? edge_tint
        return luthier_edge_tinted(layer, cos_theta_d);
        //? else
        return luthier_schlick(layer.ior_n, cos_theta_d);
    }
    //? else
    //? edge_tint
    return luthier_edge_tinted(layer, cos_theta_d);
    //? else
    return luthier_schlick(layer.ior_n, cos_theta_d);
    //? bare|film
    //? bare
    {
        //? film
        if layer.film_ior_n.x > 0.0 {
            return luthier_film(layer, cos_theta_d);
        }
        //? complex_index
        return luthier_fresnel(layer.ior_n, layer.ior_k, cos_theta_d);
        //? else
        return vec3<f32>(luthier_fresnel_real(layer.ior_n.x, cos_theta_d));
    }
    //? else
    return luthier_film(layer, cos_theta_d);
}
