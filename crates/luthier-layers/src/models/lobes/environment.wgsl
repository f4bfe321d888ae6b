/// A lobe that the environment is shown in, in slopes of half vectors in the plane of the eye and across it.
struct LuthierShownLobe {
    /// The eye inside, times the index.
    eye: vec3<f32>,
    /// Middle.
    middle: vec2<f32>,
    //? lobes_axes
    {
        /// Cosine and sine of the azimuth of the eye.
        azimuth: vec2<f32>,
        /// Squared widths as a symmetric matrix: in the plane of the eye, across it, and between them.
        width_sq: vec3<f32>,
        /// The triangular root of the matrix within which directions lie: what their blurs leave.
        spread: vec3<f32>,
    }
    //? else
    {
        /// Widths.
        width: vec2<f32>,
        /// Those within which directions lie: what their blurs leave.
        spread: vec2<f32>,
    }
    /// 1 over the decay: near 0 Beckmann's distribution, 1 that of GGX.
    tail: f32,
    /// Whether facets of the first interface weigh the directions.
    is_coat: bool,
    /// Cosine and sine by which directions are turned about the middle.
    turn: vec2<f32>,
}

/// Light that was read in some directions of a lobe, and the weights of these.
struct LuthierShown {
    light: vec3<f32>,
    weight: vec3<f32>,
}

/// Angles between directions outside over differences of slopes, in the plane of the eye and across it.
fn luthier_shown_stretch(up_z: f32, cos_theta_i: f32, cos_theta_d: f32, cos_theta_h: f32) -> vec2<f32> {
    return 2.0 * cos_theta_h * vec2<f32>(cos_theta_h * max(up_z, 0.0) / max(cos_theta_i, 0.02), max(cos_theta_d, 1e-3));
}

/// Standard deviation of the blur of a direction over the widths of its lobe, for Beckmann's distribution: with less the directions are seen one by one in
/// small bright lights, with more the lobe is one of angles rather than of slopes. Gaussians about the points of a Gaussian are one; lobes with longer tails
/// want narrower ones in the middle, and wider ones the farther out they are.
const LUTHIER_TAP_BLUR: f32 = $tap_blur;

/// Standard deviation of the blur of a direction of a lobe, an angle: not wider than the lobe where it is narrow.
fn luthier_shown_blur(lobe: LuthierShownLobe, stretch: vec2<f32>) -> f32 {
    let tail = min(lobe.tail, 1.0);
    let share = LUTHIER_TAP_BLUR - 0.08 * tail;
    let narrowest = 0.70711 - 0.4 * tail;
    //? lobes_axes
    {
        let angle_sq = lobe.width_sq * vec3<f32>(stretch * stretch, stretch.x * stretch.y);
        let mean = 0.5 * (angle_sq.x + angle_sq.y);
        let half_difference = 0.5 * (angle_sq.x - angle_sq.y);
        let narrow_sq = max(mean - sqrt(half_difference * half_difference + angle_sq.z * angle_sq.z), 1e-6 * mean);
        let area_sq = max(angle_sq.x * angle_sq.y - angle_sq.z * angle_sq.z, 0.0);
        return min(share * sqrt(sqrt(area_sq)), narrowest * sqrt(narrow_sq));
    }
    //? else
    {
        let angles = lobe.width * stretch;
        return min(share * sqrt(angles.x * angles.y), narrowest * min(angles.x, angles.y));
    }
}

/// The stretch of angles about the middle of a lobe.
fn luthier_shown_middle_stretch(lobe: LuthierShownLobe) -> vec2<f32> {
    let wh = vec3<f32>(lobe.middle, 1.0) * inverseSqrt(1.0 + dot(lobe.middle, lobe.middle));
    let cos_theta_d = dot(wh, lobe.eye);
    let up = 2.0 * cos_theta_d * wh - lobe.eye;
    return luthier_shown_stretch(up.z, sqrt(max(1.0 - dot(up.xy, up.xy), 0.0)), cos_theta_d, wh.z);
}

