/// Half the density of slopes of a lobe: its peak times (1 + q)^-(1 + z) with its decay z, q being the squared distance from the middle times the
/// sharpness; Student's, from GGX at 1 to Gaussians.
fn luthier_half_slope_density(shape: LuthierLobeShape, slope: vec2<f32>) -> f32 {
    //? lobes_axes
    let apart = shape.sharpness * slope + shape.shear * slope.yx - shape.middle;
    //? else
    //? lobes_tilted
    let apart = shape.sharpness * slope - shape.middle;
    //? else
    let apart = vec2<f32>(slope.x * shape.sharpness.x - shape.middle, slope.y * shape.sharpness.y);
    //? !lobes_family|~lobes_family|lobes_tails
    {
        let falloff = (1.0 + shape.decay) * log2(1.0 + dot(apart, apart));
        return exp2(-falloff) * shape.peak;
    }
    //? else
    {
        // All tails are those of GGX.
        let falloff = 1.0 / (1.0 + dot(apart, apart));
        return falloff * falloff * shape.peak;
    }
}

/// The half vector with light from wi between refracted directions: its slopes in the frame of the lobes, and the factor from half
/// densities of slopes to densities of solid angle outside.
fn luthier_place_below(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> vec3<f32> {
    //? !lobes_family|~lobes_family|lobes_tails
    {
        // Directions inside times the index.
        let sum = wi.xy + prepared.wo.xy;
        let across = luthier_in_frame(prepared.azimuth, sum);
        let inside_cos_sq = luthier_inside_cos_sq(prepared.medium, wi.z);
        let inverse_cos = inverseSqrt(inside_cos_sq);
        let z = inside_cos_sq * inverse_cos + prepared.inside_cos;
        let inverse_z = 1.0 / z;
        let factor = (dot(sum, sum) + z * z) * (inverse_z * inverse_z * inverse_z) * (inverse_cos * wi.z);
        return vec3<f32>(across * inverse_z, factor);
    }
    //? else
    {
        let sum = luthier_sum_below(prepared, wi);
        let inverse_z = 1.0 / sum.z;
        let inverse_sq = inverse_z * inverse_z;
        return vec3<f32>(sum.xy * inverse_z, sum.w * inverse_sq * inverse_sq);
    }
}

/// The sum of refracted directions times the index, in the frame of the lobes, and the factor of `luthier_place_below` times its z to the fourth.
fn luthier_sum_below(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> vec4<f32> {
    let sum = wi.xy + prepared.wo.xy;
    let inside_cos_sq = luthier_inside_cos_sq(prepared.medium, wi.z);
    let inverse_cos = inverseSqrt(inside_cos_sq);
    let z = inside_cos_sq * inverse_cos + prepared.inside_cos;
    let factor = (dot(sum, sum) + z * z) * z * (inverse_cos * wi.z);
    return vec4<f32>(luthier_in_frame(prepared.azimuth, sum), z, factor);
}

/// Density in solid angle of a lobe with the tail of GGX, at a sum of `luthier_sum_below`: `luthier_half_slope_density` of its slope without that quotient.
fn luthier_density_below(shape: LuthierLobeShape, sum: vec4<f32>) -> f32 {
    //? lobes_axes
    let apart = shape.sharpness * sum.xy + shape.shear * sum.yx - shape.middle * sum.z;
    //? else
    //? lobes_tilted
    let apart = shape.sharpness * sum.xy - shape.middle * sum.z;
    //? else
    let apart = vec2<f32>(sum.x * shape.sharpness.x - sum.z * shape.middle, sum.y * shape.sharpness.y);
    let falloff = 1.0 / (sum.z * sum.z + dot(apart, apart));
    return falloff * falloff * shape.peak * sum.w;
}

/// f cos_theta_i of the layer that is bare where the first is not, without lobes; `sum` is that of the directions.
fn luthier_light_bare(prepared: LuthierPreparedLobes, wi: vec3<f32>, sum: vec3<f32>, cos_theta_d: f32) -> vec3<f32> {
    let layer = prepared.bare;
    //? lobes_bare_base
    if layer.kind == LUTHIER_DIFFUSE {
        return wi.z * $diffuse(layer, wi, prepared.wo);
    }
    let masking = prepared.bare_masking + luthier_slope_lambda(layer, luthier_coat_across_sq(layer, wi), wi.z);
    let facets = luthier_quarter_density(layer, sum) / (masking * prepared.wo.z);
    return luthier_fresnel_term(layer, cos_theta_d) * facets;
}

/// The material with the facets of the bare layer in place of those of the first interface.
fn luthier_bare_lobes(prepared: LuthierPreparedLobes) -> LuthierPreparedLobes {
    var bare = prepared;
    bare.coat = prepared.bare;
    bare.masking = prepared.bare_masking;
    return bare;
}

/// Energy that the facets of the bare layer send to the eye, the mean of the channels: rows of isotropic stacks have it beside the albedo.
fn luthier_bare_energy(prepared: LuthierPreparedLobes) -> f32 {
    if prepared.cover >= 1.0 {
        return 0.0;
    }
    return max(luthier_lookup_lobes(prepared.row.x, prepared.row.y, LUTHIER_LOBES_ALBEDO).a, 0.0);
}

/// Shape of the remainder: its radiance towards a cosine, over that along the normal.
fn luthier_wide_shape(prepared: LuthierPreparedLobes, cos_theta: f32) -> f32 {
    //? critical_view
    let away = 1.0 - luthier_inside_cosine(prepared.inside, cos_theta);
    //? else
    let away = 1.0 - cos_theta;
    let away_sq = away * away;
    return max(1.0 - prepared.medium.y * (away_sq * away_sq * away) - prepared.medium.z * away_sq, 0.0);
}

//? lobes_curve
/// Reflectance of a first interface at the cosine of a facet, as a polynomial of the cube of 1 less the cosine.
fn luthier_curve_reflectance(numbers: vec4<f32>, cos_theta_d: f32) -> f32 {
    let away = 1.0 - cos_theta_d;
    let cube = away * away * away;
    return numbers.x + cube * (numbers.y + cube * (numbers.z + cube * numbers.w));
}

/// Reflectance of the first interface at the cosine of a facet.
fn luthier_first_reflectance(prepared: LuthierPreparedLobes, cos_theta_d: f32) -> vec3<f32> {
    //? ~lobes_curve
    if prepared.is_curved {
        return vec3<f32>(luthier_curve_reflectance(prepared.reflectance, cos_theta_d));
    }
    //? lobes_curve, !~lobes_curve
    return vec3<f32>(luthier_curve_reflectance(prepared.reflectance, cos_theta_d));
    //? else
    return luthier_fresnel_term(prepared.coat, cos_theta_d);
}

//? lobes_curve
/// f cos_theta_i of one facet of the first interface, which is isotropic and reflects by a polynomial: `sum` is that of the directions, and `across_sq` its squared part along the
/// surface.
fn luthier_light_curved(prepared: LuthierPreparedLobes, wi: vec3<f32>, sum: vec3<f32>, across_sq: f32) -> f32 {
    let wo = prepared.wo;
    //? beckmann|free_slopes
    {
        let masking = prepared.masking + luthier_slope_lambda(prepared.coat, luthier_coat_across_sq(prepared.coat, wi), wi.z);
        let facets = luthier_quarter_density(prepared.coat, sum) / (masking * wo.z);
    }
    //? else
    {
        // Of GGX 1 + 2 Lambda is a root over the cosine.
        let roots = prepared.coat_roots;
        let masking = wi.z / (sqrt(roots.x + wi.z * wi.z * roots.y) * roots.w + wi.z * roots.z);
        let facets = luthier_distribution_term(prepared.coat, 1.0, sum.z * sum.z, across_sq) * masking;
    }
    // For unit directions the cosine is half the length of their sum.
    return luthier_curve_reflectance(prepared.reflectance, 0.5 * length(sum)) * facets;
}

//? lobes_short, !~lobes_short
/// f cos_theta_i of a prepared material with a short lobe for light from wi, above the horizon.
fn luthier_light_lobes(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> vec3<f32> {
    let wo = prepared.wo;
    let sum = vec3<f32>(wi.xy + wo.xy, max(wi.z + wo.z, 1e-16));
    let across_sq = dot(sum.xy, sum.xy);
    let first = luthier_light_curved(prepared, wi, sum, across_sq);
    //? lobes_tilted
    let lobe = luthier_density_below(prepared.first_shape, luthier_sum_below(prepared, wi));
    //? else
    {
        // The sum of refracted directions times the index has the same coordinates along the surface. 1 and the squared distance from the middle of the lobe, times its
        // squared z, are a quadratic form of it.
        let inside_cos_sq = wi.z * wi.z + prepared.medium.x;
        let inverse_cos = inverseSqrt(inside_cos_sq);
        let z = inside_cos_sq * inverse_cos + prepared.inside_cos;
        let along = dot(prepared.azimuth, sum.xy);
        let form = prepared.form;
        let falloff = 1.0 / (across_sq * form.x + z * z * form.y + along * (along * form.z + z * form.w));
        let factor = (across_sq + z * z) * z * (inverse_cos * wi.z);
        let lobe = falloff * falloff * factor * prepared.first_shape.peak;
    }
    return prepared.first_strength * lobe + first;
}

//? !lobes_short|~lobes_short
/// f cos_theta_i of a prepared material for light from wi, above the horizon.
fn luthier_light_lobes(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> vec3<f32> {
    let wo = prepared.wo;
    let sum = vec3<f32>(wi.xy + wo.xy, max(wi.z + wo.z, 1e-16));
    // One facet of the first interface.
    //? lobes_curve, !~lobes_curve
    var value = vec3<f32>(luthier_light_curved(prepared, wi, sum, dot(sum.xy, sum.xy)));
    //? else
    {
        // For unit directions cos_theta_d is half the length of their sum, which does not cancel at grazing angles.
        let masking = prepared.masking + luthier_slope_lambda(prepared.coat, luthier_coat_across_sq(prepared.coat, wi), wi.z);
        let facets = luthier_quarter_density(prepared.coat, sum) / (masking * wo.z);
        let cos_theta_d = min(0.5 * length(sum), 1.0);
        //? ~lobes_curve
        var value = luthier_first_reflectance(prepared, cos_theta_d) * facets;
        //? else
        var value = luthier_fresnel_term(prepared.coat, cos_theta_d) * facets;
    }
    //? lobes_patina
    if prepared.cover < 1.0 {
        value = mix(luthier_light_bare(prepared, wi, sum, cos_theta_d), value, prepared.cover);
    }
    let wide = luthier_wide_shape(prepared, wi.z) * wi.z * prepared.medium.w;
    //? lobes_bare_base
    value += (prepared.wide - prepared.base) * wide;
    //? else
    value += prepared.wide * wide;
    //? lobes_lean
    {
        let eta = prepared.coat.eta;
        let along = dot(prepared.lean, wi.xy) * inverseSqrt(max(eta * eta - dot(wi.xy, wi.xy), 1e-6));
        value += max(prepared.leaning * along, -prepared.wide) * wide;
    }
    //? one_lobe|two_lobes
    {
        //? lobes_mixed
        if prepared.first_shape.peak == 0.0 {
            return value;
        }
        //? !lobes_family|~lobes_family|lobes_tails
        {
            let place = luthier_place_below(prepared, wi);
            value += prepared.first_strength * (luthier_half_slope_density(prepared.first_shape, place.xy) * place.z);
        }
        //? else
        {
            let sum_below = luthier_sum_below(prepared, wi);
            value += prepared.first_strength * luthier_density_below(prepared.first_shape, sum_below);
        }
    }
    //? lobes_mixed, two_lobes
    if prepared.second_shape.peak == 0.0 {
        return value;
    }
    //? two_lobes
    //? !lobes_family|~lobes_family|lobes_tails
    value += prepared.second_strength * (luthier_half_slope_density(prepared.second_shape, place.xy) * place.z);
    //? else
    value += prepared.second_strength * luthier_density_below(prepared.second_shape, sum_below);
    //? lobes_mixed, three_lobes
    if prepared.third_shape.peak == 0.0 {
        return value;
    }
    //? three_lobes
    //? !lobes_family|~lobes_family|lobes_tails
    value += prepared.third_strength * (luthier_half_slope_density(prepared.third_shape, place.xy) * place.z);
    //? else
    value += prepared.third_strength * luthier_density_below(prepared.third_shape, sum_below);
    return value;
}

/// Directional albedo of a prepared material, RGB.
fn luthier_albedo_lobes(prepared: LuthierPreparedLobes) -> vec3<f32> {
    //? lobes_family
    var albedo = prepared.albedo;
    //? else
    //? lobes_tints
    var albedo = luthier_lookup_tinted(prepared.row, prepared.tints, LUTHIER_LOBES_ALBEDO).rgb;
    //? else
    //? lobes_tilted
    var albedo = luthier_lookup_lobes(prepared.row.x, prepared.row.y, LUTHIER_LOBES_ALBEDO).rgb;
    //? else
    let albedo = luthier_lookup_lobes(prepared.row.x, prepared.row.y, LUTHIER_LOBES_ALBEDO).rgb;
    //? lobes_tilted
    {
        //? one_lobe|two_lobes
        albedo -= luthier_lost_below(prepared.first_shape, luthier_lobe_below(prepared, 0u).energy);
        //? two_lobes
        albedo -= luthier_lost_below(prepared.second_shape, luthier_lobe_below(prepared, 1u).energy);
        //? three_lobes
        albedo -= luthier_lost_below(prepared.third_shape, luthier_lobe_below(prepared, 2u).energy);
    }
    //? lobes_base, !lobes_family
    //? base_color|lobes_lean
    return albedo + prepared.painted;
    //? else
    return albedo;
    //? else
    return albedo;
}

/// A lobe of a prepared material by number, below `LUTHIER_LOBES`.
struct LuthierBelow {
    /// Energy, RGB.
    energy: vec3<f32>,
    /// Its shape.
    shape: LuthierLobeShape,
}

/// Share of a lobe above the horizon, from that of its row.
fn luthier_share_left(shape: LuthierLobeShape, share: f32) -> f32 {
    //? lobes_tilted
    return share * shape.left / max(shape.gain, 1e-3);
    //? else
    return share;
}

fn luthier_lobe_below(prepared: LuthierPreparedLobes, lobe: u32) -> LuthierBelow {
    //? three_lobes
    if lobe == 2u {
        return LuthierBelow(prepared.third_strength * luthier_share_left(prepared.third_shape, prepared.third_share), prepared.third_shape);
    }
    //? two_lobes
    {
        //? lobes_family
        let shares = prepared.shares;
        //? else
        let shares = luthier_lookup_lobes(prepared.row.x, prepared.row.y, LUTHIER_LOBES_SHARES).yw;
        if lobe == 1u {
            return LuthierBelow(prepared.second_strength * luthier_share_left(prepared.second_shape, shares.y), prepared.second_shape);
        }
        return LuthierBelow(prepared.first_strength * luthier_share_left(prepared.first_shape, shares.x), prepared.first_shape);
    }
    //? else
    {
        //? lobes_family
        let share = prepared.shares.x;
        //? else
        let share = luthier_lookup_lobes(prepared.row.x, prepared.row.y, 2.0).a;
        return LuthierBelow(prepared.first_strength * luthier_share_left(prepared.first_shape, share), prepared.first_shape);
    }
}

/// f cos_theta_i of the first interface, one bounce, and of the simulated light from below it.
fn luthier_eval_lobes($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    //? lobes
    {
        //? lobes_diffuse
        {
            let layer = $layer(material, 0u);
            if layer.kind == LUTHIER_DIFFUSE {
                return wi.z * $diffuse(layer, wi, wo);
            }
        }
        //? lobes_sides
        return luthier_light_sides(luthier_prepare_sides($place_argument material, wo), wi);
        //? else
        return luthier_light_lobes(luthier_prepare_lobes($place_argument material, wo), wi);
    }
    //? else
    {
        let layer = $layer(material, 0u);
        return wi.z * $diffuse(layer, wi, wo);
    }
}
