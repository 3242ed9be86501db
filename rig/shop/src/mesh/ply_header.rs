//! The header of a PLY: which elements of which properties follow, and how they are written.

use super::error::{Fault, Found};
use super::text::{Lines, quote, words};

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// A number's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn of(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub(crate) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// A column of an element.
#[derive(Debug)]
pub(crate) struct Property {
    pub(crate) name: String,
    /// Type of the length where it is a list.
    pub(crate) list: Option<Scalar>,
    pub(crate) item: Scalar,
}

impl Property {
    /// Fewest bytes that it takes.
    fn least_bytes(&self, encoding: Encoding) -> u64 {
        match encoding {
            // A digit and what parts it from the next.
            Encoding::Text => 2,
            _ => self.list.unwrap_or(self.item).bytes() as u64,
        }
    }
}

/// A table of the body.
#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) count: u64,
    pub(crate) properties: Vec<Property>,
}

impl Element {
    /// Fewest bytes that the whole table takes.
    pub(crate) fn least_bytes(&self, encoding: Encoding) -> u64 {
        let row: u64 = self
            .properties
            .iter()
            .map(|p| p.least_bytes(encoding))
            .sum();
        self.count.saturating_mul(row)
    }
}

/// All of it.
#[derive(Debug)]
pub(crate) struct Header {
    pub(crate) encoding: Encoding,
    pub(crate) elements: Vec<Element>,
    /// `comment TextureFile`, as MeshLab writes.
    pub(crate) textures: Vec<String>,
    /// First byte of the body, and its line.
    pub(crate) body: usize,
    pub(crate) line: usize,
}

/// Lines of a header: real ones have a few dozen.
const MAX_LINES: usize = 1000;

pub(crate) fn read(bytes: &[u8]) -> Result<Header, Found> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut textures = Vec::new();
    let mut lines = Lines::new(bytes);
    if lines
        .next()
        .is_none_or(|(_, line)| line.trim_ascii() != b"ply")
    {
        let why = "it does not begin with a line `ply`".to_owned();
        return Err(Found::line(1, Fault::NotThis { format: "PLY", why }));
    }
    while let Some((at, line)) = lines.next() {
        let wrong = |why: String| Found::line(at, Fault::NotThis { format: "PLY", why });
        if at > MAX_LINES {
            return Err(wrong("its header does not end".to_owned()));
        }
        let mut rest = words(line);
        let key = rest.next().unwrap_or_default();
        let rest: Vec<&[u8]> = rest.collect();
        match (key, rest.as_slice()) {
            (b"format", [b"ascii", ..]) => encoding = Some(Encoding::Text),
            (b"format", [b"binary_little_endian", ..]) => encoding = Some(Encoding::LittleEndian),
            (b"format", [b"binary_big_endian", ..]) => encoding = Some(Encoding::BigEndian),
            (b"comment", [b"TextureFile", ..]) => {
                let name = line
                    .trim_ascii()
                    .splitn(3, |&b| b == b' ')
                    .nth(2)
                    .unwrap_or_default();
                textures.push(String::from_utf8_lossy(name.trim_ascii()).into_owned());
            }
            (b"element", [name, count]) => {
                let count = std::str::from_utf8(count).ok().and_then(|c| c.parse().ok());
                elements.push(Element {
                    name: String::from_utf8_lossy(name).into_owned(),
                    count: count.ok_or_else(|| wrong("an element has no count".to_owned()))?,
                    properties: Vec::new(),
                });
            }
            (b"property", rest) => {
                let Some(element) = elements.last_mut() else {
                    return Err(wrong("a property comes before any element".to_owned()));
                };
                let property = property(rest)
                    .ok_or_else(|| wrong(format!("`{}` is no property", quote(line))))?;
                element.properties.push(property);
            }
            (b"end_header", _) => {
                let encoding =
                    encoding.ok_or_else(|| wrong("its format is not said".to_owned()))?;
                return Ok(Header {
                    encoding,
                    elements,
                    textures,
                    body: bytes.len() - lines.rest().len(),
                    line: at + 1,
                });
            }
            (b"comment" | b"obj_info" | b"", _) => {}
            _ => return Err(wrong(format!("`{}` has no place in a header", quote(line)))),
        }
    }
    Err(Fault::Truncated("its header").into())
}

fn property(words: &[&[u8]]) -> Option<Property> {
    let (list, item, name) = match *words {
        [b"list", length, item, name] => {
            let length = Scalar::of(length).filter(|l| l.is_integer())?;
            (Some(length), Scalar::of(item)?, name)
        }
        [item, name] => (None, Scalar::of(item)?, name),
        _ => return None,
    };
    Some(Property {
        name: String::from_utf8_lossy(name).into_owned(),
        list,
        item,
    })
}
