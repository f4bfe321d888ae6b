/// A direction of light that was drawn for a material.
struct LuthierSample {
    /// Direction, unit.
    wi: vec3<f32>,
    /// Density in solid angle; 0 where nothing is reflected along the direction. Such a draw counts all the same.
    pdf: f32,
    /// f cos_theta_i over the density, RGB.
    weight: vec3<f32>,
    /// Number of the lobe that it was drawn for, from 0 at the top; one more than the last for diffuse light.
    part: u32,
}

/// Probability of a part times the sum of all.
fn luthier_chance(part: LuthierPart) -> f32 {
    return max(dot(part.energy, vec3<f32>(0.333333333)), 0.0);
}

/// Probability that diffuse draws take over from a part: where lobes are rough, models leave their visible normals.
fn luthier_spill(part: LuthierPart) -> f32 {
    //? powers
    return select(0.1 * max(part.alpha.x, part.alpha.y), 0.0, part.exponent >= 0.0) * luthier_chance(part);
    //? else
    return 0.1 * max(part.alpha.x, part.alpha.y) * luthier_chance(part);
}

/// Probability of the diffuse draws, times the sum of all.
fn luthier_wide_chance(prepared: LuthierPrepared) -> f32 {
    // A material that reflects nothing is drawn from, too.
    var chance = max(dot(prepared.wide, vec3<f32>(0.333333333)), 1e-6);
    $each_spill
    return chance;
}

/// A direction across a boundary to a medium of the relative index eta; below the horizon where there is none.
fn luthier_refracted(w: vec3<f32>, eta: f32) -> vec3<f32> {
    let cos_sq = (w.z * w.z + (eta - 1.0) * (eta + 1.0)) / (eta * eta);
    return vec3<f32>(w.xy / eta, select(-1.0, sqrt(max(cos_sq, 1e-12)), cos_sq > 0.0 && w.z > 0.0));
}

/// A direction outside as it is where a part is.
fn luthier_into_part(part: LuthierPart, w: vec3<f32>) -> vec3<f32> {
    let inside = luthier_refracted(w, part.eta);
    //? tilted
    return luthier_refracted(luthier_local(part.normal, inside), part.inner_eta);
    //? else
    return inside;
}

/// Density in solid angle of directions mirrored at a part, over the whole sphere, in the medium of the part.
fn luthier_mirrored_density(part: LuthierPart, eye: vec3<f32>, light: vec3<f32>) -> f32 {
    //? cavities
    if part.cavity_power > 0.0 {
        return luthier_cavity_density(part.cavity_power, eye, light);
    }
    //? powers, visible
    if part.exponent < 0.0 {
        return luthier_visible_density(part.alpha, part.axis, eye, light);
    }
    //? powers
    {
        let apart = vec3<f32>(light.xy + eye.xy, light.z - eye.z);
        let lobe = luthier_power_lobe(0.5 * dot(apart, apart), part.exponent);
        return (part.exponent + 1.0) * lobe / (2.0 * LUTHIER_PI);
    }
    //? else
    return luthier_visible_density(part.alpha, part.axis, eye, light);
}

/// Cosines outside the cone of directions that leave which mirrored ones reach, and the factor that fits them into it. Visible normals lean by less than
/// 90 degrees, so that no cosine is below that of the eye, negative.
fn luthier_fold(part: LuthierPart, eye: vec3<f32>, edge: f32) -> vec2<f32> {
    //? powers
    //? visible
    let reach = edge + select(1.0, eye.z, part.exponent < 0.0);
    //? else
    let reach = edge + 1.0;
    //? else
    let reach = edge + eye.z;
    return vec2<f32>(reach, min((1.0 - edge) / reach, 1.0));
}

/// The direction of the same azimuth and another cosine.
fn luthier_with_cosine(w: vec3<f32>, cosine: f32) -> vec3<f32> {
    let across = sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0)) * inverseSqrt(max(dot(w.xy, w.xy), 1e-30));
    return vec3<f32>(w.xy * across, cosine);
}

/// Density in solid angle, outside, of directions that are drawn for a part.
fn luthier_part_density(part: LuthierPart, wo: vec3<f32>, wi: vec3<f32>) -> f32 {
    //? media
    {
        //? tilted
        {
            // Once more the way of `luthier_into_part`, for the cosines at each boundary.
            let through = luthier_refracted(wi, part.eta);
            let tilted = luthier_local(part.normal, through);
            let light = luthier_refracted(tilted, part.inner_eta);
            let index = part.eta * part.inner_eta;
            let crowding = wi.z * tilted.z / (index * index * through.z * light.z);
            let is_shut = through.z <= 0.0 || light.z <= 0.0;
        }
        //? else
        {
            let light = luthier_into_part(part, wi);
            let crowding = wi.z / (part.eta * part.eta * light.z);
            let is_shut = light.z <= 0.0;
        }
        let eye = luthier_into_part(part, wo);
        if is_shut || eye.z <= 0.0 {
            return 0.0;
        }
    }
    //? else
    {
        let light = wi;
        let eye = wo;
        let crowding = 1.0;
    }
    //? folded
    {
        //? media
        let edge = part.edge;
        //? else
        let edge = 0.0;
        let fold = luthier_fold(part, eye, edge);
        let beyond = max(light.z - edge, 0.0) / fold.y;
        var density = luthier_mirrored_density(part, eye, light);
        if beyond < fold.x {
            density += luthier_mirrored_density(part, eye, luthier_with_cosine(light, edge - beyond)) / fold.y;
        }
        return crowding * density;
    }
    //? else
    return crowding * luthier_mirrored_density(part, eye, light);
}

