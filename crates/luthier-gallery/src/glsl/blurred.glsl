// Surroundings that were blurred beforehand, weighed by the albedo of every interface.

struct ViewFactors {
    vec3 normal;
    float alpha;
    float slab;
    float film;
    // Normal below the first interface, in the frame of `normal`.
    vec3 below;
    // Below 0: none.
    float patina;
};

ViewFactors view_factors(uint material, ViewSurface surface) {
    ViewFactors factors = ViewFactors(vec3(0.0, 0.0, 1.0), 1.0, 1.0, 1.0, vec3(0.0, 0.0, 1.0), -1.0);
#ifdef VIEW_PLACES
    factors.normal = surface.normal;
    factors.alpha = surface.alpha_factor;
    factors.slab = surface.slab_factor;
    factors.film = surface.film_factor;
#ifdef VIEW_TILTED
    factors.below = surface.flake_normal;
#endif
#ifdef VIEW_PATINA
    factors.patina = surface.patina;
#endif
#ifdef VIEW_COVERS
    factors.patina = luthier_cover(surface, material);
#endif
#endif
    return factors;
}

// The frame whose +z is `n`, turned the shortest way, as luthier_eval_at turns it.
mat3 view_turned_frame(mat3 frame, vec3 n) {
    float a = 1.0 / (1.0 + max(n.z, 0.0));
    float shear = -n.x * n.y * a;
    return frame * mat3(vec3(1.0 - n.x * n.x * a, shear, -n.x), vec3(shear, 1.0 - n.y * n.y * a, -n.y), n);
}

#ifdef VIEW_LOBES
vec3 view_environment(uint material, ViewSurface surface, ViewFactors factors, mat3 frame, vec3 wo_world, float turn) {
    vec3 wo = wo_world * frame;
    wo.z = max(wo.z, 1e-4);
    mat3 sky = mat3(view_turned(frame[0]), view_turned(frame[1]), view_turned(frame[2]));
#ifdef VIEW_PLACES
    return luthier_environment_lobes(luthier_prepare_lobes(surface, material, wo), sky, turn);
#else
    return luthier_environment_lobes(luthier_prepare_lobes(material, wo), sky, turn);
#endif
}
#else

vec3 view_diffuse(vec3 normal) {
    return view_read(1, view_turned(normal));
}

// Around a mirrored direction, blurred by a rough mirror.
vec3 view_mirrored(bool is_ggx, float alpha, vec3 direction) {
    int chain = is_ggx ? view_chains.y : view_chains.x;
    vec3 around = view_turned(direction);
    float octaves = 2.0 * (log2(max(alpha, 1e-6)) + 6.0);
    if (octaves < 0.0) {
        return mix(view_read(0, around), view_read(chain, around), alpha * 64.0);
    }
    float place = min(octaves, 12.0);
    int low = int(place);
    return mix(view_read(chain + low, around), view_read(chain + min(low + 1, 12), around), fract(place));
}

float view_row_cosine(ViewLayer layer, float cos_theta) {
    float sin_theta_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
    return sqrt(max(cos_theta * cos_theta - layer.critical_cot_sq * sin_theta_sq, 0.0));
}

float view_refract(float cos_theta, float eta) {
    return sqrt(max(1.0 - (1.0 - cos_theta * cos_theta) / (eta * eta), 0.0));
}

vec3 view_fresnel(float tile, float cos_theta) {
#ifdef VIEW_FRESNEL
    return luthier_lookup_fresnel(tile, cos_theta);
#else
    return vec3(0.0);
#endif
}

