//! Any bytes in pieces of any size: the stream gives what the whole gives.

#![no_main]

mod pieces;

use libfuzzer_sys::fuzz_target;
use mouthpiece_phonemes::{LineError, SampleRate, Segment, timit::TimitStream};
use pieces::cut;

/// So many bytes of the input say how long the pieces are, in turn.
const CUTS: usize = 8;

fuzz_target!(|input: &[u8]| {
    let (bytes, pieces) = cut(input, CUTS);
    let whole = parse([bytes]);
    assert_eq!(parse(pieces), whole);
});

fn parse<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Result<Segment, LineError>> {
    let mut stream = TimitStream::new(SampleRate::TIMIT);
    let mut all = Vec::new();
    for piece in pieces {
        stream.push(piece, |one| all.push(one));
    }
    stream.finish(|one| all.push(one));
    all
}
