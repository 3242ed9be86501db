//! The light of the room round the head: the studio's own, or that of a panorama a user gives.
//!
//! Only what is broad of it counts: it becomes spherical harmonics of order 2 (`harmonics`), the ambient light of
//! every shader. The three lamps stay, and with them the shadows; a sun in the panorama casts none of its own.

use std::path::Path;

use glam::{Vec3, vec3};

use crate::harmonics::Harmonics;
use crate::picture::{PictureError, decode};

/// Mean brightness of the ambient light, whatever room it is: panoramas come in any scale, and the lamps do not.
const LEVEL: f32 = 0.31;
/// Brighter texels count as this bright: the largest number of an .exr's half floats. A broken one is no sun.
const LIGHT_MAX: f32 = 65_504.0;
/// Luminance of linear sRGB.
const LUMINANCE: Vec3 = vec3(0.2126, 0.7152, 0.0722);

/// Ambient light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    light: Harmonics,
    /// A studio is arranged round the camera; a place stays where it is.
    turns: bool,
}

impl Default for Environment {
    fn default() -> Self {
        Self::studio()
    }
}

impl Environment {
    /// The built-in studio: grey walls, a large box overhead, a reflector behind the camera, a dark floor.
    #[must_use]
    pub fn studio() -> Self {
        let mut light = Harmonics::uniform(vec3(0.184, 0.186, 0.195));
        light.add_disc(Vec3::Y, vec3(0.347, 0.373, 0.427), 60_f32.to_radians());
        light.add_disc(Vec3::Z, vec3(0.290, 0.266, 0.242), 40_f32.to_radians());
        Self { light, turns: true }
    }

    /// From a panorama (.hdr or .exr): all round across, from straight up to straight down. Its middle is what
    /// the face looks at. Brightness is fitted to the lamps', colour is taken as it is.
    ///
    /// # Errors
    /// When it cannot be opened, is of another kind, damaged, too large or dark all over.
    pub fn load(path: &Path) -> Result<Self, PictureError> {
        use image::ImageFormat::{Hdr, OpenExr};
        let panorama = decode(path, &[Hdr, OpenExr], "a panorama as .hdr or .exr")?.into_rgb32f();
        let width = panorama.width() as usize;
        let light = project(width, panorama.as_raw());
        light
            .map(|light| Self {
                light,
                turns: false,
            })
            .ok_or_else(|| PictureError::Dark {
                path: path.to_path_buf(),
            })
    }

    /// As it falls on the head when the studio is turned by `turn`, radians.
    pub(crate) fn seen(&self, turn: f32) -> Harmonics {
        if self.turns {
            self.light.turned(turn)
        } else {
            self.light
        }
    }
}

