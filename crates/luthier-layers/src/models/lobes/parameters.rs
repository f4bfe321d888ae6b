//! Unknowns of a fit, in one vector.

use super::ellipse::Numbers;

/// Nodes of shapes over the view.
pub(super) const NODES: usize = 6;

/// The unknowns of one lobe: rows over the nodes, and an angle whose squared sine is the tail.
///
/// The first three rows are the [`Numbers`] of an ellipse without c, for all azimuths of the eye. Further rows add waves of the second order over
/// the azimuth to these numbers and to c: half a turn takes a stack to itself. All waves but those of the shift are scaled by the squared sine of
/// the view, because the normal has no azimuth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Basis {
    /// Ellipses in the plane of the eye, alike at all azimuths.
    Isotropic,
    /// Ellipses in the tangents of a stack that is its own mirror image in both.
    Mirrored,
    /// Ellipses in tangents.
    Turned,
}

/// A row that has a part in a number of an ellipse.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub(super) number: usize,
    pub(super) row: usize,
    pub(super) factor: f64,
}

/// Rows of the shift and of the mean width.
pub(super) const SHIFT: usize = 0;
pub(super) const MEAN: usize = 1;

impl Basis {
    /// Number of rows.
    pub(super) fn rows(self) -> usize {
        match self {
            Self::Isotropic => 3,
            Self::Mirrored => 7,
            Self::Turned => 12,
        }
    }

    /// Parameters of one lobe in the vector of all.
    pub(super) fn per_lobe(self) -> usize {
        self.rows() * NODES + 1
    }

    /// Whether a fit pulls a row to 0: all but the rows of the widths along the normal.
    pub(super) fn is_small(self, row: usize) -> bool {
        match self {
            Self::Isotropic => row != MEAN,
            Self::Mirrored | Self::Turned => ![MEAN, 2, 10].contains(&row),
        }
    }

    /// The terms at a view: the squared sine of its angle, and cosine and sine of twice its azimuth.
    pub(super) fn terms(self, sin_sq: f64, [cos, sin]: [f64; 2]) -> Vec<Term> {
        let (long, across) = (sin_sq * cos, sin_sq * sin);
        let of = [
            (0, 1.0),
            (1, 1.0),
            (2, 1.0),
            (0, cos),
            (1, long),
            (2, long),
            (3, across),
            (0, sin),
            (1, across),
            (2, across),
            (3, 1.0),
            (3, long),
        ];
        of[..self.rows()].iter().enumerate().map(|(row, &(number, factor))| Term { number, row, factor }).collect()
    }
}

/// One lobe: its rows, and the angle of the tail.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) tail: f64,
}

impl Start {
    /// A lobe of one centred ellipse at all views.
    pub(super) fn new(basis: Basis, [_, mean, b, c]: Numbers, tail: f64) -> Self {
        let mut rows = vec![vec![0.0; NODES]; basis.rows()];
        rows[MEAN] = vec![mean; NODES];
        if basis != Basis::Isotropic {
            rows[2] = vec![b; NODES];
        }
        if let Some(row) = rows.get_mut(10) {
            *row = vec![c; NODES];
        }
        Self { rows, tail }
    }

    /// Wider by a factor, up to 1.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.rows[MEAN].iter_mut().for_each(|log| *log = (*log + libm::log(factor)).min(0.0));
        scaled
    }
}

/// Parameters of lobes and remainder in one vector.
pub(super) fn parameters(lobes: Vec<Start>, wide: [f64; 2]) -> Vec<f64> {
    let mut parameters = Vec::new();
    for Start { rows, tail } in lobes {
        rows.iter().for_each(|row| parameters.extend(row));
        parameters.push(tail);
    }
    parameters.extend(wide);
    parameters
}
