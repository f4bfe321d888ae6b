// The page as a whole: addresses, keys, controls.

let painter;

/** The material of the address, or -1. */
const addressed = () => data.materials.findIndex(({ name }) => `#${name}` === decodeURIComponent(location.hash));

function open() {
  const material = addressed();
  const before = data.materials[stage.material];
  document.body.classList.toggle("one", material >= 0);
  for (const article of document.querySelectorAll("article")) article.classList.toggle("open", article.id === (data.materials[material] || {}).name);
  document.title = material < 0 ? find("title").textContent : `${data.materials[material].name} – ${find("title").textContent}`;
  stage.open(material);
  // Back among the tiles the keyboard is where it was.
  if (material < 0 && before) document.querySelector(`.tiles a[href="#${CSS.escape(before.name)}"]`).focus();
}

function redraw() {
  tiles.draw();
  stage.draw(true).catch(complain);
}

function controls() {
  document.querySelector(".controls").open = innerWidth >= 700;
  const select = find("sky");
  select.replaceChildren(...data.skies.map(({ name }, i) => new Option(name, i)));
  select.addEventListener("change", () => {
    look.sky = Number(select.value);
    look.hasLight = find("lit").checked = data.skies[look.sky].has_light;
    redraw();
  });
  find("lit").checked = look.hasLight;
  const degrees = value => Math.round((value * 180) / Math.PI);
  find("azimuth").value = degrees(look.azimuth);
  find("height").value = degrees(look.height);
  const numbers = {
    azimuth: value => (look.azimuth = (value * Math.PI) / 180),
    height: value => (look.height = (value * Math.PI) / 180),
    "sky-turn": value => (look.skyTurn = (value * Math.PI) / 180),
    exposure: value => (look.exposure = value),
  };
  for (const [id, set] of Object.entries(numbers)) {
    const output = find(`${id}-value`);
    const says = () => (output.textContent = id === "exposure" ? `${find(id).value} EV` : `${find(id).value}°`);
    says();
    find(id).addEventListener("input", event => {
      set(Number(event.target.value));
      says();
      redraw();
    });
  }
  find("lit").addEventListener("change", event => {
    look.hasLight = event.target.checked;
    redraw();
  });
  find("behind").addEventListener("change", event => {
    look.showsSky = event.target.checked;
    redraw();
  });
  find("turn").addEventListener("click", event => {
    const isOn = event.currentTarget.getAttribute("aria-pressed") !== "true";
    event.currentTarget.setAttribute("aria-pressed", isOn);
    tiles.turn(isOn);
  });
  find("filter").addEventListener("input", event => {
    const text = event.target.value.trim().toLowerCase();
    for (const tile of tiles.all) tile.element.hidden = !data.materials[tile.material].name.toLowerCase().includes(text);
  });
  addEventListener("keydown", event => {
    if (event.key === "Escape" && addressed() >= 0) location.hash = "";
  });
}

/** Articles have the pictures of their tiles while they are printed; those that the filter hides are left out. */
function printing() {
  addEventListener("beforeprint", () => {
    for (const { material, element, canvas } of tiles.all) {
      const article = document.getElementById(data.materials[material].name);
      const copy = canvas.cloneNode();
      copy.className = "printed";
      copy.getContext("2d").drawImage(canvas, 0, 0);
      article.querySelector(".place").prepend(copy);
      article.classList.toggle("left-out", element.hidden);
    }
  });
  addEventListener("afterprint", () => {
    for (const copy of document.querySelectorAll(".printed")) copy.remove();
  });
}

try {
  document.documentElement.classList.add("live");
  painter = new Painter();
  painter.black4 = { texture: painter.black };
  controls();
  tiles.start();
  stage.start();
  printing();
  addEventListener("hashchange", open);
  open();
} catch (error) {
  document.documentElement.classList.remove("live");
  complain(error);
}

/** For scripts: pixels of a picture of a material by name, RGBA from the top left, as the page shows it. */
globalThis.luthierPicture = async (name, { size = 128, samples = 4, look: number = 0, form = "baked", way, slopes, live, directions = 64 } = {}) => {
  const material = data.materials.findIndex(item => item.name === name);
  const picture = pictureOf(material, { look: number, form }, { camera: camera(0, 0), way, slopes, live });
  const loaded = await painter.ready(picture);
  const sums = painter.sums(size);
  for (const pass of passes(picture.way, samples, directions, STAGE_TOGETHER)) painter.pass(sums, picture, loaded, pass);
  painter.draw(sums, painter.black4, { scales: [1 / (samples * samples), 0], exposure: look.exposure });
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const context = canvas.getContext("2d");
  context.drawImage(painter.canvas, 0, 0);
  painter.free(sums);
  return context.getImageData(0, 0, size, size).data;
};
