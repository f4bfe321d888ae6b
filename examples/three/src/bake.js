// A bake in memory: textures, the shader, and the materials that are made of them.

import { CompressedCubeTexture, DataTexture, HalfFloatType, LinearFilter, RGBAFormat } from "three";
import { Bake, mapKey } from "luthier-web";

export class LuthierBake extends Bake {
  #Material;

  constructor(read, Material) {
    super(read);
    /** Uniforms of all materials: the cubes of the environment, and whether there is one. */
    this.environmentUniforms = {
      luthier_environment_map: { value: blackCube() },
      luthier_irradiance_map: { value: blackCube() },
      luthier_has_environment: { value: false },
    };
    this.#Material = Material;
  }

  /** A material of the bake, by its name. All share one program, as far as the settings of three.js are the same. */
  material(name, options) {
    return new this.#Material(this, name, options);
  }

  /** Light from all around, of `LuthierEnvironmentLoader`; null for none. */
  set environment(cubes) {
    if (cubes && !this.functions.includes("luthier_environment")) throw new Error("the shader has no light from all around: bake with --functions surface,environment");
    const { luthier_environment_map, luthier_irradiance_map, luthier_has_environment } = this.environmentUniforms;
    luthier_environment_map.value = cubes?.environment ?? blackCube();
    luthier_irradiance_map.value = cubes?.irradiance ?? blackCube();
    luthier_has_environment.value = Boolean(cubes);
  }

  /** Frees the textures. */
  dispose() {
    for (const texture of [...this.tables.values(), ...this.maps.values()]) texture.dispose();
  }

  /**
   * The textures of the maps of a material, as many as any has. Each is a texture of its own, because three.js binds a texture once that a material has
   * twice.
   */
  texturesOf(entry) {
    const used = new Set();
    const textures = this.surface.mapsOf(entry).map((map) => {
      const texture = this.maps.get(mapKey(map));
      if (!used.has(texture)) return used.add(texture) && texture;
      const again = texture.clone();
      again.needsUpdate = true;
      return again;
    });
    while (textures.length < this.surface.width) textures.push(unused(textures.length));
    return textures;
  }
}

const whites = [];

/** One texel in place of the map that a material lacks: one texture for each place in the list. */
function unused(place) {
  if (!whites[place]) {
    whites[place] = new DataTexture(new Uint8Array(4).fill(255), 1, 1);
    whites[place].minFilter = whites[place].magFilter = LinearFilter;
    whites[place].needsUpdate = true;
  }
  return whites[place];
}

function blackCube() {
  const face = { width: 1, height: 1, mipmaps: [{ data: new Uint16Array(4), width: 1, height: 1 }] };
  const texture = new CompressedCubeTexture(Array(6).fill(face), RGBAFormat, HalfFloatType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return texture;
}
