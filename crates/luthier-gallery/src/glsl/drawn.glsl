// Surroundings through luthier_eval: the same number of directions for each interface and for a cosine, Hammersley points shifted by a seed,
// weighed by the balance heuristic (Veach 1997, eq. 9.8).

// Directions per lobe of the whole picture, and those of this pass.
uniform int view_directions;
uniform int view_first_direction;
uniform int view_direction_count;

float view_lobe(uint material, uint index) {
    float alpha = 0.0;
    float spread = 1.0;
    for (uint i = 0u; i <= index; i++) {
        ViewLayer layer = view_layer(material, i);
        if (layer.kind == 2u) {
            return 0.0;
        }
        alpha = layer.alpha * view_slopes;
        if (i < index) {
            spread *= layer.eta;
        }
    }
    return clamp(alpha * spread, 1e-3, 1.0);
}

float view_density(float alpha, vec3 wi, vec3 wo) {
    vec3 wh = normalize(wi + wo);
    float root = alpha / max(alpha * alpha * wh.z * wh.z + dot(wh.xy, wh.xy), 1e-20);
    return root * root * wh.z / (4.0 * VIEW_PI * max(dot(wh, wo), 1e-6));
}

vec3 view_draw(float alpha, vec2 u, vec3 wo) {
    float phi = 2.0 * VIEW_PI * u.y;
    vec2 around = vec2(cos(phi), sin(phi));
    if (alpha == 0.0) {
        return vec3(around * sqrt(u.x), sqrt(1.0 - u.x));
    }
    float tan_sq = alpha * alpha * u.x / max(1.0 - u.x, 1e-7);
    return reflect(-wo, vec3(around * sqrt(tan_sq), 1.0) * inversesqrt(1.0 + tan_sq));
}

uint view_hash(uint x) {
    // PCG output function (Jarzynski and Olano 2020).
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float view_unit(uint x) {
    return float(x >> 8u) * (1.0 / 16777216.0);
}

uint view_reversed(uint x) {
    x = (x >> 16u) | (x << 16u);
    x = ((x & 0xff00ff00u) >> 8u) | ((x & 0x00ff00ffu) << 8u);
    x = ((x & 0xf0f0f0f0u) >> 4u) | ((x & 0x0f0f0f0fu) << 4u);
    x = ((x & 0xccccccccu) >> 2u) | ((x & 0x33333333u) << 2u);
    return ((x & 0xaaaaaaaau) >> 1u) | ((x & 0x55555555u) << 1u);
}

vec3 view_surroundings(uint material, ViewSurface surface, mat3 frame, vec3 wo_world, uint seed) {
    vec3 wo = wo_world * frame;
    uint lobes = view_layer_count(material) + 1u;
    vec3 total = vec3(0.0);
    for (uint lobe = 0u; lobe < lobes; lobe++) {
        float alpha = 0.0;
        if (lobe + 1u < lobes) {
            alpha = view_lobe(material, lobe);
            if (alpha == 0.0) {
                continue;
            }
        }
        uint first = view_hash(seed * 16u + lobe);
        vec2 shift = vec2(view_unit(first), view_unit(view_hash(first)));
        for (int k = 0; k < view_direction_count; k++) {
            uint i = uint(view_first_direction + k);
            vec2 point = vec2((float(i) + 0.5) / float(view_directions), view_unit(view_reversed(i)));
            vec3 wi = view_draw(alpha, fract(point + shift), wo);
            if (wi.z <= 0.0) {
                continue;
            }
            float density = wi.z / VIEW_PI;
            for (uint other = 0u; other + 1u < lobes; other++) {
                float other_alpha = view_lobe(material, other);
                if (other_alpha > 0.0) {
                    density += view_density(other_alpha, wi, wo);
                }
            }
            total += view_lit(material, surface, wi, wo, view_radiance(frame * wi)) / (density * float(view_directions));
        }
    }
    return total;
}
