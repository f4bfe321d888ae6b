/// Lobes from below that rows have.
//? three_lobes
const LUTHIER_LOBES: u32 = 3u;
//? else
//? two_lobes
const LUTHIER_LOBES: u32 = 2u;
//? else
//? one_lobe
const LUTHIER_LOBES: u32 = 1u;
//? else
const LUTHIER_LOBES: u32 = 0u;
/// Marks beside the number of lobes in the words of a material: layers below a coat have lobes of their own, a polynomial reflectance, one width, a short lobe.
const LUTHIER_OVER_SIDE: u32 = 4u;
const LUTHIER_CURVED: u32 = 8u;
const LUTHIER_ONE_WIDTH: u32 = 16u;
const LUTHIER_SHORT: u32 = 32u;

/// The part of rows that is the albedo. A third lobe has the parts after it.
//? lobes_one_width, !~lobes_one_width
const LUTHIER_LOBES_ALBEDO: f32 = 2.0;
//? else
const LUTHIER_LOBES_ALBEDO: f32 = f32(1u + 2u * min(LUTHIER_LOBES, 2u));
/// The part of rows of two lobes that has their decays and shares.
const LUTHIER_LOBES_SHARES: f32 = 4.0;
/// The parts of rows that are what layers send back to a diffuse base, and the light of that base.
const LUTHIER_LOBES_INTERNAL: f32 = -2.0;
const LUTHIER_LOBES_BASE: f32 = -1.0;

/// A lobe over slopes: elliptic, in the plane of the eye and across it, or in axes.
struct LuthierLobeShape {
    /// The sharpness times the slope of its middle.
    //? lobes_axes|lobes_tilted
    middle: vec2<f32>,
    //? else
    middle: f32,
    /// Its sharpness, 1 over its widths.
    sharpness: vec2<f32>,
    /// The number of the symmetric matrix of the sharpness between the axes.
    shear: f32,
    /// Its decay z, from 1 for GGX to Gaussians.
    decay: f32,
    /// Half its greatest density.
    peak: f32,
    //? lobes_tilted
    {
        /// Factor on its strength, and on its energy, where layers are tilted.
        gain: f32,
        left: f32,
    }
}

/// A material of the model as seen from a direction: what can be kept for all lights.
struct LuthierPreparedLobes {
    /// The first interface.
    coat: LuthierLayer,
    /// The eye.
    wo: vec3<f32>,
    /// Tile of its rows, and the cosine at which they are read.
    row: vec2<f32>,
    //? lobes_tints
    /// Tiles from that to those of the energies of each channel.
    tints: vec3<f32>,
    /// 1 + Lambda of the eye.
    masking: f32,
    /// Cosine and sine of the azimuth of the frame of the lobes: the plane of the eye, or axes.
    azimuth: vec2<f32>,
    /// Cosine of the refracted eye times the index.
    inside_cos: f32,
    /// The index squared less 1, the coefficients of the remainder's shape, and 1 over its integral.
    medium: vec4<f32>,
    /// Numbers of the cosine inside, see `luthier_inside_cosine`.
    inside: vec4<f32>,
    /// Energy of the remainder, RGB.
    wide: vec3<f32>,
    /// The part of it by which a base of another colour is brighter, RGB.
    painted: vec3<f32>,
    //? lobes_lean
    {
        /// Energy of the light that meets the base from one direction, RGB, and coordinates of the normal of the base along the first interface.
        leaning: vec3<f32>,
        lean: vec2<f32>,
    }
    //? lobes_curve
    {
        /// Numbers of the reflectance of the first interface, see `luthier_curve_reflectance`.
        reflectance: vec4<f32>,
        //? ~lobes_curve
        /// Whether it has them.
        is_curved: bool,
        /// Of a first interface of GGX: its squared slope parameter, 1 less that, and 2 pi times that square times a root of the cosine of the eye and times the cosine.
        coat_roots: vec4<f32>,
    }
    //? lobes_short, !~lobes_short
    /// Numbers of the lobe as a quadratic form, see `luthier_light_lobes`.
    form: vec4<f32>,
    /// Share of the surface that the first interface covers.
    cover: f32,
    /// The layer that is bare elsewhere, and 1 + Lambda of the eye there.
    bare: LuthierLayer,
    bare_masking: f32,
    /// Energy of the remainder that a bare diffuse base has, RGB.
    base: vec3<f32>,
    //? lobes_family
    /// Directional albedo, RGB.
    albedo: vec3<f32>,
    //? lobes_family
    /// Shares of the lobes above the horizon.
    shares: vec2<f32>,
    /// Energy of the first lobe over its share above the horizon, RGB.
    first_strength: vec3<f32>,
    first_shape: LuthierLobeShape,
    /// Energy of the second lobe over its share above the horizon, RGB.
    second_strength: vec3<f32>,
    second_shape: LuthierLobeShape,
    //? three_lobes
    {
        /// Energy of the third lobe over its share above the horizon, RGB, and that share.
        third_strength: vec3<f32>,
        third_share: f32,
        third_shape: LuthierLobeShape,
    }
}

