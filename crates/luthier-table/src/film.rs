//! Tables of thin-film iridescence: the reflected colour of an interface, over angle and thickness.

use std::fmt;

use luthier_lut::{Comparison, ErrorStats, Image, Scan, WeightBits, balance, bilinear, measure_scan};
use luthier_optics::Rgb;
use luthier_optics::color::{Color, WavelengthNode};
use luthier_optics::fresnel::{FilmLayer, coated};
use luthier_optics::num_complex::Complex64;
use rayon::prelude::*;

use crate::{AxesError, AxisSpec, Nodes, Quantity, Stored};

/// Fraction bits of the sampler's weights.
const WEIGHTS: WeightBits = WeightBits::Fixed(8);
/// Points of the scan for errors, along each axis.
const SCAN_POINTS: u32 = 128;
/// Halvings of the climb to the worst error.
const REFINEMENTS: u32 = 8;

/// Axes of a table of a film: one of the direction, one of the thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmLayout {
    /// Across, then down.
    axes: [AxisSpec; 2],
}

impl FilmLayout {
    /// Parses two axes separated by a comma, the one across first, in the grammar of [`AxisSpec`].
    ///
    /// # Errors
    /// [`AxesError::Axis`] for an axis that does not parse, [`AxesError::FilmAxes`] unless there is one of the direction and one of the thickness.
    pub fn parse(text: &str, nodes: Nodes) -> Result<Self, AxesError> {
        let axes = AxisSpec::parse_all(text, nodes)?;
        let is_fit = axes.iter().any(|axis| axis.quantity.is_angle())
            && axes.iter().any(|axis| axis.quantity == Quantity::ThicknessNm);
        match *axes.as_slice() {
            [x, y] if is_fit => Ok(Self { axes: [x, y] }),
            _ => Err(AxesError::FilmAxes(text.to_owned())),
        }
    }

    /// The axes across and down.
    pub fn axes(&self) -> &[AxisSpec; 2] {
        &self.axes
    }

    /// Canonical values of both axes at coordinates.
    fn canonical(&self, u: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k: usize| self.axes[k].canonical_of_coordinate(u[k]))
    }

    /// Cosine and thickness of the canonical values of both axes.
    fn place(&self, canonical: [f64; 2]) -> [f64; 2] {
        let [theta, thickness_nm] =
            if self.axes[0].quantity.is_angle() { canonical } else { [canonical[1], canonical[0]] };
        [libm::cos(theta).max(0.0), thickness_nm]
    }
}

impl fmt::Display for FilmLayout {
    /// The grammar of [`FilmLayout::parse`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.axes[0], self.axes[1])
    }
}

/// A table of the reflectance of a plane interface under a thin film, in linear Rec.709. Its fields state the table;
/// the texels follow from them.
///
/// For facets the cosine is that against the half vector.
///
/// ```
/// use luthier_optics::{color::Color, num_complex::Complex64};
/// use luthier_table::{FilmLayout, FilmTable, Nodes, Stored};
///
/// let layout = FilmLayout::parse("cos_theta,thickness_nm=0..500", Nodes::Ends)?;
/// let (film, below) = (Complex64::new(1.33, 0.0), Complex64::ONE);
/// let soap = FilmTable { above: 1.0, film, below, color: Color::Spectral, layout, size: [4, 6], stored: Stored::Half };
/// let texels = soap.bake();
/// assert_eq!(soap.thicknesses(), [0.0, 500.0]);
/// assert!(texels.texel(3, 0)[1] < 1e-3); // no film reflects nothing at normal incidence
/// # Ok::<(), luthier_table::AxesError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FilmTable {
    /// Index above.
    pub above: f64,
    /// Index of the film, complex where it absorbs.
    pub film: Complex64,
    /// Index below: a dielectric or a metal.
    pub below: Complex64,
    /// How spectra become colours. [`Color::Spectral`] may leave 0..1, as real colours do: fixed-point texels are clamped.
    pub color: Color,
    /// Axes and nodes.
    pub layout: FilmLayout,
    /// Texels across and down.
    pub size: [u32; 2],
    /// Number type of the texels.
    pub stored: Stored,
}

