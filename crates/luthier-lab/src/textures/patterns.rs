//! The maps of the textured materials: functions over the unit square.

use super::noise::{Line, Noise, mix, step, unit};

/// A colour in linear Rec.709, or one number three times.
pub(super) type Texel = [f64; 3];

fn blend(a: Texel, b: Texel, t: f64) -> Texel {
    [0, 1, 2].map(|c: usize| mix(a[c], b[c], t))
}

fn scaled(a: Texel, factor: f64) -> Texel {
    a.map(|value| value * factor)
}

/// Oak, sawn plain: growth rings across u that wander along v, and pores where the wood of the spring is.
struct Oak {
    /// Share of the dense wood of the summer.
    summer: f64,
    /// Share of pores.
    pore: f64,
    /// Slow changes of the colour.
    shade: f64,
}

fn oak(place: [f64; 2]) -> Oak {
    let bent = Noise { seed: 11, cells: [2, 1], octaves: 3 }.at(place);
    let rings = 7.0 * place[0] + 1.3 * bent;
    // Rings have unlike widths: the phase runs unevenly.
    let phase = rings + 0.35 * Noise { seed: 12, cells: [7, 1], octaves: 1 }.at(place);
    let at = phase - phase.floor();
    let summer = step(0.25, 0.9, at) * (1.0 - step(0.94, 1.0, at));
    let fibre = Noise { seed: 13, cells: [64, 4], octaves: 1 }.at(place);
    let pore = step(0.28, 0.5, fibre) * (1.0 - 0.8 * summer);
    Oak { summer, pore, shade: Noise { seed: 14, cells: [3, 2], octaves: 2 }.at(place) }
}

pub(super) fn oak_color(place: [f64; 2]) -> Texel {
    let Oak { summer, pore, shade } = oak(place);
    let wood = blend([0.38, 0.205, 0.085], [0.20, 0.085, 0.028], 0.85 * summer);
    scaled(blend(wood, [0.08, 0.032, 0.012], 0.75 * pore), 1.0 + 0.18 * shade)
}

/// Open pores are rougher than planed wood.
pub(super) fn oak_alpha(place: [f64; 2]) -> Texel {
    let Oak { summer, pore, .. } = oak(place);
    [mix(0.62 - 0.12 * summer, 1.0, pore); 3]
}

/// Brass whose lacquer has come off in places, where it has tarnished.
struct Brass {
    /// Share of the lacquer.
    lacquer: f64,
    /// Share of tarnish.
    tarnish: f64,
    /// Fine scratches of use.
    fine: f64,
}

fn brass(place: [f64; 2]) -> Brass {
    let wear = Noise { seed: 21, cells: [3, 3], octaves: 5 }.at(place);
    let creep = Noise { seed: 22, cells: [12, 12], octaves: 2 }.at(place);
    let fine = Noise { seed: 23, cells: [4, 48], octaves: 1 }.at(place);
    Brass {
        lacquer: 1.0 - step(0.055, 0.075, wear + 0.02 * creep),
        // Air reaches under the edge of the lacquer.
        tarnish: step(0.02, 0.24, wear + 0.10 * creep),
        fine,
    }
}

pub(super) fn brass_color(place: [f64; 2]) -> Texel {
    let Brass { tarnish, fine, .. } = brass(place);
    let dull = blend([0.90, 0.68, 0.35], [0.55, 0.33, 0.16], step(0.0, 0.6, tarnish));
    scaled(blend(dull, [0.10, 0.055, 0.035], step(0.55, 1.0, tarnish)), 1.0 + 0.08 * fine * tarnish)
}

pub(super) fn brass_metal(place: [f64; 2]) -> Texel {
    [1.0 - 0.85 * step(0.45, 1.0, brass(place).tarnish); 3]
}

pub(super) fn brass_alpha(place: [f64; 2]) -> Texel {
    let Brass { tarnish, fine, .. } = brass(place);
    [(mix(0.30, 0.95, step(0.1, 0.9, tarnish)) + 0.10 * fine).clamp(0.0, 1.0); 3]
}

pub(super) fn brass_lacquer(place: [f64; 2]) -> Texel {
    [brass(place).lacquer; 3]
}

/// Scratches of washing: thin lines in all directions, few of them deep.
pub(super) struct Scratches(Vec<Line>);

impl Scratches {
    pub(super) fn new() -> Self {
        Self((0..150).map(|n| Line::random(31, n, [0.03, 0.45])).collect())
    }

    /// Slope parameter over that of the deepest scratch: polished between them.
    pub(super) fn alpha(&self, place: [f64; 2]) -> Texel {
        let width = 0.9 / 256.0;
        let deepest =
            self.0.iter().map(|line| line.depth * (1.0 - step(0.4 * width, 1.5 * width, line.distance(place))));
        [mix(0.05, 1.0, deepest.fold(0.0, f64::max)); 3]
    }
}

