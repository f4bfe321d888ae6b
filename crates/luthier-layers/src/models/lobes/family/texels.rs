//! Rows of a family as parts of four numbers, as tables have them.

use luthier_optics::Rgb;

use super::Family;
use crate::models::lobes::{BaseLight, Lobe, Row};

impl Family {
    /// Number of parts of a row from part 0 on: with the lengths of light in a slab that absorbs or cosines of facets below a film, or with the light of a diffuse base apart, to recolour it.
    /// An edge tint, or cosines below a film and a coat, come after the lengths, whether they count or not.
    pub fn parts(self, is_tinted: bool, has_base: bool, is_filmed: bool) -> usize {
        match (self.is_metallic, is_tinted, has_base) {
            (true, _, _) if self.is_tinted || is_filmed && self.is_coated() => 6,
            (true, false, _) => 4,
            (true, true, _) => 5,
            (false, ..) if self.has_lengths => 8,
            (false, _, false) => 5,
            (false, _, true) => 7,
        }
    }

    /// Number of the first part of a row: -1 has shares above the horizon of lobes whose tails are not those of GGX.
    pub fn first_part(self) -> i32 {
        -i32::from(self.has_tail)
    }

    /// A row as parts from the first on, all that it may have; their numbers are in docs/manifest.md, Families of lobes.
    pub fn to_parts(self, row: &Row) -> Vec<[f64; 4]> {
        let lobe = |lobe: usize| row.lobes.get(lobe).copied().unwrap_or(DARK);
        let [first, second] = [lobe(0), lobe(1)];
        let base = row.base.unwrap_or_default();
        let [a, _] = base.falloff;
        // The place of the shear of one lobe has the share of the light of the other that is wide.
        let [more_wide, once_wide] = [first, second].map(|lobe| lobe.shear * lobe.tail.sqrt());
        let shares = self.has_tail.then_some([first.share, second.share, 0.0, 0.0]);
        let [x, y] = first.sharpness.map(|x| x * first.tail.sqrt());
        let [z, w] = second.sharpness.map(|x| x * second.tail.sqrt());
        let more = with(second.strength, more_wide);
        if self.is_metallic {
            let [once, pole, _] = first.strength;
            let [facet, once_length, more_length] = row.albedo_dir;
            let ([light, base_length, kept], [_, around, kept_apart]) = (base.energy, base.internal);
            let [white_light, dip, first_dip] = row.wide;
            let parts = [
                [once, pole, once_wide, first.shift],
                more,
                [x, y, z, w],
                [facet, white_light, light, a],
                [base_length, around, once_length, more_length],
                [dip, first_dip, kept, kept_apart],
            ];
            return shares.into_iter().chain(parts).collect();
        }
        let parts = [
            with(first.strength, first.shift),
            more,
            [x, y, z, w],
            with(row.albedo_dir, once_wide),
            with(row.wide, a),
            with(base.energy, base.lengths[1]),
            with(base.internal, base.lengths[2]),
            [base.lengths[0], 0.0, 0.0, 0.0],
        ];
        shares.into_iter().chain(parts).collect()
    }

    /// The row of parts from a number on, those that a table has, with lobes of a tail.
    pub fn of_parts(self, first: i32, parts: &[[f64; 4]], tail: f64) -> Row {
        let part = |number: i32| {
            let place = usize::try_from(number - first).ok();
            place.and_then(|place| parts.get(place)).copied().unwrap_or_default()
        };
        let rgb = |number: i32| -> Rgb {
            let [r, g, b, _] = part(number);
            [r, g, b]
        };
        let [x, y, z, w] = part(2).map(|sharpness| sharpness / tail.sqrt());
        let (once, more_wide) = (part(0), part(1)[3]);
        let (strength, once_wide, albedo_dir, wide, base) = if self.is_metallic {
            let [facet, wide, light, a] = part(3);
            let [base_length, around, once_length, more_length] = part(4);
            let [dip, first_dip, kept, kept_apart] = part(5);
            let base = BaseLight {
                energy: [light, base_length, kept],
                internal: [0.0, around, kept_apart],
                falloff: [a, 0.0],
                ..BaseLight::default()
            };
            let albedo_dir = [facet, once_length, more_length];
            ([once[0], once[1], 0.0], once[2], albedo_dir, [wide, dip, first_dip], base)
        } else {
            let (falloff, lengths) = ([part(4)[3], 0.0], [part(7)[0], part(5)[3], part(6)[3]]);
            let base = BaseLight { energy: rgb(5), internal: rgb(6), falloff, lengths, ..BaseLight::default() };
            (rgb(0), part(3)[3], rgb(3), rgb(4), base)
        };
        let [first_share, second_share, ..] = if self.has_tail { part(-1) } else { [1.0; 4] };
        let lobe = |strength, share, shift, sharpness, wide: f64| Lobe {
            strength,
            share,
            shift,
            sharpness,
            shear: wide / tail.sqrt(),
            tail,
        };
        let lobes = vec![
            lobe(strength, first_share, once[3], [x, y], more_wide),
            lobe(rgb(1), second_share, 0.0, [z, w], once_wide),
        ];
        Row { albedo_dir, lobes, wide, base: Some(base) }
    }
}

/// A lobe without light.
pub(super) const DARK: Lobe =
    Lobe { strength: [0.0; 3], share: 1.0, shift: 0.0, sharpness: [1.0; 2], shear: 0.0, tail: 1.0 };

fn with([r, g, b]: Rgb, w: f64) -> [f64; 4] {
    [r, g, b, w]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::lobes::SlopeAxis;

    #[test]
    fn parts_are_the_row() {
        let axis = SlopeAxis { least: 0.1, most: 0.4, nodes: 3 };
        for (is_metallic, is_tinted) in [(true, false), (true, true), (false, false)] {
            let has_tail = !is_tinted;
            let family = Family {
                coat: axis,
                base: axis,
                interface: 1,
                is_metallic,
                is_tinted,
                has_lengths: !is_metallic,
                has_tail,
                sent_back: [0.0; 3],
            };
            let some = |k: f64| [k, k + 1.0, k + 2.0];
            // The light of one visit has two numbers in a metallic row.
            let two = |k: f64| [k, k + 1.0, if is_metallic { 0.0 } else { k + 2.0 }];
            let lobe = |strength, shift, k: f64| Lobe {
                strength,
                share: if has_tail { k } else { 1.0 },
                shift,
                sharpness: [k, 2.0 * k],
                shear: 0.5 * k,
                tail: 0.25,
            };
            let row = Row {
                albedo_dir: [1.0, 2.0, 3.0],
                lobes: vec![lobe(two(4.0), 0.3, 0.5), lobe([6.0, 7.0, 8.0], 0.0, 0.75)],
                wide: [9.0, 10.0, 11.0],
                base: Some(BaseLight {
                    energy: some(12.0),
                    internal: if is_metallic { [0.0, 16.0, 17.0] } else { some(15.0) },
                    falloff: [0.25, 0.0],
                    lengths: if is_metallic { [0.0; 3] } else { [2.0, 2.5, 3.0] },
                    met: None,
                }),
            };
            let (first, parts) = (family.first_part(), family.to_parts(&row));
            assert_eq!(parts.len() as i32, family.parts(true, true, true) as i32 - first);
            assert_eq!(family.of_parts(first, &parts, 0.25), row);
            // Lengths, or the light of the base, are last.
            let fewer = &parts[..(family.parts(false, false, false) as i32 - first) as usize];
            assert_eq!(family.of_parts(first, fewer, 0.25).lobes, row.lobes);
        }
    }
}
