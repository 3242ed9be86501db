//! What the file may say, and what is said of one that is wrong.

use proptest::prelude::*;

use super::{Config, file, print};

fn sentence(text: &str) -> String {
    file::parse(text, "kiosk.toml").unwrap_err().to_string()
}

#[test]
fn what_is_printed_reads_back_as_the_same() {
    let text = print::toml(&Config::default()).unwrap();
    assert_eq!(file::parse(&text, "x").unwrap(), Config::default());
    // Keys that are not set by default, and others changed.
    let set = r##"
        [window]
        rotate = 270
        size = "640x480"
        [look]
        head = "anna \"b\".glb"
        tissue = "layered"
        background = "gradient:#102030,#ffffff"
        environment = "room.hdr"
        [wire]
        listen = "127.0.0.1:7716"
        [life]
        seed = 9223372036854775807
        [drive]
        to = ["vmc:127.0.0.1:39539", "osc:[::1]:9000"]
        rate_hz = 30
    "##;
    let config = file::parse(set, "x").unwrap();
    let text = print::toml(&config).unwrap();
    assert_eq!(file::parse(&text, "x").unwrap(), config);
    assert!(text.contains("rotate = 270"), "{text}");
}

/// Guards `config print` as the documentation of every key.
#[test]
fn every_key_is_printed_below_what_it_means() {
    let text = print::toml(&Config::default()).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    for (section, _, keys) in Config::sections() {
        let heading = format!("[{section}]");
        let from = lines.iter().position(|l| *l == heading).unwrap();
        assert!(lines[from - 1].starts_with("# "), "{section}");
        for key in keys {
            let of_key = |l: &&str| {
                l.trim_start_matches('#')
                    .starts_with(&format!("{} =", key.name))
            };
            let at = from + lines[from..].iter().position(of_key).unwrap();
            let about = lines[at - 1].strip_prefix("# ").unwrap();
            let about = if key.at_start { lines[at - 2] } else { about };
            assert!(about.len() > 10, "{section}.{}: {about}", key.name);
        }
    }
    // No key is in the file that is not in the list.
    let all = toml::Table::try_from(Config::default()).unwrap();
    for (name, section) in &all {
        let (_, _, keys) = Config::sections()
            .into_iter()
            .find(|s| s.0 == name)
            .unwrap();
        for key in section.as_table().unwrap().keys() {
            assert!(keys.iter().any(|k| k.name == key), "{name}.{key}");
        }
    }
}

#[test]
fn a_wrong_file_is_refused_with_line_key_and_mend() {
    for (text, wanted) in [
        (
            "\n[window]\nfulscreen = true\n",
            "kiosk.toml, line 3: window.fulscreen: there is no such key, did you mean fullscreen?",
        ),
        (
            "[window]\nfullscreen = 1",
            "kiosk.toml, line 2: window.fullscreen: invalid type: integer `1`, expected a boolean",
        ),
        (
            "[window]\n# turned\nrotate = 45",
            "kiosk.toml, line 3: window.rotate: 45 is no turn, write 0, 90, 180 or 270",
        ),
        (
            "[sound]\nlook_ahead_ms = 501",
            "kiosk.toml, line 2: sound.look_ahead_ms: 501 is out of range, write a whole number from 0 to 500",
        ),
        (
            "[look]\ntier = \"best\"",
            "kiosk.toml, line 2: look.tier: \"best\" is none of auto, low, medium, high",
        ),
        (
            "[look]\nbackground = \"transparent\"",
            "kiosk.toml, line 2: look.background: a window is not transparent",
        ),
        (
            "[windows]\n",
            "kiosk.toml, line 1: [windows]: there is no such section, did you mean window?",
        ),
        ("[look]\ntier = low\n", "kiosk.toml, line 2: look.tier: "),
        (
            "seed = 3\n",
            "kiosk.toml, line 1: seed: there is no such key",
        ),
        ("\u{1}\n", "kiosk.toml, line 1: "),
    ] {
        let said = sentence(text);
        assert!(said.starts_with(wanted), "{said}");
        assert!(!said.contains('\n'), "{said}");
    }
}

#[test]
fn what_has_changed_is_named_and_whether_it_is_felt_at_once() {
    let new = "[window]\nfullscreen = true\n[look]\nenvironment = \"a.hdr\"\n[life]\nseed = 1";
    let new = file::parse(new, "x").unwrap();
    let changed = Config::default().differs_in(&new);
    let changed: Vec<_> = changed.iter().map(|c| (&*c.name, c.at_start)).collect();
    assert_eq!(
        changed,
        [("window.fullscreen", true), ("look.environment", false)]
    );
}

#[test]
fn files_are_found_from_the_file_s_own_folder_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("kiosk.toml");
    std::fs::write(&path, "[look]\nhead = \"a.glb\"\nbackground = \"b.png\"").unwrap();
    let config = file::read(&path).unwrap();
    assert_eq!(config.look.head, Some(folder.path().join("a.glb")));
    assert_eq!(
        config.look.background.to_string(),
        folder.path().join("b.png").to_string_lossy()
    );
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused_in_one_line(text in "(\\[(window|look|life)\\]\n)?([a-z_]{1,9} ?= ?[-\"a-z0-9.]{0,6}\n){0,4}.{0,20}") {
        if let Err(error) = file::parse(&text, "x") {
            prop_assert!(!error.to_string().contains('\n'));
        }
    }
}
