// Reads the folder of a bake, and surroundings. The device decides the language of the shader: WGSL for WebGPU, else GLSL ES 3.00.

import { ResourceHandler } from "playcanvas";
import { readBake, readEnvironment } from "luthier-web";
import { LuthierBake } from "./bake.js";
import { cubeTexture, mapTexture, tableTexture } from "./textures.js";

/**
 * Loads `manifest.json` of a bake, and the shader, tables and maps that it names. Without `mipmaps` maps are read as `luthier preview` does. Rejects with the file and
 * what to do where the bake cannot be drawn with.
 */
export async function loadBake(device, url, { mipmaps = true } = {}) {
  const read = await readBake(new URL(url, document.baseURI), {
    host: "PlayCanvas",
    name: "luthier-playcanvas",
    target: device.isWebGPU ? "wgsl" : "glsl-es300",
    file,
    table: (bytes, format) => tableTexture(device, "luthier_table", bytes, format),
    map: (url, map) => mapTexture(device, url, map, mipmaps),
  });
  return new LuthierBake(device, read);
}

/** Loads `environment.json` of the command `luthier environment --layout cube`: the two cubes of a surrounding, for `LuthierBake.environment`. */
export async function loadEnvironment(device, url) {
  const files = await readEnvironment(new URL(url, document.baseURI), file);
  const cubes = await Promise.all(Object.entries(files).map(async ([content, bytes]) => [content, await cubeTexture(device, content, bytes)]));
  return Object.fromEntries(cubes);
}

/** Assets of the type "luthier" whose file is a manifest: `app.loader.addHandler("luthier", new LuthierHandler(app))`. The resource is a `LuthierBake`. */
export class LuthierHandler extends ResourceHandler {
  constructor(app) {
    super(app, "luthier");
  }

  load(url, callback) {
    loadBake(this.app.graphicsDevice, url.load ?? url).then((bake) => callback(null, bake), callback);
  }

  open(url, bake) {
    return bake;
  }
}

async function file(url, type) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return type === "text" ? response.text() : response.arrayBuffer();
}
