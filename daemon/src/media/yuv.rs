//! RGB as screens take it to planar YUV 4:2:0 as video encoders take it: BT.709, limited range.
//!
//! Integers only, so that every machine gives the same bytes. The matrix is that of ITU-R BT.709-6
//! section 3, scaled to 219 and 224 steps and 16 bits of fraction; each chroma value is the mean
//! of its four pixels. The video must be labelled accordingly, or players guess BT.601 for small
//! pictures and skin turns orange.

/// A picture as three planes; chroma has half the width and height.
#[derive(Clone, Debug, Default)]
pub struct Yuv {
    pub width: usize,
    pub height: usize,
    pub y: Vec<u8>,
    pub u: Vec<u8>,
    pub v: Vec<u8>,
}

impl Yuv {
    /// For pictures of even `width` and `height`.
    pub fn new(width: usize, height: usize) -> Self {
        let chroma = (width / 2) * (height / 2);
        Self {
            width,
            height,
            y: vec![0; width * height],
            u: vec![0; chroma],
            v: vec![0; chroma],
        }
    }

    /// Converts `rgba`, rows from the top, `width * height * 4` bytes.
    pub fn set(&mut self, rgba: &[u8]) {
        let half = self.width / 2;
        let rows = rgba.chunks_exact(self.width * 8);
        let luma = self.y.chunks_exact_mut(self.width * 2);
        let chroma = self
            .u
            .chunks_exact_mut(half)
            .zip(self.v.chunks_exact_mut(half));
        for ((two_rows, luma), (u, v)) in rows.zip(luma).zip(chroma) {
            for (pixel, y) in two_rows.chunks_exact(4).zip(luma.iter_mut()) {
                let [r, g, b] = [pixel[0], pixel[1], pixel[2]].map(i32::from);
                *y = ((11_966 * r + 40_254 * g + 4_064 * b + (16 << 16) + HALF) >> 16) as u8;
            }
            let (above, below) = two_rows.split_at(self.width * 4);
            let squares = above.chunks_exact(8).zip(below.chunks_exact(8));
            for ((a, b), (u, v)) in squares.zip(u.iter_mut().zip(v.iter_mut())) {
                let sum = |i: usize| {
                    i32::from(a[i]) + i32::from(a[i + 4]) + i32::from(b[i]) + i32::from(b[i + 4])
                };
                let [r, g, b] = [sum(0), sum(1), sum(2)];
                *u = ((-6_596 * r - 22_189 * g + 28_785 * b + CENTRE) >> 18) as u8;
                *v = ((28_785 * r - 26_145 * g - 2_640 * b + CENTRE) >> 18) as u8;
            }
        }
    }
}

const HALF: i32 = 1 << 15;
/// 128 and a half, at 18 bits of fraction: two more, for the sum of four pixels.
const CENTRE: i32 = (128 << 18) + (1 << 17);

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(rgb: [u8; 3]) -> [u8; 3] {
        let mut yuv = Yuv::new(2, 2);
        yuv.set(&[rgb[0], rgb[1], rgb[2], 255].repeat(4));
        [yuv.y[3], yuv.u[0], yuv.v[0]]
    }

    /// The values of BT.709's colour bars at 8 bits, limited range.
    #[test]
    fn colour_bars_have_the_values_of_the_standard() {
        assert_eq!(flat([0, 0, 0]), [16, 128, 128]);
        assert_eq!(flat([255, 255, 255]), [235, 128, 128]);
        assert_eq!(flat([255, 0, 0]), [63, 102, 240]);
        assert_eq!(flat([0, 255, 0]), [173, 42, 26]);
        assert_eq!(flat([0, 0, 255]), [32, 240, 118]);
    }
}
