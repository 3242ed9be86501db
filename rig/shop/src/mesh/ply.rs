//! PLY (Stanford), as text and binary of either byte order: `vertex` with coordinates of any type,
//! colours and texture coordinates in any order, `face` with polygons and MeshLab's texture
//! coordinates per corner. Other elements are passed over.

use glam::{DVec3, Vec2, vec2};

use super::Side;
use super::builder::{Builder, byte};
use super::error::{Fault, Found, Place};
use super::limits::{MAX_CORNERS, MAX_TRIANGLES, MAX_VERTICES};
use super::picture::Material;
use super::ply_header::{self, Element, Encoding, Header, Scalar};
use super::text::number;

/// A file whose header already says too much, before it is loaded.
pub(crate) fn refuse_large(head: &[u8]) -> Result<(), Fault> {
    match ply_header::read(head) {
        Ok(header) => header.elements.iter().try_for_each(check_count),
        // What else is wrong is said when all of it is there.
        Err(_) => Ok(()),
    }
}

fn check_count(element: &Element) -> Result<(), Fault> {
    match element.name.as_str() {
        "vertex" if element.count > MAX_VERTICES as u64 => Err(Fault::ManyVertices(element.count)),
        "face" if element.count > MAX_TRIANGLES as u64 => Err(Fault::ManyTriangles(element.count)),
        _ => Ok(()),
    }
}

pub(crate) fn read(bytes: &[u8], side: &dyn Side) -> Result<Builder, Found> {
    let header = ply_header::read(bytes)?;
    let body = &bytes[header.body..];
    match header.encoding {
        Encoding::Text => {
            let numbers = Text {
                rest: body,
                line: header.line,
            };
            read_body(&header, numbers, side)
        }
        encoding => {
            let little = encoding == Encoding::LittleEndian;
            let numbers = Binary {
                bytes,
                at: header.body,
                little,
            };
            read_body(&header, numbers, side)
        }
    }
}

/// A body, number by number.
trait Numbers {
    fn next(&mut self, kind: Scalar) -> Result<f64, Found>;
    fn place(&self) -> Place;
    fn left(&self) -> usize;
}

struct Text<'a> {
    rest: &'a [u8],
    line: usize,
}

impl Numbers for Text<'_> {
    fn next(&mut self, _: Scalar) -> Result<f64, Found> {
        let blank = self.rest.iter().take_while(|b| b.is_ascii_whitespace());
        let mut skipped = 0;
        for &b in blank {
            skipped += 1;
            self.line += usize::from(b == b'\n');
        }
        let rest = &self.rest[skipped..];
        let end = rest
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return Err(Found::line(self.line, Fault::Truncated("its tables")));
        }
        number(word, "a value", self.line)
    }

    fn place(&self) -> Place {
        Place::Line(self.line)
    }

    fn left(&self) -> usize {
        // The last number needs no blank after it.
        self.rest.len() + 1
    }
}

struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
    little: bool,
}

impl Numbers for Binary<'_> {
    fn next(&mut self, kind: Scalar) -> Result<f64, Found> {
        let size = kind.bytes();
        let Some(bytes) = self.bytes.get(self.at..self.at + size) else {
            return Err(Found::byte(self.at, Fault::Truncated("its tables")));
        };
        self.at += size;
        let mut word = [0; 8];
        word[..size].copy_from_slice(bytes);
        if !self.little {
            word[..size].reverse();
        }
        let [a, b, c, d, ..] = word;
        Ok(match kind {
            Scalar::U8 => f64::from(a),
            Scalar::I8 => f64::from(a as i8),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(word),
        })
    }

    fn place(&self) -> Place {
        Place::Byte(self.at)
    }

    fn left(&self) -> usize {
        self.bytes.len() - self.at
    }
}

fn read_body(
    header: &Header,
    mut numbers: impl Numbers,
    side: &dyn Side,
) -> Result<Builder, Found> {
    let mut out = Builder::default();
    let mut uvs = Vec::new();
    for name in &header.textures {
        let picture = out.picture(name, side)?;
        out.materials.push(Material {
            picture,
            ..Material::default()
        });
    }
    for element in &header.elements {
        check_count(element)?;
        if element.least_bytes(header.encoding) > numbers.left() as u64 {
            let end = Found {
                place: numbers.place(),
                fault: Fault::Truncated("its tables"),
            };
            return Err(end);
        }
        match element.name.as_str() {
            "vertex" => vertices(element, &mut numbers, &mut out, &mut uvs)?,
            "face" => faces(element, &mut numbers, &mut out, &uvs)?,
            "tristrips" | "range_grid" => {
                let found = format!("a PLY with {}", element.name);
                let mend = "open it in MeshLab and export it as triangles";
                return Err(Fault::Unsupported { found, mend }.into());
            }
            _ => skip(element, &mut numbers)?,
        }
    }
    Ok(out)
}

fn length(list: Scalar, numbers: &mut impl Numbers) -> Result<usize, Found> {
    let length = numbers.next(list)?;
    if length < 0.0 || length.fract() != 0.0 || length > numbers.left() as f64 {
        let fault = Fault::Truncated("a list");
        return Err(Found {
            place: numbers.place(),
            fault,
        });
    }
    Ok(length as usize)
}

