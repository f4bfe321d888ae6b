/// The two beams of a film for one channel (Granier and Heidrich 2003, eq. 6 and 10), each scaled so that its lobe carries its
/// coefficient.
struct LuthierBeams {
    /// R.
    reflected: f32,
    /// T.
    transmitted: f32,
    /// Sum of the cosines in the film, 0 when nothing is transmitted.
    cosines: f32,
}

/// Schlick 1994.
fn luthier_schlick(normal: vec3<f32>, cos_theta: f32) -> vec3<f32> {
    let q = 1.0 - cos_theta;
    return normal + (1.0 - normal) * (q * q * q * q * q);
}

/// The beams of a film whose index over that outside is `eta`; `normal` is that of its inner boundary. //? granier_film
fn luthier_beams(wi: vec3<f32>, wo: vec3<f32>, eta: f32, exponent: f32, normal: vec3<f32>) -> LuthierBeams { //? granier_film
    let root = (eta - 1.0) / (eta + 1.0); //? granier_film
    let outside = luthier_schlick(vec3<f32>(root * root), wi.z).x; //? granier_film
    let scale = (exponent + 1.0) / (2.0 * LUTHIER_PI); //? granier_film
    let apart = vec3<f32>(wi.xy + wo.xy, wi.z - wo.z); //? granier_film
    var beams: LuthierBeams; //? granier_film
    beams.reflected = outside * scale * luthier_power_lobe(0.5 * dot(apart, apart), exponent); //? granier_film
    let cosines_sq = (vec2<f32>(wi.z * wi.z, wo.z * wo.z) + (eta - 1.0) * (eta + 1.0)) / (eta * eta); //? granier_film
    if min(cosines_sq.x, cosines_sq.y) <= 0.0 { //? granier_film
        return beams; //? granier_film
    } //? granier_film
    let ti = vec3<f32>(wi.xy / eta, sqrt(cosines_sq.x)); //? granier_film
    let to = vec3<f32>(wo.xy / eta, sqrt(cosines_sq.y)); //? granier_film
    let across = dot(ti, normal); //? granier_film
    if min(across, dot(to, normal)) <= 0.0 { //? granier_film
        return beams; //? granier_film
    } //? granier_film
    let between = 2.0 * across * normal - ti - to; //? granier_film
    let inside = luthier_schlick(vec3<f32>(root * root), min(to.z, 1.0)).x; //? granier_film
    let compression = wi.z / (eta * eta * ti.z); //? granier_film
    let lobe = luthier_power_lobe(0.5 * dot(between, between), exponent); //? granier_film
    beams.transmitted = (1.0 - outside) * (1.0 - inside) * compression * scale * lobe; //? granier_film
    beams.cosines = ti.z + to.z; //? granier_film
    return beams; //? granier_film
} //? granier_film

/// 2 cos(2 Phi) of a film, RGB, for the sums of the cosines inside (eq. 3). //? granier_interference
fn luthier_interference(layer: LuthierLayer, cosines: vec3<f32>) -> vec3<f32> { //? granier_interference
    let s = cosines * (0.5 * layer.film_thickness_nm / layer.film_thickness_max_nm); //? granier_interference, phase
    return vec3<f32>( //? granier_interference, phase
        luthier_lookup_phase(layer.phase_tile, s.x).x, //? granier_interference, phase
        luthier_lookup_phase(layer.phase_tile, s.y).y, //? granier_interference, phase
        luthier_lookup_phase(layer.phase_tile, s.z).z, //? granier_interference, phase
    ); //? granier_interference, phase
    // Whole cycles are taken off first: sines of large angles are imprecise on GPUs. //? granier_interference, !phase
    let cycles = layer.film_ior_n * layer.film_waves * cosines; //? granier_interference, !phase
    return 2.0 * cos(2.0 * LUTHIER_PI * (cycles - round(cycles))); //? granier_interference, !phase
} //? granier_interference

/// Two powers and their interference, of a layer that may be too thick for it (eq. 4).
fn luthier_superposed(layer: LuthierLayer, r: vec3<f32>, t: vec3<f32>, cosines: vec3<f32>) -> vec3<f32> {
    if layer.film_thickness_nm > 0.0 { //? granier_interference, granier_slab
        return max(r + t + luthier_interference(layer, cosines) * sqrt(r * t), vec3<f32>(0.0)); //? granier_interference
    } //? granier_interference, granier_slab
    return r + t; //? granier_slab|!granier_interference
}

/// f cos_theta_i of two beams, their interference and a diffuse term (Granier and Heidrich 2003, eq. 5-18).
fn luthier_eval_granier_heidrich($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let layer = $layer(material, 0u);
    var specular = vec3<f32>(0.0);
    var diffuse = vec3<f32>(1.0);
    let exponent = 2.0 / (layer.alpha * layer.alpha) - 2.0; //? interface
    if layer.kind == LUTHIER_DIELECTRIC || layer.film_thickness_nm > 0.0 { //? granier_film, granier_bare, film
    if layer.kind == LUTHIER_DIELECTRIC { //? granier_film, granier_bare, !film
        let eta = select(layer.ior_n, layer.film_ior_n, layer.film_thickness_nm > 0.0); //? granier_film, film
        let eta = layer.ior_n; //? granier_film, !film
        let normal = place.inner_normal; //? granier_film, place
        let normal = vec3<f32>(0.0, 0.0, 1.0); //? granier_film, !place
        let red = luthier_beams(wi, wo, eta.x, exponent, normal); //? granier_film
        let green = luthier_beams(wi, wo, eta.y, exponent, normal); //? granier_film
        let blue = luthier_beams(wi, wo, eta.z, exponent, normal); //? granier_film
        let r = vec3<f32>(red.reflected, green.reflected, blue.reflected); //? granier_film
        let t = vec3<f32>(red.transmitted, green.transmitted, blue.transmitted); //? granier_film
        specular = luthier_superposed(layer, r, t, vec3<f32>(red.cosines, green.cosines, blue.cosines)); //? granier_film
        // The mean of Schlick's reflectance (eq. 14). //? granier_film
        let mean = (21.0 * (eta * eta + 1.0) - 38.0 * eta) / (21.0 * (eta + 1.0) * (eta + 1.0)); //? granier_film
        diffuse = luthier_superposed(layer, mean, 1.0 - mean, vec3<f32>(2.0)); //? granier_film
    } //? granier_film, granier_bare
    if layer.kind == LUTHIER_CONDUCTOR && layer.film_thickness_nm <= 0.0 { //? granier_bare
    } //? granier_bare
    return specular + diffuse * luthier_base_albedo(material) * (wi.z / LUTHIER_PI);
}
