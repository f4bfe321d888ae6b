// An interface, or a diffuse base, as the paths through a stack meet it. Kernels K(a, b) are what becomes of a unit of light that comes in
// from a and leaves along b, per solid angle: with radiance, f cos_theta_b.

// Whether light walks between facets until it leaves; else it meets one facet, and what others block is lost.
const SIMULATION_WALKS: bool = $walks;

// Facet from which on a walk survives by chance, and the probability with which it does.
const SIMULATION_FACETS_SURE: u32 = 32u;
const SIMULATION_FACETS_MOST: u32 = 256u;
const SIMULATION_FACET_SURVIVAL: f32 = 0.8;

// Light fainter than this survives by chance.
const SIMULATION_FAINT: f32 = 0.1;

// A direction, and the side whose frame it is in.
struct SimulationSided {
    direction: vec3<f32>,
    above: bool,
}

// Light that goes on.
struct SimulationScattered {
    to: SimulationSided,
    // 0: it is lost.
    weight: vec3<f32>,
}

fn simulation_turned(layer: SimulationLayer, d: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(layer.turn.x * d.x + layer.turn.y * d.y, layer.turn.x * d.y - layer.turn.y * d.x, d.z);
}

fn simulation_turned_back(layer: SimulationLayer, d: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(layer.turn.x * d.x - layer.turn.y * d.y, layer.turn.y * d.x + layer.turn.x * d.y, d.z);
}

fn simulation_brightest(weight: vec3<f32>) -> f32 {
    return max(weight.x, max(weight.y, weight.z));
}

// Light from a meets one facet, and is reflected or refracted by chance.
fn simulation_facet(layer: SimulationLayer, way: SimulationWay, a: SimulationSided, u: vec3<f32>) -> SimulationScattered {
    let w = a.direction;
    let m = simulation_normal(layer, w, u.xy);
    let cos_theta = max(dot(w, m), 0.0);
    let split = simulation_split(layer, a.above, cos_theta);
    let reflected = dot(way.mask, split.reflected);
    let transmitted = dot(way.mask, split.transmitted);
    let kept = reflected + transmitted;
    if transmitted == 0.0 || u.z * kept < reflected {
        let share = select(1.0, kept / reflected, transmitted > 0.0);
        return SimulationScattered(SimulationSided(2.0 * cos_theta * m - w, a.above), split.reflected * share);
    }
    let eta_it = simulation_eta(layer, a.above);
    let refracted = m * (cos_theta * eta_it - split.cos_theta_t) - w * eta_it;
    let to = SimulationSided(normalize(vec3<f32>(refracted.xy, -refracted.z)), !a.above);
    return SimulationScattered(to, split.transmitted * (kept / transmitted));
}

// Density per solid angle with which a facet seen from a sends light to b, by channel, absorption included (Walter et al. 2007, eq. 14 and
// 17, over visible normals).
fn simulation_phase(layer: SimulationLayer, a: SimulationSided, area: f32, b: SimulationSided) -> vec3<f32> {
    let w = a.direction;
    if area <= 0.0 {
        return vec3<f32>(0.0);
    }
    if a.above == b.above {
        let sum = w + b.direction;
        let length_sq = dot(sum, sum);
        if length_sq < 1e-12 {
            return vec3<f32>(0.0);
        }
        let m = sum * inverseSqrt(length_sq);
        let density = simulation_density(layer, m);
        if density == 0.0 {
            return vec3<f32>(0.0);
        }
        return simulation_split(layer, a.above, dot(w, m)).reflected * (density / (4.0 * area));
    }
    if layer.kind != SIMULATION_DIELECTRIC {
        return vec3<f32>(0.0);
    }
    // Indices over that of the side of a.
    let index_t = 1.0 / simulation_eta(layer, a.above);
    let through = vec3<f32>(b.direction.xy, -b.direction.z);
    let sum = w + index_t * through;
    let length_sq = dot(sum, sum);
    if length_sq == 0.0 {
        return vec3<f32>(0.0);
    }
    let m = sum * (inverseSqrt(length_sq) * select(1.0, -1.0, sum.z < 0.0));
    let cos_i = dot(w, m);
    let cos_t = -dot(through, m);
    if cos_i <= 0.0 || cos_t <= 0.0 {
        return vec3<f32>(0.0);
    }
    let jacobian = cos_t * index_t * index_t / length_sq;
    return simulation_split(layer, a.above, cos_i).transmitted * (simulation_density(layer, m) * cos_i * jacobian / area);
}

