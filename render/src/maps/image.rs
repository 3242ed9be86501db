//! An image of four bytes a texel, and its smaller copies.

/// Rows from the top, four bytes a texel.
#[derive(Clone, Debug)]
pub(crate) struct Image {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) texels: Vec<[u8; 4]>,
}

impl Image {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            texels: vec![[0; 4]; width * height],
        }
    }

    /// This image and its halvings down to one texel. Plain averages: right for slopes and masks,
    /// near enough for colours kept as square roots.
    pub(crate) fn into_mips(self) -> Vec<Self> {
        let mut levels = vec![self];
        while let Some(last) = levels.last()
            && (last.width > 1 || last.height > 1)
        {
            let half = last.halved();
            levels.push(half);
        }
        levels
    }

    fn halved(&self) -> Self {
        let mut out = Self::new((self.width / 2).max(1), (self.height / 2).max(1));
        let (dx, dy) = (self.width.min(2) - 1, self.height.min(2) - 1);
        let (width, source) = (out.width, &self.texels);
        super::parallel_rows(&mut out.texels, width, |y, row| {
            let upper = &source[2 * y * self.width..];
            let lower = &source[(2 * y + dy) * self.width..];
            for (x, texel) in row.iter_mut().enumerate() {
                let four = [
                    upper[2 * x],
                    upper[2 * x + dx],
                    lower[2 * x],
                    lower[2 * x + dx],
                ];
                *texel = std::array::from_fn(|c| {
                    let sum: u16 = four.iter().map(|t| u16::from(t[c])).sum();
                    ((sum + 2) / 4) as u8
                });
            }
        });
        out
    }
}

/// An sRGB-like value 0..1 as a byte of the square root of linear light: what the shaders square.
pub(crate) fn root_of_linear(value: f32) -> u8 {
    // sqrt(x^2.2) is x^1.1; close to sRGB's curve and smooth at zero.
    (value.clamp(0.0, 1.0).powf(1.1) * 255.0 + 0.5) as u8
}
