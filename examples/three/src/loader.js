// Reads the folder of a bake. What three.js draws with decides the language of the shader and the class of the materials: src/index.js and src/webgpu.js.

import { FileLoader, ImageBitmapLoader, LinearFilter, LinearMipmapLinearFilter, Loader, RepeatWrapping, SRGBColorSpace, Texture } from "three";
import { readBake, readEnvironment } from "luthier-web";
import { LuthierBake } from "./bake.js";
import { cubeTexture, tableTexture, unfiltered } from "./texture.js";

/** Loads a file of JSON and the files that it names, which are beside it. */
class FolderLoader extends Loader {
  load(url, onLoad, onProgress, onError) {
    this.loadAsync(url).then(onLoad, onError ?? console.error);
  }

  base(url) {
    return new URL(url, new URL(this.path || ".", document.baseURI));
  }

  file = (url, type) => {
    const loader = new FileLoader(this.manager).setResponseType(type).setRequestHeader(this.requestHeader).setWithCredentials(this.withCredentials);
    return loader.loadAsync(url.href);
  };
}

/** Loads `manifest.json` of a bake, and the shader, tables and maps that it names. A subclass says for which renderer. */
export class BakeLoader extends FolderLoader {
  /** Whether maps get mipmaps. `luthier preview` reads level 0 alone. */
  mipmaps = true;

  async loadAsync(url) {
    const host = { host: "three.js", name: "luthier-three", target: this.target, file: this.file, table: tableTexture, map: this.#map };
    return new LuthierBake(await readBake(this.base(url), host), this.Material);
  }

  /** The texture of a map: its first row is at v = 0, and its numbers are those of the file. The browser reads 16 bits as 8. */
  #map = async (url, { slot, srgb }) => {
    const loader = new ImageBitmapLoader(this.manager).setOptions({ premultiplyAlpha: "none", colorSpaceConversion: "none" });
    const texture = new Texture(await loader.loadAsync(url.href));
    if (srgb) texture.colorSpace = SRGBColorSpace;
    texture.flipY = false;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    const isCells = slot === "flake-normal";
    texture.generateMipmaps = this.mipmaps && !isCells;
    texture.magFilter = LinearFilter;
    texture.minFilter = texture.generateMipmaps ? LinearMipmapLinearFilter : LinearFilter;
    if (isCells) unfiltered(texture);
    texture.needsUpdate = true;
    return texture;
  };
}

/** Loads `environment.json` of the command `luthier environment --layout cube`: the two cubes of a surrounding. */
export class LuthierEnvironmentLoader extends FolderLoader {
  async loadAsync(url) {
    const { environment, irradiance } = await readEnvironment(this.base(url), this.file);
    return { environment: await cubeTexture(environment), irradiance: await cubeTexture(irradiance) };
  }
}
