// One material large, or two pictures of it side by side and apart.

const STAGE_SAMPLES = 4;
/** Pictures that draw directions: these are many, and drivers without a GPU are slow. */
const DRAWN_SAMPLES = () => (work.steps >= FRAME_STEPS / 2 ? 4 : 2);
const STAGE_DIRECTIONS = 16;
/** Directions of one pass: drivers end passes that take seconds. */
const STAGE_TOGETHER = 8;
const MOST_PIXELS = 640;
const MOST_DRAWN_PIXELS = 384;
const KEY_STEP = Math.PI / 24;
const HIGHEST = 1.5;

const stage = {
  material: -1,
  choices: [],
  azimuth: 0,
  height: 0,
  split: 0.5,
  /** Factor on all slope parameters. */
  slopes: 1,
  /** Numbers of the sliders of live numbers, by the number of a look. */
  live: {},
  sides: [],
  version: 0,

  start() {
    this.canvas = find("picture");
    this.context = this.canvas.getContext("2d");
    for (const id of ["a", "b", "mode", "gain"]) find(id).addEventListener("change", () => this.changed());
    find("split").addEventListener("input", event => {
      this.split = event.target.value / 100;
      this.show();
    });
    find("slopes").addEventListener("input", () => {
      this.sayRoughness();
      this.draw(true).catch(complain);
    });
    find("reset").addEventListener("click", () => this.turnTo(0, 0));
    this.drag();
  },

  /** Opens a material, or none. */
  open(material) {
    if (material === this.material) return;
    this.material = material;
    this.version++;
    work.drop("stage");
    if (material < 0) return;
    const { name, looks, simulated } = data.materials[material];
    this.choices = looks.flatMap((item, look) => [
      { look, form: "baked", label: `${item.model}, tables`, facts: item },
      ...(data.sets[item.set].full ? [{ look, form: "full", label: `${item.model}, no tables`, facts: item }] : []),
    ]);
    if (simulated) this.choices.push({ isSimulated: true, label: `simulated, ${simulated.samples} samples`, facts: {} });
    for (const [id, chosen] of [["a", 0], ["b", simulated ? this.choices.length - 1 : Math.min(1, this.choices.length - 1)]]) {
      const options = this.choices.map(({ label }, i) => new Option(label, i, i === chosen, i === chosen));
      find(id).replaceChildren(...options);
    }
    find("mode").value = "single";
    find("slopes").value = 0;
    this.live = {};
    document.getElementById(name).querySelector(".place").append(find("stage"));
    find("stage").hidden = false;
    this.canvas.setAttribute("aria-label", `Picture of ${name}. Arrow keys turn it.`);
    this.azimuth = this.height = 0;
    this.split = find("split").value / 100;
    this.changed();
  },

  get mode() {
    return find("mode").value;
  },

  chosen() {
    const ids = this.mode === "single" ? ["a"] : ["a", "b"];
    return ids.map(id => this.choices[find(id).value]);
  },

  /** The simulated picture has one view and one light. */
  isFixed() {
    return this.chosen().some(choice => choice.isSimulated);
  },

  changed() {
    const isPair = this.mode !== "single";
    const isFixed = this.isFixed();
    find("of-b").hidden = !isPair;
    find("of-split").hidden = this.mode !== "slider";
    find("of-gain").hidden = this.mode !== "difference";
    find("fixed").hidden = !isFixed;
    this.offerRoughness();
    this.offerLive();
    this.compareFacts();
    this.draw().catch(complain);
  },

  /** Offers factors on the slopes that all chosen looks follow, or says why one of them follows none. */
  offerRoughness() {
    const follows = this.chosen().map(choice => (choice.isSimulated ? { fixed: "The simulated picture has one roughness." } : choice.facts.slopes));
    const { fixed } = follows.find(item => item.fixed) || {};
    const input = find("slopes");
    input.disabled = Boolean(fixed);
    input.max = fixed ? 2 : Math.min(...follows.map(item => item.octaves));
    if (fixed) input.value = 0;
    for (const element of [input, find("of-slopes")]) element.title = fixed || "A factor on the slopes of all interfaces, 1 as the material has them";
    this.sayRoughness();
  },

  /** Sliders of the live numbers of the looks that are shown, each look once. */
  offerLive() {
    const box = find("live");
    const looks = new Set(this.chosen().filter(choice => !choice.isSimulated && choice.facts.live).map(choice => choice.look));
    const legend = box.querySelector("legend");
    const labels = [...looks].flatMap(number => {
      const { model, live } = data.materials[this.material].looks[number];
      this.live[number] ||= live.sliders.map(({ value }) => value);
      return live.sliders.map((slider, i) => this.liveSlider(number, slider, i, looks.size > 1 ? `${model}, ` : ""));
    });
    box.replaceChildren(legend, ...labels);
    box.hidden = labels.length === 0;
  },

  liveSlider(number, { label, member, least, most }, i, before) {
    const element = document.createElement("label");
    const input = Object.assign(document.createElement("input"), { type: "range", min: least, max: most, step: "any", title: member });
    input.value = this.live[number][i];
    const output = document.createElement("output");
    const says = () => {
      output.textContent = Number(input.value).toPrecision(3);
      input.setAttribute("aria-valuetext", output.textContent);
    };
    says();
    input.addEventListener("input", () => {
      this.live[number][i] = Number(input.value);
      says();
      this.draw(true).catch(complain);
    });
    element.append(`${before}${label} `, input, output);
    return element;
  },

  sayRoughness() {
    const input = find("slopes");
    this.slopes = 2 ** input.value;
    find("slopes-value").textContent = input.disabled ? "fixed" : `× ${this.slopes.toFixed(2)}`;
    input.setAttribute("aria-valuetext", input.disabled ? input.title : `${this.slopes.toFixed(2)} times the slopes`);
  },

  turnTo(azimuth, height) {
    this.azimuth = azimuth;
    this.height = Math.max(-HIGHEST, Math.min(HIGHEST, height));
    this.draw(true).catch(complain);
  },

  /** Draws anew. While it moves, with few samples first. */
  async draw(isMoving = false) {
    if (this.material < 0) return;
    const version = ++this.version;
    const chosen = this.chosen();
    const isPair = chosen.length > 1;
    const { simulated } = data.materials[this.material];
    const isFixed = this.isFixed();
    const shown = Math.round(this.canvas.clientWidth * Math.min(devicePixelRatio, 2)) || 480;
    const size = isFixed ? simulated.size : shown;
    const fixed = { ...look, sky: 0, skyTurn: 0, showsSky: false, hasLight: true, ...defaultLight };
    const at = isFixed ? camera(0, 0) : camera(this.azimuth, this.height);
    // Two pictures are made alike, by the shaders alone.
    const way = isPair ? "drawn" : undefined;
    const sides = await Promise.all(
      chosen.map(async choice => {
        if (choice.isSimulated) return { fixed: await painter.simulated(this.material), scale: 1 };
        const picture = pictureOf(this.material, choice, { camera: at, way, given: isFixed ? fixed : look, slopes: this.slopes, live: this.live[choice.look] });
        return { picture, loaded: await painter.ready(picture), scale: 0 };
      })
    );
    if (version !== this.version) return;
    const isDrawn = sides.some(side => side.picture && side.picture.way === "drawn");
    const samples = isDrawn ? DRAWN_SAMPLES() : STAGE_SAMPLES;
    this.resize(isFixed ? size : Math.min(size, isDrawn ? MOST_DRAWN_PIXELS : MOST_PIXELS), sides);
    const together = isMoving ? 4 : STAGE_TOGETHER;
    const plans = sides.map(side => side.picture && passes(side.picture.way, samples, STAGE_DIRECTIONS, together));
    const steps = function* () {
      for (let left = true; left; ) {
        left = false;
        for (const [i, plan] of plans.entries()) {
          if (!plan) continue;
          // Of one sample all directions, then the other side.
          for (let done = 0; !done; ) {
            const next = plan.next();
            if (next.done) break;
            left = true;
            const { sums, picture, loaded } = sides[i];
            painter.pass(sums, picture, loaded, next.value);
            done = next.value.done;
            if (done) sides[i].scale = 1 / done;
            yield;
          }
        }
        stage.show();
      }
      stage.finish();
    };
    this.sides = sides;
    find("apart").textContent = "";
    work.put("stage", () => 0, steps());
  },

  resize(size, sides) {
    if (!this.kept || this.kept[0].size !== size) {
      if (this.kept) this.kept.forEach(sums => painter.free(sums));
      this.kept = [painter.sums(size), painter.sums(size)];
      this.canvas.width = this.canvas.height = size;
    }
    sides.forEach((side, i) => {
      side.sums = side.fixed || this.kept[i];
      if (side.picture) side.sums.passes = 0;
    });
  },

  show() {
    const [a, b = a] = this.sides;
    if (!a || !a.scale || !b.scale) return;
    const mode = ["single", "slider", "difference"].indexOf(this.mode);
    const gain = Number(find("gain").value);
    painter.draw(a.sums, b.sums, { scales: [a.scale, b.scale], exposure: look.exposure, mode, split: this.split, gain });
    this.context.drawImage(painter.canvas, 0, 0);
  },

  /** Says how far two pictures are apart, as `luthier compare` does. */
  finish() {
    performance.mark("luthier-stage");
    if (this.sides.length < 2) return;
    const [a, b] = this.sides.map(side => painter.values(side.sums, side.scale));
    let [sum, most] = [0, 0];
    for (let i = 0; i < a.length; i++) {
      if (i % 4 === 3) continue;
      const apart = Math.abs(a[i] - b[i]);
      sum += apart * apart;
      most = Math.max(most, apart);
    }
    const rms = Math.sqrt(sum / (0.75 * a.length));
    find("apart").textContent = `Root mean square difference ${rms.toExponential(2)}, largest ${most.toExponential(2)}, in linear radiance.`;
  },

  /** What each side costs, takes and misses. */
  compareFacts() {
    const chosen = this.chosen();
    const rows = [
      ["", choice => choice.label],
      ["Cycles, RDNA2", ({ facts, form }) => (facts.cycles && facts.cycles[form]) || "–"],
      ["Bytes of tables", ({ facts, form }) => (form === "baked" ? facts.bytes : form === "full" ? "0 B" : "–")],
      ["Error of tables", ({ facts, form }) => (form === "baked" && facts.table_error) || "–"],
      ["Error of lobes", ({ facts, form }) => (form === "baked" && facts.lobe_error) || "–"],
    ];
    const table = find("facts");
    table.hidden = chosen.length < 2;
    const cell = (kind, text) => Object.assign(document.createElement(kind), { textContent: text });
    const lines = rows.map(([title, value], i) => {
      const line = document.createElement("tr");
      line.append(cell("th", title), ...chosen.map(choice => cell(i ? "td" : "th", value(choice))));
      return line;
    });
    // A row without any number says nothing.
    const says = line => [...line.cells].slice(1).some(item => item.textContent !== "–");
    table.replaceChildren(...lines.filter(says));
  },

  drag() {
    const { canvas } = this;
    let from = null;
    canvas.addEventListener("pointerdown", event => {
      const box = canvas.getBoundingClientRect();
      const place = (event.clientX - box.left) / box.width;
      const isSplit = this.mode === "slider" && Math.abs(place - this.split) < 0.06;
      if (!isSplit && this.isFixed()) return;
      from = { x: event.clientX, y: event.clientY, azimuth: this.azimuth, height: this.height, isSplit, box };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", event => {
      if (!from) return;
      const { box } = from;
      if (from.isSplit) {
        this.split = Math.max(0, Math.min(1, (event.clientX - box.left) / box.width));
        find("split").value = 100 * this.split;
        return this.show();
      }
      const turn = Math.PI / box.width;
      this.turnTo(from.azimuth - (event.clientX - from.x) * turn, from.height + (event.clientY - from.y) * turn);
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (from = null));
    canvas.addEventListener("keydown", event => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!step || this.isFixed()) return;
      event.preventDefault();
      this.turnTo(this.azimuth + step[0] * KEY_STEP, this.height + step[1] * KEY_STEP);
    });
  },
};
const defaultLight = { azimuth: look.azimuth, height: look.height };
