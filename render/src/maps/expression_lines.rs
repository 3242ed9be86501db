//! The lines that expressions draw on a face, found from a head's landmarks and feature lines: each method lays those
//! of one muscle group in the chart, in mm. See `wrinkles` for what becomes of them.

use glam::{Vec2, vec2};
use mouthpiece_rig::{Head, Layer};

use super::CHART_MM;
use super::creases::Crease;
use super::noise::value;

/// Where things are in the chart of a head, mm.
pub(super) struct Face<'a> {
    pub(super) head: &'a Head,
}

/// The subject's left and right.
const SIDES: [(&str, f32); 2] = [("l", 1.0), ("r", -1.0)];

impl Face<'_> {
    /// A landmark of the skin.
    pub(super) fn mark(&self, name: &str) -> Option<Vec2> {
        let uvs = &self.head.skin.mesh.uvs;
        let mark = self
            .head
            .landmarks
            .iter()
            .find(|l| l.layer == Layer::Skin && l.name == name)?;
        let mut uv = Vec2::ZERO;
        for (vertex, share) in mark.at.vertices.iter().zip(mark.at.shares) {
            uv += *uvs.get(*vertex as usize)? * share;
        }
        Some(uv * CHART_MM)
    }

    fn sided(&self, name: &str, side: &str) -> Option<Vec2> {
        self.mark(&format!("{name}_{side}"))
    }

    /// A feature line of one side.
    fn line(&self, name: &str, side: &str) -> Option<Vec<Vec2>> {
        let line = self.head.feature(&format!("{name}_{side}"))?;
        Some(line.points.iter().map(|p| *p * CHART_MM).collect())
    }

    /// Across the forehead, from brow to hairline, in pieces, following the brows' course weakly.
    pub(super) fn forehead(&self) -> Vec<Crease> {
        let (Some(left), Some(right)) =
            (self.line("brow_upper", "l"), self.line("brow_upper", "r"))
        else {
            return Vec::new();
        };
        let brow: Vec<Vec2> = left.iter().chain(&right).copied().collect();
        let brow_y = brow.iter().map(|p| p.y).sum::<f32>() / brow.len() as f32;
        let half = brow
            .iter()
            .map(|p| (p.x - 0.5 * CHART_MM.x).abs())
            .fold(0.0, f32::max);
        let top = self
            .mark("tr")
            .map_or(brow_y - 48.0, |p| p.y)
            .max(brow_y - 70.0);
        let mut creases = Vec::new();
        const LINES: usize = 6;
        for k in 0..LINES {
            let up = (k as f32 + 0.75) / (LINES as f32 + 0.3);
            let level = brow_y + (top - brow_y) * up;
            // The outer lines are the shorter; a line comes in two or three pieces that pass each other.
            let reach = half * (0.86 - 0.32 * (up - 0.35).abs());
            let shift = 7.0 * (value(k as f32 * 1.7, 0.5, 5) - 0.5);
            let pieces: &[[f32; 2]] = if k % 2 == 0 {
                &[[-1.0, 0.12], [0.02, 1.0]]
            } else {
                &[[-0.95, -0.22], [-0.36, 0.52], [0.40, 0.93]]
            };
            for (piece, [from, to]) in pieces.iter().enumerate() {
                let points = (0..=10)
                    .map(|i| {
                        let x = (from + (to - from) * i as f32 / 10.0) * reach + shift;
                        let s = x / half;
                        // Low in the middle, up over the brows, down at the temples; and wavering.
                        let arch = -3.2 * (1.0 - (2.4 * (s.abs() - 0.5)).powi(2)).max(-1.0);
                        let waver = 3.4 * (value(x * 0.07 + 9.0, k as f32 * 3.1, 31) - 0.5)
                            + 1.1 * piece as f32 * (value(x * 0.2 + 40.0, k as f32, 32) - 0.5);
                        vec2(
                            0.5 * CHART_MM.x + x,
                            level + arch * (1.0 - 0.6 * up) + waver,
                        )
                    })
                    .collect();
                creases.push(Crease {
                    points,
                    depth_mm: [0.40, 0.52, 0.55, 0.46, 0.36, 0.24][k],
                    half_width_mm: 0.95 + 0.15 * (k % 3) as f32,
                    shoulders: [0.55, 0.42],
                    fade: [0.28, 0.28],
                });
            }
        }
        creases
    }

    /// From the wings of the nose to beside the mouth, a second fold in the cheek, and below the corners.
    pub(super) fn smile(&self) -> Vec<Crease> {
        let mut creases = Vec::new();
        for (side, out) in SIDES {
            let (Some(al), Some(ch)) = (self.sided("al", side), self.sided("ch", side)) else {
                continue;
            };
            let off = |from: Vec2, across: f32, down: f32| from + vec2(across * out, down);
            // The shoulder is on the cheek's side; which hand that is goes by the side.
            let cheek = |high: f32, low: f32| if out > 0.0 { [high, low] } else { [low, high] };
            let middle = al.lerp(ch, 0.5);
            creases.push(Crease {
                points: vec![
                    off(al, 0.5, -8.0),
                    off(al, 5.0, -2.5),
                    off(middle, 10.5, -4.5),
                    off(ch, 13.5, -12.0),
                    off(ch, 17.5, -3.0),
                    off(ch, 18.0, 6.0),
                ],
                depth_mm: 0.50,
                half_width_mm: 2.9,
                shoulders: cheek(0.55, 0.08),
                fade: [0.20, 0.40],
            });
            creases.push(Crease {
                points: vec![
                    off(ch, 23.0, -15.0),
                    off(ch, 26.5, -6.0),
                    off(ch, 26.5, 4.0),
                ],
                depth_mm: 0.14,
                half_width_mm: 2.3,
                shoulders: cheek(0.5, 0.3),
                fade: [0.35, 0.35],
            });
            creases.push(Crease {
                points: vec![off(ch, 3.5, -1.5), off(ch, 6.0, 1.0), off(ch, 6.5, 5.0)],
                depth_mm: 0.24,
                half_width_mm: 1.3,
                shoulders: cheek(0.4, 0.1),
                fade: [0.25, 0.4],
            });
        }
        creases
    }

    /// Between lip and chin, and down from the corners of the mouth.
    pub(super) fn chin(&self) -> Vec<Crease> {
        let mut creases = Vec::new();
        if let Some(sl) = self.mark("sl") {
            let at = |across: f32, down: f32| sl + vec2(across, down);
            creases.push(Crease {
                points: vec![
                    at(-17.0, 4.0),
                    at(-9.0, 0.8),
                    at(0.0, 0.0),
                    at(9.0, 0.8),
                    at(17.0, 4.0),
                ],
                depth_mm: 0.75,
                half_width_mm: 2.1,
                shoulders: [0.2, 0.5],
                fade: [0.3, 0.3],
            });
        }
        for (side, out) in SIDES {
            if let Some(ch) = self.sided("ch", side) {
                let off = |across: f32, down: f32| ch + vec2(across * out, down);
                creases.push(Crease {
                    points: vec![off(2.5, 4.5), off(5.0, 11.0), off(6.0, 18.0)],
                    depth_mm: 0.45,
                    half_width_mm: 1.4,
                    shoulders: [0.3, 0.3],
                    fade: [0.3, 0.45],
                });
            }
        }
        creases
    }

    /// Upright between the brows.
    pub(super) fn frown(&self) -> Vec<Crease> {
        let mut creases = Vec::new();
        for (side, out) in SIDES {
            let (Some(upper), Some(lower)) =
                (self.line("brow_upper", side), self.line("brow_lower", side))
            else {
                continue;
            };
            let inner = |line: &[Vec2]| {
                let off = |p: &Vec2| (p.x - 0.5 * CHART_MM.x) * out;
                line.iter()
                    .copied()
                    .min_by(|a, b| off(a).total_cmp(&off(b)))
            };
            let (Some(top), Some(bottom)) = (inner(&upper), inner(&lower)) else {
                continue;
            };
            let middle = 0.5 * CHART_MM.x;
            let across = (top.x - middle) * out;
            let at = |share: f32, y: f32| vec2(middle + across * share * out, y);
            // The left line is the longer in most faces.
            let tall = if out > 0.0 { 1.0 } else { 0.82 };
            creases.push(Crease {
                points: vec![
                    at(0.50, bottom.y + 4.0),
                    at(0.66, bottom.y - 1.5),
                    at(if out > 0.0 { 0.58 } else { 0.70 }, top.y - 4.0 * tall),
                    at(0.72, top.y - 8.0 * tall),
                    at(if out > 0.0 { 0.98 } else { 0.82 }, top.y - 14.0 * tall),
                ],
                depth_mm: 0.68,
                half_width_mm: 1.7,
                shoulders: [0.6, 0.6],
                fade: [0.25, 0.45],
            });
            creases.push(Crease {
                points: vec![
                    at(1.12, top.y + 1.0),
                    at(1.18, top.y - 5.0),
                    at(1.38, top.y - 11.0),
                ],
                depth_mm: 0.45,
                half_width_mm: 1.2,
                shoulders: [0.5, 0.5],
                fade: [0.35, 0.45],
            });
        }
        creases
    }

    /// Fanned out from the outer corner of the eye, and under the lower lid.
    pub(super) fn crow(&self) -> Vec<Crease> {
        /// Angle up from the horizontal (degrees), length (mm), depth (mm).
        const RAYS: [[f32; 3]; 5] = [
            [40.0, 15.0, 0.34],
            [19.0, 20.0, 0.48],
            [1.0, 22.0, 0.52],
            [-19.0, 21.0, 0.46],
            [-38.0, 18.0, 0.34],
        ];
        let mut creases = Vec::new();
        for (side, out) in SIDES {
            let (Some(ex), Some(en)) = (self.sided("ex", side), self.sided("en", side)) else {
                continue;
            };
            for (k, [degrees, length, depth_mm]) in RAYS.into_iter().enumerate() {
                let vary = value(k as f32 * 2.3, out * 3.0 + 9.0, 41) - 0.5;
                let (sin, cos) = (degrees + 12.0 * vary).to_radians().sin_cos();
                let ray = |t: f32, sag: f32| ex + vec2(out * (4.0 + t * cos), -t * sin + sag);
                let length = length * (1.0 + 0.35 * vary);
                let sag = 0.10 * length * sin.signum();
                creases.push(Crease {
                    points: vec![
                        ray(2.5, 0.0),
                        ray(0.40 * length, sag * 0.6),
                        ray(0.72 * length, sag * 0.7),
                        ray(length, 0.0),
                    ],
                    depth_mm,
                    half_width_mm: 0.95,
                    shoulders: [0.5, 0.5],
                    fade: [0.22, 0.5],
                });
            }
            for (down, depth_mm) in [(6.0, 0.26), (9.5, 0.36), (13.0, 0.24)] {
                let at = |share: f32, extra: f32| en.lerp(ex, share) + vec2(0.0, down + extra);
                creases.push(Crease {
                    points: vec![
                        at(0.12, -1.0),
                        at(0.35, 1.6),
                        at(0.65, 1.8),
                        at(0.92, 0.0),
                        at(1.12, -2.5),
                    ],
                    depth_mm,
                    half_width_mm: 0.9,
                    shoulders: [0.45, 0.45],
                    fade: [0.35, 0.3],
                });
            }
        }
        creases
    }

    /// Across the root of the nose, and down its sides.
    pub(super) fn nose(&self) -> Vec<Crease> {
        let (Some(n), Some(tip)) = (self.mark("n"), self.mark("prn")) else {
            return Vec::new();
        };
        let mut creases = Vec::new();
        for (down, depth_mm) in [(-4.0, 0.22), (0.5, 0.34), (4.5, 0.20)] {
            let at = |across: f32, sag: f32| n + vec2(across, down + sag);
            creases.push(Crease {
                points: vec![at(-11.0, 1.0), at(-4.0, -0.6), at(4.0, 0.2), at(11.0, 0.6)],
                depth_mm,
                half_width_mm: 1.0,
                shoulders: [0.5, 0.5],
                fade: [0.35, 0.35],
            });
        }
        for (_, out) in SIDES {
            for (k, depth_mm) in [0.30, 0.42, 0.34].into_iter().enumerate() {
                let start = n.lerp(tip, 0.14 + 0.14 * k as f32);
                let at = |across: f32, down: f32| start + vec2(across * out, down);
                creases.push(Crease {
                    points: vec![at(8.0, -2.0), at(12.5, 0.5), at(17.0, 5.0 + k as f32)],
                    depth_mm,
                    half_width_mm: 1.05,
                    shoulders: [0.5, 0.5],
                    fade: [0.35, 0.4],
                });
            }
        }
        creases
    }

    /// Upright round the lips, as they are pursed.
    pub(super) fn rays(&self) -> Vec<Crease> {
        let (Some(left), Some(right)) = (self.mark("ch_l"), self.mark("ch_r")) else {
            return Vec::new();
        };
        let (Some(ls), Some(li)) = (self.mark("ls"), self.mark("li")) else {
            return Vec::new();
        };
        let half = (left.x - right.x).abs() * 0.5;
        let mut creases = Vec::new();
        for (border, up, count) in [(ls.y, -1.0_f32, 8), (li.y, 1.0, 7)] {
            for k in 0..count {
                let s = (k as f32 + 0.5) / count as f32 * 2.0 - 1.0;
                let vary = value(k as f32 * 1.9 + 3.0, up + 4.0, 47) - 0.5;
                let x = ls.x + (s + 0.10 * vary) * half * 0.86;
                // The red's border falls away towards the corners.
                let corner = left.y.midpoint(right.y);
                let start = border + (corner - border) * s.abs().powi(2) * 0.72 + 0.6 * up;
                let length = (7.0 + 5.0 * vary) * (1.0 - 0.25 * s.abs());
                creases.push(Crease {
                    points: vec![
                        vec2(x, start),
                        vec2(x + 0.9 * s, start + up * length * 0.5),
                        vec2(x + 2.6 * s, start + up * length),
                    ],
                    depth_mm: 0.24 + 0.18 * vary,
                    half_width_mm: 0.9,
                    shoulders: [0.5, 0.5],
                    fade: [0.15, 0.6],
                });
            }
        }
        creases
    }
}
