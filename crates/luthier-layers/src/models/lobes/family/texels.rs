//! Rows of a family as parts of four numbers, as tables have them.

use luthier_optics::Rgb;

use super::Family;
use crate::models::lobes::{BaseLight, Lobe, Row};

impl Family {
    /// Number of parts of a row: with the lengths of light in a slab that absorbs or cosines of facets below a film, or with the light of a diffuse base apart, to recolour it.
    /// An edge tint comes after the lengths, whether they count or not.
    pub fn parts(self, is_tinted: bool, has_base: bool) -> usize {
        match (self.is_metallic, is_tinted, has_base) {
            (true, _, _) if self.is_tinted => 7,
            (true, false, _) => 5,
            (true, true, _) => 6,
            (false, _, false) => 6 + usize::from(self.has_lengths),
            (false, _, true) => 8,
        }
    }

    /// A row as parts, all that it may have; their numbers are in docs/manifest.md, Families of lobes.
    pub fn to_parts(self, row: &Row) -> Vec<[f64; 4]> {
        let lobe = |lobe: usize| row.lobes.get(lobe).copied().unwrap_or(DARK);
        let [first, second] = [lobe(0), lobe(1)];
        let base = row.base.unwrap_or_default();
        let [a, b] = base.falloff;
        // The place of the shear of one lobe has the share of the light of the other that is wide.
        let [more_wide, once_wide] = [first, second].map(|lobe| lobe.shear * lobe.tail.sqrt());
        let [x, y] = first.sharpness.map(|x| x * first.tail.sqrt());
        let [z, w] = second.sharpness.map(|x| x * second.tail.sqrt());
        let more = with(second.strength, more_wide);
        if self.is_metallic {
            let [bright, white, _] = first.strength;
            let [facet, once_length, more_length] = row.albedo_dir;
            let ([light, base_length, _], [sent_back, around, _]) = (base.energy, base.internal);
            let [white_light, dip, first_dip] = row.wide;
            let edge = self.is_tinted.then_some([dip, first_dip, 0.0, 0.0]);
            let parts = [
                [bright, white, once_wide, first.shift],
                more,
                [x, y, z, w],
                [facet, white_light, first.share, second.share],
                [light, sent_back, a, b],
                [base_length, around, once_length, more_length],
            ];
            return parts.into_iter().chain(edge).collect();
        }
        vec![
            with(first.strength, first.shift),
            more,
            [x, y, z, w],
            with(row.albedo_dir, first.share),
            with(row.wide, second.share),
            [a, b, once_wide, base.lengths[0]],
            with(base.energy, base.lengths[1]),
            with(base.internal, base.lengths[2]),
        ]
    }

    /// The row of parts, those that a table has, with lobes of a tail.
    pub fn of_parts(self, parts: &[[f64; 4]], tail: f64) -> Row {
        let part = |number: usize| parts.get(number).copied().unwrap_or_default();
        let rgb = |number: usize| -> Rgb {
            let [r, g, b, _] = part(number);
            [r, g, b]
        };
        let [x, y, z, w] = part(2).map(|sharpness| sharpness / tail.sqrt());
        let (once, more_wide) = (part(0), part(1)[3]);
        let (strength, shares, once_wide, albedo_dir, wide, base) = if self.is_metallic {
            let ([facet, wide, first, second], [light, sent_back, a, b]) = (part(3), part(4));
            let [base_length, around, once_length, more_length] = part(5);
            let [dip, first_dip, ..] = if self.is_tinted { part(6) } else { [0.0; 4] };
            let base = BaseLight {
                energy: [light, base_length, 0.0],
                internal: [sent_back, around, 0.0],
                falloff: [a, b],
                ..BaseLight::default()
            };
            let albedo_dir = [facet, once_length, more_length];
            ([once[0], once[1], 0.0], [first, second], once[2], albedo_dir, [wide, dip, first_dip], base)
        } else {
            let [a, b, once_wide, once_length] = part(5);
            let lengths = [once_length, part(6)[3], part(7)[3]];
            let base = BaseLight { energy: rgb(6), internal: rgb(7), falloff: [a, b], lengths, ..BaseLight::default() };
            (rgb(0), [part(3)[3], part(4)[3]], once_wide, rgb(3), rgb(4), base)
        };
        let lobe = |strength, share, shift, sharpness, wide: f64| Lobe {
            strength,
            share,
            shift,
            sharpness,
            shear: wide / tail.sqrt(),
            tail,
        };
        let lobes = vec![
            lobe(strength, shares[0], once[3], [x, y], more_wide),
            lobe(rgb(1), shares[1], 0.0, [z, w], once_wide),
        ];
        Row { albedo_dir, lobes, wide, base: Some(base) }
    }
}

/// A lobe without light.
const DARK: Lobe = Lobe { strength: [0.0; 3], share: 1.0, shift: 0.0, sharpness: [1.0; 2], shear: 0.0, tail: 1.0 };

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
            let family =
                Family { coat: axis, base: axis, interface: 1, is_metallic, is_tinted, has_lengths: !is_metallic };
            // Numbers that a metallic row has not are 0.
            let some = |k: f64| [k, k + 1.0, if is_metallic { 0.0 } else { k + 2.0 }];
            let lobe = |strength, shift, k: f64| Lobe {
                strength,
                share: k,
                shift,
                sharpness: [k, 2.0 * k],
                shear: 0.5 * k,
                tail: 0.25,
            };
            let row = Row {
                albedo_dir: [1.0, 2.0, 3.0],
                lobes: vec![lobe(some(4.0), 0.3, 0.5), lobe([6.0, 7.0, 8.0], 0.0, 0.75)],
                wide: if is_metallic && !is_tinted { [9.0, 0.0, 0.0] } else { [9.0, 10.0, 11.0] },
                base: Some(BaseLight {
                    energy: some(12.0),
                    internal: some(15.0),
                    falloff: [0.25, 0.125],
                    lengths: if is_metallic { [0.0; 3] } else { [2.0, 2.5, 3.0] },
                    met: None,
                }),
            };
            let parts = family.to_parts(&row);
            assert_eq!(parts.len(), family.parts(true, true));
            assert_eq!(family.of_parts(&parts, 0.25), row);
            // Lengths, or the light of the base, are last.
            let fewer = family.of_parts(&parts[..family.parts(false, false)], 0.25);
            assert_eq!(fewer.lobes, row.lobes);
        }
    }
}
