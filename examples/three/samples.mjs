// Three .glb files whose materials have textures of every kind that luthier imports: node samples.mjs FOLDER

import { mkdir, writeFile } from "node:fs/promises";
import path from "node:path";
import { deflateSync } from "node:zlib";

const SIDE = 128;
const TURN = 2 * Math.PI;

/** A picture of RGB, 0 to 1, as a function of texture coordinates; PNG of 8 bits. */
function picture(value) {
  const rows = Buffer.alloc(SIDE * (3 * SIDE + 1));
  for (let y = 0; y < SIDE; y++) {
    for (let x = 0; x < SIDE; x++) {
      const rgb = value((x + 0.5) / SIDE, (y + 0.5) / SIDE).map((v) => Math.round(255 * Math.min(Math.max(v, 0), 1)));
      rows.set(rgb, y * (3 * SIDE + 1) + 1 + 3 * x);
    }
  }
  const head = Buffer.alloc(13);
  head.writeUInt32BE(SIDE, 0);
  head.writeUInt32BE(SIDE, 4);
  head.set([8, 2], 8);
  const begin = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([begin, chunk("IHDR", head), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

function chunk(name, data) {
  const body = Buffer.concat([Buffer.from(name), data]);
  let crc = 0xffffffff;
  for (const byte of body) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  const [length, check] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(data.length);
  check.writeUInt32BE(~crc >>> 0);
  return Buffer.concat([length, body, check]);
}

/** Normals of waves with these slopes, so many along u and v. */
const waves = (slope, across, down) => picture((u, v) => {
  const [x, y] = [slope * Math.cos(TURN * across * u), slope * Math.cos(TURN * down * v)];
  const length = Math.hypot(x, y, 1);
  return [x, y, 1].map((n) => 0.5 + (0.5 * n) / length);
});
const wave = (times, at) => 0.5 + 0.5 * Math.sin(TURN * times * at);
const checks = (a, b, times) => picture((u, v) => ((Math.floor(times * u) + Math.floor(times * v)) % 2 ? a : b));

/** A ring about the z axis, with texture coordinates and, where asked for, tangents along u. */
function ring(hasTangents) {
  const [columns, rows] = [96, 48];
  const part = { POSITION: [], NORMAL: [], TEXCOORD_0: [], ...(hasTangents && { TANGENT: [] }) };
  const indices = [];
  for (let row = 0; row <= rows; row++) {
    for (let column = 0; column <= columns; column++) {
      const [s, c] = [Math.sin((TURN * column) / columns), Math.cos((TURN * column) / columns)];
      const [t, d] = [Math.sin((TURN * row) / rows), Math.cos((TURN * row) / rows)];
      part.POSITION.push((1 + 0.45 * d) * c, (1 + 0.45 * d) * s, 0.45 * t);
      part.NORMAL.push(d * c, d * s, t);
      part.TEXCOORD_0.push((4 * column) / columns, (2 * row) / rows);
      // v grows along the parallels, so that the cross product of normal and tangent points against it.
      part.TANGENT?.push(-s, c, 0, -1);
      if (row < rows && column < columns) {
        const [here, above] = [row * (columns + 1) + column, (row + 1) * (columns + 1) + column];
        indices.push(here, here + 1, above + 1, here, above + 1, above);
      }
    }
  }
  return { part, indices };
}

const WIDTH = { POSITION: 3, NORMAL: 3, TANGENT: 4, TEXCOORD_0: 2 };

/** A file: rings in a row, one for each material. The last is mirrored. */
function glb(materials, pictures, hasTangents) {
  const json = { asset: { version: "2.0", generator: "luthier" }, accessors: [], bufferViews: [], images: [], textures: [] };
  const blobs = [];
  let length = 0;
  const view = (bytes, more) => {
    json.bufferViews.push({ buffer: 0, byteOffset: length, byteLength: bytes.length, ...more });
    blobs.push(bytes, Buffer.alloc(-bytes.length & 3));
    length += bytes.length + (-bytes.length & 3);
    return json.bufferViews.length - 1;
  };
  const accessor = (array, componentType, width, more) => {
    const bufferView = view(Buffer.from(array.buffer));
    const type = ["SCALAR", "", "VEC2", "VEC3", "VEC4"][width === 1 ? 0 : width];
    return json.accessors.push({ bufferView, componentType, count: array.length / width, type, ...more }) - 1;
  };
  for (const [name, bytes] of Object.entries(pictures)) {
    json.textures.push({ source: json.images.push({ name, mimeType: "image/png", bufferView: view(bytes) }) - 1 });
  }
  const { part, indices } = ring(hasTangents);
  const bounds = [[-1.45, -1.45, -0.45], [1.45, 1.45, 0.45]];
  const attributes = Object.fromEntries(Object.entries(part).map(([name, values]) =>
    [name, accessor(new Float32Array(values), 5126, WIDTH[name], name === "POSITION" && { min: bounds[0], max: bounds[1] })]));
  const corners = accessor(new Uint16Array(indices), 5123, 1);
  json.materials = materials;
  json.meshes = materials.map((_, material) => ({ primitives: [{ attributes, indices: corners, material }] }));
  json.nodes = materials.map((_, mesh) => ({
    mesh,
    // Each hides some light from the next.
    translation: [2.3 * (mesh - (materials.length - 1) / 2), 0, -0.9 * mesh],
    rotation: [Math.sin(-0.3), 0, 0, Math.cos(-0.3)],
    scale: [mesh > 0 && mesh === materials.length - 1 ? -1 : 1, 1, 1],
  }));
  json.scenes = [{ nodes: materials.map((_, node) => node) }];
  json.scene = 0;
  json.extensionsUsed = [...new Set(JSON.stringify(materials).match(/KHR_\w+/g))];
  json.buffers = [{ byteLength: length }];
  const text = Buffer.from(JSON.stringify(json));
  const head = (size, name) => Buffer.concat([Buffer.from(new Uint32Array([size]).buffer), Buffer.from(name)]);
  const body = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
  const file = [head(body.length, "JSON"), body, head(length, "BIN\0"), ...blobs];
  const size = file.reduce((sum, { length }) => sum + length, 12);
  return Buffer.concat([Buffer.from("glTF"), Buffer.from(new Uint32Array([2, size]).buffer), ...file]);
}

/** A reference to a picture, with a placement. */
const placed = (index, scale, rotation, offset) => ({ index, extensions: { KHR_texture_transform: { scale, rotation, offset } } });

const FILES = {
  /** Metal and roughness, with a placement of its own for each picture. */
  "placed.glb": () => glb([{
    name: "Glazed Tiles",
    pbrMetallicRoughness: {
      baseColorTexture: placed(0, [1.5, 2], 0.4, [0.1, 0.3]),
      metallicRoughnessTexture: placed(1, [2, 1], -0.2, [0, 0.25]),
    },
    normalTexture: placed(2, [1, 1], 0.9, [0.5, 0]),
  }, {
    // A colour without a picture.
    name: "glazed tiles",
    pbrMetallicRoughness: { baseColorFactor: [0.8, 0.35, 0.1, 1], metallicRoughnessTexture: { index: 1 } },
  }], {
    color: checks([0.85, 0.3, 0.2], [0.2, 0.5, 0.75], 4),
    metal: picture((u, v) => [0, 0.35 + 0.4 * wave(2, u), wave(1, v) > 0.6 ? 1 : 0]),
    waves: waves(0.25, 4, 3),
  }, false),
  /** A coat with weight, roughness and normals over a base with normals. */
  "coated.glb": () => glb([{
    name: "Lacquer",
    pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0, roughnessFactor: 0.6 },
    extensions: { KHR_materials_clearcoat: { clearcoatFactor: 1, clearcoatTexture: { index: 1 }, clearcoatRoughnessFactor: 0.2 } },
  }, {
    name: "Varnish",
    pbrMetallicRoughness: { baseColorFactor: [0.1, 0.3, 0.6, 1], metallicFactor: 0, roughnessFactor: 0.5 },
    normalTexture: { index: 2 },
    extensions: {
      KHR_materials_clearcoat: {
        clearcoatFactor: 1,
        clearcoatRoughnessFactor: 0.4,
        clearcoatRoughnessTexture: { index: 3 },
        clearcoatNormalTexture: { index: 4 },
      },
    },
  }], {
    color: checks([0.75, 0.1, 0.1], [0.3, 0.05, 0.3], 4),
    weight: picture((u, v) => [wave(2, u + v), 0, 0]),
    waves: waves(0.2, 5, 4),
    rough: picture((u, v) => [0, 0.15 + 0.85 * wave(1, v), 0]),
    ripples: waves(0.06, 3, 8),
  }, false),
  /** Tangents of the file, directions and strengths by a picture; a film; colours of the specular. */
  "brushed.glb": () => glb([{
    name: "Brushed",
    pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 1, roughnessFactor: 0.35 },
    extensions: { KHR_materials_anisotropy: { anisotropyStrength: 0.8, anisotropyRotation: 0.3, anisotropyTexture: { index: 1 } } },
  }, {
    name: "Film",
    pbrMetallicRoughness: { baseColorFactor: [0.02, 0.02, 0.02, 1], metallicFactor: 0, roughnessFactor: 0.4 },
    extensions: {
      KHR_materials_iridescence: {
        iridescenceFactor: 1,
        iridescenceIor: 1.8,
        iridescenceThicknessMinimum: 200,
        iridescenceThicknessMaximum: 600,
        iridescenceThicknessTexture: { index: 2 },
      },
    },
  }, {
    name: "Tinted",
    pbrMetallicRoughness: { baseColorFactor: [0.2, 0.25, 0.2, 1], metallicFactor: 0, roughnessFactor: 0.4 },
    extensions: { KHR_materials_specular: { specularColorTexture: { index: 3 } } },
  }], {
    color: checks([0.95, 0.8, 0.5], [0.8, 0.75, 0.7], 4),
    directions: picture((u, v) => [0.5 + 0.5 * Math.cos(TURN * v), 0.5 + 0.5 * Math.sin(TURN * v), 0.4 + 0.6 * wave(2, u)]),
    thickness: picture((u) => [0, wave(1, u), 0]),
    specular: checks([1, 0.3, 0.2], [0.3, 0.5, 1], 4),
  }, true),
};

const folder = process.argv[2];
if (!folder) {
  console.error("usage: node samples.mjs FOLDER");
  process.exit(2);
}
await mkdir(folder, { recursive: true });
for (const [name, file] of Object.entries(FILES)) await writeFile(path.join(folder, name), file());
