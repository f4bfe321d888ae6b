//! Tables of the reflectance of any smooth surface: over the angle, the index n and the absorption index k (Weidlich and Wilkie 2009, section 3.4.1).

use std::fmt;

use luthier_lut::{Comparison, ErrorStats, Image};
use luthier_optics::fresnel::interface;
use luthier_optics::num_complex::Complex64;
use rayon::prelude::*;

use crate::{AxesError, AxisSpec, Nodes, Quantity, Stored, slices};

/// Points of the scan for errors, along each axis.
const SCAN_POINTS: u32 = 64;
/// Halvings of the climb to the worst error.
const REFINEMENTS: u32 = 8;

/// Axes of a table of reflectances: one of the direction, one of n and one of k, in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FresnelLayout {
    /// Across, down, and from slice to slice.
    axes: [AxisSpec; 3],
}

impl FresnelLayout {
    /// Parses three axes separated by commas, the fastest first, in the grammar of [`AxisSpec`].
    ///
    /// # Errors
    /// [`AxesError::Axis`] for an axis that does not parse, [`AxesError::FresnelAxes`] unless there is one of the direction, one of n and one of k.
    pub fn parse(text: &str, nodes: Nodes) -> Result<Self, AxesError> {
        let axes = AxisSpec::parse_all(text, nodes)?;
        let is_fit = axes.iter().any(|axis| axis.quantity.is_angle())
            && axes.iter().any(|axis| axis.quantity == Quantity::IorN)
            && axes.iter().any(|axis| axis.quantity == Quantity::IorK);
        match *axes.as_slice() {
            [x, y, z] if is_fit => Ok(Self { axes: [x, y, z] }),
            _ => Err(AxesError::FresnelAxes(text.to_owned())),
        }
    }

    /// The axes across, down, and from slice to slice.
    pub fn axes(&self) -> &[AxisSpec; 3] {
        &self.axes
    }

    /// Canonical values of the axes at coordinates.
    fn canonical(&self, u: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k: usize| self.axes[k].canonical_of_coordinate(u[k]))
    }

    /// Cosine, n and k of the canonical values of the axes.
    fn place(&self, canonical: [f64; 3]) -> [f64; 3] {
        let mut place = [0.0; 3];
        for (axis, value) in self.axes.iter().zip(canonical) {
            match axis.quantity {
                Quantity::IorN => place[1] = value,
                Quantity::IorK => place[2] = value,
                _ => place[0] = libm::cos(value).max(0.0),
            }
        }
        place
    }
}

impl fmt::Display for FresnelLayout {
    /// The grammar of [`FresnelLayout::parse`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.axes;
        write!(f, "{x},{y},{z}")
    }
}

/// A table of the reflectance of a smooth surface of index n + ik in air, for unpolarised light. Its fields state the
/// table; the texels follow from them.
///
/// For facets the cosine is that against the half vector.
///
/// ```
/// use luthier_table::{FresnelLayout, FresnelTable, Nodes, Stored};
///
/// let layout = FresnelLayout::parse("cos_theta,ior_n,ior_k", Nodes::Ends)?;
/// let table = FresnelTable { layout, size: [8, 32, 32], stored: Stored::Half };
/// let glass = table.sample(&table.bake(), [1.0, 1.5, 0.0]);
/// assert!((glass - 0.04).abs() < 0.01);
/// # Ok::<(), luthier_table::AxesError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FresnelTable {
    /// Axes and nodes.
    pub layout: FresnelLayout,
    /// Texels along each axis.
    pub size: [u32; 3],
    /// Number type of the texels.
    pub stored: Stored,
}

impl FresnelTable {
    /// The texels of one channel, as a shader reads them: Fresnel's equations at every node. Slices of the third axis lie one below the other.
    pub fn bake(&self) -> Image {
        let [width, rows, slices] = self.size;
        let data = (0..width * rows * slices)
            .into_par_iter()
            .map(|i| {
                let texel = [i % width, i / width % rows, i / (width * rows)];
                let canonical = [0, 1, 2].map(|k: usize| self.layout.axes[k].canonical(texel[k], self.size[k]));
                Self::exact(self.layout.place(canonical)) as f32
            })
            .collect();
        self.stored.quantise(&Image { width, height: rows * slices, channels: 1, data })
    }

