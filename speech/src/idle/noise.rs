//! Random numbers that can be asked for in any order: each is a hash of the seed, the purpose and a
//! count. And events at random intervals, found at any time without what came before.

use super::ms;

/// What a number is for, so that no two purposes share one.
#[derive(Clone, Copy, Debug)]
#[repr(u64)]
pub(super) enum Purpose {
    BlinkInterval = 1,
    BlinkKeep,
    GlanceInterval,
    GlanceKeep,
    GlanceLength,
    GlanceAmplitude,
    GlanceDirection,
    FixationOnset,
    FixationYaw,
    FixationPitch,
    SwayPhase,
    SwayAmplitude,
    BreathInterval,
    BreathDepth,
    SwallowInterval,
    PauseSwallow,
    Nod,
    Brow,
    BrowOnset,
    PhraseBlink,
    PhraseBlinkOnset,
    ThoughtSide,
    ThoughtHeight,
    ThoughtLength,
    BackchannelInterval,
    BackchannelSize,
    RestBrowInterval,
    RestBrowSize,
}

/// The source of all randomness of one seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Noise {
    seed: u64,
}

impl Noise {
    pub(super) const fn new(seed: u64) -> Self {
        Self { seed }
    }

    /// Evenly spread over 0 (inclusive) to 1 (exclusive).
    pub(super) fn uniform(&self, purpose: Purpose, index: i64) -> f32 {
        let mut x = mix(self.seed ^ 0x6d6f_7574_6870_6965);
        x = mix(x ^ (purpose as u64));
        x = mix(x ^ index.cast_unsigned());
        // The upper 24 bits: what an f32 holds exactly.
        (x >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Normal with mean 0 and deviation 1 (Box and Muller).
    pub(super) fn normal(&self, purpose: Purpose, index: i64) -> f32 {
        let index = index.wrapping_mul(2);
        let radius = 1.0 - self.uniform(purpose, index);
        let angle = self.uniform(purpose, index.wrapping_add(1));
        (-2.0 * radius.ln()).sqrt() * (std::f32::consts::TAU * angle).cos()
    }
}

/// The finaliser of the SplitMix64 generator with its increment: a bijection that spreads every bit.
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Events whose distances are log-normal. Time is cut into blocks; each begins its own sequence, so that
/// the events around any tick are found by walking one block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Events {
    pub(super) purpose: Purpose,
    /// Mean distance, seconds.
    pub(super) mean_s: f32,
    /// Deviation of its logarithm.
    pub(super) sigma: f32,
    /// Least distance, seconds; also kept from a block's ends, so that an event of this length never
    /// meets the next block's first.
    pub(super) least_s: f32,
}

/// Length of a block: many events long, so that its ends hardly show in the statistics, and short enough
/// to walk.
const BLOCK: i64 = ms(120_000);

/// A block's share of an event's number; far more than its events.
const EVENTS_MAX: i64 = 1024;

impl Events {
    /// Calls `visit` with the number of each event in the block around `ticks` that began at or before
    /// it, and the ticks since.
    pub(super) fn begun(&self, noise: &Noise, ticks: i64, mut visit: impl FnMut(i64, i64)) {
        let block = ticks.div_euclid(BLOCK);
        let now = ticks.rem_euclid(BLOCK);
        let least = ms(1) * (self.least_s * 1000.0) as i64;
        // Mean of a log-normal: median * exp(sigma^2 / 2).
        let median_s = self.mean_s / (self.sigma * self.sigma / 2.0).exp();
        let mut at = 0;
        for i in 0..EVENTS_MAX {
            let number = block.wrapping_mul(EVENTS_MAX).wrapping_add(i);
            let wait_s = median_s * (self.sigma * noise.normal(self.purpose, number)).exp();
            let wait = ms(1) * (wait_s * 1000.0).clamp(0.0, 120_000.0) as i64;
            at += wait.max(least);
            if at > now || at > BLOCK - least {
                break;
            }
            visit(number, now - at);
        }
    }
}
