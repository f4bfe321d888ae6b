// A ball of a baked material. `?save` sends the picture to the server that `examples/browser.mjs` runs.

import * as THREE from "three";
import { Bake } from "./bake.js";

const VERTEX = /* glsl */ `
precision highp float;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
in vec3 normal;
out vec3 v_position;
out vec3 v_normal;

void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  v_position = world.xyz;
  // No scaling here; otherwise the inverse transpose.
  v_normal = mat3(modelMatrix) * normal;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const fragment = (glsl, lights) => /* glsl */ `
precision highp float;
precision highp int;
${glsl}
struct Light { vec3 direction; vec3 irradiance; };
uniform Light lights[${lights}];
uniform uint material;
uniform vec3 cameraPosition;
in vec3 v_position;
in vec3 v_normal;
out vec4 color;

// The transfer function of sRGB; a raw material has to apply it itself.
vec3 srgb(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, vec3(greaterThan(c, vec3(0.0031308))));
}

void main() {
  // The local frame: +z is the normal, x runs along the parallels of the ball.
  vec3 normal = normalize(v_normal);
  vec3 up = abs(normal.y) > 0.9999 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 tangent = normalize(cross(up, normal));
  mat3 frame = mat3(tangent, cross(normal, tangent), normal);

  // A vector times a matrix is the transposed matrix times the vector: from the world into the frame.
  vec3 wo = normalize(cameraPosition - v_position) * frame;
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < ${lights}; i++) {
    radiance += lights[i].irradiance * luthier_eval(material, lights[i].direction * frame, wo);
  }
  color = vec4(srgb(radiance), 1.0);
}`;

/** A material that evaluates `bake`, lit by `lights` of scene.json. */
function bakedMaterial(bake, name, lights) {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: VERTEX,
    fragmentShader: fragment(bake.glsl, lights.length),
    uniforms: {
      ...bake.uniforms,
      material: { value: bake.number(name) },
      lights: {
        value: lights.map(({ direction, irradiance }) => ({
          direction: new THREE.Vector3(...direction).normalize(),
          irradiance: new THREE.Vector3(...irradiance),
        })),
      },
    },
  });
}

async function main() {
  const description = await (await fetch("/scene.json")).json();
  const renderer = new THREE.WebGLRenderer();
  renderer.setPixelRatio(1);
  renderer.setSize(description.size, description.size);
  document.body.append(renderer.domElement);
  renderer.debug.onShaderError = (gl, program, vertex, fragment) => {
    throw new Error(`${gl.getProgramInfoLog(program)} ${gl.getShaderInfoLog(vertex)} ${gl.getShaderInfoLog(fragment)}`);
  };

  const bake = await Bake.open(new URL("/bake/", location.href), renderer);
  const ball = new THREE.Mesh(
    new THREE.SphereGeometry(1, 128, 64),
    bakedMaterial(bake, description.material, description.lights),
  );
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(...description.background);
  scene.add(ball);
  const camera = new THREE.PerspectiveCamera(description.fov_y_deg, 1, 0.1, 100);
  camera.position.z = description.eye_distance;
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
