//! Any bytes as a scan of each format: no panic, no memory without end, and what is read is sound
//! before and after tidying. The first byte chooses the format; the rest also serves as every file
//! that the scan names beside itself.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mouthpiece_shop::mesh::{Format, Scan, ScanColour, Side, read_bytes, tidy};

/// Whatever name is asked for.
struct Any<'a>(&'a [u8]);

impl Side for Any<'_> {
    fn open(&self, name: &str) -> Option<Vec<u8>> {
        name.ends_with("g").then(|| self.0.to_vec())
    }
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, rest)) = bytes.split_first() else {
        return;
    };
    let formats = [Format::Obj, Format::Ply, Format::Stl, Format::Glb];
    let format = formats[usize::from(first) % formats.len()];
    match read_bytes(format, "fuzzed", rest, &Any(rest)) {
        Ok(reading) => {
            sound(&reading.scan);
            if let Ok((scan, _)) = tidy(reading.scan) {
                sound(&scan);
            }
        }
        Err(error) => assert!(error.to_string().len() < 1000),
    }
});

fn sound(scan: &Scan) {
    let count = scan.positions.len();
    assert!(scan.positions.iter().all(|p| p.is_finite()));
    assert!(
        scan.triangles
            .iter()
            .flatten()
            .all(|&i| (i as usize) < count)
    );
    match &scan.colour {
        None => {}
        Some(ScanColour::PerVertex(colours)) => assert_eq!(colours.len(), count),
        Some(ScanColour::Texture { image, uvs }) => {
            assert_eq!(uvs.len(), scan.triangles.len());
            assert_eq!(
                image.rgb.len(),
                image.width as usize * image.height as usize * 3
            );
        }
    }
}
