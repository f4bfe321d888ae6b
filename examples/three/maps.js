// Maps of a baked material: their textures, and the GLSL that fills a `LuthierPlace` from them.

import * as THREE from "three";

/** Uniforms and GLSL of the maps of a material. The GLSL is a function `LuthierPlace surface(uint material, vec2 uv)`. */
export async function surface(bake, number) {
  const entry = bake.manifest.materials[number];
  const uniforms = {};
  const declarations = [];
  /** The texel of a map, RGB, times its factor. */
  const texel = async (map) => {
    const name = `map_${map.slot.replace("-", "_")}_${map.layer}`;
    const [[a, b, c], [d, e, f]] = map.transform ?? [[1, 0, 0], [0, 1, 0]];
    uniforms[name] = { value: await texture(new URL(map.file.path, bake.url), map.srgb) };
    // Columns are the rows of the manifest: a vector times them is the texture coordinate.
    uniforms[`${name}_rows`] = { value: new THREE.Matrix3(a, d, 0, b, e, 0, c, f, 1) };
    uniforms[`${name}_factor`] = { value: new THREE.Vector3(...(map.factor ?? [1, 1, 1])) };
    declarations.push(`uniform sampler2D ${name};`, `uniform mat3 ${name}_rows;`, `uniform vec3 ${name}_factor;`);
    return `${name}_factor * texture(${name}, (vec3(uv, 1.0) * ${name}_rows).xy).rgb`;
  };

  const lines = [];
  const has = (name) => bake.interface.functions.some((known) => known.name === name);
  // The thickness of a film is a table of the bake.
  if (has("luthier_film_place")) lines.push("place = luthier_film_place(place, material, uv);");
  const [colors, others] = [true, false].map((is) => entry.maps.filter(({ slot }) => slot in COLORS === is));
  for (const map of others) {
    const line = PLACES[map.slot];
    if (!line) throw new Error(`${entry.name} has a map of ${map.slot}, which glTF does not have`);
    lines.push(`{ vec3 t = ${await texel(map)}; ${line(map.layer)} }`);
  }
  // Behind the weight of a coat, on which the colour below may depend.
  for (const map of colors) COLORS[map.slot](lines, await texel(map));
  if (colors.some(({ slot }) => slot !== "f0")) {
    const [color, metallic] = uncoloured(entry);
    lines.unshift(`vec3 color = ${vec3(color)};`, `float metallic = ${metallic.toFixed(1)};`);
    lines.push("place = luthier_metallic_place(place, material, color, metallic);");
  }
  const body = lines.map((line) => `  ${line}`).join("\n");
  const glsl = `${declarations.join("\n")}
vec3 normal_of(vec3 texel) {
  vec3 n = 2.0 * texel - 1.0;
  return normalize(vec3(n.xy, max(n.z, 0.001)));
}
LuthierPlace surface(uint material, vec2 uv) {
  LuthierPlace place = luthier_place();
${body}
  return place;
}`;
  return { uniforms, glsl };
}

/** What the texel t of a map says of a place: the table in docs/manifest.md, of the slots that imported glTF has. */
const PLACES = {
  normal: () => "place.normal = normal_of(t);",
  roughness: () => "place.alpha_factor = t.r * t.r;",
  weight: () => "place.weight_factor = t.r;",
  bumps: (layer) => `place.layers[${layer}].normal = normal_of(t);`,
  alpha: (layer) => `place.layers[${layer}].alpha_factors *= t.r;`,
  "alpha-x": (layer) => `place.layers[${layer}].alpha_factors.x *= t.r;`,
  "alpha-y": (layer) => `place.layers[${layer}].alpha_factors.y *= t.r;`,
  tangent: (layer) => `place.layers[${layer}].tangent = luthier_tangent(t.rg);`,
};

const COLORS = {
  f0: (lines, texel) => lines.push(`place = luthier_f0_place(place, material, ${texel});`),
  "base-color": (lines, texel) => lines.push(`color = ${texel};`),
  metallic: (lines, texel) => lines.push(`metallic = (${texel}).r;`),
};

/** Colour and metal of a surface with a map of the other alone. */
function uncoloured({ constants, layers }) {
  const metallic = layers.some((layer) => layer.is_metal) ? 1 : 0;
  if (constants.brightening) return [constants.brightening.base_color, metallic];
  // Without metal, what the interface lets through decides the albedo of the base.
  const passed = (0.96 * 20) / 21 / layers.at(-2).eta ** 2;
  return [layers.at(-1).albedo.map((albedo) => (albedo * passed) / (1 - albedo * (1 - passed))), metallic];
}

const vec3 = (numbers) => `vec3(${numbers.map((number) => number.toFixed(9)).join(", ")})`;

const textures = new Map();

/** The texture of a map, level 0 alone. Materials that share a file share it. */
function texture(url, isSrgb) {
  const key = `${url} ${isSrgb}`;
  if (!textures.has(key)) textures.set(key, load(url, isSrgb));
  return textures.get(key);
}

/** The browser reads maps of 16 bits as 8: in the pictures of compare.sh that is not seen. */
async function load(url, isSrgb) {
  const loader = new THREE.ImageBitmapLoader().setOptions({ premultiplyAlpha: "none", colorSpaceConversion: "none" });
  const texture = new THREE.Texture(await loader.loadAsync(url.href));
  if (isSrgb) texture.colorSpace = THREE.SRGBColorSpace;
  texture.flipY = false; // the first row is at v = 0
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return texture;
}
