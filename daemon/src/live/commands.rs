//! The commands of the live face, each put together from the modules beside this one.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Result, bail};
use arc_swap::ArcSwap;
use tokio::runtime::Runtime;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

use super::address::Address;
use super::client;
use super::deadline;
use super::faults;
use super::player::{Handle, Player, Sight};
use super::reload::{Current, Reload};
use super::rules::Rules;
use super::server::{Server, read_token_text};
use super::service;
use super::sound::Choice;
use super::source::Source;
use super::speaker;
use super::stop::Stop;
use super::sync::ear::Ear;
use super::sync::{self, Flash, Onsets, skew};
use super::window::{Display, Look, Wake};
use crate::cli::{CastArgs, RunArgs, SayArgs, StageArgs, WireArgs};
use crate::config::{self, Config};
use crate::health::{Health, Token};
use crate::interrupt::Interrupted;
use crate::pipeline::Cast;

/// How long sockets may take to close.
const CLOSE_PATIENCE: Duration = Duration::from_millis(300);

/// The daemon.
pub fn run(args: &RunArgs) -> Result<()> {
    let stop = Stop::default();
    let source = config::Source::new(&args.stage, &args.wire).with_http(args.http);
    let net = runtime(&stop, source.file().is_none())?;
    let config = source.load()?;
    if let Some(file) = source.file() {
        tracing::info!(file = %file.display(), "configured");
    }
    let look = Look::load(&config)?;
    // First, so that a second daemon ends before it has cost anything.
    let server = net.block_on(Server::bind(&config.wire))?;
    let secret = config.wire.token_file.as_deref().map(read_token_text);
    let token = secret
        .transpose()?
        .map(|secret| Token::new(secret.as_bytes()));
    let door = net.block_on(config.health.http.open(token))?;
    net.spawn(ended_in_time(stop.clone(), server.socket()));
    let cast = cast(&config)?;
    let onsets = args.test.then(Arc::<Onsets>::default);
    let (player, sight) = start(&cast, &config, onsets.clone())?;
    net.spawn(service::tell(Arc::clone(&sight.vitals), stop.clone()));
    if let Some(door) = door {
        let vitals = Arc::clone(player.handle().vitals());
        let health = Health::new(vitals, sight.shots.clone(), config.health.stall_ms.get());
        net.spawn(door.serve(health));
    }
    let current = Current::new(ArcSwap::from_pointee(config));
    let serving = net.spawn(server.serve(player.handle(), Arc::clone(&current)));
    let leaving = net.spawn(goodbye(stop.clone(), player.handle(), serving));
    let reload = |window| Reload {
        source,
        current,
        player: player.handle(),
        window,
    };
    let seen = match Display::open() {
        Ok(display) => {
            net.spawn(reload(Some(display.proxy())).watch(stop.clone()));
            if args.test {
                net.spawn(faults::obey(display.proxy()));
            }
            let flash = onsets.map(Flash::of_onsets);
            show(display, &net, &cast, sight, look, &stop, flash, None)
        }
        Err(error) => {
            net.spawn(reload(None).watch(stop.clone()));
            Err(error)
        }
    };
    if let Err(error) = seen {
        tracing::warn!("{error:#}; going on without a window");
        net.block_on(stop.wait());
    }
    stop.ask();
    // It tells by itself, in time.
    let _ = net.block_on(leaving);
    net.shutdown_timeout(CLOSE_PATIENCE);
    player.end()
}

/// Once the end is asked for, stops what is spoken and tells who sent it, as long as that takes no longer than it should.
async fn goodbye(stop: Stop, player: Handle, serving: JoinHandle<()>) {
    stop.wait().await;
    player.closing().cancel();
    player.stop(None).await;
    let serving = tokio::time::timeout(CLOSE_PATIENCE, serving);
    if serving.await.is_err() {
        tracing::debug!("clients that do not read were not told of the end");
    }
}

/// Once the end is asked for, it comes.
async fn ended_in_time(stop: Stop, socket: Option<PathBuf>) {
    stop.wait().await;
    deadline::arm(socket);
}

/// One utterance: through the daemon where there is one, else in a window of its own.
pub fn say(args: &SayArgs) -> Result<()> {
    let stop = Stop::default();
    let net = runtime(&stop, true)?;
    let config = config::Source::new(&args.stage, &args.wire).load()?;
    let asked = !args.wire.listen.is_empty();
    let address = match Address::all(&config.wire.listen) {
        Ok(all) => all
            .into_iter()
            .find(|a| !matches!(a, Address::WebSocket(_))),
        Err(error) if asked => return Err(error),
        Err(_) => None,
    };
    let token = match (&config.wire.token_file, &address) {
        (Some(file), Some(Address::Tcp(_))) => Some(read_token_text(file)?),
        _ => None,
    };
    if let Some(address) = address {
        match net.block_on(client::connect(&address)) {
            Ok(stream) => {
                let source = Source::open(&args.input)?;
                tracing::info!(%address, "speaking through the daemon");
                return net.block_on(client::speak(stream, source, token, &stop));
            }
            Err(error) if asked => {
                bail!(
                    "no daemon answers at {address} ({error}); start one: mouthpiece run --listen {address}"
                )
            }
            Err(_) => {}
        }
    }
    perform(Source::open(&args.input)?, &config, None, &net, &stop)
}

