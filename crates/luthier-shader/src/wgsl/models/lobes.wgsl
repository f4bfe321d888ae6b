//? lobes
/// Lobes from below that rows have.
//? two_lobes
const LUTHIER_LOBES: u32 = 2u;
//? else
//? one_lobe
const LUTHIER_LOBES: u32 = 1u;
//? else
const LUTHIER_LOBES: u32 = 0u;
//? end
//? end
/// The part of rows that is the albedo.
const LUTHIER_LOBES_ALBEDO: f32 = f32(1u + 2u * LUTHIER_LOBES);

/// A material of the model as seen from a direction: what can be kept for all lights.
struct LuthierPreparedLobes {
    /// The first interface.
    coat: LuthierLayer,
    /// The eye.
    wo: vec3<f32>,
    /// Tile of its rows, and the cosine at which they are read.
    row: vec2<f32>,
    /// 1 + Lambda of the eye.
    masking: f32,
    /// Cosine and sine of the azimuth of the eye.
    azimuth: vec2<f32>,
    /// Cosine of the refracted eye times the index.
    inside_cos: f32,
    /// The index squared less 1, the coefficients of the remainder's shape, and 1 over its integral.
    medium: vec4<f32>,
    //? lobes_tilted
    //? one_lobe|two_lobes
    /// Slope by which flakes turn the lobes, along the plane of the eye and across it.
    tilt: vec2<f32>,
    //? end
    //? end
    //? critical_view
    /// Numbers of the cosine inside, see `luthier_inside_cosine`.
    inside: vec4<f32>,
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

/// Smith's Lambda of a slope: that of the direction times the slope parameter (Walter et al. 2007, eq. 34 for GGX). That of Beckmann is a rational
/// function; 1 / (1 + Lambda) is within 5e-5.
fn luthier_slope_lambda(coat: LuthierLayer, slope: f32) -> f32 {
    //? beckmann
    //? ggx
    if coat.distribution > 0.5 {
        return 0.5 * (sqrt(1.0 + slope * slope) - 1.0);
    }
    //? end
    let beyond = max(slope - 0.354768, 0.0);
    let inverse = 1.0 / max(beyond, 1e-9);
    return beyond / (3.5449077 + inverse * (5.04868 + inverse * (3.41329 + inverse * 1.6329)));
    //? else
    return 0.5 * (sqrt(1.0 + slope * slope) - 1.0);
    //? end
}

//? critical_view
/// The cosine of a refracted direction where a medium reflects flat light totally: its kink at the critical angle is rounded off, and it goes
/// from 0 at the horizon to 1 at the normal. The numbers: squared cotangent of the angle, four times the squared width of the kink, factor
/// and offset.
fn luthier_inside_cosine(inside: vec4<f32>, cos_theta: f32) -> f32 {
    let cos_theta_sq = cos_theta * cos_theta;
    let refracted = cos_theta_sq - inside.x * (1.0 - cos_theta_sq);
    let root = sqrt(max(0.5 * (refracted + sqrt(refracted * refracted + inside.y)), 0.0));
    return root * inside.z + inside.w;
}
//? end

/// Squared cosine of a refracted direction times the squared index; not 0.
fn luthier_inside_cos_sq(medium: vec4<f32>, cos_theta: f32) -> f32 {
    return max(cos_theta * cos_theta + medium.x, 1e-12);
}

//? place
//? one_lobe|two_lobes
/// A lobe whose slopes are so many times as steep, and then have twice a variance more.
fn luthier_spread(shape: vec4<f32>, factor: f32, twice_variance: f32) -> vec4<f32> {
    let inverse = 1.0 / factor;
    //? surface
    // Squared widths are 1 / (z x^2).
    let sharper = shape.yz * inverse;
    let wider = sharper * inverseSqrt(1.0 + twice_variance * shape.w * sharper * sharper);
    return vec4<f32>(shape.x * factor, wider, shape.w);
    //? else
    return shape * vec4<f32>(factor, inverse, inverse, 1.0);
    //? end
}
//? end
//? end

/// A material as seen from wo, above the horizon.
fn luthier_prepare_lobes($place_parameter material: u32, wo: vec3<f32>) -> LuthierPreparedLobes {
    let header = luthier_header(material);
    //? place
    // Rows over a factor lie one below the other, at equal distances of its root from 1: to 0 on the slab, to a step before it on slopes.
    let over = luthier_materials[header + $word_phong_diffuse];
    let away = 1.0 - sqrt(saturate(vec2<f32>(place.alpha_factor, place.slab_factor)));
    let tile = luthier_materials[header].w + min(away.x * (over.x + 1.0), over.x) + away.y * over.y;
    let spread = max(place.alpha_factor, over.z);
    //? else
    let tile = luthier_materials[header].w;
    //? end
    // Along the normal the azimuth is 0.
    let across = vec2<f32>(wo.x + 1e-15, wo.y);
    let sin_theta_sq = dot(across, across);
    let inverse_sin = inverseSqrt(sin_theta_sq);
    let sin_theta = sin_theta_sq * inverse_sin;
    var prepared: LuthierPreparedLobes;
    prepared.coat = $layer(material, 0u);
    //? anisotropic
    prepared.coat.alpha_xy = vec2<f32>(prepared.coat.alpha);
    //? end
    prepared.wo = wo;
    prepared.masking = 1.0 + luthier_slope_lambda(prepared.coat, prepared.coat.alpha * sin_theta / wo.z);
    prepared.azimuth = across * inverse_sin;
    prepared.medium = luthier_materials[header + $word_veil];
    prepared.inside_cos = sqrt(luthier_inside_cos_sq(prepared.medium, wo.z));
    //? lobes_tilted
    //? one_lobe|two_lobes
    // Half vectors in the slab are shifted by the slope of the normal, those in another medium as much as the mirror direction is.
    let slab_cos = sqrt(max(prepared.coat.eta * prepared.coat.eta - sin_theta_sq, 0.0));
    let turned = place.flake_normal.xy * (slab_cos / (prepared.inside_cos * max(place.flake_normal.z, 1e-3)));
    prepared.tilt = vec2<f32>(dot(prepared.azimuth, turned), prepared.azimuth.x * turned.y - prepared.azimuth.y * turned.x);
    //? end
    //? end
    //? critical_view
    prepared.inside = luthier_materials[header + $word_phong_specular];
    // Rows are over a mean of it and of the cosine outside.
    let cos_theta = mix(luthier_inside_cosine(prepared.inside, wo.z), wo.z, luthier_materials[header + $word_phong_diffuse].w);
    //? else
    let cos_theta = wo.z;
    //? end
    prepared.row = vec2<f32>(tile, cos_theta);
    prepared.wide = luthier_lookup_lobes(tile, cos_theta, 0.0).rgb;
    //? one_lobe|two_lobes
    //? surface
    // A normal that leans by a slope shifts half vectors by as much of it as directions lean outside over those inside.
    let leaning = wo.z / prepared.inside_cos;
    let unresolved = 2.0 * max(place.slope_variance, 0.0) * leaning * leaning;
    //? else
    //? place
    let unresolved = 0.0;
    //? end
    //? end
    let first = luthier_lookup_lobes(tile, cos_theta, 1.0);
    prepared.first_strength = first.rgb;
    let first_shape = vec4<f32>(first.a * sin_theta, luthier_lookup_lobes(tile, cos_theta, 2.0).rgb);
    //? place
    prepared.first_shape = luthier_spread(first_shape, spread, unresolved);
    //? else
    prepared.first_shape = first_shape;
    //? end
    //? end
    //? two_lobes
    let second = luthier_lookup_lobes(tile, cos_theta, 3.0);
    prepared.second_strength = second.rgb;
    let second_shape = vec4<f32>(second.a * sin_theta, luthier_lookup_lobes(tile, cos_theta, 4.0).rgb);
    //? place
    prepared.second_shape = luthier_spread(second_shape, spread, unresolved);
    //? else
    prepared.second_shape = second_shape;
    //? end
    //? end
    return prepared;
}

//? one_lobe|two_lobes
/// Half the density of slopes of a lobe: z / (2 pi) (1 + q)^-(1 + z) with its decay z, q being the squared distance from the middle times the
/// sharpness; Student's, from GGX at 1 to Gaussians.
fn luthier_half_slope_density(shape: vec4<f32>, slope: vec2<f32>) -> f32 {
    let apart = vec2<f32>(slope.x - shape.x, slope.y) * shape.yz;
    let falloff = (1.0 + shape.w) * log2(1.0 + dot(apart, apart));
    return exp2(-falloff) * (shape.y * shape.z * shape.w * (0.5 / LUTHIER_PI));
}
//? end

//? one_lobe|two_lobes
/// The half vector with light from wi between refracted directions: its slopes in the plane of the eye and across it, against the tilt, and the factor from half
/// densities of slopes to densities of solid angle outside.
fn luthier_place_below(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> vec3<f32> {
    // Directions inside times the index.
    let sum = wi.xy + prepared.wo.xy;
    let across = vec2<f32>(dot(prepared.azimuth, sum), prepared.azimuth.x * sum.y - prepared.azimuth.y * sum.x);
    let inside_cos_sq = luthier_inside_cos_sq(prepared.medium, wi.z);
    let inverse_cos = inverseSqrt(inside_cos_sq);
    let z = inside_cos_sq * inverse_cos + prepared.inside_cos;
    let inverse_z = 1.0 / z;
    let factor = (dot(sum, sum) + z * z) * (inverse_z * inverse_z * inverse_z) * (inverse_cos * wi.z);
    //? lobes_tilted
    return vec3<f32>(across * inverse_z - prepared.tilt, factor);
    //? else
    return vec3<f32>(across * inverse_z, factor);
    //? end
}
//? end

/// f cos_theta_i of a prepared material for light from wi, above the horizon.
fn luthier_light_lobes(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> vec3<f32> {
    let wo = prepared.wo;
    let sum = vec3<f32>(wi.xy + wo.xy, max(wi.z + wo.z, 1e-16));
    // One facet of the first interface. For unit directions cos_theta_d is half the length of their sum, which does not cancel at grazing angles.
    let slope_i = prepared.coat.alpha * sqrt(dot(wi.xy, wi.xy)) / wi.z;
    let masking = prepared.masking + luthier_slope_lambda(prepared.coat, slope_i);
    let facets = luthier_quarter_density(prepared.coat, sum) / (masking * wo.z);
    let cos_theta_d = min(0.5 * length(sum), 1.0);
    var value = luthier_fresnel_term(prepared.coat, cos_theta_d) * facets;
    let medium = prepared.medium;
    // The wide remainder.
    //? critical_view
    let away = 1.0 - luthier_inside_cosine(prepared.inside, wi.z);
    //? else
    let away = 1.0 - wi.z;
    //? end
    let away_sq = away * away;
    let wide = max(1.0 - medium.y * (away_sq * away_sq * away) - medium.z * away_sq, 0.0);
    value += prepared.wide * (wide * wi.z * medium.w);
    //? one_lobe|two_lobes
    let place = luthier_place_below(prepared, wi);
    value += prepared.first_strength * (luthier_half_slope_density(prepared.first_shape, place.xy) * place.z);
    //? end
    //? two_lobes
    value += prepared.second_strength * (luthier_half_slope_density(prepared.second_shape, place.xy) * place.z);
    //? end
    return value;
}

/// Directional albedo of a prepared material, RGB.
fn luthier_albedo_lobes(prepared: LuthierPreparedLobes) -> vec3<f32> {
    return luthier_lookup_lobes(prepared.row.x, prepared.row.y, LUTHIER_LOBES_ALBEDO).rgb;
}

/// A lobe of a prepared material by number, below `LUTHIER_LOBES`.
struct LuthierBelow {
    /// Energy, RGB.
    energy: vec3<f32>,
    /// Its middle, its sharpness along the plane of the eye and across it, and its decay.
    shape: vec4<f32>,
}

fn luthier_lobe_below(prepared: LuthierPreparedLobes, lobe: u32) -> LuthierBelow {
    //? two_lobes
    if lobe == 1u {
        let share = luthier_lookup_lobes(prepared.row.x, prepared.row.y, 4.0).a;
        return LuthierBelow(prepared.second_strength * share, prepared.second_shape);
    }
    //? end
    //? one_lobe|two_lobes
    let share = luthier_lookup_lobes(prepared.row.x, prepared.row.y, 2.0).a;
    return LuthierBelow(prepared.first_strength * share, prepared.first_shape);
    //? else
    return LuthierBelow(vec3<f32>(0.0), vec4<f32>(0.0, 1.0, 1.0, 1.0));
    //? end
}

//? end
/// f cos_theta_i of the first interface, one bounce, and of the simulated light from below it.
fn luthier_eval_lobes($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    //? lobes
    //? lobes_diffuse
    let layer = luthier_layer(material, 0u);
    if layer.kind == LUTHIER_DIFFUSE {
        return wi.z * $diffuse(layer, wi, wo);
    }
    //? end
    return luthier_light_lobes(luthier_prepare_lobes($place_argument material, wo), wi);
    //? else
    let layer = luthier_layer(material, 0u);
    return wi.z * $diffuse(layer, wi, wo);
    //? end
}
