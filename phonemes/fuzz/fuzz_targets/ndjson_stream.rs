//! Any bytes in pieces of any size as our NDJSON: the stream gives what the whole gives, in order.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mouthpiece_phonemes::{LineError, Segment, formats::NdjsonStream};

/// So many bytes of the input say how long the pieces are, in turn.
const CUTS: usize = 4;

fuzz_target!(|input: &[u8]| {
    let (cuts, bytes) = input.split_at(CUTS.min(input.len()));
    let whole = parse([bytes]);
    let good: Vec<&Segment> = whole.iter().flatten().collect();
    assert!(good.is_sorted_by(|a, b| a.end <= b.start));
    let mut rest = bytes;
    let mut pieces = Vec::new();
    for cut in cuts.iter().cycle().take(bytes.len()) {
        let (piece, after) = rest.split_at(usize::from(*cut).min(rest.len()));
        pieces.push(piece);
        rest = after;
    }
    pieces.push(rest);
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
