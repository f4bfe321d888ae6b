//! Numbers in the buffers of a glTF file. Every statement about them is checked before they are read.

use super::buffers::Buffers;
use super::document::{Accessor, Document};
use crate::{MeshError, TRIANGLES_MAX};

/// Most elements of an accessor.
const ELEMENTS_MAX: usize = 3 * TRIANGLES_MAX;

/// Types of numbers, by their codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Kind {
    fn of(code: u32) -> Result<Self, String> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(format!("numbers of the type {code}, which glTF does not have")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number in the first bytes; shorter types that are normalised become 0..1 or -1..1.
    fn number(self, bytes: &[u8], is_normalised: bool) -> f32 {
        let (value, largest) = match (self, bytes) {
            (Self::I8, &[a, ..]) => (f32::from(a as i8), 127.0),
            (Self::U8, &[a, ..]) => (f32::from(a), 255.0),
            (Self::I16, &[a, b, ..]) => (f32::from(i16::from_le_bytes([a, b])), 32767.0),
            (Self::U16, &[a, b, ..]) => (f32::from(u16::from_le_bytes([a, b])), 65535.0),
            (Self::U32, &[a, b, c, d, ..]) => return u32::from_le_bytes([a, b, c, d]) as f32,
            (Self::F32, &[a, b, c, d, ..]) => return f32::from_le_bytes([a, b, c, d]),
            _ => return 0.0,
        };
        if is_normalised { (value / largest).max(-1.0) } else { value }
    }
}

/// Owner of the numbers that are read, for messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Owner<'a> {
    /// The numbers, such as positions.
    pub(super) what: &'static str,
    pub(super) mesh: &'a str,
}

impl Owner<'_> {
    pub(super) fn refuse(self, reason: impl Into<String>) -> MeshError {
        MeshError::Accessor { what: self.what, mesh: self.mesh.to_owned(), reason: reason.into() }
    }

    pub(super) fn check_count(self, values: usize, positions: usize) -> Result<(), MeshError> {
        if values == positions { Ok(()) } else { Err(self.refuse(format!("{values} for {positions} positions"))) }
    }
}

/// Accessors and the bytes behind them.
#[derive(Clone, Copy)]
pub(super) struct Numbers<'a> {
    pub(super) document: &'a Document,
    pub(super) buffers: &'a Buffers<'a>,
}

impl<'a> Numbers<'a> {
    pub(super) fn accessor(self, index: usize, owner: Owner<'_>) -> Result<&'a Accessor, MeshError> {
        self.document.accessors.get(index).ok_or_else(|| owner.refuse(format!("accessor {index} is not there")))
    }

    /// The numbers of an accessor, `N` to an element. Shorter types that are normalised become 0..1 or -1..1.
    pub(super) fn floats<const N: usize>(self, index: usize, owner: Owner<'_>) -> Result<Vec<[f32; N]>, MeshError> {
        let accessor = self.accessor(index, owner)?;
        if components(&accessor.shape) != Some(N) {
            let shape = &accessor.shape;
            return Err(owner.refuse(format!("elements of type `{shape}`, where {N} numbers are expected")));
        }
        let kind = Kind::of(accessor.component_type).map_err(|reason| owner.refuse(reason))?;
        let size = kind.size();
        let bytes = self.elements(accessor, N * size, owner)?;
        let elements = bytes.chunks_exact(N * size);
        let elements =
            elements.map(|bytes| std::array::from_fn(|i| kind.number(&bytes[i * size..], accessor.normalized)));
        Ok(elements.collect())
    }

    /// The whole numbers of an accessor.
    pub(super) fn indices(self, index: usize, owner: Owner<'_>) -> Result<Vec<u32>, MeshError> {
        let accessor = self.accessor(index, owner)?;
        if components(&accessor.shape) != Some(1) {
            return Err(owner.refuse("indices are single numbers"));
        }
        let kind = Kind::of(accessor.component_type).map_err(|reason| owner.refuse(reason))?;
        whole(kind, &self.elements(accessor, kind.size(), owner)?).map_err(|reason| owner.refuse(reason))
    }

    /// The bytes of all elements, without gaps. They are zeros without a buffer view; sparse elements replace some.
    fn elements(self, accessor: &Accessor, size: usize, owner: Owner<'_>) -> Result<Vec<u8>, MeshError> {
        let count = accessor.count;
        if count > ELEMENTS_MAX {
            return Err(
                owner.refuse(format!("{count} elements; at most {ELEMENTS_MAX} are read: export a coarser mesh"))
            );
        }
        let mut all = match accessor.buffer_view {
            Some(view) => self.gathered(view, accessor.byte_offset, count, size, owner)?,
            None => vec![0; count * size],
        };
        let Some(sparse) = &accessor.sparse else { return Ok(all) };
        if sparse.count > count {
            return Err(owner.refuse(format!("{} sparse elements of {count}", sparse.count)));
        }
        let kind = Kind::of(sparse.indices.component_type).map_err(|reason| owner.refuse(reason))?;
        let (places, values) = (&sparse.indices, &sparse.values);
        let places = self.gathered(places.buffer_view, places.byte_offset, sparse.count, kind.size(), owner)?;
        let values = self.gathered(values.buffer_view, values.byte_offset, sparse.count, size, owner)?;
        let places = whole(kind, &places).map_err(|reason| owner.refuse(reason))?;
        for (place, value) in places.into_iter().zip(values.chunks_exact(size)) {
            let element = all.chunks_exact_mut(size).nth(place as usize);
            let element = element.ok_or_else(|| owner.refuse(format!("the sparse element {place} of {count}")))?;
            element.copy_from_slice(value);
        }
        Ok(all)
    }

    /// Elements of a buffer view, without the gaps between them.
    fn gathered(
        self,
        view: usize,
        offset: usize,
        count: usize,
        size: usize,
        owner: Owner<'_>,
    ) -> Result<Vec<u8>, MeshError> {
        let view = self.document.buffer_views.get(view);
        let view = view.ok_or_else(|| owner.refuse("their buffer view is not there"))?;
        let buffer = self.buffers.get(view.buffer)?.ok_or_else(|| owner.refuse("their buffer is not there"))?;
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| buffer.get(view.byte_offset..end)?.get(offset..));
        let stride = view.byte_stride.unwrap_or(size);
        let length = match count.checked_sub(1) {
            Some(last) => last.checked_mul(stride).and_then(|start| start.checked_add(size)),
            None => Some(0),
        };
        let bytes = bytes
            .filter(|bytes| stride >= size && length.is_some_and(|length| length <= bytes.len()))
            .ok_or_else(|| owner.refuse(format!("{count} elements do not fit into their buffer view")))?;
        Ok((0..count).flat_map(|i| &bytes[i * stride..i * stride + size]).copied().collect())
    }
}

fn whole(kind: Kind, bytes: &[u8]) -> Result<Vec<u32>, String> {
    Ok(match kind {
        Kind::U8 => bytes.iter().map(|&byte| byte.into()).collect(),
        Kind::U16 => bytes.as_chunks().0.iter().map(|pair| u16::from_le_bytes(*pair).into()).collect(),
        Kind::U32 => bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect(),
        other => return Err(format!("indices of type {other:?}; they are whole numbers from 0 on")),
    })
}

/// Numbers to an element.
fn components(shape: &str) -> Option<usize> {
    match shape {
        "SCALAR" => Some(1),
        "VEC2" => Some(2),
        "VEC3" => Some(3),
        "VEC4" => Some(4),
        _ => None,
    }
}
