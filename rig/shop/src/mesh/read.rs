//! A file as a scan: tells formats apart by their first bytes, then by the name's ending, refuses what
//! is too large before it is in memory, and hands the bytes to the format's reader.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path};

use super::error::{Fault, Found, Place, ScanError};
use super::limits::{MAX_FILE_BYTES, MAX_SIDE_FILE_BYTES};
use super::scan::Scan;
use super::{glb, obj, ply, stl};

/// A scan, and what was strange about its file without making it useless.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The scan.
    pub scan: Scan,
    /// One sentence each, for the user.
    pub notes: Vec<String>,
}

/// The files beside a scan: materials and pictures that it names.
pub trait Side {
    /// The bytes of the file that the scan calls `name`, or none where there is no such file.
    fn open(&self, name: &str) -> Option<Vec<u8>>;
}

/// No files beside the scan: it is all in one piece.
impl Side for () {
    fn open(&self, _: &str) -> Option<Vec<u8>> {
        None
    }
}

/// A folder. Only what is in it or below is opened: a scan from a stranger names no other files.
impl Side for Path {
    fn open(&self, name: &str) -> Option<Vec<u8>> {
        let relative = name.replace('\\', "/");
        let relative = Path::new(&relative);
        let inside = |c: Component<'_>| matches!(c, Component::Normal(_) | Component::CurDir);
        // Exporters write paths of their own machine: then the bare name is looked for.
        let drive = name.as_bytes().get(1) == Some(&b':');
        let relative = if relative.components().all(inside) && !drive {
            relative
        } else {
            Path::new(relative.file_name()?)
        };
        let file = File::open(self.join(relative)).ok()?;
        if !file.metadata().ok()?.is_file() {
            return None;
        }
        let mut bytes = Vec::new();
        file.take(MAX_SIDE_FILE_BYTES)
            .read_to_end(&mut bytes)
            .ok()?;
        Some(bytes)
    }
}

/// What a scan file can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Format {
    Obj,
    Ply,
    Stl,
    /// glTF 2.0, as one binary file or as JSON.
    Glb,
}

impl Format {
    /// By the first bytes where they tell, else by the ending of the name.
    #[must_use]
    pub fn of(path: &Path, head: &[u8]) -> Option<Self> {
        if head.starts_with(b"glTF") {
            return Some(Self::Glb);
        }
        if head.starts_with(b"ply\n") || head.starts_with(b"ply\r") {
            return Some(Self::Ply);
        }
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("obj") => Some(Self::Obj),
            Some("ply") => Some(Self::Ply),
            Some("stl") => Some(Self::Stl),
            Some("glb" | "gltf" | "vrm") => Some(Self::Glb),
            _ => None,
        }
    }
}

impl Scan {
    /// The scan in the file at `path`. [`read`] also returns what is worth a note.
    ///
    /// # Errors
    /// When it is no such file or not a usable mesh.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ScanError> {
        read(path).map(|reading| reading.scan)
    }
}

/// The scan in the file at `path`.
///
/// # Errors
/// When it is no such file or not a usable mesh.
pub fn read(path: impl AsRef<Path>) -> Result<Reading, ScanError> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let bytes = load(path).map_err(|found| found.in_file(&name))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let Some(format) = Format::of(path, &bytes) else {
        return Err(Fault::UnknownFormat.at(&name, Place::Whole));
    };
    read_bytes(format, &name, &bytes, folder)
}

/// The scan in `bytes`, which errors call `name`.
///
/// # Errors
/// When they are not a usable mesh of that format.
pub fn read_bytes(
    format: Format,
    name: &str,
    bytes: &[u8],
    side: &(impl Side + ?Sized),
) -> Result<Reading, ScanError> {
    // One instance of each reader for all callers.
    let side: &dyn Side = &Borrowed(side);
    let builder = match format {
        _ if bytes.is_empty() => Err(Fault::EmptyFile.into()),
        Format::Obj => obj::read(bytes, side),
        Format::Ply => ply::read(bytes, side),
        Format::Stl => stl::read(bytes),
        Format::Glb => glb::read(bytes, side),
    };
    builder
        .and_then(|builder| builder.finish().map_err(Found::from))
        .map_err(|found| found.in_file(name))
}

struct Borrowed<'a, S: Side + ?Sized>(&'a S);

impl<S: Side + ?Sized> Side for Borrowed<'_, S> {
    fn open(&self, name: &str) -> Option<Vec<u8>> {
        self.0.open(name)
    }
}

/// How much of a large file is looked at before the rest is loaded.
const PEEK_BYTES: u64 = 64 << 10;

fn load(path: &Path) -> Result<Vec<u8>, Found> {
    let io = |e: io::Error| Found::from(Fault::Io(e));
    let mut file = File::open(path).map_err(io)?;
    let metadata = file.metadata().map_err(io)?;
    if metadata.is_dir() {
        return Err(io(io::Error::other("it is a folder")));
    }
    let mut bytes = Vec::new();
    (&mut file)
        .take(PEEK_BYTES)
        .read_to_end(&mut bytes)
        .map_err(io)?;
    let size = metadata.len();
    // Files that say how many triangles they hold are refused by that, which helps more.
    match Format::of(path, &bytes) {
        Some(Format::Stl) => stl::refuse_large(&bytes, size)?,
        Some(Format::Ply) => ply::refuse_large(&bytes)?,
        Some(_) => {}
        None if bytes.is_empty() => return Err(Fault::EmptyFile.into()),
        None => return Err(Fault::UnknownFormat.into()),
    }
    if size > MAX_FILE_BYTES {
        return Err(Fault::HugeFile(size).into());
    }
    bytes.reserve(
        usize::try_from(size)
            .unwrap_or(0)
            .saturating_sub(bytes.len()),
    );
    // A pipe has no size beforehand.
    file.take(MAX_FILE_BYTES)
        .read_to_end(&mut bytes)
        .map_err(io)?;
    Ok(bytes)
}
