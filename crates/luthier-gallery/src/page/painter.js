// Draws balls of materials: one WebGL context for the whole page.

/** Bytes of a texel, where it has not four. */
const TEXEL_BYTES = { r16float: 2, rgba16float: 8, rgba32float: 16 };

const VERTEX = `#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}`;

/** Radius of the camera's orbit and half the side of the picture at its centre: those of `luthier preview`. */
const EYE_DISTANCE = 7;
const HALF_EXTENT = 1.22;
const BACKDROP = [0.13, 0.13, 0.133];
/** The light of pictures that name none. */
const LIGHT = { direction: [-0.45, 0.7, 0.6], irradiance: [1.75, 1.7, 1.62] };

const toward = vector => vector.map(value => value / Math.hypot(...vector));

class Painter {
  constructor() {
    this.canvas = document.createElement("canvas");
    const gl = this.canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.gl = gl;
    if (gl.getExtension("EXT_color_buffer_float")) this.sum = "rgba32float";
    else if (gl.getExtension("EXT_color_buffer_half_float")) this.sum = "rgba16float";
    else throw new Error("this browser draws no floating-point pictures");
    this.parallel = gl.getExtension("KHR_parallel_shader_compile");
    this.black = this.texels("rgba16float", 1, 1, new Uint16Array(4));
    this.blackCube = this.cube([{ width: 1, texels: new Uint16Array(4) }], 1);
    this.show = this.compile(VERTEX, data.glsl.show);
    this.packageTables = kept(number => this.loadTables(number));
    this.setWords = kept(number => this.loadWords(number));
    this.skies = kept(number => this.loadSky(number));
    this.textures = kept(number => this.loadTextures(number));
    this.programs = kept(key => this.loadProgram(...key.split(" ")));
  }

  /** A texture whose texels are read one by one. */
  texels(format, width, height, texels) {
    return makeTexture(this.gl, { format, width, height, texels, filter: this.gl.NEAREST });
  }

