// Exact furnace values by quadrature: an oracle that shares no code with luthier.

/** Nodes over the polar angle, and over half the azimuth: within 5e-5 of twice as many, for cosines from 0.05 on. */
const NODES = 96;

/** Steps over the polar angle that look for the horizon, which it may cross more than once. */
const SCAN = 64;

/** Bisections that find the horizon. */
const STEPS = 48;

/**
 * Split sum of GGX with Smith's masking correlated by height, under Schlick's Fresnel: {albedo, bias}, albedo = scale + bias.
 * Half vectors are those that the view sees (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"), so that the
 * integrand is G2/G1 at any roughness. Gauss-Legendre over the polar angle of the cap, as far as the reflected direction is above the
 * horizon, and midpoints over its azimuth.
 */
export function splitSum(cos, alpha, nodes = NODES) {
  const { gauss, phis } = grid(nodes);
  const sin = Math.sqrt(Math.max(0, 1 - cos * cos));
  const length = Math.hypot(alpha * sin, cos);
  const [vx, vz] = [(alpha * sin) / length, cos / length];
  const lambda = (c) => (Math.sqrt(1 + (alpha * alpha * (1 - c * c)) / (c * c)) - 1) / 2;
  const seen = lambda(cos);
  // Cosines of the view against the half vector and of the light against the normal.
  const reflect = (theta, cosPhi) => {
    const s = Math.sin(theta);
    const x = alpha * (s * cosPhi + vx);
    const z = Math.cos(theta) + vz;
    const norm = Math.sqrt(x * x + z * z + alpha * alpha * s * s * (1 - cosPhi * cosPhi));
    const dot = (sin * x + cos * z) / norm;
    return [dot, (2 * dot * z) / norm - cos];
  };
  let [albedo, bias] = [0, 0];
  for (const phi of phis) {
    const cosPhi = Math.cos(phi);
    const above = (theta) => reflect(theta, cosPhi)[1] > 0;
    for (const [from, to] of intervals(above, Math.acos(-vz))) {
      for (const [node, weight] of gauss) {
        const theta = from + node * (to - from);
        const [dot, out] = reflect(theta, cosPhi);
        if (out <= 0) continue;
        const measure = (weight * (to - from) * Math.sin(theta)) / ((1 + vz) * phis.length);
        const value = (measure * (1 + seen)) / (1 + seen + lambda(Math.min(out, 1)));
        albedo += value;
        bias += value * (1 - dot) ** 5;
      }
    }
  }
  return { albedo, bias };
}

/** Albedo of Charlie's distribution with Ashikhmin's visibility, which Babylon.js reads in the blue channel. */
export function sheen(cos, alpha, nodes = NODES) {
  const { gauss, phis } = grid(nodes);
  const sin = Math.sqrt(Math.max(0, 1 - cos * cos));
  let sum = 0;
  for (const [node, weight] of gauss) {
    const theta = (node * Math.PI) / 2;
    const [ls, lc] = [Math.sin(theta), Math.cos(theta)];
    for (const phi of phis) {
      const [x, y, z] = [sin + ls * Math.cos(phi), ls * Math.sin(phi), cos + lc];
      const sinSq = (x * x + y * y) / (x * x + y * y + z * z);
      const d = ((2 + 1 / alpha) * sinSq ** (0.5 / alpha)) / (2 * Math.PI);
      const v = 1 / (4 * (lc + cos - lc * cos));
      // Both halves of the azimuth.
      sum += weight * (Math.PI / 2) * ls * ((2 * Math.PI) / phis.length) * d * v * lc;
    }
  }
  return sum;
}

/** Parts of 0..last where a condition holds. */
function intervals(holds, last) {
  const found = [];
  let from = 0;
  let before = holds(0);
  for (let i = 1; i <= SCAN; i++) {
    const now = holds((last * i) / SCAN);
    if (now !== before) {
      let [low, high] = [(last * (i - 1)) / SCAN, (last * i) / SCAN];
      for (let step = 0; step < STEPS; step++) {
        const middle = (low + high) / 2;
        if (holds(middle) === before) low = middle;
        else high = middle;
      }
      if (before) found.push([from, low]);
      from = low;
      before = now;
    }
  }
  if (before) found.push([from, last]);
  return found;
}

const grids = new Map();

/** Nodes of both integrals: Gauss-Legendre over 0..1, midpoints over half the azimuth. */
function grid(nodes) {
  if (!grids.has(nodes)) {
    grids.set(nodes, { gauss: gaussLegendre(nodes), phis: Array.from({ length: nodes }, (_, i) => ((i + 0.5) / nodes) * Math.PI) });
  }
  return grids.get(nodes);
}

/** Nodes and weights of Gauss and Legendre over 0..1. */
function gaussLegendre(n) {
  return Array.from({ length: n }, (_, i) => {
    let x = Math.cos((Math.PI * (i + 0.75)) / (n + 0.5));
    let slope = 0;
    for (let step = 0; step < 50; step++) {
      let [p, before] = [1, 0];
      for (let k = 1; k <= n; k++) [p, before] = [((2 * k - 1) * x * p - (k - 1) * before) / k, p];
      slope = (n * (x * p - before)) / (x * x - 1);
      const move = p / slope;
      x -= move;
      if (Math.abs(move) < 1e-15) break;
    }
    return [(x + 1) / 2, 1 / ((1 - x * x) * slope * slope)];
  });
}
