//! Built-in optical constants with their sources.
//!
//! The files lie in `data/`, in the CSV form that [`crate::index_file`] reads; their comment lines `# key: value` carry the citation.
//!
//! Rows exist only where the source has data: nothing is extrapolated, [`Ior::at`] holds the end values.

use std::sync::OnceLock;

use crate::index_file::csv;
use crate::ior::Ior;

/// A built-in index of refraction, and its source.
///
/// ```
/// use luthier_optics::constants::dataset;
///
/// let silver = dataset("ag").unwrap();
/// assert_eq!((silver.class, silver.k_given), ("conductor", true));
/// assert!(silver.ior.at(550.0).im > 3.0);
/// assert!(dataset("unobtainium").is_none());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Dataset {
    /// Name in material files: lower case, digits and underscores.
    pub id: &'static str,
    /// Name for people.
    pub name: &'static str,
    /// `conductor`, `semiconductor` or `dielectric`.
    pub class: &'static str,
    /// Who measured it, and where it was published.
    pub citation: &'static str,
    /// Digital object identifier of the publication; empty when it has none.
    pub doi: &'static str,
    /// Page of the database that the rows come from; empty when they were printed in the source.
    pub page: &'static str,
    /// Terms under which the rows are available.
    pub licence: &'static str,
    /// Origin of the rows: measured points joined, or a formula evaluated.
    pub rows: &'static str,
    /// Conditions of the measurement, and what to know before relying on it.
    pub note: &'static str,
    /// Whether the source gives k. Where it does not, k is 0, which does not mean measured transparency.
    pub k_given: bool,
    /// The index.
    pub ior: Ior,
}

/// All built-in data sets, by id in alphabetical order.
pub fn datasets() -> &'static [Dataset] {
    static DATASETS: OnceLock<Vec<Dataset>> = OnceLock::new();
    DATASETS.get_or_init(|| FILES.iter().map(|(id, text)| load(id, text)).collect())
}

/// The built-in data set of that id.
pub fn dataset(id: &str) -> Option<&'static Dataset> {
    let all = datasets();
    all.binary_search_by(|d| d.id.cmp(id)).ok().map(|i| &all[i])
}

fn load(id: &'static str, text: &'static str) -> Dataset {
    let ior = match csv(text) {
        Ok(file) => file.ior,
        // Part of the program, not input: a unit test reads every file.
        Err(error) => unreachable!("built-in data set {id}: {error}"),
    };
    Dataset {
        id,
        name: header(text, "name"),
        class: header(text, "class"),
        citation: header(text, "citation"),
        doi: header(text, "doi"),
        page: header(text, "page"),
        licence: header(text, "licence"),
        rows: header(text, "rows"),
        note: header(text, "note"),
        k_given: header(text, "k") == "given",
        ior,
    }
}

/// The value of a `# key: value` line; empty when there is none.
fn header<'t>(text: &'t str, key: &str) -> &'t str {
    text.lines()
        .map_while(|line| line.strip_prefix("# "))
        .find_map(|line| line.strip_prefix(key)?.strip_prefix(':'))
        .map_or("", str::trim)
}

macro_rules! files {
    ($($id:literal),* $(,)?) => {
        &[$(($id, include_str!(concat!("../data/", $id, ".csv")))),*]
    };
}

