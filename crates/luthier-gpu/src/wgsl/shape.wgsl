// Rays against the shapes of shape.rs.

// A point of a surface, and what the shader may vary over it.
struct Place {
    position: vec3<f32>,
    // Unit, towards the side that the ray came from.
    normal: vec3<f32>,
    // Unit, across the normal; nowhere undefined.
    tangent: vec3<f32>,
    uv: vec2<f32>,
}

struct Hit {
    found: bool,
    // Which of the materials.
    part: u32,
    place: Place,
}

const SHAPE_PI: f32 = 3.14159265358979;
const TORUS_RADIUS: f32 = 0.72;
const TORUS_THICKNESS: f32 = 0.3;
const GRID_SIDE: i32 = 5;
const GRID_SPACING: f32 = 1.05;
const GRID_RADIUS: f32 = 0.46;

// A vector across n: `along` made orthogonal, or any where it has no direction.
fn shape_tangent(n: vec3<f32>, along: vec3<f32>) -> vec3<f32> {
    let t = along - n * dot(n, along);
    let length_sq = dot(t, t);
    let other = normalize(cross(n, select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), abs(n.x) > 0.9)));
    return select(other, t * inverseSqrt(length_sq), length_sq > 1e-12);
}

fn shape_sphere(eye: vec3<f32>, ray: vec3<f32>, radius: f32) -> Hit {
    var hit: Hit;
    // Point of the ray nearest to the centre, formed without cancellation.
    let moment = cross(eye, ray);
    let nearest = cross(ray, moment);
    let depth_sq = radius * radius - dot(moment, moment);
    if depth_sq <= 0.0 {
        return hit;
    }
    let n = normalize(nearest - sqrt(depth_sq) * ray);
    hit.found = true;
    hit.place.position = n * radius;
    hit.place.normal = n;
    hit.place.tangent = shape_tangent(n, vec3<f32>(n.z, 0.0, -n.x));
    hit.place.uv = vec2<f32>(0.5 + atan2(n.x, n.z) / (2.0 * SHAPE_PI), acos(clamp(n.y, -1.0, 1.0)) / SHAPE_PI);
    return hit;
}

// Distance to the torus: exact, also inside.
fn shape_torus_distance(p: vec3<f32>) -> f32 {
    return length(vec2<f32>(length(p.xz) - TORUS_RADIUS, p.y)) - TORUS_THICKNESS;
}

// Steps of the distance to the surface never overshoot; the quartic has no such luck in f32.
fn shape_torus(eye: vec3<f32>, ray: vec3<f32>) -> Hit {
    var hit: Hit;
    let bound = TORUS_RADIUS + TORUS_THICKNESS;
    let moment = cross(eye, ray);
    let nearest = cross(ray, moment);
    let half_sq = bound * bound - dot(moment, moment);
    if half_sq <= 0.0 {
        return hit;
    }
    let half = sqrt(half_sq);
    var t = -half;
    var distance = 1.0;
    for (var i = 0; i < 128; i++) {
        distance = shape_torus_distance(nearest + t * ray);
        t += distance;
        if distance < 1e-6 || t > half {
            break;
        }
    }
    if distance > 1e-4 {
        return hit;
    }
    let p = nearest + t * ray;
    let around = normalize(vec3<f32>(p.x, 0.0, p.z));
    hit.found = true;
    hit.place.position = p;
    hit.place.normal = normalize(p - around * TORUS_RADIUS);
    hit.place.tangent = shape_tangent(hit.place.normal, vec3<f32>(around.z, 0.0, -around.x));
    hit.place.uv = vec2<f32>(
        0.5 + atan2(p.x, p.z) / (2.0 * SHAPE_PI),
        0.5 + atan2(p.y, length(p.xz) - TORUS_RADIUS) / (2.0 * SHAPE_PI),
    );
    return hit;
}

fn shape_plane(eye: vec3<f32>, ray: vec3<f32>) -> Hit {
    var hit: Hit;
    let t = -eye.y / ray.y;
    let p = eye + t * ray;
    if !(t > 0.0) || max(abs(p.x), abs(p.z)) > 1.0 {
        return hit;
    }
    hit.found = true;
    hit.place.position = vec3<f32>(p.x, 0.0, p.z);
    hit.place.normal = vec3<f32>(0.0, select(-1.0, 1.0, eye.y > 0.0), 0.0);
    hit.place.tangent = vec3<f32>(1.0, 0.0, 0.0);
    hit.place.uv = 0.5 + 0.5 * p.xz;
    return hit;
}

// The spheres of the wall do not hide each other from a camera in front of it.
fn shape_grid(eye: vec3<f32>, ray: vec3<f32>) -> Hit {
    var hit: Hit;
    for (var i = 0; i < GRID_SIDE * GRID_SIDE; i++) {
        let cell = vec2<f32>(f32(i % GRID_SIDE - GRID_SIDE / 2), f32(GRID_SIDE / 2 - i / GRID_SIDE));
        let centre = vec3<f32>(cell * GRID_SPACING, 0.0);
        hit = shape_sphere(eye - centre, ray, GRID_RADIUS);
        if hit.found {
            hit.part = u32(i);
            hit.place.position += centre;
            return hit;
        }
    }
    return hit;
}

fn shape_hit(shape: u32, eye: vec3<f32>, ray: vec3<f32>) -> Hit {
    switch shape {
        case 1u: {
            return shape_torus(eye, ray);
        }
        case 2u: {
            return shape_plane(eye, ray);
        }
        case 3u: {
            return shape_grid(eye, ray);
        }
        default: {
            return shape_sphere(eye, ray, 1.0);
        }
    }
}