//? beckmann
/// A factor on slopes in `luthier_slope_lambda`, with which exp2(-1 / slope^2) is the exponential of Beckmann's.
const LUTHIER_SLOPE_SCALE: f32 = 0.84143657;
//? else
const LUTHIER_SLOPE_SCALE: f32 = 1.0;

/// Smith's Lambda of a direction by its cosine and by `luthier_coat_across_sq` (Walter et al. 2007, eq. 34 for GGX). That of Beckmann is an exponential
/// over a polynomial; 1 + 2 Lambda is within 2e-6 of itself at all slopes.
fn luthier_slope_lambda(coat: LuthierLayer, across_sq: f32, cos_theta: f32) -> f32 {
    //? beckmann
    {
        //? ggx
        if coat.distribution > 0.5 {
            let inverse_cos = 1.0 / (LUTHIER_SLOPE_SCALE * cos_theta);
            return 0.5 * sqrt(1.0 + across_sq * inverse_cos * inverse_cos) - 0.5;
        }
        let inverse = cos_theta * inverseSqrt(across_sq);
        let poly = 2.982824 + inverse * (4.4479934 + inverse * (2.4605687 + inverse * 0.49868596));
        return exp2(-inverse * inverse) / (inverse * poly);
    }
    //? else
    {
        let inverse_cos = 1.0 / cos_theta;
        return 0.5 * sqrt(1.0 + across_sq * inverse_cos * inverse_cos) - 0.5;
    }
}

/// The square of the slope parameter of a coat along a direction times the sine of its angle times `LUTHIER_SLOPE_SCALE`; so far from 0 that nothing in
/// `luthier_slope_lambda` is infinite.
fn luthier_coat_across_sq(coat: LuthierLayer, w: vec3<f32>) -> f32 {
    //? anisotropic
    {
        let across = luthier_stretched(coat, coat.alpha_xy * LUTHIER_SLOPE_SCALE, w);
        return 1e-18 + across.x * across.x + across.y * across.y;
    }
    //? else
    {
        let alpha = coat.alpha * LUTHIER_SLOPE_SCALE;
        return (1e-12 + w.x * w.x + w.y * w.y) * (alpha * alpha);
    }
}

/// The cosine of a refracted direction where a medium reflects flat light totally: its kink at the critical angle is rounded off, and it goes
/// from 0 at the horizon to 1 at the normal. The numbers: squared cosine of the angle, four times the squared width of the kink, factor
/// and offset.
fn luthier_inside_cosine(inside: vec4<f32>, cos_theta: f32) -> f32 {
    //? ~critical_view
    if inside.x == 0.0 {
        return cos_theta;
    }
    let beyond = cos_theta * cos_theta - inside.x;
    let root = sqrt(max(beyond + sqrt(beyond * beyond + inside.y), 0.0));
    return root * inside.z + inside.w;
}

/// Squared cosine of a refracted direction times the squared index; not 0.
fn luthier_inside_cos_sq(medium: vec4<f32>, cos_theta: f32) -> f32 {
    return max(cos_theta * cos_theta + medium.x, 1e-12);
}

/// A lobe whose slopes are so many times as steep, and then have twice a variance more.
fn luthier_spread(given: LuthierLobeShape, factor: f32, twice_variance: f32) -> LuthierLobeShape {
    var shape = given;
    shape.sharpness = given.sharpness / factor;
    //? lobes_axes
    shape.shear = given.shear / factor;
    //? surface
    {
        // Squared widths are 1 / (z x^2).
        let excess = twice_variance * shape.decay;
        //? lobes_axes
        {
            // As a matrix, about its mean: the share of either end of the ellipse that is left.
            let mean = 0.5 * (shape.sharpness.x + shape.sharpness.y);
            let about = vec2<f32>(0.5 * (shape.sharpness.x - shape.sharpness.y), shape.shear);
            let radius = sqrt(dot(about, about));
            let ends = mean + vec2<f32>(radius, -radius);
            let left = inverseSqrt(1.0 + excess * ends * ends);
            let level = 0.5 * (left.x + left.y);
            let steep = 0.5 * (left.x - left.y) / max(radius, 1e-9 * mean);
            let m = shape.middle;
            shape.middle = level * m + steep * vec2<f32>(about.x * m.x + about.y * m.y, about.y * m.x - about.x * m.y);
            let next = (level + steep * mean) * about;
            shape.sharpness = level * mean + steep * radius * radius + vec2<f32>(next.x, -next.x);
            shape.shear = next.y;
        }
        //? else
        {
            let left = inverseSqrt(1.0 + excess * shape.sharpness * shape.sharpness);
            shape.middle *= left.x;
            shape.sharpness *= left;
        }
    }
    return shape;
}

