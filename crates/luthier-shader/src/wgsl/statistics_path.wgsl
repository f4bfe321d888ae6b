/// Light on its way down from the exterior, 0, to the medium above the next layer, i: energies, and spreads of directions (Belcour
/// 2018, sec. 4 and 5).
struct $Path {
    /// Cosine of the mean direction in i.
    cos_theta: f32,
    /// The same in the medium above i. //? escape
    cos_above: f32, //? escape
    /// Index of i over that of 0. //? statistics_base
    eta: f32, //? statistics_base
    /// Share that comes down from 0 to i. //? below|statistics_base
    t0i: vec3<f32>, //? below|statistics_base
    /// Share that goes up from i to 0. //? below
    ti0: vec3<f32>, //? below
    /// Share that comes back to i from above. //? below
    ri0: vec3<f32>, //? below
    /// Spreads of the three. //? below
    spread_t0i: $spread, //? below
    spread_ti0: $spread, //? below
    spread_ri0: $spread, //? below
    /// By how much spreads in i grow on the way to 0. //? below
    jacobian: f32, //? below
    /// Transmittance of the slab that is i. //? absorption, escape
    slab: vec3<f32>, //? absorption, escape
    /// Tile of the escape table for lobes in i; -1 where all escapes. //? escape
    escape_tile: f32, //? escape
    /// Energy that left the last interface to 0.
    lobe: vec3<f32>,
    /// Its spread.
    lobe_spread: $spread,
    /// Whether any light reaches the next layer.
    open: bool,
}

/// Light at a cosine above the first interface.
fn $start(cos_theta: f32) -> $Path {
    var path: $Path;
    path.cos_theta = clamp(cos_theta, 0.00001, 1.0);
    path.cos_above = path.cos_theta; //? escape
    path.eta = 1.0; //? statistics_base
    path.t0i = vec3<f32>(1.0); //? below|statistics_base
    path.ti0 = vec3<f32>(1.0); //? below
    path.jacobian = 1.0; //? below
    path.slab = vec3<f32>(1.0); //? absorption, escape
    path.escape_tile = -1.0; //? escape
    path.open = true;
    return path;
}

/// Adds an interface below: its lobe, and what goes on below it.
fn $add(path: $Path, layer: LuthierLayer) -> $Path {
    var next = path;
    next.open = false;
    let r12 = luthier_sent_back(layer, path.cos_theta);
    let spread_r12 = $interface_spread(layer, 1.0);
    next.lobe = r12; //? !below
    next.lobe_spread = spread_r12; //? !below
    // What of the lobe is beyond the critical angle of the interface above turns back, and crosses the slab once more. //? below, escape
    var escaping = 1.0; //? below, escape
    if path.escape_tile >= 0.0 { //? below, escape
        let alpha = $mean_alpha(path.spread_t0i + spread_r12); //? below, escape
        escaping = saturate(luthier_lookup_escape(path.escape_tile, path.cos_above, alpha)); //? below, escape
    } //? below, escape
    let ti0 = path.ti0 * escaping; //? below, escape
    let ri0 = path.ri0 + (1.0 - escaping) * path.ti0 * path.slab; //? below, escape, absorption
    let ri0 = path.ri0 + (1.0 - escaping) * path.ti0; //? below, escape, !absorption
    let ti0 = path.ti0; //? below, !escape
    let ri0 = path.ri0; //? below, !escape

    // All echoes between the two, as a geometric series; 1 is the limit without absorption. //? below
    let echo = ri0 * r12; //? below
    let q = 1.0 - echo; //? below
    let guarded = max(q, vec3<f32>(1e-20)); //? below
    let upward = select(vec3<f32>(1.0), min(ti0 / guarded, vec3<f32>(1.0)), q > vec3<f32>(0.0)); //? below
    let downward = select(vec3<f32>(1.0), min((1.0 - r12) / guarded, vec3<f32>(1.0)), q > vec3<f32>(0.0)); //? below
    let bounces = dot(min(echo / max(q, vec3<f32>(1e-6)), vec3<f32>(1e6)), vec3<f32>(0.333333333)); //? below
    let between = (spread_r12 + path.spread_ri0) * bounces; //? below
    next.lobe = path.t0i * r12 * upward; //? below
    next.lobe_spread = $limited(path.spread_ti0 + (path.spread_t0i + spread_r12 + between) * path.jacobian); //? below

    next.t0i = vec3<f32>(0.0); //? below
    if layer.kind != LUTHIER_DIELECTRIC { //? below, conductor
        return next; //? below, conductor
    } //? below, conductor
    // Refracted at the normal; the squared cosine is written so that it does not cancel for an index near 1. //? below
    let cos_sq = (path.cos_theta * path.cos_theta + (layer.eta - 1.0) * (layer.eta + 1.0)) / (layer.eta * layer.eta); //? below
    if cos_sq <= 0.0 { //? below
        return next; //? below
    } //? below
    next.cos_theta = clamp(sqrt(cos_sq), 0.00001, 1.0); //? below
    next.cos_above = path.cos_theta; //? below, escape
    next.eta = path.eta * layer.eta; //? below, statistics_base
    let widening = layer.eta * next.cos_theta / path.cos_theta; //? below
    let spread_t12 = $interface_spread(layer, 0.5 * abs(1.0 - 1.0 / widening)); //? below
    let spread_t21 = $interface_spread(layer, 0.5 * abs(1.0 - widening)); //? below

    let r21 = r12; //? below
    let back = (1.0 - r21) * ri0 * downward; //? below
    let reflected = r21 + back; //? below
    let share = dot(back, vec3<f32>(1.0)) / max(dot(reflected, vec3<f32>(1.0)), 1e-20); //? below
    let deep = spread_t12 + (spread_t21 + path.spread_ri0 + between) * widening; //? below
    next.spread_ri0 = $limited(spread_r12 * (1.0 - share) + deep * share); //? below
    next.spread_t0i = $limited((path.spread_t0i + between) * widening + spread_t12); //? below
    next.spread_ti0 = $limited(path.spread_ti0 + (spread_t21 + between) / path.jacobian); //? below
    next.jacobian = path.jacobian * widening; //? below

    next.t0i = path.t0i * downward; //? below
    next.ti0 = (1.0 - r21) * upward; //? below
    next.ri0 = reflected; //? below
    next.escape_tile = layer.escape_tile; //? below, escape
    let slab = exp2(-layer.halvings / next.cos_theta); //? below, absorption
    next.slab = slab; //? absorption, escape
    next.t0i *= slab; //? below, absorption
    next.ti0 *= slab; //? below, absorption
    next.ri0 *= slab * slab; //? below, absorption
    next.open = true; //? below
    return next;
}

/// f cos_theta_i of a diffuse base below what both directions have passed through. //? statistics_base
fn $add_base(material: u32, layer: LuthierLayer, light: $Path, eye: $Path, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> { //? statistics_base
    let wi_below = vec3<f32>(wi.xy / light.eta, light.cos_theta); //? statistics_base
    let wo_below = vec3<f32>(wo.xy / eye.eta, eye.cos_theta); //? statistics_base
    return wi.z * luthier_base(material, layer, light.t0i * eye.t0i, wi_below, wo_below, eye.eta); //? statistics_base
} //? statistics_base