//? lobes_axes
/// A lobe with this middle and these squared widths, a symmetric matrix in the frame of the lobes, seen in a medium whose squared index less 1 is
/// the excess.
fn luthier_shown_lobe(prepared: LuthierPreparedLobes, excess: f32, middle: vec2<f32>, width_sq: vec3<f32>, tail: f32, turn: vec2<f32>) -> LuthierShownLobe {
    var lobe: LuthierShownLobe;
    let across = prepared.wo.xy + vec2<f32>(1e-15, 0.0);
    let inverse_sin = inverseSqrt(dot(across, across));
    lobe.azimuth = across * inverse_sin;
    lobe.eye = vec3<f32>(dot(across, lobe.azimuth), 0.0, sqrt(prepared.wo.z * prepared.wo.z + excess));
    // From the frame of the lobes.
    let plane = luthier_in_frame(prepared.azimuth, lobe.azimuth);
    lobe.middle = luthier_in_frame(plane, middle);
    let square = plane * plane;
    let both = plane.x * plane.y;
    lobe.width_sq = vec3<f32>(
        square.x * width_sq.x + square.y * width_sq.y + 2.0 * both * width_sq.z,
        square.y * width_sq.x + square.x * width_sq.y - 2.0 * both * width_sq.z,
        both * (width_sq.y - width_sq.x) + (square.x - square.y) * width_sq.z,
    );
    lobe.tail = tail;
    lobe.is_coat = false;
    lobe.turn = turn;
    let stretch = luthier_shown_middle_stretch(lobe);
    let blur = luthier_shown_blur(lobe, stretch);
    let left = max(lobe.width_sq.xy - (2.0 + 2.0 * tail) * (blur * blur) / max(stretch * stretch, vec2<f32>(1e-12)), vec2<f32>(0.0));
    let along = sqrt(left.x);
    let between = lobe.width_sq.z / max(along, 1e-12);
    lobe.spread = vec3<f32>(along, sqrt(max(left.y - between * between, 0.0)), between);
    return lobe;
}
//? else
/// A lobe with this middle and these widths, seen in a medium whose squared index less 1 is the excess.
fn luthier_shown_lobe(prepared: LuthierPreparedLobes, excess: f32, middle: vec2<f32>, width: vec2<f32>, tail: f32, turn: vec2<f32>) -> LuthierShownLobe {
    var lobe: LuthierShownLobe;
    lobe.eye = vec3<f32>(dot(prepared.azimuth, prepared.wo.xy), 0.0, sqrt(prepared.wo.z * prepared.wo.z + excess));
    lobe.middle = middle;
    lobe.width = width;
    lobe.tail = tail;
    lobe.is_coat = false;
    lobe.turn = turn;
    let stretch = luthier_shown_middle_stretch(lobe);
    let angles = width * stretch;
    let blur = luthier_shown_blur(lobe, stretch);
    lobe.spread = width * sqrt(max(1.0 - (2.0 + 2.0 * tail) * (blur * blur) / (angles * angles), vec2<f32>(0.0)));
    return lobe;
}

/// A lobe of rows.
fn luthier_shown_below(prepared: LuthierPreparedLobes, shape: LuthierLobeShape, turn: vec2<f32>) -> LuthierShownLobe {
    let middle = luthier_lobe_slope(shape, vec2<f32>(0.0));
    //? lobes_axes
    {
        // The square of the inverse of the sharpness, over the decay.
        let determinant = luthier_lobe_determinant(shape);
        let mixed = shape.sharpness.yx * shape.sharpness.yx + shape.shear * shape.shear;
        let squares = vec3<f32>(mixed, -shape.shear * (shape.sharpness.x + shape.sharpness.y));
        let width = squares / (determinant * determinant * shape.decay);
    }
    //? else
    let width = inverseSqrt(shape.decay) / shape.sharpness;
    return luthier_shown_lobe(prepared, prepared.medium.x, middle, width, 1.0 / shape.decay, turn);
}

/// Light so far and that of one more direction of a lobe: where it lies over the widths of a Gaussian, the square of its distance from the middle, and its
/// weight. Lobes with longer tails have it farther out, with a wider blur. What would not leave the surface weighs nothing.
fn luthier_shown_tap(shown: LuthierShown, lobe: LuthierShownLobe, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, tap: vec4<f32>) -> LuthierShown {
    let grown = lobe.tail * tap.z;
    let farther = sqrt(select((exp(grown) - 1.0) / max(grown, 1e-2), 1.0 + 0.5 * grown, grown < 0.02));
    let around = farther * vec2<f32>(lobe.turn.x * tap.x - lobe.turn.y * tap.y, lobe.turn.y * tap.x + lobe.turn.x * tap.y);
    //? lobes_axes
    let slope = lobe.middle + lobe.spread.xy * around + vec2<f32>(0.0, lobe.spread.z * around.x);
    //? else
    let slope = lobe.middle + lobe.spread * around;
    let wh = vec3<f32>(slope, 1.0) * inverseSqrt(1.0 + dot(slope, slope));
    let cos_theta_d = dot(wh, lobe.eye);
    let up = 2.0 * cos_theta_d * wh - lobe.eye;
    let sin_sq = dot(up.xy, up.xy);
    // Below 0 where light does not leave.
    let above = select(-1.0, 1.0, sin_sq < 1.0 && up.z > 0.0) * sqrt(abs(1.0 - sin_sq));
    let cos_theta_i = max(above, 1e-2);
    let across = up.xy * min(inverseSqrt(max(sin_sq, 1e-12)), 1.0);
    let stretch = luthier_shown_stretch(up.z, cos_theta_i, cos_theta_d, wh.z);
    let width = min(luthier_shown_blur(lobe, stretch) * exp(0.4 * grown), 1.4);
    var weight = vec3<f32>(tap.w * saturate(0.5 + 0.5 * above / max(width, 0.014)));
    //? lobes_axes
    let azimuth = lobe.azimuth;
    //? else
    let azimuth = prepared.azimuth;
    let wi = vec3<f32>(azimuth.x * across.x - azimuth.y * across.y, azimuth.y * across.x + azimuth.x * across.y, cos_theta_i);
    if lobe.is_coat {
        //? anisotropic
        let across_sq = luthier_coat_across_sq(prepared.coat, wi);
        //? else
        {
            let alpha = prepared.coat.alpha * LUTHIER_SLOPE_SCALE;
            let across_sq = max(sin_sq, 1e-12) * (alpha * alpha);
        }
        let masking = prepared.masking + luthier_slope_lambda(prepared.coat, across_sq, cos_theta_i);
        let fresnel = luthier_fresnel_term(prepared.coat, clamp(cos_theta_d, 0.0, 1.0));
        weight *= max(fresnel, vec3<f32>(1e-6)) * (max(cos_theta_d, 1e-3) / (wh.z * masking * prepared.wo.z));
    }
    let light = luthier_environment_around(frame * wi, width);
    return LuthierShown(shown.light + weight * light, shown.weight + weight);
}

