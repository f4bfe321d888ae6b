// The maps of materials, and the lines of shader that fill a `LuthierPlace` from their texels. The lines are the same in GLSL and in WGSL, and the same
// for all materials of a bake: a texel goes to the quantity whose number, its kind, is a uniform. So a bake has one program.

/**
 * What the texel `t` of a map says of the place: the table in docs/manifest.md. `layer` is that of the map; `fills` tells whether the place, or that of a
 * layer, has a member. Undefined where no model of the bake shows the quantity.
 */
const SLOTS = {
  normal: () => "luthier_here.normal = luthier_unit_normal(t);",
  roughness: () => "luthier_here.alpha_factor = t.x * t.x;",
  thickness: (layer, fills) => (layer ? fills("slab_factor", layer) && `luthier_here.layers[${layer}].slab_factor = t.x;` : "luthier_here.slab_factor = t.x;"),
  absorption: (layer, fills) => fills("absorption_factors", layer) && `luthier_here.layers[${layer}].absorption_factors = t;`,
  weight: (_, fills) => fills("weight_factor") && "luthier_here.weight_factor = t.x;",
  patina: (_, fills) => fills("patina") && "luthier_here.patina = luthier_patina_amount(material, t.x);",
  "flake-normal": (_, fills) => fills("flake_normal") && "luthier_here.flake_normal = luthier_flake_tilt(material, 2.0 * t - 1.0, distance);",
  bumps: (layer, fills) => fills("normal", layer) && `luthier_here.layers[${layer}].normal = luthier_unit_normal(t);`,
  alpha: (layer, fills) => fills("alpha_factors", layer) && `luthier_here.layers[${layer}].alpha_factors *= t.x;`,
  "alpha-x": (layer, fills) => fills("alpha_factors", layer) && `luthier_here.layers[${layer}].alpha_factors.x *= t.x;`,
  "alpha-y": (layer, fills) => fills("alpha_factors", layer) && `luthier_here.layers[${layer}].alpha_factors.y *= t.x;`,
  tangent: (layer, fills) => fills("tangent", layer) && `luthier_here.layers[${layer}].tangent = luthier_tangent(t.xy);`,
  albedo: (_, fills) => fills("base_color") && "luthier_here.base_color = t;",
  lean: (_, fills) => fills("inner_normal") && "luthier_here.inner_normal = luthier_lean(luthier_unit_normal(t), luthier_here.inner_normal);",
  f0: (_, fills) => fills("luthier_f0_place") && "luthier_here = luthier_f0_place(luthier_here, material, t);",
  // They take effect together, in the end.
  "base-color": (_, fills) => fills("luthier_metallic_place") && "luthier_base = vec4(t, luthier_base.w);",
  metallic: (_, fills) => fills("luthier_metallic_place") && "luthier_base.w = t.x;",
};

