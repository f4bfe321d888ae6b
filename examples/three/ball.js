// A ball of a baked material, under lamps and, where scene.json names one, in an environment.

import { driver, open, run, show } from "./page.js";

run(async ({ renderer: kind, size, material, lights, background, fov_y_deg, eye_distance, slope_variance: slopeVariance, environment, tone }) => {
  const { THREE, LuthierLoader, LuthierEnvironmentLoader, renderer } = await open(kind, size);
  const bake = await new LuthierLoader().loadAsync("bake/manifest.json");
  if (environment) bake.environment = await new LuthierEnvironmentLoader().loadAsync(`scene/${environment}`);
  if (tone) renderer.toneMapping = THREE[tone];
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(...background);
  scene.add(new THREE.Mesh(ball(THREE), bake.material(material, { slopeVariance })));
  for (const light of lights) scene.add(lamp(THREE, light));
  const camera = new THREE.PerspectiveCamera(fov_y_deg, 1, 0.1, 100);
  camera.position.z = eye_distance;
  return { picture: await show(renderer, scene, camera), driver: driver(renderer) };
});

/** A light far away, or at a position, whose irradiance is that at the centre, or from all around with the same radiance. */
function lamp(THREE, { direction, position, irradiance, radiance }) {
  if (radiance) return new THREE.AmbientLight(new THREE.Color(...radiance), Math.PI);
  const light = position
    ? new THREE.PointLight(new THREE.Color(...irradiance), new THREE.Vector3(...position).lengthSq())
    : new THREE.DirectionalLight(new THREE.Color(...irradiance));
  light.position.set(...(position ?? direction));
  return light;
}

/** A ball whose texture coordinates begin at the top, behind: those of `luthier preview --shape sphere`. */
function ball(THREE) {
  const geometry = new THREE.SphereGeometry(1, 128, 64);
  const { uv } = geometry.attributes;
  for (let i = 0; i < uv.count; i++) uv.setXY(i, uv.getX(i) + 0.25, 1 - uv.getY(i));
  return geometry;
}
