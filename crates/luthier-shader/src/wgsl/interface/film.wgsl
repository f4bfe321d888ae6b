/// Product of complex numbers.
fn luthier_complex_mul(a: LuthierComplex, b: LuthierComplex) -> LuthierComplex {
    return LuthierComplex(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re);
}

/// Airy's reflectance of a film for one polarisation, |(r_ab + r_bc e) / (1 + r_ab r_bc e)|^2 with amplitudes
/// r_ab = (a - b) / (a + b), r_bc = (b - c) / (b + c) and the phase factor e of one round trip through the film.
/// Multiplied out, so that no amplitude is divided by a vanishing sum.
fn luthier_airy(a: f32, b: LuthierComplex, c: LuthierComplex, e: LuthierComplex) -> vec3<f32> {
    let sum_ab = LuthierComplex(a + b.re, b.im);
    let diff_ab = LuthierComplex(a - b.re, -b.im);
    let sum_bc = LuthierComplex(b.re + c.re, b.im + c.im);
    let echo = luthier_complex_mul(LuthierComplex(b.re - c.re, b.im - c.im), e);
    let direct = luthier_complex_mul(diff_ab, sum_bc);
    let returned = luthier_complex_mul(sum_ab, echo);
    let passed = luthier_complex_mul(sum_ab, sum_bc);
    let trapped = luthier_complex_mul(diff_ab, echo);
    let num = LuthierComplex(direct.re + returned.re, direct.im + returned.im);
    let den = LuthierComplex(passed.re + trapped.re, passed.im + trapped.im);
    let den_sq = den.re * den.re + den.im * den.im;
    return (num.re * num.re + num.im * num.im) / max(den_sq, vec3<f32>(1e-30));
}

/// The normal index over the squared index, which takes its place for p-polarised light.
fn luthier_parallel_index(normal: LuthierComplex, ior_n: vec3<f32>, ior_k: vec3<f32>) -> LuthierComplex {
    let modulus_sq = ior_n * ior_n + ior_k * ior_k;
    let re = (ior_n * ior_n - ior_k * ior_k) / (modulus_sq * modulus_sq);
    let im = -2.0 * ior_n * ior_k / (modulus_sq * modulus_sq);
    return luthier_complex_mul(normal, LuthierComplex(re, im));
}

/// Reflectance of unpolarised light by the interface of a layer with its coherent film.
fn luthier_film(layer: LuthierLayer, cos_theta: f32) -> vec3<f32> {
    let film = luthier_normal_index(layer.film_ior_n, layer.film_ior_k, cos_theta);
    let below = luthier_normal_index(layer.ior_n, layer.ior_k, cos_theta);
    // Whole cycles are taken off first: sines of large angles are imprecise on GPUs.
    let cycles = 2.0 * film.re * layer.film_thickness_waves;
    let angle = 2.0 * LUTHIER_PI * (cycles - round(cycles));
    let decay = exp(-4.0 * LUTHIER_PI * film.im * layer.film_thickness_waves);
    let echo = LuthierComplex(decay * cos(angle), decay * sin(angle));
    let film_p = luthier_parallel_index(film, layer.film_ior_n, layer.film_ior_k);
    let below_p = luthier_parallel_index(below, layer.ior_n, layer.ior_k);
    return 0.5 * (luthier_airy(cos_theta, film, below, echo) + luthier_airy(cos_theta, film_p, below_p, echo));
}
