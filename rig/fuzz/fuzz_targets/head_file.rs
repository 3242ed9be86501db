//! Any bytes as a head file, and any changes to a real one: no panic, no endless work, and what is
//! read can be written and read again. Input: pairs of a place (four bytes) and a byte to put there;
//! input that begins as a .glb is read as it is.

#![no_main]

use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use mouthpiece_rig::Head;

fn real() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| Head::reference().map(|head| head.write()).unwrap_or_default())
}

fuzz_target!(|input: &[u8]| {
    if input.starts_with(b"glTF") {
        read(input);
        return;
    }
    let mut bytes = real().to_vec();
    for change in input.chunks_exact(5) {
        let place = u32::from_le_bytes([change[0], change[1], change[2], change[3]]) as usize;
        let length = bytes.len();
        bytes[place % length] = change[4];
    }
    read(&bytes);
});

fn read(bytes: &[u8]) {
    match Head::read(bytes) {
        Ok(head) => {
            let again = Head::read(&head.write());
            assert!(again.is_ok(), "what was read cannot be read again");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
