//? lobes
/// Light from below the first interface as seen from a direction: lobes of slopes between refracted directions, and a wide remainder.
struct LuthierBelow {
    /// Cosine and sine of the azimuth of the eye.
    azimuth: vec2<f32>,
    /// The eye, its cosine that of the refracted direction.
    eye: vec3<f32>,
    /// 1 over the index that refracts, the coefficients of the remainder's shape, and 1 over its integral.
    medium: vec4<f32>,
    //? total_reflection
    /// Squared cotangent of the critical angle; 0 where nothing has a kink there.
    critical_cot_sq: f32,
    //? end
    /// Energy of the remainder, RGB.
    wide: vec3<f32>,
    //? one_lobe|two_lobes
    /// Energy of the first lobe over its share above the horizon, RGB.
    first_strength: vec3<f32>,
    /// Its middle, its sharpness along the plane of the eye and across it, and its decay.
    first_shape: vec4<f32>,
    //? end
    //? two_lobes
    /// Energy of the second lobe over its share above the horizon, RGB.
    second_strength: vec3<f32>,
    /// Its middle, its sharpness along the plane of the eye and across it, and its decay.
    second_shape: vec4<f32>,
    //? end
}

//? total_reflection
/// Cosine of a refracted direction; 0 where it would be totally reflected.
fn luthier_critical_cosine(critical_cot_sq: f32, cos_theta: f32) -> f32 {
    let sin_theta_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
    return sqrt(max(cos_theta * cos_theta - critical_cot_sq * sin_theta_sq, 0.0));
}
//? end

/// Squared cosine of the direction refracted into a medium, from 1 over its index: without cancellation for an index of 1, and not 0.
fn luthier_inside_cos_sq(inverse: f32, cos_theta: f32) -> f32 {
    let inverse_sq = inverse * inverse;
    return max(inverse_sq * (cos_theta * cos_theta) + (1.0 - inverse_sq), 1e-12);
}

/// The light from below the first interface of a material as seen from wo: what can be kept for all lights.
fn luthier_see_below(material: u32, wo: vec3<f32>) -> LuthierBelow {
    let header = luthier_header(material);
    let tile = luthier_materials[header].w;
    let sin_theta_sq = dot(wo.xy, wo.xy);
    let inverse_sin = inverseSqrt(max(sin_theta_sq, 1e-30));
    let sin_theta = sin_theta_sq * inverse_sin;
    var below: LuthierBelow;
    below.medium = luthier_materials[header + $word_veil];
    below.azimuth = select(vec2<f32>(1.0, 0.0), wo.xy * inverse_sin, sin_theta_sq > 1e-30);
    let inverse = below.medium.x;
    below.eye = vec3<f32>(wo.xy, sqrt(luthier_inside_cos_sq(inverse, wo.z)));
    //? total_reflection
    below.critical_cot_sq = luthier_materials[header + $word_phong_specular].w;
    let cos_theta = luthier_critical_cosine(below.critical_cot_sq, wo.z);
    //? else
    let cos_theta = wo.z;
    //? end
    below.wide = luthier_lookup_lobes(tile, cos_theta, 0.0).rgb;
    //? one_lobe|two_lobes
    let first = luthier_lookup_lobes(tile, cos_theta, 1.0);
    below.first_strength = first.rgb;
    below.first_shape = vec4<f32>(first.a * sin_theta, luthier_lookup_lobes(tile, cos_theta, 2.0).rgb);
    //? end
    //? two_lobes
    let second = luthier_lookup_lobes(tile, cos_theta, 3.0);
    below.second_strength = second.rgb;
    below.second_shape = vec4<f32>(second.a * sin_theta, luthier_lookup_lobes(tile, cos_theta, 4.0).rgb);
    //? end
    return below;
}

//? one_lobe|two_lobes
/// Density of slopes of a lobe: z / pi (1 + q)^-(1 + z) with its decay z, q being the squared distance from the middle times the sharpness;
/// Student's, from GGX at 1 to Gaussians.
fn luthier_slope_density(shape: vec4<f32>, slope: vec2<f32>) -> f32 {
    let apart = vec2<f32>(slope.x - shape.x, slope.y) * shape.yz;
    let falloff = (1.0 + shape.w) * log2(1.0 + dot(apart, apart));
    return exp2(-falloff) * (shape.y * shape.z * shape.w / LUTHIER_PI);
}
//? end

/// f cos_theta_i of the light from below for light from wi, above the horizon.
fn luthier_below(below: LuthierBelow, wi: vec3<f32>) -> vec3<f32> {
    //? one_lobe|two_lobes
    // The half vector between refracted directions, in the plane of the eye.
    let inverse = below.medium.x;
    let sum = inverse * (wi.xy + below.eye.xy);
    let across = vec2<f32>(dot(below.azimuth, sum), below.azimuth.x * sum.y - below.azimuth.y * sum.x);
    let cos_theta_t_sq = luthier_inside_cos_sq(inverse, wi.z);
    let inverse_cos = inverseSqrt(cos_theta_t_sq);
    let z = cos_theta_t_sq * inverse_cos + below.eye.z;
    let inverse_z = 1.0 / z;
    let slope = across * inverse_z;
    // From densities of slopes to densities of solid angle outside.
    let solid = inverse_cos * wi.z * (0.5 * inverse * inverse);
    let factor = (dot(across, across) + z * z) * (inverse_z * inverse_z * inverse_z) * solid;
    //? end
    //? total_reflection
    let away = 1.0 - luthier_critical_cosine(below.critical_cot_sq, wi.z);
    //? else
    let away = 1.0 - wi.z;
    //? end
    let away_sq = away * away;
    let medium = below.medium;
    let wide = max(1.0 - medium.y * (away_sq * away_sq * away) - medium.z * away_sq, 0.0);
    var value = below.wide * (wide * wi.z * medium.w);
    //? one_lobe|two_lobes
    value += below.first_strength * (luthier_slope_density(below.first_shape, slope) * factor);
    //? end
    //? two_lobes
    value += below.second_strength * (luthier_slope_density(below.second_shape, slope) * factor);
    //? end
    return value;
}

//? end
/// f cos_theta_i of the first interface, one bounce, and of the simulated light from below it.
fn luthier_eval_lobes($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    //? anisotropic
    var layer = luthier_layer(material, 0u);
    layer.alpha_xy = vec2<f32>(layer.alpha);
    //? else
    let layer = luthier_layer(material, 0u);
    //? end
    //? lobes
    //? lobes_diffuse
    if layer.kind == LUTHIER_DIFFUSE {
        return wi.z * $diffuse(layer, wi, wo);
    }
    //? end
    let lobe = luthier_smith_lobe(layer, wi, wo);
    let first = luthier_fresnel_term(layer, lobe.cos_theta_d) * lobe.value;
    return first + luthier_below(luthier_see_below(material, wo), wi);
    //? else
    return wi.z * $diffuse(layer, wi, wo);
    //? end
}
