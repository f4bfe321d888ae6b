// The tiles: every material small. Each is drawn with one sample first, then with all; it turns while the pointer is over it, or after a press.

/** Side of a tile; less where the page is shown smaller. */
const TILE_PIXELS = Math.ceil(192 * Math.min(devicePixelRatio, 1));
const TILE_SAMPLES = 4;
/** Directions of the environment where it is not blurred beforehand. */
const TILE_DIRECTIONS = 16;
const TURN_PER_MS = 0.0011;

class Tile {
  constructor(material, element) {
    this.material = material;
    this.element = element;
    this.canvas = element.querySelector("canvas");
    this.canvas.width = this.canvas.height = TILE_PIXELS;
    this.context = this.canvas.getContext("2d");
    this.isSeen = false;
    this.isTurning = false;
    this.azimuth = 0;
    this.version = 0;
    element.addEventListener("pointerenter", event => {
      if (event.pointerType === "mouse" && !isStill.matches) this.turn(true);
    });
    element.addEventListener("pointerleave", event => {
      if (event.pointerType === "mouse" && !tiles.areTurning) this.turn(false);
    });
  }

  copy(scale) {
    painter.draw(tiles.sums, painter.black4, { scales: [scale, 0], exposure: look.exposure });
    this.context.drawImage(painter.canvas, 0, 0);
    if (!tiles.first) {
      tiles.first = performance.now();
      performance.mark("luthier-first-picture");
    }
  }

  picture() {
    return pictureOf(this.material, { look: 0, form: "baked" }, { camera: camera(this.azimuth, 0) });
  }

  /** Draws anew: with one sample at once, then with all. */
  async draw() {
    const version = ++this.version;
    const name = `tile ${this.material}`;
    const picture = this.picture();
    const loaded = await painter.ready(picture);
    if (version !== this.version) return;
    const tile = this;
    const left = this.isTurning ? [2] : [1, TILE_SAMPLES];
    const rank = () => (tile.isTurning ? 1 : left[0] === 1 ? 2 : 3) + (tile.isSeen ? 0 : 0.5);
    const steps = function* () {
      while (left.length > 0) {
        const samples = left[0];
        // All passes of a tile at once: tiles share their sums.
        tiles.sums.passes = 0;
        for (const pass of passes(picture.way, samples, TILE_DIRECTIONS, TILE_DIRECTIONS)) {
          painter.pass(tiles.sums, picture, loaded, pass);
        }
        tile.copy(1 / (samples * samples));
        tiles.drawn(tile);
        left.shift();
        yield;
      }
      if (tile.isTurning) tile.next();
    };
    work.put(name, rank, steps());
  }

  turn(isTurning) {
    if (isTurning === this.isTurning) return;
    this.isTurning = isTurning;
    if (isTurning) this.before = performance.now();
    else this.azimuth = 0;
    this.draw();
  }

  next() {
    const now = performance.now();
    this.azimuth = (this.azimuth + (now - this.before) * TURN_PER_MS) % (2 * Math.PI);
    this.before = now;
    if (this.isSeen) this.draw();
    else this.isTurning = false;
  }
}

const tiles = {
  all: [],
  areTurning: false,
  left: new Set(),
  start() {
    this.sums = painter.sums(TILE_PIXELS);
    this.all = [...document.querySelectorAll(".tiles li")].map((element, material) => new Tile(material, element));
    this.left = new Set(this.all);
    const watcher = new IntersectionObserver(
      entries => {
        for (const entry of entries) {
          const tile = this.all[Number(entry.target.dataset.number)];
          tile.isSeen = entry.isIntersecting;
          if (tile.isSeen && this.areTurning) tile.turn(true);
        }
      },
      { rootMargin: "120px" }
    );
    for (const tile of this.all) watcher.observe(tile.element);
    this.draw();
  },
  /** Draws all, each as soon as its shader is there. */
  async draw() {
    const version = (this.version = (this.version || 0) + 1);
    for (const tile of this.all) {
      if (version === this.version) await tile.draw().catch(complain);
    }
  },
  /** All tiles have a picture. */
  drawn(tile) {
    if (this.left.delete(tile) && this.left.size === 0) performance.mark("luthier-all-pictures");
  },
  turn(areTurning) {
    this.areTurning = areTurning;
    for (const tile of this.all) tile.turn(areTurning && tile.isSeen);
  },
};
