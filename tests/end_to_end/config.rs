//! The configuration as its users meet it: `config check`, `config print`, and flags over the file.

use std::fs;

use mouthpiece_tests::binary;

/// Guards `config check`: what is right is said to be so, what is wrong is said where and what to write.
#[test]
fn a_file_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("kiosk.toml");
    let name = file.to_string_lossy().into_owned();
    let check = |text: &str| {
        fs::write(&file, text).unwrap();
        binary::run(&["config", "check", &name])
    };
    check("[look]\nbackground = \"#203040\"\n").expect_done();
    for (text, wanted) in [
        (
            "[window]\nfulscreen = true\n",
            ", line 2: window.fulscreen: there is no such key, did you mean fullscreen?",
        ),
        (
            "[look]\n\nframing_percent = 900\n",
            ", line 3: look.framing_percent: 900 is out of range",
        ),
        ("[look]\nbackground = \"not_there.png\"\n", "not_there.png"),
        ("[look]\nhead = \"nobody.glb\"\n", "nobody.glb"),
        ("[sound", ", line 1: "),
    ] {
        let checked = check(text);
        let said = checked.expect_sentence(1);
        assert!(said.contains(wanted) && said.contains(&name), "{said}");
    }
    let missing = binary::run(&["config", "check", "/nowhere/kiosk.toml"]);
    assert!(missing.expect_sentence(1).contains("/nowhere/kiosk.toml"));
}

/// Guards `config print` as the way to a first file, and the place where a file is looked for.
#[test]
fn what_is_printed_is_a_file_that_is_right() {
    let folder = tempfile::tempdir().unwrap();
    let base = folder.path().join("mouthpiece");
    fs::create_dir(&base).unwrap();
    let user = |args: &[&str]| {
        let mut command = binary::command(args);
        command.env("XDG_CONFIG_HOME", folder.path());
        binary::start(command.stdout(std::process::Stdio::piped())).finish()
    };
    // Nothing there: the defaults, and nothing to check.
    let printed = user(&["config", "print"]).expect_done().text();
    user(&["config", "check"]).expect_sentence(1);
    assert!(printed.contains("\nfullscreen = false\n"), "{printed}");

    let changed = printed.replace("\nfullscreen = false\n", "\nfullscreen = true\n");
    fs::write(base.join("config.toml"), &changed).unwrap();
    user(&["config", "check"]).expect_done();
    assert_eq!(user(&["config", "print"]).expect_done().text(), changed);

    // A wrong file is not passed over: who has one wants it.
    fs::write(base.join("config.toml"), "[life]\nseed = -1\n").unwrap();
    for args in [
        &["config", "print"][..],
        &["run", "--audio-device", "none"],
        &["say", "--demo"],
    ] {
        let refused = user(args);
        let said = refused.expect_sentence(1);
        assert!(said.contains("config.toml, line 2: life.seed: "), "{said}");
    }
}

/// Guards the files that come with the program.
#[test]
fn the_kiosk_s_own_file_is_right() {
    let file = binary::root().join("daemon/kiosk/kiosk.toml");
    let file = file.to_string_lossy();
    binary::run(&["config", "check", &*file]).expect_done();
}
