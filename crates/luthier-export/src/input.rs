//! Reads files that users name: only regular files, of a size that fits their purpose. Reading a pipe would wait for its writer, and a device has no
//! end.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// Bytes of the longest text that is read: materials, scenes, indices, directions, reports.
pub const TEXT_MAX: u64 = 64 << 20;

/// Bytes of the largest image that is read: maps, environments, tables.
const IMAGE_MAX: u64 = 1 << 30;

/// Bytes of the largest file of a mesh: many times the triangles that pictures show.
const MESH_MAX: u64 = 256 << 20;

/// The bytes of an image.
///
/// # Errors
/// Those of the system, and what is no regular file of bounded size.
pub fn image(path: &Path) -> io::Result<Vec<u8>> {
    read(path, IMAGE_MAX)
}

/// The bytes of a mesh, or of a buffer of one.
///
/// # Errors
/// Those of the system, and what is no regular file of bounded size.
pub fn mesh(path: &Path) -> io::Result<Vec<u8>> {
    read(path, MESH_MAX)
}

/// The bytes of a file that another one in `folder` names, if it lies below `root`: `..` is taken out by the letters of the path, as links are followed.
///
/// # Errors
/// Those of the system, what is no regular file of bounded size, and a file outside of `root`.
pub fn beside(root: &Path, folder: &Path, path: &str) -> io::Result<Vec<u8>> {
    let here = |path: &Path| if path.as_os_str().is_empty() { PathBuf::from(".") } else { path.to_owned() };
    let place = plain(&here(folder).join(path))?;
    if place.starts_with(plain(&here(root))?) {
        return mesh(&place);
    }
    Err(io::Error::other("it is outside of the folder of the file: name a folder that has both by --root"))
}

/// An absolute path without `..`.
fn plain(path: &Path) -> io::Result<PathBuf> {
    let mut plain = PathBuf::new();
    for part in std::path::absolute(path)?.components() {
        if part == Component::ParentDir {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    Ok(plain)
}

/// The bytes of what should be a text.
///
/// # Errors
/// Those of the system, and what is no regular file of bounded size.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    read(path, TEXT_MAX)
}

/// A text.
///
/// # Errors
/// Those of the system, and what is no regular file of bounded size in UTF-8.
pub fn text(path: &Path) -> io::Result<String> {
    String::from_utf8(bytes(path)?).map_err(|error| {
        let (bytes, valid) = (error.as_bytes(), error.utf8_error().valid_up_to());
        let reason = match bytes {
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "the file is UTF-16: save it as UTF-8".to_owned(),
            _ => {
                let line = bytes[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
                format!("line {line} is not UTF-8: save the file as UTF-8")
            }
        };
        io::Error::new(ErrorKind::InvalidData, reason)
    })
}

fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    // This comes before opening, because opening a pipe waits for its other end.
    let kind = std::fs::metadata(path).map_err(plainly)?;
    if kind.is_dir() {
        return Err(io::Error::other("it is a folder, not a file"));
    }
    if !kind.is_file() {
        return Err(io::Error::other("it is a pipe or a device, not a file"));
    }
    if kind.len() > most {
        return Err(too_large(most));
    }
    let mut bytes = Vec::with_capacity(kind.len() as usize);
    // The limit holds for reading, too: files can grow, and some systems have files that are longer than they state.
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(most)) } else { Ok(bytes) }
}

fn too_large(most: u64) -> io::Error {
    io::Error::other(format!("it is larger than {} MiB", most >> 20))
}

/// Gives the most common error words that do not depend on the system.
fn plainly(error: io::Error) -> io::Error {
    if error.kind() == ErrorKind::NotFound { io::Error::new(ErrorKind::NotFound, "no such file") } else { error }
}