    /// The absolute error of reads (linear along each axis, weights of 8 bits) from these texels, over cosines from the
    /// given one on and all n and k of the table. Axis values of the worst point are the cosine, n and k.
    pub fn error(&self, texels: &Image, min_cos: f64) -> ErrorStats {
        let ends = self.layout.axes.map(|axis| axis.ends_from_cosine(min_cos));
        slices::measure(
            SCAN_POINTS,
            ends,
            REFINEMENTS,
            |u| {
                let canonical = self.layout.canonical(u);
                let exact = Self::exact(self.layout.place(canonical));
                let [sampled, ..] = self.read(texels, canonical);
                Comparison { expected: [exact, 0.0, 0.0, 0.0], sampled: [sampled, 0.0, 0.0, 0.0] }
            },
            |u| self.layout.place(self.layout.canonical(u)).to_vec(),
        )
    }

    /// The reflectance as read from the texels for a cosine, n and k.
    pub fn sample(&self, texels: &Image, [cos_theta, n, k]: [f64; 3]) -> f64 {
        let canonical = self.layout.axes.map(|axis| match axis.quantity {
            Quantity::IorN => n,
            Quantity::IorK => k,
            _ => libm::acos(cos_theta),
        });
        self.read(texels, canonical)[0]
    }

    /// The reflectance by Fresnel's equations for a cosine, n and k.
    pub fn exact([cos_theta, n, k]: [f64; 3]) -> f64 {
        interface(Complex64::ONE, Complex64::new(n, k), cos_theta).unpolarised()
    }

    fn read(&self, texels: &Image, canonical: [f64; 3]) -> [f64; 4] {
        let position = [0, 1, 2].map(|k: usize| self.layout.axes[k].position(canonical[k], self.size[k]));
        slices::read(texels, position, self.size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(axes: &str, size: [u32; 3], stored: Stored) -> FresnelTable {
        FresnelTable { layout: FresnelLayout::parse(axes, Nodes::Ends).unwrap(), size, stored }
    }

    #[test]
    fn layouts_have_an_angle_and_both_indices() {
        for text in ["cos_theta,ior_n,ior_k", "ior_k=0..8^2,-theta,ior_n=0.1..4@log"] {
            assert_eq!(FresnelLayout::parse(text, Nodes::CENTRES).unwrap().to_string(), text);
        }
        for text in ["cos_theta,ior_n", "ior_n,ior_k,ior_k", "cos_theta,ior,ior_k", "cos_theta,ior_n=0..5,ior_k", ""] {
            assert!(FresnelLayout::parse(text, Nodes::CENTRES).is_err(), "{text}");
        }
    }

    /// At normal incidence ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), at a grazing angle 1. Brewster's angle of glass: half of the s light, (n^2 - 1)^2/(n^2 + 1)^2.
    #[test]
    fn texels_are_reflectances() {
        let table = table("cos_theta,ior_n=1.5..2.5,ior_k=0..4", [3, 3, 3], Stored::Float);
        let texels = table.bake();
        assert_eq!((texels.width, texels.height, texels.channels), (3, 9, 1));
        for (row, n) in [1.5, 2.0, 2.5].into_iter().enumerate() {
            for (slice, k) in [0.0, 2.0, 4.0].into_iter().enumerate() {
                let y = (3 * slice + row) as u32;
                let f0 = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
                assert!((f64::from(texels.texel(2, y)[0]) - f0).abs() < 1e-7, "{n} {k}");
                assert!((texels.texel(0, y)[0] - 1.0).abs() < 1e-6);
                assert!((table.sample(&texels, [1.0, n, k]) - f0).abs() < 1e-7, "{n} {k}");
            }
        }
        let brewster = 1.0 / (1.0_f64 + 1.5 * 1.5).sqrt();
        let r_s = 1.25 / 3.25;
        assert!((FresnelTable::exact([brewster, 1.5, 0.0]) - 0.5 * r_s * r_s).abs() < 1e-12);
    }

    /// Linear reads err by the square of the step where the function is smooth.
    #[test]
    fn errors_fall_with_the_square_of_the_step() {
        let error = |n: u32| {
            let table = table("cos_theta=0.5..1,ior_n=1.5..3,ior_k=1..4", [n; 3], Stored::Float);
            table.error(&table.bake(), 0.5)
        };
        let (coarse, fine) = (error(9), error(17));
        assert!((3.0..5.0).contains(&(coarse.rms_err / fine.rms_err)), "{coarse:?} {fine:?}");
        assert!((3.0..5.0).contains(&(coarse.max_abs_err / fine.max_abs_err)), "{coarse:?} {fine:?}");
    }
}