vec3 view_prefiltered(uint material, ViewFactors factors, bool is_bare, mat3 frame, vec3 wo) {
    vec4 patina = view_word(material * VIEW_MATERIAL_WORDS + 6u);
    vec3 patina_albedo = view_word(material * VIEW_MATERIAL_WORDS + 7u).rgb;
    vec3 tarnish = vec3(1.0);
    if (factors.patina >= 0.0) {
        tarnish = mix(tarnish, view_word(material * VIEW_MATERIAL_WORDS + 8u).rgb, factors.patina);
    }
    vec3 mirrored = frame * vec3(-wo.xy, wo.z);
    vec3 leaving = vec3(1.0);
    vec3 entering = vec3(1.0);
    float cos_out = clamp(wo.z, 1e-4, 1.0);
    float cos_in = 2.0 / 3.0;
    float alpha = 0.0;
    float spread = 1.0;
    vec3 total = vec3(0.0);
    uint count = view_layer_count(material);
    for (uint i = is_bare ? 1u : 0u; i < count; i++) {
        ViewLayer layer = view_layer(material, is_bare && i == 1u ? count : i);
        if (layer.kind == 2u) {
            total += leaving * entering * layer.albedo * view_diffuse(frame[2]);
            break;
        }
        layer.alpha = min(layer.alpha * factors.alpha, 1.0);
        if (i == 1u && factors.patina >= 0.0 && patina.z >= 0.0) {
            layer.alpha = mix(layer.alpha, patina.z, factors.patina);
        }
        alpha = max(alpha, layer.alpha);
        float row_out = view_row_cosine(layer, cos_out);
        float row_in = view_row_cosine(layer, cos_in);
        vec3 reflected_out = view_fresnel(layer.fresnel_tile, row_out);
        vec3 reflected_in = view_fresnel(layer.fresnel_tile, row_in);
        vec3 albedo = reflected_out;
        bool has_film = false;
#ifdef VIEW_FILM
        if (layer.film_tile >= 0.0) {
            has_film = true;
            float fraction = layer.film_fraction * (i == 0u ? factors.film : 1.0);
            reflected_out = luthier_lookup_film(layer.film_tile, row_out, fraction);
            reflected_in = luthier_lookup_film(layer.film_tile, row_in, fraction);
            albedo = reflected_out;
        }
#endif
#ifdef VIEW_FGD
        if (!has_film && layer.fgd_tile >= 0.0) {
            albedo = luthier_lookup_fgd(layer.fgd_tile, cos_out, alpha).rgb;
        }
#endif
        if (i > 0u) {
            albedo *= tarnish;
        }
        total += leaving * leaving * albedo * view_mirrored(layer.is_ggx, min(alpha * spread, 1.0), mirrored);
        if (i == 0u && factors.patina > 0.0) {
            total += (1.0 - reflected_out) * (1.0 - reflected_in) * patina_albedo * view_diffuse(frame[2]);
        }
        if (layer.kind == 1u) {
            break;
        }
        cos_out = view_refract(cos_out, layer.eta);
        cos_in = view_refract(cos_in, layer.eta);
        if (min(cos_out, cos_in) <= 0.0) {
            break;
        }
        if (i == 0u && factors.below.z < 1.0) {
            // What a tilted mirror below the interface shows.
            vec3 down = vec3(wo.xy / layer.eta, cos_out);
            vec3 up = reflect(-down, factors.below);
            float across_sq = dot(up.xy, up.xy) * layer.eta * layer.eta;
            cos_out = dot(down, factors.below);
            if (min(cos_out, up.z) <= 0.0 || across_sq >= 1.0) {
                break;
            }
            mirrored = frame * vec3(up.xy * layer.eta, sqrt(1.0 - across_sq));
        }
        vec3 depth = layer.optical_depth * (i == 0u ? factors.slab : 1.0);
        leaving *= (1.0 - reflected_out) * exp(-depth / cos_out);
        entering *= (1.0 - reflected_in) * exp(-depth / cos_in);
        spread *= layer.eta;
    }
    return total;
}

vec3 view_environment(uint material, ViewSurface surface, ViewFactors factors, mat3 frame, vec3 wo_world, float turn) {
    vec3 wo = wo_world * frame;
    float grown = factors.patina >= 0.0 ? factors.patina : 1.0;
    vec3 total = vec3(0.0);
    if (grown < 1.0) {
        total += (1.0 - grown) * view_prefiltered(material, factors, true, frame, wo);
    }
    if (grown > 0.0) {
        total += grown * view_prefiltered(material, factors, false, frame, wo);
    }
    return total;
}
#endif

vec3 view_surroundings(uint material, ViewSurface surface, mat3 frame, vec3 wo_world, uint seed) {
    ViewFactors factors = view_factors(material, surface);
    // One sample does not turn.
    float turn = view_samples > 1 ? (float(view_sample) + 0.5) / float(view_samples * view_samples) : 0.0;
    return view_environment(material, surface, factors, view_turned_frame(frame, factors.normal), wo_world, turn);
}