/// Determinant of the sharpness.
fn luthier_lobe_determinant(shape: LuthierLobeShape) -> f32 {
    let product = shape.sharpness.x * shape.sharpness.y;
    // Rounding may leave no ellipse.
    return max(product - shape.shear * shape.shear, 1e-4 * product);
}

/// The slope at which the sharpness times the slope from the middle is so much.
fn luthier_lobe_slope(shape: LuthierLobeShape, apart: vec2<f32>) -> vec2<f32> {
    //? lobes_axes
    {
        let scaled = shape.middle + apart;
        return (shape.sharpness.yx * scaled - shape.shear * scaled.yx) / luthier_lobe_determinant(shape);
    }
    //? else
    //? lobes_tilted
    return (shape.middle + apart) / shape.sharpness;
    //? else
    return vec2<f32>(shape.middle + apart.x, apart.y) / shape.sharpness;
}

/// A lobe of a row: its shift, its sharpness and decay, and the shear of its sharpness, as seen by an eye with coordinates along the surface in its frame.
fn luthier_lobe_in_axes(shift: f32, numbers: vec3<f32>, shear: f32, eye: vec2<f32>, is_turned: bool) -> LuthierLobeShape {
    var shape: LuthierLobeShape;
    // In axes the middle is the adjugate of the sharpness times the eye.
    let turned = numbers.yx * eye - shear * eye.yx;
    shape.middle = shift * select(vec2<f32>(numbers.x * eye.x, 0.0), turned, is_turned);
    shape.shear = shear;
    shape.sharpness = numbers.xy;
    shape.decay = numbers.z;
    return shape;
}

/// A lobe of a row: its shift, its sharpness and decay, as seen by an eye at an angle of this sine.
fn luthier_lobe_shape(shift: f32, numbers: vec3<f32>, sin_theta: f32) -> LuthierLobeShape {
    var shape: LuthierLobeShape;
    //? lobes_tilted
    shape.middle = vec2<f32>(shift * sin_theta * numbers.x, 0.0);
    //? else
    shape.middle = shift * sin_theta * numbers.x;
    shape.sharpness = numbers.xy;
    shape.decay = numbers.z;
    return shape;
}

/// A lobe without light.
fn luthier_dark_lobe() -> LuthierLobeShape {
    var shape: LuthierLobeShape;
    shape.sharpness = vec2<f32>(1.0);
    shape.decay = 1.0;
    return shape;
}

/// The lobe with its greatest density: z / pi times the determinant of the sharpness.
fn luthier_with_peak(given: LuthierLobeShape) -> LuthierLobeShape {
    var shape = given;
    //? lobes_axes
    shape.peak = luthier_lobe_determinant(given) * given.decay * (0.5 / LUTHIER_PI);
    //? else
    shape.peak = given.sharpness.x * given.sharpness.y * given.decay * (0.5 / LUTHIER_PI);
    return shape;
}

/// Tiles of rows from the first to the azimuth of an eye in axes, of which a quarter of a circle has so many; and the sign of the shear there.
/// With v, the tangent of the angle from the diagonal, tiles are nearly at equal angles.
fn luthier_lobes_azimuth(eye: vec2<f32>, quarter: f32) -> vec2<f32> {
    let size = abs(eye.x) + abs(eye.y);
    let v = (abs(eye.y) - abs(eye.x)) / max(size, 1e-20);
    let place = quarter * (0.5 + 0.5 * v * (1.241 - 0.241 * v * v));
    let is_crossed = eye.x * eye.y < 0.0;
    // Of a stack that is its own mirror image a quarter has all seven, of others half of them: these go over two quarters.
    let is_mirrored = quarter > 5.0;
    let tiles = select(place, 2.0 * quarter - place, is_crossed && !is_mirrored);
    return vec2<f32>(select(0.0, tiles, size > 0.0), select(1.0, -1.0, is_crossed && is_mirrored));
}


/// A direction along the surface, in a frame of this azimuth.
fn luthier_in_frame(azimuth: vec2<f32>, across: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(dot(azimuth, across), azimuth.x * across.y - azimuth.y * across.x);
}

