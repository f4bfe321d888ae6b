// A .glb whose materials are those of a bake. `?save` sends the picture to the server that `examples/browser.mjs` runs.

import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import * as MikkTSpace from "three/addons/libs/mikktspace.module.js";
import { computeMikkTSpaceTangents } from "three/addons/utils/BufferGeometryUtils.js";
import { Bake } from "./bake.js";
import { surface } from "./maps.js";

const SHADOW_SIZE = 2048;

const VERTEX = /* glsl */ `
precision highp float;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
in vec3 normal;
in vec4 tangent;
in vec2 uv;
out vec3 v_position;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;

void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  mat3 linear = mat3(modelMatrix);
  v_position = world.xyz;
  v_normal = normalize(transpose(inverse(linear)) * normal);
  // A mirrored part has its bitangents on the other side.
  v_tangent = vec4(linear * tangent.xyz, tangent.w * sign(determinant(linear)));
  v_uv = uv;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const fragment = (glsl, surface, lights) => /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2DShadow;
${glsl}
${surface}
struct Light { vec3 direction; vec3 irradiance; mat4 view; };
uniform Light lights[${lights}];
uniform sampler2DShadow shadows;
uniform float light_variance;
uniform uint material;
uniform vec3 cameraPosition;
in vec3 v_position;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;
out vec4 color;

// The tone curve of the command preview: values up to 0.8 stay.
vec3 shoulder(vec3 c) {
  vec3 excess = max(c - 0.8, 0.0) / 0.2;
  return min(c, 0.8) + 0.2 * excess / (1.0 + excess);
}

// The transfer function of sRGB; a raw material has to apply it itself.
vec3 srgb(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, vec3(greaterThan(c, vec3(0.0031308))));
}

// Whether a light is seen; the maps of all lights are side by side.
float sees(int i, vec3 normal) {
  vec3 at = (lights[i].view * vec4(v_position + 0.004 * normal, 1.0)).xyz * 0.5 + 0.5;
  return texture(shadows, vec3((float(i) + at.x) / ${lights}.0, at.y, at.z - 0.001));
}

void main() {
  vec3 wo_world = normalize(cameraPosition - v_position);
  // Both sides are shown, and no normal is seen from behind.
  vec3 normal = normalize(v_normal) * (gl_FrontFacing ? 1.0 : -1.0);
  normal = normalize(normal + max(0.02 - dot(normal, wo_world), 0.0) * wo_world);
  vec3 across = cross(normal, abs(normal.x) > 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0));
  vec3 along = v_tangent.xyz - normal * dot(normal, v_tangent.xyz);
  vec3 tangent = normalize(dot(along, along) > 1e-12 ? along : across);
  mat3 frame = mat3(tangent, cross(normal, tangent) * (v_tangent.w < 0.0 ? -1.0 : 1.0), normal);

  LuthierPlace place = surface(material, v_uv);
  // A light with a size widens highlights.
  place.slope_variance = light_variance;
  LuthierPrepared prepared = luthier_prepare_at(place, material, wo_world * frame);
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < ${lights}; i++) {
    radiance += lights[i].irradiance * luthier_light(prepared, lights[i].direction * frame) * sees(i, normal);
  }
  color = vec4(srgb(shoulder(luthier_bounded(radiance))), 1.0);
}`;

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
    return Array.from({ length: position.count }, (_, i) =>
      new THREE.Vector3().fromBufferAttribute(position, i).applyMatrix4(mesh.matrixWorld));
  });
  const centre = new THREE.Box3().setFromPoints(points).getCenter(new THREE.Vector3());
  const radius = Math.sqrt(points.reduce((most, point) => Math.max(most, point.distanceToSquared(centre)), 0));
  const fitted = new THREE.Group();
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

