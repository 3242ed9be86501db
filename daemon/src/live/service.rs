//! What a service manager is told (systemd's sd_notify(3)): ready, alive, how it goes, ending.
//!
//! Wanted: a face that stands still is started anew, whatever the rest of the process does. So the
//! watchdog is fed for pictures that the screen took since it was fed last, and for nothing else;
//! `READY=1` waits for the first of them. The count is [`super::vitals`]', the sending is done on the
//! net thread, so that no manager can keep a picture waiting.

use std::sync::Arc;
use std::time::Duration;

use sd_notify::NotifyState;

use super::stop::Stop;
use super::vitals::{DeviceState, Vitals};

/// How often pictures are counted; a watchdog that wants to hear more often than twice in this time is
/// none for pictures.
const TURN_MAX: Duration = Duration::from_millis(500);
const TURN_MIN: Duration = Duration::from_millis(20);
/// How often the status line may change.
const STATUS_TURN: Duration = Duration::from_secs(5);

/// Tells the service manager until the end is asked for. Without one it ends at once.
pub async fn tell(vitals: Arc<Vitals>, stop: Stop) {
    if std::env::var_os("NOTIFY_SOCKET").is_none() {
        return;
    }
    let watchdog = sd_notify::watchdog_enabled();
    // Four times a period, so that one late turn does no harm.
    let turn = watchdog.map_or(TURN_MAX, |period| (period / 4).clamp(TURN_MIN, TURN_MAX));
    let mut turns = tokio::time::interval(turn);
    turns.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    let mut told = Told::default();
    loop {
        tokio::select! {
            () = stop.wait() => break,
            _ = turns.tick() => {}
        }
        let presented = vitals.window.presented.get();
        if presented == told.presented {
            continue;
        }
        let mut news = Vec::new();
        if told.presented == 0 {
            news.push(NotifyState::Ready);
        }
        if watchdog.is_some() {
            news.push(NotifyState::Watchdog);
        }
        told.presented = presented;
        let now_ns = vitals.origin.now_ns();
        let line = told.status_due(now_ns).then(|| status(&vitals, now_ns));
        news.extend(line.as_deref().map(NotifyState::Status));
        send(&news);
    }
    send(&[NotifyState::Stopping, NotifyState::Status("ending")]);
}

/// What was told last.
#[derive(Default)]
struct Told {
    presented: u64,
    status_ns: Option<i64>,
}

impl Told {
    fn status_due(&mut self, now_ns: i64) -> bool {
        let turn_ns = i64::try_from(STATUS_TURN.as_nanos()).unwrap_or(i64::MAX);
        let due = self.status_ns.is_none_or(|last| now_ns - last >= turn_ns);
        if due {
            self.status_ns = Some(now_ns);
        }
        due
    }
}

/// How it goes, in a line for `systemctl status`.
fn status(vitals: &Vitals, now_ns: i64) -> String {
    let sound = match vitals.sound.device() {
        DeviceState::Unwanted => "no sound wanted",
        DeviceState::Playing => "sound plays",
        DeviceState::Missing => "the sound device is missing",
    };
    format!(
        "{:.0} pictures a second, {} utterances in hand, {} clients, {sound}",
        vitals.window.per_second(now_ns),
        vitals.sound.queue.get(),
        vitals.net.clients.get(),
    )
}

fn send(news: &[NotifyState<'_>]) {
    if let Err(error) = sd_notify::notify(news) {
        tracing::warn!(%error, "the service manager could not be told");
    }
}
