//! What the window draws, as plain vertices: a scan with its colour, or a head's skin and eyes.

use std::collections::HashMap;

use glam::{Vec2, Vec3};
use mouthpiece_rig::{Detail, Head, normals};
use mouthpiece_shop::closest::Surface;
use mouthpiece_shop::mesh::{Image, ScanColour};

/// Clay, for what has no colour of its own; sRGB.
const CLAY: [u8; 3] = [205, 190, 178];

/// Pupil, iris and white of an eye by how far forward its surface looks (cosine): eyes are only there so that the head
/// does not look hollow.
const EYE: [(f32, [u8; 3]); 3] = [
    (0.97, [20, 18, 18]),
    (0.865, [92, 74, 58]),
    (-1.0, [224, 220, 214]),
];

/// A corner as the graphics card reads it; the shader's `Vertex` has the same order.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub uv: [f32; 2],
    /// sRGB; the fourth says how much of it the texture replaces.
    pub colour: [u8; 4],
}

/// A mesh to draw.
#[derive(Default)]
pub struct Shape {
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    pub texture: Option<Image>,
    /// Whether it has a colour of its own, so that there is something to hide.
    pub coloured: bool,
}

impl Shape {
    /// The scan's surface; `colour` belongs to the mesh that it was built from.
    pub fn of_scan(surface: &Surface, colour: Option<ScanColour>) -> Self {
        let (positions, normals) = (surface.positions(), surface.normals());
        let vertex = |v: u32, uv: Vec2, colour: [u8; 4]| Vertex {
            position: positions[v as usize].to_array(),
            normal: normals[v as usize].to_array(),
            uv: uv.to_array(),
            colour,
        };
        let coloured = colour.is_some();
        let Some(ScanColour::Texture { image, uvs }) = colour else {
            let painted = match colour {
                Some(ScanColour::PerVertex(colours)) => colours,
                _ => vec![CLAY; positions.len()],
            };
            let vertices = (0..positions.len() as u32)
                .zip(painted)
                .map(|(v, [r, g, b])| vertex(v, Vec2::ZERO, [r, g, b, 0]))
                .collect();
            return Self {
                vertices,
                indices: surface.triangles().as_flattened().to_vec(),
                texture: None,
                coloured,
            };
        };
        let [r, g, b] = CLAY;
        let mut shape = Self {
            texture: Some(image),
            coloured,
            ..Self::default()
        };
        let mut numbers: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        for (triangle, uvs) in surface.triangles().iter().zip(&uvs) {
            for (v, uv) in triangle.iter().zip(uvs) {
                let key = (*v, uv.to_array().map(f32::to_bits));
                let number = *numbers.entry(key).or_insert_with(|| {
                    shape.vertices.push(vertex(*v, *uv, [r, g, b, 255]));
                    shape.vertices.len() as u32 - 1
                });
                shape.indices.push(number);
            }
        }
        shape
    }

    /// A head's skin, as drawn, and its eyes; no hair, which would hide ears and hairline.
    pub fn of_head(head: &Head) -> anyhow::Result<Self> {
        let detail = Detail {
            levels: 1,
            ..Detail::default()
        };
        let skin = head.subdivision(&detail)?;
        let mut points = vec![Vec3::ZERO; skin.point_count()];
        skin.apply(&head.skin.mesh.positions, &mut points);
        let mut directions = vec![Vec3::Z; skin.point_count()];
        skin.normals(&points, &mut directions);
        // Copies of points for the texture's islands follow the points.
        let origin = (0..skin.point_count() as u32).chain(skin.copies().iter().copied());
        let texture = head.colour.as_ref().map(|map| Image {
            width: map.width as u32,
            height: map.height as u32,
            rgb: map.rgb.clone(),
        });
        let [r, g, b] = CLAY;
        let colour = [r, g, b, if texture.is_some() { 255 } else { 0 }];
        let mut shape = Self {
            vertices: origin
                .zip(skin.uvs())
                .map(|(point, uv)| Vertex {
                    position: points[point as usize].to_array(),
                    normal: directions[point as usize].to_array(),
                    uv: uv.to_array(),
                    colour,
                })
                .collect(),
            indices: skin.triangles().as_flattened().to_vec(),
            coloured: texture.is_some(),
            texture,
        };
        for mesh in ["eye_l", "eye_r"]
            .into_iter()
            .filter_map(|name| Some(&head.part(name)?.mesh))
        {
            let base = shape.vertices.len() as u32;
            let directions = normals(&mesh.positions, &mesh.triangles);
            let middle = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len().max(1) as f32;
            let vertices = mesh.positions.iter().zip(directions);
            shape.vertices.extend(vertices.map(|(p, n)| {
                let forward = (*p - middle).normalize_or(Vec3::Z).z;
                let ring = EYE.iter().find(|(from, _)| forward >= *from);
                let [r, g, b] = ring.map_or(CLAY, |(_, colour)| *colour);
                Vertex {
                    position: p.to_array(),
                    normal: n.to_array(),
                    uv: [0.0; 2],
                    colour: [r, g, b, 0],
                }
            }));
            let corners = mesh.triangles.as_flattened().iter();
            shape.indices.extend(corners.map(|i| i + base));
        }
        Ok(shape)
    }
}

/// The picture at half the size, again and again until both sides are at most `side`.
pub fn at_most(mut image: Image, side: u32) -> Image {
    while image.width.max(image.height) > side {
        let (width, height) = ((image.width / 2).max(1), (image.height / 2).max(1));
        let texel = |x: u32, y: u32, channel: u32| {
            let x = x.min(image.width - 1);
            let y = y.min(image.height - 1);
            let at = (y as usize * image.width as usize + x as usize) * 3 + channel as usize;
            u32::from(image.rgb.get(at).copied().unwrap_or(0))
        };
        let mut rgb = Vec::with_capacity(width as usize * height as usize * 3);
        for y in 0..height {
            for x in 0..width {
                for c in 0..3 {
                    let (u, v) = (2 * x, 2 * y);
                    let sum = texel(u, v, c)
                        + texel(u + 1, v, c)
                        + texel(u, v + 1, c)
                        + texel(u + 1, v + 1, c);
                    rgb.push((sum / 4) as u8);
                }
            }
        }
        image = Image { width, height, rgb };
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_are_halved_until_they_fit() {
        let rgb = (0..5 * 3).flat_map(|i| [i as u8 * 10; 3]).collect();
        let small = at_most(
            Image {
                width: 5,
                height: 3,
                rgb,
            },
            2,
        );
        assert_eq!((small.width, small.height), (2, 1));
        // Texels 0, 1, 5, 6 and 2, 3, 7, 8.
        assert_eq!(small.rgb, [30, 30, 30, 50, 50, 50]);
    }

    #[test]
    fn a_textured_scan_has_one_vertex_for_each_place_of_its_texture() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
        let surface = Surface::new(&points, &[[0, 1, 2], [1, 3, 2]]).unwrap();
        let corner = |x: f32, y: f32| Vec2::new(x, y);
        let uvs = vec![
            [corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)],
            // The second corner's place is shared, the last one lies on a seam.
            [corner(1.0, 0.0), corner(1.0, 1.0), corner(0.5, 0.5)],
        ];
        let image = Image {
            width: 1,
            height: 1,
            rgb: vec![9; 3],
        };
        let shape = Shape::of_scan(&surface, Some(ScanColour::Texture { image, uvs }));
        assert_eq!(shape.vertices.len(), 5);
        assert_eq!(shape.indices, [0, 1, 2, 1, 3, 4]);
        assert!(shape.coloured);
    }
}
