//! Unknowns of a fit, in one vector.

/// Nodes of shapes over the view.
pub(super) const NODES: usize = 6;

/// Parameters of one lobe: shifts, logarithms of the mean width, half the logarithms of the ratio of the widths over the squared sine of the
/// view, each at the nodes; and the angle whose squared sine is the tail.
#[derive(Debug, Clone)]
pub(super) struct Start(pub(super) [Vec<f64>; 3], pub(super) f64);

impl Start {
    /// A lobe of one width at all views.
    pub(super) fn new(width: f64, tail: f64) -> Self {
        Self([vec![0.0; NODES], vec![libm::log(width); NODES], vec![0.0; NODES]], tail)
    }

    /// Wider by a factor, up to 1.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.0[1].iter_mut().for_each(|log| *log = (*log + libm::log(factor)).min(0.0));
        scaled
    }
}

/// Parameters of one lobe in the vector of all.
pub(super) const PER_LOBE: usize = 3 * NODES + 1;

/// Parameters of lobes and remainder in one vector.
pub(super) fn parameters(lobes: Vec<Start>, wide: [f64; 2]) -> Vec<f64> {
    let mut parameters = Vec::new();
    for Start(rows, tail) in lobes {
        rows.iter().for_each(|row| parameters.extend(row));
        parameters.push(tail);
    }
    parameters.extend(wide);
    parameters
}
