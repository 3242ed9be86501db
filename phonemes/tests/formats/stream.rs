//! Our NDJSON as a stream: pieces of any size give what the whole gives, and a file of the same
//! bytes the same segments.

use mouthpiece_phonemes::formats::NdjsonStream;
use mouthpiece_phonemes::{
    LineError, Phone, ReadOptions, SampleRate, Segment, Source, read, writer,
};
use proptest::prelude::*;

fn stream<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Result<Segment, LineError>> {
    let mut parser = NdjsonStream::new(None);
    let mut all = Vec::new();
    for piece in pieces {
        parser.push(piece, |one| all.push(one));
    }
    parser.finish(|one| all.push(one));
    all
}

proptest! {
    #[test]
    fn pieces_of_any_size_give_what_the_whole_gives(
        lengths in prop::collection::vec(1_i64..50_000, 1..20),
        piece in 1_usize..80,
        damage in prop::option::of((any::<prop::sample::Index>(), any::<u8>())),
    ) {
        let mut at = 0;
        let segments = lengths.iter().map(|length| {
            let start = at;
            at += length;
            Segment::new(Phone::Iy, start, at)
        });
        let labels = mouthpiece_phonemes::Labels {
            segments: segments.collect(),
            ..Default::default()
        };
        let mut bytes = Vec::new();
        writer("ndjson").unwrap().write(&labels, SampleRate::TIMIT, &mut bytes).unwrap();
        if let Some((index, byte)) = &damage {
            let at = index.index(bytes.len());
            bytes[at] = *byte;
        }
        let whole = stream([&bytes[..]]);
        prop_assert_eq!(&stream(bytes.chunks(piece)), &whole);
        if damage.is_none() {
            let source = Source { name: "x", bytes: &bytes };
            let file = read(&source, None, &ReadOptions::default()).unwrap();
            let streamed: Vec<Segment> = whole.into_iter().map(Result::unwrap).collect();
            prop_assert_eq!(&streamed, &labels.segments);
            prop_assert_eq!(&file.segments, &labels.segments);
        }
    }
}

#[test]
fn a_bad_line_is_told_and_the_next_one_read() {
    let text = b"{\"start\":0,\"end\":0.1,\"phone\":\"h#\"}\nnonsense\n\
        {\"start\":0.05,\"end\":0.2,\"phone\":\"aa\"}\n{\"start\":0.1,\"end\":0.2,\"phone\":\"aa\",\"stress\":1}\n";
    let all = stream([&text[..]]);
    assert_eq!(all.len(), 4);
    assert_eq!(all[0], Ok(Segment::new(Phone::HSharp, 0, 4800)));
    let said = all[1].clone().unwrap_err().to_string();
    assert!(said.starts_with("line 2: not the JSON"), "{said}");
    let said = all[2].clone().unwrap_err().to_string();
    assert!(said.starts_with("line 3: ends at 0.050000 but"), "{said}");
    let last = all[3].clone().unwrap();
    assert_eq!((last.phone, last.start, last.end), (Phone::Aa, 4800, 9600));
    // A new utterance's times may start over.
    let mut parser = NdjsonStream::new(None);
    let mut count = 0;
    parser.push(text, |_| {});
    parser.restart();
    parser.push(&text[..36], |one| count += usize::from(one.is_ok()));
    assert_eq!(count, 1);
}
