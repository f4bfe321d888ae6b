// A ball of a baked material. `?save` sends the picture to the server that `examples/browser.mjs` runs.

import { Bake } from "./bake.js";

const SEGMENTS = [128, 64];

const VERTEX = /* glsl */ `#version 300 es
uniform float focal;
uniform float eye_distance;
in vec3 point;
out vec3 v_point;

void main() {
  v_point = point;
  // One convex shape without its back faces needs no depth.
  gl_Position = vec4(focal * point.xy, 0.0, eye_distance - point.z);
}`;

const fragment = (glsl, lights) => /* glsl */ `#version 300 es
precision highp float;
precision highp int;
${glsl}
struct Light { vec3 direction; vec3 irradiance; };
uniform Light lights[${lights}];
uniform uint material;
uniform float eye_distance;
in vec3 v_point;
out vec4 color;

// The transfer function of sRGB.
vec3 srgb(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, vec3(greaterThan(c, vec3(0.0031308))));
}

void main() {
  // The local frame: +z is the normal, x runs along the parallels of the ball.
  vec3 normal = normalize(v_point);
  vec3 up = abs(normal.y) > 0.9999 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 tangent = normalize(cross(up, normal));
  mat3 frame = mat3(tangent, cross(normal, tangent), normal);

  // A vector times a matrix is the transposed matrix times the vector: from the world into the frame.
  vec3 wo = normalize(vec3(0.0, 0.0, eye_distance) - v_point) * frame;
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < ${lights}; i++) {
    radiance += lights[i].irradiance * luthier_eval(material, lights[i].direction * frame, wo);
  }
  color = vec4(srgb(radiance), 1.0);
}`;

/** Points of a ball of radius 1, which are its normals too, and the corners of its triangles, counter-clockwise from outside. */
function ball() {
  const [columns, rows] = SEGMENTS;
  const points = [];
  const corners = [];
  for (let row = 0; row <= rows; row++) {
    const theta = (Math.PI * row) / rows;
    for (let column = 0; column <= columns; column++) {
      const phi = (2 * Math.PI * column) / columns;
      points.push(-Math.cos(phi) * Math.sin(theta), Math.cos(theta), Math.sin(phi) * Math.sin(theta));
      if (row < rows && column < columns) {
        const here = row * (columns + 1) + column;
        const below = here + columns + 1;
        corners.push(here + 1, here, below + 1, here, below, below + 1);
      }
    }
  }
  return { points: new Float32Array(points), corners: new Uint16Array(corners) };
}

function program(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

function buffer(gl, target, data) {
  gl.bindBuffer(target, gl.createBuffer());
  gl.bufferData(target, data, gl.STATIC_DRAW);
}

const unit = (vector) => vector.map((value) => value / Math.hypot(...vector));
const srgb = (value) => (value > 0.0031308 ? 1.055 * value ** (1 / 2.4) - 0.055 : 12.92 * value);

async function main() {
  const scene = await (await fetch("/scene.json")).json();
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = scene.size;
  document.body.append(canvas);
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false });
  if (!gl) throw new Error("this browser has no WebGL 2");

  const bake = await Bake.open(new URL("/bake/", location.href), gl);
  const ball_program = program(gl, VERTEX, fragment(bake.glsl, scene.lights.length));
  gl.useProgram(ball_program);
  const uniform = (name) => gl.getUniformLocation(ball_program, name);
  [...bake.textures].forEach(([name, texture], unit) => {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.uniform1i(uniform(name), unit);
  });
  gl.uniform1ui(uniform("material"), bake.number(scene.material));
  gl.uniform1f(uniform("focal"), 1 / Math.tan((scene.fov_y_deg * Math.PI) / 360));
  gl.uniform1f(uniform("eye_distance"), scene.eye_distance);
  scene.lights.forEach(({ direction, irradiance }, i) => {
    gl.uniform3fv(uniform(`lights[${i}].direction`), unit(direction));
    gl.uniform3fv(uniform(`lights[${i}].irradiance`), irradiance);
  });

  const { points, corners } = ball();
  buffer(gl, gl.ARRAY_BUFFER, points);
  buffer(gl, gl.ELEMENT_ARRAY_BUFFER, corners);
  const point = gl.getAttribLocation(ball_program, "point");
  gl.enableVertexAttribArray(point);
  gl.vertexAttribPointer(point, 3, gl.FLOAT, false, 0, 0);
  gl.enable(gl.CULL_FACE);
  gl.clearColor(...scene.background.map(srgb), 1);
  gl.clear(gl.COLOR_BUFFER_BIT);
  gl.drawElements(gl.TRIANGLES, corners.length, gl.UNSIGNED_SHORT, 0);
  const error = gl.getError();
  if (error !== gl.NO_ERROR) throw new Error(`WebGL error ${error}`);

  // In the task of the drawing: later the canvas may be empty.
  const picture = canvas.toDataURL("image/png");
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return { picture, driver: gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER) };
}

const answer = await main().catch((error) => ({ error: String(error.stack ?? error) }));
if (answer.error) console.error(answer.error);
if (new URLSearchParams(location.search).has("save")) {
  await fetch("/save", { method: "POST", body: JSON.stringify(answer) });
}
