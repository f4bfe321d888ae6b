//! Files of every writing that people have; what is expected is stated in the tests, and never read by another path of this crate.

use num_complex::Complex64;

use super::{IndexFile, Reason, csv, yaml};
use crate::ior::IorSample;

fn samples(file: &IndexFile) -> Vec<[f64; 3]> {
    file.ior.samples().iter().map(|IorSample { wavelength_nm, n, k }| [*wavelength_nm, *n, *k]).collect()
}

/// Every header names the same two rows.
#[test]
fn headers_are_those_that_people_write() {
    let expected = vec![[400.0, 1.5, 0.25], [700.0, 1.25, 2.0]];
    let nm = "400,1.5,0.25\n700,1.25,2\n";
    let um = "0.4,1.5,0.25\n0.7,1.25,2\n";
    for (header, rows) in [
        ("wavelength_nm,n,k", nm),
        ("Wavelength (nm),N,K", nm),
        ("nm,n,k", nm),
        ("wl,n,k", nm),
        ("lambda [nm],Re(n),Im(n)", nm),
        ("wl,n,k", um),
        ("wavelength, um,n,k", um),
        ("\"wavelength, um\",n,k", um),
        ("Wavelength/\u{b5}m,Refractive index,Extinction coefficient", um),
        ("λ (\u{3bc}m),n,k", um),
        ("micrometers,n,kappa", um),
        ("wavelength (angstrom),n,k", "4000,1.5,0.25\n7000,1.25,2\n"),
        ("k,n,nm", "0.25,1.5,400\n2,1.25,700\n"),
    ] {
        let file = csv(&format!("{header}\n{rows}")).unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!(samples(&file), expected, "{header}");
        assert_eq!(file.notes, Vec::<String>::new(), "{header}");
    }
    for text in [
        "\u{feff}wavelength_nm;n;k\r\n# lines\r\n\r\n400;1,5;0,25\r\n700;1,25;2\r\n;;\r\n",
        "sep=;\nwavelength_nm;n;k;\n400;1.5;0.25;\n700;1.25;2;\n",
        "nm\tn\tk\r400\t1.5\t0.25\r700\t1.25\t2\r",
        "wavelength (um) n k\n 0.4  1.5  0.25\n 0.7  1.25 2\n",
        "wl,n\n0.4,1.5\n0.7,1.25\n\nwl,k\n0.4,0.25\n0.7,2\n",
    ] {
        assert_eq!(samples(&csv(text).unwrap_or_else(|error| panic!("{text}: {error}"))), expected, "{text}");
    }
    assert_eq!(samples(&csv("nm,n\n400,1.5\n").unwrap()), [[400.0, 1.5, 0.0]]);
}

