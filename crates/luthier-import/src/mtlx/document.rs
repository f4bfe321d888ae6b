//! MaterialX documents: elements with their places, includes merged.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::ImportError;

/// Most levels of elements.
const LEVELS_MAX: usize = 64;

/// Most files of a document with its includes.
const FILES_MAX: usize = 64;

/// Namespace of `xi:include`.
const XINCLUDE: &str = "http://www.w3.org/2001/XInclude";

/// Reader of files by paths relative to the document.
pub(super) type Files<'a> = &'a dyn Fn(&str) -> std::io::Result<Vec<u8>>;

/// An element.
#[derive(Debug, Clone, Default)]
pub(super) struct Element {
    pub(super) category: String,
    pub(super) attributes: BTreeMap<String, String>,
    pub(super) children: Vec<Arc<Element>>,
    /// Its place, for messages.
    pub(super) place: String,
    /// Folder of its file, relative to the document: empty, or with a slash at its end.
    pub(super) folder: Arc<str>,
    /// Beginning of file names, of the innermost element that says so.
    pub(super) file_prefix: Arc<str>,
    /// Space of colours, of the innermost element that says so.
    pub(super) color_space: Arc<str>,
}

impl Element {
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.get(name).map(String::as_str)
    }

    pub(super) fn name(&self) -> &str {
        self.attribute("name").unwrap_or_default()
    }

    /// The child of a name, of inputs or of anything else.
    pub(super) fn child(&self, name: &str) -> Option<&Arc<Element>> {
        self.children.iter().find(|child| child.name() == name)
    }

    /// The input of a name.
    pub(super) fn input(&self, name: &str) -> Option<&Arc<Element>> {
        self.children.iter().find(|child| child.name() == name && child.category == "input")
    }
}

/// Reads a document with its includes into one root.
pub(super) fn read(label: &str, bytes: &[u8], files: Files<'_>) -> Result<Arc<Element>, ImportError> {
    let mut reading = Reading { files, read: BTreeSet::from([label.to_owned()]) };
    Ok(Arc::new(reading.file("", bytes)?))
}

/// Refuses a root that is no MaterialX of version 1.38 or later.
fn check(root: &Element) -> Result<(), ImportError> {
    let fail = |reason: String| Err(ImportError::Xml { place: root.place.clone(), reason });
    if root.category != "materialx" {
        return fail(format!("the root is `{}`: a MaterialX file has `materialx`", root.category));
    }
    let version = root.attribute("version").unwrap_or_default();
    let minor = version.strip_prefix("1.").and_then(|minor| minor.split('.').next()?.parse::<u32>().ok());
    if minor.is_some_and(|minor| minor < 38) {
        return fail(format!("version {version} is older than 1.38: write the file anew with MaterialX"));
    }
    Ok(())
}

struct Reading<'a> {
    files: Files<'a>,
    read: BTreeSet<String>,
}

/// Properties that children have from their parents.
#[derive(Clone)]
struct Inherited {
    folder: Arc<str>,
    file_prefix: Arc<str>,
    color_space: Arc<str>,
}

impl Reading<'_> {
    /// A file, `path` empty for the document itself.
    fn file(&mut self, path: &str, bytes: &[u8]) -> Result<Element, ImportError> {
        let place = |line: u32| if path.is_empty() { format!("line {line}") } else { format!("{path}, line {line}") };
        let fail = |line: u32, reason: String| ImportError::Xml { place: place(line), reason };
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let line = bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
            fail(line as u32, "the text is not UTF-8".to_owned())
        })?;
        let document = roxmltree::Document::parse(text)
            .map_err(|error| fail(error.pos().row, format!("no well-formed XML: {}", plain(&error))))?;
        let folder = path.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
        let inherited = Inherited { folder: folder.into(), file_prefix: "".into(), color_space: "lin_rec709".into() };
        let starts: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
        let line = |node: roxmltree::Node<'_, '_>| starts.partition_point(|&at| at < node.range().start) as u32 + 1;
        let root = self.element(document.root_element(), &inherited, 1, &|node| place(line(node)))?;
        check(&root)?;
        Ok(root)
    }

    fn element(
        &mut self,
        node: roxmltree::Node<'_, '_>,
        inherited: &Inherited,
        level: usize,
        place: &dyn Fn(roxmltree::Node<'_, '_>) -> String,
    ) -> Result<Element, ImportError> {
        let fail = |reason: String| ImportError::Xml { place: place(node), reason };
        if level > LEVELS_MAX {
            return Err(fail(format!("elements lie in more than {LEVELS_MAX} others")));
        }
        let attributes: BTreeMap<String, String> =
            node.attributes().map(|found| (found.name().to_owned(), found.value().to_owned())).collect();
        let own = |name: &str, outer: &Arc<str>| {
            attributes.get(name).map_or_else(|| outer.clone(), |own| own.as_str().into())
        };
        let inherited = Inherited {
            folder: inherited.folder.clone(),
            file_prefix: own("fileprefix", &inherited.file_prefix),
            color_space: own("colorspace", &inherited.color_space),
        };
        let mut children = Vec::new();
        for child in node.children().filter(roxmltree::Node::is_element) {
            if child.tag_name().namespace() == Some(XINCLUDE) {
                let href = child.attribute("href").unwrap_or_default();
                let path = joined(&inherited.folder, href);
                if !self.read.insert(path.clone()) {
                    continue;
                }
                if self.read.len() > FILES_MAX {
                    return Err(ImportError::Xml {
                        place: place(child),
                        reason: format!("more than {FILES_MAX} files are included"),
                    });
                }
                let bytes = (self.files)(&path)
                    .map_err(|error| ImportError::Xml { place: place(child), reason: format!("`{href}`: {error}") })?;
                children.extend(self.file(&path, &bytes)?.children);
            } else {
                children.push(Arc::new(self.element(child, &inherited, level + 1, place)?));
            }
        }
        Ok(Element {
            category: node.tag_name().name().to_owned(),
            attributes,
            children,
            place: place(node),
            folder: inherited.folder,
            file_prefix: inherited.file_prefix,
            color_space: inherited.color_space,
        })
    }
}

/// The reason of a parser without the place that stands at its end.
fn plain(error: &roxmltree::Error) -> String {
    let text = error.to_string();
    text.rsplit_once(" at ").map_or(text.clone(), |(reason, _)| reason.to_owned())
}

/// A path beside another, `.` and `..` taken out where they can be.
pub(super) fn joined(folder: &str, path: &str) -> String {
    let path = path.replace('\\', "/");
    let whole = if path.starts_with('/') { path } else { format!("{folder}{path}") };
    let mut parts: Vec<&str> = Vec::new();
    for part in whole.split('/') {
        match part {
            "." | "" => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            _ => parts.push(part),
        }
    }
    let root = if whole.starts_with('/') { "/" } else { "" };
    format!("{root}{}", parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_joined() {
        assert_eq!(joined("a/b/", "../../../c/./d.png"), "../c/d.png");
        assert_eq!(joined("", "x\\y.png"), "x/y.png");
        assert_eq!(joined("a/", "/etc/passwd"), "/etc/passwd");
    }
}