fn skip(element: &Element, numbers: &mut impl Numbers) -> Result<(), Found> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            let count = match property.list {
                Some(list) => length(list, numbers)?,
                None => 1,
            };
            for _ in 0..count {
                numbers.next(property.item)?;
            }
        }
    }
    Ok(())
}

/// Where a vertex's property goes: coordinates, colours, texture coordinates, nowhere.
fn slot(name: &str) -> Option<usize> {
    Some(match name {
        "x" => 0,
        "y" => 1,
        "z" => 2,
        "red" | "r" | "diffuse_red" => 3,
        "green" | "g" | "diffuse_green" => 4,
        "blue" | "b" | "diffuse_blue" => 5,
        "s" | "u" | "texture_u" => 6,
        "t" | "v" | "texture_v" => 7,
        _ => return None,
    })
}

fn vertices(
    element: &Element,
    numbers: &mut impl Numbers,
    out: &mut Builder,
    uvs: &mut Vec<Vec2>,
) -> Result<(), Found> {
    let slots: Vec<Option<usize>> = element
        .properties
        .iter()
        .map(|p| {
            if p.list.is_some() {
                None
            } else {
                slot(&p.name)
            }
        })
        .collect();
    let has = |slot: usize| slots.contains(&Some(slot));
    if !(has(0) && has(1) && has(2)) {
        let why = "its vertices have no x, y, z".to_owned();
        return Err(Fault::NotThis { format: "PLY", why }.into());
    }
    let (coloured, textured) = (has(3) && has(4) && has(5), has(6) && has(7));
    for _ in 0..element.count {
        let mut row = [0.0; 8];
        for (property, slot) in element.properties.iter().zip(&slots) {
            if let Some(list) = property.list {
                for _ in 0..length(list, numbers)? {
                    numbers.next(property.item)?;
                }
                continue;
            }
            let value = numbers.next(property.item)?;
            if let &Some(slot) = slot {
                let colour = (3..6).contains(&slot);
                row[slot] = if colour {
                    channel(value, property.item)
                } else {
                    value
                };
            }
        }
        let [x, y, z, r, g, b, u, v] = row;
        let place = numbers.place();
        out.vertex(DVec3::new(x, y, z))
            .map_err(|fault| Found { place, fault })?;
        if coloured {
            out.colours.push([r, g, b].map(byte));
        }
        if textured {
            uvs.push(vec2(u as f32, 1.0 - v as f32));
        }
    }
    Ok(())
}

/// A colour channel as 0..1, by the type that it is written in.
fn channel(value: f64, kind: Scalar) -> f64 {
    match kind {
        Scalar::F32 | Scalar::F64 => value,
        Scalar::U16 | Scalar::I16 => value / 65535.0,
        _ => value / 255.0,
    }
}

fn faces(
    element: &Element,
    numbers: &mut impl Numbers,
    out: &mut Builder,
    vertex_uvs: &[Vec2],
) -> Result<(), Found> {
    let named = |names: &[&str]| {
        element
            .properties
            .iter()
            .position(|p| names.contains(&p.name.as_str()))
    };
    let corners_at = named(&["vertex_indices", "vertex_index"])
        .filter(|&at| element.properties[at].list.is_some());
    let (uvs_at, texture_at) = (named(&["texcoord"]), named(&["texnumber"]));
    if corners_at.is_none() && element.count > 0 {
        let why = "its faces have no list `vertex_indices`".to_owned();
        return Err(Fault::NotThis { format: "PLY", why }.into());
    }
    let (mut corners, mut uvs) = (Vec::new(), Vec::new());
    for _ in 0..element.count {
        corners.clear();
        uvs.clear();
        let mut material = 0.0;
        let mut u = None;
        for (at, property) in element.properties.iter().enumerate() {
            let count = match property.list {
                Some(list) => length(list, numbers)?,
                None => 1,
            };
            let wanted = Some(at) == corners_at;
            if wanted && count > MAX_CORNERS {
                let fault = Fault::ManyCorners(count);
                return Err(Found {
                    place: numbers.place(),
                    fault,
                });
            }
            for _ in 0..count {
                let value = numbers.next(property.item)?;
                if wanted {
                    let place = numbers.place();
                    let index = out.index(whole(value));
                    corners.push(index.map_err(|fault| Found { place, fault })?);
                } else if Some(at) == uvs_at {
                    match u.take() {
                        None => u = Some(value),
                        Some(u) => uvs.push(vec2(u as f32, 1.0 - value as f32)),
                    }
                } else if Some(at) == texture_at {
                    material = value;
                }
            }
        }
        if uvs.len() != corners.len() {
            uvs.clear();
            uvs.extend(corners.iter().filter_map(|&c| vertex_uvs.get(c as usize)));
        }
        let known = material >= 0.0 && material < out.materials.len() as f64;
        let material = if known { material as u32 } else { 0 };
        let place = numbers.place();
        out.face(&corners, &uvs, material)
            .map_err(|fault| Found { place, fault })?;
    }
    Ok(())
}

/// An index as written; -1 where it is no whole number.
fn whole(value: f64) -> i64 {
    if value.fract() == 0.0 {
        value as i64
    } else {
        -1
    }
}
