//! The reference mouth: lips as columns from the vermilion border over crest and contact line to the inner side, and
//! closed rings round it on the skin (HEADSHOP 3).

use glam::{Vec3, vec2, vec3};
use mouthpiece_rig::LIP_LEVELS;
use mouthpiece_rig::lip_level::{CONTACT, INNER};

use super::half::Half;
use super::polyline::{at_x, superellipse};
use super::target::{ChartPoint, Target, chart_of};

/// Columns from the mid line to the corner of the mouth, both included.
const STATIONS: usize = 15;
const CORNER: usize = STATIONS - 1;
/// Where the slit between the lips ends; the corner's skin (cheilion) lies a little further out.
const SLIT_END: Vec3 = vec3(24.2, -35.0, 101.9);
const CHEILION_X: f32 = 26.4;
/// How far along the way from the border to the contact line the levels between them lie.
const LEVELS: [f32; CONTACT + 1] = [0.0, 0.24, 0.45, 0.64, 0.83, 1.0];
/// Share of the closing of the lips that each of those levels takes part in.
const CLOSING: [f32; CONTACT + 1] = [0.0, 0.12, 0.3, 0.5, 0.75, 1.0];
/// The inner side: upwards and backwards from the contact line, mm.
const INSIDE: [(f32, f32); LIP_LEVELS - INNER] = [(0.0, 2.2), (3.0, 3.7), (8.6, 4.2)];
/// Rings on the skin round the border: how far along the way to the outermost, which is a superellipse in the chart.
const RINGS: [f32; 7] = [0.08, 0.18, 0.30, 0.44, 0.60, 0.79, 1.0];
const OUTERMOST: ChartPoint = vec2(43.0, -35.0);
const UP_MM: f32 = 20.2;
const DOWN_MM: f32 = 27.0;

/// One lip's vertices: `[station][level]`, from the mid line to the corner.
pub(super) type Rows = Vec<[usize; LIP_LEVELS]>;

/// The mouth in the half template.
pub(super) struct Mouth {
    pub upper: Rows,
    pub lower: Rows,
    /// The outermost ring, from the mid line below to the one above.
    pub outline: Vec<usize>,
}

/// A column of one lip.
struct Column {
    chart: [ChartPoint; CONTACT + 1],
    points: [Vec3; LIP_LEVELS],
}

/// Places the lips and the rings round them.
pub(super) fn build(half: &mut Half, target: &Target) -> Mouth {
    let upper = place(half, &columns(target, 1.0), None);
    let lower = place(half, &columns(target, -1.0), Some(upper[CORNER]));
    // Rows run counter-clockwise as seen from the front: below from the mid line outwards, above back to it.
    for level in 0..LIP_LEVELS - 1 {
        let row = |rows: &Rows, level: usize| rows.iter().map(|r| r[level]).collect::<Vec<_>>();
        let back = |mut row: Vec<usize>| {
            row.reverse();
            row
        };
        half.strip(&row(&lower, level), &row(&lower, level + 1), false);
        half.strip(
            &back(row(&upper, level)),
            &back(row(&upper, level + 1)),
            false,
        );
    }
    for rows in [&upper, &lower] {
        let sharp = rows.windows(2).map(|w| [w[0][CONTACT], w[1][CONTACT]]);
        half.creases.extend(sharp);
    }
    let border: Vec<usize> = lower
        .iter()
        .chain(upper.iter().rev().skip(1))
        .map(|r| r[0])
        .collect();
    let mut inner = border.clone();
    for share in RINGS {
        let ring: Vec<usize> = border
            .iter()
            .enumerate()
            .map(|(i, &b)| {
                let from = half.vertices[b].chart;
                // From straight down (-1) over the corner (0) to straight up (1).
                let turn = (i as f32 / CORNER as f32 - 1.0) * std::f32::consts::FRAC_PI_2;
                let height = if turn > 0.0 { UP_MM } else { DOWN_MM };
                let out = superellipse(turn, vec2(OUTERMOST.x, height), 2.6);
                let chart = from.lerp(vec2(0.0, OUTERMOST.y) + out, share);
                let chart = if i == 0 || i == border.len() - 1 {
                    vec2(0.0, chart.y)
                } else {
                    chart
                };
                half.on_chart(target, chart)
            })
            .collect();
        half.strip(&ring, &inner, false);
        inner = ring;
    }
    Mouth {
        upper,
        lower,
        outline: inner,
    }
}