/// A direction about the mirrored one, by a power of the cosine between both.
fn luthier_draw_power(exponent: f32, wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    // 1 less the cosine, 1 - exp(-y) without cancellation.
    let y = -log(1.0 - min(u.x, 0.9999999)) / (exponent + 1.0);
    let series = y * (1.0 - y * (0.5 - y * (1.0 / 6.0)));
    let away = select(1.0 - exp(-y), series, y < 0.02);
    let phi = 2.0 * LUTHIER_PI * u.y;
    let across = sqrt(max(away * (2.0 - away), 0.0)) * vec2<f32>(cos(phi), sin(phi));
    return luthier_local(vec3<f32>(wo.xy, wo.z), vec3<f32>(across, 1.0 - away));
}

/// A direction mirrored at a part, in the medium of the part.
fn luthier_draw_mirrored(part: LuthierPart, eye: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    //? cavities
    if part.cavity_power > 0.0 {
        return luthier_draw_cavity(part.cavity_power, eye, u);
    }
    //? powers, visible
    if part.exponent < 0.0 {
        return luthier_draw_visible(part.alpha, part.axis, eye, u);
    }
    //? powers
    return luthier_draw_power(part.exponent, eye, u);
    //? else
    return luthier_draw_visible(part.alpha, part.axis, eye, u);
}

/// A direction that is drawn for a part; below the horizon where light does not leave along it.
fn luthier_draw_part(part: LuthierPart, wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    //? media
    {
        let eye = luthier_into_part(part, wo);
        if eye.z <= 0.0 {
            return vec3<f32>(0.0, 0.0, -1.0);
        }
    }
    //? else
    let eye = wo;
    let mirrored = luthier_draw_mirrored(part, eye, u);
    //? folded
    {
        // What does not leave is folded into the cone of directions that do, at its edge.
        //? media
        let edge = part.edge;
        //? else
        let edge = 0.0;
        var drawn = mirrored;
        if mirrored.z <= edge {
            let fold = luthier_fold(part, eye, edge);
            drawn = luthier_with_cosine(mirrored, min(edge + fold.y * (edge - mirrored.z), 1.0));
        }
    }
    //? else
    let drawn = mirrored;
    //? media
    //? tilted
    {
        let through = luthier_refracted(drawn, 1.0 / part.inner_eta);
        if through.z <= 0.0 {
            return through;
        }
        return luthier_refracted(luthier_local(vec3<f32>(-part.normal.xy, part.normal.z), through), 1.0 / part.eta);
    }
    //? else
    return luthier_refracted(drawn, 1.0 / part.eta);
    //? else
    return drawn;
}

/// Density in solid angle with which a direction in the frame of the place, above the horizon, is drawn.
fn luthier_density(prepared: LuthierPrepared, wi: vec3<f32>) -> f32 {
    //? lobes
    //? several
    if prepared.model == $model_lobes {
        return luthier_density_$sides(prepared.lobes, wi);
    }
    //? else
    return luthier_density_$sides(prepared.lobes, wi);
    //? several|!lobes
    {
        let wide = luthier_wide_chance(prepared);
        var density = wide * (wi.z / LUTHIER_PI);
        var total = wide;
        $each_density
        return density / total;
    }
}

/// Direction and part of a draw, in the frame of the place, without its density and weight.
fn luthier_draw(prepared: LuthierPrepared, u: vec3<f32>) -> LuthierSample {
    //? lobes
    //? several
    if prepared.model == $model_lobes {
        return luthier_draw_$sides(prepared.lobes, u);
    }
    //? else
    return luthier_draw_$sides(prepared.lobes, u);
    //? several|!lobes
    {
        let phi = 2.0 * LUTHIER_PI * u.z;
        let cosine = vec3<f32>(sqrt(u.y) * vec2<f32>(cos(phi), sin(phi)), sqrt(1.0 - u.y));
        var drawn = LuthierSample(cosine, 0.0, vec3<f32>(0.0), $parts);
        //? visible|powers
        {
            var total = luthier_wide_chance(prepared);
            $each_total
            let choice = u.x * total;
            var part = luthier_no_part();
            var below = 0.0;
            $each_choice
            if drawn.part < $parts {
                drawn.wi = luthier_draw_part(part, prepared.wo, u.yz);
            }
        }
        return drawn;
    }
}

/// Density in solid angle with which `luthier_sample` draws a direction. Its integral is 1 less the share of draws that have no weight, as they do not
/// leave the surface; parts that lie below no tilted boundary fold them back to where they do.
fn luthier_pdf(prepared: LuthierPrepared, wi: vec3<f32>) -> f32 {
    if wi.z <= 0.0 || !prepared.open {
        return 0.0;
    }
    //? place
    {
        let wi_here = luthier_local(prepared.place.normal, wi);
        if wi_here.z <= 0.0 {
            return 0.0;
        }
        return luthier_density(prepared, wi_here);
    }
    //? else
    return luthier_density(prepared, wi);
}

/// A direction of light for a prepared material, from three numbers that are uniform in 0..1.
fn luthier_sample(prepared: LuthierPrepared, u: vec3<f32>) -> LuthierSample {
    var drawn = luthier_draw(prepared, u);
    //? place
    {
        let normal = prepared.place.normal;
        drawn.wi = luthier_local(vec3<f32>(-normal.xy, normal.z), drawn.wi);
    }
    drawn.pdf = luthier_pdf(prepared, drawn.wi);
    if drawn.pdf > 0.0 {
        drawn.weight = luthier_light(prepared, drawn.wi) / drawn.pdf;
    }
    return drawn;
}
