//! The strands' map that hair cards show: columns of painted strands, roots at the top. The first are dense, then
//! come loose locks, one thick and the rest thin, then single hairs: `hair` in the head shop says which card shows which.
//! R tone of the strand, G 255, B its shift, A how much it covers.

use glam::{Vec2, vec2};

use super::image::Image;
use super::noise::{Dice, value};
use super::parallel_rows;
use super::strokes::{Blend, Field, Stroke};

/// Columns of equal width; how many are dense, and how many are loose locks. Keep in step with the head
/// shop's `hair`.
const COLUMNS: usize = 8;
const DENSE: usize = 4;
const LOOSE: usize = 2;

/// The map, `side` texels wide and half as high.
pub(crate) fn paint(side: usize) -> Image {
    let (width, height) = (side, (side / 2).max(1));
    // Tone, shift, cover.
    let mut field = Field::new(width, height, [0.30, 0.5, 0.0]);
    for column in 0..COLUMNS {
        strands(&mut field, column);
    }
    let mut image = Image::new(width, height);
    parallel_rows(&mut image.texels, width, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let [tone, shift, cover] =
                field.values[y * width + x].map(|v| (v.clamp(0.0, 1.0) * 255.0) as u8);
            *texel = [tone, 255, shift, cover];
        }
    });
    image
}

/// Strands of one column, back to front.
fn strands(field: &mut Field<3>, column: usize) {
    let size = vec2(field.width as f32 / COLUMNS as f32, field.height as f32);
    let left = column as f32 * size.x;
    let mut dice = Dice::new(1201 + column as u64);
    // How many, how wide as a share of the column, how far they stay from its sides.
    let (count, wide, margin) = if column < DENSE {
        (150, 0.030, 0.03)
    } else if column == DENSE {
        (46, 0.030, 0.10)
    } else if column < DENSE + LOOSE {
        (17, 0.030, 0.08)
    } else {
        (3, 0.085, 0.30)
    };
    let loose = column >= DENSE;
    for i in 0..count {
        let back = 1.0 - i as f32 / count as f32;
        let across = dice.roll();
        // Locks: strands of one lock end together and share a tone.
        let lock = value(
            across * if loose { 3.0 } else { 5.0 },
            column as f32 * 7.3,
            31,
        );
        let x = margin + (1.0 - 2.0 * margin) * across;
        let lean = 0.16 * dice.spread() + 0.10 * (lock - 0.5);
        let bend = 0.10 * dice.spread();
        let (start, end) = if loose {
            (
                0.02 + 0.22 * dice.roll(),
                0.58 + 0.40 * dice.roll() * (0.4 + 0.6 * lock),
            )
        } else {
            (
                0.02 + 0.34 * dice.roll(),
                0.60 + 0.39 * (0.5 * dice.roll() + 0.5 * lock),
            )
        };
        // Tips of a lock draw together.
        let gather = (lock - across) * if loose { 0.16 } else { 0.08 };
        let at = |across: f32, along: f32| {
            vec2(
                left + across.clamp(margin * 0.5, 1.0 - margin * 0.5) * size.x,
                along * size.y,
            )
        };
        let points: [Vec2; 3] = [
            at(x, start),
            at(x + 0.5 * lean + bend, 0.5 * (start + end)),
            at(x + lean + gather, end),
        ];
        let tone = 0.24 + 0.34 * lock + 0.36 * dice.roll() - 0.14 * back;
        let stroke = Stroke {
            points,
            half_width: (wide * (0.6 + 0.8 * dice.roll()) * size.x).max(0.5),
            strength: [tone.clamp(0.0, 1.0), dice.roll(), 1.0],
        };
        field.draw(&stroke, Blend::Over);
    }
}