//? lobes_tints
/// A part of a row whose RGB are energies, read for each channel at a tile of its own; A is that of the row.
fn luthier_lookup_tinted(row: vec2<f32>, tints: vec3<f32>, part: f32) -> vec4<f32> {
    let read = luthier_lookup_lobes(row.x, row.y, part);
    if dot(tints, tints) > 0.0 {
        let red = luthier_lookup_lobes(row.x + tints.x, row.y, part).x;
        let green = luthier_lookup_lobes(row.x + tints.y, row.y, part).y;
        let blue = luthier_lookup_lobes(row.x + tints.z, row.y, part).z;
        return vec4<f32>(red, green, blue, read.w);
    }
    return read;
}

//? lobes_base
/// A material whose rows have the light of its diffuse base apart, with the colour that this base has at a place.
fn luthier_over_base(given: LuthierPreparedLobes, $place_parameter material: u32, painted_word: vec4<f32>) -> LuthierPreparedLobes {
    var prepared = given;
    //? lobes_tints
    {
        let of_internal = luthier_lookup_tinted(given.row, given.tints, LUTHIER_LOBES_INTERNAL);
        let of_base = luthier_lookup_tinted(given.row, given.tints, LUTHIER_LOBES_BASE);
    }
    //? else
    {
        let of_internal = luthier_lookup_lobes(given.row.x, given.row.y, LUTHIER_LOBES_INTERNAL);
        let of_base = luthier_lookup_lobes(given.row.x, given.row.y, LUTHIER_LOBES_BASE);
    }
    if painted_word.w < -1.5 {
        // Over a factor the shape of the remainder, that of the light of a Lambertian base, changes with it.
        let falloff = vec2<f32>(of_base.a, of_internal.a);
        let moments = luthier_materials[luthier_header(material) + $word_patina_diffuse_albedo].xy;
        let integral = 1.0 - dot(falloff, moments);
        prepared.medium = vec4<f32>(prepared.medium.x, falloff, (1.0 / LUTHIER_PI) / integral);
    }
    //? base_color
    if place.base_color.x >= 0.0 {
        // The base has its light times R / (1 - r R), r being what the layers send back; rows have that of the albedo of the material.
        let own = max(painted_word.rgb, vec3<f32>(1e-6)) * max(1.0 - of_internal.rgb * place.base_color, vec3<f32>(1e-3));
        let other = place.base_color * (1.0 - of_internal.rgb * painted_word.rgb);
        prepared.painted = max(of_base.rgb * (other / own - 1.0), -given.wide);
        prepared.wide += prepared.painted;
    }
    //? lobes_lean
    {
        // Light that the layers send back to the base has no direction. The rest meets the base by its cosine to the normal of the base.
        //? base_color
        let color = select(painted_word.rgb, place.base_color, place.base_color.x >= 0.0);
        //? else
        let color = painted_word.rgb;
        let met = of_base.rgb * max(1.0 - of_internal.rgb * painted_word.rgb, vec3<f32>(0.0));
        prepared.leaning = met * color / max(painted_word.rgb, vec3<f32>(1e-6));
        let normal = luthier_own_normal(place, luthier_layer_count(material) - 1u);
        let lost = (1.0 - normal.z) * prepared.leaning;
        prepared.lean = normal.xy;
        prepared.wide -= lost;
        prepared.painted -= lost;
    }
    return prepared;
}

//? ~lobes_one_width
/// Sharpness along the plane of the eye and across it, and the decay, of a lobe of one width, which rows have, or of a short lobe.
fn luthier_numbers_by_view(header: u32, form: u32, width: f32, sin_theta_sq: f32) -> vec3<f32> {
    //? ~lobes_short
    if (form & LUTHIER_SHORT) != 0u {
        let widths = luthier_materials[header + $word_phong_specular];
        let along = widths.x + sin_theta_sq * (widths.y + sin_theta_sq * widths.z);
        return vec3<f32>(along, along * (1.0 + widths.w * sin_theta_sq), 1.0);
    }
    let sheet = luthier_materials[header + $word_glitter_tilt];
    return vec3<f32>(width, width * (1.0 + sheet.z * sin_theta_sq), sheet.y);
}

