/// Mean radiance in a lobe. A turn has cosine and sine of its angle, and itself, 0 for one sample.
fn luthier_shown_mean(lobe: LuthierShownLobe, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec3<f32>) -> vec3<f32> {
    $turned_mean
    return luthier_shown_still(lobe, prepared, frame);
}

/// Mean radiance in the remainder.
fn luthier_shown_wide(prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec3<f32>) -> vec3<f32> {
    $turned_wide
    return luthier_environment_diffuse(frame[2]);
}

/// Mean radiance in the facets of the first interface.
fn luthier_shown_coat(prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec3<f32>) -> vec3<f32> {
    //? beckmann
    //? ggx
    let tail = 0.001 + 0.998 * prepared.coat.distribution;
    //? else
    let tail = 0.001;
    //? else
    let tail = 0.999;
    //? lobes_axes
    //? anisotropic
    {
        let alpha_sq = prepared.coat.alpha_xy * prepared.coat.alpha_xy;
        let axis = luthier_in_frame(prepared.azimuth, prepared.coat.rotation);
        let square = axis * axis;
        let width = vec3<f32>(dot(square, alpha_sq), dot(square.yx, alpha_sq), axis.x * axis.y * (alpha_sq.x - alpha_sq.y));
    }
    //? else
    let width = vec3<f32>(vec2<f32>(prepared.coat.alpha * prepared.coat.alpha), 0.0);
    //? else
    let width = vec2<f32>(prepared.coat.alpha);
    var coat = luthier_shown_lobe(prepared, 0.0, vec2<f32>(0.0), width, tail);
    coat.is_coat = true;
    return luthier_shown_mean(coat, prepared, frame, turn);
}

/// Radiance that a prepared material sends to the eye from a prefiltered environment. The columns of the frame are tangent, bitangent and normal in
/// the world of the environment. The turn is 0 for one sample of a pixel. Samples with turns of their own in 0..1 read narrower blurs in other directions, whose mean is nearer.
fn luthier_environment_lobes(prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: f32) -> vec3<f32> {
    let angle = 2.0 * LUTHIER_PI * turn;
    let turned = vec3<f32>(cos(angle), sin(angle), turn);
    var rest = luthier_albedo_lobes(prepared) - prepared.wide;
    //? lobes_bare_base
    {
        var total = prepared.base * luthier_environment_diffuse(frame[2]);
        total += (prepared.wide - prepared.base) * luthier_shown_wide(prepared, frame, turned);
    }
    //? else
    var total = prepared.wide * luthier_shown_wide(prepared, frame, turned);
    //? lobes_lean
    {
        // As if the base were outside, and leaned by less: exact where radiance is linear in the direction.
        let eta = prepared.coat.eta;
        let outside = eta * eta * eta - sqrt(max(eta * eta - 1.0, 0.0)) * (eta * eta + 0.5);
        let leaned = frame * normalize(vec3<f32>(prepared.lean * outside, 1.0));
        total += prepared.leaning * (luthier_environment_diffuse(leaned) - luthier_environment_diffuse(frame[2]));
    }
    //? one_lobe|two_lobes
    {
        let first = luthier_lobe_below(prepared, 0u);
        rest -= first.energy;
        total += first.energy * luthier_shown_mean(luthier_shown_below(prepared, first.shape), prepared, frame, turned);
    }
    //? two_lobes
    {
        let second = luthier_lobe_below(prepared, 1u);
        rest -= second.energy;
        total += second.energy * luthier_shown_mean(luthier_shown_below(prepared, second.shape), prepared, frame, turned);
    }
    //? three_lobes
    {
        let third = luthier_lobe_below(prepared, 2u);
        rest -= third.energy;
        total += third.energy * luthier_shown_mean(luthier_shown_below(prepared, third.shape), prepared, frame, turned);
    }
    //? lobes_patina
    {
        // The bare layer has the colour of its reflectance in the mirrored direction.
        let tint = luthier_fresnel_term(prepared.bare, min(prepared.wo.z, 1.0));
        let bare = tint * (luthier_bare_energy(prepared) / max(dot(tint, vec3<f32>(1.0 / 3.0)), 1e-6));
        rest -= bare;
        total += bare * luthier_shown_coat(luthier_bare_lobes(prepared), frame, turned);
    }
    return total + max(rest, vec3<f32>(0.0)) * luthier_shown_coat(prepared, frame, turned);
}

//? lobes_sides, lobes_side_frames
/// Tangent, bitangent and normal in the world of a side whose normal this is in the frame of both.
fn luthier_frame_of_side(frame: mat3x3<f32>, normal: vec3<f32>) -> mat3x3<f32> {
    let back = vec3<f32>(-normal.xy, normal.z);
    return mat3x3<f32>(
        frame * luthier_local(back, vec3<f32>(1.0, 0.0, 0.0)),
        frame * luthier_local(back, vec3<f32>(0.0, 1.0, 0.0)),
        frame * normal,
    );
}

//? lobes_sides
/// Radiance that both sides of a coat with a weight send to the eye: see `luthier_environment_lobes`.
fn luthier_environment_sides(prepared: LuthierPreparedSides, frame: mat3x3<f32>, turn: f32) -> vec3<f32> {
    var light = vec3<f32>(0.0);
    //? lobes_side_frames
    if prepared.cover > 0.0 && prepared.coated_open {
        light = prepared.cover * luthier_environment_lobes(prepared.coated, luthier_frame_of_side(frame, prepared.coated_normal), turn);
    }
    //? else
    if prepared.cover > 0.0 {
        light = prepared.cover * luthier_environment_lobes(prepared.coated, frame, turn);
    }
    //? lobes_side_frames
    if !prepared.bare_open {
        return light;
    }
    if prepared.cover < 1.0 {
        let bare = 1.0 - prepared.cover;
        //? lobes_side_frames
        let bare_frame = luthier_frame_of_side(frame, prepared.bare_normal);
        //? lobes_side_bases
        {
            if prepared.is_base {
                //? lobes_side_frames
                return light + bare * luthier_albedo_bare_side(prepared) * luthier_environment_diffuse(bare_frame[2]);
                //? else
                return light + bare * luthier_albedo_bare_side(prepared) * luthier_environment_diffuse(frame[2]);
            }
        }
        //? lobes_side_rows
        //? lobes_side_frames
        light += bare * luthier_environment_lobes(prepared.bare, bare_frame, turn);
        //? else
        light += bare * luthier_environment_lobes(prepared.bare, frame, turn);
    }
    return light;
}