/// A dyed plate with a scale that a laser has bared: strokes along v at both sides of a line, every tenth longer.
pub(super) fn plate_color(place: [f64; 2]) -> Texel {
    let [x, y] = place.map(|x| x - x.floor());
    let number = (x * 20.0).floor();
    let across = ((x * 20.0 - number) - 0.5).abs() / 20.0;
    let length = match number as u32 % 20 {
        0 | 10 => 0.16,
        5 | 15 => 0.11,
        _ => 0.07,
    };
    let away = (y - 0.5).abs();
    let stroke = (1.0 - step(0.006, 0.009, across)) * (1.0 - step(length - 0.002, length + 0.002, away));
    let line = 1.0 - step(0.004, 0.007, away);
    blend([0.42, 0.025, 0.03], [0.91, 0.915, 0.92], stroke.max(line))
}

/// Strokes of the brush along u, unlike in depth.
pub(super) fn plate_roughness(place: [f64; 2]) -> Texel {
    let strokes = Noise { seed: 41, cells: [2, 96], octaves: 1 }.at(place);
    let broad = Noise { seed: 42, cells: [1, 12], octaves: 2 }.at(place);
    [(0.78 + 0.30 * strokes + 0.10 * broad).clamp(0.4, 1.0); 3]
}

/// Depth of a flower of eight petals that was carved into a tile, 0 to 1, and of the groove around it.
fn carved([u, v]: [f64; 2]) -> f64 {
    let [x, y] = [u, v].map(|x| x - x.floor() - 0.5);
    let radius = libm::sqrt(x * x + y * y);
    let turn = libm::atan2(y, x);
    let petal = 0.29 + 0.10 * libm::cos(8.0 * turn);
    // A carved stroke is steep outside and runs out inside.
    let rim = (1.0 - step(0.0, 0.012, radius - petal)) * step(petal - 0.10, petal, radius);
    let core = (1.0 - step(0.0, 0.010, radius - 0.085)) * step(0.03, 0.085, radius);
    let vein = (1.0 - step(0.0, 0.012, (libm::sin(4.0 * turn) * radius / 4.0).abs())) * step(0.10, 0.13, radius);
    let vein = vein * (1.0 - step(petal - 0.07, petal - 0.03, radius)) * 0.6;
    let border = 0.5 - x.abs().max(y.abs());
    let groove = step(0.035, 0.045, border) * (1.0 - step(0.045, 0.075, border));
    rim.max(core).max(vein).max(groove)
}

/// Thickness of the glaze over the greatest: it fills what was carved, and is thin at the edge of the tile.
pub(super) fn glaze_thickness(place: [f64; 2]) -> Texel {
    let [x, y] = place.map(|x| x - x.floor() - 0.5);
    let border = 0.5 - x.abs().max(y.abs());
    let even = 0.34 + 0.05 * Noise { seed: 51, cells: [3, 3], octaves: 2 }.at(place);
    let glaze = mix(even, 1.0, carved(place));
    [glaze * mix(0.15, 1.0, step(0.0, 0.03, border)); 3]
}

/// Stoneware with specks of iron, browner where it was bare to the fire at the edge.
pub(super) fn stone_albedo(place: [f64; 2]) -> Texel {
    let [x, y] = place.map(|x| x - x.floor());
    let border = 0.5 - (x - 0.5).abs().max((y - 0.5).abs());
    let cloud = Noise { seed: 52, cells: [4, 4], octaves: 3 }.at(place);
    let clay = scaled([0.66, 0.62, 0.54], 1.0 + 0.06 * cloud);
    let fired = blend([0.40, 0.22, 0.12], clay, step(0.0, 0.03, border));
    let squares = 24;
    let mut speck: f64 = 0.0;
    // A speck in every fourth square, which may reach into its neighbours.
    let [column, row] = [x, y].map(|x| (x * f64::from(squares)).floor() as i64);
    for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
        let square = [column + i, row + j].map(|c| c.rem_euclid(i64::from(squares)) as u32);
        let number = |index: u32| unit(53 + index, square);
        if number(0) > 0.25 {
            continue;
        }
        let away = [(x, column + i, 1), (y, row + j, 2)]
            .map(|(x, c, index)| x * f64::from(squares) - c as f64 - number(index));
        let distance = libm::sqrt(away[0] * away[0] + away[1] * away[1]);
        let size = 0.10 + 0.22 * number(3) * number(3);
        speck = speck.max(1.0 - step(0.6 * size, size, distance));
    }
    blend(fired, [0.09, 0.045, 0.02], 0.85 * speck)
}
