// Model: elek (O. Elek, Layered Materials in Real-Time Rendering, CESCG 2010).
// No tables: Fresnel equations at three wavelengths, closed forms of D.
// Needs `precision highp float;` and `precision highp int;` above.
//
// Bindings, by name:
//   luthier_materials: uniform block LuthierMaterials (std140), 31 vec4
//
// Materials:
//   0 varnished-gold, elek, 2 layers

// One layer of a material. Indices are relative to the medium above it; tiles are -1 where there is none.
struct LuthierLayer {
    // 0 dielectric, 1 conductor, 2 diffuse base.
    uint kind;
    // Slope parameter of the micro-surface.
    float alpha;
    // Index below over index above, for the refracted directions.
    float eta;
    // Slope distribution: 0 Beckmann, 1 GGX.
    float distribution;
    // Real part of the index below, at three wavelengths.
    vec3 ior_n;
    // Imaginary part of it.
    vec3 ior_k;
};

// Complex numbers at three wavelengths.
struct LuthierComplex {
    vec3 re;
    vec3 im;
};

// What the light has met on its way down and back up: directions, and sums over the layers so far.
struct LuthierPath {
    // To the light, in the medium above the next layer.
    vec3 wi;
    // To the eye, in the medium above the next layer.
    vec3 wo;
    // Sum of their tangential parts. It nearly cancels in a highlight, so that it is refracted as a whole.
    vec2 across;
    // Share of the light that comes down to the next layer and back out, times the outer cos_theta_i.
    vec3 throughput;
    // Reflected by the layers so far: f cos_theta_i.
    vec3 reflected;
    // Greatest slope parameter so far: a layer is never smoother than those above it.
    float alpha;
    // Whether any light reaches the next layer.
    bool open;
};

const uint LUTHIER_MATERIAL_VARNISHED_GOLD = 0u;
const float LUTHIER_PI = 3.1415927;
const uint LUTHIER_MATERIAL_WORDS = 11u;
const uint LUTHIER_LAYER_WORDS = 10u;

layout(std140) uniform LuthierMaterials { vec4 luthier_materials[31]; };

// Index of the first word of a material in the buffer.
uint luthier_header(uint material) {
    return material * LUTHIER_MATERIAL_WORDS;
}

// Number of layers of a material.
uint luthier_layer_count(uint material) {
    return uint(luthier_materials[luthier_header(material)].y);
}

// A layer of a material, counted from the top.
LuthierLayer luthier_layer(uint material, uint index) {
    LuthierLayer layer = LuthierLayer(0u, 0.0, 0.0, 0.0, vec3(0.0), vec3(0.0));
    uint first = uint(luthier_materials[luthier_header(material)].x) + (index * LUTHIER_LAYER_WORDS);
    vec4 head = luthier_materials[first];
    vec4 base = luthier_materials[first + 3u];
    vec4 real_part = luthier_materials[first + 4u];
    vec4 imaginary_part = luthier_materials[first + 5u];
    layer.kind = uint(head.x);
    layer.alpha = head.y;
    layer.eta = head.z;
    layer.distribution = base.w;
    layer.ior_n = real_part.xyz;
    layer.ior_k = imaginary_part.xyz;
    return layer;
}

// Normal component of the wave vector in a medium, over that above: sqrt((n + i k)^2 - sin_theta^2), both parts >= 0.
// Formed without cancellation for an index near 1, under total reflection, and for weak absorption.
LuthierComplex luthier_normal_index(vec3 ior_n, vec3 ior_k, float cos_theta) {
    vec3 square = (((ior_n - vec3(1.0)) * (ior_n + vec3(1.0))) - (ior_k * ior_k)) + vec3(cos_theta * cos_theta);
    vec3 product = ior_n * ior_k;
    vec3 modulus = sqrt((square * square) + ((4.0 * product) * product));
    vec3 large_sq = 0.5 * (modulus + abs(square));
    vec3 small_sq = (product * product) / max(large_sq, vec3(1e-30));
    bvec3 propagates = greaterThanEqual(square, vec3(0.0));
    vec3 re_sq = mix(small_sq, large_sq, propagates);
    vec3 im_sq = mix(large_sq, small_sq, propagates);
    return LuthierComplex(sqrt(re_sq), sqrt(im_sq));
}

// Exact Fresnel reflectance of unpolarised light for the relative index n + i k, total reflection included.
vec3 luthier_fresnel(vec3 ior_n, vec3 ior_k, float cos_theta) {
    LuthierComplex below = luthier_normal_index(ior_n, ior_k, cos_theta);
    float sin_sq = 1.0 - (cos_theta * cos_theta);
    vec3 im_sq = below.im * below.im;
    vec3 difference = below.re - vec3(cos_theta);
    vec3 sum = below.re + vec3(cos_theta);
    vec3 refl_s = ((difference * difference) + im_sq) / ((sum * sum) + im_sq);
    vec3 along = below.re * cos_theta;
    vec3 across = (im_sq * cos_theta) * cos_theta;
    vec3 refl_ratio = (((along - vec3(sin_sq)) * (along - vec3(sin_sq))) + across) / (((along + vec3(sin_sq)) * (along + vec3(sin_sq))) + across);
    return (0.5 * refl_s) * (vec3(1.0) + refl_ratio);
}

