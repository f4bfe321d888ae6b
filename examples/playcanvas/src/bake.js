// A bake in memory: textures, the shader, and the materials that are made of them.

import { BUFFERUSAGE_COPY_DST, StorageBuffer } from "playcanvas";
import { Bake } from "luthier-web";
import { LuthierMaterial } from "./material.js";
import { blackCube, whiteTexture, wordsTexture } from "./textures.js";

export class LuthierBake extends Bake {
  #environment = null;

  constructor(device, read) {
    super(read);
    this.device = device;
    /** Materials that were made and not destroyed. */
    this.materials = new Set();
    /** In place of maps that a material lacks. */
    this.white = whiteTexture(device);
    /** Textures and the material buffer of all materials, by the names of the shader. */
    this.resources = new Map(this.tables);
    if (device.isWebGPU) {
      const words = new StorageBuffer(device, this.words.byteLength, BUFFERUSAGE_COPY_DST);
      words.write(0, this.words);
      this.resources.set("luthier_materials", words);
    } else {
      this.resources.set("luthier_materials", wordsTexture(device, this.manifest.material_texture, this.words));
    }
    if (this.#takesEnvironment) for (const name of ["luthier_environment_map", "luthier_irradiance_map"]) this.resources.set(name, blackCube(device, name));
  }

  get #takesEnvironment() {
    return this.functions.includes("luthier_environment");
  }

  /** A material of the bake, by its name. All share one program, as far as the settings of PlayCanvas are the same. */
  material(name, options) {
    return new LuthierMaterial(this, name, options);
  }

  /** Light from all around, of `loadEnvironment`; null for none. */
  get environment() {
    return this.#environment;
  }

  set environment(cubes) {
    if (cubes && !this.#takesEnvironment) throw new Error("the shader has no light from all around: bake with --functions surface,environment");
    this.#environment = cubes;
    for (const material of this.materials) material.setEnvironment(cubes);
  }

  /** Frees the materials, the textures and the material buffer. */
  destroy() {
    for (const material of this.materials) material.destroy();
    for (const resource of [...this.resources.values(), ...this.maps.values(), this.white]) resource.destroy();
  }
}
