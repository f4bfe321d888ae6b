/// `LuthierPlace::patina` where the map of a material has a value, 0 to 1: clamp(1/2 + (extent - map) / (2 transition), 0, 1)
/// (Elek 2010, section 4.2). -1 for a material without patina.
fn luthier_patina_amount(material: u32, map_value: f32) -> f32 {
    let shape = luthier_materials[luthier_header(material) + $word_patina];
    let ahead = shape.x - map_value;
    let soft = saturate(0.5 + ahead / (2.0 * max(shape.y, 1e-30)));
    let amount = select(select(0.0, 1.0, ahead >= 0.0), soft, shape.y > 0.0);
    //? weight
    return select(-1.0, amount, abs(shape.w - 1.0) < 0.5);
    //? else
    return select(-1.0, amount, shape.w > 0.5);
}

/// Scattering in the patina of a place: a diffuse term below the first interface, f cos_theta_i.
fn luthier_patina_diffuse(place: LuthierPlace, material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if place.patina <= 0.0 {
        return vec3<f32>(0.0);
    }
    let cover = luthier_layer_at(place, material, 0u);
    let passed = 1.0 - luthier_fresnel_term(cover, min(0.5 * length(wi + wo), 1.0));
    let diffuse_albedo = luthier_materials[luthier_header(material) + $word_patina_diffuse_albedo].xyz;
    return place.patina * passed * diffuse_albedo * (wi.z / LUTHIER_PI);
}
