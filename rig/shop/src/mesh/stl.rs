//! STL, binary and text. The format repeats each corner per triangle; corners with the same
//! coordinates become one vertex. Normals and the colours of dialects are not read.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::DVec3;

use super::builder::Builder;
use super::error::{Fault, Found};
use super::limits::MAX_TRIANGLES;
use super::text::{Lines, number, quote, words};

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

/// A binary file whose header already says too much, before it is loaded; `size` of the whole file.
pub(crate) fn refuse_large(head: &[u8], size: u64) -> Result<(), Fault> {
    match count(head) {
        Some(count) if fits(count, size) && count as usize > MAX_TRIANGLES => {
            Err(Fault::ManyTriangles(u64::from(count)))
        }
        _ => Ok(()),
    }
}

fn count(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(80..HEADER_BYTES)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

/// Whether a file of `size` bytes has room for that many binary triangles.
fn fits(count: u32, size: u64) -> bool {
    HEADER_BYTES as u64 + u64::from(count) * TRIANGLE_BYTES as u64 <= size
}

pub(crate) fn read(bytes: &[u8]) -> Result<Builder, Found> {
    let declared = count(bytes);
    let size = bytes.len() as u64;
    // Binary files, too, may begin with `solid`: the size tells, then zero bytes do.
    let exact = declared.is_some_and(|n| size == HEADER_BYTES as u64 + u64::from(n) * 50);
    let solid = bytes.trim_ascii_start().starts_with(b"solid");
    let text = solid && !exact && !bytes[..bytes.len().min(512)].contains(&0);
    match declared {
        _ if text => read_text(bytes),
        Some(count) if fits(count, size) => read_binary(bytes, count),
        Some(count) if u64::from(count) < 2 * size => {
            Err(Found::byte(bytes.len(), Fault::Truncated("its triangles")))
        }
        None if !solid && bytes.contains(&0) => {
            Err(Found::byte(bytes.len(), Fault::Truncated("its header")))
        }
        _ => {
            let why = "it has neither `solid` at its beginning nor a count that fits its size";
            let why = why.to_owned();
            Err(Fault::NotThis { format: "STL", why }.into())
        }
    }
}

/// Hashes three coordinates: quick, and no attacker gains by collisions in a local file.
#[derive(Default)]
pub(crate) struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 29)
    }

    fn write(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.write_u32(u32::from(b));
        }
    }

    fn write_u32(&mut self, word: u32) {
        self.0 = (self.0.rotate_left(21) ^ u64::from(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// Which vertex a corner is.
#[derive(Default)]
struct Corners {
    known: HashMap<(u32, u32, u32), u32, BuildHasherDefault<Mix>>,
}

impl Corners {
    fn vertex(&mut self, out: &mut Builder, at: DVec3) -> Result<u32, Fault> {
        // Adding zero makes -0 and 0 the same.
        let [x, y, z] = (at.as_vec3() + 0.0).to_array().map(f32::to_bits);
        if let Some(&vertex) = self.known.get(&(x, y, z)) {
            return Ok(vertex);
        }
        out.vertex(at)?;
        let vertex = (out.positions.len() - 1) as u32;
        self.known.insert((x, y, z), vertex);
        Ok(vertex)
    }
}

fn read_binary(bytes: &[u8], count: u32) -> Result<Builder, Found> {
    if count as usize > MAX_TRIANGLES {
        return Err(Found::byte(80, Fault::ManyTriangles(u64::from(count))));
    }
    let mut out = Builder::default();
    let mut known = Corners::default();
    known.known.reserve(count as usize / 2);
    let triangles = bytes[HEADER_BYTES..].chunks_exact(TRIANGLE_BYTES);
    for (i, triangle) in triangles.take(count as usize).enumerate() {
        let float = |place: usize| {
            let b = &triangle[place..place + 4];
            f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        };
        let mut corners = [0; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            // The normal takes the first 12 bytes.
            let place = 12 + 12 * k;
            let at = DVec3::new(float(place), float(place + 4), float(place + 8));
            let byte = HEADER_BYTES + i * TRIANGLE_BYTES + place;
            *corner = known
                .vertex(&mut out, at)
                .map_err(|f| Found::byte(byte, f))?;
        }
        out.face(&corners, &[], 0)?;
    }
    Ok(out)
}

fn read_text(bytes: &[u8]) -> Result<Builder, Found> {
    let mut out = Builder::default();
    let mut known = Corners::default();
    let mut corners = Vec::new();
    let mut open = false;
    let mut last = 0;
    for (line, text) in Lines::new(bytes) {
        last = line;
        let mut rest = words(text);
        let Some(key) = rest.next() else { continue };
        let is = |word: &str| key.eq_ignore_ascii_case(word.as_bytes());
        if is("facet") {
            open = true;
            corners.clear();
        } else if open && is("vertex") {
            let mut at = [0.0; 3];
            for coordinate in &mut at {
                let word = rest.next().unwrap_or_default();
                *coordinate = number(word, "a coordinate", line)?;
            }
            let vertex = known.vertex(&mut out, DVec3::from_array(at));
            corners.push(vertex.map_err(|f| Found::line(line, f))?);
        } else if open && is("endfacet") {
            open = false;
            out.face(&corners, &[], 0)
                .map_err(|f| Found::line(line, f))?;
        } else if !["outer", "endloop", "solid", "endsolid"]
            .into_iter()
            .any(is)
        {
            let why = format!("`{}` has no place here", quote(key));
            return Err(Found::line(line, Fault::NotThis { format: "STL", why }));
        }
    }
    if open {
        return Err(Found::line(last, Fault::Truncated("a facet")));
    }
    Ok(out)
}
