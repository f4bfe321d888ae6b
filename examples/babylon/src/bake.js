// A bake of a scene, and light from all around. The engine of the scene decides the language of the shader.

import { LoadFile } from "@babylonjs/core/Misc/fileTools.js";
import { Bake, mapKey, readBake, readEnvironment } from "luthier-web";
import { LuthierMaterial } from "./material.js";
import { blackCube, cubeTexture, mapTexture, tableTexture, whiteTexel, wordsOf } from "./texture.js";

const texts = new Map();

/** Tells the program of a bake from those of others. A bake that is loaded again has the program that it had. */
function programOf(text) {
  if (!texts.has(text)) texts.set(text, texts.size + 1);
  return texts.get(text);
}

export class LuthierBake extends Bake {
  constructor(files, scene) {
    super(files);
    this.scene = scene;
    this.program = programOf(this.text + JSON.stringify(this.surface.lines));
    /** The material buffer: a storage buffer in WebGPU, a texture in WebGL 2. */
    this.materials = wordsOf(this, scene);
    /** What stands for a map, and for surroundings, that are not there. */
    this.unused = whiteTexel(scene);
    this.black = blackCube(scene);
    this.environment = null;
  }

  /** Loads `manifest.json` of a bake, and the shader, tables and maps that it names. `mipmaps` is for maps; `luthier preview` reads level 0 alone. */
  static async LoadAsync(url, scene, { mipmaps = true } = {}) {
    const host = {
      host: "Babylon.js",
      name: "luthier-babylon",
      target: scene.getEngine().isWebGPU ? "wgsl" : "glsl-es300",
      file: load,
      table: (bytes, format) => tableTexture(bytes, format, scene),
      map: (url, map) => mapTexture(url.href, map, scene, mipmaps),
    };
    return new LuthierBake(await readBake(absolute(url), host), scene);
  }

  /** A material of the bake, by its name. All share one program, as far as meshes, lights and settings of the scene are the same. */
  material(name, options) {
    return new LuthierMaterial(this, name, options);
  }

  /** Light from all around, a `LuthierEnvironment`; null for none. */
  get environment() {
    return this.cubes;
  }

  set environment(cubes) {
    if (cubes && !this.functions.includes("luthier_environment")) throw new Error("the shader has no light from all around: bake with --functions surface,environment");
    this.cubes = cubes;
  }

  /** The textures of the maps that a material shows. */
  texturesOf(entry) {
    return this.surface.mapsOf(entry).map((map) => this.maps.get(mapKey(map)));
  }

  /** Frees textures and numbers. */
  dispose() {
    for (const texture of [...this.tables.values(), ...this.maps.values(), this.materials, this.unused, this.black]) texture.dispose();
  }
}

/** The two cubes of `luthier environment --layout cube`. */
export class LuthierEnvironment {
  constructor(environment, irradiance) {
    this.environment = environment;
    this.irradiance = irradiance;
  }

  /** Loads `environment.json` and its cubes. */
  static async LoadAsync(url, scene) {
    const { environment, irradiance } = await readEnvironment(absolute(url), load);
    return new LuthierEnvironment(await cubeTexture(environment, scene), await cubeTexture(irradiance, scene));
  }

  dispose() {
    this.environment.dispose();
    this.irradiance.dispose();
  }
}

const absolute = (url) => new URL(url, document.baseURI);

function load(url, type) {
  return new Promise((resolve, reject) => {
    LoadFile(url.href, resolve, undefined, undefined, type === "arraybuffer", (request, error) => reject(new Error(`${url}: ${request?.statusText || error?.message}`)));
  });
}