/// Data sets in alphabetical order.
const FILES: &[(&str, &str)] = files![
    "acrylic_lacquer",
    "ag",
    "al",
    "al2o3_o",
    "au",
    "brass_70_30",
    "calcite_e",
    "calcite_o",
    "cellulose",
    "co",
    "cr",
    "cr_rakic",
    "cu",
    "cu2o",
    "diamond",
    "fe",
    "fe2o3_o",
    "ge",
    "glycerol",
    "ice",
    "mgf2_o",
    "n_bk7",
    "ni",
    "pc",
    "pd",
    "pdms",
    "pet",
    "pmma",
    "ps",
    "pt",
    "sf11",
    "si",
    "si3n4",
    "sio2",
    "steel_316",
    "ti",
    "tio2_anatase_film",
    "tio2_film",
    "tio2_rutile_e",
    "tio2_rutile_o",
    "w",
    "water",
    "zn",
    "zno_o",
    "zns_film",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_is_complete_and_in_order() {
        assert_eq!(datasets().len(), 45);
        assert!(datasets().is_sorted_by(|a, b| a.id < b.id));
        for d in datasets() {
            assert!(d.id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'), "{}", d.id);
            for (what, text) in [("name", d.name), ("citation", d.citation), ("licence", d.licence), ("note", d.note)] {
                assert!(!text.is_empty(), "{} has no {what}", d.id);
            }
            assert!(["conductor", "semiconductor", "dielectric"].contains(&d.class), "{}: {}", d.id, d.class);
            assert_eq!(dataset(d.id), Some(d));
            let k_max = d.ior.samples().iter().fold(0.0, |k: f64, s| k.max(s.k));
            assert!(d.k_given || k_max == 0.0, "{}", d.id);
            assert!(d.class != "conductor" || k_max > 1.0, "{}", d.id);
        }
    }

    #[test]
    fn ranges_lie_in_the_visible_and_steps_are_five_nanometres() {
        for d in datasets() {
            let (first, last) = d.ior.range_nm().unwrap();
            assert!((360.0..=450.0).contains(&first) && (690.0..=830.0).contains(&last), "{}: {first}-{last}", d.id);
            if d.id != "cu2o" {
                assert!(d.ior.samples().windows(2).all(|w| w[1].wavelength_nm - w[0].wavelength_nm == 5.0), "{}", d.id);
            }
        }
        assert_eq!(dataset("au").unwrap().ior.range_nm(), Some((360.0, 830.0)));
        assert_eq!(dataset("diamond").unwrap().ior.range_nm(), Some((360.0, 760.0)));
    }

    /// Oracle: n and k at the sodium D line evaluated by refractiveindex.info's own files, not from our rows.
    #[test]
    fn sodium_d_agrees_with_the_sources() {
        for (id, n, k) in [
            ("ag", 0.0520749, 3.919),
            ("al", 1.20665, 7.068),
            ("au", 0.273401, 2.948),
            ("brass_70_30", 0.46056, 3.152),
            ("cu", 0.617003, 2.808),
            ("diamond", 2.41726, 0.0),
            ("n_bk7", 1.51673, 0.0),
            ("ti", 2.6146, 3.609),
            ("tio2_film", 2.41068, 0.0),
            ("water", 1.33335, 0.0),
        ] {
            let index = dataset(id).unwrap().ior.at(589.3);
            // Joining 5 nm rows by straight lines costs at most this much on the steepest of them.
            assert!((index.re - n).abs() < 2e-3 && (index.im - k).abs() < 4e-3, "{id}: {index} against {n} + {k}i");
        }
    }

    /// Oracle: N-BK7's catalogue index at the lines F, d and C (1.52238, 1.51680, 1.51432).
    #[test]
    fn crown_glass_agrees_with_its_catalogue() {
        let ior = &dataset("n_bk7").unwrap().ior;
        for (nm, n) in [(486.13, 1.52238), (587.56, 1.51680), (656.27, 1.51432)] {
            assert!((ior.at(nm).re - n).abs() < 2e-5, "{nm}: {}", ior.at(nm).re);
        }
    }

    /// Oracle: the numbers printed in Elek 2010, appendix A.
    #[test]
    fn cuprite_is_as_printed() {
        let set = dataset("cu2o").unwrap();
        for (nm, n, k) in [(690.0, 2.83, 0.083), (550.0, 3.10, 0.19), (450.0, 3.06, 0.6)] {
            assert_eq!((set.ior.at(nm).re, set.ior.at(nm).im), (n, k));
        }
    }

    #[test]
    fn unknown_ids_are_none() {
        assert_eq!(dataset("unobtainium"), None);
        assert_eq!(dataset(""), None);
    }
}
