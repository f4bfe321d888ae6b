// Position-free paths of light through a stack (Guo, Hasan and Zhao 2018), from the eye, connected to a light that is refracted down through
// the interfaces above the connection. A path has one estimator for each of the interfaces that it leaves through at its end, and for the event
// before these; balanced weights (Veach 1997) keep whichever draws the narrow lobes.

// The most layers of a stack.
const SIMULATION_LAYERS: u32 = $layersu;

// Event from which on a path survives by chance, and the probability with which it does. Of paths longer than the last of these, less than
// one in 10^20 is left.
const SIMULATION_EVENTS_SURE: u32 = 32u;
const SIMULATION_EVENTS_MOST: u32 = 512u;
const SIMULATION_SURVIVAL: f32 = 0.9;

// Light on its way down, as it comes to an interface from above.
struct SimulationLight {
    direction: vec3<f32>,
    // With what turns kernels against the way of the light into kernels along it.
    weight: vec3<f32>,
    // Sum of the densities of the strategies that connect nearer to the light, over that of the one that connects here.
    later: f32,
}

// Light that was found.
struct SimulationPath {
    // Connected to the light: f cos_theta_i.
    connected: vec3<f32>,
    // Left upward: its direction, and its weight.
    direction: vec3<f32>,
    weight: vec3<f32>,
}

// One path from wo. With `connects` it is connected to light from wi.
fn simulation_path(
    first: u32, count: u32, way: SimulationWay, wi: vec3<f32>, wo: vec3<f32>, connects: bool,
) -> SimulationPath {
    var found: SimulationPath;
    if wo.z <= 0.0 || (connects && wi.z <= 0.0) {
        return found;
    }
    var lights: array<SimulationLight, SIMULATION_LAYERS>;
    // Interfaces that the light comes to.
    var lit = 0u;
    if connects {
        lit = simulation_lights(first, count, way, wi, &lights);
    }
    var arrival = SimulationSided(wo, true);
    var number = 0u;
    var weight = way.mask;
    var earlier = 0.0;
    for (var event = 0u; event < SIMULATION_EVENTS_MOST; event++) {
        let layer = simulation_layer(first, number, way.lead);
        if number < lit && !layer.is_absent {
            let light = lights[number];
            let to = SimulationSided(light.direction, true);
            let densities = simulation_densities(layer, way, arrival, to);
            // Light on its way down is refracted, never reflected.
            let back = select(0.0, densities.y, !arrival.above);
            let share = 1.0 / (1.0 + back * earlier + densities.x * light.later);
            found.connected += weight * light.weight * simulation_kernel(layer, way, arrival, to) * share;
        }
        let scattered = simulation_scatter(layer, way, arrival);
        let to = scattered.to;
        weight *= scattered.weight;
        if simulation_brightest(weight) <= 0.0 {
            return found;
        }
        if connects {
            if !to.above {
                earlier = 0.0;
            } else if !layer.is_absent {
                let densities = simulation_densities(layer, way, arrival, to);
                earlier = (1.0 + select(0.0, densities.y, !arrival.above) * earlier) / densities.x;
            }
        }
        if to.above {
            if number == 0u {
                found.direction = to.direction;
                found.weight = weight;
                return found;
            }
            number -= 1u;
            weight *= simulation_slab(first, number, to.direction.z);
        } else {
            weight *= simulation_slab(first, number, to.direction.z);
            number += 1u;
            if number >= count {
                return found;
            }
        }
        arrival = SimulationSided(vec3<f32>(-to.direction.xy, to.direction.z), !to.above);
        let survival = select(1.0, SIMULATION_SURVIVAL, event >= SIMULATION_EVENTS_SURE)
            * min(simulation_brightest(weight) / SIMULATION_FAINT, 1.0);
        if simulation_draw().x >= survival {
            return found;
        }
        weight /= survival;
    }
    return found;
}

// Light from wi as it comes to the interfaces from above; the number of those.
fn simulation_lights(
    first: u32, count: u32, way: SimulationWay, wi: vec3<f32>,
    lights: ptr<function, array<SimulationLight, SIMULATION_LAYERS>>,
) -> u32 {
    var light = SimulationLight(wi, vec3<f32>(1.0), 0.0);
    var index = 1.0;
    for (var number = 0u; number < count; number++) {
        (*lights)[number] = light;
        (*lights)[number].weight *= wi.z / (index * index * light.direction.z);
        let layer = simulation_layer(first, number, way.lead);
        if layer.kind != SIMULATION_DIELECTRIC {
            return number + 1u;
        }
        let arrival = SimulationSided(light.direction, true);
        let scattered = simulation_scatter(layer, way, arrival);
        let to = scattered.to;
        light.weight *= scattered.weight * simulation_slab(first, number, to.direction.z);
        if to.above || simulation_brightest(light.weight * way.mask) <= 0.0 {
            return number + 1u;
        }
        if !layer.is_absent {
            let densities = simulation_densities(layer, way, arrival, to);
            light.later = (1.0 + densities.y * light.later) / densities.x;
        }
        index *= layer.eta;
        light.direction = vec3<f32>(-to.direction.xy, to.direction.z);
    }
    return count;
}
