/// Light on its way down from the exterior, 0, to the medium above the next layer, i: energies, and spreads of directions (Belcour
/// 2018, sec. 4 and 5).
struct $Path {
    /// Cosine of the mean direction in i.
    cos_theta: f32,
    /// Cosine of the mean direction in the medium above i.
    cos_above: f32,
    /// Tile of the escape table for lobes in i; -1 where all escapes.
    escape_tile: f32,
    /// Transmittance of the slab that is i.
    slab: vec3<f32>,
    /// Index of i over that of 0.
    eta: f32,
    /// Share that comes down from 0 to i.
    t0i: vec3<f32>,
    /// Share that goes up from i to 0.
    ti0: vec3<f32>,
    /// Share that comes back to i from above.
    ri0: vec3<f32>,
    /// Spreads of the three.
    spread_t0i: $spread,
    spread_ti0: $spread,
    spread_ri0: $spread,
    /// By how much spreads in i grow on the way to 0.
    jacobian_0i: f32,
    /// Energy that left the last interface to 0.
    lobe_energy: vec3<f32>,
    /// Its spread.
    lobe_spread: $spread,
    /// Whether any light reaches the next layer.
    open: bool,
}

/// Light at a cosine above the first interface.
fn $start(cos_theta: f32) -> $Path {
    var path: $Path;
    path.cos_theta = clamp(cos_theta, 0.00001, 1.0);
    path.cos_above = path.cos_theta;
    path.eta = 1.0;
    path.t0i = vec3<f32>(1.0);
    path.ti0 = vec3<f32>(1.0);
    path.jacobian_0i = 1.0;
    path.slab = vec3<f32>(1.0);
    path.escape_tile = -1.0;
    path.open = true;
    return path;
}

/// Adds an interface below: its lobe, and what goes on below it.
fn $add(path: $Path, layer: LuthierLayer) -> $Path {
    var next = path;
    next.open = false;
    let r12 = luthier_energy_fgd(layer, path.cos_theta);
    let spread_r12 = $interface_spread(layer, 1.0);
    //? below
    {
        //? escape
        {
            // What of the lobe is beyond the critical angle of the interface above turns back, and crosses the slab once more.
            var escaping = 1.0;
            if path.escape_tile >= 0.0 {
                let alpha = $mean_alpha(path.spread_t0i + spread_r12);
                escaping = saturate(luthier_lookup_escape(path.escape_tile, path.cos_above, alpha));
            }
            let ti0 = path.ti0 * escaping;
            //? absorption
            let ri0 = path.ri0 + (1.0 - escaping) * path.ti0 * path.slab;
            //? else
            let ri0 = path.ri0 + (1.0 - escaping) * path.ti0;
        }
        //? else
        {
            let ti0 = path.ti0;
            let ri0 = path.ri0;
        }

        // All echoes between the two, as a geometric series; 1 is the limit without absorption.
        let echo = ri0 * r12;
        let q = 1.0 - echo;
        let guarded = max(q, vec3<f32>(1e-20));
        let upward = luthier_choose(vec3<f32>(1.0), min(ti0 / guarded, vec3<f32>(1.0)), q > vec3<f32>(0.0));
        let downward = luthier_choose(vec3<f32>(1.0), min((1.0 - r12) / guarded, vec3<f32>(1.0)), q > vec3<f32>(0.0));
        let bounces = dot(min(echo / max(q, vec3<f32>(1e-6)), vec3<f32>(1e6)), vec3<f32>(0.333333333));
        let between = (spread_r12 + path.spread_ri0) * bounces;
        next.lobe_energy = path.t0i * r12 * upward;
        next.lobe_spread = $limited(path.spread_ti0 + (path.spread_t0i + spread_r12 + between) * path.jacobian_0i);

        next.t0i = vec3<f32>(0.0);
        //? conductor
        if layer.kind != LUTHIER_DIELECTRIC {
            return next;
        }
        // Refracted at the normal; the squared cosine is written so that it does not cancel for an index near 1.
        let cos_t_sq = (path.cos_theta * path.cos_theta + (layer.eta - 1.0) * (layer.eta + 1.0)) / (layer.eta * layer.eta);
        if cos_t_sq <= 0.0 {
            return next;
        }
        next.cos_theta = clamp(sqrt(cos_t_sq), 0.00001, 1.0);
        next.cos_above = path.cos_theta;
        next.eta = path.eta * layer.eta;
        let j12 = layer.eta * next.cos_theta / path.cos_theta;
        let spread_t12 = $interface_spread(layer, 0.5 * abs(1.0 - 1.0 / j12));
        let spread_t21 = $interface_spread(layer, 0.5 * abs(1.0 - j12));

        let r21 = r12;
        let back = (1.0 - r21) * ri0 * downward;
        let reflected = r21 + back;
        let share = dot(back, vec3<f32>(1.0)) / max(dot(reflected, vec3<f32>(1.0)), 1e-20);
        let deep = spread_t12 + (spread_t21 + path.spread_ri0 + between) * j12;
        next.spread_ri0 = $limited(spread_r12 * (1.0 - share) + deep * share);
        next.spread_t0i = $limited((path.spread_t0i + between) * j12 + spread_t12);
        next.spread_ti0 = $limited(path.spread_ti0 + (spread_t21 + between) / path.jacobian_0i);
        next.jacobian_0i = path.jacobian_0i * j12;

        next.t0i = path.t0i * downward;
        next.ti0 = (1.0 - r21) * upward;
        next.ri0 = reflected;
        next.escape_tile = layer.escape_tile;
        //? absorption
        {
            let slab = exp2(-layer.optical_depth_log2 / next.cos_theta);
            next.slab = slab;
            next.t0i *= slab;
            next.ti0 *= slab;
            next.ri0 *= slab * slab;
        }
        next.open = true;
    }
    //? else
    {
        next.lobe_energy = r12;
        next.lobe_spread = spread_r12;
    }
    return next;
}

/// f cos_theta_i of a diffuse base below what both directions have passed through.
fn $add_base(material: u32, layer: LuthierLayer, light: $Path, eye: $Path, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let wi_below = vec3<f32>(wi.xy / light.eta, light.cos_theta);
    let wo_below = vec3<f32>(wo.xy / eye.eta, eye.cos_theta);
    return wi.z * luthier_base(material, layer, light.t0i * eye.t0i, wi_below, wo_below, eye.eta);
}
