//! Results of jobs, as values and as bytes.

use std::any::Any;
use std::fmt;

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Result of a job: a function of the inputs whose hash is its [`Key`](crate::Key).
pub struct Artefact {
    value: Box<dyn Any + Send + Sync>,
    encode: fn(&dyn Any) -> Option<Vec<u8>>,
}

impl Artefact {
    pub(crate) fn new<T: Any + Send + Sync + Serialize>(value: T) -> Self {
        Self { value: Box::new(value), encode: |value| postcard::to_stdvec(value.downcast_ref::<T>()?).ok() }
    }

    /// Reads the bytes of [`Self::encode`] back; `None` for bytes of another type.
    pub(crate) fn decode<T: Any + Send + Sync + Serialize + DeserializeOwned>(bytes: &[u8]) -> Option<Self> {
        match postcard::take_from_bytes::<T>(bytes) {
            Ok((value, [])) => Some(Self::new(value)),
            _ => None,
        }
    }

    /// The value, of its type.
    pub(crate) fn get<T: Any>(&self) -> Option<&T> {
        self.value.downcast_ref()
    }

    /// The result as bytes, in the form of postcard: [`Task::decode`](crate::Task::decode) reads them.
    pub fn encode(&self) -> Option<Vec<u8>> {
        (self.encode)(self.value.as_ref())
    }
}

impl fmt::Debug for Artefact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Artefact")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_the_value() {
        let value = (vec![0.1f64, f64::MIN_POSITIVE, -0.0], "a".to_owned(), Some([1.5f32; 2]));
        let bytes = Artefact::new(value.clone()).encode().unwrap();
        let read = Artefact::decode::<(Vec<f64>, String, Option<[f32; 2]>)>(&bytes).unwrap();
        assert_eq!(read.get(), Some(&value));
        assert_eq!(read.get::<u32>(), None);
        assert!(Artefact::decode::<(Vec<f64>, String, Option<[f32; 2]>)>(&bytes[1..]).is_none());
        let longer = [bytes.as_slice(), &[0]].concat();
        assert!(Artefact::decode::<(Vec<f64>, String, Option<[f32; 2]>)>(&longer).is_none());
    }
}
