/// Level of `luthier_environment_map` that is blurred by a width in radians. Levels have widths 0, 8 / size, and then twice that of the one before, up
/// to 1; between two of them the square of the width is linear, so that what is read has the width's second moment.
fn luthier_environment_level(width: f32) -> f32 {
    let size = f32(textureDimensions(luthier_environment_map).x);
    let relative = 0.125 * size * width;
    if relative <= 1.0 {
        return relative * relative;
    }
    let whole = floor(min(log2(relative), log2(size) - 3.001));
    let above = relative * exp2(-whole);
    return min(whole + 1.0 + (above * above - 1.0) / 3.0, log2(size) - 2.0);
}

/// Radiance around a direction of the world, blurred by a width in radians.
fn luthier_environment_around(direction: vec3<f32>, width: f32) -> vec3<f32> {
    let level = luthier_environment_level(width);
    return textureSampleLevel(luthier_environment_map, luthier_environment_sampler, direction, level).rgb;
}

/// Level of `luthier_environment_map` between two levels that together are nearest to one lobe of a width in radians, by least squares. They are about a
/// tenth off; with the second moment of the width they would be up to a third, too bright in the middle. The map itself counts as blurred by its texels.
fn luthier_environment_level_alone(width: f32) -> f32 {
    let size = f32(textureDimensions(luthier_environment_map).x);
    let relative = 0.125 * size * width;
    let relative_sq = relative * relative;
    if relative <= 1.0 {
        return saturate((65.0 / 63.0) * (relative_sq - 0.015625) / (relative_sq + 0.015625));
    }
    let whole = floor(min(log2(relative), log2(size) - 3.001));
    let above_sq = relative_sq * exp2(-2.0 * whole);
    return min(whole + 1.0 + (4.0 / 3.0) * (1.0 - 10.0 / ((1.0 + above_sq) * (4.0 + above_sq))), log2(size) - 2.0);
}

/// Radiance around a direction of the world in a lobe of a width in radians, where no reads beside this one make up the lobe.
fn luthier_environment_alone(direction: vec3<f32>, width: f32) -> vec3<f32> {
    let level = luthier_environment_level_alone(width);
    return textureSampleLevel(luthier_environment_map, luthier_environment_sampler, direction, level).rgb;
}

/// Irradiance over pi around a normal of the world: the radiance of a white Lambertian patch.
fn luthier_environment_diffuse(normal: vec3<f32>) -> vec3<f32> {
    return textureSampleLevel(luthier_irradiance_map, luthier_environment_sampler, normal, 0.0).rgb;
}