/// Odd files are read, and told.
#[test]
fn what_is_odd_is_told() {
    for (text, expected, note) in [
        ("0.4,1.5,0.25\n0.7,1.25,2\n", vec![[400.0, 1.5, 0.25], [700.0, 1.25, 2.0]], "no header"),
        (
            "nm,n,k\n400,1.5,-1e-5\n700,1.25,0\n",
            vec![[400.0, 1.5, 0.0], [700.0, 1.25, 0.0]],
            "1 in all, down to -0.00001",
        ),
        (
            "nm,n\n400,1\n400,2\n700,3\n",
            vec![[400.0, 1.5, 0.0], [700.0, 3.0, 0.0]],
            "1 in all, first at 400 nm: the mean is taken",
        ),
        ("nm,n,dn\n400,1.5,9\n700,1.25,9\n", vec![[400.0, 1.5, 0.0], [700.0, 1.25, 0.0]], "not read: dn"),
        ("nm,n\n300,-2\n400,1.5\n900,1\n", vec![[400.0, 1.5, 0.0], [900.0, 1.0, 0.0]], "the row is left out"),
        (
            "nm,n\n400,1\n700,1\nnm,k\n500,1\n700,1\n",
            vec![[400.0, 1.0, 1.0], [500.0, 1.0, 1.0], [700.0, 1.0, 1.0]],
            "k is given from 500",
        ),
    ] {
        let file = csv(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(samples(&file), expected, "{text}");
        assert_eq!(file.notes.len(), 1, "{text}: {:?}", file.notes);
        assert!(file.notes[0].contains(note), "{text}: {:?}", file.notes);
    }
    // Rows may stand in any order, and equal rows twice.
    let file = csv("nm,n\n700,3\n400,1\n700,3\n").unwrap();
    assert_eq!((samples(&file), file.notes.len()), (vec![[400.0, 1.0, 0.0], [700.0, 3.0, 0.0]], 0));
}

/// The visible range, and the sample beyond each end that lines need.
#[test]
fn rows_that_are_not_seen_do_not_count() {
    let file =
        csv("nm,n,k\n41.33,0.77,0.21\n82.7,1.2,0.9\n340,2,1\n550,0.4,2.4\n850,0.2,5\n900,0,0\n40000,1e9,0\n").unwrap();
    assert_eq!(samples(&file), [[340.0, 2.0, 1.0], [550.0, 0.4, 2.4], [850.0, 0.2, 5.0]]);
    assert_eq!(file.notes, Vec::<String>::new());
    // An n of 0 is that of silver in some tables.
    assert_eq!(samples(&csv("nm,n,k\n645,0,6.59\n").unwrap()), [[645.0, 0.0, 6.59]]);
}

#[test]
fn faults_have_a_place_and_a_hint() {
    for (text, line, column, part) in [
        ("", None, None, "no row of numbers"),
        ("# n\nnm,n\n", None, None, "no row of numbers"),
        ("# a comment\nn,k\n", Some(2), None, "no column of wavelengths"),
        ("nm,r\n", Some(1), None, "no column of n or k"),
        ("energy (eV),n,k\n2,1,1\n", Some(1), Some(1), "`energy (eV)` is an energy"),
        ("nm,n,k\n400,1\n", Some(2), None, "2 columns where the header has 3"),
        ("nm,n,k\n400,1,5,0,2\n", Some(2), None, "5 columns"),
        ("nm,n\n400,1\n\n500,x\n", Some(4), Some(2), "`x` is not a number"),
        ("nm,n\n400,1\nfoot,note\n", Some(3), Some(1), "`foot` is not a number"),
        ("nm,n\n-400,1\n", Some(2), Some(1), "not positive"),
        ("nm,n\n400,1\n500,-1\n", Some(3), Some(2), "n = -1 at 500 nm"),
        ("nm,n,k\n400,1,-2.4\n", Some(2), Some(3), "k = -2.4 at 400 nm"),
        ("nm,n,k\n400,1e300,0\n", Some(2), Some(2), "no medium"),
        ("nm,n,k\n400,1,0\n500,0,0\n", Some(3), None, "both 0 at 500 nm"),
        ("wl,n\n20,1\n400,1\n", Some(2), None, "may be nanometres or micrometres"),
        ("1,2,3,4\n", Some(1), None, "4 columns without a header"),
        ("nm,n\n0.4,1\n0.8,1\n", None, None, "no sample of this index is visible"),
        ("nm,k\n400,1\n", None, None, "no n"),
    ] {
        let error = csv(text).unwrap_err();
        assert_eq!((error.line, error.column), (line, column), "{text}: {error}");
        assert!(error.to_string().contains(part) && !error.hint().is_empty(), "{text}: {error}");
    }
    assert!(csv("nm,n\n0.4,1\n0.8,1\n").unwrap_err().hint().contains("wavelength_um"));
    let long = format!("nm,n\n{}", "400,1\n".repeat(super::ROWS_MAX + 1));
    assert_eq!(csv(&long).unwrap_err(), Reason::TooManyRows.at(super::ROWS_MAX + 2));
}

const COAT: &str = "# a page\nREFERENCES: |\n    DATA:\n      - type: none\nDATA:\n  - type: formula 5\n    wavelength_range: 0.31 4.6\n    \
                    coefficients: 1.5 0.01 -2\n  - type: tabulated k\n    data: |\n        0.36 1E-3\n        0.83 2E-3\nCONDITIONS:\n  \
                    temperature: 300\nDATA2: [{a: &b 1}, *b]\n";

/// Oracle: Cauchy's law by hand, and the rows as they stand.
#[test]
fn pages_have_tables_and_formulas() {
    let file = yaml(COAT).unwrap();
    assert!(
        (file.ior.at(500.0) - Complex64::new(1.54, 1e-3 + 1e-3 * 140.0 / 470.0)).norm() < 1e-6,
        "{}",
        file.ior.at(500.0)
    );
    assert_eq!((file.ior.range_nm(), file.notes.len()), (Some((360.0, 830.0)), 0));
    let table = "DATA:\n- {type: tabulated nk, data: \"0.4 1.5 0.25\\n0.7 1.25 2\"}\n";
    assert_eq!(samples(&yaml(table).unwrap()), [[400.0, 1.5, 0.25], [700.0, 1.25, 2.0]]);
    let apart = "DATA:\n  - type: tabulated n\n    data: |\n      0.4 1\n      0.7 4\n  - type: tabulated k\n    data: |\n      0.4 1\n      0.5 3\n      0.7 5\n";
    assert_eq!(samples(&yaml(apart).unwrap()), [[400.0, 1.0, 1.0], [500.0, 2.0, 3.0], [700.0, 4.0, 5.0]]);
}

#[test]
fn faults_of_pages_have_a_line() {
    for (from, to, line, part) in [
        ("formula 5", "formula 12", Some(8), "no formula 12"),
        ("formula 5", "formula x", Some(6), "`formula x` is no type"),
        ("formula 5", "tabulated n2", Some(6), "`tabulated n2` is no type"),
        ("1.5 0.01 -2", "1.5 0.01 two", Some(8), "`two` is not a number"),
        ("1.5 0.01 -2", "-1", Some(6), "no index at 360 nm"),
        ("0.31 4.6", "4.6", Some(7), "not two ascending wavelengths"),
        ("0.31 4.6", "2 12", Some(7), "from 2000 to 12000 nm"),
        ("    coefficients: 1.5 0.01 -2\n", "", Some(6), "`coefficients` is missing"),
        ("0.83 2E-3", "0.83 x", Some(12), "column 2: `x` is not a number"),
        ("0.36 1E-3", "\n\n        0.36 x", Some(13), "column 2: `x` is not a number"),
        ("0.83 2E-3", "0.83 2E-3 1", Some(12), "3 columns"),
        ("0.36 1E-3", "0.36 -1", Some(11), "k = -1 at 360 nm"),
        ("type: tabulated k", "type: tabulated nk", Some(9), "a second entry of `DATA` gives n"),
        ("type: tabulated k", "kind: tabulated k", Some(9), "`type` is missing"),
        ("\nDATA:", "\nDAT:", None, "no list `DATA`"),
        ("    data: |", "    data: *b", None, "not YAML"),
        ("# a page", "\t- [", None, "not YAML"),
    ] {
        let error = yaml(&COAT.replacen(from, to, 1)).unwrap_err();
        assert!(error.to_string().contains(part) && !error.hint().is_empty(), "{to}: {error}");
        assert!(line.is_none() || error.line == line, "{to}: {error}");
    }
}

/// Lists in lists have an end, and an alias stands for nothing.
#[test]
fn pages_are_bounded() {
    let deep = format!("DATA: {}", "[".repeat(60));
    assert!(matches!(yaml(&deep).unwrap_err().reason, Reason::TooDeep(_)));
    let bomb = "a: &a [x, x]\nb: &b [*a, *a]\nDATA:\n  - *b\n";
    assert_eq!(yaml(bomb).unwrap_err().reason, Reason::Alias);
    let many = format!("DATA:\n{}", "  - type: tabulated k\n".repeat(1000));
    assert_eq!(yaml(&many).unwrap_err(), Reason::TooManyRows.at(18));
}
