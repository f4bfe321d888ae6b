//! Numbers in the buffers of a glTF file. Whatever the file says of them is checked before they are read.

use gltf::accessor::{DataType, Dimensions};

/// The numbers of an accessor, so many to an element; shorter types that are normalised become 0..1 or -1..1.
///
/// # Errors
/// A sentence for people.
pub(crate) fn floats<const N: usize>(
    accessor: &gltf::Accessor<'_>,
    buffers: &[Vec<u8>],
) -> Result<Vec<[f32; N]>, String> {
    if components(accessor.dimensions()) != Some(N) {
        return Err(format!("elements of type {:?}, where {N} numbers are expected", accessor.dimensions()));
    }
    let (kind, normalized) = (accessor.data_type(), accessor.normalized());
    let number = |bytes: &[u8]| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| bytes.get(i).copied().unwrap_or(0));
        let scaled = |value: f32, largest: f32| if normalized { (value / largest).max(-1.0) } else { value };
        match kind {
            DataType::I8 => scaled(f32::from(a as i8), 127.0),
            DataType::U8 => scaled(f32::from(a), 255.0),
            DataType::I16 => scaled(f32::from(i16::from_le_bytes([a, b])), 32767.0),
            DataType::U16 => scaled(f32::from(u16::from_le_bytes([a, b])), 65535.0),
            DataType::U32 => u32::from_le_bytes([a, b, c, d]) as f32,
            DataType::F32 => f32::from_le_bytes([a, b, c, d]),
        }
    };
    let size = kind.size();
    let element = |bytes: &[u8]| std::array::from_fn(|i| number(&bytes[i * size..]));
    let values: Vec<[f32; N]> = elements(accessor, buffers)?.map(element).collect();
    if values.iter().flatten().any(|value| !value.is_finite()) {
        return Err("a number is not finite".to_owned());
    }
    Ok(values)
}

/// The whole numbers of an accessor.
///
/// # Errors
/// A sentence for people.
pub(crate) fn indices(accessor: &gltf::Accessor<'_>, buffers: &[Vec<u8>]) -> Result<Vec<u32>, String> {
    if accessor.dimensions() != Dimensions::Scalar {
        return Err("indices are single numbers".to_owned());
    }
    let number: fn(&[u8]) -> u32 = match accessor.data_type() {
        DataType::U8 => |bytes| u32::from(bytes[0]),
        DataType::U16 => |bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        DataType::U32 => |bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        other => return Err(format!("indices of type {other:?}; they are whole numbers from 0 on")),
    };
    Ok(elements(accessor, buffers)?.map(number).collect())
}

fn components(dimensions: Dimensions) -> Option<usize> {
    match dimensions {
        Dimensions::Scalar => Some(1),
        Dimensions::Vec2 => Some(2),
        Dimensions::Vec3 => Some(3),
        Dimensions::Vec4 => Some(4),
        _ => None,
    }
}

/// The bytes of each element.
fn elements<'a>(
    accessor: &gltf::Accessor<'_>,
    buffers: &'a [Vec<u8>],
) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, String> {
    if accessor.sparse().is_some() {
        return Err(
            "they are stored sparsely, which is not supported: export the mesh without sparse accessors".to_owned()
        );
    }
    let view = accessor.view().ok_or("they have no buffer view")?;
    let count = accessor.count();
    let size = accessor.data_type().size() * components(accessor.dimensions()).ok_or("matrices")?;
    let stride = view.stride().unwrap_or(size);
    let beyond = || format!("{count} elements do not fit into their buffer view");
    let bytes = buffers.get(view.buffer().index()).ok_or("their buffer is missing")?;
    let end = view.offset().checked_add(view.length()).ok_or_else(beyond)?;
    let bytes = bytes.get(view.offset()..end).ok_or_else(beyond)?;
    let bytes = bytes.get(accessor.offset()..).ok_or_else(beyond)?;
    let length = count.checked_sub(1).and_then(|last| last.checked_mul(stride)?.checked_add(size));
    if stride < size || length.is_none_or(|length| length > bytes.len()) {
        return Err(beyond());
    }
    Ok((0..count).map(move |i| &bytes[i * stride..i * stride + size]))
}
