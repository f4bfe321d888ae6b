// A car of sixty parts, to measure: five large ones, and wheels, spokes, lamps and mirrors.

/** Geometries of the large parts, by a material of `materials/textured` each, and of the 55 small ones, in metres; up is y, x is forward. */
export function car(THREE) {
  const outline = (points) => new THREE.Shape(points.map(([x, y]) => new THREE.Vector2(x, y)));
  /** What a side view encloses, with round edges. */
  const hull = (points, width) => {
    const round = { bevelEnabled: true, bevelSize: 0.06, bevelThickness: 0.06, bevelSegments: 6, curveSegments: 24, steps: 8 };
    return new THREE.ExtrudeGeometry(outline(points), { depth: width, ...round }).translate(0, 0, -width / 2);
  };
  const box = (x, y, z, at) => new THREE.BoxGeometry(x, y, z, 4, 4, 4).translate(...at);
  const large = {
    "scratched-car-paint": hull([[-2, 0.35], [2, 0.35], [2.05, 0.7], [1.2, 0.9], [-1.9, 0.95], [-2.1, 0.8]], 1.5),
    "anodised-plate": hull([[-1.7, 0.95], [0.9, 0.92], [0.2, 1.4], [-1.2, 1.42]], 1.3),
    "varnished-oak": box(2.4, 0.24, 1.72, [-0.4, 0.68, 0]),
    "worn-brass": box(4.5, 0.14, 1.5, [0, 0.36, 0]),
    "celadon-tile": box(0.06, 0.16, 0.5, [2.16, 0.55, 0]),
  };
  const small = [];
  for (const x of [-1.25, 1.3]) {
    for (const z of [-0.8, 0.8]) {
      const wheel = (geometry) => small.push(geometry.translate(x, 0.36, z));
      wheel(new THREE.TorusGeometry(0.29, 0.08, 16, 48));
      wheel(new THREE.CylinderGeometry(0.07, 0.07, 0.16, 24).rotateX(Math.PI / 2));
      for (let spoke = 0; spoke < 10; spoke++) wheel(new THREE.CapsuleGeometry(0.018, 0.19, 4, 12).translate(0, 0.15, 0).rotateZ((spoke * Math.PI) / 5));
    }
  }
  for (const z of [-0.55, 0.55]) {
    small.push(new THREE.SphereGeometry(0.13, 32, 16).translate(2.05, 0.66, z));
    small.push(new THREE.SphereGeometry(0.1, 32, 16).translate(-2.1, 0.75, z));
    small.push(new THREE.SphereGeometry(0.1, 32, 16).scale(0.6, 0.8, 1).translate(0.75, 1.02, 1.6 * z));
  }
  small.push(new THREE.CylinderGeometry(0.008, 0.008, 0.6, 12).translate(-1.4, 1.7, 0.4));
  return { large, small };
}
