//! The tones of a face by place on the reference head: where it is ruddy, pale, bluish; lips; the lines that features
//! draw on it; mottling and freckles. Colours are sRGB, 0..1.

use glam::{Vec2, Vec3, vec3};
use mouthpiece_rig::Head;

use crate::lines::{CHART_MM, Hairline, Line, waver_mm};
use crate::noise::{fractal, hash, ramp, unit, value};

/// Skin where nothing colours it.
const BASE: Vec3 = vec3(0.802, 0.606, 0.520);
/// Hair of brows and scalp, and the scalp between the roots.
const HAIR: Vec3 = vec3(0.185, 0.128, 0.096);
const SCALP: Vec3 = vec3(0.390, 0.285, 0.228);
/// Lower lip, upper lip, and where they touch.
const LIP: Vec3 = vec3(0.700, 0.425, 0.395);
const UPPER_LIP: Vec3 = vec3(0.655, 0.392, 0.365);
const CONTACT: Vec3 = vec3(0.490, 0.255, 0.240);

/// Places on the reference head, mm; sided ones are the subject's left.
const EYE: Vec3 = vec3(31.05, 36.04, 78.9);
const NOSE: Vec3 = vec3(0.0, 0.9, 130.0);
const MOUTH: Vec3 = vec3(0.0, -33.6, 112.7);

/// What is known of a place on the skin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// Place on the reference head, mm.
    pub(super) place: Vec3,
    /// Place in the chart.
    pub(super) chart: Vec2,
    /// Share of the lips' red, of their wet inner side, and of the light that reaches it.
    pub(super) red: f32,
    pub(super) wet: f32,
    pub(super) open: f32,
}

/// A feature line that colours the skin beside it.
#[derive(Clone, Debug)]
struct Painted {
    lines: Vec<Line>,
    half_width_mm: f32,
    colour: Vec3,
    share: f32,
}

impl Painted {
    fn of(head: &Head, name: &str, half_width_mm: f32, colour: Vec3, share: f32) -> Self {
        Self {
            lines: Line::pair(head, name),
            half_width_mm,
            colour,
            share,
        }
    }

    /// 1 on the line, falling to 0 within a few half widths.
    fn cover(&self, chart: Vec2, half_width_mm: f32) -> f32 {
        let near = self
            .lines
            .iter()
            .map(|l| l.distance(chart, 3.0 * half_width_mm))
            .fold(f32::INFINITY, f32::min);
        (-(near / half_width_mm).powi(2)).exp()
    }
}

/// What the tones of one head are laid by.
#[derive(Clone, Debug)]
pub(super) struct Face {
    creases: [Painted; 2],
    lid_margin: Painted,
    nose: Vec3,
    mouth: Vec3,
}

impl Face {
    pub(super) fn of(head: &Head) -> Self {
        Self {
            creases: [
                Painted::of(head, "alar_crease", 2.6, vec3(0.66, 0.41, 0.35), 0.34),
                Painted::of(head, "lid_crease", 1.3, vec3(0.57, 0.365, 0.305), 0.42),
            ],
            lid_margin: Painted::of(head, "lid_margin", 1.7, vec3(0.585, 0.365, 0.320), 0.60),
            nose: NOSE,
            mouth: MOUTH,
        }
    }

    /// The colour of a place, as bytes; `hair` is how much hair covers it.
    pub(super) fn colour(&self, spot: &Spot, hairline: Option<&Hairline>, hair: f32) -> [u8; 3] {
        let depth = hairline.map_or(-1e3, |h| h.depth_mm(spot.chart));
        // Where hair hides it nothing fine is painted: the file is smaller for it.
        let seen = ramp(14.0, 8.0, depth);
        let mut c = if seen > 0.0 {
            let c = self.zones(spot);
            let c = self.lined(c, spot);
            let c = mottled(c, spot, seen);
            self.lips(c, spot)
        } else {
            BASE
        };
        // Between the roots the scalp shows less and less.
        let chart = spot.chart * CHART_MM;
        let depth = depth - waver_mm(chart);
        c = c.lerp(SCALP, 0.92 * ramp(-4.0, 6.0, depth));
        c = c.lerp(HAIR, 0.85 * ramp(2.0, 11.0, depth));
        c = c.lerp(HAIR, hair.clamp(0.0, 1.0));
        c.to_array()
            .map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
    }

