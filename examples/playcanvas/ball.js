// A ball of a baked material, under lamps and, where scene.json names one, in an environment.

import * as pc from "playcanvas";
import { loadBake, loadEnvironment } from "luthier-playcanvas";
import { add, driver, mesh, open, run, show } from "./page.js";

run(async ({ device: kind = "webgl2", size, material, lights, ambient, background, fov_y_deg, eye_distance, slope_variance: slopeVariance, environment, tone, tangents }) => {
  const app = await open(kind, size);
  const device = app.graphicsDevice;
  const bake = await loadBake(device, "bake/manifest.json");
  if (environment) bake.environment = await loadEnvironment(device, `scene/${environment}`);
  app.scene.ambientLight = new pc.Color(...(ambient ?? [0, 0, 0])).gamma();
  mesh(app, ball(tangents), bake.material(material, { slopeVariance }));
  for (const light of lights) lamp(app, light);
  const clearColor = new pc.Color(...background).gamma();
  const camera = add(app, "camera", { clearColor, fov: fov_y_deg, nearClip: 0.1, farClip: 100, toneMapping: pc[tone ?? "TONEMAP_NONE"], gammaCorrection: pc.GAMMA_SRGB }, [0, 0, eye_distance]);
  return { picture: await show(app, camera, size), driver: driver(app) };
});

/** A light far away, or at a position, whose irradiance is that at the centre. A colour of 1 is an irradiance of pi. */
function lamp(app, { direction, position, irradiance }) {
  const color = (scale) => new pc.Color(...irradiance.map((value) => (scale * value) / Math.PI)).gamma();
  if (position) {
    inverseSquare(app.graphicsDevice);
    const squared = position.reduce((sum, x) => sum + x * x, 0);
    add(app, "light", { type: "omni", color: color(squared / 16), falloffMode: pc.LIGHTFALLOFF_INVERSESQUARED, range: 1e4 }, position);
    return;
  }
  // Light shines down the -y of its entity.
  const entity = add(app, "light", { type: "directional", color: color(1) });
  entity.setRotation(new pc.Quat().setFromDirections(pc.Vec3.UP, new pc.Vec3(...direction).normalize()));
}

/** Has lamps fall off as 16 / d^2, for comparisons with other programs. That of PlayCanvas is 16 / (1 + d^2). */
function inverseSquare(device) {
  const chunks = pc.ShaderChunks.get(device, device.isWebGPU ? pc.SHADERLANGUAGE_WGSL : pc.SHADERLANGUAGE_GLSL);
  chunks.set("falloffInvSquaredPS", chunks.get("falloffInvSquaredPS").replace("(sqrDist + 1.0)", "sqrDist"));
}

/** A ball whose texture coordinates begin at the top, behind: those of `luthier preview --shape sphere`. */
function ball(hasTangents) {
  const geometry = new pc.SphereGeometry({ radius: 1, latitudeBands: 64, longitudeBands: 128, calculateTangents: hasTangents });
  // glTF files have the bitangent against v, the engine's geometries along it.
  geometry.tangents = geometry.tangents?.map((value, i) => (i % 4 === 3 ? -value : value));
  return geometry;
}
