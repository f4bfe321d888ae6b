// A scene with a ball of a baked material, under lamps and, where it has one, in an environment.

import { FreeCamera } from "@babylonjs/core/Cameras/freeCamera.js";
import { DirectionalLight } from "@babylonjs/core/Lights/directionalLight.js";
import { HemisphericLight } from "@babylonjs/core/Lights/hemisphericLight.js";
import { PointLight } from "@babylonjs/core/Lights/pointLight.js";
import { ImageProcessingConfiguration } from "@babylonjs/core/Materials/imageProcessingConfiguration.js";
import { Color3, Color4 } from "@babylonjs/core/Maths/math.color.js";
import { Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { Scene } from "@babylonjs/core/scene.js";
import { LuthierBake, LuthierEnvironment } from "luthier-babylon";
import { ball, placed } from "./page.js";

/** The scene of a description such as `../scene.json`. Bake and environment are folders that the page can load from. */
export async function ballScene(engine, bakeFolder, description) {
  const { material, lights, background, fov_y_deg, eye_distance, slope_variance: slopeVariance, environment, tone, handed } = description;
  const scene = new Scene(engine);
  scene.useRightHandedSystem = handed === "right";
  scene.clearColor = new Color4(...background, 1);
  if (tone) {
    scene.imageProcessingConfiguration.toneMappingEnabled = true;
    scene.imageProcessingConfiguration.toneMappingType = ImageProcessingConfiguration[tone];
  }
  const camera = new FreeCamera("camera", new Vector3(...placed(scene, [0, 0, eye_distance])), scene);
  camera.setTarget(Vector3.Zero());
  camera.fov = (fov_y_deg * Math.PI) / 180;
  for (const light of lights) lamp(scene, light);
  const bake = await LuthierBake.LoadAsync(`${bakeFolder}/manifest.json`, scene);
  if (environment) bake.environment = await LuthierEnvironment.LoadAsync(`scene/${environment}`, scene);
  ball(scene).material = bake.material(material, { slopeVariance });
  return scene;
}

/** A light far away, or at a position, whose irradiance is that at the centre, or from all around with the same radiance. */
function lamp(scene, { direction, position, irradiance, radiance }) {
  if (radiance) {
    const light = new HemisphericLight("light", Vector3.Up(), scene);
    light.diffuse = light.groundColor = new Color3(...radiance);
    return;
  }
  const at = new Vector3(...placed(scene, position ?? direction));
  const light = position ? new PointLight("light", at, scene) : new DirectionalLight("light", at.scale(-1), scene);
  light.diffuse = new Color3(...irradiance);
  if (position) light.intensity = at.lengthSquared();
}
