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
  for (const { direction, position, irradiance } of lights) {
    // Irradiance of a lamp at a position is that at the centre.
    const light = position
      ? new THREE.PointLight(new THREE.Color(...irradiance), new THREE.Vector3(...position).lengthSq())
      : new THREE.DirectionalLight(new THREE.Color(...irradiance));
    light.position.set(...(position ?? direction));
    scene.add(light);
  }
  const camera = new THREE.PerspectiveCamera(fov_y_deg, 1, 0.1, 100);
  camera.position.z = eye_distance;
  return { picture: await show(renderer, scene, camera), driver: driver(renderer) };
});

/** A ball whose texture coordinates begin at the top, behind: those of `luthier preview --shape sphere`. */
function ball(THREE) {
  const geometry = new THREE.SphereGeometry(1, 128, 64);
  const { uv } = geometry.attributes;
  for (let i = 0; i < uv.count; i++) uv.setXY(i, uv.getX(i) + 0.25, 1 - uv.getY(i));
  return geometry;
}