/// Clicks with flashes for `seconds`, for a recorder outside to judge.
pub fn sync_test(stage: &StageArgs, seconds: u32) -> Result<()> {
    let stop = Stop::default();
    let net = runtime(&stop, true)?;
    let config = config::Source::new(stage, &WireArgs::default()).load()?;
    let (source, flash) = sync::clicks(seconds)?;
    perform(source, &config, Some(flash), &net, &stop)
}

/// The same, and what a recorder of the sound server's own says of it.
pub fn doctor_sync(stage: &StageArgs, seconds: u32) -> Result<String> {
    let stop = Stop::default();
    let net = runtime(&stop, true)?;
    let config = config::Source::new(stage, &WireArgs::default()).load()?;
    let (source, flash) = sync::clicks(seconds)?;
    let seen = std::sync::Arc::clone(&flash.seen);
    let ear = Ear::start();
    perform(source, &config, Some(flash), &net, &stop)?;
    let clicks = ear.and_then(Ear::finish)?;
    let flashes: Vec<_> = std::iter::from_fn(|| seen.pop()).collect();
    let skews = skew::skews(&clicks, &flashes);
    anyhow::ensure!(
        !skews.is_empty(),
        "{} clicks were heard and {} flashes shown, but none together: is the default sound device the one that plays?",
        clicks.len(),
        flashes.len()
    );
    let offset_ms = config.sound.picture_delay_ms.get();
    Ok(skew::report(skews, flashes.len(), offset_ms))
}

/// Speaks `source` in this process.
fn perform(
    source: Source,
    config: &Config,
    flash: Option<Flash>,
    net: &Runtime,
    stop: &Stop,
) -> Result<()> {
    let look = Look::load(config)?;
    let cast = cast(config)?;
    let (player, sight) = start(&cast, config, None)?;
    let display = match Display::open() {
        Ok(display) => Some(display),
        Err(error) if player.has_sound() => {
            tracing::warn!("{error:#}; speaking without a window");
            None
        }
        Err(error) => {
            player.end()?;
            bail!(
                "{error:#}, and no sound device either; write a video instead: mouthpiece export"
            );
        }
    };
    let (first, first_shown) = oneshot::channel();
    let start = flash.as_ref().map(|f| Arc::clone(&f.start));
    let windowed = display.is_some();
    let speaking = {
        let (handle, stop) = (player.handle(), stop.clone());
        net.spawn(async move {
            // A window that never shows anything ends the process by itself.
            if windowed && first_shown.await.is_err() {
                return Ok(());
            }
            let spoken = tokio::select! {
                spoken = speaker::speak(handle, source, start) => spoken,
                () = stop.wait() => Ok(()),
            };
            stop.ask();
            spoken
        })
    };
    let seen = match display {
        Some(display) => show(display, net, &cast, sight, look, stop, flash, Some(first)),
        None => {
            net.block_on(stop.wait());
            Ok(())
        }
    };
    stop.ask();
    let spoken = net.block_on(speaking)?;
    player.end()?;
    seen?;
    spoken?;
    if stop.by_signal() {
        return Err(Interrupted::default().into());
    }
    Ok(())
}

/// Runs the window until it is closed or the end is asked for.
#[allow(
    clippy::too_many_arguments,
    reason = "the one place where everything that is seen comes together"
)]
fn show(
    display: Display,
    net: &Runtime,
    cast: &Cast,
    sight: Sight,
    look: Look,
    stop: &Stop,
    flash: Option<Flash>,
    shown: Option<oneshot::Sender<()>>,
) -> Result<()> {
    let (proxy, stopping) = (display.proxy(), stop.clone());
    net.spawn(async move {
        stopping.wait().await;
        // Closed already: nothing to wake.
        let _ = proxy.send_event(Wake::Quit);
    });
    display.show(Arc::clone(&cast.head), sight, look, flash, shown)
}

fn cast(config: &Config) -> Result<Cast> {
    Cast::load(&CastArgs {
        head: config.look.head.clone(),
        tissue: config.look.tissue,
    })
}

fn start(cast: &Cast, config: &Config, onsets: Option<Arc<Onsets>>) -> Result<(Player, Sight)> {
    let choice = match config.sound.device.as_str() {
        "default" => Choice::Default,
        "none" => Choice::Silent,
        id => Choice::Id(id.to_owned()),
    };
    Player::start(
        cast,
        choice,
        &config.life,
        Rules::of(config),
        &config.drive,
        onsets,
    )
}

/// Sockets and control, on one thread: nothing real-time runs there. Whether SIGHUP `hangs_up`, that is, ends the process.
fn runtime(stop: &Stop, hangs_up: bool) -> Result<Runtime> {
    let net = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .thread_name("net")
        .enable_all()
        .build()?;
    net.spawn(stop.clone().on_signals(hangs_up));
    Ok(net)
}
