//! Tables of energy compensation: albedos of rough surfaces after one facet, over roughness, angle and index.

mod container;
mod measure;
mod preset;

use std::f64::consts::SQRT_2;

use luthier_lut::Image;
use luthier_optics::dielectric_albedo::{
    InterfaceAlbedo, JointMasking, albedo_avg, albedo_dir, reflected_avg, reflected_dir,
};
use luthier_optics::stack::Distribution;
use rayon::prelude::*;

use crate::{AxesError, AxisSpec, Nodes, Quantity, Stored};

pub use container::EnergyContainer;
pub use measure::EnergyDomain;
pub use preset::{EnergyFile, EnergyPreset};

luthier_lut::named! {
    /// The surface whose albedo a table holds.
    pub enum EnergySurface("energy surface") {
        /// Facets that reflect everything: metals. Their colour enters by the average Fresnel (Kulla and Conty 2017) or by
        /// the factor `1 + f0 (1 - E)/E` (Turquin 2019).
        Reflector = "reflector",
        /// An interface between transparent media with exact Fresnel, lit from the rarer side.
        FromRarer = "from-rarer",
        /// An interface between transparent media lit from the denser side, with total reflection.
        FromDenser = "from-denser",
    }
}

luthier_lut::named! {
    /// Content of one channel of a table of energy.
    pub enum EnergyValue("energy value") {
        /// E: light reflected and transmitted.
        Albedo = "albedo",
        /// 1 - E: the share of multiple scattering.
        Loss = "loss",
        /// (1 - E)/E: the added part of a factor on the single scattering (Turquin 2019).
        Compensation = "compensation",
        /// Light reflected.
        Reflected = "reflected",
        /// 1 less the light reflected.
        Unreflected = "unreflected",
        /// Light transmitted.
        Transmitted = "transmitted",
    }
}

impl EnergyValue {
    /// The content for an albedo.
    pub fn of(self, albedo: InterfaceAlbedo) -> f64 {
        let total = albedo.total();
        match self {
            Self::Albedo => total.min(1.0),
            Self::Loss => (1.0 - total).max(0.0),
            Self::Compensation => ((1.0 - total) / total).max(0.0),
            Self::Reflected => albedo.reflected,
            Self::Unreflected => 1.0 - albedo.reflected,
            Self::Transmitted => albedo.transmitted,
        }
    }
}

/// A table of energy compensation. Its fields state the table; the texels follow from them.
///
/// ```
/// use luthier_table::{EnergyPreset, EnergyTable};
///
/// let cycles = EnergyPreset::named("cycles").unwrap();
/// let table = EnergyTable { size: [4, 4, 1], ..cycles.tables(&cycles.files[0])[0].clone() };
/// let texels = table.bake();
/// assert!(texels.data.iter().all(|albedo| (0.0..=1.0).contains(albedo)));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyTable {
    /// Slope distribution.
    pub distribution: Distribution,
    /// Masking and shadowing.
    pub masking: JointMasking,
    /// Surface of the albedo.
    pub surface: EnergySurface,
    /// Axes and nodes: the fastest in memory first.
    pub layout: EnergyLayout,
    /// Nodes along each axis; 1 for a missing axis.
    pub size: [u32; 3],
    /// Content of each channel, one to four.
    pub values: Vec<EnergyValue>,
    /// Number type of the texels.
    pub stored: Stored,
    /// Whether texels are moved by a sixteenth of their second differences, so that reads between them err to both sides alike.
    pub balanced: bool,
    /// Distance from 1 below which an index lets all light pass: some renderers treat such an interface as a plane. 0
    /// for none.
    pub clear_within: f64,
}

/// Axes of a table of energy: one of the micro-surface, at most one of the direction, and one of the index if the
/// surface has one.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyLayout {
    axes: Vec<AxisSpec>,
}

impl EnergyLayout {
    /// Parses one to three axes, separated by commas, the fastest in memory first, in the grammar of [`AxisSpec`].
    ///
    /// # Errors
    /// [`AxesError::Axis`] for an axis that does not parse, [`AxesError::EnergyAxes`] unless there is one of the micro-surface and at most one
    /// each of the direction and the index.
    pub fn parse(text: &str, nodes: Nodes) -> Result<Self, AxesError> {
        let axes = AxisSpec::parse_all(text, nodes)?;
        let [slopes, angles, indices] = [Quantity::is_slope, Quantity::is_angle, Quantity::is_index]
            .map(|is: fn(Quantity) -> bool| axes.iter().filter(|axis| is(axis.quantity)).count());
        let is_fit = slopes == 1 && angles <= 1 && indices <= 1;
        if is_fit { Ok(Self { axes }) } else { Err(AxesError::EnergyAxes(text.to_owned())) }
    }

