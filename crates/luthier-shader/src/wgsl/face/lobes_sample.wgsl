/// Probabilities of the first facet, of the lobes and of the wide remainder, times their sum.
fn luthier_chances_lobes(prepared: LuthierPreparedLobes) -> vec4<f32> {
    let third = vec3<f32>(1.0 / 3.0);
    let wide = dot(prepared.wide, third);
    var rest = dot(luthier_albedo_lobes(prepared), third) - wide;
    // A material that reflects nothing has a remainder without light.
    let least = vec4<f32>(0.0, 0.0, 0.0, 1e-6);
    //? one_lobe|two_lobes
    rest -= dot(luthier_lobe_below(prepared, 0u).energy, third);
    let first = dot(prepared.first_strength, third);
    //? two_lobes
    rest -= dot(luthier_lobe_below(prepared, 1u).energy, third);
    return max(vec4<f32>(rest, first, dot(prepared.second_strength, third), wide), least);
    //? else
    return max(vec4<f32>(rest, first, 0.0, wide), least);
    //? end
    //? else
    return max(vec4<f32>(rest, 0.0, 0.0, wide), least);
    //? end
}

/// Density of directions mirrored at the visible normals of the first interface, as GGX has them for its slope parameter whatever its
/// distribution is. Beckmann's facets have weights up to 2 then, and up to 2.6 for an eye within 20 degrees of the horizon.
fn luthier_facet_density(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> f32 {
    return luthier_visible_density(vec2<f32>(prepared.coat.alpha), vec2<f32>(1.0, 0.0), prepared.wo, wi);
}

//? one_lobe|two_lobes
/// Density in solid angle of light that a lobe sends to the eye.
fn luthier_lobe_density(prepared: LuthierPreparedLobes, shape: vec4<f32>, wi: vec3<f32>) -> f32 {
    let place = luthier_place_below(prepared, wi);
    return luthier_half_slope_density(shape, place.xy) * place.z;
}

/// A direction whose half vector has a slope that a lobe draws; below the horizon where light does not leave there.
fn luthier_sample_lobe(prepared: LuthierPreparedLobes, shape: vec4<f32>, u: vec2<f32>) -> vec3<f32> {
    // Of y, the tail times the logarithm of the share beyond, exp(y) - 1 without cancellation.
    let y = -log(1.0 - min(u.x, 0.9999999)) / shape.w;
    let series = y * (1.0 + y * (0.5 + y * (1.0 / 6.0)));
    let radius = sqrt(select(exp(y) - 1.0, series, y < 0.02));
    let phi = 2.0 * LUTHIER_PI * u.y;
    //? lobes_tilted
    let middle = vec2<f32>(shape.x, 0.0) + prepared.tilt;
    //? else
    let middle = vec2<f32>(shape.x, 0.0);
    //? end
    let wh = normalize(vec3<f32>(middle + radius * vec2<f32>(cos(phi), sin(phi)) / shape.yz, 1.0));
    // Directions inside times the index, in the plane of the eye.
    let eye = vec3<f32>(dot(prepared.azimuth, prepared.wo.xy), 0.0, prepared.inside_cos);
    let inside = 2.0 * dot(wh, eye) * wh - eye;
    let cos_sq = 1.0 - dot(inside.xy, inside.xy);
    let leaves = inside.z > 0.0 && cos_sq > 0.0;
    let turn = prepared.azimuth;
    let across = vec2<f32>(turn.x * inside.x - turn.y * inside.y, turn.y * inside.x + turn.x * inside.y);
    return vec3<f32>(across, select(-1.0, sqrt(max(cos_sq, 0.0)), leaves));
}

//? end
/// Density in solid angle with which `luthier_draw_lobes` draws a direction above the horizon.
fn luthier_density_lobes(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> f32 {
    let chances = luthier_chances_lobes(prepared);
    var density = chances.x * luthier_facet_density(prepared, wi) + chances.w * (wi.z / LUTHIER_PI);
    //? one_lobe|two_lobes
    density += chances.y * luthier_lobe_density(prepared, prepared.first_shape, wi);
    //? end
    //? two_lobes
    density += chances.z * luthier_lobe_density(prepared, prepared.second_shape, wi);
    //? end
    return density / dot(chances, vec4<f32>(1.0));
}

/// Direction and part of a draw, without its density and weight: 0 the first facet, 1 and 2 the lobes, 3 the wide remainder.
fn luthier_draw_lobes(prepared: LuthierPreparedLobes, u: vec3<f32>) -> LuthierSample {
    let chances = luthier_chances_lobes(prepared);
    let choice = u.x * dot(chances, vec4<f32>(1.0));
    let phi = 2.0 * LUTHIER_PI * u.z;
    var drawn = LuthierSample(vec3<f32>(sqrt(u.y) * vec2<f32>(cos(phi), sin(phi)), sqrt(1.0 - u.y)), 0.0, vec3<f32>(0.0), 3u);
    if choice < chances.x {
        drawn.wi = luthier_draw_visible(vec2<f32>(prepared.coat.alpha), vec2<f32>(1.0, 0.0), prepared.wo, u.yz);
        drawn.part = 0u;
    }
    //? one_lobe|two_lobes
    let first = chances.x + chances.y;
    if choice >= chances.x && choice < first {
        drawn.wi = luthier_sample_lobe(prepared, prepared.first_shape, u.yz);
        drawn.part = 1u;
    }
    //? end
    //? two_lobes
    if choice >= first && choice < first + chances.z {
        drawn.wi = luthier_sample_lobe(prepared, prepared.second_shape, u.yz);
        drawn.part = 2u;
    }
    //? end
    return drawn;
}
