/// f cos_theta_i of one lobe about the mirror direction over one diffuse term (Phong 1975, the lobe scaled so that a whole one
/// carries the specular coefficient).
fn luthier_eval_phong($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let header = luthier_header(material);
    let diffuse = luthier_materials[header + $word_phong_diffuse];
    let specular = luthier_materials[header + $word_phong_specular].rgb;
    //? place
    // The exponent is (1/alpha^2 - 1) / 2.
    let exponent = max((diffuse.w + 0.5) / (place.alpha_factor * place.alpha_factor) - 0.5, 0.0);
    //? else
    let exponent = diffuse.w;
    // 1 minus the cosine to the mirror direction is half a squared distance: no cancellation in narrow lobes.
    let apart = vec3<f32>(wi.xy + wo.xy, wi.z - wo.z);
    let lobe = luthier_power_lobe(0.5 * dot(apart, apart), exponent);
    return diffuse.rgb * (wi.z / LUTHIER_PI) + specular * ((exponent + 1.0) * lobe / (2.0 * LUTHIER_PI));
}
