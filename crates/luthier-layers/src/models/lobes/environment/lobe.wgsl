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
    }
    //? else
    {
        /// Widths.
        width: vec2<f32>,
    }
    /// Angles outside over slopes about the middle.
    stretch: vec2<f32>,
    /// 1 over the decay: near 0 Beckmann's distribution, 1 that of GGX.
    tail: f32,
    /// Whether facets of the first interface weigh the directions.
    is_coat: bool,
}

/// A direction of a lobe.
struct LuthierShownPlace {
    /// The direction outside.
    wi: vec3<f32>,
    /// Its cosine; below 0 where light does not leave.
    above: f32,
    /// Angles outside over slopes.
    stretch: vec2<f32>,
    /// Light that facets of the first interface reflect in a direction, over the density of their slopes; 1 in lobes from below.
    weight: vec3<f32>,
}

/// Light that was read in some directions of a lobe, and the weights of these.
struct LuthierShown {
    light: vec3<f32>,
    weight: vec3<f32>,
}

/// A direction of a blur, the standard deviation of the blur, an angle, and the share of its light that is above the horizon.
struct LuthierShownBlur {
    wi: vec3<f32>,
    width: f32,
    share: f32,
}

/// A blur about a place, as far as it is above the horizon: the mean of a Gaussian that is cut there, and its standard deviation across the horizon, which is
/// read in all directions. An exponential stands for the hazard of the normal distribution: from half a standard deviation below the horizon on it is
/// within .012, and within .1 from one below.
fn luthier_shown_above(place: LuthierShownPlace, width: f32) -> LuthierShownBlur {
    let above = max(place.above / max(width, 0.014), -1.0);
    let hazard = 0.8 * exp(-above * (0.8 + 0.22 * above));
    let raised = above + hazard;
    let z = min(max(width * raised, place.wi.z), 1.0);
    let across = place.wi.xy * sqrt(max(1.0 - z * z, 0.0) / max(dot(place.wi.xy, place.wi.xy), 1e-12));
    let share = saturate(0.5 + 0.4 * place.above / max(width, 0.014));
    return LuthierShownBlur(vec3<f32>(across, z), width * sqrt(1.0 - hazard * raised), share);
}

/// Angles between directions outside over differences of slopes, in the plane of the eye and across it.
fn luthier_shown_stretch(up_z: f32, cos_theta_i: f32, cos_theta_d: f32, cos_theta_h: f32) -> vec2<f32> {
    return 2.0 * cos_theta_h * vec2<f32>(cos_theta_h * max(up_z, 0.0) / max(cos_theta_i, 0.02), max(cos_theta_d, 1e-3));
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
fn luthier_shown_lobe(prepared: LuthierPreparedLobes, excess: f32, middle: vec2<f32>, width_sq: vec3<f32>, tail: f32) -> LuthierShownLobe {
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
    lobe.stretch = max(luthier_shown_middle_stretch(lobe), vec2<f32>(1e-3));
    return lobe;
}
//? else
/// A lobe with this middle and these widths, seen in a medium whose squared index less 1 is the excess.
fn luthier_shown_lobe(prepared: LuthierPreparedLobes, excess: f32, middle: vec2<f32>, width: vec2<f32>, tail: f32) -> LuthierShownLobe {
    var lobe: LuthierShownLobe;
    lobe.eye = vec3<f32>(dot(prepared.azimuth, prepared.wo.xy), 0.0, sqrt(prepared.wo.z * prepared.wo.z + excess));
    lobe.middle = middle;
    lobe.width = width;
    lobe.tail = tail;
    lobe.is_coat = false;
    lobe.stretch = max(luthier_shown_middle_stretch(lobe), vec2<f32>(1e-3));
    return lobe;
}

/// A lobe of rows.
fn luthier_shown_below(prepared: LuthierPreparedLobes, shape: LuthierLobeShape) -> LuthierShownLobe {
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
    return luthier_shown_lobe(prepared, prepared.medium.x, middle, width, 1.0 / shape.decay);
}

/// The direction of a lobe at a slope.
fn luthier_shown_place(lobe: LuthierShownLobe, prepared: LuthierPreparedLobes, slope: vec2<f32>) -> LuthierShownPlace {
    var place: LuthierShownPlace;
    let wh = vec3<f32>(slope, 1.0) * inverseSqrt(1.0 + dot(slope, slope));
    let cos_theta_d = dot(wh, lobe.eye);
    let up = 2.0 * cos_theta_d * wh - lobe.eye;
    let sin_sq = dot(up.xy, up.xy);
    place.above = select(-1.0, 1.0, sin_sq < 1.0 && up.z > 0.0) * sqrt(abs(1.0 - sin_sq));
    let cos_theta_i = max(place.above, 1e-2);
    let across = up.xy * min(inverseSqrt(max(sin_sq, 1e-12)), 1.0);
    place.stretch = luthier_shown_stretch(up.z, cos_theta_i, cos_theta_d, wh.z);
    //? lobes_axes
    let azimuth = lobe.azimuth;
    //? else
    let azimuth = prepared.azimuth;
    place.wi = vec3<f32>(azimuth.x * across.x - azimuth.y * across.y, azimuth.y * across.x + azimuth.x * across.y, cos_theta_i);
    place.weight = vec3<f32>(1.0);
    if lobe.is_coat {
        //? anisotropic
        let across_sq = luthier_coat_across_sq(prepared.coat, place.wi);
        //? else
        {
            let alpha = prepared.coat.alpha * LUTHIER_SLOPE_SCALE;
            let across_sq = max(sin_sq, 1e-12) * (alpha * alpha);
        }
        let masking = prepared.masking + luthier_slope_lambda(prepared.coat, across_sq, cos_theta_i);
        let fresnel = luthier_first_reflectance(prepared, clamp(cos_theta_d, 0.0, 1.0));
        place.weight = max(fresnel, vec3<f32>(1e-6)) * (max(cos_theta_d, 1e-3) / (wh.z * masking * prepared.wo.z));
    }
    return place;
}
