//? lobes_family
{
    //? lobes_metallic
    {
        /// Light of one visit to the metal of a family, over its F0 and that of the dielectric in w: w (1 - R) f / (1 - R f) with w and R.
        fn luthier_family_once(numbers: vec2<f32>, f0: vec4<f32>) -> vec4<f32> {
            return f0 * (numbers.x - numbers.x * numbers.y) / (1.0 - numbers.y * f0);
        }

        /// Light of more visits, f^2 (p + q f) / (1 - R f) with p + q f at .5 and at 1, and R.
        fn luthier_family_more(numbers: vec3<f32>, f0: vec3<f32>) -> vec3<f32> {
            let growth = 2.0 * (numbers.y - numbers.x);
            let least = 2.0 * numbers.x - numbers.y;
            return f0 * f0 * max(least + growth * f0, vec3<f32>(0.0)) / (1.0 - numbers.z * f0);
        }
    }

    //? lobes_metallic, dielectric_f0
    /// Share of the light of a diffuse base that is sent back to it below a coat and a dielectric of an F0: `sent_back` is it at an F0 of 0.04, and `left_by_index` the
    /// index of the coat over that of the dielectric.
    fn luthier_family_sent_back(sent_back: f32, f0: vec3<f32>, left_by_index: f32) -> vec3<f32> {
        let known = 1.0 - LUTHIER_PLASTIC_PASSED;
        let left = (1.0 - sent_back) / (LUTHIER_PLASTIC_PASSED * left_by_index * left_by_index);
        let kept = saturate((1.0 - left) / (1.0 - left * known));
        let average = f0 + (1.0 - f0) / 21.0;
        let passed = (1.0 - average) / max(1.0 - average * kept, vec3<f32>(0.02));
        return 1.0 - passed * ((1.0 - known * kept) / LUTHIER_PLASTIC_PASSED) * (1.0 - sent_back);
    }

    //? lobes_metallic, film_f0|dielectric_f0
    /// Light of several facets of a dielectric at an F0, of which `known` is that at 0.04: that of a metal, and light that crossed some of them. `steep` is the mean
    /// of Schlick's (1 - cos)^5 at the facets that the eye sees.
    fn luthier_family_several(known: f32, energies: vec3<f32>, steep: f32, f0: vec3<f32>) -> vec3<f32> {
        let excess = (known - luthier_family_more(energies, vec3<f32>(0.04)).x) / ((0.04 + 0.96 * steep) * 0.9406040);
        let crossed = (f0 + (1.0 - f0) * steep) * (1.0 - f0) * sqrt(max(1.0 - f0, vec3<f32>(0.0)));
        return max(luthier_family_more(energies, f0) + excess * crossed, vec3<f32>(0.0));
    }

    //? film_f0
    {
        /// Cosines at which the mean of a reflectance over all directions is taken, by Gauss, and standard deviations of the squared sines that they stand for.
        const LUTHIER_MEAN_COSINES: vec2<f32> = vec2<f32>(0.3550510, 0.8449490);
        const LUTHIER_MEAN_SPREADS: vec2<f32> = vec2<f32>(0.105054, 0.183621);

        /// Light at two angles, and the fifth powers of what their cosines lack.
        struct LuthierEnds {
            near: LuthierEchoes,
            far: LuthierEchoes,
            powers: vec2<f32>,
        }

        /// Light whose squared sines have a mean and a standard deviation: at two of them, half the variance apart, whose echoes fade by the other half.
        fn luthier_film_ends(sheet: LuthierSheet, square: f32, spread: f32) -> LuthierEnds {
            let faded = 0.7071068 * spread;
            let apart = min(faded, 0.9 * (1.0 - square));
            let cosines = sqrt(clamp(1.0 - square + vec2<f32>(apart, -apart), vec2<f32>(0.0025), vec2<f32>(1.0)));
            let away = 1.0 - cosines;
            let powers = away * away * (away * away) * away;
            return LuthierEnds(luthier_echoes(sheet, cosines.x, faded), luthier_echoes(sheet, cosines.y, faded), powers);
        }

        /// Reflectance of a film over F0 of these roots, RGB, in the mean of such light.
        fn luthier_film_seen(sheet: LuthierSheet, ends: LuthierEnds, roots: vec3<f32>) -> vec3<f32> {
            return 0.5 * (luthier_film_over(sheet, ends.near, roots) + luthier_film_over(sheet, ends.far, roots));
        }

        /// F0 of an interface that reflects as much of light at one angle as a film over F0 of these roots.
        fn luthier_film_equal(sheet: LuthierSheet, echoes: LuthierEchoes, roots: vec3<f32>, power: f32) -> vec3<f32> {
            return saturate((luthier_film_over(sheet, echoes, roots) - power) / (1.0 - power));
        }

        /// F0 of an interface that reflects as much of such light.
        fn luthier_film_f0(sheet: LuthierSheet, ends: LuthierEnds, roots: vec3<f32>) -> vec3<f32> {
            let near = luthier_film_equal(sheet, ends.near, roots, ends.powers.x);
            return 0.5 * (near + luthier_film_equal(sheet, ends.far, roots, ends.powers.y));
        }

        /// F0 of an interface that reflects as much of diffuse light as a film does, of its reflectances at these cosines.
        fn luthier_film_mean(flat: vec3<f32>, steep: vec3<f32>) -> vec3<f32> {
            // Fifth powers of what the cosines lack.
            let powers = vec2<f32>(0.1115904, 0.0000896);
            let f0 = 0.3639172 * (flat - powers.x) / (1.0 - powers.x) + 0.6360828 * (steep - powers.y) / (1.0 - powers.y);
            return clamp(f0, vec3<f32>(0.0), vec3<f32>(1.0));
        }
    }

    //? lobes_metallic, own_edge
    /// Amount that an edge tint takes from the F0 of a metal for light that a coat keeps, over what it keeps at 82 degrees: by slope parameters of coat and base, and a
    /// cosine of the view.
    fn luthier_family_trapped_dip(held: vec2<f32>, cos_theta: f32) -> f32 {
        let spread = dot(held, held);
        let away = 1.0 - cos_theta;
        let flat_views = away * away * away * (1.0 - held.y) * held.x / (held.x + 0.1);
        return 0.15 * (spread / (spread + 0.006) + flat_views);
    }

    /// About the share of light that crosses a coat of a slope parameter as seen at a cosine, over which rows have energies.
    fn luthier_family_crossing(alpha: f32, cos_theta: f32) -> f32 {
        let cos_sq = cos_theta * cos_theta;
        let leaning = 0.4 * alpha * alpha / (alpha + 0.2 * cos_theta);
        let missed = 1.0 - sqrt(cos_sq + (1.0 - cos_sq) * leaning);
        return 1.0 - missed * missed * (missed * missed) * missed;
    }

    //? lobes_metallic
    /// Shares of diffuse light that an interface of an F0 of 0.04 lets through by Schlick's formula: from above, and of that from below, which it bends by
    /// the index 1.5.
    const LUTHIER_PLASTIC_PASSED: f32 = 0.9142857;
    const LUTHIER_PLASTIC_LEFT: f32 = 0.4063492;

    /// A part of the row of a family: at a tile and a cosine, between this many tiles and the share of a place among those of the next node of the coat.
    fn luthier_family_part(row: vec2<f32>, beside: vec2<f32>, part: f32) -> vec4<f32> {
        let here = luthier_lookup_lobes(row.x, row.y, part);
        //? lobes_coats
        if beside.y > 0.0 {
            return mix(here, luthier_lookup_lobes(row.x + beside.x, row.y, part), beside.y);
        }
        return here;
    }

    /// Albedo of the diffuse base of a material by its header: of the place, or of the file.
    fn luthier_family_albedo($place_parameter header: u32) -> vec3<f32> {
        //? base_color
        if place.base_color.x >= 0.0 {
            return place.base_color;
        }
        return luthier_materials[header + $word_patina].rgb;
    }

    /// A lobe of a family by its shift, its sharpness and decay, seen at an angle of this sine.
    fn luthier_family_shape(shift: f32, sharpness: vec2<f32>, decay: f32, sin_theta: f32) -> LuthierLobeShape {
        //? lobes_axes
        return luthier_lobe_in_axes(shift, vec3<f32>(sharpness, decay), 0.0, vec2<f32>(sin_theta, 0.0), false);
        //? else
        return luthier_lobe_shape(shift, vec3<f32>(sharpness, decay), sin_theta);
    }

    //? !lobes_tails|~lobes_tails
    /// Shares above the horizon of both lobes of a family in the plane of the eye, with the tail of GGX: see `Leaving` of the f64 twin. `radius` is that of the disc of
    /// slopes to light above the horizon, whose middle is in that plane; `less_sine` is 1 less the sine of the view, `slope` that of the middle of the first lobe.
    fn luthier_family_leaving(slope: f32, sharpness: vec4<f32>, radius: f32, less_sine: f32) -> vec2<f32> {
        let along = radius * sharpness.xz;
        let across = radius * sharpness.yw;
        // From the middle of a lobe to both edges of the disc: at flat views one of them is near.
        let near = (radius * less_sine + vec2<f32>(slope, 0.0)) * sharpness.xz;
        let far = 2.0 * along - near;
        let away = along - near;
        let squares = (1.0 + near * near) * (1.0 + far * far);
        let over_root = inverseSqrt(squares);
        let root = squares * over_root;
        // 1 + d + root and 1 - d + root: the one that cancels is the product of both over the other.
        let d = near * far;
        let more = 1.0 + abs(d) + root;
        let less = (2.0 + 2.0 * root + near * near + far * far) / more;
        let within = luthier_where_less(-d, 0.0, more, less);
        let beyond = luthier_where_less(-d, 0.0, less, more);
        let sum = 1.0 + along * along + away * away + root;
        return max(along * across * within * (inverseSqrt(sum * (beyond + 2.0 * across * across)) * over_root), vec2<f32>(1e-3));
    }

    //? lobes_tails
    /// Those of lobes of other tails, as estimates.
    fn luthier_family_leaving_tail(slope: f32, sharpness: vec4<f32>, decay: f32, disc: vec2<f32>) -> vec2<f32> {
        let away = abs(disc.x - vec2<f32>(slope, 0.0));
        let mean = sqrt(sharpness.xz * sharpness.yw);
        // The nearer the middle of a lobe is to the edge of the disc, the more its width along the way counts.
        let out = min(away / disc.y, vec2<f32>(1.0));
        let near = disc.y * (mean - (mean - sharpness.xz) * out * (2.0 - out)) - away * sharpness.xz;
        let far = max(2.0 * disc.y * mean - near, near);
        let near_cos = exp2(-0.5 * decay * log2(1.0 + near * near));
        let far_cos = exp2(-0.5 * decay * log2(1.0 + far * far));
        // Small sines by a series: the difference to 1 would be rounded off.
        let small_near = decay * near * near;
        let small_far = decay * far * far;
        let near_sq = luthier_where_less(small_near, 1e-3, small_near - 0.5 * small_near * (small_near + near * near), 1.0 - near_cos * near_cos);
        let far_sq = luthier_where_less(small_far, 1e-3, small_far - 0.5 * small_far * (small_far + far * far), 1.0 - far_cos * far_cos);
        let sines = sign(near) * sign(far) * sqrt(max(near_sq * far_sq, vec2<f32>(0.0)));
        return max(0.5 - 0.5 * (near_cos * far_cos - sines), vec2<f32>(1e-3));
    }

    //? lobes_tails
    /// Shares above the horizon of lobes of such a tail, from what rows have over these estimates.
    fn luthier_family_tail_shares(row: vec2<f32>, beside: vec2<f32>, slope: f32, sharpness: vec4<f32>, decay: f32, disc: vec2<f32>) -> vec2<f32> {
        let over = luthier_family_part(row, beside, -1.0).xy;
        return clamp(over * luthier_family_leaving_tail(slope, sharpness, decay, disc), vec2<f32>(1e-3), vec2<f32>(1.0));
    }

    //? anisotropic
    {
        /// An angle more, by cosine and sine.
        fn luthier_turned(turn: vec2<f32>, more: vec2<f32>) -> vec2<f32> {
            return vec2<f32>(turn.x * more.x - turn.y * more.y, turn.y * more.x + turn.x * more.y);
        }

        /// Squared slope parameters of an interface over the square of their mean, as a matrix in the plane of the eye and across it: both entries of its
        /// diagonal, and the one off it.
        fn luthier_family_squares(alphas: vec2<f32>, turn: vec2<f32>, azimuth: vec2<f32>) -> vec3<f32> {
            let axis = luthier_in_frame(azimuth, turn);
            let over_mean = alphas * (2.0 / (alphas.x + alphas.y));
            let squares = over_mean * over_mean;
            let along = axis * axis;
            return vec3<f32>(dot(squares, along), dot(squares, along.yx), (squares.x - squares.y) * axis.x * axis.y);
        }

        /// A lobe in the plane of the eye whose slopes are multiplied by the root of a matrix.
        fn luthier_family_stretched(given: LuthierLobeShape, squares: vec3<f32>) -> LuthierLobeShape {
            var shape = given;
            // Cayley and Hamilton: the root of M is (M + d) / sqrt(tr M + 2 d), d being the root of its determinant.
            let root_det = sqrt(max(squares.x * squares.y - squares.z * squares.z, 1e-12));
            let width = vec3<f32>(squares.xy + root_det, squares.z) * inverseSqrt(squares.x + squares.y + 2.0 * root_det);
            // The squared sharpness, and its root, which is symmetric.
            let inverse = vec3<f32>(width.yx, -width.z) / root_det;
            let sharp = given.sharpness * given.sharpness;
            let inverse_sq = inverse * inverse;
            let sharp_sq = vec3<f32>(
                dot(sharp, inverse_sq.xz), dot(sharp, inverse_sq.zy), inverse.z * (sharp.x * inverse.x + sharp.y * inverse.y),
            );
            let area = given.sharpness.x * given.sharpness.y / root_det;
            let sharpness = vec3<f32>(sharp_sq.xy + area, sharp_sq.z) * inverseSqrt(sharp_sq.x + sharp_sq.y + 2.0 * area);
            let middle = width.xz * (given.middle.x / given.sharpness.x);
            shape.sharpness = sharpness.xy;
            shape.shear = sharpness.z;
            shape.middle = sharpness.xy * middle + sharpness.z * middle.yx;
            return shape;
        }
    }

    /// A material of a family as seen from wo, above the horizon: rows are read at the slope parameters of the place, and their energies are those of its
    /// colours.
    fn luthier_prepare_family($place_parameter material: u32, wo: vec3<f32>) -> LuthierPreparedLobes {
        let header = luthier_header(material);
        let base_axis = luthier_materials[header + $word_phong_diffuse];
        //? lobes_coat_slopes|~lobes_metallic
        let coat_axis = luthier_materials[header + $word_patina_tarnish];
        let tilt_word = luthier_materials[header + $word_glitter_tilt];
        let base_layer = $base_layer;
        let first_word = luthier_whole(luthier_materials[header].x);
        let base_word = first_word + base_layer * LUTHIER_LAYER_WORDS;
        // Slope parameters of coat and base, without the variance of normals, which lobes get by themselves.
        //? layered
        {
            let own_coat = luthier_own_place(place, 0u);
            let own_base = luthier_own_place(place, base_layer);
        }
        //? anisotropic
        {
            // Along the tangents and the bitangents: an anisotropic interface reads the rows of their mean.
            let coat_tangent = luthier_materials[first_word + $word_tangent];
            let base_tangent = luthier_materials[base_word + $word_tangent];
            var coat_alphas = coat_tangent.xy;
            var base_alphas = base_tangent.xy;
            //? own_alphas
            {
                coat_alphas *= own_coat.alpha_factors;
                base_alphas *= own_base.alpha_factors;
            }
            //? place
            {
                coat_alphas *= place.alpha_factor;
                base_alphas *= place.alpha_factor;
            }
            coat_alphas = clamp(coat_alphas, vec2<f32>(0.001), vec2<f32>(1.0));
            base_alphas = clamp(base_alphas, vec2<f32>(0.001), vec2<f32>(1.0));
            let alphas = 0.5 * vec2<f32>(coat_alphas.x + coat_alphas.y, base_alphas.x + base_alphas.y);
        }
        //? else
        {
            var alphas = vec2<f32>(luthier_materials[first_word + $word_numbers].y, luthier_materials[base_word + $word_numbers].y);
            //? own_alphas
            {
                // Both are the same where interfaces are isotropic.
                alphas *= vec2<f32>(own_coat.alpha_factors.x, own_base.alpha_factors.x);
            }
            //? place
            alphas *= place.alpha_factor;
        }
        //? lobes_coat_slopes
        {
            let least = vec2<f32>(coat_axis.x, base_axis.x);
            let roots = clamp(sqrt(max(alphas, vec2<f32>(0.0))), least, vec2<f32>(coat_axis.y, base_axis.y));
            let nodes = (roots - least) * vec2<f32>(coat_axis.z, base_axis.z);
            let held = roots * roots;
        }
        //? else
        {
            // Every coat has the one slope parameter of its layer, and none where the base is the first interface.
            let root = clamp(sqrt(max(alphas.y, 0.0)), base_axis.x, base_axis.y);
            let held = vec2<f32>(select(luthier_materials[first_word + $word_numbers].y, 0.0, base_layer == 0u), root * root);
        }
        // Tiles over the base follow each other, and make a sheet for each node of the coat. One tile makes no sheet: then tiles follow the coat.
        //? lobes_coats
        {
            let sheet = abs(coat_axis.w);
            let share = select(0.0, fract(nodes.x), sheet > 1.5);
            let beside = vec2<f32>(sheet, share);
            let tile = luthier_materials[header].w + (nodes.x - share) * sheet + nodes.y;
        }
        //? else
        {
            let beside = vec2<f32>(0.0);
            //? lobes_coat_slopes
            let tile = luthier_materials[header].w + nodes.x + nodes.y;
            //? else
            let tile = luthier_materials[header].w + (root - base_axis.x) * base_axis.z;
        }
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
            prepared.cover = 1.0;
            prepared.bare = prepared.coat;
            prepared.bare_masking = prepared.masking;
        }
        prepared.azimuth = across * inverse_sin;
        prepared.medium = luthier_materials[header + $word_veil];
        prepared.inside_cos = sqrt(luthier_inside_cos_sq(prepared.medium, wo.z));
        //? critical_view
        {
            prepared.inside = luthier_materials[header + $word_phong_specular];
            let plain = wo.z * (1.25 / (wo.z + 0.25));
            let cos_theta = mix(luthier_inside_cosine(prepared.inside, wo.z), plain, base_axis.w);
        }
        //? else
        let cos_theta = wo.z;
        prepared.row = vec2<f32>(tile, cos_theta);
        let of_once = luthier_family_part(prepared.row, beside, 0.0);
        let of_more = luthier_family_part(prepared.row, beside, 1.0);
        let sharpness = luthier_family_part(prepared.row, beside, 2.0);
        let of_facet = luthier_family_part(prepared.row, beside, 3.0);
        // Energies of rows are over the light that crosses the coat.
        let crossing = select(luthier_family_crossing(held.x, wo.z), 1.0, base_layer == 0u);
        // Light that the base reflected once and more often, the remainder, and one facet of the first interface.
        var once = of_once.rgb;
        var more = of_more.rgb;
        var wide = vec3<f32>(0.0);
        // Light but that of one facet, over what crosses the coat.
        var entering = of_facet.rgb;
        // The a of the remainder, and the share of the light of one visit that is wide.
        var falloff = of_facet.a;
        var once_wide = of_once.z;
        //? lobes_lean
        // Light of the base that came through the coat, and not back from it.
        var met = vec3<f32>(0.0);
        //? lobes_metallic
        //? ~lobes_metallic
        let is_metallic = coat_axis.w > 0.0;
        //? else
        let is_metallic = true;
        //? else
        let is_metallic = false;
        //? lobes_metallic
        if is_metallic {
            //? own_f0
            {
                // Below 0 without a place's own: none.
                var metal = saturate(place.metal.rgb);
                var metallic = saturate(place.metal.w);
            }
            //? else
            {
                var metal = vec3<f32>(0.0);
                var metallic = 0.0;
            }
            //? film_f0
            {
                // The film of the base, first or below a coat; a base of nothing but metal has the F0 of the file.
                var base = luthier_layer(material, base_layer);
                //? place
                base.film_thickness_waves *= place.film_factor;
                let sheet = luthier_sheet(base);
                //? own_f0
                let is_of_file = base.kind == LUTHIER_CONDUCTOR && place.metal.w < 0.0;
                //? else
                let is_of_file = base.kind == LUTHIER_CONDUCTOR;
                if is_of_file {
                    metal = base.ior_n;
                    metallic = 1.0;
                }
            }
            //? dielectric_f0
            let dielectric = select(luthier_materials[base_word + $word_ior_n].xyz, place.dielectric_f0, place.dielectric_f0.x >= 0.0);
            // The diffuse base has the albedo diffuse / passed.
            //? own_f0
            {
                var diffuse = place.matt;
                var passed = vec3<f32>(1.0);
                if place.metal.w >= 0.0 {
                    // It shows the colour of the place (Saunderson 1942).
                    //? dielectric_f0
                    let entered = (1.0 - dielectric) * (LUTHIER_PLASTIC_LEFT / 0.96);
                    //? else
                    let entered = LUTHIER_PLASTIC_LEFT;
                    passed = entered + diffuse * (1.0 - entered);
                } else {
                    diffuse = luthier_family_albedo($place_argument header);
                }
            }
            //? else
            {
                let diffuse = luthier_family_albedo($place_argument header);
                let passed = vec3<f32>(1.0);
            }
            // Rows have the light of a diffuse base of the albedo 0.8.
            //? lobes_coat_slopes
            let back = prepared.medium.y + tilt_word.w * roots.x + prepared.medium.w * roots.y;
            //? else
            let back = prepared.medium.y + prepared.medium.w * root;
            var light = vec3<f32>(of_facet.z * (1.25 - back));
            var sent_back = vec3<f32>(back);
            //? lobes_tinted|film_f0
            let of_lengths = luthier_family_part(prepared.row, beside, 4.0);
            //? own_edge|film_f0
            let of_edge = luthier_family_part(prepared.row, beside, 5.0);
            //? own_edge
            {
                // Light of one visit below a coat, or of several facets without one, sees an F0 that is less by what rows say; light that a coat keeps is flat.
                let of_one = luthier_family_once(of_once.xy, vec4<f32>(max(metal - place.metal_edge * of_edge.x, vec3<f32>(0.0)), 0.04));
            }
            //? else
            let of_one = luthier_family_once(of_once.xy, vec4<f32>(metal, 0.04));
            //? dielectric_f0
            once = mix(luthier_family_once(of_once.xy, vec4<f32>(dielectric, 0.0)).rgb, of_one.rgb, metallic);
            //? else
            once = mix(vec3<f32>(of_one.w), of_one.rgb, metallic);
            // F0 of the dielectric for light that a coat keeps: without a film it reflects hardly any.
            //? film_f0
            var kept_plastic = vec3<f32>(0.0);
            var several = vec3<f32>(of_once.x);
            var seen_metal = metal;
            //? own_edge
            metal = max(metal - place.metal_edge * select(luthier_family_trapped_dip(held, wo.z), of_edge.x, base_layer == 0u), vec3<f32>(0.0));
            //? film_f0|dielectric_f0
            {
                // Light of one facet of the dielectric over that of a mirror, and its F0 for light from everywhere.
                let all = of_facet.x + of_once.y;
                //? dielectric_f0
                {
                    var seen_plastic = (of_facet.x + of_once.y * dielectric) / max(all, 0.02);
                    var mean_plastic = dielectric;
                    var is_other = base_layer == 0u && dot(abs(dielectric - vec3<f32>(0.04)), vec3<f32>(1.0)) > 0.0;
                }
                //? else
                {
                    var seen_plastic = vec3<f32>(0.04);
                    var mean_plastic = vec3<f32>(0.04);
                    var is_other = false;
                }
                //? film_f0
                let is_filmed = base_layer == 0u && sheet.row >= 0.0;
                //? film_f0
                let metal_roots = sqrt(max(metal, vec3<f32>(0.0)));
                //? film_f0
                if is_filmed {
                    is_other = true;
                    let ends = luthier_film_ends(sheet, of_lengths.z, of_lengths.w);
                    let flat = luthier_echoes(sheet, LUTHIER_MEAN_COSINES.x, LUTHIER_MEAN_SPREADS.x);
                    let steep = luthier_echoes(sheet, LUTHIER_MEAN_COSINES.y, LUTHIER_MEAN_SPREADS.y);
                    let plastic = vec3<f32>(0.2);
                    // Rows know the mean of Schlick's power, which two angles do not have at flat views.
                    let passing = (1.0 - of_facet.x / max(all, 0.02)) / max(1.0 - 0.5 * (ends.powers.x + ends.powers.y), 0.02);
                    seen_plastic = 1.0 - max((1.0 - luthier_film_seen(sheet, ends, plastic)) * passing, vec3<f32>(0.0));
                    mean_plastic = luthier_film_mean(luthier_film_over(sheet, flat, plastic), luthier_film_over(sheet, steep, plastic));
                    if metallic > 0.0 {
                        seen_metal = 1.0 - max((1.0 - luthier_film_seen(sheet, ends, metal_roots)) * passing, vec3<f32>(0.0));
                        metal = luthier_film_mean(luthier_film_over(sheet, flat, metal_roots), luthier_film_over(sheet, steep, metal_roots));
                    }
                }
                if is_other {
                    several = luthier_family_several(of_once.x, of_more.rgb, of_facet.x / max(all, 0.02), mean_plastic);
                    // What facets do not reflect enters, seen from the eye as well as in the mean.
                    let diffused = mean_plastic + (1.0 - mean_plastic) / 21.0;
                    let staying = max(1.0 - all * diffused - several, vec3<f32>(0.0)) / max(1.0 - all * (1.0 - LUTHIER_PLASTIC_PASSED) - of_once.x, 0.02);
                    let leaving_base = staying * (1.0 - sent_back);
                    light = max(1.0 - all * seen_plastic - several, vec3<f32>(0.0)) * leaving_base;
                    sent_back = 1.0 - leaving_base;
                }
                //? film_f0
                if base_layer > 0u && sheet.row >= 0.0 {
                    // Below a coat the film is an F0 for light of one visit, and for that of more, some of which a film thinner than the coat reflects totally.
                    let ends = luthier_film_ends(sheet, of_edge.x, of_edge.y);
                    let steepest = min(sheet.ior * sheet.ior, 1.0);
                    let more_ends = luthier_film_ends(sheet, of_edge.w, 0.4 * steepest);
                    let flat_cos = sqrt(max(0.5 - 0.5 * steepest, 0.0025));
                    let flat_away = 1.0 - flat_cos;
                    let flat_power = flat_away * flat_away * (flat_away * flat_away) * flat_away;
                    let flat = luthier_echoes(sheet, flat_cos, 0.0);
                    let plastic = vec3<f32>(0.2);
                    let seen = luthier_film_f0(sheet, ends, plastic);
                    kept_plastic = mix(luthier_film_f0(sheet, more_ends, plastic), luthier_film_equal(sheet, flat, plastic, flat_power), of_edge.z);
                    once = luthier_family_once(of_once.xy, vec4<f32>(seen, 0.04)).rgb;
                    // A white base returns what the dielectric does not reflect.
                    let reflected = once + luthier_family_more(of_more.rgb, kept_plastic);
                    let white = max(light / (1.0 - sent_back), vec3<f32>(0.02));
                    let crossed = (1.0 - seen) / 0.96;
                    light *= crossed * max(1.0 - (reflected - of_one.w) / white, vec3<f32>(0.0));
                    sent_back = 1.0 - crossed * (1.0 - sent_back);
                    if metallic > 0.0 {
                        once = mix(once, luthier_family_once(of_once.xy, vec4<f32>(luthier_film_f0(sheet, ends, metal_roots), 0.04)).rgb, metallic);
                        metal = mix(luthier_film_f0(sheet, more_ends, metal_roots), luthier_film_equal(sheet, flat, metal_roots, flat_power), of_edge.z);
                    }
                }
                //? dielectric_f0
                if base_layer > 0u && dot(abs(dielectric - vec3<f32>(0.04)), vec3<f32>(1.0)) > 0.0 {
                    let reflected = of_facet.y + luthier_family_once(of_once.xy, vec4<f32>(dielectric, 0.0)).rgb + luthier_family_more(of_more.rgb, dielectric);
                    sent_back = luthier_family_sent_back(back, dielectric, luthier_materials[base_word].z);
                    light = max(of_facet.x - reflected, vec3<f32>(0.0)) * (1.0 - sent_back);
                }
            }
            //? dielectric_f0
            var again = vec3<f32>(1.0);
            //? lobes_tinted
            {
                var depth = luthier_materials[first_word + $word_slab].xyz * 0.6931472;
                //? place
                depth *= place.slab_factor;
                //? own_tints
                depth *= own_coat.absorption_factors;
                light *= exp(-of_lengths.x * depth);
                // What the dielectric itself sends back does not pass the slab.
                //? dielectric_f0
                {
                    let left = luthier_materials[base_word].z;
                    let kept_by_base = 1.0 - LUTHIER_PLASTIC_PASSED * (left * left);
                }
                //? else
                let kept_by_base = 1.0 - LUTHIER_PLASTIC_LEFT;
                let own_share = select(0.0, clamp(kept_by_base / max(back, 1e-6), 0.0, 0.98), base_layer > 0u);
                sent_back *= own_share + (1.0 - own_share) * exp(-of_lengths.y * depth);
                once *= exp(-of_lengths.z * depth);
                // Trapped light passes the slab again before each visit.
                //? dielectric_f0
                {
                    again = exp(-of_lengths.w * depth);
                    metal *= again;
                }
                //? else
                metal *= exp(-of_lengths.w * depth);
                //? film_f0
                kept_plastic *= exp(-of_lengths.w * depth);
            }
            more = metallic * luthier_family_more(of_more.rgb, metal);
            //? film_f0
            more += (1.0 - metallic) * luthier_family_more(of_more.rgb, kept_plastic);
            //? dielectric_f0
            if base_layer > 0u && dot(abs(dielectric - vec3<f32>(0.04)), vec3<f32>(1.0)) > 0.0 {
                more += (1.0 - metallic) * luthier_family_more(of_more.rgb, dielectric * again);
            }
            let of_base = (1.0 - metallic) * light;
            wide = of_facet.y + of_base * diffuse / (passed - sent_back * diffuse);
            //? lobes_lean
            met = of_base * diffuse / passed;
            entering = vec3<f32>(of_facet.x);
            if base_layer == 0u {
                // Several facets of the dielectric, and one of either.
                once = (1.0 - metallic) * several;
                //? dielectric_f0
                var facet = of_facet.x + of_once.y * mix(dielectric, seen_metal, metallic);
                //? else
                var facet = of_facet.x + of_once.y * mix(vec3<f32>(0.04), seen_metal, metallic);
                //? own_edge
                facet -= of_edge.y * metallic * place.metal_edge;
                //? film_f0
                if is_filmed {
                    facet = all * mix(seen_plastic, seen_metal, metallic);
                }
                entering = 1.0 - facet;
            }
        }
        //? !lobes_metallic|~lobes_metallic
        if !is_metallic {
            let painted = luthier_materials[header + $word_patina];
            let diffuse = luthier_family_albedo($place_argument header);
            let of_wide = luthier_family_part(prepared.row, beside, 4.0);
            wide = of_wide.rgb;
            falloff = of_wide.a;
            once_wide = of_facet.a;
            //? lobes_lengths
            {
                var depth = luthier_materials[first_word + $word_slab].xyz * 0.6931472;
                //? place
                depth *= place.slab_factor;
                //? own_tints
                depth *= own_coat.absorption_factors;
                let of_lengths = luthier_family_part(prepared.row, beside, 7.0);
                let visited = exp(-of_lengths.x * depth);
                once *= visited;
            }
            //? base_color|lobes_lean|lobes_lengths
            {
                //? lobes_lean|lobes_lengths
                let is_own = dot(painted.rgb, vec3<f32>(1.0)) > 0.0;
                //? else
                let is_own = place.base_color.x >= 0.0;
                if is_own {
                    let of_base = luthier_family_part(prepared.row, beside, 5.0);
                    let of_internal = luthier_family_part(prepared.row, beside, 6.0);
                    let simulated = max(painted.rgb, vec3<f32>(1e-6));
                    var own = simulated * max(1.0 - of_internal.rgb * diffuse, vec3<f32>(1e-3));
                    var other = diffuse * (1.0 - of_internal.rgb * painted.rgb);
                    //? lobes_lengths
                    {
                        let around = exp2(select(-1.5, -4.0, base_layer == 0u) * log2(1.0 + of_internal.w * depth));
                        own = simulated * max(1.0 - of_internal.rgb * around * diffuse, vec3<f32>(1e-3));
                        other *= exp(-of_base.w * depth);
                        // Above a diffuse base light of more visits passes the slab as often as its light does.
                        more *= visited * around;
                    }
                    //? lobes_lean
                    met = of_base.rgb * max(other, vec3<f32>(0.0)) / simulated;
                    //? base_color|lobes_lengths
                    wide += max(of_base.rgb * (other / own - 1.0), -wide);
                }
                //? lobes_lengths
                if !is_own {
                    more *= exp2(-4.5 * log2(1.0 + luthier_family_part(prepared.row, beside, 5.0).w * depth));
                }
            }
        }
        prepared.medium.y = falloff;
        // Integrals of the shape of the remainder.
        //? critical_view
        let moments = luthier_materials[header + $word_patina_diffuse_albedo].xy;
        //? else
        let moments = vec2<f32>(1.0 / 21.0, 1.0 / 6.0);
        prepared.medium.w = (1.0 / LUTHIER_PI) / (1.0 - dot(prepared.medium.yz, moments));
        let below = wide + once + more;
        // No more light than falls in.
        let left = crossing * min(max(entering, vec3<f32>(0.0)) / max(below, vec3<f32>(1e-6)), vec3<f32>(1.0));
        prepared.albedo = 1.0 - crossing * entering + left * below;
        // Some of the light of both lobes is wide.
        prepared.wide = left * (wide + once_wide * once + of_more.a * more);
        //? lobes_lean
        {
            let base_normal = luthier_own_normal(place, luthier_layer_count(material) - 1u);
            prepared.leaning = left * met;
            prepared.lean = base_normal.xy;
            prepared.albedo -= (1.0 - base_normal.z) * prepared.leaning;
            prepared.wide -= (1.0 - base_normal.z) * prepared.leaning;
        }
        let squares = held * held;
        let once_square = squares.y + 0.09 * squares.x;
        let over_spreads = vec2<f32>(inverseSqrt(once_square), max(inverseSqrt(4.84 * squares.y + squares.x), 1.0));
        let once_spread = once_square * over_spreads.x;
        let sharp = sharpness * over_spreads.xxyy;
        //? lobes_tails
        let decay = tilt_word.y;
        //? else
        let decay = 1.0;
        let shift = of_once.a * once_spread;
        var first_shape = luthier_family_shape(shift, sharp.xy, decay, sin_theta);
        var second_shape = luthier_family_shape(0.0, sharp.zw, decay, sin_theta);
        // Between rows the share is that of the shape there. Rows of other tails than that of GGX have it over an estimate.
        // Rows are in the plane of the eye.
        let radius = luthier_leaving_disc(prepared).z;
        let middle = shift * sin_theta;
        //? !lobes_tails|~lobes_tails
        let less_sine = wo.z * wo.z / (1.0 + sin_theta);
        //? lobes_tails
        {
            //? ~lobes_tails
            if decay == 1.0 {
                prepared.shares = luthier_family_leaving(middle, sharp, radius, less_sine);
            } else {
                prepared.shares = luthier_family_tail_shares(prepared.row, beside, middle, sharp, decay, radius * vec2<f32>(sin_theta, 1.0));
            }
            //? else
            prepared.shares = luthier_family_tail_shares(prepared.row, beside, middle, sharp, decay, radius * vec2<f32>(sin_theta, 1.0));
        }
        //? else
        prepared.shares = luthier_family_leaving(middle, sharp, radius, less_sine);
        //? anisotropic
        if coat_alphas.x != coat_alphas.y || base_alphas.x != base_alphas.y {
            let disc = luthier_leaving_disc(prepared);
            let first_level = luthier_lobe_leaving(first_shape, disc.xy - luthier_lobe_slope(first_shape, vec2<f32>(0.0)), disc.z);
            let second_level = luthier_lobe_leaving(second_shape, disc.xy - luthier_lobe_slope(second_shape, vec2<f32>(0.0)), disc.z);
            // Squared slope parameters in the plane of the eye, over those that rows were read at.
            var coat_turn = coat_tangent.zw;
            var base_turn = base_tangent.zw;
            //? tangents
            {
                coat_turn = luthier_turned(coat_turn, own_coat.tangent);
                base_turn = luthier_turned(base_turn, own_base.tangent);
            }
            let of_coat = luthier_family_squares(coat_alphas, coat_turn, prepared.azimuth) * squares.x;
            let of_base = luthier_family_squares(base_alphas, base_turn, prepared.azimuth) * squares.y;
            first_shape = luthier_family_stretched(first_shape, (of_base + 0.09 * of_coat) / (squares.y + 0.09 * squares.x));
            second_shape = luthier_family_stretched(second_shape, (4.84 * of_base + of_coat) / (4.84 * squares.y + squares.x));
            let first_left = luthier_lobe_leaving(first_shape, disc.xy - luthier_lobe_slope(first_shape, vec2<f32>(0.0)), disc.z);
            let second_left = luthier_lobe_leaving(second_shape, disc.xy - luthier_lobe_slope(second_shape, vec2<f32>(0.0)), disc.z);
            prepared.shares = clamp(prepared.shares * vec2<f32>(first_left / first_level, second_left / second_level), vec2<f32>(1e-3), vec2<f32>(1.0));
        }
        let over_shares = (1.0 - vec2<f32>(once_wide, of_more.a)) / prepared.shares;
        prepared.first_strength = left * (over_shares.x * once);
        prepared.second_strength = left * (over_shares.y * more);
        //? surface
        {
            // A normal that leans by a slope shifts half vectors by as much of it as directions lean outside over those inside.
            let leaning = wo.z / prepared.inside_cos;
            let unresolved = 2.0 * max(place.slope_variance, 0.0) * leaning * leaning;
            first_shape = luthier_spread(first_shape, 1.0, unresolved);
            second_shape = luthier_spread(second_shape, 1.0, unresolved);
        }
        //? lobes_tilted
        {
            // Half vectors in the slab are shifted by the slope of the normal, those in another medium as much as the mirror direction is.
            let turned = luthier_slope_below(place, material);
            first_shape.gain = 1.0;
            first_shape.left = 1.0;
            second_shape.gain = 1.0;
            second_shape.left = 1.0;
            if turned.x != 0.0 || turned.y != 0.0 {
                let slab_cos = sqrt(max(prepared.coat.eta * prepared.coat.eta - sin_theta_sq, 0.0));
                let tilt = luthier_in_frame(prepared.azimuth, turned * (slab_cos / prepared.inside_cos));
                let disc = luthier_leaving_disc(prepared);
                first_shape = luthier_lobe_about(first_shape, tilt, prepared.shares.x, disc);
                second_shape = luthier_lobe_about(second_shape, tilt, prepared.shares.y, disc);
                prepared.first_strength *= first_shape.gain;
                prepared.second_strength *= second_shape.gain;
            }
        }
        prepared.first_shape = luthier_with_peak(first_shape);
        prepared.second_shape = luthier_with_peak(second_shape);
        return prepared;
    }

    //? ~lobes_family
    /// Whether rows of a material are those of a family.
    fn luthier_is_family(material: u32) -> bool {
        return luthier_materials[luthier_header(material) + $word_patina].w < -2.5;
    }
    //? else
    /// A material as seen from wo, above the horizon.
    fn luthier_prepare_lobes($place_parameter material: u32, wo: vec3<f32>) -> LuthierPreparedLobes {
        return luthier_prepare_family($place_argument material, wo);
    }
}
