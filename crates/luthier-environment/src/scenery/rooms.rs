//! Rooms: boxes about the viewer, with things on their walls. The lamps of a room light its walls.

use super::patterns::{clouds, meets, mix, noise, random, smooth};
use crate::vector::{dot, unit};

type V = [f64; 3];

/// A box-shaped room: its lower and upper corner, seen from the origin.
struct Room {
    low: V,
    high: V,
}

/// A place on a wall.
struct Place {
    at: V,
    /// Into the room.
    normal: V,
}

impl Room {
    /// The wall in a direction.
    fn wall(&self, d: V) -> Place {
        let distances =
            [0, 1, 2].map(|c: usize| if d[c] > 0.0 { self.high[c] / d[c] } else { self.low[c] / d[c].min(-1e-12) });
        let nearest = (1..3).fold(0, |near, c| if distances[c] < distances[near] { c } else { near });
        let mut normal = [0.0; 3];
        normal[nearest] = if d[nearest] > 0.0 { -1.0 } else { 1.0 };
        Place { at: d.map(|v| v * distances[nearest]), normal }
    }
}

/// A lamp for the walls: its place and its intensity over pi.
struct Glow {
    at: V,
    color: V,
}

fn lit(place: &Place, glows: &[Glow], ambient: V) -> V {
    glows.iter().fold(ambient, |sum, glow| {
        let to = [0, 1, 2].map(|c| glow.at[c] - place.at[c]);
        let distance_sq = dot(to, to).max(0.05);
        let cosine = dot(unit(to), place.normal).max(0.0);
        [0, 1, 2].map(|c| sum[c] + glow.color[c] * cosine / distance_sq)
    })
}

fn times(a: V, b: V) -> V {
    [0, 1, 2].map(|c| a[c] * b[c])
}

fn scaled(a: V, factor: f64) -> V {
    a.map(|v| v * factor)
}

/// A rectangle of cloth with a light behind: brighter in the middle, with a dark rim.
fn softbox([u, v]: [f64; 2], radiance: V) -> V {
    if u.abs().max(v.abs()) > 0.955 {
        return [0.015; 3];
    }
    // Two lamps and the seams of the cloth.
    let [left, right] = [-0.4, 0.4].map(|x| libm::exp(-2.0 * ((u - x) * (u - x) + v * v)));
    let seam = 1.0 - 0.12 * (smooth(0.02, 0.0, u.abs()) + smooth(0.02, 0.0, v.abs())).min(1.0);
    scaled(radiance, seam * (0.55 + 0.45 * (left + right).min(1.0)))
}

pub(super) fn softbox_studio(d: V) -> V {
    // Scaled so that a white patch facing the camera is nearly white.
    scaled(softboxes(d), 1.7)
}