/// A panorama of `width` texels a row, linear RGB, at [`LEVEL`]; none where it holds no light.
fn project(width: usize, rgb: &[f32]) -> Option<Harmonics> {
    let texels = rgb.as_chunks::<3>().0;
    let height = texels.len() / width.max(1);
    let mut light = Harmonics::default();
    let mut filled = 0.0;
    for (y, row) in texels.chunks_exact(width.max(1)).enumerate() {
        let down = (y as f32 + 0.5) / height as f32 * std::f32::consts::PI;
        // Texels near the poles fill less of the sphere.
        let share = down.sin();
        // A sum of its own, since a long one would lose the small ones.
        let mut band = Harmonics::default();
        for (x, texel) in row.iter().enumerate() {
            // Seen from inside: what is right of the middle is at the face's right, which is -X.
            let across = ((x as f32 + 0.5) / width as f32 - 0.5) * std::f32::consts::TAU;
            let direction = vec3(-across.sin() * share, down.cos(), across.cos() * share);
            // Not a number, and less than no light, are darkness.
            let texel = Vec3::from(texel.map(|t| if t > 0.0 { t.min(LIGHT_MAX) } else { 0.0 }));
            band.add(direction, texel, share);
        }
        light.add_all(&band);
        filled += share * width as f32;
    }
    let brightness = light.mean().dot(LUMINANCE) / filled;
    let factor = LEVEL / (filled * brightness);
    (brightness > 1e-9 && factor.is_finite()).then(|| light.scaled(factor))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panorama(light: impl Fn(f32, f32) -> f32) -> Vec<f32> {
        let at = |i: usize| ((i % 64) as f32 / 64.0, (i / 64) as f32 / 32.0);
        (0..64 * 32)
            .flat_map(|i| [light(at(i).0, at(i).1); 3])
            .collect()
    }

    #[test]
    fn a_panorama_of_one_grey_lights_all_alike_whatever_its_scale() {
        for level in [1e-3, 1.0, 5e4] {
            let light = project(64, &panorama(|_, _| level)).unwrap();
            for n in [
                Vec3::X,
                Vec3::Y,
                Vec3::Z,
                Vec3::NEG_Y,
                Vec3::splat(0.577_350_3),
            ] {
                let got = light.returned(n);
                assert!(
                    (got - Vec3::splat(LEVEL)).abs().max_element() < 2e-3,
                    "{level}, {n}: {got}"
                );
            }
        }
    }

    #[test]
    fn the_middle_is_in_front_its_right_at_the_faces_right_and_its_top_above() {
        let front = project(
            64,
            &panorama(|u, _| f32::from(u8::from((u - 0.5).abs() < 0.1))),
        )
        .unwrap();
        let right = project(64, &panorama(|u, _| f32::from(u8::from(u >= 0.5)))).unwrap();
        let above = project(64, &panorama(|_, v| f32::from(u8::from(v < 0.5)))).unwrap();
        for (light, n) in [(front, Vec3::Z), (right, Vec3::NEG_X), (above, Vec3::Y)] {
            let (lit, unlit) = (light.returned(n).x, light.returned(-n).x);
            assert!(
                lit > 1.5 * LEVEL && unlit < 0.3 * LEVEL,
                "{n}: {lit} and {unlit}"
            );
        }
        // A half lit whole: twice the mean in its middle, nothing at its back.
        let n = right.returned(Vec3::NEG_X).x;
        assert!((n - 2.0 * LEVEL).abs() < 2e-3 && right.returned(Vec3::X).x.abs() < 2e-3);
    }

    #[test]
    fn broken_texels_are_dark_and_a_dark_panorama_is_none() {
        let broken = |u: f32, v: f32| match ((u * 64.0) as u32 % 4, v < 0.5) {
            (0, true) => f32::NAN,
            (1, true) => -3.0,
            (2, true) => f32::INFINITY,
            _ => 1.0,
        };
        let light = project(64, &panorama(broken)).unwrap();
        assert!(light.returned(Vec3::Y).is_finite());
        assert!(project(64, &panorama(|_, _| 0.0)).is_none());
        assert!(project(64, &panorama(|_, _| f32::NAN)).is_none());
        assert!(project(0, &[]).is_none());
    }

    #[test]
    fn panoramas_are_read_from_hdr_and_exr() {
        let folder =
            std::env::temp_dir().join(format!("mouthpiece-panorama-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        // Light above only, in a colour.
        let pixels = image::Rgb32FImage::from_fn(32, 16, |_, y| {
            image::Rgb(if y < 8 { [4.0, 2.0, 1.0] } else { [0.0; 3] })
        });
        for name in ["a.hdr", "a.exr"] {
            let path = folder.join(name);
            pixels.save(&path).unwrap();
            let light = Environment::load(&path).unwrap().seen(1.0);
            let up = light.returned(Vec3::Y);
            assert!(
                (up.x / up.y - 2.0).abs() < 0.02 && (up.y / up.z - 2.0).abs() < 0.02,
                "{name}: {up}"
            );
            assert!(
                light.returned(Vec3::NEG_Y).abs().max_element() < 0.01 * up.x,
                "{name}"
            );
        }
        std::fs::write(
            folder.join("cut.hdr"),
            &std::fs::read(folder.join("a.hdr")).unwrap()[..60],
        )
        .unwrap();
        let cut = Environment::load(&folder.join("cut.hdr")).unwrap_err();
        assert!(matches!(cut, PictureError::Damaged { .. }), "{cut}");
        let other = Environment::load(Path::new("Cargo.toml")).unwrap_err();
        assert!(matches!(other, PictureError::Kind { .. }), "{other}");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
