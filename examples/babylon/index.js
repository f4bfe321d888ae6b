// The ball of scene.json.

import { ballScene } from "./ball.js";
import { driver, open, run, show } from "./page.js";

run(async ({ renderer, size, ...description }) => {
  const engine = await open(renderer, size);
  const scene = await ballScene(engine, "bake", description);
  return { picture: await show(scene, size), driver: driver(engine) };
});
