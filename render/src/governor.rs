//! Chooses the tier of a live face by what pictures cost, never by the name of the card: the pure part of `auto`.
//!
//! Wanted: the first pictures come soon, so it begins with the cheapest tier; the best tier that fits is
//! found within a second and then kept, with no wavering while the load is the same; a machine that slows down (a kiosk
//! PC that gets hot) is relieved within a dozen pictures and gets its tier back when it has recovered.
//!
//! So it goes down when the median of the last pictures is over the budget, and up when the next tier is expected to fit with room
//! to spare. What is expected is learnt: once two tiers have been seen, how many times dearer one is than the other is known, and holds
//! while the machine gets slower and faster. A tier that proved too dear is therefore not tried again until the machine is faster than it was.

use crate::tier::Tier;

/// Pictures that a median is taken of, and after which a machine that got slow is relieved.
const PICTURES: usize = 12;
/// The first pictures in a tier load its buffers and shaders: what they cost says nothing.
const WARM_PICTURES: u32 = 4;
/// Pictures that are watched before going up again after going down: some seconds.
const CALM_PICTURES: u32 = 120;
/// Share of the budget that a dearer tier may be expected to fill.
const ROOM: f64 = 0.75;
/// How many times dearer the next tier is taken to be before it was seen: more than was ever measured, since a tier that
/// is gone up to and does not fit is a jolt, and one that is a little late is none.
const DEARER: f64 = 3.0;

/// The state of the choice.
#[derive(Clone, Debug)]
pub struct Governor {
    tier: usize,
    recent: [i64; PICTURES],
    /// Pictures in this tier since it began, or since the last choice.
    seen: u32,
    /// Whether it has ever gone down: then it goes up more carefully.
    has_relieved: bool,
    /// How many times dearer tier `n + 1` is than tier `n`.
    dearer: [f64; 2],
    /// Median cost in the tier left last, and which it was.
    left: Option<(usize, f64)>,
}

impl Default for Governor {
    fn default() -> Self {
        Self {
            tier: 0,
            recent: [0; PICTURES],
            seen: 0,
            has_relieved: false,
            dearer: [DEARER; 2],
            left: None,
        }
    }
}

impl Governor {
    /// The tier to draw in now; at first the cheapest.
    #[must_use]
    pub fn tier(&self) -> Tier {
        Tier::ALL[self.tier]
    }

    /// Takes what a picture in [`tier`](Self::tier) cost and what it may cost, nanoseconds. Some: from now on draw in that tier, and tell of pictures in no other.
    pub fn picture(&mut self, cost_ns: i64, budget_ns: i64) -> Option<Tier> {
        self.seen = self.seen.saturating_add(1);
        if self.seen <= WARM_PICTURES {
            return None;
        }
        self.recent[self.seen as usize % PICTURES] = cost_ns.max(1);
        if self.seen < WARM_PICTURES + PICTURES as u32 {
            return None;
        }
        let cost = self.median();
        self.learn(cost);
        let budget = budget_ns.max(1) as f64;
        if cost > budget && self.tier > 0 {
            self.has_relieved = true;
            return Some(self.change(self.tier - 1, cost));
        }
        let waited = !self.has_relieved || self.seen >= WARM_PICTURES + CALM_PICTURES;
        let dearer = self.dearer.get(self.tier)?;
        (waited && cost * dearer <= budget * ROOM).then(|| self.change(self.tier + 1, cost))
    }

    /// The tier could not be set up: this one is kept, and the other is not tried for a while.
    pub fn failed(&mut self, kept: Tier) {
        self.tier = Tier::ALL.iter().position(|t| *t == kept).unwrap_or(0);
        self.has_relieved = true;
        self.left = None;
        self.seen = 0;
    }

    fn change(&mut self, tier: usize, cost: f64) -> Tier {
        self.left = Some((self.tier, cost));
        self.tier = tier;
        self.seen = 0;
        self.tier()
    }

    /// The first median after a change tells how the two tiers compare.
    fn learn(&mut self, cost: f64) {
        let Some((before, cost_before)) = self.left.take() else {
            return;
        };
        let (low, ratio) = if before < self.tier {
            (before, cost / cost_before)
        } else {
            (self.tier, cost_before / cost)
        };
        // Tiers are ordered: a dearer one that seems cheaper met a hiccup of the other.
        self.dearer[low] = ratio.max(1.0);
    }

