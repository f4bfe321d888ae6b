/// The transmitted beam of a film for one channel (Granier and Heidrich 2003, eq. 10).
struct LuthierBeam {
    /// T, scaled so that its lobe carries its coefficient.
    transmitted: f32,
    /// Sum of the cosines in the film; 0 when nothing is transmitted.
    cosines: f32,
}

/// The beam through a film whose index over that outside is `eta`, and whose outer boundary reflects `normal` of light at the normal;
/// `inner_normal` is that of its inner boundary.
fn luthier_beam(wi: vec3<f32>, wo: vec3<f32>, eta: f32, normal: f32, exponent: f32, inner_normal: vec3<f32>) -> LuthierBeam {
    let cosines_sq = (vec2<f32>(wi.z * wi.z, wo.z * wo.z) + (eta - 1.0) * (eta + 1.0)) / (eta * eta);
    if min(cosines_sq.x, cosines_sq.y) <= 0.0 {
        return LuthierBeam(0.0, 0.0);
    }
    let ti = vec3<f32>(wi.xy / eta, sqrt(cosines_sq.x));
    let to = vec3<f32>(wo.xy / eta, sqrt(cosines_sq.y));
    let across = dot(ti, inner_normal);
    if min(across, dot(to, inner_normal)) <= 0.0 {
        return LuthierBeam(0.0, 0.0);
    }
    // 2 across inner_normal - ti - to without differences of rounded cosines: in a narrow lobe all of it cancels but a little.
    let tilt = inner_normal.xy;
    let rise = (wi.z - wo.z) * (wi.z + wo.z) / (eta * eta * (ti.z + to.z));
    let apart = vec3<f32>(
        2.0 * across * tilt - (wi.xy + wo.xy) / eta,
        2.0 * (dot(ti.xy, tilt) * inner_normal.z - ti.z * dot(tilt, tilt)) + rise,
    );
    let leaving = 1.0 - luthier_schlick(vec3<f32>(normal), min(to.z, 1.0)).x;
    // The same of the way in, multiplied out: at grazing angles it is small.
    let c = wi.z;
    let entering = (1.0 - normal) * c * (5.0 + c * (-10.0 + c * (10.0 + c * (-5.0 + c))));
    // Directions crowd in the film by cos_theta_i / (eta^2 cos_theta_t).
    let compression = wi.z / (eta * eta * ti.z);
    let lobe = (exponent + 1.0) / (2.0 * LUTHIER_PI) * luthier_power_lobe(0.5 * dot(apart, apart), exponent);
    return LuthierBeam(entering * leaving * compression * lobe, ti.z + to.z);
}

/// Two powers and their interference for the sums of the cosines in the film (eq. 3-5); a slab is too thick for it.
fn luthier_superpose(layer: LuthierLayer, r: vec3<f32>, t: vec3<f32>, cosines: vec3<f32>) -> vec3<f32> {
    //? granier_film
    {
        if layer.film_ior_n.x <= 0.0 {
            return r + t;
        }
        //? phase
        {
            let s = cosines * (0.5 * layer.film_thickness_nm / layer.film_thickness_max_nm);
            let red = luthier_lookup_phase(layer.phase_tile, s.x).x;
            let green = luthier_lookup_phase(layer.phase_tile, s.y).y;
            let blue = luthier_lookup_phase(layer.phase_tile, s.z).z;
            let interference = vec3<f32>(red, green, blue);
        }
        //? else
        {
            // Whole cycles are taken off first: sines of large angles are imprecise on GPUs.
            let cycles = layer.film_ior_n * layer.film_thickness_waves * cosines;
            let interference = 2.0 * cos(2.0 * LUTHIER_PI * (cycles - round(cycles)));
        }
        return max(r + t + interference * sqrt(r * t), vec3<f32>(0.0));
    }
    //? else
    return r + t;
}

/// Numbers of a material that are none of its layers.
struct LuthierOwn {
    /// Exponent of the inner boundary.
    inner_exponent: f32,
    /// Weights of the specular and the diffuse part.
    weights: vec2<f32>,
    /// Normal of the inner boundary, unit.
    inner_normal: vec3<f32>,
    //? granier_height
    /// Lobes have height one, and do not carry their coefficients.
    has_height_one: bool,
}

/// The numbers of a material whose outer boundary has the slope parameter `alpha`; those of all others where it has none of its own.
fn luthier_own(material: u32, alpha: f32) -> LuthierOwn {
    let header = luthier_header(material);
    let numbers = luthier_materials[header + $word_phong_diffuse];
    let normal = luthier_materials[header + $word_phong_specular];
    let is_own = normal.w > 0.5;
    let inner = clamp(alpha * select(1.0, numbers.x, is_own), 0.001, 1.0);
    return LuthierOwn(
        2.0 / (inner * inner) - 2.0,
        select(vec2<f32>(1.0), numbers.yz, is_own),
        select(vec3<f32>(0.0, 0.0, 1.0), normal.xyz, is_own),
        //? granier_height
        is_own && numbers.w > 0.5,
    );
}

