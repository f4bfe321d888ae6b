//? film_f0
{
    /// A clear film over an F0, as its series sees it.
    struct LuthierSheet {
        /// Row of its interference; below 0 without such a film.
        row: f32,
        /// Index over that of the medium above.
        ior: f32,
        /// Optical path down and up the film along its normal, in waves of each channel.
        waves: vec3<f32>,
    }

    /// Light of a cosine in such a film, and interference of its first four echoes.
    struct LuthierEchoes {
        cos_theta: f32,
        sin_theta_sq: f32,
        /// Squared cosine in the film, below 0 where light is totally reflected.
        cos_film_sq: f32,
        first: vec3<f32>,
        second: vec3<f32>,
        third: vec3<f32>,
        fourth: vec3<f32>,
    }

    /// The film of a layer, if that lies over an F0.
    fn luthier_sheet(layer: LuthierLayer) -> LuthierSheet {
        let row = select(-1.0, layer.phase_tile, layer.ior_k.x < 0.0);
        return LuthierSheet(row, layer.film_ior_n.y, 2.0 * layer.film_ior_n * layer.film_thickness_waves);
    }

    /// Light of a cosine in the medium above a film, of squared sines with a standard deviation. Rows end at twelve waves.
    fn luthier_echoes(sheet: LuthierSheet, cos_theta: f32, spread: f32) -> LuthierEchoes {
        var echoes: LuthierEchoes;
        echoes.cos_theta = cos_theta;
        echoes.sin_theta_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
        echoes.cos_film_sq = 1.0 - echoes.sin_theta_sq / (sheet.ior * sheet.ior);
        let cos_film = sqrt(max(echoes.cos_film_sq, 0.0));
        let s = sheet.waves.y * cos_film / 12.0;
        // Echoes of many paths fade, those of a normal distribution by a Gaussian.
        let apart = LUTHIER_PI * sheet.waves.y * spread / (sheet.ior * sheet.ior * max(cos_film, 0.1));
        let faded = -0.5 * apart * apart;
        echoes.first = exp(faded) * luthier_lookup_phase(sheet.row, min(s, 1.0));
        echoes.second = exp(4.0 * faded) * luthier_lookup_phase(sheet.row, min(2.0 * s, 1.0));
        echoes.third = exp(9.0 * faded) * luthier_lookup_phase(sheet.row, min(3.0 * s, 1.0));
        echoes.fourth = exp(16.0 * faded) * luthier_lookup_phase(sheet.row, min(4.0 * s, 1.0));
        return echoes;
    }

    /// Share of one polarisation that the film lets through, by the amplitudes of its boundaries.
    fn luthier_film_passed(echoes: LuthierEchoes, top: f32, bottom: vec3<f32>) -> vec3<f32> {
        let p = top * bottom;
        let late = p * (echoes.first - p * (echoes.second - p * (echoes.third - p * echoes.fourth / (1.0 + p))));
        return (1.0 - top * top) * (1.0 - bottom * bottom) / max(1.0 - p * p, vec3<f32>(1e-6)) * (1.0 - late);
    }

    /// Share of one polarisation that tunnels through a film which would reflect it totally, by the wave numbers along the normal, each over that of its
    /// polarisation; `kept` is what an amplitude keeps down and up the film.
    fn luthier_film_tunnelled(above: f32, film: f32, below: vec3<f32>, kept: vec3<f32>) -> vec3<f32> {
        let a = above * above;
        let k = film * film;
        let b = below * below;
        let cross_term = 4.0 * above * k * below;
        let whole = (1.0 + kept * kept) * (a + k) * (k + b) + 2.0 * kept * ((a - k) * (k - b) + cross_term);
        return 4.0 * kept * cross_term / max(whole, vec3<f32>(1e-9));
    }

    /// Reflectance of a film over F0 of these roots, RGB.
    fn luthier_film_over(sheet: LuthierSheet, echoes: LuthierEchoes, roots: vec3<f32>) -> vec3<f32> {
        // The index above over that of the base, which has a highest one.
        let relative = max(1.0 - roots, vec3<f32>(2e-4)) / (1.0 + roots);
        let cos_below = sqrt(1.0 - echoes.sin_theta_sq * relative * relative);
        if echoes.cos_film_sq <= 0.0 {
            let decay = sqrt(-echoes.cos_film_sq);
            let kept = exp(-2.0 * LUTHIER_PI * decay * sheet.waves);
            let s = luthier_film_tunnelled(echoes.cos_theta, sheet.ior * decay, cos_below / relative, kept);
            let p = luthier_film_tunnelled(echoes.cos_theta, decay / sheet.ior, cos_below * relative, kept);
            return 1.0 - 0.5 * (s + p);
        }
        let cos_film = sqrt(echoes.cos_film_sq);
        let outer = sheet.ior * cos_film;
        let inner = sheet.ior * echoes.cos_theta;
        let top_s = (echoes.cos_theta - outer) / (echoes.cos_theta + outer);
        let top_p = (inner - cos_film) / (inner + cos_film);
        let under = sheet.ior * relative;
        let bottom_s = (under * cos_film - cos_below) / (under * cos_film + cos_below);
        let bottom_p = (cos_film - under * cos_below) / (cos_film + under * cos_below);
        return 1.0 - max(0.5 * (luthier_film_passed(echoes, top_s, bottom_s) + luthier_film_passed(echoes, top_p, bottom_p)), vec3<f32>(0.0));
    }
}

/// Reflectance of a layer as it is at a place: Schlick's form with another F0 leaves a constant factor of what it left,
/// less what an edge tint keeps.
fn luthier_fresnel_term(layer: LuthierLayer, cos_theta_d: f32) -> vec3<f32> {
    //? film_f0
    {
        let sheet = luthier_sheet(layer);
        if sheet.row >= 0.0 {
            let echoes = luthier_echoes(sheet, saturate(cos_theta_d), 0.0);
            var reflected = luthier_film_over(sheet, echoes, vec3<f32>(0.2));
            if layer.film_roots.w > 0.0 {
                reflected = mix(reflected, luthier_film_over(sheet, echoes, layer.film_roots.rgb), layer.film_roots.w);
            }
            return reflected;
        }
    }
    //? rows|computed|fitted
    {
        //? own_edge
        {
            let away = 1.0 - saturate(cos_theta_d);
            let cubed = away * away * away;
            let kept = layer.edge * (saturate(cos_theta_d) * cubed * cubed);
            // An edge tint takes no more than all. Colours outside of Rec.709 have channels below 0.
            let whole = 1.0 - layer.passing * (1.0 - luthier_fresnel_given(layer, cos_theta_d));
            return max(whole - kept, min(whole, vec3<f32>(0.0)));
        }
        //? else
        //? facets_f0
        return 1.0 - layer.passing * (1.0 - luthier_fresnel_given(layer, cos_theta_d));
        //? else
        return luthier_fresnel_given(layer, cos_theta_d);
    }
    //? else
    return vec3<f32>(0.0);
}
