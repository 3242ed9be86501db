//! What all readers do alike: check each vertex and face as it comes, keep within the limits, and
//! bring the colour into one form.

use glam::{DVec3, Vec2, Vec3};

use super::error::Fault;
use super::limits::{
    MAX_CORNERS, MAX_PIXELS, MAX_SPREAD, MAX_TRIANGLES, MAX_VERTICES, MIN_TRIANGLES,
};
use super::picture::{self, Material};
use super::polygon::triangulate;
use super::scan::{Image, Scan, ScanColour};
use super::text::quote;
use super::{Reading, Side};

/// A scan while it is read.
#[derive(Default)]
pub(crate) struct Builder {
    pub(crate) positions: Vec<Vec3>,
    /// Per vertex, or empty.
    pub(crate) colours: Vec<[u8; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Per triangle, or empty; NaN where a face has none.
    pub(crate) uvs: Vec<[Vec2; 3]>,
    /// Per triangle, or empty.
    pub(crate) material: Vec<u32>,
    pub(crate) materials: Vec<Material>,
    pub(crate) pictures: Vec<Image>,
    names: Vec<String>,
    pub(crate) notes: Vec<String>,
    points: Vec<DVec3>,
}

impl Builder {
    /// Adds a vertex.
    pub(crate) fn vertex(&mut self, at: DVec3) -> Result<(), Fault> {
        let vertex = self.positions.len() + 1;
        if vertex > MAX_VERTICES {
            return Err(Fault::ManyVertices(vertex as u64));
        }
        for (what, value) in [("x", at.x), ("y", at.y), ("z", at.z)] {
            if !value.is_finite() {
                return Err(Fault::NotFinite {
                    what,
                    vertex,
                    value,
                });
            }
            if value.abs() > f64::from(MAX_SPREAD) {
                return Err(Fault::TooFar { vertex, value });
            }
        }
        self.positions.push(at.as_vec3());
        Ok(())
    }

    /// An index of a file as an index of this scan.
    pub(crate) fn index(&self, index: i64) -> Result<u32, Fault> {
        let count = self.positions.len();
        match u32::try_from(index) {
            Ok(index) if (index as usize) < count => Ok(index),
            _ => Err(Fault::OutOfRange {
                what: "vertex",
                index,
                count,
            }),
        }
    }

    /// Adds a face with its corners' places in a picture (or none) and its material.
    pub(crate) fn face(
        &mut self,
        corners: &[u32],
        uvs: &[Vec2],
        material: u32,
    ) -> Result<(), Fault> {
        match corners.len() {
            0..3 => return Err(Fault::FewCorners(corners.len())),
            n if n > MAX_CORNERS => return Err(Fault::ManyCorners(n)),
            n if self.triangles.len() + n - 2 > MAX_TRIANGLES => {
                return Err(Fault::ManyTriangles(self.triangles.len() as u64 + 1));
            }
            _ => {}
        }
        let mut points = std::mem::take(&mut self.points);
        points.clear();
        points.extend(
            corners
                .iter()
                .map(|&i| self.positions[i as usize].as_dvec3()),
        );
        triangulate(&points, |t| {
            self.triangles.push(t.map(|i| corners[i]));
            let none = Vec2::splat(f32::NAN);
            self.uvs
                .push(t.map(|i| uvs.get(i).copied().unwrap_or(none)));
            self.material.push(material);
        });
        self.points = points;
        Ok(())
    }

    /// Reads the picture `name` beside the scan once and returns its number. One that is missing
    /// costs the colour, not the scan: it is noted.
    pub(crate) fn picture(&mut self, name: &str, side: &dyn Side) -> Result<Option<usize>, Fault> {
        if let Some(known) = self.names.iter().position(|n| n == name) {
            return Ok(Some(known));
        }
        let Some(bytes) = side.open(name) else {
            self.note(format!(
                "the texture {} is not beside the scan, so the head gets no colour from it",
                quote(name.as_bytes())
            ));
            return Ok(None);
        };
        self.decode(name, &bytes).map(Some)
    }

    /// Takes a picture that is inside the scan's file.
    pub(crate) fn decode(&mut self, name: &str, bytes: &[u8]) -> Result<usize, Fault> {
        if let Some(known) = self.names.iter().position(|n| n == name) {
            return Ok(known);
        }
        let picture = picture::decode(name, bytes)?;
        let so_far: usize = self.pictures.iter().map(|p| p.rgb.len() / 3).sum();
        if (so_far + picture.rgb.len() / 3) as u64 > MAX_PIXELS {
            return Err(Fault::Picture {
                name: quote(name.as_bytes()),
                why: format!("with it the textures have more than {MAX_PIXELS} pixels"),
            });
        }
        self.pictures.push(picture);
        self.names.push(name.to_owned());
        Ok(self.pictures.len() - 1)
    }

    /// Keeps what the user should know, once and within reason.
    pub(crate) fn note(&mut self, note: String) {
        const MOST: usize = 20;
        if self.notes.len() < MOST && !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    /// The scan, once all is read.
    pub(crate) fn finish(mut self) -> Result<Reading, Fault> {
        if self.positions.is_empty() {
            return Err(Fault::NoVertices);
        }
        if self.triangles.is_empty() {
            return Err(Fault::PointCloud(self.positions.len()));
        }
        if self.triangles.len() < MIN_TRIANGLES {
            return Err(Fault::FewTriangles(self.triangles.len()));
        }
        let colour = self.colour()?;
        Ok(Reading {
            scan: Scan {
                positions: self.positions,
                triangles: self.triangles,
                colour,
            },
            notes: self.notes,
        })
    }

    /// A texture where any triangle shows one, else the vertices' colours, else none.
    fn colour(&mut self) -> Result<Option<ScanColour>, Fault> {
        if self.materials.is_empty() {
            self.materials.push(Material::default());
        }
        let shows = |m: &u32| self.materials[*m as usize].picture.is_some();
        let finite = |uv: &[Vec2; 3]| uv.iter().all(|c| c.is_finite());
        let textured = self
            .uvs
            .iter()
            .zip(&self.material)
            .any(|(uv, m)| finite(uv) && shows(m));
        if textured {
            let pictures = std::mem::take(&mut self.pictures);
            let mut uvs = std::mem::take(&mut self.uvs);
            let image = picture::stack(pictures, &self.materials, &self.material, &mut uvs)?;
            return Ok(Some(ScanColour::Texture { image, uvs }));
        }
        let whole = self.colours.len() == self.positions.len();
        let colours = std::mem::take(&mut self.colours);
        Ok(whole.then_some(ScanColour::PerVertex(colours)))
    }
}

/// A colour channel of 0..1 as a byte.
pub(crate) fn byte(channel: f64) -> u8 {
    // A cast saturates, and NaN becomes 0.
    (channel * 255.0).round() as u8
}
