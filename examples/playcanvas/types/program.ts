// A program of a user, which `npm run types` checks.

import { AppBase, Asset, createGraphicsDevice, Entity, Mesh, MeshInstance, SphereGeometry } from "playcanvas";
import { loadBake, loadEnvironment, LuthierBake, LuthierHandler, LuthierMaterial } from "luthier-playcanvas";

const canvas = document.createElement("canvas");
const device = await createGraphicsDevice(canvas, { deviceTypes: ["webgpu", "webgl2"] });
const app = new AppBase(canvas);
const bake = await loadBake(device, "bake/manifest.json", { mipmaps: false });
bake.environment = await loadEnvironment(device, "studio/environment.json");
const paint: LuthierMaterial = bake.material("car-paint", { slopeVariance: 0.0003 });
paint.slopeVariance *= 2;
paint.useFog = false;
const ball = new Entity("ball", app);
ball.addComponent("render", { meshInstances: [new MeshInstance(Mesh.fromGeometry(device, new SphereGeometry()), paint.clone())] });

app.loader.addHandler("luthier", new LuthierHandler(app));
const asset = new Asset("bake", "luthier", { url: "bake/manifest.json" });
asset.ready(({ resource }) => console.log((resource as LuthierBake).names[0].length));
app.assets.add(asset);
app.assets.load(asset);
console.log(bake.find("car-paint").entry.maps.length, bake.materials.size);
bake.destroy();

// @ts-expect-error A bake's material has a name.
bake.material();
// @ts-expect-error The slopes are a number.
bake.material("car-paint", { slopeVariance: "wide" });
// @ts-expect-error A bake belongs to a device.
await loadBake("bake/manifest.json");