    /// The broad zones.
    fn zones(&self, spot: &Spot) -> Vec3 {
        let (nose, mouth, p) = (self.nose, self.mouth, spot.place);
        let side = vec3(p.x.abs(), p.y, p.z);
        // Ellipsoid blots, 1 in the middle.
        let blot =
            |centre: Vec3, radius: Vec3| (-((side - centre) / radius).length_squared()).exp();
        let cheek = blot(vec3(40.0, 0.0, 88.0), vec3(17.0, 16.0, 40.0));
        let cheek_wide = blot(vec3(44.0, -8.0, 80.0), vec3(27.0, 24.0, 45.0));
        let tip = blot(nose, vec3(13.0, 11.0, 20.0));
        let wing = blot(
            vec3(15.5, nose.y - 4.0, nose.z - 20.0),
            vec3(6.0, 7.0, 13.0),
        );
        let base = blot(
            vec3(8.0, nose.y - 12.0, nose.z - 16.0),
            vec3(9.0, 4.5, 12.0),
        );
        let bridge = blot(vec3(0.0, 26.0, nose.z - 18.0), vec3(7.0, 16.0, 22.0));
        let forehead = ramp(56.0, 78.0, p.y) * ramp(66.0, 38.0, side.x);
        let temple = blot(vec3(60.0, 55.0, 70.0), vec3(12.0, 22.0, 25.0));
        let ring = blot(vec3(EYE.x - 5.0, EYE.y - 15.0, 90.0), vec3(14.0, 4.2, 25.0));
        let inner = blot(vec3(17.0, EYE.y - 5.0, 92.0), vec3(5.0, 8.0, 16.0));
        let lid = blot(vec3(EYE.x, EYE.y + 8.0, 92.0), vec3(16.0, 5.5, 25.0));
        let socket = blot(vec3(16.5, EYE.y + 8.0, 92.0), vec3(6.5, 10.0, 22.0));
        let chin = blot(vec3(0.0, mouth.y - 27.0, 104.0), vec3(13.0, 9.0, 20.0));
        let muzzle = blot(vec3(0.0, mouth.y + 2.0, 104.0), vec3(30.0, 19.0, 30.0));
        let corner = blot(vec3(27.0, mouth.y - 1.0, 96.0), vec3(6.0, 5.0, 12.0));
        let jaw = ramp(-52.0, -72.0, p.y);
        // The ear: everything that stands off beside the jaw's joint.
        let ear = ramp(62.0, 70.0, side.x) * ramp(28.0, 17.0, p.z) * ramp(-32.0, -23.0, p.y);
        let rim = ear * ramp(76.0, 86.0, side.x).max(ramp(-8.0, -18.0, p.y));
        let neck = ramp(-70.0, -100.0, p.y);

        let mut c = BASE;
        let mut blend = |target: Vec3, share: f32| c = c.lerp(target, share.clamp(0.0, 1.0));
        blend(vec3(0.822, 0.640, 0.552), forehead * 0.75);
        blend(vec3(0.800, 0.625, 0.520), temple * 0.5);
        blend(vec3(0.795, 0.570, 0.492), cheek_wide * 0.62);
        blend(vec3(0.782, 0.508, 0.440), cheek * 0.40);
        blend(vec3(0.775, 0.500, 0.432), tip * 0.70);
        blend(vec3(0.742, 0.462, 0.395), wing * 0.62);
        blend(vec3(0.715, 0.445, 0.388), base * 0.45);
        blend(vec3(0.820, 0.645, 0.550), bridge * 0.45);
        blend(vec3(0.806, 0.602, 0.516), muzzle * 0.5);
        blend(vec3(0.735, 0.520, 0.450), corner * 0.45);
        blend(vec3(0.690, 0.528, 0.498), ring * 0.55);
        blend(vec3(0.665, 0.490, 0.470), inner * 0.45);
        blend(vec3(0.715, 0.500, 0.448), lid * 0.55);
        blend(vec3(0.690, 0.490, 0.432), socket * 0.42);
        blend(vec3(0.782, 0.545, 0.468), chin * 0.5);
        blend(vec3(0.770, 0.585, 0.494), jaw * 0.45);
        blend(vec3(0.772, 0.512, 0.452), ear * 0.55);
        blend(vec3(0.760, 0.462, 0.402), rim * 0.55);
        blend(vec3(0.765, 0.585, 0.490), neck * 0.6);
        // What lies deep is redder: light that gets out has been through skin.
        let deep = 1.0 - ramp(0.15, 0.75, spot.open);
        c.lerp(c * vec3(0.90, 0.76, 0.74), deep * (0.4 + 0.6 * ear))
    }

