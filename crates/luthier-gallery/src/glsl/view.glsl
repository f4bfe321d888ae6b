// A ball under lights and surroundings: one sample of every pixel, added to those before. The numbers are those of luthier-gpu's kernel.

uniform highp sampler2D view_before;
uniform bool view_is_first;
uniform int view_size;
// Samples along the side of a pixel, and the number of this one.
uniform int view_samples;
uniform int view_sample;
uniform vec3 view_eye;
// Half the picture, in the plane through the centre of the ball.
uniform vec3 view_right;
uniform vec3 view_up;
uniform uint view_material;
// Of the materials whose slopes the size of the lights has widened, behind all others.
uniform uint view_lit_material;
uniform vec3 view_light;
uniform vec3 view_irradiance;
// Whether this pass adds the lights, and what is behind the ball.
uniform bool view_is_lit;
uniform vec3 view_backdrop;
uniform bool view_shows_sky;
// Cosine and sine of the turn of the surroundings about the vertical.
uniform vec2 view_sky;
// Maps of the surroundings one below the other: the map, irradiance over pi, the blurred maps of Beckmann and of GGX.
uniform highp sampler2D view_maps;
// First row, columns, rows.
uniform ivec3 view_headers[28];
// First blurred map of Beckmann and of GGX.
uniform ivec2 view_chains;
// Factor on all slope parameters beside those of textures; other than 1 only where there are places.
uniform float view_slopes;

const float VIEW_PI = 3.14159265358979;

struct ViewPlace {
    vec3 position;
    vec3 normal;
    vec3 tangent;
    vec2 uv;
};

bool view_ball(vec3 ray, out ViewPlace place) {
    // Point of the ray nearest to the centre, formed without cancellation.
    vec3 moment = cross(view_eye, ray);
    float depth_sq = 1.0 - dot(moment, moment);
    if (depth_sq <= 0.0) {
        return false;
    }
    vec3 n = normalize(cross(ray, moment) - sqrt(depth_sq) * ray);
    vec3 along = vec3(n.z, 0.0, -n.x);
    float length_sq = dot(along, along);
    place.position = n;
    place.normal = n;
    place.tangent = length_sq > 1e-12 ? along * inversesqrt(length_sq) : normalize(cross(n, vec3(1.0, 0.0, 0.0)));
    place.uv = vec2(0.5 + atan(n.x, n.z) / (2.0 * VIEW_PI), acos(clamp(n.y, -1.0, 1.0)) / VIEW_PI);
    return true;
}

// A direction of the scene among the surroundings.
vec3 view_turned(vec3 d) {
    return vec3(view_sky.x * d.x + view_sky.y * d.z, d.y, view_sky.x * d.z - view_sky.y * d.x);
}

vec3 view_read(int map, vec3 direction) {
    ivec3 header = view_headers[map];
    vec2 uv = vec2(
        0.5 + atan(direction.x, -direction.z) / (2.0 * VIEW_PI),
        atan(length(direction.xz), direction.y) / VIEW_PI
    );
    vec2 position = uv * vec2(header.yz) - 0.5;
    vec2 corner = floor(position);
    vec2 weight = position - corner;
    int left = (int(corner.x) + header.y) % header.y;
    int right = (left + 1) % header.y;
    int top = header.x + clamp(int(corner.y), 0, header.z - 1);
    int bottom = header.x + clamp(int(corner.y) + 1, 0, header.z - 1);
    vec3 above = mix(texelFetch(view_maps, ivec2(left, top), 0).rgb, texelFetch(view_maps, ivec2(right, top), 0).rgb, weight.x);
    vec3 below = mix(texelFetch(view_maps, ivec2(left, bottom), 0).rgb, texelFetch(view_maps, ivec2(right, bottom), 0).rgb, weight.x);
    return mix(above, below, weight.y);
}

vec3 view_radiance(vec3 direction) {
    return view_read(0, view_turned(direction));
}

// Words of the material buffer, as docs/manifest.md lists them.
vec4 view_word(uint index) {
    uint width = uint(textureSize(luthier_materials, 0).x);
    return texelFetch(luthier_materials, ivec2(index % width, index / width), 0);
}

uint view_whole(float word) {
    return floatBitsToUint(word) & 0x7fffffu;
}

