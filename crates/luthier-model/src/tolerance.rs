//! Tolerances of the error of a shader against its f64 twin.

/// The largest error of one share that a shader is held to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Its name.
    pub name: &'static str,
    /// Largest error, relative to the brightest channel of the reference, or to the floor of the page where that is brighter.
    pub limit: f64,
    /// Reason for the limit.
    pub reason: &'static str,
}

impl Tolerance {
    /// The tolerance of a shader without tables.
    pub const NO_TABLE: Self = Self { name: "NO_TABLE", limit: 0.0, reason: "The shader reads no table." };
}

/// The tolerances of a model, by the source of the error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Tolerance of the error that tables bring.
    pub table: Tolerance,
    /// Tolerance of f32 arithmetic in the form `baked`, where a sampler filters exactly.
    pub baked: Tolerance,
    /// Tolerance of f32 arithmetic in the form `full`.
    pub full: Tolerance,
    /// Tolerance of f32 arithmetic in the form `baked`, where a sampler has weights of 8 bits.
    pub filtered: Tolerance,
}

pub(crate) const LOBE_TABLE: Tolerance = Tolerance {
    name: "LOBE_TABLE",
    limit: 2.5e-3,
    reason: "A Fresnel row is within 5e-4 of the reflectance F, and light of lower layers passes the interface twice, with a factor of 1 - F each time. \
             If a material asks for a table of the distribution, that table is interpolated between slope parameters. The values at the foot \
             of a lobe are then a few thousandths off, and still brighter than the floor.",
};

pub(crate) const PHASE_TABLE: Tolerance = Tolerance {
    name: "PHASE_TABLE",
    limit: 1.5e-3,
    reason: "A phase row replaces a cosine by straight lines between 256 nodes, and stores it in half floats of up to 2.",
};

pub(crate) const ENERGY_TABLE: Tolerance = Tolerance {
    name: "ENERGY_TABLE",
    limit: 2.5e-3,
    reason: "A lobe is a closed form times its energy, and the energy is a product of values from the `fgd` and `escape` tables. The tables have 64 nodes \
             along each axis. An error of 1e-3 in one of the factors is an error of 1e-3 in the lobe.",
};

pub(crate) const ROW_TABLE: Tolerance = Tolerance {
    name: "ROW_TABLE",
    limit: 1e-2,
    reason: "A Fresnel row is within 5e-4 of the reflectance F, which is 1% of 0.04. Rows of lobes are half floats, \
             off by up to 2.4e-4 of themselves: at the foot of a Gaussian lobe a change of its width changes the value fifteen times as much.",
};

pub(crate) const LOBE_READ: Tolerance = Tolerance {
    name: "LOBE_READ",
    limit: 2e-4,
    reason: "The reason of `LAYERS_IN_F32` holds. In addition, a distribution table, where a material asks for one, stores sixteenth roots: \
             a rounding error of the coordinate or of the filter grows sixteenfold.",
};

pub(crate) const LOBES_IN_F32: Tolerance = Tolerance {
    name: "LOBES_IN_F32",
    limit: 3.5e-4,
    reason: "A sampler finds its place in a row in f32, to some millionths of the distance between rows. Where a lobe fades to almost nothing between the \
             first two rows, beyond 88°, what is left of it is off by more than a hundred times as much. Elsewhere values are within 2e-4: a Gaussian \
             lobe is a power with an exponent of up to 1025, which multiplies the rounding of its base.",
};

pub(crate) const LAYERS_IN_F32: Tolerance = Tolerance {
    name: "LAYERS_IN_F32",
    limit: 5e-5,
    reason: "Every layer adds some tens of roundings of 6e-8 each. They enter an exponential, whose argument can reach ten or more \
             before its value is below the floor.",
};

pub(crate) const BEAMS_IN_F32: Tolerance = Tolerance {
    name: "BEAMS_IN_F32",
    limit: 2e-5,
    reason: "The rounding errors are those of one layer. The exponents of the lobes reach 2e6, but their bases are computed without cancellation.",
};

pub(crate) const STATISTICS_IN_F32: Tolerance = Tolerance {
    name: "STATISTICS_IN_F32",
    limit: 2e-5,
    reason: "Every layer adds some tens of roundings of 6e-8 each, and two powers convert a slope parameter to a variance and back. No exponential \
             and no root of a stored value makes the errors larger.",
};

pub(crate) const PHONG_IN_F32: Tolerance = Tolerance {
    name: "PHONG_IN_F32",
    limit: 1e-5,
    reason: "The shader evaluates one exponential of a product whose factors have an error of 1e-7 each. The error of the value is that error times \
             the argument, and beyond an argument of 1 the value falls faster than the error grows.",
};

pub(crate) const FILTERED_BY_HARDWARE: Tolerance = Tolerance {
    name: "FILTERED_BY_HARDWARE",
    limit: 4e-3,
    reason: "A filter in hardware has weights of 8 bits, and f32 rounds a coordinate to one side or the other of a step: a part of 256 of the difference of two \
             texels. A GPU was seen to round filtered half floats to half floats again, off by 2.4e-4 of themselves. Values are products of several.",
};

pub(crate) const FILTERED_BELOW_A_COAT: Tolerance = Tolerance {
    name: "FILTERED_BELOW_A_COAT",
    limit: 2e-2,
    reason: "The reason of `FILTERED_BY_HARDWARE` holds. In addition, light of lower layers is multiplied by (1 - F)², which is small beyond 88° while F is near 1: \
             as in `FRESNEL_UNDER_A_COAT`. Tables of the distribution store sixteenth roots, and a Gaussian lobe changes fifteen times as much as its width.",
};
