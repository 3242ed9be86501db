//! A configuration that is replaced while the face is on a screen: no picture is lost over it, right or wrong.

use mouthpiece_tests::daemon::Daemon;
use mouthpiece_tests::or_skipped;
use mouthpiece_tests::screen::Screen;

/// Longest time between two pictures, seconds: less than a window or its pipelines take that are made anew, more
/// than other tests beside this one take the processor away for. A machine that is busier still shows so before
/// anything is replaced.
const GAP_S: f64 = 0.5;
/// Pictures to be judged by, before and between.
const PICTURES: u64 = 40;

/// How many pictures came later than each bound after the one before them: bound in seconds, count.
struct Gaps(Vec<(f64, u64)>);

impl Gaps {
    fn now(daemon: &Daemon) -> Self {
        let text = daemon.get("/metrics").text();
        let buckets = text.lines().filter_map(|line| {
            let rest = line.strip_prefix("mouthpiece_picture_interval_seconds_bucket{le=\"")?;
            let (bound, count) = rest.split_once("\"} ")?;
            let bound = bound.replace("+Inf", "inf").parse().ok()?;
            Some((bound, count.parse().ok()?))
        });
        let gaps = Self(buckets.collect());
        assert!(gaps.0.len() > 2, "{text}");
        gaps
    }

    /// The bound that no gap since `before` lay above.
    fn longest_since(&self, before: &Self) -> f64 {
        let new: Vec<_> = self
            .0
            .iter()
            .zip(&before.0)
            .map(|(n, b)| (n.0, n.1 - b.1))
            .collect();
        // Buckets count all that lie below them, too.
        let all = new.last().map_or(0, |last| last.1);
        new.iter()
            .find(|(_, n)| *n == all)
            .map_or(f64::INFINITY, |(bound, _)| *bound)
    }
}

fn pictures(daemon: &Daemon, more: u64) {
    let shown = |s: &serde_json::Value| s["window"]["pictures"].as_u64().unwrap_or(0);
    let before = shown(&daemon.get("/status.json").json());
    let _ = daemon.status_when("pictures", |s| shown(s) >= before + more);
}

/// Guards a kiosk whose configuration is looked after while people look at the face.
#[test]
fn no_picture_is_lost_when_the_configuration_is_replaced() {
    let Some(screen) = or_skipped(Screen::start()) else {
        return;
    };
    if !crate::graphics::are_there_for("a face that is reconfigured") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("face.toml");
    let configure = |text: &str| std::fs::write(&file, text).unwrap();
    configure("[look]\nbackground = \"#203040\"\n");
    let name = file.to_string_lossy();
    let small = ["--size", "240x240", "--tier", "low", "--config", &*name];
    let daemon = Daemon::start(Some(&screen), &small);
    let _ = daemon.status_when("well", |s| s["ok"] == true);
    pictures(&daemon, PICTURES);

    let first = Gaps::now(&daemon);
    pictures(&daemon, PICTURES);
    let before = Gaps::now(&daemon);
    let calm_s = before.longest_since(&first);
    for n in 1..=3 {
        configure(&format!(
            "[look]\nbackground = \"#a0304{n}\"\n[window]\nrotate = {}\n[life]\nstate = \"{}\"\n",
            [90, 180, 270][n - 1],
            ["listening", "thinking", "idle"][n - 1],
        ));
        daemon.wait_for_log("the configuration has changed", n);
        pictures(&daemon, PICTURES);
        configure("[look]\nbackground = 3\n");
        daemon.wait_for_log("the configuration in use stays", n);
        pictures(&daemon, PICTURES);
    }
    let after = Gaps::now(&daemon);
    let replaced_s = after.longest_since(&before);
    assert!(
        replaced_s <= calm_s.max(GAP_S),
        "gaps of up to {replaced_s} s, of up to {calm_s} s before\n{}",
        daemon.log()
    );
    let status = daemon.get("/status.json").json();
    assert!(
        status["ok"] == true && status["window"]["failures"] == 0,
        "{status:#}"
    );
    println!("longest gap: at most {calm_s} s before, {replaced_s} s across six replacements");
}
