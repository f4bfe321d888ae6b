//! Measurement: the subject of a judgement, its terms as shaders read them, directions, statistics, and the scan of its tables.

pub(crate) mod device;
pub(crate) mod directions;
pub(crate) mod scan;
pub(crate) mod seen;
pub(crate) mod statistics;
pub(crate) mod subject;
pub(crate) mod table_terms;