struct ViewLayer {
    uint kind;
    float alpha;
    float eta;
    bool is_ggx;
    float fresnel_tile;
    float fgd_tile;
    float film_tile;
    float film_fraction;
    vec3 optical_depth;
    float critical_cot_sq;
    vec3 albedo;
};

uint view_layer_count(uint material) {
    return view_whole(view_word(material * VIEW_MATERIAL_WORDS).y);
}

ViewLayer view_layer(uint material, uint index) {
    uint first = view_whole(view_word(material * VIEW_MATERIAL_WORDS).x) + index * VIEW_LAYER_WORDS;
    vec4 head = view_word(first + 10u);
    vec4 base = view_word(first + 3u);
    ViewLayer layer;
    layer.kind = view_whole(head.x) & 3u;
    layer.alpha = head.y;
    layer.eta = head.z;
    // ABC is blurred as GGX, all others as Beckmann.
    layer.is_ggx = base.w == 1.0 || base.w == 3.0;
    layer.fresnel_tile = VIEW_FRESNEL_TILE;
    layer.fgd_tile = VIEW_FGD_TILE;
    layer.film_tile = VIEW_FILM_TILE;
    layer.film_fraction = view_word(first + 4u).w / max(view_word(first + 5u).w, 1e-30);
    layer.optical_depth = view_word(first + 2u).rgb * 0.69314718;
    layer.critical_cot_sq = view_word(first + 7u).w;
    layer.albedo = base.rgb * VIEW_PI;
    return layer;
}

#ifdef VIEW_PLACES
// Textures of the material one below the other: normals, roughness, thickness, patina, flakes, albedo, lean, weight. First row, columns, rows; no columns
// where there is none.
uniform highp sampler2D view_textures;
uniform ivec3 view_slots[8];
// Two rows for each, which make its texture coordinates of the surface's.
uniform highp vec3 view_turns[16];

vec2 view_uv(int map, vec2 uv) {
    return vec2(dot(view_turns[2 * map], vec3(uv, 1.0)), dot(view_turns[2 * map + 1], vec3(uv, 1.0)));
}

vec4 view_texel(ivec3 slot, vec2 at) {
    vec2 size = vec2(slot.yz);
    ivec2 wrapped = ivec2(clamp(at - floor(at / size) * size, vec2(0.0), size - 1.0));
    return texelFetch(view_textures, ivec2(wrapped.x, slot.x + wrapped.y), 0);
}

vec4 view_bilinear(int map, vec2 uv) {
    ivec3 slot = view_slots[map];
    vec2 position = fract(view_uv(map, uv)) * vec2(slot.yz) - 0.5;
    vec2 corner = floor(position);
    vec2 weight = position - corner;
    vec4 above = mix(view_texel(slot, corner), view_texel(slot, corner + vec2(1.0, 0.0)), weight.x);
    vec4 below = mix(view_texel(slot, corner + vec2(0.0, 1.0)), view_texel(slot, corner + 1.0), weight.x);
    return mix(above, below, weight.y);
}

#ifdef VIEW_LIVE
// Numbers of the sliders. Of the whole surface: factors on slab, weight and slopes; albedo of a base, which counts where w is 1, and is a factor on the
// texels of its map where w is 2; base colour and metal, which count where w is not below 0; nothing. Of each layer: factors on both slope parameters
// and on the slab, and the turn of its tangent in degrees; factors on what the slab absorbs.
uniform highp vec4 view_live[4 + 2 * VIEW_LIVE_LAYERS];

LuthierPlace view_lively(LuthierPlace given, uint material) {
    LuthierPlace place = given;
    place.slab_factor *= view_live[0].x;
#ifdef VIEW_WEIGHTS
    place.weight_factor *= view_live[0].y;
#endif
    place.alpha_factor *= view_live[0].z;
#ifdef VIEW_COLORS
    if (view_live[1].w > 0.5) {
        place.base_color = view_live[1].w > 1.5 ? view_live[1].rgb * place.base_color : view_live[1].rgb;
    }
#endif
    for (int i = 0; i < VIEW_LIVE_LAYERS; i++) {
#ifdef VIEW_OWN_ALPHAS
        place.layers[i].alpha_factors *= view_live[4 + 2 * i].xy;
#endif
#ifdef VIEW_OWN_SLABS
        place.layers[i].slab_factor *= view_live[4 + 2 * i].z;
#endif
#ifdef VIEW_OWN_TANGENTS
        float turn = radians(view_live[4 + 2 * i].w);
        place.layers[i].tangent = vec2(cos(turn), sin(turn));
#endif
#ifdef VIEW_OWN_TINTS
        place.layers[i].absorption_factors *= view_live[5 + 2 * i].rgb;
#endif
    }
#ifdef VIEW_METALS
    // After the weight: the colour below a coat may depend on it.
    if (view_live[2].w >= 0.0) {
        place = luthier_metallic_place(place, material, view_live[2].rgb, view_live[2].w);
    }
#endif
    return place;
}
#endif