/// One lip's columns, from the mid line to the corner. `sign` is 1 for the upper lip.
///
/// The surface data holds the lips 0.8 mm apart; here they meet at rest, since a mouth at rest is closed: the contact
/// line goes to the middle, the levels before it a part of the way.
fn columns(target: &Target, sign: f32) -> Vec<Column> {
    let curves = &target.curves;
    let (vermilion, own, other) = if sign > 0.0 {
        (
            &curves.vermilion_upper,
            &curves.lip_contact_upper,
            &curves.lip_contact_lower,
        )
    } else {
        (
            &curves.vermilion_lower,
            &curves.lip_contact_lower,
            &curves.lip_contact_upper,
        )
    };
    let contact = |line: &[Vec3], x: f32| {
        let last = line.last().copied().unwrap_or(SLIT_END);
        if x <= last.x {
            at_x(line, x)
        } else {
            last.lerp(SLIT_END, (x - last.x) / (SLIT_END.x - last.x))
        }
    };
    (0..STATIONS)
        .map(|i| {
            let share = i as f32 / CORNER as f32;
            let corner = i == CORNER;
            let x = SLIT_END.x * share;
            let meeting = (contact(own, x) + contact(other, x)) * 0.5;
            let closing = meeting - contact(own, x);
            let border = if corner {
                target.seen_from_front(CHEILION_X, -35.2)
            } else {
                at_x(vermilion, x + (CHEILION_X - SLIT_END.x) * share.powi(4))
            };
            let (from, to) = (chart_of(border), chart_of(meeting));
            let narrow = 1.0 - 0.5 * share.powi(3);
            let mut points = [meeting; LIP_LEVELS];
            let mut chart = [to; CONTACT + 1];
            for level in 0..CONTACT {
                chart[level] = from.lerp(to, LEVELS[level]);
                points[level] = target.point(chart[level]) + closing * CLOSING[level];
            }
            points[0] = border;
            for (point, (rise, back)) in points[INNER..].iter_mut().zip(INSIDE) {
                // At the corner the inner side runs straight back.
                let (rise, back) = if corner {
                    (0.0, 0.5 * (back + rise))
                } else {
                    (sign * rise * narrow, back)
                };
                *point = meeting + vec3(-0.05 * x * share * back / 6.0, rise, -back);
            }
            Column { chart, points }
        })
        .collect()
}

/// Pushes the vertices of one lip. At the corner both lips share theirs, of which there are two on the skin (border and
/// contact) and those of the inner side.
fn place(half: &mut Half, columns: &[Column], corner: Option<[usize; LIP_LEVELS]>) -> Rows {
    const RED: [f32; CONTACT + 1] = [0.45, 1.0, 1.0, 1.0, 1.0, 1.0];
    const WET: [f32; CONTACT + 1] = [0.0, 0.0, 0.0, 0.08, 0.2, 0.5];
    let mut rows = Rows::new();
    for (i, column) in columns.iter().enumerate() {
        let at_corner = i == CORNER;
        if let (true, Some(shared)) = (at_corner, corner) {
            rows.push(shared);
            continue;
        }
        let mut numbers = [usize::MAX; LIP_LEVELS];
        for level in 0..LIP_LEVELS {
            numbers[level] = match (CORNER - i, level) {
                (0 | 1, 1 | 2) => numbers[0],
                (0 | 1, 4 | CONTACT) => numbers[3],
                (0 | 1, 3) => half.push(column.points[CONTACT], column.chart[CONTACT]),
                // Towards the corner the red is too low for all its levels.
                (2, 2 | 4) => numbers[level - 1],
                _ => half.push(column.points[level], column.chart[level.min(CONTACT)]),
            };
            let vertex = &mut half.vertices[numbers[level]];
            let fade = if at_corner && level < 3 { 0.3 } else { 1.0 };
            vertex.vermilion = fade * RED.get(level).copied().unwrap_or(1.0);
            vertex.wet = WET.get(level).copied().unwrap_or(1.0);
            if i == 0 {
                vertex.position.x = 0.0;
                vertex.chart.x = 0.0;
            }
        }
        rows.push(numbers);
    }
    rows
}
