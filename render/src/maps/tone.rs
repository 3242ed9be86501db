//! The broad tones of a face: where it is ruddy, pale, oily, rough or thin, by place; and the lines
//! that features draw on it.

use glam::{Vec2, Vec3, vec3};
use mouthpiece_rig::Head;

use super::hairline::Hairline;
use super::landmarks::Landmarks;
use super::lines::{CHART_MM, Line};
use super::noise::fractal;
use super::{WINDOW_MAX, WINDOW_MIN, ramp};

/// Broad properties of a place: red, green, blue (sRGB-like, 0..1), gloss, depth of the skin's cells, depth
/// of pores, translucence, lip, strength of all mottling.
pub(super) type Tone = [f32; 9];

/// Skin where nothing colours it.
const BASE: Vec3 = vec3(0.800, 0.598, 0.512);
/// Hair of brows and scalp.
pub(super) const HAIR: Vec3 = vec3(0.205, 0.145, 0.110);
/// Share of the width at each side over which paint fades to plain skin.
const FADE: f32 = 0.06;

/// A feature line that colours the skin beside it.
#[derive(Clone, Debug)]
struct Painted {
    lines: Vec<Line>,
    half_width_mm: f32,
    colour: Vec3,
    share: f32,
}

impl Painted {
    /// 1 on the line, falling to 0 within a few half widths.
    fn cover(&self, chart: Vec2, half_width_mm: f32) -> f32 {
        let reach = 3.0 * half_width_mm;
        let near = self
            .lines
            .iter()
            .map(|l| l.distance(chart, reach))
            .fold(f32::INFINITY, f32::min);
        (-(near / half_width_mm).powi(2)).exp()
    }
}

/// What the tones of one face are laid by.
#[derive(Clone, Debug)]
pub(super) struct Face {
    marks: Landmarks,
    hairline: Option<Hairline>,
    alar_crease: Painted,
    lid_crease: Painted,
    lid_margin: Painted,
}

impl Face {
    pub(super) fn of(head: &Head) -> Self {
        let line = |name, half_width_mm, colour, share| Painted {
            lines: Line::pair(head, name),
            half_width_mm,
            colour,
            share,
        };
        Self {
            marks: Landmarks::of(head),
            hairline: Hairline::of(head),
            alar_crease: line("alar_crease", 2.2, vec3(0.62, 0.36, 0.30), 0.55),
            lid_crease: line("lid_crease", 1.4, vec3(0.55, 0.34, 0.28), 0.60),
            lid_margin: line("lid_margin", 2.0, vec3(0.50, 0.30, 0.26), 0.75),
        }
    }

    pub(super) fn hairline(&self) -> Option<&Hairline> {
        self.hairline.as_ref()
    }
}