//? !lobes_family|~lobes_family
/// A material as seen from wo, above the horizon.
fn luthier_prepare_lobes($place_parameter material: u32, wo: vec3<f32>) -> LuthierPreparedLobes {
    //? ~lobes_family
    if luthier_is_family(material) {
        return luthier_prepare_family($place_argument material, wo);
    }
    let header = luthier_header(material);
    //? place
    {
        // Rows over a factor lie one below the other, at equal distances of its root from 1: to 0 on the slab, to a step before it on slopes.
        let over = luthier_materials[header + $word_phong_diffuse];
        //? lobes_tints
        {
            // Each channel has a factor of its own on what the slab absorbs. Shapes are those of their mean.
            let slabs = 1.0 - sqrt(saturate(place.slab_factor * luthier_own_place(place, 0u).absorption_factors));
            let slab = dot(slabs, vec3<f32>(1.0 / 3.0));
            let tints = (slabs - slab) * over.y;
        }
        //? lobes_film
        {
            // Or at equal distances of the factor on the film, from the greatest to the least.
            let sheet = luthier_materials[header + $word_glitter_tilt];
            //? lobes_tints
            let roots = vec2<f32>(1.0 - sqrt(saturate(place.alpha_factor)), slab);
            //? else
            let roots = 1.0 - sqrt(saturate(vec2<f32>(place.alpha_factor, place.slab_factor)));
            let away = vec2<f32>(roots.x, select(roots.y, saturate(place.film_factor * sheet.y + sheet.z), sheet.w < 0.0));
        }
        //? else
        //? lobes_tints
        let away = vec2<f32>(1.0 - sqrt(saturate(place.alpha_factor)), slab);
        //? else
        let away = 1.0 - sqrt(saturate(vec2<f32>(place.alpha_factor, place.slab_factor)));
        //? lobes_patina
        {
            // Of the last two tiles one is that of all layers, and the other that of the bare ones.
            let bare_tile = luthier_materials[header + $word_patina_tarnish].w;
            //? weight
            let amount = luthier_cover(place, material);
            //? else
            let amount = place.patina;
            let is_covered = bare_tile > 0.0 && amount >= 0.0;
            let cover = select(1.0, saturate(amount), is_covered);
            let nominal_tile = luthier_materials[header].w + min(away.x * (over.x + 1.0), over.x) + away.y * over.y;
            let first_tile = nominal_tile + select(0.0, bare_tile - cover, is_covered);
        }
        //? else
        let first_tile = luthier_materials[header].w + min(away.x * (over.x + 1.0), over.x) + away.y * over.y;
        let spread = max(place.alpha_factor, over.z);
    }
    //? else
    let first_tile = luthier_materials[header].w;
    // Numbers of the tiles.
    //? lobes_axes, !lobes_film
    let sheet = luthier_materials[header + $word_glitter_tilt];
    // Along the normal the azimuth is 0.
    let across = vec2<f32>(wo.x + 1e-15, wo.y);
    let sin_theta_sq = dot(across, across);
    let inverse_sin = inverseSqrt(sin_theta_sq);
    let sin_theta = sin_theta_sq * inverse_sin;
    var prepared: LuthierPreparedLobes;
    prepared.coat = $layer(material, 0u);
    prepared.wo = wo;
    //? anisotropic
    prepared.masking = 1.0 + luthier_slope_lambda(prepared.coat, luthier_coat_across_sq(prepared.coat, wo), wo.z);
    //? else
    {
        let alpha = prepared.coat.alpha * LUTHIER_SLOPE_SCALE;
        prepared.masking = 1.0 + luthier_slope_lambda(prepared.coat, sin_theta_sq * (alpha * alpha) + 1e-18, wo.z);
    }
    //? lobes_patina
    {
        prepared.cover = cover;
        prepared.bare = prepared.coat;
        prepared.bare_masking = prepared.masking;
    }
    //? lobes_patina
    if cover < 1.0 {
        var bare_place = place;
        bare_place.patina = -1.0;
        //? base_color
        bare_place.base_color = vec3<f32>(-1.0);
        prepared.bare = luthier_layer_at(bare_place, material, luthier_layer_count(material));
        prepared.bare_masking = 1.0 + luthier_slope_lambda(prepared.bare, luthier_coat_across_sq(prepared.bare, wo), wo.z);
    }
    //? ~lobes_axes
    {
        prepared.azimuth = across * inverse_sin;
        var eye = vec2<f32>(sin_theta, 0.0);
        var around = vec2<f32>(0.0);
        if sheet.w > 0.0 {
            prepared.azimuth = sheet.yz;
            eye = luthier_in_frame(prepared.azimuth, wo.xy);
            around = luthier_lobes_azimuth(eye, sheet.w);
        }
        let tile = first_tile + around.x;
    }
    //? else
    //? lobes_axes
    {
        prepared.azimuth = sheet.yz;
        let eye = luthier_in_frame(prepared.azimuth, wo.xy);
        let around = luthier_lobes_azimuth(eye, sheet.w);
        let tile = first_tile + around.x;
    }
    //? else
    {
        prepared.azimuth = across * inverse_sin;
        let tile = first_tile;
    }
    //? lobes_mixed|~lobes_one_width|~lobes_curve
    let form = u32(luthier_materials[header + $word_patina_diffuse_albedo].w);
    //? lobes_short, !~lobes_short
    {
        let medium = luthier_materials[header + $word_veil];
        prepared.medium = vec4<f32>(medium.x, 0.0, 0.0, 1.0 / LUTHIER_PI);
        prepared.reflectance = vec4<f32>(medium.yzw, 1.0 - medium.y - medium.z - medium.w);
    }
    //? else
    {
        prepared.medium = luthier_materials[header + $word_veil];
        //? lobes_curve
        prepared.reflectance = luthier_materials[header + $word_phong_specular];
        //? ~lobes_curve
        prepared.is_curved = (form & LUTHIER_CURVED) != 0u;
        //? ~lobes_short
        if (form & LUTHIER_SHORT) != 0u {
            // A short lobe has its widths there, and its reflectance in place of a remainder.
            let curve = prepared.medium.yzw;
            prepared.reflectance = vec4<f32>(curve, 1.0 - curve.x - curve.y - curve.z);
            prepared.medium = vec4<f32>(prepared.medium.x, 0.0, 0.0, 1.0 / LUTHIER_PI);
        }
    }
    //? lobes_curve, !~lobes_curve, !beckmann, !free_slopes
    {
        let alpha_sq = 1.0 / prepared.coat.falloff;
        let left = 1.0 - alpha_sq;
        let area = 2.0 * LUTHIER_PI * alpha_sq;
        prepared.coat_roots = vec4<f32>(alpha_sq, left, area * sqrt(alpha_sq + wo.z * wo.z * left), area * wo.z);
    }
    prepared.inside_cos = sqrt(luthier_inside_cos_sq(prepared.medium, wo.z));
    //? lobes_tilted
    //? one_lobe|two_lobes
    {
        // Half vectors in the slab are shifted by the slope of the normal, those in another medium as much as the mirror direction is.
        let turned = luthier_slope_below(place, material);
        let is_tilted = turned.x != 0.0 || turned.y != 0.0;
        var tilt = vec2<f32>(0.0);
        var disc = vec3<f32>(0.0);
        if is_tilted {
            let slab_cos = sqrt(max(prepared.coat.eta * prepared.coat.eta - sin_theta_sq, 0.0));
            tilt = luthier_in_frame(prepared.azimuth, turned * (slab_cos / prepared.inside_cos));
            disc = luthier_leaving_disc(prepared);
        }
    }
    //? critical_view
    {
        prepared.inside = luthier_materials[header + $word_phong_specular];
        //? ~lobes_curve
        if prepared.is_curved {
            // No critical angle: the cosine itself.
            prepared.inside = vec4<f32>(0.0, 0.0, 0.70710678, 0.0);
        }
        // Rows are over a mean of it and of a cosine outside that is steeper at the horizon.
        let plain = wo.z * (1.25 / (wo.z + 0.25));
        let cos_theta = mix(luthier_inside_cosine(prepared.inside, wo.z), plain, luthier_materials[header + $word_phong_diffuse].w);
    }
    //? else
    let cos_theta = wo.z;
    prepared.row = vec2<f32>(tile, cos_theta);
    //? lobes_tints
    prepared.tints = tints;
    //? ~lobes_short
    {
        var wide = vec4<f32>(0.0);
        if (form & LUTHIER_SHORT) == 0u {
            //? lobes_tints
            wide = luthier_lookup_tinted(prepared.row, tints, 0.0);
            //? else
            wide = luthier_lookup_lobes(tile, cos_theta, 0.0);
        }
    }
    //? else
    //? lobes_tints
    let wide = luthier_lookup_tinted(prepared.row, tints, 0.0);
    //? else
    //? !lobes_short
    let wide = luthier_lookup_lobes(tile, cos_theta, 0.0);
    //? lobes_short, !~lobes_short
    prepared.wide = vec3<f32>(0.0);
    //? else
    prepared.wide = wide.rgb;
    //? lobes_base
    {
        // Rows have a diffuse base apart. Under patina this word is patina's.
        let painted_word = luthier_materials[header + $word_patina];
        //? ~lobes_base
        if painted_word.w < 0.0 {
            prepared = luthier_over_base(prepared, $place_argument material, painted_word);
        }
        //? else
        prepared = luthier_over_base(prepared, $place_argument material, painted_word);
    }
    //? lobes_family
    {
        //? lobes_tints
        prepared.albedo = luthier_lookup_tinted(prepared.row, tints, LUTHIER_LOBES_ALBEDO).rgb + prepared.painted;
        //? else
        prepared.albedo = luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_ALBEDO).rgb + prepared.painted;
        //? two_lobes
        prepared.shares = luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_SHARES).yw;
        //? else
        //? one_lobe
        prepared.shares = vec2<f32>(luthier_lookup_lobes(tile, cos_theta, 2.0).a, 0.0);
    }
    //? lobes_bare_base
    if cover < 1.0 && prepared.bare.kind == LUTHIER_DIFFUSE {
        prepared.base = (1.0 - cover) * luthier_lookup_lobes(nominal_tile + bare_tile, cos_theta, 0.0).rgb;
    }
    //? one_lobe|two_lobes
    {
        //? surface
        {
            // A normal that leans by a slope shifts half vectors by as much of it as directions lean outside over those inside.
            let leaning = wo.z / prepared.inside_cos;
            let unresolved = 2.0 * max(place.slope_variance, 0.0) * leaning * leaning;
        }
        //? else
        //? place
        let unresolved = 0.0;
        //? lobes_mixed
        {
            let lobes = form & 3u;
            prepared.first_shape = luthier_dark_lobe();
            //? two_lobes
            prepared.second_shape = luthier_dark_lobe();
            //? three_lobes
            prepared.third_shape = luthier_dark_lobe();
        }
        //? lobes_mixed
        if lobes == 0u {
            return prepared;
        }
        //? lobes_tints
        let first = luthier_lookup_tinted(prepared.row, tints, 1.0);
        //? else
        let first = luthier_lookup_lobes(tile, cos_theta, 1.0);
        prepared.first_strength = first.rgb;
        //? two_lobes
        {
            //? ~lobes_one_width
            {
                let has_own = (form & (LUTHIER_ONE_WIDTH | LUTHIER_SHORT)) == 0u;
                var sharpness = vec4<f32>(0.0);
                if has_own {
                    sharpness = luthier_lookup_lobes(tile, cos_theta, 3.0);
                }
            }
            //? else
            let sharpness = luthier_lookup_lobes(tile, cos_theta, 3.0);
            // Rows of one tile have one decay for each lobe.
            //? !lobes_axes, !lobes_film, !lobes_rows|~lobes_rows
            let sheet = luthier_materials[header + $word_glitter_tilt];
            //? ~lobes_rows
            {
                var decays = sheet.yz;
                if sheet.w != 0.0 || sheet.y == 0.0 {
                    decays = luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_SHARES).xz;
                }
            }
            //? else
            //? lobes_rows
            let decays = luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_SHARES).xz;
            //? else
            let decays = sheet.yz;
            //? ~lobes_one_width
            {
                var first_numbers = vec3<f32>(sharpness.xy, decays.x);
                if !has_own {
                    first_numbers = luthier_numbers_by_view(header, form, wide.a, sin_theta_sq);
                }
            }
            //? else
            let first_numbers = vec3<f32>(sharpness.xy, decays.x);
            //? lobes_tilted
            var shares = vec2<f32>(1.0);
            //? lobes_tilted
            if is_tilted {
                shares = luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_SHARES).yw;
            }
        }
        //? else
        //? ~lobes_one_width
        {
            let has_own = (form & (LUTHIER_ONE_WIDTH | LUTHIER_SHORT)) == 0u;
            var numbers = vec4<f32>(1.0);
            //? lobes_tilted
            if has_own || is_tilted {
                numbers = luthier_lookup_lobes(tile, cos_theta, 2.0);
            }
            //? else
            if has_own {
                numbers = luthier_lookup_lobes(tile, cos_theta, 2.0);
            }
            var first_numbers = numbers.rgb;
            if !has_own {
                first_numbers = luthier_numbers_by_view(header, form, wide.a, sin_theta_sq);
            }
            //? lobes_tilted
            let shares = numbers.aa;
        }
        //? else
        //? lobes_one_width
        {
            //? lobes_short
            {
                // Both widths follow from the view.
                let widths = luthier_materials[header + $word_phong_specular];
                let along = widths.x + sin_theta_sq * (widths.y + sin_theta_sq * widths.z);
                let first_numbers = vec3<f32>(along, along * (1.0 + widths.w * sin_theta_sq), 1.0);
            }
            //? else
            {
                // One width is beside the remainder, and the share beside the albedo. The other width follows from the view.
                //? !lobes_film
                let sheet = luthier_materials[header + $word_glitter_tilt];
                let first_numbers = vec3<f32>(wide.a, wide.a * (1.0 + sheet.z * sin_theta_sq), sheet.y);
            }
            //? lobes_tilted
            var shares = vec2<f32>(1.0);
            //? lobes_tilted
            if is_tilted {
                shares = luthier_lookup_lobes(tile, cos_theta, 2.0).aa;
            }
        }
        //? else
        //? lobes_tilted
        {
            let numbers = luthier_lookup_lobes(tile, cos_theta, 2.0);
            let first_numbers = numbers.rgb;
            let shares = numbers.aa;
        }
        //? else
        let first_numbers = luthier_lookup_lobes(tile, cos_theta, 2.0).rgb;
        //? lobes_axes
        let first_shape = luthier_lobe_in_axes(first.a, first_numbers, around.y * wide.a, eye, sheet.w > 0.0);
        //? else
        let first_shape = luthier_lobe_shape(first.a, first_numbers, sin_theta);
        //? place
        {
            let first_spread = luthier_spread(first_shape, spread, unresolved);
            //? lobes_tilted
            {
                prepared.first_shape = luthier_with_peak(luthier_lobe_about(first_spread, tilt, shares.x, disc));
                prepared.first_strength *= prepared.first_shape.gain;
            }
            //? else
            prepared.first_shape = luthier_with_peak(first_spread);
        }
        //? else
        prepared.first_shape = luthier_with_peak(first_shape);
        //? lobes_short, !~lobes_short, !lobes_tilted
        {
            let shape = prepared.first_shape;
            let squares = shape.sharpness * shape.sharpness;
            let crossed = -2.0 * shape.sharpness.x * shape.middle;
            prepared.form = vec4<f32>(squares.y, 1.0 + shape.middle * shape.middle, squares.x - squares.y, crossed);
        }
    }
    //? two_lobes
    {
        //? lobes_mixed
        if lobes == 1u {
            return prepared;
        }
        //? lobes_tints
        let second = luthier_lookup_tinted(prepared.row, tints, 2.0);
        //? else
        let second = luthier_lookup_lobes(tile, cos_theta, 2.0);
        prepared.second_strength = second.rgb;
        let second_numbers = vec3<f32>(sharpness.zw, decays.y);
        //? lobes_axes
        {
            //? ~lobes_axes
            {
                var second_shear = 0.0;
                if sheet.w > 0.0 {
                    second_shear = around.y * luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_ALBEDO).a;
                }
            }
            //? else
            let second_shear = around.y * luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_ALBEDO).a;
            let second_shape = luthier_lobe_in_axes(second.a, second_numbers, second_shear, eye, sheet.w > 0.0);
        }
        //? else
        let second_shape = luthier_lobe_shape(second.a, second_numbers, sin_theta);
        //? place
        {
            let second_spread = luthier_spread(second_shape, spread, unresolved);
            //? lobes_tilted
            {
                // Over patina on an interface the second lobe is that of the bare layer, which flakes of the first do not cover.
                //? lobes_patina
                let second_tilt = select(tilt, vec2<f32>(0.0), cover < 1.0 && prepared.bare.kind != LUTHIER_DIFFUSE);
                //? else
                let second_tilt = tilt;
                prepared.second_shape = luthier_with_peak(luthier_lobe_about(second_spread, second_tilt, shares.y, disc));
                prepared.second_strength *= prepared.second_shape.gain;
            }
            //? else
            prepared.second_shape = luthier_with_peak(second_spread);
        }
        //? else
        prepared.second_shape = luthier_with_peak(second_shape);
    }
    //? three_lobes
    {
        //? lobes_mixed
        if lobes == 2u {
            return prepared;
        }
        // Rows over the view alone have a third lobe: no channel has rows of its own, and lobes are in the plane of the eye.
        let third = luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_ALBEDO + 1.0);
        let third_numbers = luthier_lookup_lobes(tile, cos_theta, LUTHIER_LOBES_ALBEDO + 2.0);
        prepared.third_strength = third.rgb;
        prepared.third_share = third_numbers.w;
        //? lobes_axes
        let third_shape = luthier_lobe_in_axes(third.a, third_numbers.xyz, 0.0, eye, false);
        //? else
        let third_shape = luthier_lobe_shape(third.a, third_numbers.xyz, sin_theta);
        //? place
        {
            let third_spread = luthier_spread(third_shape, spread, unresolved);
            //? lobes_tilted
            {
                prepared.third_shape = luthier_with_peak(luthier_lobe_about(third_spread, tilt, prepared.third_share, disc));
                prepared.third_strength *= prepared.third_shape.gain;
            }
            //? else
            prepared.third_shape = luthier_with_peak(third_spread);
        }
        //? else
        prepared.third_shape = luthier_with_peak(third_shape);
    }
    return prepared;
}
