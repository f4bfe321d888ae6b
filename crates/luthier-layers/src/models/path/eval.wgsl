/// State of the light on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    /// To the light, in the medium above the next layer.
    wi_local: vec3<f32>,
    /// To the eye, in the medium above the next layer.
    wo_local: vec3<f32>,
    /// Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    across: vec2<f32>,
    /// Share of the light that comes down to the next layer and back out.
    throughput: vec3<f32>,
    //? fluorescent
    /// Light that comes down to the next layer; `throughput` is the share of what goes up there that comes out.
    lit: vec3<f32>,
    /// f of the layers so far.
    total: vec3<f32>,
    //? clamped
    /// Greatest slope parameter so far: a layer is never smoother than those above it.
    alpha_above: f32,
    /// Whether any light reaches the next layer.
    open: bool,
    //? flakes
    /// Normal below the next interface, in its frame: that of the flakes.
    normal_below: vec3<f32>,
    //? inner_cosine
    /// Cosine of the light outside.
    outer_cosine: f32,
}

/// A path in the frame of an interface's own normal, closed where the interface turns away from either direction. The light that falls on it
/// goes by its cosine there.
fn luthier_onto(path: LuthierPath, normal: vec3<f32>) -> LuthierPath {
    var next = path;
    next.wi_local = luthier_local(normal, path.wi_local);
    next.wo_local = luthier_local(normal, path.wo_local);
    next.across = luthier_local(normal, vec3<f32>(path.across, path.wi_local.z + path.wo_local.z)).xy;
    next.open = path.open && min(next.wi_local.z, next.wo_local.z) > 0.0;
    let facing = next.wi_local.z / path.wi_local.z;
    //? fluorescent
    next.lit = path.lit * facing;
    //? else
    next.throughput = path.throughput * facing;
    return next;
}

//? flakes
/// A path in the frame of a normal that tilts all that lies below, the way through the slab included: closed where either direction does not meet it.
fn luthier_into(path: LuthierPath, normal: vec3<f32>) -> LuthierPath {
    var next = path;
    next.wi_local = luthier_local(normal, path.wi_local);
    next.wo_local = luthier_local(normal, path.wo_local);
    next.across = luthier_local(normal, vec3<f32>(path.across, path.wi_local.z + path.wo_local.z)).xy;
    next.normal_below = vec3<f32>(0.0, 0.0, 1.0);
    next.open = path.open && min(next.wi_local.z, next.wo_local.z) > 0.0;
    return next;
}

/// Adds what a diffuse base reflects. It ends the stack.
fn luthier_add_diffuse(above: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    //? own_normals
    {
        var path = luthier_onto(above, layer.normal);
        if !path.open {
            return path;
        }
    }
    //? else
    let path = above;
    //? fluorescent
    let sent = luthier_reradiated(layer, path.wi_local, path.wo_local, path.lit);
    //? else
    let brdf = $diffuse(layer, path.wi_local, path.wo_local);
    var next = path;
    //? fluorescent
    next.total = path.total + path.throughput * sent;
    //? else
    next.total = path.total + path.throughput * brdf;
    next.open = false;
    return next;
}

//? power_facets
/// BRDF of a lower interface that reflects all light, as a lobe of Blinn and Phong about the normal or of Phong about the mirrored direction.
fn luthier_power_facets(layer: LuthierLayer, path: LuthierPath, bisector: vec3<f32>, length_sq: f32) -> f32 {
    let of_blinn = 2.0 / (layer.alpha * layer.alpha) - 2.0;
    if layer.lower_facets == 1u {
        let sine_sq = dot(bisector.xy, bisector.xy) / length_sq;
        let away = sine_sq / (1.0 + bisector.z * inverseSqrt(length_sq));
        return (of_blinn + 2.0) * luthier_power_lobe(away, of_blinn) / (8.0 * LUTHIER_PI);
    }
    let exponent = 0.25 * of_blinn;
    let apart = vec3<f32>(bisector.xy, path.wi_local.z - path.wo_local.z);
    return (exponent + 2.0) * luthier_power_lobe(0.5 * dot(apart, apart), exponent) / (2.0 * LUTHIER_PI);
}

/// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
/// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
fn luthier_add_interface(above: LuthierPath, layer: LuthierLayer) -> LuthierPath {
    //? own_normals
    {
        var path = luthier_onto(above, layer.normal);
        if !path.open {
            return path;
        }
    }
    //? else
    let path = above;
    var next = path;
    next.open = false;

    let cosines = vec2<f32>(path.wi_local.z, path.wo_local.z);
    let bisector = vec3<f32>(path.across, cosines.x + cosines.y);
    let length_sq = dot(bisector.xy, bisector.xy) + bisector.z * bisector.z;
    // For unit directions cos_theta_d is half the length of their sum, which does not cancel at grazing angles.
    let secant_d = 2.0 * inverseSqrt(length_sq);
    let cos_theta_d = min(0.25 * length_sq * secant_d, 1.0);
    //? own_angles
    //? chain_patina
    var fresnel = layer.tarnish * luthier_fresnel_term(layer, cos_theta_d);
    //? else
    var fresnel = luthier_fresnel_term(layer, cos_theta_d);
    //? else
    //? chain_patina
    let fresnel = layer.tarnish * luthier_fresnel_term(layer, cos_theta_d);
    //? else
    let fresnel = luthier_fresnel_term(layer, cos_theta_d);
    // G of V-cavities: 2 cos_theta_h / cos_theta_d times the lower cosine, at most 1.
    //? kelemen_cavities|power_facets
    var masking = min(bisector.z * min(cosines.x, cosines.y) * (secant_d * secant_d), 1.0);
    //? else
    let masking = min(bisector.z * min(cosines.x, cosines.y) * (secant_d * secant_d), 1.0);
    //? kelemen_cavities
    {
        // Kelemen and Szirmay-Kalos: cos_theta_i cos_theta_o / cos_theta_d^2.
        if layer.masking == 4u {
            masking = min(cosines.x * cosines.y * (secant_d * secant_d), 1.0);
        }
    }
    //? inner_cosine|power_facets
    var geometry = luthier_quarter_density(layer, bisector) * masking / (cosines.x * cosines.y);
    //? else
    let geometry = luthier_quarter_density(layer, bisector) * masking / (cosines.x * cosines.y);
    //? power_facets
    {
        if layer.lower_facets > 0u {
            masking = 1.0;
            geometry = luthier_power_facets(layer, path, bisector, length_sq);
        }
    }
    //? inner_cosine
    geometry *= select(1.0, cosines.x / path.outer_cosine, layer.inner_cosine);
    //? fluorescent
    next.total = path.total + path.throughput * path.lit * fresnel * geometry;
    //? else
    next.total = path.total + path.throughput * fresnel * geometry;

    //? below
    {
        //? conductor
        if layer.kind != LUTHIER_DIELECTRIC {
            return next;
        }
        // Refracted at the normal; the squared cosine does not cancel for an index near 1.
        let bent = cosines * layer.inverse_eta;
        let cosines_sq = bent * bent + layer.grazing_cos_sq;
        let secants = inverseSqrt(cosines_sq);
        let refracted = cosines_sq * secants;
        next.wi_local = vec3<f32>(path.wi_local.xy * layer.inverse_eta, refracted.x);
        next.wo_local = vec3<f32>(path.wo_local.xy * layer.inverse_eta, refracted.y);
        next.across = path.across * layer.inverse_eta;
        next.open = min(cosines_sq.x, cosines_sq.y) > 0.0;
        //? ~flakes
        if dot(path.normal_below.xy, path.normal_below.xy) > 0.0 {
            next = luthier_into(next, path.normal_below);
        }
        //? else
        //? flakes
        next = luthier_into(next, path.normal_below);
        //? own_normals
        {
            // Back to the frame of the place: slabs are as thick along its normal as without bumps.
            next = luthier_onto(next, vec3<f32>(-layer.normal.xy, layer.normal.z));
            //? fluorescent
            path.lit = next.lit;
            //? else
            path.throughput = next.throughput;
        }
        // (1 - F) down, (1 - F) up, and part of what the cavities block comes back: (1 - F) (1 - G + (1 - F) G).
        //? internal
        //? own_angles
        {
            var returned = 1.0 - (layer.internal_reflection * masking) * fresnel;
            if layer.own_angles {
                //? chain_patina
                {
                    fresnel = layer.tarnish * luthier_fresnel_term(layer, min(cosines.x, 1.0));
                    returned = 1.0 - layer.tarnish * luthier_fresnel_term(layer, min(cosines.y, 1.0));
                }
                //? else
                {
                    fresnel = luthier_fresnel_term(layer, min(cosines.x, 1.0));
                    returned = 1.0 - luthier_fresnel_term(layer, min(cosines.y, 1.0));
                }
            }
        }
        //? else
        let returned = 1.0 - (layer.internal_reflection * masking) * fresnel;
        //? else
        let returned = 1.0 - masking * fresnel;
        //? fluorescent
        // On the way down light has the channels in which it came, on the way up those in which it leaves.
        //? absorption
        {
            //? flakes|own_normals
            let ways = 1.0 / vec2<f32>(next.wi_local.z, next.wo_local.z);
            //? else
            let ways = secants;
            let down = exp2(-layer.optical_depth_log2 * ways.x);
            next.lit = path.lit * (down - down * fresnel);
            next.throughput = path.throughput * exp2(-layer.optical_depth_log2 * ways.y) * returned;
        }
        //? else
        {
            next.lit = path.lit * (1.0 - fresnel);
            next.throughput = path.throughput * returned;
        }
        //? else
        //? absorption
        {
            //? flakes|own_normals
            let absorbed = exp2(-layer.optical_depth_log2 * (1.0 / next.wi_local.z + 1.0 / next.wo_local.z));
            //? else
            let absorbed = exp2(-layer.optical_depth_log2 * (secants.x + secants.y));
            next.throughput = path.throughput * (absorbed - absorbed * fresnel) * returned;
        }
        //? else
        next.throughput = path.throughput * (1.0 - fresnel) * returned;
    }
    return next;
}
