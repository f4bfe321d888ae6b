// A program of a user, which `npm run types` checks.

import { FreeCamera } from "@babylonjs/core/Cameras/freeCamera.js";
import { Engine } from "@babylonjs/core/Engines/engine.js";
import { DirectionalLight } from "@babylonjs/core/Lights/directionalLight.js";
import { Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { CreateSphere } from "@babylonjs/core/Meshes/Builders/sphereBuilder.js";
import { Scene } from "@babylonjs/core/scene.js";
import { LuthierBake, LuthierEnvironment, LuthierMaterial } from "luthier-babylon";

const scene = new Scene(new Engine(document.querySelector("canvas")));
new FreeCamera("camera", new Vector3(0, 0, -5), scene);
new DirectionalLight("sun", new Vector3(-1, -2, 1), scene).intensity = 3;
const bake = await LuthierBake.LoadAsync("bake/manifest.json", scene, { mipmaps: false });
bake.environment = await LuthierEnvironment.LoadAsync("studio/environment.json", scene);
const paint: LuthierMaterial = bake.material("car-paint", { slopeVariance: 0.0003 });
paint.slopeVariance *= 2;
paint.useGLTFLightFalloff = true;
CreateSphere("ball", {}, scene).material = paint.clone("another");
console.log(bake.names[0].length, bake.find("car-paint").entry.maps.length, bake.manifest.schema);

// @ts-expect-error A bake's material has a name.
bake.material();
// @ts-expect-error The slopes are a number.
bake.material("car-paint", { slopeVariance: "wide" });
// @ts-expect-error A bake is of a scene.
LuthierBake.LoadAsync("bake/manifest.json");
