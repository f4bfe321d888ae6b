// Rays against the triangles of a mesh, in a tree of boxes. Its words are those of mesh.rs.

// A point of a surface, and what the shader may vary over it.
struct Place {
    position: vec3<f32>,
    // Unit, towards the side that the ray came from.
    normal: vec3<f32>,
    // Unit, across the normal; nowhere undefined.
    tangent: vec3<f32>,
    uv: vec2<f32>,
    // Of the bitangent.
    sign: f32,
    // Share of the hemisphere that the mesh leaves open, weighed by the cosine.
    open: f32,
    // Of the triangle, towards the side that the ray came from.
    facing: vec3<f32>,
    // Where rays to other places begin.
    lifted: vec3<f32>,
}

struct Hit {
    found: bool,
    // 0 shows the material; others are plain.
    part: u32,
    place: Place,
}

// A triangle that a ray meets: distance, number of its word, weights of the second and third corner.
struct MeshMeeting {
    t: f32,
    triangle: u32,
    weights: vec2<f32>,
}

// The first number of plain parts; those below are shown materials.
const MESH_PLAIN = 0x80000000u;

const MESH_FAR: f32 = 1e30;
// Distance of the begin of a ray from the surface that it leaves.
const MESH_LIFT: f32 = 4e-4;
// Share of light that dark places get from others of the mesh, by a guess of their colour.
const MESH_RETURNED: f32 = 0.5;

// Words of the mesh: where nodes begin, their number, where triangles and vertices begin.
fn mesh_head() -> vec4<u32> {
    return bitcast<vec4<u32>>(kernel_inputs.words[mesh_first()]);
}

// Where plain colours begin; distances from the axis at which a floor begins to fade, and has faded; angular radius of lights.
fn mesh_rest() -> vec4<f32> {
    return kernel_inputs.words[mesh_first() + 1u];
}

fn mesh_first() -> u32 {
    return bitcast<u32>(kernel_inputs.words[kernel_inputs.parts].z);
}

fn mesh_position(head: vec4<u32>, corner: u32) -> vec3<f32> {
    return kernel_inputs.words[head.w + 3u * corner].xyz;
}

// The nearest triangle before `farthest`, or any where `is_shadow`, along a unit ray. Plain parts shade nothing.
fn mesh_nearest(origin: vec3<f32>, ray: vec3<f32>, farthest: f32, is_shadow: bool) -> MeshMeeting {
    let head = mesh_head();
    let inverse = 1.0 / select(ray, vec3<f32>(1e-12), abs(ray) < vec3<f32>(1e-12));
    var best = MeshMeeting(farthest, 0u, vec2<f32>(0.0));
    var node = 0u;
    while node < head.y {
        let low = kernel_inputs.words[head.x + 2u * node];
        let high = kernel_inputs.words[head.x + 2u * node + 1u];
        let first = (low.xyz - origin) * inverse;
        let second = (high.xyz - origin) * inverse;
        let enter = min(first, second);
        let leave = max(first, second);
        let near = max(max(enter.x, enter.y), max(enter.z, 0.0));
        let far = min(min(leave.x, leave.y), min(leave.z, best.t));
        if !(near <= far * 1.000001 + 1e-9) {
            node = bitcast<u32>(low.w);
            continue;
        }
        // Eight times the first triangle of a leaf, and the number of its triangles.
        let leaf = bitcast<u32>(high.w);
        let count = leaf & 7u;
        for (var i = 0u; i < count; i++) {
            let number = head.z + (leaf >> 3u) + i;
            let triangle = bitcast<vec4<u32>>(kernel_inputs.words[number]);
            if is_shadow && triangle.w >= MESH_PLAIN {
                continue;
            }
            // Corners across the ray: edges that triangles have in common have sums that differ in sign alone, so that no ray slips through.
            let a = mesh_position(head, triangle.x) - origin;
            let b = mesh_position(head, triangle.y) - origin;
            let c = mesh_position(head, triangle.z) - origin;
            let along = vec3<f32>(dot(a, ray), dot(b, ray), dot(c, ray));
            let a_across = a - along.x * ray;
            let b_across = b - along.y * ray;
            let c_across = c - along.z * ray;
            let areas = vec3<f32>(
                dot(ray, cross(c_across, b_across)), dot(ray, cross(a_across, c_across)), dot(ray, cross(b_across, a_across)),
            );
            let sum = areas.x + areas.y + areas.z;
            if sum == 0.0 {
                continue;
            }
            // Devices may fuse a product with a sum, so that the two signs need not differ.
            let shares = areas / sum;
            if min(min(shares.x, shares.y), shares.z) < -2e-6 {
                continue;
            }
            let weights = shares.yz;
            let t = dot(areas, along) / sum;
            if t > 0.0 && t < best.t {
                best = MeshMeeting(t, number, weights);
                if is_shadow {
                    return best;
                }
            }
        }
        node = select(node + 1u, bitcast<u32>(low.w), count > 0u);
    }
    return best;
}

