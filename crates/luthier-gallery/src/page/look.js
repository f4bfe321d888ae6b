// How all pictures are lit, and the order in which they are drawn.

const find = id => document.getElementById(`page-${id}`);
const isStill = matchMedia("(prefers-reduced-motion: reduce)");

const look = {
  sky: 0,
  skyTurn: 0,
  exposure: 0,
  showsSky: false,
  hasLight: data.skies[0].has_light,
  azimuth: Math.atan2(LIGHT.direction[0], LIGHT.direction[2]),
  height: Math.asin(toward(LIGHT.direction)[1]),
};

/** Numbers that the page sets: those of the file, and in their places those of sliders. See `view_live` of the shader. */
function liveNumbers(material, { look: number, form }, values) {
  const { set, live } = data.materials[material].looks[number];
  const numbers = [1, 1, 1, 0, 1, 1, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0];
  for (let i = 0; i < data.sets[set][form].layers; i++) numbers.push(1, 1, 1, 0, 1, 1, 1, 0);
  if (!live) return numbers;
  for (const [place, value] of live.set) numbers[place] = value;
  // A map of the albedo has the number of the file in its texels.
  const { maps } = data.materials[material];
  const isMapped = numbers[7] > 0 && maps && maps.slots.includes(5);
  if (isMapped) numbers[7] = 2;
  live.sliders.forEach(({ value, places }, i) => {
    const moved = values && values[i] !== undefined ? values[i] : value;
    for (const place of places) numbers[place] = isMapped && place >= 4 && place < 7 ? moved / Math.max(value, 1e-6) : moved;
  });
  return numbers;
}

/** A material by one of its looks, under the light of the page, as the painter takes it. `slopes` is a factor on all slope parameters, and `live` are numbers of the sliders of the look. */
function pictureOf(material, choice, { camera, way, given = look, slopes = 1, live }) {
  const { set, number, is_blurred: isBlurred } = data.materials[material].looks[choice.look];
  const level = Math.cos(given.height);
  const direction = [Math.sin(given.azimuth) * level, Math.sin(given.height), Math.cos(given.azimuth) * level];
  return {
    material,
    set,
    number,
    form: choice.form,
    // Surroundings that were blurred beforehand need tables of albedos.
    way: way || (isBlurred && choice.form === "baked" ? "blurred" : "drawn"),
    sky: given.sky,
    skyTurn: given.skyTurn,
    showsSky: given.showsSky,
    slopes,
    live: liveNumbers(material, choice, live),
    camera,
    light: { direction, irradiance: given.hasLight ? LIGHT.irradiance : [0, 0, 0] },
  };
}

/** Passes of a picture: samples of a pixel, and where directions are drawn, so many of these at once. */
function* passes(way, samples, directions, together) {
  const count = samples * samples;
  for (let i = 0; i < count; i++) {
    // Spread over the pixel, so that the first few stand for all.
    const sample = (i * 7) % count;
    const last = way === "drawn" ? directions : 1;
    for (let first = 0; first < last; first += together) {
      const isWhole = first + together >= last;
      const pass = { samples, sample, directions, firstDirection: first, directionCount: Math.min(together, directions - first) };
      yield { ...pass, done: isWhole ? i + 1 : 0 };
    }
  }
}

/** Milliseconds of a frame in which pictures are drawn, and steps at most. */
const FRAME_MS = 12;
const FRAME_STEPS = 32;

/** Work by frames: generators, of which the one with the least rank goes on. */
const work = {
  jobs: new Map(),
  isScheduled: false,
  /** Steps of a frame: as many as the driver is through with before the next. */
  steps: 1,
  fence: null,
  /** Puts a job in the place of one with the same name. */
  put(name, rank, steps) {
    this.jobs.set(name, { rank, steps });
    this.schedule();
  },
  drop(name) {
    this.jobs.delete(name);
  },
  schedule() {
    if (this.isScheduled) return;
    this.isScheduled = true;
    // Frames do not come to pages in the background, nor while one is printed.
    const isSeen = document.visibilityState === "visible";
    (isSeen ? requestAnimationFrame : callback => setTimeout(callback, 16))(() => this.frame());
  },
  frame() {
    this.isScheduled = false;
    if (this.fence && !painter.isPast(this.fence)) {
      this.steps = Math.max(1, this.steps / 2);
      return this.schedule();
    }
    if (this.fence) this.steps = Math.min(FRAME_STEPS, this.steps * 2);
    const end = performance.now() + FRAME_MS;
    for (let n = 0; n < this.steps && this.jobs.size > 0 && performance.now() < end; n++) {
      let name;
      let job;
      for (const [other, candidate] of this.jobs) {
        if (!job || candidate.rank() < job.rank()) [name, job] = [other, candidate];
      }
      let isDone = true;
      try {
        isDone = job.steps.next().done;
      } catch (error) {
        complain(error);
      }
      if (isDone && this.jobs.get(name) === job) this.jobs.delete(name);
    }
    painter.forget(this.fence);
    this.fence = painter.fence();
    if (this.jobs.size > 0) this.schedule();
  },
};

/** Says in the page that something does not work. */
function complain(error) {
  const note = find("trouble");
  note.textContent = `Pictures cannot be drawn: ${error.message || error}`;
  note.hidden = false;
  console.error(error);
}
