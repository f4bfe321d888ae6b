/// How facets of GGX are drawn, see `FacetDraw` of the f64 twin.
struct LuthierFacetDraw {
    /// Slope parameters along the tangents, and cosine and sine of the angle of the first.
    alpha: vec2<f32>,
    axis: vec2<f32>,
    /// The eye where the surface is rough by 1, its length before, and minus the least height of directions there.
    eye: vec3<f32>,
    size: f32,
    lowest: f32,
    /// The square of the slope parameter, and v of a facet at a distance of 1 from the flattest directions.
    alpha_sq: f32,
    pull: f32,
    //? beckmann
    /// The reflectance at normal incidence.
    f0: f32,
}

fn luthier_facet_draw(prepared: LuthierPreparedLobes) -> LuthierFacetDraw {
    let wo = prepared.wo;
    var given: LuthierFacetDraw;
    //? anisotropic
    {
        given.alpha = max(prepared.coat.alpha_xy, vec2<f32>(1e-4));
        given.axis = prepared.coat.rotation;
    }
    //? else
    {
        given.alpha = vec2<f32>(max(prepared.coat.alpha, 1e-4));
        given.axis = vec2<f32>(1.0, 0.0);
    }
    let stretched = vec3<f32>(given.alpha * luthier_in_frame(given.axis, wo.xy), wo.z);
    given.size = length(stretched);
    given.eye = stretched / given.size;
    // The greatest height below which no direction leaves (Eto and Tokuyoshi 2023).
    let least = min(given.alpha.x, given.alpha.y);
    let reach = 1.0 + length(wo.xy);
    let bound = (1.0 - least * least) * reach * reach / (reach * reach + least * least * wo.z * wo.z);
    given.lowest = bound * given.eye.z;
    given.alpha_sq = given.alpha.x * given.alpha.y;
    let alpha = sqrt(given.alpha_sq);
    let f0 = clamp(dot(luthier_first_reflectance(prepared, 1.0), vec3<f32>(1.0 / 3.0)), 1e-3, 1.0);
    let rest_sq = (1.0 - f0) * (1.0 - f0);
    //? beckmann
    given.f0 = f0;
    given.pull = 2.0 * given.size * rest_sq * rest_sq * (alpha + 0.8) / (f0 * alpha * (3.6 + 13.0 * wo.z * wo.z));
    return given;
}

/// The mean of x at a height above the flattest directions, v there, and the root of the mean of 1 / (1 + x v) over azimuths, inverse.
fn luthier_facet_pulled(given: LuthierFacetDraw, above: f32) -> vec3<f32> {
    let middle = 0.5 + 0.5 * given.eye.z * (above - given.eye.z);
    let pull = given.pull * inverseSqrt(max(4.0 * given.alpha_sq * middle + (1.0 - given.alpha_sq) * above * above, 1e-12));
    return vec3<f32>(middle, pull, sqrt(1.0 + pull * (2.0 * middle + 0.25 * above * above * pull)));
}

/// Density in solid angle with which `luthier_draw_facet` draws a direction above the horizon.
fn luthier_facet_density(prepared: LuthierPreparedLobes, wi: vec3<f32>) -> f32 {
    let sum = vec3<f32>(wi.xy + prepared.wo.xy, max(wi.z + prepared.wo.z, 1e-16));
    let given = luthier_facet_draw(prepared);
    //? beckmann
    {
        //? ggx
        if prepared.coat.distribution < 0.5 {
            return luthier_gaussian_density(given, prepared.wo, sum);
        }
        //? else
        return luthier_gaussian_density(given, prepared.wo, sum);
    }
    //? ggx|!beckmann
    {
        let steep = vec3<f32>(luthier_in_frame(given.axis, sum.xy) / given.alpha, sum.z);
        let steep_sq = dot(steep, steep);
        // The cosine of eye and facet times the length of the sum; unit directions have no other.
        let product = 0.5 * dot(sum, sum);
        let above = 2.0 * product * sum.z / (given.size * steep_sq);
        let cosine = product / given.size;
        let facing = cosine * (cosine / steep_sq);
        let pulled = luthier_facet_pulled(given, above);
        let uniform_density = 2.0 * facing * given.size / (LUTHIER_PI * given.alpha_sq * steep_sq * (1.0 + given.lowest));
        return uniform_density * pulled.z / (1.0 + facing * pulled.y);
    }
}

/// A direction mirrored at a facet of the first interface: of GGX at facets that reflect more of the light more often, of Beckmann by a mixture.
fn luthier_draw_facet(prepared: LuthierPreparedLobes, u: vec3<f32>) -> vec3<f32> {
    let given = luthier_facet_draw(prepared);
    //? beckmann
    {
        //? ggx
        if prepared.coat.distribution < 0.5 {
            return luthier_draw_gaussian(given, prepared.wo, u);
        }
        //? else
        return luthier_draw_gaussian(given, prepared.wo, u);
    }
    //? ggx|!beckmann
    {
        let z = (1.0 - u.y) * (1.0 + given.lowest) - given.lowest;
        let above = z + given.eye.z;
        let pulled = luthier_facet_pulled(given, above);
        let ring = sqrt(max(1.0 - z * z, 0.0));
        let across = length(given.eye.xy);
        let whole = 1.0 / (1.0 + pulled.x * pulled.y);
        let lean = 0.5 * across * ring * pulled.y * whole;
        let phi = 2.0 * LUTHIER_PI * u.z;
        let turn = vec2<f32>(cos(phi), sin(phi));
        let turned = ring * vec2<f32>(turn.x + lean, pulled.z * whole * turn.y) / max(1.0 + lean * turn.x, 1e-6);
        let away = select(vec2<f32>(1.0, 0.0), given.eye.xy / max(across, 1e-20), across > 1e-20);
        let level = given.eye.xy - turned.x * away - turned.y * vec2<f32>(-away.y, away.x);
        let wh = normalize(vec3<f32>(given.alpha * level, max(above, 1e-6)));
        let eye = vec3<f32>(luthier_in_frame(given.axis, prepared.wo.xy), prepared.wo.z);
        let wi = 2.0 * dot(wh, eye) * wh - eye;
        return vec3<f32>(given.axis.x * wi.x - given.axis.y * wi.y, given.axis.y * wi.x + given.axis.x * wi.y, wi.z);
    }
}
