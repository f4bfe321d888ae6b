/// Light that one lobe of a material reflects to the eye, as an estimate: directions are drawn from such parts.
struct LuthierPart {
    /// Energy, RGB.
    energy: vec3<f32>,
    /// Slope parameters along an axis and across it, for visible normals of GGX.
    alpha: vec2<f32>,
    /// Cosine and sine of the angle from the tangent to that axis.
    axis: vec2<f32>,
    /// Exponent plus 2 of Blinn's facets in V-cavities; 0 for visible normals of GGX.
    cavity_power: f32,
    /// Exponent of the cosine to the mirrored direction; below 0 for visible normals.
    exponent: f32,
    /// Index of the medium that it is in over that outside.
    eta: f32,
    /// Cosine, there, of the edge of the cone of directions that leave.
    edge: f32,
    /// Normal of what lies in that medium, in the frame above it, and the index of the medium there over that of this one.
    normal: vec3<f32>,
    inner_eta: f32,
}

/// A part without energy.
fn luthier_no_part() -> LuthierPart {
    var part: LuthierPart;
    part.alpha = vec2<f32>(1.0);
    part.axis = vec2<f32>(1.0, 0.0);
    part.exponent = -1.0;
    part.cavity_power = 0.0;
    part.eta = 1.0;
    part.edge = 0.0;
    part.normal = vec3<f32>(0.0, 0.0, 1.0);
    part.inner_eta = 1.0;
    return part;
}

/// Exponent plus 2, 2 / alpha^2, of a layer whose distribution is Blinn's; 0 of another layer.
fn luthier_cavity_power(layer: LuthierLayer) -> f32 {
    //? several_slopes
    return select(0.0, 2.0 * layer.falloff, abs(layer.distribution - 2.0) < 0.5);
    //? else
    return 2.0 * layer.falloff;
}

/// A material as seen from a direction: what can be kept for all lights.
struct LuthierPrepared {
    /// The material.
    material: u32,
    /// The number of its model.
    model: u32,
    /// Whether the eye is above the horizon.
    open: bool,
    /// The place of the surface.
    place: LuthierPlace,
    /// The eye in the frame of the place.
    wo: vec3<f32>,
    /// Light that diffuse bases reflect to the eye, as an estimate, RGB.
    wide: vec3<f32>,
    /// The lobes, from the top; those that the material lacks have no energy.
    parts: array<LuthierPart, $parts>,
    /// Number of the layer that is a diffuse base below others; 0 for none.
    base: u32,
    /// Share that comes up from it to the eye, RGB.
    base_share: vec3<f32>,
    /// Cosine of the eye there.
    base_cos: f32,
    /// Index there over that outside.
    base_eta: f32,
    /// A material of the model `lobes` as seen from the eye.
    lobes: $prepared_lobes,
}

/// A direction that stands for light from everywhere: at the mean cosine, 2/3, across the plane of the eye.
fn luthier_mean_light(wo: vec3<f32>) -> vec3<f32> {
    let across = vec2<f32>(-wo.y, wo.x + 1e-15);
    return vec3<f32>(across * (0.745355992 * inverseSqrt(dot(across, across))), 0.666666667);
}