    /// Creases and the lids' rims.
    fn lined(&self, mut c: Vec3, spot: &Spot) -> Vec3 {
        if spot.place.z < 60.0 {
            return c;
        }
        let chart = spot.chart * CHART_MM;
        for line in self.creases.iter().chain([&self.lid_margin]) {
            c = c.lerp(
                line.colour,
                line.share * line.cover(chart, line.half_width_mm),
            );
        }
        // The roots of the upper lashes, as a thin dark line that fades towards the nose; faint below.
        let upper = ramp(EYE.y - 4.0, EYE.y + 0.5, spot.place.y);
        let out = ramp(16.0, 27.0, spot.place.x.abs());
        let roots = self.lid_margin.cover(chart, 0.75);
        c = c.lerp(
            vec3(0.16, 0.105, 0.085),
            roots * out * (0.10 + 0.52 * upper),
        );
        // The rim's inner edge is wet and pink.
        c.lerp(
            vec3(0.735, 0.470, 0.430),
            0.7 * ramp(0.3, 0.8, spot.wet) * (1.0 - spot.red),
        )
    }

    /// The red of the lips, with a soft border and creases across.
    fn lips(&self, c: Vec3, spot: &Spot) -> Vec3 {
        let chart = spot.chart * CHART_MM;
        let bend = 2.2 * value(chart.x * 0.18, chart.y * 0.30, 53);
        let crease = value(chart.x * 0.95 + bend, chart.y * 0.16, 61) - 0.5;
        let fine = value(chart.x * 2.1 + bend, chart.y * 0.35, 67) - 0.5;
        // The border frays along the creases.
        let red = ramp(0.02, 0.86, spot.red + 0.09 * crease + 0.05 * fine);
        if spot.red < 0.02 || spot.place.z < 60.0 {
            return c;
        }
        let upper = ramp(self.mouth.y - 3.0, self.mouth.y + 2.0, spot.place.y);
        let lip = LIP.lerp(UPPER_LIP, upper) * (1.0 + 0.075 * crease + 0.05 * fine);
        let lip = lip.lerp(CONTACT, ramp(0.10, 0.75, spot.wet) * 0.85);
        // Paler along the very border.
        let border = (-((spot.red - 0.22) / 0.13).powi(2)).exp();
        c.lerp(lip, 0.90 * red) * (1.0 + 0.010 * border)
    }
}

/// Blood shows as less green and blue, pigment as less of all: in three sizes; freckles over them.
fn mottled(c: Vec3, spot: &Spot, seen: f32) -> Vec3 {
    let at = spot.chart * CHART_MM;
    let broad = seen * (fractal(at.x * 0.055, at.y * 0.055, 5) - 0.5);
    let mottle = seen * (fractal(at.x * 0.20, at.y * 0.20, 7) - 0.5);
    let grain = seen * (value(at.x * 0.9, at.y * 0.9, 9) - 0.5);
    let red = vec3(
        1.0,
        1.0 - 0.060 * broad - 0.060 * mottle,
        1.0 - 0.055 * broad - 0.055 * mottle,
    );
    let c = c * red * (1.0 + 0.040 * broad + 0.016 * grain);
    // More of them where the sun falls: nose and cheeks.
    let likely = (-((spot.place.y - 8.0) / 26.0).powi(2)).exp() * ramp(60.0, 85.0, spot.place.z);
    c * (1.0 - vec3(0.13, 0.20, 0.24) * (seen * freckle(at, likely)))
}

/// How dark a freckle or mole makes a place, 0..1.
fn freckle(at: Vec2, likely: f32) -> f32 {
    const SIDE_MM: f32 = 4.2;
    let (cx, cy) = ((at.x / SIDE_MM) as i32, (at.y / SIDE_MM) as i32);
    if unit(hash(cx, cy, 91)) > 0.04 + 0.12 * likely {
        return 0.0;
    }
    let within = |seed| 0.25 + 0.5 * unit(hash(cx, cy, seed));
    let centre = Vec2::new(cx as f32 + within(92), cy as f32 + within(93)) * SIDE_MM;
    let radius = 0.4 + 0.5 * unit(hash(cx, cy, 94));
    0.55 * unit(hash(cx, cy, 95)) * ramp(radius, radius * 0.3, at.distance(centre))
}
