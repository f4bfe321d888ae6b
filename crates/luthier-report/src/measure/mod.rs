//! Measurement: the subject of a judgement, both sides of a comparison, directions, statistics, causes of errors, and the scan of its tables.

pub(crate) mod causes;
pub(crate) mod device;
pub(crate) mod directions;
pub(crate) mod memory;
pub(crate) mod readers;
pub(crate) mod references;
pub(crate) mod scan;
pub(crate) mod seen;
pub(crate) mod statistics;
pub(crate) mod subject;
pub(crate) mod table_terms;