fn softboxes(d: V) -> V {
    let room = Room { low: [-4.0, -1.0, -4.5], high: [4.0, 3.2, 4.5] };
    // Before the left wall, above; a tall narrow one on the right; a small one behind, for edges.
    let key = ([-2.3, 1.75, 1.7], [0.72, 0.15, 0.78], [-0.45, 0.78, 0.27], [7.5, 7.4, 7.1]);
    let strip = ([2.6, 0.75, 0.9], [-0.1, 0.0, 0.28], [0.0, 1.15, 0.0], [4.4, 4.6, 5.0]);
    let edge = ([1.6, 1.9, -2.6], [0.55, 0.0, 0.3], [0.1, 0.35, -0.2], [6.0, 6.0, 6.2]);
    for (middle, along, across, radiance) in [key, strip, edge] {
        if let Some(at) = meets(d, middle, along, across) {
            return softbox(at, radiance);
        }
        // The stand below.
        let foot = [middle[0], 0.5 * (middle[1] - 1.0) - 0.2, middle[2]];
        let side = unit([middle[2], 0.0, -middle[0]]);
        if meets(d, foot, scaled(side, 0.018), [0.0, 0.5 * (middle[1] + 1.0) - 0.2, 0.0]).is_some() {
            return [0.012; 3];
        }
    }
    // A black flag, which puts a dark edge on bright metal.
    if meets(d, [3.0, 0.5, -1.0], [0.0, 0.0, 0.8], [0.0, 1.4, 0.0]).is_some() {
        return [0.006; 3];
    }
    let place = room.wall(d);
    let [x, y, z] = place.at;
    // Four windows of six panes in the left wall, a wall behind them that the sky lights.
    if place.normal[0] == 1.0 && (0.1..2.4).contains(&y) && z < 1.9 {
        let across = [(z + 10.0) / 1.5, (y - 0.1) / 1.15];
        let [u, v] = across.map(|w| w - w.floor());
        let pane = [3.0 * u, 2.0 * v].map(|w| (w - w.floor() - 0.5).abs());
        if (0.08..0.92).contains(&u) && pane[0] < 0.46 && pane[1] < 0.47 {
            let sky = mix([1.9, 2.1, 2.3], [1.2, 1.6, 2.4], smooth(0.6, 2.4, y));
            let houses = y < 0.75 + 0.35 * random((z * 1.3).floor() as i64, 3, 17);
            return if houses { [0.5, 0.46, 0.42] } else { sky };
        }
        return [0.55, 0.56, 0.58];
    }
    let glows = [
        Glow { at: [-2.0, 1.5, 1.4], color: [1.5, 1.48, 1.42] },
        Glow { at: [2.3, 0.8, 0.8], color: [0.7, 0.73, 0.8] },
        Glow { at: [-3.2, 1.2, -1.0], color: [0.8, 0.9, 1.05] },
    ];
    let light = lit(&place, &glows, [0.1, 0.1, 0.103]);
    let paint = match place.normal {
        // Rails and lamps under the ceiling.
        [_, -1.0, _] if (x - 0.2).abs() < 0.05 || (x + 1.7).abs() < 0.05 => [0.05; 3],
        [_, -1.0, _] => [0.7, 0.7, 0.7],
        [_, 1.0, _] => scaled([0.34, 0.335, 0.33], 0.9 + 0.2 * clouds(d, 6.0)),
        // A roll of paper behind the stage, darker wall beside it.
        [_, _, 1.0] if x.abs() < 2.2 => [0.62, 0.62, 0.63],
        [_, _, -1.0] if x.abs() < 0.6 && y < 1.2 => [0.08, 0.09, 0.11],
        _ => [0.45, 0.44, 0.43],
    };
    times(light, paint)
}

