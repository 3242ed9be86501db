//! Whether this machine can draw at all, asked once.

use std::sync::OnceLock;

use mouthpiece_tests::binary;

/// True where pictures can be drawn; else says why `test` is skipped. Where `CI` is set nothing may
/// be skipped: there the driver is part of the set-up.
pub(crate) fn are_there_for(test: &str) -> bool {
    static FOUND: OnceLock<Result<(), String>> = OnceLock::new();
    let found = FOUND.get_or_init(|| {
        let doctor = binary::run(&["doctor"]);
        if doctor.code() == 0 {
            return Ok(());
        }
        let text = doctor.text();
        let line = text.lines().find(|line| line.starts_with("graphics"));
        Err(line.unwrap_or("doctor found no graphics").to_owned())
    });
    if let Err(why) = found {
        assert!(std::env::var_os("CI").is_none(), "CI must draw, but: {why}");
        eprintln!("skipped {test}: {why} (make setup installs a driver)");
    }
    found.is_ok()
}