/// Mean radiance in a lobe: in directions with weights, each blurred. Together the blurs are nearly the lobe, if it is a Gaussian.
fn luthier_shown_mean(lobe: LuthierShownLobe, prepared: LuthierPreparedLobes, frame: mat3x3<f32>) -> vec3<f32> {
    var shown = LuthierShown(vec3<f32>(0.0), vec3<f32>(1e-6));
    $each_direction
    return shown.light / shown.weight;
}

/// Mean radiance in the facets of the first interface.
fn luthier_shown_coat(prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec2<f32>) -> vec3<f32> {
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
    var coat = luthier_shown_lobe(prepared, 0.0, vec2<f32>(0.0), width, tail, turn);
    coat.is_coat = true;
    return luthier_shown_mean(coat, prepared, frame);
}

/// Standard deviation of the blur of a direction of the remainder, an angle.
const LUTHIER_WIDE_BLUR: f32 = 0.2;

/// Light that was read in some directions of the remainder: in its shape, and in that of a cosine.
struct LuthierShownWide {
    shaped: vec3<f32>,
    plain: vec3<f32>,
    weight: f32,
}

/// Light so far and that of one more direction of a cosine about the normal.
fn luthier_shown_wide_tap(shown: LuthierShownWide, prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec2<f32>, wi: vec3<f32>) -> LuthierShownWide {
    let turned = vec3<f32>(turn.x * wi.x - turn.y * wi.y, turn.y * wi.x + turn.x * wi.y, wi.z);
    let light = luthier_environment_around(frame * turned, LUTHIER_WIDE_BLUR);
    let shape = luthier_wide_shape(prepared, wi.z);
    return LuthierShownWide(shown.shaped + shape * light, shown.plain + light, shown.weight + shape);
}

/// Mean radiance in the remainder: the irradiance, and what its shape is brighter by in a few directions.
fn luthier_shown_wide(prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: vec2<f32>) -> vec3<f32> {
    var shown = LuthierShownWide(vec3<f32>(0.0), vec3<f32>(0.0), 1e-6);
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.968246, 0.000000, 0.250000));
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.664655, 0.608879, 0.433013));
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.072490, -0.825981, 0.559017));
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.456329, 0.595201, 0.661438));
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.651327, -0.115211, 0.750000));
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(0.471674, -0.300040, 0.829156));
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.112412, 0.418167, 0.901388));
    shown = luthier_shown_wide_tap(shown, prepared, frame, turn, vec3<f32>(-0.115227, -0.221862, 0.968246));
    let brighter = shown.shaped / shown.weight - 0.125 * shown.plain;
    return max(luthier_environment_diffuse(frame[2]) + brighter, vec3<f32>(0.0));
}

/// Radiance that a prepared material sends to the eye from a prefiltered environment. The columns of the frame are tangent, bitangent and normal in
/// the world of the environment. A turn in 0..1 moves the directions: samples of a pixel with turns of their own see more of them.
fn luthier_environment_lobes(prepared: LuthierPreparedLobes, frame: mat3x3<f32>, turn: f32) -> vec3<f32> {
    let angle = 2.0 * LUTHIER_PI * turn;
    let turned = vec2<f32>(cos(angle), sin(angle));
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
        total += first.energy * luthier_shown_mean(luthier_shown_below(prepared, first.shape, turned), prepared, frame);
    }
    //? two_lobes
    {
        let second = luthier_lobe_below(prepared, 1u);
        rest -= second.energy;
        total += second.energy * luthier_shown_mean(luthier_shown_below(prepared, second.shape, turned), prepared, frame);
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