    fn median(&self) -> f64 {
        let mut sorted = self.recent;
        sorted.sort_unstable();
        sorted[PICTURES / 2] as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BUDGET: i64 = 20_000_000;

    /// A machine that draws each tier at a cost times its slowness.
    #[derive(Debug)]
    struct Machine {
        costs: [f64; 3],
        noise: f64,
        seed: u64,
    }

    impl Machine {
        fn cost(&mut self, tier: Tier, slowness: f64) -> i64 {
            self.seed = self
                .seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let wobble = (self.seed >> 40) as f64 / (1_u64 << 24) as f64 * 2.0 - 1.0;
            let cost = self.costs[Tier::ALL.iter().position(|t| *t == tier).unwrap()];
            (cost * slowness * (1.0 + self.noise * wobble)) as i64
        }

        /// Draws so many pictures: how often the tier changed, and when last.
        fn run(
            &mut self,
            governor: &mut Governor,
            slowness: f64,
            pictures: usize,
        ) -> (usize, usize) {
            let (mut changes, mut last) = (0, 0);
            for at in 0..pictures {
                let cost = self.cost(governor.tier(), slowness);
                if governor.picture(cost, BUDGET).is_some() {
                    (changes, last) = (changes + 1, at);
                }
            }
            (changes, last)
        }
    }

    fn machine(noise: f64) -> impl Strategy<Value = Machine> {
        (1e5_f64..6e7, 1.05_f64..4.0, 1.05_f64..4.0, any::<u64>()).prop_map(
            move |(low, m, h, seed)| Machine {
                costs: [low, low * m, low * m * h],
                noise,
                seed,
            },
        )
    }

    proptest! {
        /// Each tier is tried once at most and left once at most; then nothing changes for good.
        #[test]
        fn under_a_constant_load_it_settles_and_never_wavers(mut machine in machine(0.10)) {
            let mut governor = Governor::default();
            let (changes, _) = machine.run(&mut governor, 1.0, 20_000);
            prop_assert!(changes <= 3, "{changes} changes");
            let settled = machine.costs[Tier::ALL.iter().position(|t| *t == governor.tier()).unwrap()];
            prop_assert!(governor.tier() == Tier::Low || settled < 1.1 * BUDGET as f64);
        }

        /// On a fast machine the best tier comes within the first second.
        #[test]
        fn what_fits_with_ease_is_chosen_at_once(mut machine in machine(0.10)) {
            machine.costs = machine.costs.map(|c| c * 1e6 / machine.costs[2]);
            let mut governor = Governor::default();
            let (changes, last) = machine.run(&mut governor, 1.0, 1000);
            prop_assert_eq!((changes, governor.tier()), (2, Tier::High));
            prop_assert!(last < 50, "only at picture {}", last);
        }

        /// Throttled, then cool again: relieved soon, back where it was in the end, without trying again and again meanwhile.
        #[test]
        fn a_machine_that_throttles_is_relieved_and_recovers(
            low in 0.01_f64..0.24,
            dearer in (1.05_f64..2.5, 1.05_f64..2.5),
            hot in 1.5_f64..4.0,
            pictures in 200_usize..4000,
            seed in any::<u64>(),
        ) {
            let low = low * BUDGET as f64;
            let costs = [low, low * dearer.0, low * dearer.0 * dearer.1];
            let mut machine = Machine { costs, noise: 0.05, seed };
            let mut governor = Governor::default();
            machine.run(&mut governor, 1.0, 600);
            let cool = governor.tier();
            prop_assert_ne!(cool, Tier::Low);
            let slowness = hot * BUDGET as f64 / costs[Tier::ALL.iter().position(|t| *t == cool).unwrap()];
            let soon = machine.run(&mut governor, slowness, PICTURES + 1);
            prop_assert!(soon.0 == 1 && governor.tier() < cool, "not relieved");
            let (changes, _) = machine.run(&mut governor, slowness, pictures);
            prop_assert!(changes <= 1, "{changes} changes while hot");
            let calm = CALM_PICTURES as usize + PICTURES + WARM_PICTURES as usize;
            let (back, _) = machine.run(&mut governor, 1.0, 3 * calm);
            // Or where it could have been: what tiers cost is known better now.
            prop_assert!(governor.tier() >= cool, "{:?} after {back} changes", governor.tier());
        }

        #[test]
        fn any_costs_at_all_do_no_harm(costs in prop::collection::vec(any::<i64>(), 0..400), budget in any::<i64>()) {
            let mut governor = Governor::default();
            for cost in costs {
                let before = governor.tier();
                let changed = governor.picture(cost, budget);
                prop_assert_eq!(changed.unwrap_or(before), governor.tier());
            }
        }
    }

    #[test]
    fn a_tier_that_cannot_be_set_up_is_not_asked_for_again_at_once() {
        let mut governor = Governor::default();
        let asked = (0..50).find_map(|_| governor.picture(1, BUDGET));
        assert_eq!(asked, Some(Tier::Medium));
        governor.failed(Tier::Low);
        assert_eq!(governor.tier(), Tier::Low);
        assert!((0..100).all(|_| governor.picture(1, BUDGET).is_none()));
    }
}
