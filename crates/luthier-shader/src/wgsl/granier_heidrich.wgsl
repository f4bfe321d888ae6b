/// The transmitted beam of a film for one channel (Granier and Heidrich 2003, eq. 10). //? granier_transparent
struct LuthierBeam { //? granier_transparent
    /// T, scaled so that its lobe carries its coefficient. //? granier_transparent
    power: f32, //? granier_transparent
    /// Sum of the cosines in the film; 0 when nothing is transmitted. //? granier_transparent
    cosines: f32, //? granier_transparent
} //? granier_transparent

/// Schlick 1994. //? interface
fn luthier_schlick(normal: vec3<f32>, cos_theta: f32) -> vec3<f32> { //? interface
    let q = 1.0 - cos_theta; //? interface
    return normal + (1.0 - normal) * (q * q * q * q * q); //? interface
} //? interface

/// The beam through a film whose index over that outside is `eta`; `normal` is that of its inner boundary. //? granier_transparent
fn luthier_beam(wi: vec3<f32>, wo: vec3<f32>, eta: f32, exponent: f32, normal: vec3<f32>) -> LuthierBeam { //? granier_transparent
    let cosines_sq = (vec2<f32>(wi.z * wi.z, wo.z * wo.z) + (eta - 1.0) * (eta + 1.0)) / (eta * eta); //? granier_transparent
    if min(cosines_sq.x, cosines_sq.y) <= 0.0 { //? granier_transparent
        return LuthierBeam(0.0, 0.0); //? granier_transparent
    } //? granier_transparent
    let ti = vec3<f32>(wi.xy / eta, sqrt(cosines_sq.x)); //? granier_transparent
    let to = vec3<f32>(wo.xy / eta, sqrt(cosines_sq.y)); //? granier_transparent
    let across = dot(ti, normal); //? granier_transparent
    if min(across, dot(to, normal)) <= 0.0 { //? granier_transparent
        return LuthierBeam(0.0, 0.0); //? granier_transparent
    } //? granier_transparent
    // 2 across normal - ti - to without differences of rounded cosines: in a narrow lobe all of it cancels but a little. //? granier_transparent
    let tilt = normal.xy; //? granier_transparent
    let rise = (wi.z - wo.z) * (wi.z + wo.z) / (eta * eta * (ti.z + to.z)); //? granier_transparent
    let apart = vec3<f32>( //? granier_transparent
        2.0 * across * tilt - (wi.xy + wo.xy) / eta, //? granier_transparent
        2.0 * (dot(ti.xy, tilt) * normal.z - ti.z * dot(tilt, tilt)) + rise, //? granier_transparent
    ); //? granier_transparent
    let root = (eta - 1.0) / (eta + 1.0); //? granier_transparent
    let leaving = 1.0 - luthier_schlick(vec3<f32>(root * root), min(to.z, 1.0)).x; //? granier_transparent
    // The same of the way in, multiplied out: at grazing angles it is small. //? granier_transparent
    let c = wi.z; //? granier_transparent
    let entering = (1.0 - root * root) * c * (5.0 + c * (-10.0 + c * (10.0 + c * (-5.0 + c)))); //? granier_transparent
    // Directions crowd in the film by cos_theta_i / (eta^2 cos_theta_t). //? granier_transparent
    let crowding = wi.z / (eta * eta * ti.z); //? granier_transparent
    let lobe = (exponent + 1.0) / (2.0 * LUTHIER_PI) * luthier_power_lobe(0.5 * dot(apart, apart), exponent); //? granier_transparent
    return LuthierBeam(entering * leaving * crowding * lobe, ti.z + to.z); //? granier_transparent
} //? granier_transparent

