// A program of a user, which `npm run types` checks.

import { DirectionalLight, DoubleSide, Mesh, PerspectiveCamera, Scene, SphereGeometry, WebGLRenderer } from "three";
import { LuthierEnvironmentLoader, LuthierLoader, LuthierMaterial } from "luthier-three";
import { LuthierLoader as NodeLoader, LuthierNodeMaterial } from "luthier-three/webgpu";

const scene = new Scene();
const bake = await new LuthierLoader().loadAsync("bake/manifest.json");
bake.environment = await new LuthierEnvironmentLoader().setPath("studio/").loadAsync("environment.json");
const paint: LuthierMaterial = bake.material("car-paint", { side: DoubleSide, slopeVariance: 0.0003 });
paint.slopeVariance *= 2;
scene.add(new Mesh(new SphereGeometry(), paint), new DirectionalLight("white", 3));
new WebGLRenderer().render(scene, new PerspectiveCamera());

const loader = new NodeLoader();
loader.mipmaps = false;
loader.load("bake/manifest.json", ({ names, material }) => console.log(names[0].length, material));
const nodes = await loader.loadAsync("bake/manifest.json");
const coat: LuthierNodeMaterial = nodes.material(nodes.manifest.materials[0].name);
console.log(coat.isLuthierNodeMaterial, nodes.find("car-paint").entry.maps.length);

// @ts-expect-error A bake's material has a name.
bake.material();
// @ts-expect-error The slopes are a number.
bake.material("car-paint", { slopeVariance: "wide" });
// @ts-expect-error Materials of WebGPU are others.
const wrong: LuthierMaterial = nodes.material("car-paint");
console.log(wrong);
