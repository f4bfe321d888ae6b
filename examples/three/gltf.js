// A .glb whose materials are those of a bake.

import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import * as MikkTSpace from "three/addons/libs/mikktspace.module.js";
import { computeMikkTSpaceTangents } from "three/addons/utils/BufferGeometryUtils.js";
import { Box3, Group, Vector3 } from "three";
import { driver, open, run, show } from "./page.js";

run(async ({ renderer: kind, size, file, import: imported, eye, half_extent, light_angular_radius, irradiance, lights }) => {
  const { THREE, LuthierLoader, renderer } = await open(kind, size);
  renderer.shadowMap.enabled = true;
  const loader = new LuthierLoader();
  loader.mipmaps = false; // as in the pictures that it is compared with
  const bake = await loader.loadAsync("bake/manifest.json");
  const { sources } = await (await fetch(`scene/${imported}`)).json();
  const { fitted, found } = await meshes(`scene/${file}`);
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0);
  scene.add(fitted);

  const materials = new Map();
  for (const { mesh, number } of found) {
    // import.json has the materials in the order of the file.
    const name = sources[0].materials[number]?.name;
    if (!name) throw new Error(`a part of ${file} has no material`);
    if (!materials.has(name)) {
      // A lamp with a size widens highlights. `preview` widens the slopes of the file, before a map multiplies them: nearly not, where it does.
      const isRoughByMap = bake.find(name).entry.maps.some(({ slot }) => ["roughness", "alpha", "alpha-y"].includes(slot));
      const slopeVariance = isRoughByMap ? 0 : light_angular_radius ** 2 / 8;
      materials.set(name, bake.material(name, { side: THREE.DoubleSide, slopeVariance }));
    }
    mesh.material = materials.get(name);
    mesh.castShadow = mesh.receiveShadow = true;
  }

  for (const direction of lights) {
    const light = new THREE.DirectionalLight(new THREE.Color(...irradiance));
    light.position.set(...direction).normalize().multiplyScalar(2);
    light.castShadow = true;
    light.shadow.mapSize.set(2048, 2048);
    light.shadow.normalBias = 0.004;
    light.shadow.bias = -0.001;
    Object.assign(light.shadow.camera, { left: -1.01, right: 1.01, top: 1.01, bottom: -1.01, near: 0.9, far: 3.1 });
    scene.add(light);
  }
  const distance = new Vector3(...eye).length();
  const fov = (360 / Math.PI) * Math.atan(half_extent / distance);
  const camera = new THREE.PerspectiveCamera(fov, 1, Math.max(distance - 1.1, 0.01), distance + 1.1);
  camera.position.set(...eye);
  camera.lookAt(0, 0, 0);
  return { picture: await show(renderer, scene, camera), driver: driver(renderer) };
});

/** The meshes of a file, each with its number among the materials of the file. They fill the unit sphere. */
async function meshes(url) {
  const { scene, parser } = await new GLTFLoader().loadAsync(url);
  const found = [];
  scene.updateWorldMatrix(false, true);
  scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const { meshes, primitives = 0 } = parser.associations.get(mesh);
    found.push({ mesh, number: parser.json.meshes[meshes].primitives[primitives].material });
  });
  await MikkTSpace.ready;
  for (const { mesh } of found) mesh.geometry = complete(mesh.geometry);

  const points = found.flatMap(({ mesh }) => {
    const { position } = mesh.geometry.attributes;
    return Array.from({ length: position.count }, (_, i) => new Vector3().fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld));
  });
  const centre = new Box3().setFromPoints(points).getCenter(new Vector3());
  const radius = Math.sqrt(points.reduce((most, point) => Math.max(most, point.distanceToSquared(centre)), 0));
  const fitted = new Group();
  fitted.scale.setScalar(1 / radius);
  fitted.position.copy(centre).divideScalar(-radius);
  fitted.add(scene);
  return { fitted, found };
}

/** A geometry with normals, and with tangents where it has texture coordinates. */
function complete(geometry) {
  let whole = geometry;
  if (!whole.attributes.normal) {
    whole = whole.index ? whole.toNonIndexed() : whole;
    whole.computeVertexNormals();
  }
  if (whole.attributes.tangent || !whole.attributes.uv) return whole;
  return computeMikkTSpaceTangents(whole, MikkTSpace);
}
