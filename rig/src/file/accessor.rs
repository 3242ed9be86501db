//! Reads a glTF accessor as plain numbers; every index and length is checked before use.

use super::HeadError;
use super::document::{Accessor, BufferView, Document, FLOAT, UNSIGNED_INT, UNSIGNED_SHORT};

/// Most vertices or corners of triangles that one mesh may have: fifty times a fine head's.
pub(super) const COUNT_MAX: usize = 3_000_000;

/// Where the numbers are.
pub(super) struct Data<'a> {
    pub document: &'a Document,
    pub binary: &'a [u8],
}

impl Data<'_> {
    fn at<T>(list: &[T], index: usize, what: &str) -> Result<usize, HeadError> {
        if index < list.len() {
            return Ok(index);
        }
        let fault = format!("there are only {}", list.len());
        Err(HeadError::element(
            format!("{what} {index}"),
            fault,
            ANEW_SAVE,
        ))
    }

    /// The bytes of a buffer view, and its stride.
    pub(super) fn view(&self, index: usize) -> Result<(&[u8], Option<usize>), HeadError> {
        let views = &self.document.buffer_views;
        let view: &BufferView = &views[Self::at(views, index, "buffer view")?];
        let outside = self
            .document
            .buffers
            .first()
            .is_none_or(|b| b.uri.is_some());
        if view.buffer != Some(0) || outside {
            let fault = "its data lies in another file";
            return Err(HeadError::element(
                format!("buffer view {index}"),
                fault,
                ONE_FILE,
            ));
        }
        let from = view.byte_offset.unwrap_or(0);
        let bytes = from
            .checked_add(view.byte_length.unwrap_or(0))
            .and_then(|to| self.binary.get(from..to))
            .ok_or(HeadError::Truncated {
                part: "its vertices",
            })?;
        Ok((bytes, view.byte_stride))
    }

    /// `components` numbers an element, as the closure makes them of the bytes.
    fn read<T>(
        &self,
        index: usize,
        element: &str,
        components: usize,
        mut push: impl FnMut(u32, bool, &[u8]) -> Option<T>,
    ) -> Result<Vec<T>, HeadError> {
        let accessors = &self.document.accessors;
        let accessor: &Accessor = &accessors[Self::at(accessors, index, "accessor")?];
        let wrong = |fault: &str| HeadError::element(element, fault, ANEW_SAVE);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][components - 1];
        if accessor.r#type.as_deref() != Some(kind) {
            return Err(wrong(&format!("it is no {kind}")));
        }
        if accessor.sparse.is_some() {
            return Err(wrong("it is stored sparsely, which is not read here"));
        }
        let count = accessor.count.unwrap_or(0);
        if count > COUNT_MAX {
            return Err(wrong(&format!(
                "{count} elements are more than {COUNT_MAX}"
            )));
        }
        let component = accessor.component_type.unwrap_or(0);
        let size = match component {
            5120 | 5121 => 1,
            5122 | UNSIGNED_SHORT => 2,
            UNSIGNED_INT | FLOAT => 4,
            _ => return Err(wrong(&format!("component type {component} is unknown"))),
        } * components;
        let Some(view) = accessor.buffer_view else {
            return Err(wrong("it has no data (compressed?)"));
        };
        let (bytes, stride) = self.view(view)?;
        let stride = stride.unwrap_or(size);
        let offset = accessor.byte_offset.unwrap_or(0);
        let normalized = accessor.normalized.unwrap_or(false);
        // The last element's end; a stride of 0 would let few bytes stand for many elements.
        let end = (count.saturating_sub(1))
            .checked_mul(stride)
            .and_then(|n| n.checked_add(offset)?.checked_add(size));
        if count > 0 && (stride < size || end.is_none_or(|end| end > bytes.len())) {
            return Err(wrong("it reaches past its buffer"));
        }
        let mut out = Vec::with_capacity(count);
        for i in 0..count {
            let from = offset + i * stride;
            let value = push(component, normalized, &bytes[from..from + size])
                .ok_or_else(|| wrong("it holds a kind of number that does not belong there"))?;
            out.push(value);
        }
        Ok(out)
    }

    /// Vectors of `N` finite numbers.
    pub(super) fn vectors<const N: usize>(
        &self,
        index: usize,
        element: &str,
    ) -> Result<Vec<[f32; N]>, HeadError> {
        let all = self.read(index, element, N, |component, normalized, bytes| {
            let size = bytes.len() / N;
            let mut out = [0.0; N];
            for (value, bytes) in out.iter_mut().zip(bytes.chunks_exact(size)) {
                *value = number(component, normalized, bytes)?;
            }
            Some(out)
        })?;
        match all.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
            Some(i) => {
                let fault = format!("element {i} is not a finite number");
                Err(HeadError::element(element, fault, super::ANEW))
            }
            None => Ok(all),
        }
    }

    /// Indices.
    pub(super) fn indices(&self, index: usize, element: &str) -> Result<Vec<u32>, HeadError> {
        self.read(index, element, 1, |component, _, bytes| {
            match (component, bytes) {
                (5121, &[a]) => Some(u32::from(a)),
                (UNSIGNED_SHORT, &[a, b]) => Some(u32::from(u16::from_le_bytes([a, b]))),
                (UNSIGNED_INT, &[a, b, c, d]) => Some(u32::from_le_bytes([a, b, c, d])),
                _ => None,
            }
        })
    }
}

const ANEW_SAVE: &str = "save the file again as glTF binary, without compression";
const ONE_FILE: &str = "save it as one .glb file, with all its data inside";

/// One number of an attribute.
fn number(component: u32, normalized: bool, bytes: &[u8]) -> Option<f32> {
    let (value, most) = match (component, bytes) {
        (5120, &[a]) => (f32::from(a as i8), 127.0),
        (5121, &[a]) => (f32::from(a), 255.0),
        (5122, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32_767.0),
        (UNSIGNED_SHORT, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65_535.0),
        (UNSIGNED_INT, &[a, b, c, d]) => (u32::from_le_bytes([a, b, c, d]) as f32, 1.0),
        (FLOAT, &[a, b, c, d]) => return Some(f32::from_le_bytes([a, b, c, d])),
        _ => return None,
    };
    Some(if normalized {
        (value / most).max(-1.0)
    } else {
        value
    })
}
