//! `head landmarks` where it cannot work: its window is driven by the shop's tests, through the model behind it.

use mouthpiece_tests::binary;

/// Guards servers and remote shells from a panic of the window system.
#[cfg(target_os = "linux")]
#[test]
fn without_a_display_it_says_so_in_one_sentence() {
    let finished = binary::run(&["head", "landmarks", "anna.ply"]);
    assert!(finished.expect_sentence(1).contains("no display"));
    let mut command = binary::command(&["head", "landmarks", "anna.ply"]);
    command
        .env("DISPLAY", ":64999")
        .stdout(std::process::Stdio::piped());
    let finished = binary::start(&mut command).finish();
    assert!(finished.expect_sentence(1).contains(":64999"));
}

#[test]
fn wrong_words_are_wrong_usage() {
    for words in [
        &["head", "landmarks"][..],
        &["head", "landmarks", "anna.ply", "--unit", "ell"],
    ] {
        let finished = binary::run(words);
        assert_eq!(finished.code(), 2, "{}", finished.stderr);
    }
}