impl FilmTable {
    /// The texels of three channels, as a shader reads them.
    ///
    /// The values are the exact sum of all interference (Airy) at every wavelength of [`Color`]. They are moved by a
    /// sixteenth of their second differences, so that reads between them err to both sides alike, then rounded.
    ///
    /// The spectral steps of 5 nm limit the thickness: up to 5 um the integral is within 1e-3 of one in steps of 1 nm.
    pub fn bake(&self) -> Image {
        let [width, height] = self.size;
        let wavelengths = self.color.nodes();
        let texels: Vec<Rgb> = (0..width * height)
            .into_par_iter()
            .map(|i| {
                let texel = [i % width, i / width];
                let canonical = [0, 1].map(|k: usize| self.layout.axes[k].canonical(texel[k], self.size[k]));
                self.rgb(&wavelengths, self.layout.place(canonical))
            })
            .collect();
        let data = texels.into_iter().flatten().map(|value| value as f32).collect();
        self.stored.quantise(&balance(&Image { width, height, channels: 3, data }, f64::NEG_INFINITY))
    }

    /// The absolute error of reads (bilinear, 8-bit weights) from these texels, in every channel, over cosines from the
    /// given one on and all thicknesses. Axis values of the worst point are the cosine and the thickness.
    pub fn error(&self, texels: &Image, min_cos: f64) -> ErrorStats {
        let wavelengths = self.color.nodes();
        let ends = self.layout.axes.map(|axis| axis.ends_from_cosine(min_cos));
        let scan = Scan {
            points: [SCAN_POINTS; 2],
            from: ends.map(|[from, _]| from),
            to: ends.map(|[_, to]| to),
            nodes: self.size.map(|n| n - 1),
            refinements: REFINEMENTS,
        };
        measure_scan(
            &scan,
            |u| {
                let at = self.layout.canonical(u);
                let position = [0, 1].map(|k: usize| self.layout.axes[k].position(at[k], self.size[k]));
                let [r, g, b] = self.rgb(&wavelengths, self.layout.place(at));
                let mut sampled = bilinear(texels, position, WEIGHTS);
                sampled[3] = 0.0;
                Comparison { expected: [r, g, b, 0.0], sampled }
            },
            |u| self.layout.place(self.layout.canonical(u)).to_vec(),
        )
    }

    /// Least and largest thickness of the table, nm.
    pub fn thicknesses(&self) -> [f64; 2] {
        let axis = self.layout.axes.into_iter().find(|axis| !axis.quantity.is_angle());
        axis.map_or([0.0; 2], |axis| [axis.min, axis.max])
    }

    /// The largest error of all channels of a read from these texels, as a function of cosine and thickness.
    pub fn errors(&self, texels: &Image) -> impl Fn(f64, f64) -> f64 {
        let wavelengths = self.color.nodes();
        move |cos_theta, thickness_nm| {
            let canonical =
                |axis: &AxisSpec| if axis.quantity.is_angle() { libm::acos(cos_theta) } else { thickness_nm };
            let axes = self.layout.axes;
            let position = [0, 1].map(|k: usize| axes[k].position(canonical(&axes[k]), self.size[k]));
            let read = bilinear(texels, position, WEIGHTS);
            let exact = self.rgb(&wavelengths, [cos_theta, thickness_nm]);
            exact.iter().zip(read).fold(0.0, |worst, (a, b)| (a - b).abs().max(worst))
        }
    }