// pi alpha^2 D of Beckmann. Below a cosine of 0.1 it is zero in f32 for any alpha <= 1.
float luthier_beckmann(float alpha, float cos_theta_h, float sin_theta_h_sq) {
    float secant_sq = 1.0 / max(cos_theta_h * cos_theta_h, 0.01);
    return exp((-(sin_theta_h_sq) * secant_sq) / (alpha * alpha)) * (secant_sq * secant_sq);
}

// pi alpha^2 D of GGX (Trowbridge-Reitz).
float luthier_ggx(float alpha, float cos_theta_h, float sin_theta_h_sq) {
    float alpha_sq = alpha * alpha;
    float ratio = alpha_sq / (((alpha_sq * cos_theta_h) * cos_theta_h) + sin_theta_h_sq);
    return ratio * ratio;
}

// Fresnel reflectance of a layer at three wavelengths, its film included.
vec3 luthier_fresnel_term(LuthierLayer layer, float cos_theta_d) {
    return luthier_fresnel(layer.ior_n, layer.ior_k, cos_theta_d);
}

// pi alpha^2 D of a layer, in closed form.
float luthier_distribution_term(LuthierLayer layer, float alpha, float cos_theta_h, float sin_theta_h_sq) {
    if (layer.distribution > 0.5) {
        return luthier_ggx(alpha, cos_theta_h, sin_theta_h_sq);
    }
    return luthier_beckmann(alpha, cos_theta_h, sin_theta_h_sq);
}

// D of a layer at the half vector along `bisector`, whose squared length is `length_sq`.
float luthier_density(LuthierLayer layer, vec3 bisector, float length_sq) {
    float inverse_length = inversesqrt(length_sq);
    float cos_theta_h = bisector.z * inverse_length;
    float sin_theta_h_sq = (dot(bisector.xy, bisector.xy) * inverse_length) * inverse_length;
    float area = layer.alpha * layer.alpha;
    float alpha = layer.alpha;
    return (luthier_distribution_term(layer, alpha, cos_theta_h, sin_theta_h_sq) / LUTHIER_PI) / area;
}

// Adds what a rough interface reflects (Torrance-Sparrow, F D G / (4 cos_theta_i cos_theta_o)) and goes on to the
// layer below it (Weidlich and Wilkie 2007; Elek 2010, eq. 2-4).
LuthierPath luthier_add_interface(LuthierPath path, LuthierLayer layer) {
    LuthierPath next = path;
    next.open = false;
    vec3 bisector = vec3(path.across, path.wi.z + path.wo.z);
    float length_sq = dot(bisector.xy, bisector.xy) + (bisector.z * bisector.z);
    if (length_sq < 1e-24) {
        return next;
    }
    float inverse_length = inversesqrt(length_sq);
    float cos_theta_d = min((0.5 * length_sq) * inverse_length, 1.0);
    vec3 fresnel = luthier_fresnel_term(layer, cos_theta_d);
    float cavity = (4.0 * (bisector.z * inverse_length)) * inverse_length;
    vec2 cosines = max(vec2(path.wi.z, path.wo.z), vec2(1e-18));
    float masking = min(cavity * min(cosines.x, cosines.y), 1.0);
    float shape = (luthier_density(layer, bisector, length_sq) * masking) / ((4.0 * cosines.x) * cosines.y);
    next.reflected = path.reflected + ((path.throughput * fresnel) * shape);
    float inverse_eta = 1.0 / layer.eta;
    vec2 cosines_sq = ((cosines * cosines) + vec2((layer.eta - 1.0) * (layer.eta + 1.0))) * (inverse_eta * inverse_eta);
    if (min(cosines_sq.x, cosines_sq.y) <= 0.0) {
        return next;
    }
    vec2 secants = inversesqrt(cosines_sq);
    vec2 refracted = cosines_sq * secants;
    next.wi = vec3(path.wi.xy * inverse_eta, refracted.x);
    next.wo = vec3(path.wo.xy * inverse_eta, refracted.y);
    next.across = path.across * inverse_eta;
    next.open = true;
    vec3 crossed = vec3(1.0) - fresnel;
    vec3 kept = crossed * (vec3(1.0 - masking) + (crossed * masking));
    next.throughput = path.throughput * kept;
    return next;
}

// Adds an interface, which is never smoother than those above it.
LuthierPath luthier_elek_interface(LuthierPath path, LuthierLayer layer) {
    LuthierLayer rougher = layer;
    rougher.alpha = max(path.alpha, layer.alpha);
    LuthierPath next = luthier_add_interface(path, rougher);
    next.alpha = rougher.alpha;
    return next;
}

// f cos_theta_i of the model `elek`, both directions above the horizon.
vec3 luthier_eval_elek(uint material, vec3 wi, vec3 wo) {
    LuthierPath path = LuthierPath(wi, wo, wi.xy + wo.xy, vec3(wi.z), vec3(0.0), 0.0, true);
    path = luthier_elek_interface(path, luthier_layer(material, 0u));
    if (path.open) {
        path = luthier_elek_interface(path, luthier_layer(material, 1u));
    }
    return path.reflected;
}

// f cos_theta_i, RGB, of a material for light from wi seen from wo: unit, in the local frame (+z is the normal), away
// from the surface. Zero when either is not above the horizon.
vec3 luthier_eval(uint material, vec3 wi, vec3 wo) {
    if (min(wi.z, wo.z) <= 0.0) {
        return vec3(0.0);
    }
    return luthier_eval_elek(material, wi, wo);
}
