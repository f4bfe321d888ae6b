//! How far two PNG files of one size are apart, in 8-bit steps.
//!
//! `difference A B [LIMIT]`: fails when the mean over all channels is above LIMIT.
//! `difference --median A B LIMIT [NEARLY_ALL]`: of the pixels that are not black in both, each by its channel that is farthest; fails when their median is
//! above LIMIT, or when 5 of 100 are above NEARLY_ALL.

use std::env;
use std::fs::File;
use std::io::BufReader;

use anyhow::{Context, Result, bail, ensure};

fn main() -> Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (a, b, limit) = match arguments.as_slice() {
        [option, a, b, limits @ ..] if option == "--median" => return median(a, b, limits),
        [a, b] => (a, b, None),
        [a, b, limit] => (a, b, Some(limit.parse::<f64>()?)),
        _ => bail!("usage: difference A B [LIMIT], or difference --median A B LIMIT [NEARLY_ALL]"),
    };
    let (left, right) = (read(a)?, read(b)?);
    ensure!(left.len() == right.len(), "the pictures have different sizes");

    let mut worst = 0;
    let mut total = 0;
    let mut far = 0;
    for (left, right) in left.iter().zip(&right) {
        let steps = (0..3).map(|channel| u32::from(left[channel].abs_diff(right[channel])));
        let most = steps.clone().max().unwrap_or_default();
        worst = worst.max(most);
        far += u32::from(most > 2);
        total += steps.sum::<u32>();
    }
    let mean = f64::from(total) / (3.0 * left.len() as f64);
    println!("{a} - {b}: mean {mean:.4}, greatest {worst}, {far} of {} pixels above 2 (of 255)", left.len());
    ensure!(limit.is_none_or(|limit| mean <= limit), "the mean is above {}", limit.unwrap_or_default());
    Ok(())
}

fn median(a: &str, b: &str, limits: &[String]) -> Result<()> {
    let (left, right) = (read(a)?, read(b)?);
    ensure!(left.len() == right.len(), "the pictures have different sizes");
    let shown = left.iter().zip(&right).filter(|(left, right)| **left != [0; 3] || **right != [0; 3]);
    let farthest = |(left, right): (&[u8; 3], &[u8; 3])| left.iter().zip(right).map(|(l, r)| l.abs_diff(*r)).max();
    let mut steps: Vec<u8> = shown.filter_map(farthest).collect();
    ensure!(!steps.is_empty(), "both pictures are black");
    steps.sort_unstable();
    let at = |percent: usize| steps[(steps.len() - 1) * percent / 100];
    let (middle, nearly_all) = (at(50), at(95));
    println!(
        "{a} - {b}: median {middle}, 95 % within {nearly_all}, 99 % within {} (of 255), {} pixels",
        at(99),
        steps.len()
    );
    for (limit, (what, found)) in limits.iter().zip([("the median", middle), ("the 95 %", nearly_all)]) {
        ensure!(found <= limit.parse()?, "{what} is above {limit}");
    }
    Ok(())
}

/// Pixels, alpha left out.
fn read(path: &str) -> Result<Vec<[u8; 3]>> {
    let file = File::open(path).with_context(|| path.to_owned())?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info()?;
    let mut bytes = vec![0; reader.output_buffer_size().context("the picture is too large")?];
    let info = reader.next_frame(&mut bytes)?;
    let samples = info.color_type.samples();
    ensure!(samples >= 3, "{path} has no colour");
    Ok(bytes[..info.buffer_size()].chunks_exact(samples).map(|p| [p[0], p[1], p[2]]).collect())
}
