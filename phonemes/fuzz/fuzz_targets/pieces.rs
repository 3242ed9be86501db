//! A stream given in pieces: for the targets that compare that with the whole.

/// The bytes behind the first `cuts`, and the same in pieces as long as those say, in turn.
pub fn cut(input: &[u8], cuts: usize) -> (&[u8], Vec<&[u8]>) {
    let (cuts, bytes) = input.split_at(cuts.min(input.len()));
    let mut rest = bytes;
    let mut pieces = Vec::new();
    for cut in cuts.iter().cycle().take(bytes.len()) {
        let (piece, after) = rest.split_at(usize::from(*cut).min(rest.len()));
        pieces.push(piece);
        rest = after;
    }
    pieces.push(rest);
    (bytes, pieces)
}