// G2 / G1 with G2 = 1 / (1 + Lambda_a + Lambda_b).
fn simulation_masking(layer: SimulationLayer, a: vec3<f32>, b: vec3<f32>) -> f32 {
    let visible = 1.0 + simulation_lambda(layer, a);
    return visible / (visible + simulation_lambda(layer, b));
}

// The depth below the top as the other side counts it: from -ln c to -ln (1 - c), c being the share of the surface that lies lower.
fn simulation_flipped(depth: f32) -> f32 {
    return -log(max(1.0 - exp(-depth), 1e-30));
}

// Light between facets (Heitz, Hanika, d'Eon and Dachsbacher 2016).
struct SimulationWalker {
    // The facet as the light sees it: looks back along the ray.
    at: SimulationSided,
    area: f32,
    depth: f32,
    weight: vec3<f32>,
    // 0: at a facet. 1: left along `at`. 2: lost.
    state: u32,
}

fn simulation_enter(layer: SimulationLayer, a: SimulationSided) -> SimulationWalker {
    let area = simulation_area(layer, a.direction);
    let rate = max(area / a.direction.z, 1.0);
    return SimulationWalker(a, area, -log(1.0 - simulation_draw().x) / rate, vec3<f32>(1.0), 0u);
}

fn simulation_step(
    layer: SimulationLayer, way: SimulationWay, walker: SimulationWalker, facet: u32,
) -> SimulationWalker {
    var next = walker;
    let scattered = simulation_facet(layer, way, walker.at, simulation_draw().xyz);
    let chance = simulation_draw();
    next.weight *= scattered.weight;
    let brightest = simulation_brightest(next.weight * way.mask);
    let survival = select(1.0, SIMULATION_FACET_SURVIVAL, facet >= SIMULATION_FACETS_SURE)
        * min(brightest / SIMULATION_FAINT, 1.0);
    if chance.x >= survival || facet >= SIMULATION_FACETS_MOST {
        next.state = 2u;
        return next;
    }
    next.weight /= survival;
    let to = scattered.to;
    var depth = walker.depth;
    if to.above != walker.at.above {
        depth = simulation_flipped(depth);
    }
    let up = to.direction.z;
    let area = simulation_area(layer, -to.direction);
    let free_path = -log(1.0 - chance.y) * abs(up) / max(area, 1e-30);
    if up > 0.0 && free_path > depth {
        next.at = to;
        next.state = 1u;
        return next;
    }
    next.at = SimulationSided(-to.direction, to.above);
    next.area = area;
    next.depth = max(select(depth + free_path, depth - free_path, up > 0.0), 0.0);
    return next;
}

