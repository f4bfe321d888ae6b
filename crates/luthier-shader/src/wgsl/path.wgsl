/// What the light has met on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    /// To the light, in the medium above the next layer.
    wi: vec3<f32>,
    /// To the eye, in the medium above the next layer.
    wo: vec3<f32>,
    /// Share of the light that comes down to the next layer and back out, times the outer cos_theta_i.
    throughput: vec3<f32>,
    /// Reflected by the layers so far: f cos_theta_i.
    reflected: vec3<f32>,
    /// Greatest slope parameter so far: a layer is never smoother than those above it.
    alpha: f32,
    /// Whether any light reaches the next layer.
    open: bool,
}

/// Adds what a diffuse base reflects. It ends the stack. //? chain_diffuse
fn luthier_add_diffuse(path: LuthierPath, layer: LuthierLayer) -> LuthierPath { //? chain_diffuse
    let brdf = luthier_diffuse(layer, path.wi, path.wo); //? chain_diffuse, oren_nayar
    let brdf = luthier_diffuse(layer); //? chain_diffuse, !oren_nayar
    var next = path; //? chain_diffuse
    next.reflected = path.reflected + path.throughput * brdf; //? chain_diffuse
    next.open = false; //? chain_diffuse
    return next; //? chain_diffuse
} //? chain_diffuse
