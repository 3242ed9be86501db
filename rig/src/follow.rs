//! How muscles, jaw, tongue and head follow what they are told: as a mass on a spring, critically damped.

/// The way from one step to the next; exact for a target that stays, so that the length of the step does not
/// tell in the motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Follow {
    rate: f32,
    step_s: f32,
    /// Share of the way that is left after a step, but for the speed.
    left: f32,
}

impl Follow {
    /// At `rate`, 1/s, in steps of `step_s`.
    pub(crate) fn new(rate: f32, step_s: f32) -> Self {
        Self {
            rate,
            step_s,
            left: (-rate * step_s).exp(),
        }
    }

    /// Place and speed a step later.
    pub(crate) fn step(&self, place: f32, speed: f32, wanted: f32) -> (f32, f32) {
        let off = place - wanted;
        let change = speed + self.rate * off;
        (
            wanted + (off + change * self.step_s) * self.left,
            (speed - self.rate * change * self.step_s) * self.left,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_half_steps_are_one_and_nothing_overshoots() {
        let (whole, half) = (Follow::new(140.0, 0.002), Follow::new(140.0, 0.001));
        let (mut a, mut b) = ((0.0, 0.0), (0.0, 0.0));
        for _ in 0..60 {
            a = whole.step(a.0, a.1, 1.0);
            for _ in 0..2 {
                b = half.step(b.0, b.1, 1.0);
            }
            assert!(
                (a.0 - b.0).abs() < 1e-5 && (0.0..=1.0).contains(&a.0),
                "{a:?} {b:?}"
            );
        }
        assert!(a.0 > 0.999, "it arrives: {a:?}");
    }
}