// The direction in which light from a goes on, and its weight, by chance.
fn simulation_scatter(layer: SimulationLayer, way: SimulationWay, arrival: SimulationSided) -> SimulationScattered {
    if layer.kind == SIMULATION_DIFFUSE {
        let u = simulation_draw();
        let around = vec2<f32>(cos(2.0 * SIMULATION_PI * u.y), sin(2.0 * SIMULATION_PI * u.y));
        let b = vec3<f32>(sqrt(u.x) * around, sqrt(1.0 - u.x));
        return SimulationScattered(SimulationSided(b, arrival.above), SIMULATION_PI * simulation_diffuse(layer, b, arrival.direction));
    }
    if layer.is_absent {
        let straight = vec3<f32>(-arrival.direction.xy, arrival.direction.z);
        return SimulationScattered(SimulationSided(straight, !arrival.above), vec3<f32>(1.0));
    }
    let a = SimulationSided(simulation_turned(layer, arrival.direction), arrival.above);
    var found: SimulationScattered;
    if SIMULATION_WALKS {
        var walker = simulation_enter(layer, a);
        for (var facet = 0u; walker.state == 0u; facet++) {
            walker = simulation_step(layer, way, walker, facet);
        }
        found = SimulationScattered(walker.at, select(vec3<f32>(0.0), walker.weight, walker.state == 1u));
    } else {
        found = simulation_facet(layer, way, a, simulation_draw().xyz);
        let b = found.to.direction;
        if b.z > 0.0 {
            found.weight *= simulation_masking(layer, a.direction, b);
        } else {
            found.weight = vec3<f32>(0.0);
        }
    }
    found.to.direction = simulation_turned_back(layer, found.to.direction);
    return found;
}

// K(a, b), or an unbiased estimate of it.
fn simulation_kernel(
    layer: SimulationLayer, way: SimulationWay, arrival: SimulationSided, to: SimulationSided,
) -> vec3<f32> {
    if layer.kind == SIMULATION_DIFFUSE {
        return simulation_diffuse(layer, to.direction, arrival.direction) * to.direction.z;
    }
    let a = SimulationSided(simulation_turned(layer, arrival.direction), arrival.above);
    let b = SimulationSided(simulation_turned(layer, to.direction), to.above);
    if !SIMULATION_WALKS {
        let area = simulation_area(layer, a.direction);
        return simulation_phase(layer, a, area, b) * simulation_masking(layer, a.direction, b.direction);
    }
    // Every facet adds what it sends straight to b.
    let lambda = simulation_lambda(layer, b.direction);
    var walker = simulation_enter(layer, a);
    let rate = max(walker.area / a.direction.z, 1.0);
    var sum = vec3<f32>(0.0);
    for (var facet = 0u; walker.state == 0u; facet++) {
        let phase = simulation_phase(layer, walker.at, walker.area, b);
        let crosses = walker.at.above != b.above;
        var leaving = rate / (rate + lambda);
        if facet > 0u || crosses {
            leaving = exp(-lambda * select(walker.depth, simulation_flipped(walker.depth), crosses));
        }
        sum += walker.weight * phase * leaving;
        walker = simulation_step(layer, way, walker, facet);
    }
    return sum;
}

// About the density of b in what is drawn from a, and of a in what is drawn from b: for weights between strategies, positive wherever these
// are. What meets more facets than one is guessed.
fn simulation_densities(
    layer: SimulationLayer, way: SimulationWay, arrival: SimulationSided, to: SimulationSided,
) -> vec2<f32> {
    if layer.kind == SIMULATION_DIFFUSE {
        return vec2<f32>(to.direction.z, arrival.direction.z) / SIMULATION_PI;
    }
    let a = SimulationSided(simulation_turned(layer, arrival.direction), arrival.above);
    let b = SimulationSided(simulation_turned(layer, to.direction), to.above);
    let area_a = simulation_area(layer, a.direction);
    let area_b = simulation_area(layer, b.direction);
    let forth = dot(way.mask, simulation_phase(layer, a, area_a, b)) / dot(way.mask, vec3<f32>(1.0));
    // n_a^2 area_a phase(a, b) = n_b^2 area_b phase(b, a).
    let index = select(simulation_eta(layer, a.above), 1.0, a.above == b.above);
    let back = forth * index * index * area_a / max(area_b, 1e-30);
    var later = vec2<f32>(0.0);
    if SIMULATION_WALKS {
        later = 0.1 * layer.alpha.x * layer.alpha.y * vec2<f32>(b.direction.z, a.direction.z);
    }
    return max(vec2<f32>(forth, back) + later, vec2<f32>(1e-30));
}