    /// The axes, the fastest in memory first.
    pub fn axes(&self) -> &[AxisSpec] {
        &self.axes
    }

    /// The axes with lowest and highest values.
    #[must_use]
    pub fn clamped(mut self, limits: &[[f64; 2]]) -> Self {
        for (axis, [floor, ceiling]) in self.axes.iter_mut().zip(limits) {
            (axis.floor, axis.ceiling) = (*floor, *ceiling);
        }
        self
    }

    /// Cosine, alpha and index of a place. `canonical` returns the canonical value of each axis by its number; a
    /// missing axis has none.
    fn place(&self, canonical: impl Fn(usize, &AxisSpec) -> f64) -> Place {
        let mut place = Place { cos_theta: None, alpha: 0.0, ior: None };
        for (k, axis) in self.axes.iter().enumerate() {
            let value = canonical(k, axis);
            if axis.quantity.is_angle() {
                place.cos_theta = Some(libm::cos(value).max(0.0));
            } else if axis.quantity.is_slope() {
                place.alpha = value;
            } else {
                place.ior = Some(value);
            }
        }
        place
    }
}

impl std::fmt::Display for EnergyLayout {
    /// The grammar of [`EnergyLayout::parse`].
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (k, axis) in self.axes.iter().enumerate() {
            write!(f, "{}{axis}", if k > 0 { "," } else { "" })?;
        }
        Ok(())
    }
}

/// A place where a table is evaluated. Without a cosine, it stands for the average over the hemisphere.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    cos_theta: Option<f64>,
    alpha: f64,
    ior: Option<f64>,
}

impl EnergyTable {
    /// The texels as they are stored, slices of the third axis one below the other.
    ///
    /// Values at the nodes are within 1e-6 (averages 2e-6). They are moved if [`balanced`](Self::balanced), then
    /// rounded. Deterministic, whatever the number of threads.
    pub fn bake(&self) -> Image {
        let [nx, ny, nz] = self.size;
        let texels: Vec<Vec<f64>> = (0..nx * ny * nz)
            .into_par_iter()
            .map(|i| {
                let texel = [i % nx, i / nx % ny, i / nx / ny];
                let albedo = self.at_texel(texel);
                self.values.iter().map(|value| value.of(albedo)).collect()
            })
            .collect();
        let texels = if self.balanced { balance(self.size, &texels) } else { texels };
        let data = texels.iter().flatten().map(|value| *value as f32).collect();
        let image = Image { width: nx, height: ny * nz, channels: self.values.len() as u32, data };
        self.stored.quantise(&image)
    }

    /// The albedo at a node.
    fn at_texel(&self, texel: [u32; 3]) -> InterfaceAlbedo {
        self.exact(self.layout.place(|k, axis| axis.canonical(texel[k], self.size[k])))
    }

    /// The albedo itself.
    fn exact(&self, place: Place) -> InterfaceAlbedo {
        let Self { distribution, masking, surface, .. } = *self;
        let Place { cos_theta, alpha, ior } = place;
        let ior = ior.unwrap_or(SQRT_2);
        let eta_ti = match surface {
            EnergySurface::Reflector => {
                let reflected = match cos_theta {
                    Some(cos) => reflected_dir(distribution, masking, alpha, cos, |_| 1.0),
                    None => reflected_avg(distribution, masking, alpha, |_| 1.0),
                };
                return InterfaceAlbedo { reflected, transmitted: 0.0 };
            }
            EnergySurface::FromRarer => ior,
            EnergySurface::FromDenser => 1.0 / ior,
        };
        match cos_theta {
            _ if ior - 1.0 < self.clear_within => InterfaceAlbedo { reflected: 0.0, transmitted: 1.0 },
            Some(cos) => albedo_dir(distribution, masking, alpha, eta_ti, cos),
            None => albedo_avg(distribution, masking, alpha, eta_ti),
        }
    }
}

/// Moves texels so that linear interpolation errs evenly: [`luthier_lut::balance`] over three axes.
fn balance(size: [u32; 3], texels: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let [nx, ny, nz] = size.map(|n| n as usize);
    let strides = [1, nx, nx * ny];
    let mut balanced = texels.to_vec();
    for (i, texel) in balanced.iter_mut().enumerate() {
        let at = [i % nx, i / nx % ny, i / nx / ny];
        for (c, value) in texel.iter_mut().enumerate() {
            let here = *value;
            let mut curvature = 0.0;
            for ((at, n), stride) in at.into_iter().zip([nx, ny, nz]).zip(strides) {
                if at > 0 && at + 1 < n {
                    curvature += texels[i - stride][c] - 2.0 * here + texels[i + stride][c];
                }
            }
            *value = (here - curvature / 16.0).clamp(0.0, here.max(1.0));
        }
    }
    balanced
}

#[cfg(test)]
mod tests;
