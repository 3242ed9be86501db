//! Wavefront OBJ: `v` (with colours after the coordinates), `vt`, `f` (polygons, negative indices,
//! vertices that come later), `mtllib`, `usemtl`. Lines, curves and smoothing groups are passed over.

use std::borrow::Cow;

use glam::{DVec3, Vec2, vec2};

use super::builder::{Builder, byte};
use super::error::{Fault, Found};
use super::limits::{MAX_CORNERS, MAX_TRIANGLES, MAX_VERTICES};
use super::picture::Material;
use super::text::{Lines, integer, number, quote, words};
use super::{Side, mtl};

/// No texture coordinate.
const NONE: u32 = u32::MAX;

/// A face before its indices can be checked: vertices may follow it.
struct Face {
    first: usize,
    line: usize,
    material: u32,
}

#[derive(Default)]
struct Reader {
    out: Builder,
    colours: Vec<[f64; 3]>,
    uvs: Vec<Vec2>,
    /// Vertex and texture coordinate per corner.
    corners: Vec<(u32, u32)>,
    faces: Vec<Face>,
    triangles: usize,
    /// Names of `out.materials`.
    names: Vec<Vec<u8>>,
    material: u32,
}

pub(crate) fn read(bytes: &[u8], side: &dyn Side) -> Result<Builder, Found> {
    if bytes[..bytes.len().min(4096)].contains(&0) {
        let why = "it holds zero bytes, so it is not text".to_owned();
        return Err(Fault::NotThis { format: "OBJ", why }.into());
    }
    let mut reader = Reader::default();
    reader.out.materials.push(Material::default());
    reader.names.push(Vec::new());
    let mut lines = Lines::new(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    while let Some((at, line)) = lines.next() {
        let mut line = Cow::Borrowed(line);
        while let Some(start) = line.strip_suffix(b"\\") {
            let next = lines.next().map_or(&b""[..], |(_, next)| next);
            line = Cow::Owned([start, b" ", next].concat());
        }
        reader.line(at, &line, side)?;
    }
    reader.finish()
}

impl Reader {
    fn line(&mut self, at: usize, line: &[u8], side: &dyn Side) -> Result<(), Found> {
        let mut rest = words(line);
        match rest.next() {
            Some(b"v") => self.vertex(at, rest),
            Some(b"vt") => self.texture_point(at, rest),
            Some(b"f" | b"fo") => self.face(at, rest),
            Some(b"mtllib") => self.library(argument(line), side),
            Some(b"usemtl") => {
                self.material = self.material_of(argument(line));
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn vertex<'a>(
        &mut self,
        at: usize,
        words: impl Iterator<Item = &'a [u8]>,
    ) -> Result<(), Found> {
        let mut numbers = [0.0; 7];
        let mut count = 0;
        for word in words.take(7) {
            numbers[count] = number(word, "a coordinate", at)?;
            count += 1;
        }
        if count < 3 {
            let mend = "a vertex has three coordinates; mend the line or export the scan again";
            let found = String::new();
            let what = "a coordinate";
            return Err(Found::line(at, Fault::NotANumber { what, found, mend }));
        }
        let [x, y, z, ..] = numbers;
        self.out
            .vertex(DVec3::new(x, y, z))
            .map_err(|f| Found::line(at, f))?;
        match count {
            6 => self.colours.push([numbers[3], numbers[4], numbers[5]]),
            7 => self.colours.push([numbers[4], numbers[5], numbers[6]]),
            _ => {}
        }
        Ok(())
    }

    fn texture_point<'a>(
        &mut self,
        at: usize,
        mut words: impl Iterator<Item = &'a [u8]>,
    ) -> Result<(), Found> {
        if self.uvs.len() >= MAX_VERTICES {
            let count = self.uvs.len() as u64 + 1;
            return Err(Found::line(at, Fault::ManyVertices(count)));
        }
        let mut next = || match words.next() {
            Some(word) => number(word, "a texture coordinate", at),
            None => Ok(0.0),
        };
        let (u, v) = (next()?, next()?);
        // OBJ counts v from the lower edge.
        self.uvs.push(vec2(u as f32, 1.0 - v as f32));
        Ok(())
    }

    fn face<'a>(&mut self, at: usize, words: impl Iterator<Item = &'a [u8]>) -> Result<(), Found> {
        let first = self.corners.len();
        for word in words {
            let mut parts = word.split(|&b| b == b'/');
            let count = self.out.positions.len();
            let vertex = index(parts.next().unwrap_or(word), at, count, "vertex")?;
            let uv = match parts.next() {
                None | Some(b"") => NONE,
                Some(part) => index(part, at, self.uvs.len(), "texture coordinate")?,
            };
            self.corners.push((vertex, uv));
            if self.corners.len() - first > MAX_CORNERS {
                let corners = self.corners.len() - first;
                return Err(Found::line(at, Fault::ManyCorners(corners)));
            }
        }
        let corners = self.corners.len() - first;
        if corners < 3 {
            return Err(Found::line(at, Fault::FewCorners(corners)));
        }
        self.triangles += corners - 2;
        if self.triangles > MAX_TRIANGLES {
            let triangles = self.triangles as u64;
            return Err(Found::line(at, Fault::ManyTriangles(triangles)));
        }
        self.faces.push(Face {
            first,
            line: at,
            material: self.material,
        });
        Ok(())
    }

    fn library(&mut self, name: &[u8], side: &dyn Side) -> Result<(), Found> {
        // The whole rest of the line is one name, blanks and all; failing that, several names.
        let whole = String::from_utf8_lossy(name).into_owned();
        let mut found = Vec::new();
        match side.open(&whole) {
            Some(bytes) => found.push(bytes),
            None => {
                for word in words(name) {
                    found.extend(side.open(&String::from_utf8_lossy(word)));
                }
            }
        }
        if found.is_empty() {
            self.out.note(format!(
                "the materials {} are not beside the scan, so the head gets no texture from it",
                quote(name)
            ));
        }
        for bytes in found {
            mtl::read(&bytes, &mut self.out, &mut self.names, side)?;
        }
        Ok(())
    }

    fn material_of(&mut self, name: &[u8]) -> u32 {
        // The last material of a name counts, as libraries may come twice.
        self.names.iter().rposition(|n| n == name).unwrap_or(0) as u32
    }

    fn finish(mut self) -> Result<Builder, Found> {
        let end = self.corners.len();
        let ends: Vec<usize> = self
            .faces
            .iter()
            .skip(1)
            .map(|f| f.first)
            .chain([end])
            .collect();
        let (mut corners, mut uvs) = (Vec::new(), Vec::new());
        for (face, end) in self.faces.iter().zip(ends) {
            corners.clear();
            uvs.clear();
            let fail = |fault| Found::line(face.line, fault);
            for &(vertex, uv) in &self.corners[face.first..end] {
                corners.push(self.out.index(i64::from(vertex)).map_err(|_| {
                    fail(out_of_range(
                        "vertex",
                        i64::from(vertex) + 1,
                        self.out.positions.len(),
                    ))
                })?);
                uvs.push(match self.uvs.get(uv as usize) {
                    Some(&at) => at,
                    None if uv == NONE => Vec2::splat(f32::NAN),
                    None => {
                        let index = i64::from(uv) + 1;
                        return Err(fail(out_of_range(
                            "texture coordinate",
                            index,
                            self.uvs.len(),
                        )));
                    }
                });
            }
            self.out.face(&corners, &uvs, face.material).map_err(fail)?;
        }
        if self.colours.len() == self.out.positions.len() {
            // Some programs write 0..255.
            let bytes = self.colours.iter().flatten().any(|&c| c > 1.0);
            let scale = if bytes { 1.0 / 255.0 } else { 1.0 };
            self.out.colours = self
                .colours
                .iter()
                .map(|c| c.map(|c| byte(c * scale)))
                .collect();
        } else if !self.colours.is_empty() {
            let (some, all) = (self.colours.len(), self.out.positions.len());
            self.out.note(format!(
                "{some} of {all} vertices have a colour, so the colours are not used"
            ));
        }
        Ok(self.out)
    }
}

/// The rest of a line after its keyword, trimmed.
fn argument(line: &[u8]) -> &[u8] {
    let line = line.trim_ascii();
    let end = line
        .iter()
        .position(u8::is_ascii_whitespace)
        .unwrap_or(line.len());
    line[end..].trim_ascii()
}

fn out_of_range(what: &'static str, index: i64, count: usize) -> Fault {
    Fault::OutOfRange { what, index, count }
}

/// An index from 1, or from the end where negative, as one from 0.
fn index(word: &[u8], line: usize, count: usize, what: &'static str) -> Result<u32, Found> {
    let given = integer(word, "a corner of a face", line)?;
    let absolute = match given {
        0 => None,
        1.. => Some(given - 1),
        _ => Some(count as i64 + given).filter(|&i| i >= 0),
    };
    absolute
        .and_then(|i| u32::try_from(i).ok())
        .filter(|&i| i != NONE)
        .ok_or_else(|| Found::line(line, out_of_range(what, given, count)))
}
