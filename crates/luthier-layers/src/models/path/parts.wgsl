/// The part of an interface, whose energy is that in the mirrored direction. These models spread it over eta^2 the solid angle without
/// dimming it.
fn luthier_path_part(
    path: LuthierPath, layer: LuthierLayer, alpha: vec2<f32>, axis: vec2<f32>, eta: f32, normal: vec3<f32>, inner_eta: f32$least,
) -> LuthierPart {
    var part = luthier_no_part();
    let index = eta * inner_eta;
    //? chain_patina
    let fresnel = layer.tarnish * luthier_fresnel_term(layer, min(path.wo_local.z, 1.0));
    //? else
    let fresnel = luthier_fresnel_term(layer, min(path.wo_local.z, 1.0));
    //? fluorescent
    part.energy = path.throughput * path.lit * fresnel * (index * index);
    //? else
    part.energy = path.throughput * fresnel * (index * index);
    //? inner_cosine
    part.energy *= select(1.0, path.wi_local.z / path.outer_cosine, layer.inner_cosine);
    part.alpha = alpha;
    part.axis = axis;
    //? cavities
    part.cavity_power = luthier_cavity_power(layer);
    part.eta = eta;
    //? folded, media
    // Snell: sines times the index are the least index at most.
    part.edge = sqrt(max((eta - least) * (eta + least), 0.0)) / eta;
    part.normal = normal;
    part.inner_eta = inner_eta;
    return part;
}

/// A part with the light of another one, which has its shape: that of the surface with a film, and of that without.
fn luthier_joined_part(given: LuthierPart, next: LuthierPart) -> LuthierPart {
    var part = next;
    part.energy += given.energy;
    return part;
}

/// A path whose light is mirrored at the layers below.
fn luthier_path_mirrored(path: LuthierPath) -> LuthierPath {
    var next = path;
    next.wi_local = vec3<f32>(-path.wo_local.xy, path.wo_local.z);
    next.across = vec2<f32>(0.0);
    next.open = path.open && path.wo_local.z > 0.0;
    return next;
}
