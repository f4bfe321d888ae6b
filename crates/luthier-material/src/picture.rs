//! Pictures that a file names, and how their texels are read.

/// A picture file and how it is read: `"p.png"`, or `{ image, channel, srgb, scale, transform }`.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureRef {
    /// Path relative to the file that names it.
    pub path: String,
    /// The channel that is taken alone; `None` if the file names no channel.
    pub channel: Option<Channel>,
    /// Whether colours are stored by the sRGB curve; `None` if the file does not say, which counts as linear.
    pub srgb: Option<bool>,
    /// Factor on the linear texels; of normals, on their slope.
    pub scale: f64,
    /// Place of the picture on the surface; `None` if it lies as the texture coordinates do.
    pub transform: Option<UvTransform>,
}

/// A channel of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// Red.
    R,
    /// Green.
    G,
    /// Blue.
    B,
    /// Alpha, which never has a curve.
    A,
}

/// A change of texture coordinates: scaled, then turned, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvTransform {
    /// Added last.
    pub offset: [f64; 2],
    /// Radians, from u towards v.
    pub rotation: f64,
    /// Factors on u and v; 2 repeats the picture twice as often.
    pub scale: [f64; 2],
}

/// Meaning of the texels of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TexelUse {
    /// One number.
    Number,
    /// A colour.
    Color,
    /// A normal: RGB is (normal + 1) / 2.
    Normal,
    /// A direction in the plane: RG.
    Direction,
}

impl PictureRef {
    /// A picture that is read as it is.
    pub fn plain(path: impl Into<String>) -> Self {
        Self { path: path.into(), channel: None, srgb: None, scale: 1.0, transform: None }
    }

    /// Whether the texels are read as the file has them, up to their curve.
    pub fn keeps_texels(&self) -> bool {
        self.channel.is_none() && self.scale == 1.0
    }

    /// The picture in words, for manifests: its path, and what is done to its texels.
    pub fn label(&self) -> String {
        let mut label = self.path.clone();
        if let Some(channel) = self.channel {
            label += &format!(", channel {}", channel.name());
        }
        if self.scale != 1.0 {
            label += &format!(", times {}", self.scale);
        }
        label
    }
}

impl Channel {
    /// All channels.
    pub const ALL: [Self; 4] = [Self::R, Self::G, Self::B, Self::A];

    /// Its letter in files.
    pub fn name(self) -> &'static str {
        ["r", "g", "b", "a"][self.index()]
    }

    /// Its place among the four of a texel.
    pub fn index(self) -> usize {
        self as usize
    }
}

impl UvTransform {
    /// The two rows that make texture coordinates of the picture of (u, v, 1).
    ///
    /// ```
    /// use luthier_material::UvTransform;
    /// let turned = UvTransform { offset: [0.5, 0.0], rotation: std::f64::consts::FRAC_PI_2, scale: [2.0, 1.0] };
    /// let [[a, b, c], _] = turned.matrix();
    /// assert!((a.abs() < 1e-15) && (b + 1.0).abs() < 1e-15 && c == 0.5);
    /// ```
    pub fn matrix(&self) -> [[f64; 3]; 2] {
        let (sin, cos) = libm::sincos(self.rotation);
        let ([su, sv], [u, v]) = (self.scale, self.offset);
        [[cos * su, -sin * sv, u], [sin * su, cos * sv, v]]
    }
}

/// A scalar map with values in 0..=1.
#[derive(Debug, Clone, PartialEq)]
pub enum VariationSource {
    /// Fractal gradient noise that repeats.
    Noise {
        /// Seed of the noise.
        seed: u32,
        /// Lattice cells of the first octave along one repeat.
        frequency: f64,
        /// Octaves, each of twice the frequency and half the weight.
        octaves: u32,
    },
    /// A picture.
    Image(PictureRef),
}

impl VariationSource {
    /// The image that it names, if it is one.
    pub(crate) fn image(&self) -> Option<&PictureRef> {
        match self {
            Self::Image(picture) => Some(picture),
            Self::Noise { .. } => None,
        }
    }
}