// What a ray shows of the triangle that it meets.
fn mesh_place(origin: vec3<f32>, ray: vec3<f32>, meeting: MeshMeeting) -> Hit {
    let head = mesh_head();
    let triangle = bitcast<vec4<u32>>(kernel_inputs.words[meeting.triangle]);
    let weights = vec3<f32>(1.0 - meeting.weights.x - meeting.weights.y, meeting.weights);
    let corners = array<vec3<f32>, 3>(
        mesh_position(head, triangle.x), mesh_position(head, triangle.y), mesh_position(head, triangle.z),
    );
    let numbers = array<u32, 3>(triangle.x, triangle.y, triangle.z);
    var hit: Hit;
    hit.found = true;
    hit.part = triangle.w;
    var facing = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
    let side = select(1.0, -1.0, dot(facing, ray) > 0.0);
    facing *= side;
    let position = origin + meeting.t * ray;
    var normal = vec3<f32>(0.0);
    var tangent = vec3<f32>(0.0);
    var lift = vec3<f32>(0.0);
    for (var i = 0u; i < 3u; i++) {
        let first = head.w + 3u * numbers[i];
        let n = kernel_inputs.words[first + 1u];
        let t = kernel_inputs.words[first + 2u];
        normal += weights[i] * n.xyz;
        tangent += weights[i] * t.xyz;
        hit.place.uv += weights[i] * vec2<f32>(kernel_inputs.words[first].w, n.w);
        hit.place.open += weights[i] * (abs(t.w) - 1.0);
        // Above the planes of all three corners, so that no coarse triangle shades itself (Hanika 2021).
        let up = side * n.xyz;
        lift -= weights[i] * min(dot(position - corners[i], up), 0.0) * up;
    }
    hit.place.position = position;
    hit.place.facing = facing;
    hit.place.lifted = position + lift + MESH_LIFT * facing;
    normal = normalize(normal) * side;
    // No normal that is seen from behind.
    let seen = dot(normal, -ray);
    normal = select(normalize(normal - (0.02 - seen) * ray), normal, seen >= 0.02);
    hit.place.normal = normal;
    hit.place.sign = sign(kernel_inputs.words[head.w + 3u * triangle.x + 2u].w);
    let across = tangent - normal * dot(normal, tangent);
    let other = cross(normal, select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), abs(normal.x) > 0.9));
    hit.place.tangent = normalize(select(other, across, dot(across, across) > 1e-12));
    return hit;
}

fn shape_hit(shape: u32, eye: vec3<f32>, ray: vec3<f32>) -> Hit {
    let meeting = mesh_nearest(eye, ray, MESH_FAR, false);
    if meeting.t == MESH_FAR {
        var none: Hit;
        return none;
    }
    return mesh_place(eye, ray, meeting);
}

// Two numbers in 0..1 for a sample of a pixel: Hammersley's points, shifted for the pixel.
fn mesh_random(seed: u32) -> vec2<f32> {
    let samples = kernel_inputs.samples * kernel_inputs.samples;
    let sample = seed % samples;
    let hash = shading_hash(seed / samples);
    let shift = vec2<f32>(shading_unit(hash), shading_unit(shading_hash(hash)));
    return fract(vec2<f32>((f32(sample) + 0.5) / f32(samples), shading_unit(reverseBits(sample))) + shift);
}

// Two vectors across a unit vector.
fn mesh_around(n: vec3<f32>) -> mat2x3<f32> {
    let t = normalize(cross(n, select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), abs(n.x) > 0.9)));
    return mat2x3<f32>(t, cross(n, t));
}

