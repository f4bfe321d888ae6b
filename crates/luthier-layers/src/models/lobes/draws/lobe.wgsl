//? one_lobe|two_lobes
{
    /// A lobe as it is drawn, see `LobeDraw` of the f64 twin.
    struct LuthierLobeDraw {
        /// Slope of the middle of the lobe.
        middle: vec2<f32>,
        /// Sharpness of what is drawn in a cap if that is round, or 0.
        circle: f32,
        /// Towards the middle of the cap, and cosine and sine of the angle there.
        towards: vec2<f32>,
        axis: vec2<f32>,
        /// Share of the sphere that is the cap; 0 if the lobe is drawn as it is.
        share: f32,
        /// Factor on the strength of the lobe for its chance.
        chance: f32,
    }

    /// Cosine and sine of half the angle of the cap about a circle, by the distance of its middle and by its radius, and of the angle of its middle.
    fn luthier_cap(away: f32, radius: f32) -> vec4<f32> {
        let near = away - radius;
        let far = away + radius;
        let scale = inverseSqrt((1.0 + near * near) * (1.0 + far * far));
        return scale * vec4<f32>(1.0 + near * far, 2.0 * radius, 1.0 - near * far, near + far);
    }

    /// Share of the sphere in a cap.
    fn luthier_cap_share(cap: vec4<f32>) -> f32 {
        return select(0.5 - 0.5 * cap.x, 0.5 * cap.y * cap.y / (1.0 + max(cap.x, 0.0)), cap.x > 0.0);
    }

    /// A slope in the widths of a lobe.
    fn luthier_in_widths(shape: LuthierLobeShape, slope: vec2<f32>) -> vec2<f32> {
        //? lobes_axes
        return sqrt(shape.decay) * (shape.sharpness * slope + shape.shear * slope.yx);
        //? else
        return sqrt(shape.decay) * shape.sharpness * slope;
    }

    /// One of Newton's steps towards the least cap, see `Cap::about` of the f64 twin.
    fn luthier_lesser_cap(u: f32, cubic: f32, linear: f32, along: f32) -> f32 {
        return u - (u * (cubic * u * u + linear) - 2.0 * along) / (3.0 * cubic * u * u + linear);
    }

    /// Middle and radius of the circle of the least cap about an ellipse: by the middle of the ellipse, the direction of its short axis, and its half axes. See
    /// `Cap::about` of the f64 twin.
    fn luthier_circle_about(middle: vec2<f32>, short: vec2<f32>, axes: vec2<f32>) -> vec3<f32> {
        let along = dot(middle, short);
        let excess = (axes.y - axes.x) * (axes.y + axes.x);
        let cubic = axes.x * axes.x * excess;
        let linear = 1.0 + dot(middle, middle) + 2.0 * axes.x * axes.x - axes.y * axes.y;
        var u = 1.0 / max(axes.x, linear / max(2.0 * abs(along), 1e-20));
        u = luthier_lesser_cap(u, cubic, linear, abs(along));
        u = luthier_lesser_cap(u, cubic, linear, abs(along));
        u = luthier_lesser_cap(u, cubic, linear, abs(along));
        u = luthier_lesser_cap(u, cubic, linear, abs(along));
        let moved = select(excess * u, -excess * u, along < 0.0);
        return vec3<f32>(middle + moved * short, axes.y * sqrt(1.0 + excess * u * u));
    }

    fn luthier_lobe_draw(prepared: LuthierPreparedLobes, shape: LuthierLobeShape) -> LuthierLobeDraw {
        var given: LuthierLobeDraw;
        given.middle = luthier_lobe_slope(shape, vec2<f32>(0.0));
        given.chance = 1.0;
        let disc = luthier_leaving_disc(prepared);
        let radius = disc.z;
        let apart = disc.xy - given.middle;
        //? lobes_axes
        {
            let lopsided = vec2<f32>(0.5 * (shape.sharpness.x - shape.sharpness.y), shape.shear);
            let most = sqrt(shape.decay) * (0.5 * (shape.sharpness.x + shape.sharpness.y) + length(lopsided));
            let least = shape.decay * luthier_lobe_determinant(shape) / most;
            // The direction of the greater sharpness has half the angle.
            let skew = length(lopsided);
            let turned = vec2<f32>(skew + abs(lopsided.x), lopsided.y);
            let greater = select(vec2<f32>(1.0, 0.0), normalize(select(turned.yx, turned, lopsided.x >= 0.0)), skew > 0.0);
            let short = vec2<f32>(-greater.y, greater.x);
        }
        //? else
        {
            let most = sqrt(shape.decay) * max(shape.sharpness.x, shape.sharpness.y);
            let least = sqrt(shape.decay) * min(shape.sharpness.x, shape.sharpness.y);
            let short = select(vec2<f32>(0.0, 1.0), vec2<f32>(1.0, 0.0), shape.sharpness.x < shape.sharpness.y);
        }
        let of_own = luthier_in_widths(shape, apart);
        let of_round = least * apart;
        let circle = luthier_circle_about(of_own, short, vec2<f32>(least, most) * radius);
        let own = luthier_cap(length(circle.xy), circle.z);
        let of_circle = luthier_cap(length(of_round), least * radius);
        let own_share = luthier_cap_share(own);
        let round_share = luthier_cap_share(of_circle);
        let is_round = round_share * most < own_share * least;
        let cost = select(own_share, round_share * most / least, is_round);
        let tail = 1.0 / shape.decay;
        if cost * (1.0 + 0.47 * (1.0 - tail) * (1.0 - 0.5 * tail)) < 1.0 && radius < 19.99 {
            let middle = select(circle.xy, of_round, is_round);
            let away = length(middle);
            given.chance = cost;
            given.share = select(own_share, round_share, is_round);
            given.circle = select(0.0, least, is_round);
            given.axis = select(own, of_circle, is_round).zw;
            given.towards = select(vec2<f32>(1.0, 0.0), middle / max(away, 1e-20), away > 1e-20);
        }
        return given;
    }

    /// Density in solid angle of light that a lobe sends to the eye.
    fn luthier_lobe_density(prepared: LuthierPreparedLobes, given: LuthierLobeDraw, shape: LuthierLobeShape, wi: vec3<f32>) -> f32 {
        let place = luthier_place_below(prepared, wi);
        if given.share > 0.0 {
            let slope = place.xy - given.middle;
            let apart = select(luthier_in_widths(shape, slope), given.circle * slope, given.circle > 0.0);
            let peak = select(shape.peak, given.circle * given.circle * (0.5 / LUTHIER_PI), given.circle > 0.0);
            let falloff = 1.0 / (1.0 + dot(apart, apart));
            return falloff * falloff * peak * place.z / given.share;
        }
        return luthier_half_slope_density(shape, place.xy) * place.z;
    }

    /// A direction whose half vector has a slope that a lobe draws; below the horizon where light does not leave there.
    fn luthier_sample_lobe(prepared: LuthierPreparedLobes, given: LuthierLobeDraw, shape: LuthierLobeShape, u: vec2<f32>) -> vec3<f32> {
        let phi = 2.0 * LUTHIER_PI * u.y;
        let turn = vec2<f32>(cos(phi), sin(phi));
        var apart = vec2<f32>(0.0);
        if given.share > 0.0 {
            let below = 2.0 * given.share * u.x;
            let ring = sqrt(below * (2.0 - below));
            let along = (1.0 - below) * given.axis.y + ring * turn.x * given.axis.x;
            let up = (1.0 - below) * given.axis.x - ring * turn.x * given.axis.y;
            let across = vec2<f32>(-given.towards.y, given.towards.x);
            apart = (along * given.towards + ring * turn.y * across) / (max(1.0 + up, 1e-7) * sqrt(shape.decay));
        } else {
            // Of y, the tail times the logarithm of the share beyond, exp(y) - 1 without cancellation.
            let y = -log(1.0 - min(u.x, 0.9999999)) / shape.decay;
            let series = y * (1.0 + y * (0.5 + y * (1.0 / 6.0)));
            apart = sqrt(select(exp(y) - 1.0, series, y < 0.02)) * turn;
        }
        var slope = luthier_lobe_slope(shape, apart);
        if given.circle > 0.0 {
            slope = given.middle + apart * (sqrt(shape.decay) / given.circle);
        }
        let wh = normalize(vec3<f32>(slope, 1.0));
        // Directions inside times the index, in the frame of the lobes.
        let eye = vec3<f32>(luthier_in_frame(prepared.azimuth, prepared.wo.xy), prepared.inside_cos);
        let inside = 2.0 * dot(wh, eye) * wh - eye;
        let cos_sq = 1.0 - dot(inside.xy, inside.xy);
        let leaves = inside.z > 0.0 && cos_sq > 0.0;
        let axes = prepared.azimuth;
        let level = vec2<f32>(axes.x * inside.x - axes.y * inside.y, axes.y * inside.x + axes.x * inside.y);
        return vec3<f32>(level, select(-1.0, sqrt(max(cos_sq, 0.0)), leaves));
    }
}