/** What the maps of a bake have in common: lines of shader, and the number of textures that one material has at most. */
export class Surface {
  constructor(manifest, { functions, structures }, shader) {
    const members = Object.fromEntries(structures.map(({ name, members }) => [name, members]));
    const calls = (name) => functions.some((known) => known.name === name);
    // Layers with places of their own: `LuthierLayerPlace layers[2];`, or `array<LuthierLayerPlace, 2>`.
    const [, layers = 0] = shader.match(/LuthierLayerPlace(?:, | layers\[)(\d+)/) ?? [];
    const fills = (member, layer) => {
      if (member.startsWith("luthier_")) return calls(member);
      if (layer === undefined) return members.LuthierPlace.includes(member);
      return layer < layers && members.LuthierLayerPlace.includes(member);
    };

    /** Lines of the kinds from 1 up, by slot and layer. */
    this.kinds = new Map();
    for (const { name, maps } of manifest.materials) {
      for (const { slot, layer } of maps) {
        if (!(slot in SLOTS)) throw new Error(`${name} has a map of ${slot}, which this version of luthier-web does not know`);
        const line = SLOTS[slot](layer ?? 0, fills);
        if (line) this.kinds.set(`${slot} ${layer}`, line);
      }
    }
    /** Textures that a material has at most. */
    this.width = Math.max(0, ...manifest.materials.map((entry) => this.mapsOf(entry).length));

    const before = [
      calls("luthier_film_place") && "luthier_here = luthier_film_place(luthier_here, material, uv);",
      calls("luthier_flake_normal") && "luthier_here.flake_normal = luthier_flake_normal(material, uv, distance);",
    ];
    const after = [
      calls("luthier_metallic_place") && "if (luthier_base.w >= 0.0) { luthier_here = luthier_metallic_place(luthier_here, material, luthier_base.xyz, luthier_base.w); }",
      calls("luthier_glitter_normal") && "if (luthier_glitter_normal(material, uv).z < 1.0) { luthier_here.normal = luthier_glitter_normal(material, uv); }",
    ];
    const lines = (list) => list.filter(Boolean).join("\n  ");
    const kinds = [...this.kinds.values()].map((line, i) => `if (kind == ${i + 1}u) { ${line} }`);
    /** Statements before the maps; of the texel `t` of a `kind`; behind the maps. They read `material`, `uv` and `distance`, from the eye. */
    this.lines = { before: lines(before), texel: lines(kinds), after: lines(after) };
  }

  /** The maps of a material that its model shows, in the order in which they fill the place. */
  mapsOf({ maps }) {
    // An F0 may depend on the weight of the coat above.
    const shown = maps.filter(({ slot, layer }) => this.kinds.has(`${slot} ${layer}`));
    return [...shown.filter(({ slot }) => slot !== "f0"), ...shown.filter(({ slot }) => slot === "f0")];
  }

  /**
   * Numbers of the maps of a material, one element for each texture that it may have: `kinds`; `rows`, the matrix of the texture coordinates, column by column;
   * `factors`, three each. And its `base`, four numbers.
   */
  uniformsOf(entry) {
    const maps = this.mapsOf(entry);
    const kinds = [...this.kinds.keys()];
    const all = Array.from({ length: this.width }, (_, i) => maps[i]);
    return {
      kinds: all.map((map) => (map ? kinds.indexOf(`${map.slot} ${map.layer}`) + 1 : 0)),
      rows: all.map((map) => rowsOf(entry, map)),
      factors: all.map((map) => map?.factor ?? [1, 1, 1]),
      base: maps.some(({ slot }) => slot === "base-color" || slot === "metallic") ? uncoloured(entry) : [0, 0, 0, -1],
    };
  }
}

/**
 * Statements, in GLSL and in WGSL, that fill `luthier_here` from the maps at `uv`. The host says how it writes the numbers of map `i`, `kind`, `rows` and
 * `factor`, the `base`, and its texel at texture coordinates, `sample(i, at)`. They read `material`, `uv`, `distance` and `variance`.
 */
export function fill({ width, lines }, { kind, rows, factor, base, sample }) {
  const texels = Array.from({ length: width }, (_, i) => {
    const texel = sample(i, `(${rows(i)} * vec3(uv, 1.0)).xy`);
    return `luthier_texel(material, ${kind(i)}, distance, ${factor(i)} * ${texel}.rgb);`;
  });
  const place = ["luthier_here = luthier_place();", "luthier_here.slope_variance = variance;", `luthier_base = ${base};`];
  return [...place, lines.before, ...texels, lines.after].filter(Boolean).join("\n  ");
}

/** The matrix that makes texture coordinates of (u, v, 1). */
function rowsOf({ constants }, map) {
  const [[a, b, c], [d, e, f]] = map?.transform ?? [[1, 0, 0], [0, 1, 0]];
  const tiling = map?.slot === "flake-normal" ? constants.flakes.tiling : 1;
  return [a * tiling, d * tiling, 0, b * tiling, e * tiling, 0, c, f, 1];
}

/** Colour and metal of a surface with a map of the other alone. */
function uncoloured({ constants, layers }) {
  const metallic = layers.some((layer) => layer.is_metal) ? 1 : 0;
  if (constants.brightening) return [...constants.brightening.base_color, metallic];
  // Without metal, what the interface lets through decides the albedo of the base.
  const passed = (0.96 * 20) / 21 / layers.at(-2).eta ** 2;
  return [...layers.at(-1).albedo.map((albedo) => (albedo * passed) / (1 - albedo * (1 - passed))), metallic];
}
