//! BC6H without sign (Khronos Data Format 1.4, section 20.2; Direct3D 11): 4 x 4 texels of three half floats in 16 bytes.
//!
//! The encoder writes only the modes with one line through the colours of a block, of the fourteen that there are: in a smooth table these
//! colours lie nearly on a short line. Such a block is the mode (5 bits), two ends of three numbers each (60), and for each texel its place between them (4, the
//! first 3).

use half::f16;

use crate::Image;

/// Texels along a side of a block.
pub(crate) const SIDE: u32 = 4;

/// Bytes of a block.
const BYTES: usize = 16;

/// Places between the ends, in 64ths.
const WEIGHTS: [i32; 16] = [0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64];

/// A mode: its number in the block, and bits of the first end and of the second, which is a difference where these are fewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Mode {
    code: u128,
    first: u32,
    second: u32,
}

/// The finest first, whose ends are nearest to each other.
const MODES: [Mode; 4] = [
    Mode { code: 15, first: 16, second: 4 },
    Mode { code: 11, first: 12, second: 8 },
    Mode { code: 7, first: 11, second: 9 },
    Mode { code: 3, first: 10, second: 10 },
];

/// Number of modes to try, the finest of those that reach both ends: coarser ones are rarely better.
const TRIED: usize = 2;

/// Bits of the first end that come before the second; the rest comes behind it, highest first.
const LOW_BITS: u32 = 10;

/// The colours of a block.
type Texels = [[f64; 3]; 16];

/// Two ends as a mode keeps them.
type Ends = [[i32; 3]; 2];

/// The largest code of so many bits.
fn largest(bits: u32) -> i32 {
    (1 << bits) - 1
}

/// The number of 16 bits that a code of fewer stands for.
fn number(code: i32, bits: u32) -> i32 {
    match code {
        code if bits == 16 => code,
        0 => 0,
        code if code == largest(bits) => largest(16),
        code => ((code << 15) + 0x4000) >> (bits - 1),
    }
}

/// The code for a number.
fn code(number: f64, bits: u32) -> i32 {
    (libm::floor(number / f64::from(0x10000 >> bits)) as i32).clamp(0, largest(bits))
}

/// The half float that a number becomes.
fn half(number: i32) -> f16 {
    f16::from_bits(((number * 31) >> 6) as u16)
}

/// The number of a half float: the middle of the numbers that become it.
fn place(value: f64) -> f64 {
    // By way of single precision: `half` converts doubles in one step or in two, by the machine.
    (f64::from(f16::from_f32(value as f32).to_bits()) + 0.5) / 31.0 * 64.0
}

impl Mode {
    fn colors(self, ends: &Ends) -> [[f16; 3]; 16] {
        let numbers = ends.map(|end| end.map(|code| number(code, self.first)));
        WEIGHTS.map(|w| [0, 1, 2].map(|c: usize| half((numbers[0][c] * (64 - w) + numbers[1][c] * w + 32) >> 6)))
    }

    /// Whether a block can say these ends, in either order: [`Fit::block`] may swap them.
    fn has(self, ends: &Ends) -> bool {
        let (max, reach) = (largest(self.first), 1 << (self.second - 1));
        ends.iter().flatten().all(|code| (0..=max).contains(code))
            && (self.first == self.second || (0..3).all(|c| (ends[1][c] - ends[0][c]).abs() < reach))
    }
}

/// A block, and how far it is from the texels.
#[derive(Debug, Clone, Copy)]
struct Fit {
    mode: Mode,
    ends: Ends,
    indices: [usize; 16],
    /// Largest error, and the sum of squares.
    error: (f64, f64),
}

impl Fit {
    /// The block of these ends; nothing if it is worse than `bound`.
    fn within(bound: (f64, f64), mode: Mode, ends: Ends, texels: &Texels) -> Option<Self> {
        let colors = mode.colors(&ends).map(|color| color.map(f16::to_f64));
        let (mut indices, mut error) = ([0; 16], (0.0_f64, 0.0));
        for (texel, index) in texels.iter().zip(&mut indices) {
            let mut best = (f64::INFINITY, 0.0);
            for (i, color) in colors.iter().enumerate() {
                let off = [0, 1, 2].map(|c: usize| (color[c] - texel[c]).abs());
                let here = (off[0].max(off[1]).max(off[2]), off[0] * off[0] + off[1] * off[1] + off[2] * off[2]);
                if here < best {
                    (best, *index) = (here, i);
                }
            }
            error = (error.0.max(best.0), error.1 + best.1);
            if error >= bound {
                return None;
            }
        }
        Some(Self { mode, ends, indices, error })
    }

