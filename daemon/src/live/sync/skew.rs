//! What `doctor --sync` says of clicks heard and flashes shown.

use std::fmt::Write as _;
use std::time::Instant;

/// A click and a flash that are further apart do not belong together, ms.
const PAIR_MS: f64 = 400.0;
/// Nobody notices less than this, ms.
const FINE_MS: f64 = 20.0;

/// By how much each flash is later than its click, ms.
pub fn skews(clicks: &[Instant], flashes: &[Instant]) -> Vec<f64> {
    let apart = |click: &Instant, flash: &Instant| {
        let late = flash.saturating_duration_since(*click).as_secs_f64();
        let early = click.saturating_duration_since(*flash).as_secs_f64();
        (late - early) * 1e3
    };
    let nearest = |click: &Instant| {
        let all = flashes.iter().map(|flash| apart(click, flash));
        all.min_by(|a, b| a.abs().total_cmp(&b.abs()))
    };
    let pairs = clicks.iter().filter_map(nearest);
    pairs.filter(|ms| ms.abs() < PAIR_MS).collect()
}

/// The figures in words; `offset_ms` is what `--av-offset` was.
pub fn report(mut skews: Vec<f64>, clicks: usize, offset_ms: i64) -> String {
    let mut text = String::new();
    skews.sort_by(f64::total_cmp);
    let at = |share: f64| skews[((skews.len() - 1) as f64 * share).round() as usize];
    let median = at(0.5);
    let _ = writeln!(
        text,
        "{} of {clicks} clicks were heard with their flash\n\
         picture after sound: median {median:+.1} ms, middle 80 % {:+.1} to {:+.1} ms\n\
         the sound is judged where its server mixes it, the picture where it is handed to the screen: what \
         loudspeakers and screen add is not seen",
        skews.len(),
        at(0.1),
        at(0.9),
    );
    let better = offset_ms - median.round() as i64;
    if median.abs() > FINE_MS {
        let _ = writeln!(
            text,
            "--av-offset {better} (or picture_delay_ms = {better} below [sound]) would bring them together"
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn pairs_are_judged_and_the_offset_counts_back() {
        let start = Instant::now();
        let at = |ms: u64| start + Duration::from_millis(ms);
        let clicks = [at(1000), at(2000), at(3000), at(9000)];
        let flashes = [at(1040), at(2050), at(3060)];
        let found = skews(&clicks, &flashes);
        assert_eq!(found.len(), 3);
        let text = report(found, clicks.len(), 10);
        assert!(text.contains("3 of 4"), "{text}");
        assert!(text.contains("median +50.0 ms"), "{text}");
        assert!(text.contains("--av-offset -40"), "{text}");
        let early = skews(&[at(1000)], &[at(995)]);
        assert!(!report(early, 1, 0).contains("--av-offset"));
    }
}
