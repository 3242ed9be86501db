//! What scripts stand on: exit statuses, help, and the reports that are read by programs.

use mouthpiece_tests::{binary, fixtures};

use crate::graphics;

/// The words under `Commands:` in the help, so that a new command is tested the day it comes.
fn commands() -> Vec<String> {
    let help = binary::run(&["--help"]).expect_done().text();
    let lines = help.lines().skip_while(|l| *l != "Commands:").skip(1);
    let found: Vec<_> = lines
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  "))
        .filter(|line| !line.starts_with(' '))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|word| *word != "help")
        .map(str::to_owned)
        .collect();
    assert!(found.len() >= 8, "{found:?}");
    found
}

/// Guards help that helps: each command says what it does and shows a line to copy.
#[test]
fn help_of_every_command_has_an_example() {
    for command in commands() {
        let finished = binary::run(&[&command, "--help"]);
        let text = finished.expect_done().text();
        let example = format!("  mouthpiece {command}");
        assert!(text.contains("Example"), "{command}: {text}");
        assert!(text.contains(&example), "{command}: {text}");
    }
}

/// Guards exit status 2 and a message on stderr, nothing on stdout.
#[test]
fn wrong_usage_is_status_2() {
    let labels = fixtures::named("flite").labels_path;
    let labels = labels.to_string_lossy();
    for args in [
        vec![],
        vec!["sing"],
        vec!["export"],
        vec!["export", "--demo"],
        vec!["export", "--demo", "--labels", &labels, "-o", "x.mp4"],
        vec!["export", "--demo", "--size", "640", "-o", "x.mp4"],
        vec!["export", "--demo", "--size", "0x0", "-o", "x.mp4"],
        vec!["export", "--demo", "--fps", "0", "-o", "x.mp4"],
        vec!["export", "--demo", "--bitrate", "-5", "-o", "x.mp4"],
        vec!["curves"],
        vec!["curves", "--labels", &labels, "--rate", "x"],
        vec!["curves", "--labels", &labels, "--from", "nosuch"],
        vec!["curves", "--labels", &labels, "--label-rate", "0"],
        vec!["labels"],
        vec!["still"],
        vec!["still", "--phone", "xyz", "-o", "x.png"],
        vec!["still", "--controls", r#"{"eyebrow": 1}"#, "-o", "x.png"],
        vec!["still", "--phone", "aa", "--controls", "{}", "-o", "x.png"],
        vec!["say", "--labels", &labels, "--demo"],
        vec!["bench", "--jason"],
    ] {
        let finished = binary::run(&args);
        assert_eq!(finished.code(), 2, "{args:?}: {}", finished.stderr);
        assert!(!finished.stderr.trim().is_empty(), "{args:?} says nothing");
        assert!(finished.stdout.is_empty(), "{args:?} prints to stdout");
    }
}

/// Guards `--version` for bug reports.
#[test]
fn the_version_is_told() {
    let text = binary::run(&["--version"]).expect_done().text();
    let version = text.trim().strip_prefix("mouthpiece ").expect("its name");
    assert_eq!(version.split('.').count(), 3, "{version}");
}

/// Guards doctor: it names each thing that the product needs, found or not.
#[test]
fn doctor_tells_of_graphics_sound_display_and_video() {
    let finished = binary::run(&["doctor"]);
    assert!(finished.code() <= 1, "{}", finished.stderr);
    let text = finished.text();
    for what in ["graphics", "sound", "display", "video"] {
        assert!(text.lines().any(|l| l.starts_with(what)), "{what}: {text}");
    }
}

/// Guards the names of bench's figures, which scripts rely on; not the figures.
#[test]
fn bench_json_has_every_figure() {
    if !graphics::are_there_for("bench") {
        return;
    }
    let finished = binary::run(&["bench", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&finished.expect_done().text()).unwrap();
    for pointer in [
        "/simulation/realtime_factor",
        "/simulation/springs",
        "/simulation/ns_per_spring_step",
        "/simulation/tissue_bytes",
        "/simulation_layered/realtime_factor",
        "/spring_pass/best/ns_per_edge",
        "/spring_pass/portable/ns_per_edge",
        "/speech/realtime_factor",
        "/render/medium/640x480/ms",
        "/render_over_blinn_phong/medium/ratio",
        "/render_over_blinn_phong/high/ratio",
        "/live_low/pictures_per_second",
        "/export/realtime_factor",
        "/export/low/realtime_factor",
        "/first_picture_ms",
    ] {
        let value = report.pointer(pointer).and_then(serde_json::Value::as_f64);
        assert!(value.is_some_and(|v| v > 0.0), "{pointer}: {report}");
    }
}
