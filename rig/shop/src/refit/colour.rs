//! A scan's own colour, vertex by vertex or from its picture, drawn into the new head's colour map: every triangle of
//! the scan that lies on the new skin and faces its way is put where that skin is in the map. Forward, since a scan has
//! fewer corners than a map has texels.
//!
//! Left out is what is no skin or not there on the new head: the whites of eyes between the lids, the mouth's inside,
//! the person's own hair. `blend` makes the rest whole.

use glam::{Vec2, Vec3, vec2};
use mouthpiece_rig::{ColourMap, Head};

use super::Coloured;
use super::blend::{Layer, blend};
use crate::closest::{Facing, Surface};
use crate::colour;
use crate::lines::Hairline;
use crate::mesh::{Image, Scan, ScanColour};

/// The scan's surface must be this near to the new skin, mm, and face its way (cosine).
const NEAR_MM: f32 = 3.0;
const AGREE: f32 = 0.5;
/// Rows of skin with more than this share of wet are margins of lids and lips.
const WET: f32 = 0.05;
/// What is nearer to an eyeball than this is the eyeball, mm.
const EYE_MM: f32 = 0.7;
/// Triangles larger than this share of the map cross a seam.
const SEAM: f32 = 0.04;
/// Colour this far within the hairline and beyond is hair, mm.
const HAIR_MM: f32 = -1.5;
/// With less than this share of the map there is nothing to blend.
const LEAST: f64 = 0.002;

/// The new head's map; none where the scan has no colour. `skin` is where the new skin is drawn.
pub(super) fn bake(scan: &Scan, surface: &Surface, skin: &[Vec3], head: &Head) -> Option<Coloured> {
    let colours = scan.colour.as_ref()?;
    let base = base(head);
    let mut layer = Layer::new(base.width, base.height);
    let places = places(scan, surface, skin, head)?;
    let size = vec2(base.width as f32, base.height as f32);
    for (number, triangle) in scan.triangles.iter().enumerate() {
        let [Some(a), Some(b), Some(c)] = triangle.map(|v| places[v as usize]) else {
            continue;
        };
        let unrolled = |uv: Vec2| uv - vec2((uv.x - a.x).round(), 0.0);
        let corners = [a, unrolled(b), unrolled(c)];
        let extent =
            corners[0].max(corners[1]).max(corners[2]) - corners[0].min(corners[1]).min(corners[2]);
        if extent.max_element() > SEAM {
            continue;
        }
        let corners = corners.map(|uv| uv * size);
        match colours {
            ScanColour::PerVertex(list) => {
                let [a, b, c] = triangle.map(|v| rgb(list[v as usize]));
                layer.draw(corners, |[u, v, w]| a * u + b * v + c * w);
            }
            ScanColour::Texture { image, uvs } => {
                let [a, b, c] = uvs[number];
                layer.draw(corners, |[u, v, w]| sample(image, a * u + b * v + c * w));
            }
        }
    }
    exclude_hair(&mut layer, head);
    let share = layer.share();
    (share > LEAST).then(|| Coloured {
        map: blend(&base, &layer),
        share,
    })
}

/// The map that the scan's colour is put on.
fn base(head: &Head) -> ColourMap {
    match &head.colour {
        Some(map) if map.rgb.len() == map.width * map.height * 3 && map.width >= 64 => map.clone(),
        _ => colour::paint(head, colour::WIDTH),
    }
}

/// Where in the map each vertex of the scan belongs.
fn places(scan: &Scan, surface: &Surface, skin: &[Vec3], head: &Head) -> Option<Vec<Option<Vec2>>> {
    let triangles = &head.skin.mesh.triangles;
    let fitted = Surface::new(skin, triangles).ok()?;
    let place = |(at, normal): (&Vec3, &Vec3)| -> Option<Vec2> {
        let facing = Facing {
            direction: *normal,
            cosine: AGREE,
        };
        let hit = fitted.closest_facing(*at, NEAR_MM, facing)?;
        let number = hit.triangle as usize;
        let margin = triangles[number]
            .iter()
            .any(|v| head.skin.wet[*v as usize] > WET);
        let in_eye = head
            .eyes
            .iter()
            .any(|eye| at.distance(eye.centre) < eye.radius + EYE_MM);
        if margin || in_eye {
            return None;
        }
        let wedge = match head.skin.wedges.get(number) {
            Some(wedge) => *wedge,
            None => triangles[number].map(|v| head.skin.mesh.uvs[v as usize]),
        };
        let uv: Vec2 = wedge
            .iter()
            .zip(hit.barycentric)
            .map(|(uv, s)| *uv * s)
            .sum();
        Some(vec2(uv.x.rem_euclid(1.0), uv.y))
    };
    Some(
        scan.positions
            .iter()
            .zip(surface.normals())
            .map(place)
            .collect(),
    )
}

/// The person's own hair is not the new head's scalp.
fn exclude_hair(layer: &mut Layer, head: &Head) {
    let Some(hairline) = Hairline::of(head) else {
        return;
    };
    layer.keep(|uv| hairline.depth_mm(uv) < HAIR_MM);
}

fn rgb(bytes: [u8; 3]) -> Vec3 {
    Vec3::from(bytes.map(f32::from))
}

/// The picture's colour between its four nearest pixels.
fn sample(image: &Image, uv: Vec2) -> Vec3 {
    let (width, height) = (image.width as usize, image.height as usize);
    if width == 0 || height == 0 {
        return Vec3::ZERO;
    }
    // Some exporters repeat the picture.
    let wrapped = uv - uv.floor();
    let wrapped = Vec2::select(uv.cmpeq(Vec2::ONE), Vec2::ONE, wrapped);
    let at = wrapped * vec2(width as f32, height as f32) - 0.5;
    let (x, y) = (at.x.floor(), at.y.floor());
    let (fx, fy) = (at.x - x, at.y - y);
    let pixel = |x: f32, y: f32| {
        let x = (x.max(0.0) as usize).min(width - 1);
        let y = (y.max(0.0) as usize).min(height - 1);
        let i = 3 * (y * width + x);
        image
            .rgb
            .get(i..i + 3)
            .map_or(Vec3::ZERO, |p| rgb([p[0], p[1], p[2]]))
    };
    let row = |y| pixel(x, y).lerp(pixel(x + 1.0, y), fx);
    row(y).lerp(row(y + 1.0), fy)
}