    fn rgb(&self, wavelengths: &[WavelengthNode], [cos_theta, thickness_nm]: [f64; 2]) -> Rgb {
        let above = Complex64::new(self.above, 0.0);
        let mut rgb = [0.0; 3];
        for node in wavelengths {
            let film = FilmLayer { ior: self.film, waves: thickness_nm / node.wavelength_nm };
            let reflectance = coated(above, &[film], self.below, cos_theta).unpolarised();
            for (sum, weight) in rgb.iter_mut().zip(node.weight) {
                *sum += weight * reflectance;
            }
        }
        rgb
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::film_color::BelcourBarla;
    use luthier_optics::fresnel::interface;

    use super::*;

    fn soap(axes: &str, size: [u32; 2]) -> FilmTable {
        FilmTable {
            above: 1.0,
            film: Complex64::new(1.33, 0.0),
            below: Complex64::new(1.0, 0.0),
            color: Color::Spectral,
            layout: FilmLayout::parse(axes, Nodes::Ends).unwrap(),
            size,
            stored: Stored::Float,
        }
    }

    #[test]
    fn layouts_have_an_angle_and_a_thickness() {
        for text in ["cos_theta,thickness_nm", "thickness_nm=100..400,-cos_theta^2"] {
            assert_eq!(FilmLayout::parse(text, Nodes::CENTRES).unwrap().to_string(), text);
        }
        for text in ["cos_theta", "cos_theta,alpha", "thickness_nm,thickness_nm", "cos_theta,thickness_nm=0..9000"] {
            assert!(FilmLayout::parse(text, Nodes::CENTRES).is_err(), "{text}");
        }
    }

    /// Without a film, Fresnel's reflectance. A quarter wave of soap at 555 nm reflects its two 2 % in phase: in full (2 r/(1 + r^2))^2, r = .33/2.33.
    #[test]
    fn texels_are_films() {
        let table = soap("cos_theta,thickness_nm=0..417.293", [5, 5]);
        let nodes = Color::Spectral.nodes();
        let [_, green, _] = table.rgb(&nodes, [1.0, 555.0 / 1.33 / 4.0]);
        assert!((green / 0.07712 - 1.0).abs() < 0.03, "{green}: green is a band, with negative ends");
        let glass = FilmTable { below: Complex64::new(1.5, 0.0), ..table.clone() };
        let bare = interface(Complex64::ONE, glass.below, 0.5).unpolarised();
        let rgb = glass.rgb(&nodes, [0.5, 0.0]);
        assert!(rgb.iter().all(|value| (value - bare).abs() < 1e-9), "{rgb:?} {bare}");
        // Corners are not moved; a table with its axes exchanged holds the same texels elsewhere.
        let texels = table.bake();
        let end = table.rgb(&nodes, [1.0, 417.293]);
        assert!(texels.texel(4, 4).iter().zip(end).all(|(a, b)| (f64::from(*a) - b).abs() < 1e-6));
        let turned = soap("thickness_nm=0..417.293,-cos_theta", [5, 5]).bake();
        assert!((0..25).all(|i| texels.texel(i % 5, i / 5) == turned.texel(i / 5, 4 - i % 5)));
    }

    /// The closed form of Belcour and Barla with its error, .005 to .01 for this film (see `film_color`).
    #[test]
    fn agrees_with_the_gaussian_fits() {
        let table = soap("cos_theta,thickness_nm", [2, 2]);
        let nodes = Color::Spectral.nodes();
        for (cos, thickness_nm) in [(1.0, 300.0), (0.5, 700.0), (0.9, 1100.0)] {
            let fits = BelcourBarla { above: 1.0, film: 1.33, thickness_nm, below: Complex64::ONE, orders: 2 };
            let found = table.rgb(&nodes, [cos, thickness_nm]);
            let near = found.iter().zip(fits.rgb(cos)).all(|(a, b)| (a - b).abs() < 0.01);
            assert!(near, "{cos} {thickness_nm}: {found:?} {:?}", fits.rgb(cos));
        }
    }

    #[test]
    fn errors_fall_with_the_square_of_the_size() {
        let error = |n: u32| {
            let table = soap("cos_theta=0.2..1,thickness_nm=0..800", [n, n]);
            table.error(&table.bake(), 0.2)
        };
        let (coarse, fine) = (error(17), error(33));
        assert!((3.0..5.5).contains(&(coarse.rms_err / fine.rms_err)), "{coarse:?} {fine:?}");
        assert!(fine.rms_err < 0.004 && fine.worst.at[0] >= 0.2 - 1e-9, "{fine:?}");
    }

    /// Thickness bounds the steps of the spectral integral: against steps of 1 nm by straight lines between the weights.
    #[test]
    fn steps_of_the_spectrum_are_fine_enough() {
        let table = soap("cos_theta,thickness_nm", [2, 2]);
        let nodes = Color::Spectral.nodes();
        let mut fine = Vec::new();
        for pair in nodes.windows(2) {
            for k in 0..5 {
                let t = f64::from(k) / 5.0;
                let mix = |a: f64, b: f64| a + (b - a) * t;
                fine.push(WavelengthNode {
                    wavelength_nm: mix(pair[0].wavelength_nm, pair[1].wavelength_nm),
                    weight: [0, 1, 2].map(|c: usize| mix(pair[0].weight[c], pair[1].weight[c]) / 5.0),
                });
            }
        }
        for thickness_nm in [800.0, 2000.0, 5000.0] {
            let (a, b) = (table.rgb(&nodes, [1.0, thickness_nm]), table.rgb(&fine, [1.0, thickness_nm]));
            let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-3, "{thickness_nm}: {off:e}");
        }
    }
}
