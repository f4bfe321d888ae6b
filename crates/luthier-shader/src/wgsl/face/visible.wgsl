/// Density of directions mirrored at the visible normals of a GGX surface, seen from wo (Heitz 2018).
fn luthier_visible_density(alpha: vec2<f32>, axis: vec2<f32>, wo: vec3<f32>, wi: vec3<f32>) -> f32 {
    let sum = wi.xy + wo.xy;
    let bisector = vec3<f32>(
        vec2<f32>(axis.x * sum.x + axis.y * sum.y, axis.x * sum.y - axis.y * sum.x) / alpha,
        max(wi.z + wo.z, 1e-16),
    );
    let length_sq = dot(sum, sum) + bisector.z * bisector.z;
    let ratio = length_sq / dot(bisector, bisector);
    let eye = alpha * vec2<f32>(axis.x * wo.x + axis.y * wo.y, axis.x * wo.y - axis.y * wo.x);
    // D / 4 over cos_theta_o (1 + Lambda).
    return ratio * ratio / (2.0 * LUTHIER_PI * alpha.x * alpha.y * (wo.z + sqrt(wo.z * wo.z + dot(eye, eye))));
}

/// A direction mirrored at a visible normal (Dupuy and Benyoub 2023); below the horizon for light that meets the surface again.
fn luthier_draw_visible(alpha: vec2<f32>, axis: vec2<f32>, wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let eye = vec3<f32>(axis.x * wo.x + axis.y * wo.y, axis.x * wo.y - axis.y * wo.x, wo.z);
    let stretched = normalize(vec3<f32>(alpha * eye.xy, eye.z));
    let phi = 2.0 * LUTHIER_PI * u.y;
    let z = (1.0 - u.x) * (1.0 + stretched.z) - stretched.z;
    let cap = vec3<f32>(sqrt(max(1.0 - z * z, 0.0)) * vec2<f32>(cos(phi), sin(phi)), z) + stretched;
    let wh = normalize(vec3<f32>(alpha * cap.xy, max(cap.z, 1e-6)));
    let wi = 2.0 * dot(wh, eye) * wh - eye;
    return vec3<f32>(axis.x * wi.x - axis.y * wi.y, axis.y * wi.x + axis.x * wi.y, wi.z);
}

/// Density of directions mirrored at the visible facets of V-cavities of Blinn's distribution, seen from wo: G1 D / (4 cos_theta_o).
fn luthier_cavity_density(power: f32, wo: vec3<f32>, wi: vec3<f32>) -> f32 {
    let bisector = vec3<f32>(wi.xy + wo.xy, max(wi.z + wo.z, 1e-16));
    let across_sq = dot(bisector.xy, bisector.xy);
    let z_sq = bisector.z * bisector.z;
    let masking = min(4.0 * bisector.z * wo.z / (z_sq + across_sq), 1.0);
    return luthier_blinn(0.5 * power, z_sq, across_sq) * masking * power / (8.0 * LUTHIER_PI * wo.z);
}

/// A direction mirrored at a visible facet of V-cavities (Heitz and d'Eon 2014, section 4): a facet is drawn by the power of its cosine, and it or
/// the other side of its cavity is seen, by the areas that they show.
fn luthier_draw_cavity(power: f32, wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    // The squared sine, 1 - exp(-y) without cancellation.
    let y = -log(1.0 - min(u.x, 0.9999999)) * (2.0 / power);
    let series = y * (1.0 - y * (0.5 - y * (1.0 / 6.0)));
    let sin_sq = select(1.0 - exp(-y), series, y < 0.02);
    let phi = 2.0 * LUTHIER_PI * u.y;
    let facet = vec3<f32>(sqrt(sin_sq) * vec2<f32>(cos(phi), sin(phi)), sqrt(max(1.0 - sin_sq, 1e-12)));
    let seen = max(vec2<f32>(dot(facet, wo), facet.z * wo.z - dot(facet.xy, wo.xy)), vec2<f32>(0.0));
    // The last digits of the number are independent of the azimuth.
    let is_other = fract(4096.0 * u.y) * (seen.x + seen.y) >= seen.x;
    let wh = select(facet, vec3<f32>(-facet.xy, facet.z), is_other);
    return 2.0 * dot(wh, wo) * wh - wo;
}