/// Broad colour of a place on the face.
pub(super) fn tone_at(p: Vec3, red: f32, uv: Vec2, face: &Face) -> Tone {
    let m = &face.marks;
    let s = m.scale;
    let side = vec3(p.x.abs(), p.y, p.z);
    // Ellipsoid blots, 1 in the middle.
    let blot =
        |centre: Vec3, radius: Vec3| (-((side - centre) / (radius * s)).length_squared()).exp();
    let drop = |below: f32| m.eye.y - below * (m.eye.y - m.mouth.y);
    let on = |x: f32, y: f32, z: f32| vec3(x, y, z);
    let cheek = blot(
        on(m.eye.x * 1.22, drop(0.55), m.eye.z),
        vec3(19.0, 18.0, 40.0),
    );
    let tip = blot(m.nose, vec3(15.0, 13.0, 22.0));
    let wing = blot(
        on(15.0 * s, m.nose.y - 2.0 * s, m.nose.z - 20.0 * s),
        vec3(7.0, 8.0, 14.0),
    );
    let bridge = blot(
        on(0.0, drop(0.15), m.nose.z - 18.0 * s),
        vec3(8.0, 18.0, 22.0),
    );
    let forehead = ramp(m.eye.y + 22.0 * s, m.eye.y + 48.0 * s, p.y)
        * ramp(m.ear_x * 0.95, m.ear_x * 0.5, side.x);
    let bag = blot(
        on(m.eye.x - 2.0, m.eye.y - 15.0 * s, m.eye.z + 8.0),
        vec3(15.0, 5.0, 25.0),
    );
    let lid = blot(
        on(m.eye.x, m.eye.y + 9.0 * s, m.eye.z + 10.0),
        vec3(17.0, 6.5, 25.0),
    );
    let socket = blot(
        on(m.eye.x - 14.0 * s, m.eye.y + 4.0 * s, m.eye.z + 8.0),
        vec3(7.0, 11.0, 25.0),
    );
    let chin = blot(
        on(0.0, m.mouth.y - 30.0 * s, m.mouth.z - 6.0),
        vec3(14.0, 10.0, 20.0),
    );
    let muzzle = blot(
        on(0.0, m.mouth.y - 2.0 * s, m.mouth.z - 6.0),
        vec3(32.0, 21.0, 30.0),
    );
    let ear = ramp(m.ear_x * 0.80, m.ear_x * 0.93, side.x)
        * ramp(m.eye.z - 25.0, m.eye.z - 55.0, p.z)
        * ramp(m.nose.y - 34.0 * s, m.nose.y - 18.0 * s, p.y)
        * ramp(m.eye.y + 22.0 * s, m.eye.y + 4.0 * s, p.y);
    let neck = ramp(m.mouth.y - 40.0 * s, m.mouth.y - 68.0 * s, p.y);

    let mut c = BASE;
    let mut blend = |target: Vec3, share: f32| c = c.lerp(target, share.clamp(0.0, 1.0));
    blend(vec3(0.81, 0.620, 0.530), forehead * 0.7);
    blend(vec3(0.775, 0.515, 0.445), cheek * 0.75);
    blend(vec3(0.765, 0.490, 0.415), tip * 0.72);
    blend(vec3(0.735, 0.455, 0.385), wing * 0.65);
    blend(vec3(0.81, 0.64, 0.54), bridge * 0.4);
    blend(vec3(0.80, 0.590, 0.505), muzzle * 0.45);
    blend(vec3(0.67, 0.475, 0.425), bag * 0.55);
    blend(vec3(0.69, 0.470, 0.410), lid * 0.60);
    blend(vec3(0.66, 0.455, 0.395), socket * 0.45);
    blend(vec3(0.765, 0.525, 0.445), chin * 0.5);
    blend(vec3(0.785, 0.490, 0.430), ear * 0.5);
    blend(vec3(0.765, 0.575, 0.475), neck * 0.6);
    // Lines: the crease beside the nose, the rims of the lids.
    let chart = uv * CHART_MM;
    for painted in [&face.alar_crease, &face.lid_crease, &face.lid_margin] {
        blend(
            painted.colour,
            painted.share * painted.cover(chart, painted.half_width_mm),
        );
    }
    // The roots of the upper lashes, as a thin dark line.
    let upper = ramp(m.eye.y - 5.0 * s, m.eye.y - 1.0 * s, p.y);
    blend(
        vec3(0.17, 0.115, 0.095),
        0.85 * upper * face.lid_margin.cover(chart, 0.95),
    );
    // Under the hair the scalp is dark, so that nothing shines through between strands.
    let covered = face
        .hairline
        .as_ref()
        .map_or(0.0, |h| ramp(-0.3, 3.5, h.depth_mm(uv)));
    blend(HAIR, 0.92 * covered);

    let oil = 0.32 + 0.16 * forehead + 0.40 * tip + 0.20 * bridge + 0.14 * chin + 0.08 * lid
        - 0.16 * bag
        - 0.14 * neck;
    let depth = 0.85 - 0.45 * lid - 0.25 * bag - 0.1 * ear;
    let pores = 0.16 + 0.85 * tip + 0.55 * wing + 0.45 * cheek + 0.18 * forehead + 0.2 * chin;
    let thin = (0.95 * ear + 0.5 * wing + 0.3 * tip + 0.25 * lid).min(1.0);
    // Plain towards the window's sides, which the sampler goes on with.
    let x = (uv.x - WINDOW_MIN.x) / (WINDOW_MAX.x - WINDOW_MIN.x);
    let inner = ramp(0.0, FADE, x.min(1.0 - x));
    let c = vec3(0.765, 0.575, 0.475).lerp(c, inner);
    // Nothing fine is painted where hair hides it.
    let inner = inner * (1.0 - covered);
    let broad = inner * (fractal(chart.x * 0.055, chart.y * 0.055, 5) - 0.5);
    let c = c * (vec3(1.0, 1.0 - 0.05 * broad, 1.0 - 0.045 * broad) * (1.0 + 0.045 * broad));
    [
        c.x,
        c.y,
        c.z,
        oil,
        depth * inner,
        pores * inner,
        thin * inner,
        red,
        inner,
    ]
}
