//! The reference mouth: lips as columns from the vermilion border over crest and contact line to the inner side, and
//! closed rings round it on the skin (HEADSHOP 3).

use glam::{Vec3, vec2, vec3};
use mouthpiece_rig::LIP_LEVELS;
use mouthpiece_rig::lip_level::{CONTACT, INNER};

use super::half::Half;
use super::polyline::{at_x, evenly, superellipse};
use super::target::{ChartPoint, Target, chart_of};

/// Columns from the mid line to the corner of the mouth, both included.
const STATIONS: usize = 20;
const CORNER: usize = STATIONS - 1;
/// Where the slit between the lips ends; the corner's skin (cheilion) lies a little further out.
const SLIT_END: Vec3 = vec3(24.2, -35.0, 101.9);
const CHEILION_X: f32 = 26.4;
/// Share of the way from the border to the contact line on which a look from the front sees the lip itself.
const SEEN: f32 = 0.84;
/// The red is not divided finer than this, mm: towards the corner it becomes low.
const LOW_MM: f32 = 0.9;
/// The inner side: upwards and backwards from the contact line, mm.
const INSIDE: [(f32, f32); LIP_LEVELS - INNER] = [(0.5, 2.2), (3.2, 3.7), (8.6, 4.2)];
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
    /// From the border to the contact line, evenly spaced: fewer than levels where the red is low.
    red: Vec<Vec3>,
    inside: [Vec3; LIP_LEVELS - INNER],
}

impl Column {
    /// Which point of the red a level is: neighbouring levels share points where there are few.
    fn point(&self, level: usize) -> usize {
        let last = self.red.len() - 1;
        (level * last + CONTACT / 2) / CONTACT
    }
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
/// line goes to the middle, what lies before it a part of the way.
fn columns(target: &Target, sign: f32) -> Vec<Column> {
    const STEPS: usize = 24;
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
    let fine = |i: usize| SLIT_END.x * i as f32 / (4 * STEPS) as f32;
    let meeting = |x: f32| (contact(own, x) + contact(other, x)) * 0.5;
    let slit: Vec<Vec3> = (0..=4 * STEPS).map(|i| meeting(fine(i))).collect();
    let slit = evenly(&slit, STATIONS);
    let mut border: Vec<Vec3> = vermilion
        .iter()
        .filter(|p| p.x < CHEILION_X - 1.5)
        .copied()
        .collect();
    border.push(target.seen_from_front(CHEILION_X, -35.2));
    let border = evenly(&border, STATIONS);
    (0..STATIONS)
        .map(|i| {
            let share = i as f32 / CORNER as f32;
            let meeting = slit[i];
            let closing = meeting - contact(own, meeting.x);
            let (from, to) = (chart_of(border[i]), chart_of(meeting));
            let mut way: Vec<Vec3> = (0..STEPS)
                .map(|k| SEEN * k as f32 / (STEPS - 1) as f32)
                .map(|f| target.point(from.lerp(to, f)) + closing * f.powf(1.5))
                .collect();
            way[0] = border[i];
            way.push(meeting);
            let length: f32 = way.windows(2).map(|w| w[0].distance(w[1])).sum();
            let segments = ((length / LOW_MM) as usize).clamp(1, CONTACT);
            let segments = if i == CORNER { 1 } else { segments };
            let narrow = 1.0 - 0.5 * share.powi(3);
            let inside = INSIDE.map(|(rise, back)| {
                // At the corner the inner side runs straight back.
                let (rise, back) = if i == CORNER {
                    (0.0, 0.5 * (back + rise))
                } else {
                    (sign * rise * narrow, back)
                };
                meeting + vec3(-0.05 * meeting.x * share * back / 6.0, rise, -back)
            });
            let mut red = evenly(&way, segments + 1);
            // To the bit, so that both lips' lines are one.
            red[segments] = meeting;
            Column { red, inside }
        })
        .collect()
}

/// Pushes the vertices of one lip. At the corner both lips share theirs.
fn place(half: &mut Half, columns: &[Column], corner: Option<[usize; LIP_LEVELS]>) -> Rows {
    let mut rows = Rows::new();
    for (i, column) in columns.iter().enumerate() {
        if let (CORNER, Some(shared)) = (i, corner) {
            rows.push(shared);
            continue;
        }
        let last = column.red.len() - 1;
        let red: Vec<usize> = column
            .red
            .iter()
            .enumerate()
            .map(|(k, &p)| {
                let v = half.on_skin(p);
                let inwards = k as f32 / last as f32;
                let vertex = &mut half.vertices[v];
                vertex.vermilion = match k {
                    0 if i == CORNER => 0.14,
                    0 => 0.45,
                    _ => 1.0,
                };
                vertex.wet = 0.5 * ((inwards - 0.4).max(0.0) / 0.6).powi(2);
                v
            })
            .collect();
        let chart = half.vertices[red[last]].chart;
        let inside = column.inside.map(|p| {
            let v = half.push(p, chart);
            half.vertices[v].vermilion = 1.0;
            half.vertices[v].wet = 1.0;
            v
        });
        let mut numbers = [0; LIP_LEVELS];
        for (level, number) in numbers.iter_mut().enumerate() {
            *number = match level.checked_sub(INNER) {
                Some(k) => inside[k],
                None => red[column.point(level)],
            };
        }
        if i == 0 {
            for &v in red.iter().chain(&inside) {
                half.vertices[v].position.x = 0.0;
                half.vertices[v].chart.x = 0.0;
            }
        }
        rows.push(numbers);
    }
    rows
}
