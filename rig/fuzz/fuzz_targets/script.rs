//! Any text as a script or a library of expressions, in either form: no panic, no endless work; what is
//! refused is refused in words with its file, and what is read gives controls within their ranges at any
//! time. Input: the first byte picks the form, the rest is the text.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mouthpiece_rig::{Control, Library, Script};

fuzz_target!(|input: &[u8]| {
    let Some((form, text)) = input.split_first() else {
        return;
    };
    let name = if form & 1 == 0 { "x.json" } else { "x.ron" };
    let text = String::from_utf8_lossy(text);
    match Script::parse(name, &text) {
        Ok(script) => {
            let end = script.end();
            for ticks in [i64::MIN, -1, 0, end / 3, end / 2, end - 1, end, i64::MAX] {
                let controls = script.controls_at(ticks);
                for &control in Control::ALL {
                    let (least, most) = control.range();
                    let value = controls[control];
                    assert!((least - 1e-5..=most + 1e-5).contains(&value), "{}: {value}", control.name());
                }
            }
        }
        Err(error) => assert!(error.to_string().starts_with(name)),
    }
    if let Ok(library) = Library::parse(name, &text) {
        for known in library.names() {
            assert!(library.get(known).is_ok());
        }
    }
});
