//! Any bytes in pieces of any size as our NDJSON: the stream gives what the whole gives, in order.

#![no_main]

mod pieces;

use libfuzzer_sys::fuzz_target;
use mouthpiece_phonemes::{LineError, Segment, formats::NdjsonStream};
use pieces::cut;

/// So many bytes of the input say how long the pieces are, in turn.
const CUTS: usize = 4;

fuzz_target!(|input: &[u8]| {
    let (bytes, pieces) = cut(input, CUTS);
    let whole = parse([bytes]);
    let good: Vec<&Segment> = whole.iter().flatten().collect();
    assert!(good.is_sorted_by(|a, b| a.end <= b.start));
    assert_eq!(parse(pieces), whole);
});

fn parse<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Result<Segment, LineError>> {
    let mut stream = NdjsonStream::new(None);
    let mut all = Vec::new();
    for piece in pieces {
        stream.push(piece, |one| all.push(one));
    }
    stream.finish(|one| all.push(one));
    all
}