#define ViewSurface LuthierPlace
LuthierPlace view_surface(uint material, vec2 uv, float distance) {
    LuthierPlace place = luthier_place();
    if (view_slots[0].y > 0) {
        vec3 n = 2.0 * view_bilinear(0, uv).xyz - 1.0;
        place.normal = normalize(vec3(n.xy, max(n.z, 1e-3)));
    }
    if (view_slots[1].y > 0) {
        float roughness = view_bilinear(1, uv).x;
        place.alpha_factor = roughness * roughness;
    }
    place.alpha_factor *= view_slopes;
    if (view_slots[2].y > 0) {
        place.slab_factor = view_bilinear(2, uv).x;
    }
#ifdef VIEW_FILMS
    place = luthier_film_place(place, material, uv);
#endif
#ifdef VIEW_FLAKES
    place.flake_normal = luthier_flake_normal(material, uv, distance);
    if (view_slots[4].y > 0) {
        float tiling = view_word(material * VIEW_MATERIAL_WORDS + 4u).w;
        vec3 flake = 2.0 * view_texel(view_slots[4], floor(fract(view_uv(4, uv * tiling)) * vec2(view_slots[4].yz))).xyz - 1.0;
        place.flake_normal = luthier_flake_tilt(material, flake, distance);
    }
#endif
#ifdef VIEW_PATINA
    float grown = view_slots[3].y > 0 ? view_bilinear(3, uv).x : 0.5;
    place.patina = luthier_patina_amount(material, grown);
#endif
#ifdef VIEW_WEIGHTS
    if (view_slots[7].y > 0) {
        place.weight_factor = view_bilinear(7, uv).x;
    }
#endif
#ifdef VIEW_GLITTER
    vec3 glitter = luthier_glitter_normal(material, uv);
    place.normal = glitter.z < 1.0 ? glitter : place.normal;
#endif
#ifdef VIEW_LEANS
    if (view_slots[6].y > 0) {
        // Slopes add up.
        vec3 n = 2.0 * view_bilinear(6, uv).xyz - 1.0;
        n.z = max(n.z, 1e-3);
        vec3 film = place.inner_normal;
        place.inner_normal = normalize(vec3(film.xy * n.z + n.xy * film.z, film.z * n.z));
    }
#endif
#ifdef VIEW_COLORS
    if (view_slots[5].y > 0) {
        place.base_color = view_bilinear(5, uv).xyz;
    }
#endif
#ifdef VIEW_LIVE
    place = view_lively(place, material);
#endif
    return place;
}

// The place as lights meet it: their size widens slopes after the factor, by as much as it widens those of the first interface without one.
LuthierPlace view_surface_lit(LuthierPlace place) {
    if (view_slopes == 1.0) {
        return place;
    }
    float alpha = view_layer(view_material, 0u).alpha;
    float lit = max(view_layer(view_lit_material, 0u).alpha, 1e-6);
    float wanted = sqrt(max(view_slopes * view_slopes * alpha * alpha + lit * lit - alpha * alpha, 0.0));
    place.alpha_factor *= wanted / (view_slopes * lit);
    return place;
}
#else
#define ViewSurface float
float view_surface(uint material, vec2 uv, float distance) {
    return 0.0;
}

float view_surface_lit(float place) {
    return place;
}
#endif

// What a light of a colour sends to the eye.
vec3 view_lit(uint material, ViewSurface surface, vec3 wi, vec3 wo, vec3 light) {
#if defined(VIEW_PLACES) && defined(VIEW_FLUORESCENT)
    return luthier_eval_lit_at(surface, material, wi, wo, light);
#elif defined(VIEW_FLUORESCENT)
    return luthier_eval_lit(material, wi, wo, light);
#elif defined(VIEW_PLACES)
    return luthier_eval_at(surface, material, wi, wo) * light;
#else
    return luthier_eval(material, wi, wo) * light;
#endif
}
