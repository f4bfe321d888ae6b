//! How far two PNG files of one size are apart, in 8-bit steps.
//!
//! `difference A B [LIMIT]`: fails when the mean over all channels is above LIMIT.

use std::env;
use std::fs::File;
use std::io::BufReader;

use anyhow::{Context, Result, bail, ensure};

fn main() -> Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (a, b, limit) = match arguments.as_slice() {
        [a, b] => (a, b, None),
        [a, b, limit] => (a, b, Some(limit.parse::<f64>()?)),
        _ => bail!("usage: difference A B [LIMIT]"),
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