/// Two powers and their interference for the sums of the cosines in the film (eq. 3-5); a slab is too thick for it. //? granier_transparent
fn luthier_superposed(layer: LuthierLayer, r: vec3<f32>, t: vec3<f32>, cosines: vec3<f32>) -> vec3<f32> { //? granier_transparent
    if layer.film_ior_n.x <= 0.0 { //? granier_transparent, granier_film
        return r + t; //? granier_transparent
    } //? granier_transparent, granier_film
    let s = cosines * (0.5 * layer.film_thickness_nm / layer.film_thickness_max_nm); //? granier_film, phase
    let red = luthier_lookup_phase(layer.phase_tile, s.x).x; //? granier_film, phase
    let green = luthier_lookup_phase(layer.phase_tile, s.y).y; //? granier_film, phase
    let blue = luthier_lookup_phase(layer.phase_tile, s.z).z; //? granier_film, phase
    let swing = vec3<f32>(red, green, blue); //? granier_film, phase
    // Whole cycles are taken off first: sines of large angles are imprecise on GPUs. //? granier_film, !phase
    let cycles = layer.film_ior_n * layer.film_waves * cosines; //? granier_film, !phase
    let swing = 2.0 * cos(2.0 * LUTHIER_PI * (cycles - round(cycles))); //? granier_film, !phase
    return max(r + t + swing * sqrt(r * t), vec3<f32>(0.0)); //? granier_film
} //? granier_transparent

/// f cos_theta_i of two beams, their interference and a diffuse term (Granier and Heidrich 2003, eq. 5-18).
fn luthier_eval_granier_heidrich($place_parameter material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let layer = $layer(material, 0u);
    var specular = vec3<f32>(0.0);
    var diffuse = vec3<f32>(1.0); //? granier_base
    let exponent = 2.0 / (layer.alpha * layer.alpha) - 2.0; //? interface
    let apart = vec3<f32>(wi.xy + wo.xy, wi.z - wo.z); //? interface
    let mirror = (exponent + 1.0) / (2.0 * LUTHIER_PI) * luthier_power_lobe(0.5 * dot(apart, apart), exponent); //? interface
    let has_film = layer.film_ior_n.x > 0.0; //? granier_film
    if layer.kind == LUTHIER_DIELECTRIC || has_film { //? granier_film
    if layer.kind == LUTHIER_DIELECTRIC { //? granier_transparent, !granier_film
        let eta = select(layer.ior_n, layer.film_ior_n, has_film); //? granier_film
        let eta = layer.ior_n; //? granier_transparent, !granier_film
        let root = (eta - 1.0) / (eta + 1.0); //? granier_transparent
        let normal = place.inner_normal; //? granier_transparent, place
        let normal = vec3<f32>(0.0, 0.0, 1.0); //? granier_transparent, !place
        let red = luthier_beam(wi, wo, eta.x, exponent, normal); //? granier_transparent
        let green = luthier_beam(wi, wo, eta.y, exponent, normal); //? granier_transparent
        let blue = luthier_beam(wi, wo, eta.z, exponent, normal); //? granier_transparent
        let r = luthier_schlick(root * root, wi.z) * mirror; //? granier_transparent
        let t = vec3<f32>(red.power, green.power, blue.power); //? granier_transparent
        specular = luthier_superposed(layer, r, t, vec3<f32>(red.cosines, green.cosines, blue.cosines)); //? granier_transparent
        // The mean of Schlick's reflectance (eq. 14). //? granier_transparent, granier_base
        let mean = (21.0 * (eta * eta + 1.0) - 38.0 * eta) / (21.0 * (eta + 1.0) * (eta + 1.0)); //? granier_transparent, granier_base
        diffuse = luthier_superposed(layer, mean, 1.0 - mean, vec3<f32>(2.0)); //? granier_transparent, granier_base
    } //? granier_transparent
    if layer.kind == LUTHIER_CONDUCTOR && !has_film { //? granier_bare, granier_film
    if layer.kind == LUTHIER_CONDUCTOR { //? granier_bare, !granier_film
        specular = luthier_schlick(luthier_fresnel_term(layer, 1.0), wi.z) * mirror; //? granier_bare
    } //? granier_bare
    let last = luthier_layer(material, luthier_layer_count(material) - 1u); //? granier_base
    if last.kind == LUTHIER_DIFFUSE { //? granier_base
        specular += diffuse * last.lambert * wi.z; //? granier_base
    } //? granier_base
    return specular;
}
