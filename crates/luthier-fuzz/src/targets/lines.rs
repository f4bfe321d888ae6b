//! Texts of one line, or of lines: optical constants, axes, directions, re-radiation.

use luthier_layers::angles::pairs;
use luthier_layers::beam_fit::samples;
use luthier_layers::luthier_optics::reradiation::Matrix;
use luthier_optics::index_file::{IndexFile, IndexFileError, VALUE_MAX, csv, yaml};
use luthier_table::{Layout, Nodes};

/// A CSV file of optical constants.
pub(super) fn index(bytes: &[u8]) {
    check_index(csv(&String::from_utf8_lossy(bytes)));
}

/// A page of refractiveindex.info.
pub(super) fn page(bytes: &[u8]) {
    check_index(yaml(&String::from_utf8_lossy(bytes)));
}

fn check_index(read: Result<IndexFile, IndexFileError>) {
    match read {
        Ok(IndexFile { ior, notes }) => {
            let samples = ior.samples();
            assert!(!samples.is_empty() && notes.iter().all(|note| !note.is_empty()));
            assert!(samples.is_sorted_by(|a, b| a.wavelength_nm < b.wavelength_nm));
            for sample in samples {
                assert!(sample.wavelength_nm.is_finite(), "{sample:?}");
                assert!([sample.n, sample.k].into_iter().all(|value| (0.0..=VALUE_MAX).contains(&value)), "{sample:?}");
            }
            let ends = [samples[0].wavelength_nm, samples[samples.len() - 1].wavelength_nm];
            for nm in [0.0, 1.0, 380.0, 550.0, 780.0, 1e6, ends[0], ends[1], 0.5 * ends[0] + 0.5 * ends[1]] {
                let index = ior.at(nm);
                assert!(index.re.is_finite() && index.im.is_finite(), "{index} at {nm} nm");
            }
        }
        Err(error) => assert!(!error.to_string().is_empty() && !error.hint().is_empty() && error.line != Some(0)),
    }
}

/// The axes of a table.
pub(super) fn axes(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    for nodes in Nodes::MISTAKEN {
        let Ok(layout) = Layout::parse(&text, nodes) else { continue };
        let printed = layout.to_string();
        assert_eq!(Layout::parse(&printed, nodes).ok(), Some(layout), "printed as {printed}");
        for size in [[1, 1], [4, 4], [32, 17]] {
            for texel in [[0, 0], [size[0] - 1, size[1] - 1]] {
                let at = layout.at_texel(size, texel);
                assert!(at.into_iter().all(f64::is_finite), "{at:?} of {text:?}");
            }
        }
    }
}

/// A list of directions.
pub(super) fn directions(bytes: &[u8]) {
    match pairs(&String::from_utf8_lossy(bytes)) {
        Ok(list) => {
            for angles in list.iter().flatten() {
                let direction = angles.direction();
                assert!((direction.length() - 1.0).abs() < 1e-12 && direction.z >= 0.0, "{direction} of {angles:?}");
            }
            let lines = list.iter().map(|pair| {
                let [wi, wo]: [[f64; 2]; 2] = pair.map(luthier_layers::angles::Angles::to_array);
                format!("{},{},{},{}\n", wi[0], wi[1], wo[0], wo[1])
            });
            let printed: String = lines.collect();
            assert_eq!(pairs(&printed), Ok(list));
        }
        Err(error) => assert!(!error.reason.is_empty() && error.line != Some(0)),
    }
}

/// Values of a lobe.
pub(super) fn lobe(bytes: &[u8]) {
    match samples(&String::from_utf8_lossy(bytes)) {
        Ok(list) => {
            assert!(!list.is_empty());
            for sample in list {
                for direction in [sample.wi, sample.wo] {
                    assert!((direction.length() - 1.0).abs() < 1e-12 && direction.z > 0.0, "{direction}");
                }
                assert!(sample.value.iter().all(|value| value.is_finite() && *value >= 0.0), "{sample:?}");
            }
        }
        Err(error) => assert!(!error.reason.is_empty() && error.line != Some(0)),
    }
}

/// A re-radiation matrix.
pub(super) fn reradiation(bytes: &[u8]) {
    match Matrix::parse(&String::from_utf8_lossy(bytes)) {
        Ok(matrix) => {
            let bins = matrix.wavelengths_nm.len();
            assert!(bins > 0 && matrix.shares.len() == bins * bins);
            for (bin, &nm) in matrix.wavelengths_nm.iter().enumerate() {
                assert_eq!(matrix.bin(nm), Some(bin));
            }
            let head = format!("nm{}\n", row(&matrix.wavelengths_nm));
            let rows = matrix.wavelengths_nm.iter().zip(matrix.shares.chunks_exact(bins));
            let printed = rows.fold(head, |text, (nm, shares)| format!("{text}{nm}{}\n", row(shares)));
            assert_eq!(Matrix::parse(&printed), Ok(matrix));
        }
        Err(error) => assert!(!error.reason.is_empty() && error.line != Some(0)),
    }
}

fn row(values: &[f64]) -> String {
    values.iter().map(|value| format!(",{value}")).collect()
}