/** Depths of all lights in one texture, each in a square; sets the `view` of the lights. */
function shadowMap(renderer, scene, lights) {
  const target = new THREE.WebGLRenderTarget(SHADOW_SIZE * lights.length, SHADOW_SIZE);
  target.depthTexture = new THREE.DepthTexture(target.width, target.height, THREE.FloatType);
  target.depthTexture.compareFunction = THREE.LessEqualCompare;
  target.depthTexture.minFilter = target.depthTexture.magFilter = THREE.LinearFilter;
  scene.overrideMaterial = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, colorWrite: false });
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.autoClear = false;
  lights.forEach((light, i) => {
    const camera = new THREE.OrthographicCamera(-1.01, 1.01, 1.01, -1.01, 0.9, 3.1);
    camera.position.copy(light.direction).multiplyScalar(2);
    camera.lookAt(0, 0, 0);
    target.viewport.set(i * SHADOW_SIZE, 0, SHADOW_SIZE, SHADOW_SIZE);
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    light.view.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  });
  renderer.autoClear = true;
  renderer.setRenderTarget(null);
  scene.overrideMaterial = null;
  return target.depthTexture;
}

async function main() {
  const description = await (await fetch("/scene.json")).json();
  const beside = (name) => new URL(name, new URL("/scene/", location.href));
  const renderer = new THREE.WebGLRenderer();
  renderer.setPixelRatio(1);
  renderer.setSize(description.size, description.size);
  document.body.append(renderer.domElement);
  renderer.debug.onShaderError = (gl, program, vertex, fragment) => {
    throw new Error(`${gl.getProgramInfoLog(program)} ${gl.getShaderInfoLog(vertex)} ${gl.getShaderInfoLog(fragment)}`);
  };

  const bake = await Bake.open(new URL("/bake/", location.href), renderer);
  const imported = await (await fetch(beside(description.import))).json();
  const { fitted, found } = await meshes(beside(description.file).href);
  const scene = new THREE.Scene();
  scene.add(fitted);

  const lights = description.lights.map((direction) => ({
    direction: new THREE.Vector3(...direction).normalize(),
    irradiance: new THREE.Vector3(...description.irradiance),
    view: new THREE.Matrix4(),
  }));
  const shared = {
    ...bake.uniforms,
    lights: { value: lights },
    shadows: { value: shadowMap(renderer, scene, lights) },
  };
  const materials = new Map();
  for (const { mesh, number } of found) {
    // import.json has the materials in the order of the file.
    const name = imported.sources[0].materials[number]?.name;
    if (!name) throw new Error(`a part of ${description.file} has no material`);
    if (!materials.has(name)) {
      const number = bake.number(name);
      const { uniforms, glsl } = await surface(bake, number);
      // Slope parameters become sqrt(alpha^2 + 2 variance). `preview` widens those of the file, before a map multiplies them: nearly not, where it does.
      const isRoughByMap = bake.manifest.materials[number].maps.some(({ slot }) => ["roughness", "alpha", "alpha-y"].includes(slot));
      const variance = isRoughByMap ? 0 : description.light_angular_radius ** 2 / 8;
      materials.set(name, new THREE.RawShaderMaterial({
        glslVersion: THREE.GLSL3,
        side: THREE.DoubleSide,
        vertexShader: VERTEX,
        fragmentShader: fragment(bake.glsl, glsl, lights.length),
        uniforms: { ...shared, ...uniforms, material: { value: number }, light_variance: { value: variance } },
      }));
    }
    mesh.material = materials.get(name);
  }

  const eye = new THREE.Vector3(...description.eye);
  const distance = eye.length();
  const fov = (360 / Math.PI) * Math.atan(description.half_extent / distance);
  const camera = new THREE.PerspectiveCamera(fov, 1, Math.max(distance - 1.1, 0.01), distance + 1.1);
  camera.position.copy(eye);
  camera.lookAt(0, 0, 0);
  renderer.render(scene, camera);

  // In the task of the drawing: later the canvas may be empty.
  const picture = renderer.domElement.toDataURL("image/png");
  const gl = renderer.getContext();
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return { picture, driver: gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER) };
}

const answer = await main().catch((error) => ({ error: String(error.stack ?? error) }));
if (answer.error) console.error(answer.error);
if (new URLSearchParams(location.search).has("save")) {
  await fetch("/save", { method: "POST", body: JSON.stringify(answer) });
}