/// The normal of a boundary of two slopes, which add up.
fn luthier_leaning(own: vec3<f32>, here: vec3<f32>) -> vec3<f32> {
    return normalize(vec3<f32>(own.xy * here.z + here.xy * own.z, own.z * here.z));
}

/// f cos_theta_i of two beams, their interference and a diffuse term (Granier and Heidrich 2003, eq. 5-18).
fn luthier_eval_granier_heidrich($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let layer = $layer(material, 0u);
    //? granier_film
    let has_film = layer.film_ior_n.x > 0.0;
    //? else
    let has_film = false;
    var specular = vec3<f32>(0.0);
    //? granier_base
    var diffuse = vec3<f32>(1.0);
    //? granier_own
    //? interface
    let own = luthier_own(material, layer.alpha);
    //? else
    let own = luthier_own(material, 1.0);
    //? interface
    {
        let exponent = 2.0 / (layer.alpha * layer.alpha) - 2.0;
        let apart = vec3<f32>(wi.xy + wo.xy, wi.z - wo.z);
        //? granier_height
        let mirror = select((exponent + 1.0) / (2.0 * LUTHIER_PI), 1.0, own.has_height_one) * luthier_power_lobe(0.5 * dot(apart, apart), exponent);
        //? else
        let mirror = (exponent + 1.0) / (2.0 * LUTHIER_PI) * luthier_power_lobe(0.5 * dot(apart, apart), exponent);
    }
    //? granier_transparent
    if layer.kind == LUTHIER_DIELECTRIC || has_film {
        //? granier_film
        let of_index = select(layer.ior_n, layer.film_ior_n, has_film);
        //? else
        let of_index = layer.ior_n;
        //? granier_schlick
        {
            // Schlick's interface has its F0 in place of the index.
            let is_schlick = layer.ior_k.x < 0.0;
            let eta = select(of_index, vec3<f32>(layer.eta), is_schlick);
            let root = (eta - 1.0) / (eta + 1.0);
            let normal = select(root * root, layer.ior_n, is_schlick);
        }
        //? else
        {
            let eta = of_index;
            let root = (eta - 1.0) / (eta + 1.0);
            let normal = root * root;
        }
        //? granier_own
        {
            let exponent = own.inner_exponent;
            //? place
            let inner_normal = luthier_leaning(own.inner_normal, place.inner_normal);
            //? else
            let inner_normal = own.inner_normal;
        }
        //? else
        //? place
        let inner_normal = place.inner_normal;
        //? else
        let inner_normal = vec3<f32>(0.0, 0.0, 1.0);
        let red = luthier_beam(wi, wo, eta.x, normal.x, exponent, inner_normal);
        let green = luthier_beam(wi, wo, eta.y, normal.y, exponent, inner_normal);
        let blue = luthier_beam(wi, wo, eta.z, normal.z, exponent, inner_normal);
        let r = luthier_schlick(normal, wi.z) * mirror;
        //? granier_height
        {
            // The factors that have a lobe carry its coefficient, which `luthier_beam` multiplies in.
            let inside = sqrt(max(wi.z * wi.z + (eta - 1.0) * (eta + 1.0), vec3<f32>(1e-12))) / eta;
            let factors = (exponent + 1.0) / (2.0 * LUTHIER_PI) * wi.z / (eta * eta * inside);
            let carried = vec3<f32>(red.transmitted, green.transmitted, blue.transmitted);
            let t = select(carried, carried / factors, own.has_height_one);
        }
        //? else
        let t = vec3<f32>(red.transmitted, green.transmitted, blue.transmitted);
        specular = luthier_superpose(layer, r, t, vec3<f32>(red.cosines, green.cosines, blue.cosines));
        //? granier_base
        {
            // The mean of Schlick's reflectance (eq. 14).
            //? granier_schlick
            let diffuse_reflectance = (20.0 * normal + 1.0) / 21.0;
            //? else
            let diffuse_reflectance = (21.0 * (eta * eta + 1.0) - 38.0 * eta) / (21.0 * (eta + 1.0) * (eta + 1.0));
            diffuse = luthier_superpose(layer, diffuse_reflectance, 1.0 - diffuse_reflectance, vec3<f32>(2.0));
        }
    }
    //? granier_bare
    if layer.kind == LUTHIER_CONDUCTOR && !has_film {
        specular = luthier_schlick(luthier_fresnel_term(layer, 1.0), wi.z) * mirror;
    }
    //? granier_base
    {
        //? base_color
        let last = luthier_layer_at(place, material, luthier_layer_count(material) - 1u);
        //? else
        let last = luthier_layer(material, luthier_layer_count(material) - 1u);
        if last.kind == LUTHIER_DIFFUSE {
            //? granier_own
            return own.weights.x * specular + own.weights.y * wi.z * (diffuse * last.lambert);
            //? else
            specular += diffuse * last.lambert * wi.z;
        }
    }
    //? granier_own
    return own.weights.x * specular;
    //? else
    return specular;
}