  /** A cube of levels: six images each, or one for all faces. */
  cube(images, faces) {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_CUBE_MAP, texture);
    const levels = images.length / faces;
    for (let level = 0; level < levels; level++) {
      for (let face = 0; face < 6; face++) {
        const { width, texels } = images[level * faces + (face % faces)];
        gl.texImage2D(gl.TEXTURE_CUBE_MAP_POSITIVE_X + face, level, gl.RGBA16F, width, width, 0, gl.RGBA, gl.HALF_FLOAT, texels);
      }
    }
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MAX_LEVEL, levels - 1);
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MIN_FILTER, levels > 1 ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    return texture;
  }

  /** Images one below the other, and where they are: first row, columns, rows. */
  stacked(images) {
    const { gl } = this;
    const width = Math.max(...images.map(image => image.width));
    const height = images.reduce((sum, image) => sum + image.height, 0);
    const texture = this.texels("rgba16float", width, height, null);
    const headers = [];
    let row = 0;
    for (const image of images) {
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, image.width, image.height, gl.RGBA, gl.HALF_FLOAT, image.texels);
      headers.push([row, image.width, image.height]);
      row += image.height;
    }
    return { texture, headers };
  }

  async loadTables(number) {
    const tables = await Promise.all(
      data.packages[number].map(async place => {
        const { name, format, width, height, texels } = data.tables[place];
        const bytes = await inflateBytes(texels, TEXEL_BYTES[format] || 4);
        return [name, makeTexture(this.gl, { format, width, height, texels: bytes })];
      })
    );
    return new Map(tables);
  }

  async loadWords(number) {
    const { words, size } = data.sets[number];
    return this.texels("rgba32float", size[0], size[1], await inflateBytes(words, 4));
  }

  async loadSky(number) {
    const sky = data.skies[number];
    const maps = this.stacked(await inflateImages(sky.maps, sky.sizes));
    const loaded = { maps, chains: sky.chains, cube: this.blackCube, irradiance: this.blackCube };
    if (sky.cube) {
      const sides = [];
      for (let side = sky.cube; side >= 4; side /= 2) sides.push(...Array(6).fill(side));
      const images = await inflateImages(sky.cubes, [...sides, ...Array(6).fill(sky.irradiance)].map(side => [side, side]));
      loaded.cube = this.cube(images.slice(0, sides.length), 6);
      loaded.irradiance = this.cube(images.slice(sides.length), 6);
    }
    return loaded;
  }

  /** Textures of a material: all in one, and where those of each slot are. */
  async loadTextures(number) {
    const { maps } = data.materials[number];
    const slots = Array(24).fill(0);
    const turns = Array(8).fill([1, 0, 0, 0, 1, 0]);
    if (!maps) return { texture: this.black, slots, turns: turns.flat() };
    const images = await inflateImages(maps.texels, maps.sizes);
    const { texture, headers } = this.stacked(images);
    maps.slots.forEach((slot, i) => {
      slots.splice(3 * slot, 3, ...headers[i]);
      turns[slot] = maps.turns[i].flat();
    });
    return { texture, slots, turns: turns.flat() };
  }

  /** The simulated picture of a material. */
  async simulated(number) {
    const { size, texels } = data.materials[number].simulated;
    const [image] = await inflateImages(texels, [[size, size]]);
    const { gl } = this;
    const texture = this.texels("rgba16float", size, size, image.texels);
    const framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return { size, sides: [{ texture, framebuffer }], newest: 0 };
  }

  compile(vertex, fragment) {
    const { gl } = this;
    const program = gl.createProgram();
    const shaders = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].map(([type, text]) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    gl.linkProgram(program);
    return { program, shaders, places: new Map(), isChecked: false };
  }

  /** Waits until a program is compiled, and says why it is not. */
  async linked(compiled) {
    const { gl } = this;
    while (this.parallel && !gl.getProgramParameter(compiled.program, this.parallel.COMPLETION_STATUS_KHR)) {
      await new Promise(done => setTimeout(done, 4));
    }
    if (!gl.getProgramParameter(compiled.program, gl.LINK_STATUS)) {
      const log = compiled.shaders.map(shader => gl.getShaderInfoLog(shader)).join("\n");
      throw new Error(`a shader was refused: ${log || gl.getProgramInfoLog(compiled.program)}`);
    }
    return compiled;
  }

  async loadProgram(set, form, way) {
    const shader = data.sets[set][form];
    const defines = shader.defines.map(name => `#define ${name}\n`).join("");
    const { constants, view, main } = data.glsl;
    const head = `#version 300 es\nprecision highp float;\nprecision highp int;\n${constants}${defines}`;
    const text = [head, await inflateText(shader.glsl), view, data.glsl[way], main].join("\n");
    return this.linked(this.compile(VERTEX, text));
  }

  place({ program, places }, name) {
    if (!places.has(name)) places.set(name, this.gl.getUniformLocation(program, name));
    return places.get(name);
  }

  /** Two pictures of sums: one is read while the other is written. */
  sums(size) {
    const { gl } = this;
    const sides = [0, 1].map(() => {
      const texture = this.texels(this.sum, size, size, null);
      const framebuffer = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
      return { texture, framebuffer };
    });
    return { size, sides, newest: 0, passes: 0 };
  }

  free(sums) {
    for (const { texture, framebuffer } of sums.sides) {
      this.gl.deleteTexture(texture);
      this.gl.deleteFramebuffer(framebuffer);
    }
  }

  /** Loads all that pictures of one kind read. Passes are drawn at once from then on. */
  async ready({ material, set, form, way, sky }) {
    const [compiled, tables, words, surroundings, textures] = await Promise.all([
      this.programs(`${set} ${form} ${way}`),
      this.packageTables(data.sets[set].package),
      this.setWords(set),
      this.skies(sky),
      this.textures(material),
    ]);
    return { compiled, tables, words, surroundings, textures };
  }

  /** Adds a pass to sums. `picture` says what of, `loaded` is what `ready` gave for it. */
  pass(sums, picture, loaded, { samples, sample, directions, firstDirection, directionCount }) {
    const { gl } = this;
    const { compiled, tables, words, surroundings, textures } = loaded;
    const [read, write] = [sums.sides[sums.newest], sums.sides[1 - sums.newest]];
    gl.bindFramebuffer(gl.FRAMEBUFFER, write.framebuffer);
    gl.viewport(0, 0, sums.size, sums.size);
    gl.useProgram(compiled.program);
    const at = name => this.place(compiled, name);
    let unit = 0;
    const bind = (name, texture, target = gl.TEXTURE_2D) => {
      if (at(name) === null) return;
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(target, texture);
      gl.uniform1i(at(name), unit++);
    };
    bind("view_before", read.texture);
    bind("luthier_materials", words);
    for (const name of data.sets[picture.set][picture.form].tables) bind(name, tables.get(name));
    bind("view_maps", surroundings.maps.texture);
    bind("view_textures", textures.texture);
    bind("luthier_environment_map", surroundings.cube, gl.TEXTURE_CUBE_MAP);
    bind("luthier_irradiance_map", surroundings.irradiance, gl.TEXTURE_CUBE_MAP);

    gl.uniform1i(at("view_is_first"), sums.passes === 0);
    gl.uniform1i(at("view_size"), sums.size);
    gl.uniform1i(at("view_samples"), samples);
    gl.uniform1i(at("view_sample"), sample);
    const { eye, right, up } = picture.camera;
    gl.uniform3fv(at("view_eye"), eye);
    gl.uniform3fv(at("view_right"), right);
    gl.uniform3fv(at("view_up"), up);
    gl.uniform1ui(at("view_material"), picture.number);
    gl.uniform1ui(at("view_lit_material"), picture.number + data.sets[picture.set].count);
    gl.uniform3fv(at("view_light"), toward(picture.light.direction));
    gl.uniform3fv(at("view_irradiance"), picture.light.irradiance);
    gl.uniform1i(at("view_is_lit"), firstDirection === 0);
    gl.uniform3fv(at("view_backdrop"), BACKDROP);
    gl.uniform1i(at("view_shows_sky"), picture.showsSky);
    gl.uniform2f(at("view_sky"), Math.cos(picture.skyTurn), Math.sin(picture.skyTurn));
    gl.uniform3iv(at("view_headers"), surroundings.maps.headers.flat());
    gl.uniform2iv(at("view_chains"), surroundings.chains);
    gl.uniform1f(at("view_slopes"), picture.slopes);
    if (at("view_live") !== null) gl.uniform4fv(at("view_live"), picture.live);
    gl.uniform3iv(at("view_slots"), textures.slots);
    gl.uniform3fv(at("view_turns"), textures.turns);
    gl.uniform1i(at("view_directions"), directions);
    gl.uniform1i(at("view_first_direction"), firstDirection);
    gl.uniform1i(at("view_direction_count"), directionCount);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    sums.newest = 1 - sums.newest;
    sums.passes++;
  }

  /** Draws sums, each with one over its number of samples, to the canvas of the painter. */
  draw(a, b, { scales, exposure, mode = 0, split = 0.5, gain = 1 }) {
    const { gl } = this;
    const { size } = a;
    if (this.canvas.width !== size) this.canvas.width = this.canvas.height = size;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, size, size);
    gl.useProgram(this.show.program);
    const at = name => this.place(this.show, name);
    [["show_a", a], ["show_b", b]].forEach(([name, sums], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, sums.texture || sums.sides[sums.newest].texture);
      gl.uniform1i(at(name), unit);
    });
    gl.uniform2fv(at("show_scales"), scales);
    gl.uniform1f(at("show_exposure"), 2 ** exposure);
    gl.uniform1i(at("show_mode"), mode);
    gl.uniform1f(at("show_split"), split);
    gl.uniform1f(at("show_gain"), gain);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  /** A mark behind all that was asked of the driver. */
  fence() {
    const fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
    return fence;
  }

  isPast(fence) {
    return this.gl.getSyncParameter(fence, this.gl.SYNC_STATUS) === this.gl.SIGNALED;
  }

  forget(fence) {
    this.gl.deleteSync(fence);
  }

  /** Radiance of sums, RGBA, from the bottom up. */
  values(sums, scale) {
    const { gl } = this;
    const values = new Float32Array(4 * sums.size * sums.size);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sums.sides[sums.newest].framebuffer);
    gl.readPixels(0, 0, sums.size, sums.size, gl.RGBA, gl.FLOAT, values);
    return values.map(value => value * scale);
  }
}

/** The camera at an azimuth and a height, in radians, on its orbit. */
function camera(azimuth, height) {
  const [sin, cos] = [Math.sin(azimuth), Math.cos(azimuth)];
  const [high, level] = [Math.sin(height), Math.cos(height)];
  return {
    eye: [EYE_DISTANCE * sin * level, EYE_DISTANCE * high, EYE_DISTANCE * cos * level],
    right: [HALF_EXTENT * cos, 0, -HALF_EXTENT * sin],
    up: [-HALF_EXTENT * sin * high, HALF_EXTENT * level, -HALF_EXTENT * cos * high],
  };
}
