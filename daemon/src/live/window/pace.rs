//! When the next picture is due, and for how far ahead it is drawn. Integers of nanoseconds.

/// A screen that does not say how often it refreshes.
const REFRESH_NS: i64 = 1_000_000_000 / 60;
/// So many pictures are wanted where the processor draws them.
const SOFTWARE_NS: i64 = 1_000_000_000 / 30;
/// It rests between them, since it has the head to move, too: in tenths of what a picture takes, so long at most,
/// and so long at least where they are slow.
const REST_TENTHS: i64 = 7;
const SHORT_REST_TENTHS: i64 = 3;
/// Slow pictures count no further than this, so that one hiccup does not shift those after it.
const DRAW_NS_MAX: i64 = 150_000_000;
/// The first pictures load pipelines and maps: how long they take says nothing.
const FIRST_PICTURES: u64 = 3;
/// Each picture's time counts one in so many.
const SMOOTH: i64 = 8;

#[derive(Debug)]
pub(super) struct Pace {
    refresh_ns: i64,
    software: bool,
    /// From taking the time to having it shown, smoothed.
    draw_ns: i64,
    due_ns: i64,
    first_ns: Option<i64>,
    last_ns: i64,
    shown: u64,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            refresh_ns: REFRESH_NS,
            software: false,
            draw_ns: 0,
            due_ns: 0,
            first_ns: None,
            last_ns: 0,
            shown: 0,
        }
    }
}

impl Pace {
    pub(super) fn set_refresh(&mut self, millihertz: u32) {
        // What no screen does is a driver's slip.
        if (20_000..=1_000_000).contains(&millihertz) {
            self.refresh_ns = 1_000_000_000_000 / i64::from(millihertz);
        }
    }

    pub(super) fn set_software(&mut self, software: bool) {
        self.software = software;
    }

    /// Time between two pictures.
    pub(super) fn interval_ns(&self) -> i64 {
        if self.software {
            let rested = |tenths| self.draw_ns * (10 + tenths) / 10;
            rested(REST_TENTHS)
                .min(SOFTWARE_NS)
                .max(rested(SHORT_REST_TENTHS))
                .max(self.refresh_ns)
        } else {
            self.refresh_ns
        }
    }

    /// What drawing a picture may take, so that all come in time and the processor has its rest.
    pub(super) fn budget_ns(&self) -> i64 {
        if self.software {
            SOFTWARE_NS.max(self.refresh_ns) * 10 / (10 + SHORT_REST_TENTHS)
        } else {
            self.refresh_ns * 8 / 10
        }
    }

    /// How long after now the middle of the picture's time on the screen is.
    pub(super) fn ahead_ns(&self) -> i64 {
        self.draw_ns + self.interval_ns() / 2
    }

    pub(super) fn due_ns(&self) -> i64 {
        self.due_ns
    }

    pub(super) fn is_due(&self, now_ns: i64) -> bool {
        now_ns >= self.due_ns
    }

    pub(super) fn due_now(&mut self, now_ns: i64) {
        self.due_ns = now_ns;
    }

    /// A picture that was begun at `begun_ns` is on its way to the screen.
    pub(super) fn shown(&mut self, begun_ns: i64, now_ns: i64) {
        let took = (now_ns - begun_ns).clamp(0, DRAW_NS_MAX);
        self.shown += 1;
        if self.shown == FIRST_PICTURES {
            self.draw_ns = took;
        } else if self.shown > FIRST_PICTURES {
            self.draw_ns += (took - self.draw_ns) / SMOOTH;
        }
        self.first_ns.get_or_insert(now_ns);
        self.last_ns = now_ns;
        // In step with the last one, unless that was late.
        let next = self.due_ns + self.interval_ns();
        self.due_ns = if next < now_ns { now_ns } else { next };
    }

    /// Nothing could be shown: once more, a little later.
    pub(super) fn retry(&mut self, now_ns: i64) {
        self.due_ns = now_ns + self.refresh_ns / 2;
    }

    pub(super) fn rest(&mut self, now_ns: i64, rest_ns: i64) {
        self.due_ns = now_ns + rest_ns;
    }

    /// Logs how it went.
    pub(super) fn report(&self) {
        let Some(first_ns) = self.first_ns else {
            return;
        };
        let seconds = (self.last_ns - first_ns).max(1) as f64 * 1e-9;
        tracing::info!(
            pictures = self.shown,
            per_second = self.shown as f64 / seconds,
            draw_ms = self.draw_ns as f64 * 1e-6,
            "window closed"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    #[test]
    fn pictures_keep_their_beat_and_late_ones_are_not_made_up_for() {
        let mut pace = Pace::default();
        pace.set_refresh(50_000);
        pace.due_now(100 * MS);
        pace.shown(100 * MS, 104 * MS);
        assert_eq!(pace.due_ns(), 120 * MS);
        assert!(!pace.is_due(119 * MS) && pace.is_due(120 * MS));
        pace.shown(121 * MS, 190 * MS);
        assert_eq!(pace.due_ns(), 190 * MS);
    }

    #[test]
    fn software_draws_as_often_as_leaves_the_processor_some_rest() {
        for (draw_ms, interval_ns) in [
            (5, REFRESH_NS),
            (14, 14 * MS * 17 / 10),
            (22, SOFTWARE_NS),
            (50, 65 * MS),
        ] {
            let mut pace = Pace::default();
            pace.set_software(true);
            for n in 0..100 {
                pace.shown(n * 100 * MS, (n * 100 + draw_ms) * MS);
            }
            assert_eq!(pace.interval_ns(), interval_ns, "{draw_ms}");
            assert_eq!(pace.ahead_ns(), draw_ms * MS + interval_ns / 2);
        }
    }
}