pub(super) fn evening_room(d: V) -> V {
    let room = Room { low: [-2.6, -1.0, -3.4], high: [3.0, 1.9, 3.0] };
    // A floor lamp on the left with a shade of cloth, a globe that hangs on the right, a candle.
    let lamp = unit([-1.9, 0.72, 1.3]);
    let shade = [dot(d, unit([lamp[2], 0.0, -lamp[0]])), d[1] - lamp[1] * (dot(d, lamp)).max(0.0)];
    let rises = (shade[1] / 0.15).clamp(-1.0, 1.0);
    if dot(d, lamp) > 0.9 && shade[1].abs() < 0.15 && shade[0].abs() < 0.16 - 0.05 * rises {
        let glow = 0.6 + 0.8 * libm::exp(-60.0 * (shade[0] * shade[0] + (shade[1] + 0.04) * (shade[1] + 0.04)));
        let fold = 0.92 + 0.08 * libm::cos(180.0 * shade[0]);
        return scaled([11.0, 7.4, 3.9], glow * fold);
    }
    if dot(d, lamp) > 0.8 && shade[0].abs() < 0.008 && shade[1] < 0.0 && d[1] > -0.42 {
        return [0.03, 0.02, 0.012];
    }
    let globe = dot(d, unit([1.3, 1.0, 1.7]));
    if globe > 0.9952 {
        return scaled([16.0, 13.2, 9.4], 0.7 + 0.3 * smooth(0.9952, 0.9995, globe));
    }
    if dot(d, unit([0.55, -0.18, 2.2])) > 0.99993 {
        return [60.0, 34.0, 12.0];
    }
    let place = room.wall(d);
    let [x, y, z] = place.at;
    let glows = [
        Glow { at: [-1.9, 0.75, 1.3], color: [1.05, 0.68, 0.36] },
        Glow { at: [1.3, 1.0, 1.7], color: [0.62, 0.5, 0.34] },
        Glow { at: [2.6, 0.5, -0.6], color: [0.07, 0.1, 0.18] },
    ];
    let light = lit(&place, &glows, [0.045, 0.034, 0.026]);
    let paint = match place.normal {
        // The window on the right: dusk over roofs, with curtains beside it.
        [-1.0, ..] if (-1.7..0.7).contains(&z) && (-0.35..1.45).contains(&y) => {
            let cross = (z + 0.5).abs() < 0.03
                || (y - 0.75).abs() < 0.025
                || !(-0.3..=1.4).contains(&y)
                || !(-1.65..0.65).contains(&z);
            if cross {
                [0.6, 0.57, 0.52]
            } else {
                let roofs = 0.05 + 0.3 * random((3.0 * z).floor() as i64, 1, 5);
                if y < roofs {
                    let is_lit = random((14.0 * z).floor() as i64, (10.0 * y).floor() as i64, 9) > 0.86;
                    return if is_lit { [1.6, 1.0, 0.4] } else { [0.02, 0.02, 0.03] };
                }
                return mix([1.7, 0.75, 0.4], [0.22, 0.42, 0.95], smooth(roofs, 1.2, y));
            }
        }
        [-1.0, ..] if (-2.3..1.3).contains(&z) && y < 1.6 => {
            scaled([0.42, 0.1, 0.08], 0.6 + 0.4 * libm::cos(42.0 * z) + 0.1 * libm::cos(91.0 * z))
        }
        // Shelves of books behind: five boards, books of their own width, height and colour.
        [_, _, 1.0] if x.abs() < 1.9 && y < 1.5 => books([x, y]),
        // Pictures in front.
        [_, _, -1.0] if (0.1..1.1).contains(&y) && (x + 0.8).abs() < 0.6 => picture([(x + 0.8) / 0.6, (y - 0.6) / 0.5]),
        [_, _, -1.0] if y < 0.0 && x > 0.2 => [0.16, 0.09, 0.05],
        // Boards of oak.
        [_, 1.0, _] => {
            let board = (x / 0.22).floor();
            let along = z / 1.3 + random(board as i64, 2, 41);
            let gap = (x / 0.22 - board - 0.5).abs() > 0.475;
            let grain = noise([40.0 * x, 3.0 * z, board]);
            let tone = 0.55 + 0.45 * random(board as i64, along.floor() as i64, 43);
            if gap { [0.04, 0.025, 0.015] } else { scaled([0.42, 0.25, 0.13], tone * (0.75 + 0.4 * grain)) }
        }
        [_, -1.0, _] => [0.75, 0.73, 0.68],
        _ => scaled([0.58, 0.5, 0.38], 0.95 + 0.1 * clouds(d, 9.0)),
    };
    times(light, paint)
}

fn books([x, y]: [f64; 2]) -> V {
    let board = (y + 1.0) / 0.42;
    let (row, above) = (board.floor(), board - board.floor());
    if above < 0.07 || (x.abs() - 1.9).abs() < 0.05 || x.abs() < 0.025 {
        return [0.2, 0.11, 0.055];
    }
    let place = x / 0.055 + 0.35 * libm::sin(7.0 * x + row);
    let book = place.floor() as i64;
    let [height, hue, tone] = [1, 2, 3].map(|k| random(book, row as i64, 100 + k));
    if above > 0.62 + 0.3 * height || hue > 0.95 {
        return [0.035, 0.022, 0.014];
    }
    let spine = (place - place.floor() - 0.5).abs();
    let cloth = mix(
        mix([0.5, 0.07, 0.05], [0.06, 0.16, 0.34], smooth(0.2, 0.5, hue)),
        [0.62, 0.55, 0.4],
        smooth(0.6, 0.8, hue),
    );
    let label = (0.35..0.42).contains(&above) && spine < 0.32;
    if label { [0.75, 0.62, 0.25] } else { scaled(cloth, (0.35 + 0.65 * tone) * (1.0 - 1.2 * spine * spine)) }
}

fn picture([u, v]: [f64; 2]) -> V {
    if u.abs().max(v.abs()) > 0.9 {
        return [0.5, 0.36, 0.14];
    }
    if u.abs().max(v.abs()) > 0.72 {
        return [0.8, 0.78, 0.72];
    }
    let hill = -0.15 + 0.25 * noise([3.0 * u + 9.0, 1.0, 1.0]);
    if v < hill { [0.12, 0.2, 0.09] } else { mix([0.7, 0.6, 0.45], [0.25, 0.4, 0.6], smooth(hill, 0.7, v)) }
}
