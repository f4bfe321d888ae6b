/// Share of what a part reflects that leaves the surface, as an estimate: its distribution is cut in four directions, at the facets that mirror
/// the eye along the boundary's critical angle or the horizon. Exact for GGX without masking, seen along the normal.
fn luthier_leaving_share(part: LuthierPart, wo: vec3<f32>) -> f32 {
    //? media
    //? tilted
    let index = part.eta * part.inner_eta;
    //? else
    let index = part.eta;
    //? else
    let index = 1.0;
    // Sines and cosines of the critical angle and of the eye in the medium.
    let sines = vec2<f32>(min(1.0 / index, 1.0), min(length(wo.xy) / index, 1.0));
    let cosines = sqrt(max(1.0 - sines * sines, vec2<f32>(0.0)));
    let products = vec2<f32>(cosines.x * cosines.y, sines.x * sines.y);
    //? powers, visible
    if part.exponent >= 0.0 {
        return luthier_power_share(part, cosines, products);
    }
    //? visible
    return luthier_facet_share(part, sines, cosines, products);
    //? else
    return luthier_power_share(part, cosines, products);
}

/// Share of a power of a cosine that leaves: `products` are those of the cosines and of the sines.
fn luthier_power_share(part: LuthierPart, cosines: vec2<f32>, products: vec2<f32>) -> f32 {
    // Cosines of the angles to the edge: on the side of the mirrored direction, on that of the eye, and across.
    let edges = vec3<f32>(products.x + products.y, products.x - products.y, cosines.x / max(cosines.y, 1e-6));
    let beyond = pow(clamp(edges, vec3<f32>(1e-6), vec3<f32>(1.0)), vec3<f32>(part.exponent + 1.0));
    return 1.0 - 0.25 * (beyond.x + beyond.y + 2.0 * beyond.z);
}

/// Share of mirroring facets that leaves.
fn luthier_facet_share(part: LuthierPart, sines: vec2<f32>, cosines: vec2<f32>, products: vec2<f32>) -> f32 {
    let edges = vec2<f32>(
        max(sines.x * cosines.y - cosines.x * sines.y, 0.0) / (1.0 + products.x + products.y),
        (sines.x * cosines.y + cosines.x * sines.y) / max(1.0 + products.x - products.y, 1e-6),
    );
    let slopes_sq = vec3<f32>(edges * edges, edges.x * edges.y);
    //? cavities
    {
        let steep = pow(1.0 + slopes_sq, vec3<f32>(-0.5 * part.cavity_power));
        let within = select(slopes_sq / (slopes_sq + part.alpha.x * part.alpha.y), 1.0 - steep, part.cavity_power > 0.0);
    }
    //? else
    let within = slopes_sq / (slopes_sq + part.alpha.x * part.alpha.y);
    return 0.25 * (within.x + within.y + 2.0 * within.z);
}