// 1 where a light is seen from a place, 0 where the mesh hides it. The samples of a pixel look at points of a disc. `near` is 1 for lights at a
// distance, which is that of their centre.
fn mesh_sees(place: Place, to_light: vec3<f32>, near: f32, seed: u32) -> f32 {
    let distance = length(to_light);
    let centre = to_light / distance;
    if dot(place.normal, centre) <= 0.0 {
        return 0.0;
    }
    let random = mesh_random(seed);
    let phi = 2.0 * ENVIRONMENT_PI * random.y;
    let disc = mesh_around(centre) * (vec2<f32>(cos(phi), sin(phi)) * sqrt(random.x) * mesh_rest().w);
    let farthest = select(MESH_FAR, distance * 0.999, near == 1.0);
    let meeting = mesh_nearest(place.lifted, normalize(centre + disc), farthest, true);
    return select(0.0, 1.0, meeting.t == farthest);
}

// Light from all around that reaches a place, as a share of what would without the mesh, with light that other places of it return.
fn mesh_openness(place: Place) -> f32 {
    return place.open / (1.0 - MESH_RETURNED * (1.0 - place.open));
}

// Factor on the environment of a material: openness where light comes out of a base, and what the mirrored rays of a smooth surface see.
fn mesh_open(material: u32, place: Place, frame: mat3x3<f32>, wo: vec3<f32>, seed: u32) -> f32 {
    let open = mesh_openness(place);
    let alpha = shading_layer(material, 0u).alpha;
    let rough = smoothstep(0.15, 0.5, alpha);
    if shading_layer(material, shading_layer_count(material) - 1u).kind == 2.0 || rough == 1.0 {
        return open;
    }
    let wi = shading_sample(max(alpha, 1e-3), mesh_random(seed) * vec2<f32>(0.9, 1.0), wo);
    let ray = frame * vec3<f32>(wi.xy, max(wi.z, 0.0));
    let meeting = mesh_nearest(place.lifted, ray, MESH_FAR, true);
    return mix(select(MESH_RETURNED * open, 1.0, meeting.t == MESH_FAR), open, rough);
}

// What a plain part sends out in the direction -ray: it is matte. A floor fades into what is behind.
fn mesh_plain(hit: Hit, ray: vec3<f32>, behind: vec3<f32>, seed: u32) -> vec3<f32> {
    let rest = mesh_rest();
    let albedo = kernel_inputs.words[bitcast<u32>(rest.x) + hit.part - MESH_PLAIN].rgb;
    let place = hit.place;
    var light = environment_diffuse(place.normal) * mesh_openness(place);
    for (var i = 0u; i < kernel_inputs.light_count; i++) {
        let word = kernel_inputs.words[kernel_inputs.lights + 2u * i];
        let color = kernel_inputs.words[kernel_inputs.lights + 2u * i + 1u].rgb;
        let to_light = select(word.xyz, word.xyz - place.position, word.w == 1.0);
        let distance_sq = dot(to_light, to_light);
        let cosine = dot(to_light, place.normal) * inverseSqrt(distance_sq);
        light += color * (max(cosine, 0.0) * mesh_sees(place, to_light, word.w, seed) / (ENVIRONMENT_PI * distance_sq));
    }
    let fade = smoothstep(rest.y, rest.z, length(place.position.xz));
    return mix(albedo * light, behind, fade);
}

// Radiance that reaches a place from a direction: of the environment, or of another place of the mesh. That one shows the lights, and light from all
// around as a grey of the share that is returned.
fn mesh_radiance(place: Place, ray: vec3<f32>, seed: u32) -> vec3<f32> {
    let radiance = environment_radiance(ray);
    let meeting = mesh_nearest(place.lifted, ray, MESH_FAR, false);
    if meeting.t == MESH_FAR {
        return radiance;
    }
    let hit = mesh_place(place.lifted, ray, meeting);
    if hit.part >= MESH_PLAIN {
        return mesh_plain(hit, ray, radiance, seed);
    }
    return environment_diffuse(hit.place.normal) * (MESH_RETURNED * mesh_openness(hit.place));
}