    /// Ends moved by a step at a time while that helps.
    fn descended(mut self, texels: &Texels) -> Self {
        loop {
            let before = self.error;
            for c in 0..3 {
                for [a, b] in [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]] {
                    let mut ends = self.ends;
                    ends[0][c] += a;
                    ends[1][c] += b;
                    if self.mode.has(&ends)
                        && let Some(better) = Self::within(self.error, self.mode, ends, texels)
                    {
                        self = better;
                    }
                }
            }
            if self.error >= before {
                return self;
            }
        }
    }

    fn block(mut self) -> [u8; BYTES] {
        // The highest bit of the first index is not kept: it is 0.
        if self.indices[0] >= 8 {
            self.ends.swap(0, 1);
            self.indices = self.indices.map(|i| 15 - i);
        }
        let (mut word, mut at) = (0, 0);
        let mut put = |value: u128, bits: u32| {
            word |= (value & ((1 << bits) - 1)) << at;
            at += bits;
        };
        let Mode { code, first, second } = self.mode;
        put(code, 5);
        let [starts, ends] = self.ends.map(|end| end.map(|code| code as u128));
        starts.iter().for_each(|&start| put(start, LOW_BITS));
        for (start, end) in starts.into_iter().zip(ends) {
            put(if first == second { end } else { end.wrapping_sub(start) }, second);
            (LOW_BITS..first).rev().for_each(|bit| put(start >> bit, 1));
        }
        for (i, &index) in self.indices.iter().enumerate() {
            put(index as u128, if i == 0 { 3 } else { 4 });
        }
        word.to_le_bytes()
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The line through colours along which they differ most, as the two of its points that enclose them all.
fn line(colors: &Texels) -> [[f64; 3]; 2] {
    let mean = [0, 1, 2].map(|c: usize| colors.iter().map(|n| n[c]).sum::<f64>() / 16.0);
    let off = colors.map(|color| [0, 1, 2].map(|c: usize| color[c] - mean[c]));
    // The power method, from the texel that is farthest off.
    let mut axis = off.iter().fold([0.0; 3], |a, b| if dot(b, b) > dot(&a, &a) { *b } else { a });
    for _ in 0..8 {
        let mut next = [0.0; 3];
        for off in &off {
            let weight = dot(&axis, off);
            (0..3).for_each(|c| next[c] += weight * off[c]);
        }
        let length = libm::sqrt(dot(&next, &next));
        if length == 0.0 {
            return [mean; 2];
        }
        axis = next.map(|v| v / length);
    }
    let places = off.map(|off| dot(&axis, &off));
    let ends = [places.into_iter().fold(0.0, f64::min), places.into_iter().fold(0.0, f64::max)];
    ends.map(|place| [0, 1, 2].map(|c: usize| mean[c] + place * axis[c]))
}

/// The ends of the one colour that is least far from all texels, in the finest mode, which has every half float.
fn flat(texels: &Texels) -> Ends {
    let middle = [0, 1, 2].map(|c: usize| {
        let values = texels.map(|texel| texel[c]);
        let [low, high] = [values.into_iter().fold(f64::INFINITY, f64::min), values.into_iter().fold(0.0, f64::max)];
        code(place(f64::midpoint(low, high)), MODES[0].first)
    });
    [middle; 2]
}

fn compressed(texels: &Texels) -> [u8; BYTES] {
    let ends = line(&texels.map(|texel| texel.map(place)));
    let lines = MODES.iter().filter_map(|&mode| {
        let ends = ends.map(|end| end.map(|number| code(number, mode.first)));
        mode.has(&ends).then_some((mode, ends))
    });
    // Colours that scatter across their line can be farther from it than from one colour.
    let starts = lines.take(TRIED).chain([(MODES[0], flat(texels))]);
    let fits = starts
        .filter_map(|(mode, ends)| Some(Fit::within((f64::INFINITY, 0.0), mode, ends, texels)?.descended(texels)));
    let best = fits.reduce(|a, b| if b.error < a.error { b } else { a });
    best.map_or([0; BYTES], Fit::block)
}

fn decompressed(block: [u8; BYTES]) -> [[f16; 3]; 16] {
    let mut word = u128::from_le_bytes(block);
    let mut take = |bits: u32| {
        let value = word & ((1 << bits) - 1);
        word >>= bits;
        value as i32
    };
    let code = take(5) as u128;
    let Some(&mode) = MODES.iter().find(|mode| mode.code == code) else { return [[f16::ZERO; 3]; 16] };
    let Mode { first, second, .. } = mode;
    let mut starts = [0; 3].map(|_| take(LOW_BITS));
    let mut ends = [0; 3];
    for (start, end) in starts.iter_mut().zip(&mut ends) {
        *end = take(second);
        (LOW_BITS..first).rev().for_each(|bit| *start |= take(1) << bit);
        if first != second {
            // The difference, with its sign extended.
            *end = (*start + (*end << (32 - second) >> (32 - second))) & largest(first);
        }
    }
    let colors = mode.colors(&[starts, ends]);
    let mut texels = [[f16::ZERO; 3]; 16];
    for (i, texel) in texels.iter_mut().enumerate() {
        *texel = colors[take(if i == 0 { 3 } else { 4 }) as usize];
    }
    texels
}

/// The blocks of an image, row by row; its sides are multiples of [`SIDE`]. Negative values and missing channels become 0; alpha is dropped.
pub(crate) fn encode(image: &Image) -> Vec<u8> {
    let mut blocks = Vec::with_capacity(image.texel_count());
    for y in (0..image.height).step_by(SIDE as usize) {
        for x in (0..image.width).step_by(SIDE as usize) {
            let texels = std::array::from_fn(|i| {
                let texel = image.texel(x + i as u32 % SIDE, y + i as u32 / SIDE);
                [0, 1, 2]
                    .map(|c: usize| texel.get(c).map_or(0.0, |value| f64::from(value.clamp(0.0, f16::MAX.to_f32()))))
            });
            blocks.extend_from_slice(&compressed(&texels));
        }
    }
    blocks
}

/// Whether all blocks are of the modes that [`encode`] writes, or empty.
pub(crate) fn is_known(blocks: &[u8]) -> bool {
    let (blocks, _) = blocks.as_chunks::<BYTES>();
    blocks.iter().all(|block| *block == [0; BYTES] || MODES.iter().any(|mode| mode.code == u128::from(block[0] & 31)))
}

/// RGB of every texel of known blocks.
pub(crate) fn decode(width: u32, height: u32, blocks: &[u8]) -> Vec<f32> {
    let mut image = Image::zeros(width, height, 3);
    let (blocks, _) = blocks.as_chunks::<BYTES>();
    for (i, block) in (0..).zip(blocks) {
        let [x, y] = [i % (width / SIDE), i / (width / SIDE)].map(|k| k * SIDE);
        for (k, color) in (0..).zip(decompressed(*block)) {
            image.texel_mut(x + k % SIDE, y + k / SIDE).copy_from_slice(&color.map(f16::to_f32));
        }
    }
    image.data
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Another decoder, of all modes.
    fn oracle(block: &[u8; BYTES]) -> [[f16; 3]; 16] {
        let mut halves = [0; 48];
        bcdec_rs::bc6h_half(block, &mut halves, 12, false);
        let (texels, _) = halves.as_chunks::<3>();
        std::array::from_fn(|i| texels[i].map(f16::from_bits))
    }

    fn largest_error(texels: &Texels, block: [u8; BYTES]) -> f64 {
        let off = |(a, b): (&[f64; 3], [f16; 3])| (0..3).map(|c| (a[c] - b[c].to_f64()).abs()).fold(0.0, f64::max);
        texels.iter().zip(decompressed(block)).map(off).fold(0.0, f64::max)
    }

    /// Error of the best block of one colour: the half floats around the middle of each channel, all tried.
    fn flat_error(texels: &Texels) -> f64 {
        let channel = |c: usize| {
            let values = texels.map(|texel| texel[c]);
            let middle =
                (values.iter().fold(f64::MAX, |a, b| a.min(*b)) + values.iter().fold(0.0_f64, |a, b| a.max(*b))) / 2.0;
            let near = f16::from_f64(middle).to_bits();
            let error =
                |bits: u16| values.iter().map(|v| (v - f16::from_bits(bits).to_f64()).abs()).fold(0.0, f64::max);
            (near.saturating_sub(1)..=near + 1).map(error).fold(f64::MAX, f64::min)
        };
        (0..3).map(channel).fold(0.0, f64::max)
    }

    /// Ends that a mode is said to have, in either order of the places between them. The farthest difference once came back as its
    /// opposite.
    #[test]
    fn ends_survive_when_they_are_swapped() {
        for mode in MODES {
            let reach = 1 << (mode.second - 1);
            for delta in [-reach, 1 - reach, -1, 0, 1, reach - 1, reach] {
                let ends = [[largest(mode.first) / 2; 3], [largest(mode.first) / 2 + delta; 3]];
                if !mode.has(&ends) {
                    continue;
                }
                for first in [0, 15] {
                    let indices = std::array::from_fn(|i| if i == 0 { first } else { i });
                    let colors = mode.colors(&ends);
                    let read = decompressed(Fit { mode, ends, indices, error: (0.0, 0.0) }.block());
                    assert_eq!(read, indices.map(|i| colors[i]), "{mode:?}, {delta}, {first}");
                }
            }
        }
    }

    /// Bits laid by hand: mode 3 with ends 1 and 2 of red, all texels at the first end but the last at the other.
    #[test]
    fn bits_lie_as_specified() {
        let word: u128 = 3 | 1 << 5 | 2 << 35 | 0xf << 124;
        let texels = decompressed(word.to_le_bytes());
        // (1 + 1/2) 2^6 becomes the bits 96 * 31 / 64, and (2 + 1/2) 2^6 the bits 160 * 31 / 64.
        assert_eq!(texels[0], [f16::from_bits(46), f16::ZERO, f16::ZERO]);
        assert_eq!(texels[15], [f16::from_bits(77), f16::ZERO, f16::ZERO]);
        assert_eq!(oracle(&word.to_le_bytes()), texels);
    }

    #[test]
    fn one_colour_is_kept_to_the_bit() {
        for color in [[0.0; 3], [1.0, 0.5, 1e-4], [0.09, 1.04, 65504.0], [0.2; 3]] {
            let color = color.map(|v| f16::from_f64(v).to_f64());
            assert_eq!(largest_error(&[color; 16], compressed(&[color; 16])), 0.0, "{color:?}");
        }
    }

    /// Sixteen places on a line, rounding of the ends aside.
    #[test]
    fn grey_ramps_are_off_by_little() {
        for [from, to] in [[0.25, 0.3], [0.5, 0.9], [0.04, 0.06]] {
            let ramp = std::array::from_fn(|i| [from + (to - from) * i as f64 / 15.0; 3]);
            let error = largest_error(&ramp, compressed(&ramp));
            assert!(error < (to - from) / 15.0, "{from} to {to}: {error}");
        }
    }

    #[test]
    fn what_is_not_ours_is_known_to_be_so() {
        let image = Image { data: (0..96).map(|i| i as f32 / 96.0).collect(), ..Image::zeros(8, 4, 3) };
        let mut blocks = encode(&image);
        assert_eq!(blocks.len(), 32);
        assert!(is_known(&blocks) && is_known(&[0; BYTES]));
        blocks[0] = 2;
        assert!(!is_known(&blocks));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        #[test]
        fn another_decoder_reads_the_same_halves(
            (from, to) in (prop::array::uniform3(0.0..1.2f64), prop::array::uniform3(0.0..1.2f64)),
            spread in prop_oneof![Just(1.0), Just(0.1), Just(0.01), Just(1e-3)],
            noise in prop::collection::vec(prop::array::uniform3(-0.05..0.05f64), 16),
        ) {
            let texels = std::array::from_fn(|i| [0, 1, 2].map(|c: usize| {
                (from[c] + spread * ((to[c] - from[c]) * i as f64 / 15.0 + noise[i][c])).max(0.0)
            }));
            let block = compressed(&texels);
            prop_assert_eq!(decompressed(block), oracle(&block));
            prop_assert!(largest_error(&texels, block) <= flat_error(&texels));
        }

        /// Any bits of the modes that are written, reachable or not.
        #[test]
        fn known_modes_decode_as_specified(bits: u128, mode in 0..4usize) {
            let block = (bits & !31 | MODES[mode].code).to_le_bytes();
            prop_assert_eq!(decompressed(block).map(|t| t.map(f16::to_bits)), oracle(&block).map(|t| t.map(f16::to_bits)));
        }
    }
}
