//! Bytes in any pieces to whole lines, in bounded memory.

/// What [`Lines::next`] found.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Line {
    /// A line without its end; it is in [`Lines::line`].
    Whole,
    /// A line longer than the bound; its bytes are gone.
    TooLong,
}

/// Collects bytes until a line is whole.
#[derive(Debug)]
pub(crate) struct Lines {
    held: Vec<u8>,
    bytes_max: usize,
    /// Inside a line that was too long: skip to its end.
    skipping: bool,
    /// `held` was handed out and goes with the next call.
    taken: bool,
}

impl Lines {
    pub(crate) fn new(bytes_max: usize) -> Self {
        Self {
            held: Vec::new(),
            bytes_max,
            skipping: false,
            taken: false,
        }
    }

    /// From the next line on lines may be this long.
    pub(crate) fn set_max(&mut self, bytes_max: usize) {
        self.bytes_max = bytes_max;
    }

    /// Takes bytes from the front of `input` up to the next line's end; `None` when all are taken.
    pub(crate) fn next(&mut self, input: &mut &[u8]) -> Option<Line> {
        if std::mem::take(&mut self.taken) {
            self.held.clear();
        }
        let end = input.iter().position(|&b| b == b'\n');
        let (piece, rest) = match end {
            Some(at) => (&input[..at], &input[at + 1..]),
            None => (*input, &input[input.len()..]),
        };
        *input = rest;
        if !self.skipping {
            if self.held.len() + piece.len() > self.bytes_max {
                self.held = Vec::new();
                self.skipping = true;
            } else {
                self.held.extend_from_slice(piece);
            }
        }
        end?;
        Some(self.finish())
    }

    /// The line that the end of the stream cut off, if there is one.
    pub(crate) fn last(&mut self) -> Option<Line> {
        if std::mem::take(&mut self.taken) {
            self.held.clear();
        }
        (self.skipping || !self.held.is_empty()).then(|| self.finish())
    }

    /// The bytes of the line that was found last.
    pub(crate) fn line(&self) -> &[u8] {
        self.held.strip_suffix(b"\r").unwrap_or(&self.held)
    }

    fn finish(&mut self) -> Line {
        if std::mem::take(&mut self.skipping) {
            return Line::TooLong;
        }
        self.taken = true;
        Line::Whole
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn split(pieces: &[&[u8]], max: usize) -> Vec<Option<Vec<u8>>> {
        let mut lines = Lines::new(max);
        let mut out = Vec::new();
        for piece in pieces {
            let mut input: &[u8] = piece;
            while !input.is_empty() {
                match lines.next(&mut input) {
                    Some(Line::Whole) => out.push(Some(lines.line().to_vec())),
                    Some(Line::TooLong) => out.push(None),
                    None => {}
                }
            }
        }
        match lines.last() {
            Some(Line::Whole) => out.push(Some(lines.line().to_vec())),
            Some(Line::TooLong) => out.push(None),
            None => {}
        }
        out
    }

    #[test]
    fn a_long_line_is_dropped_and_the_next_one_read() {
        assert_eq!(
            split(&[b"abc\r\nabcdefg", b"hij\n\nxyz"], 5),
            [
                Some(b"abc".to_vec()),
                None,
                Some(Vec::new()),
                Some(b"xyz".to_vec())
            ]
        );
    }

    proptest! {
        #[test]
        fn where_the_pieces_are_cut_does_not_matter(
            bytes in proptest::collection::vec(prop_oneof![Just(b'\n'), any::<u8>()], 0..200),
            cuts in proptest::collection::vec(0_usize..200, 0..12),
        ) {
            let mut at: Vec<usize> = cuts.into_iter().map(|c| c.min(bytes.len())).collect();
            at.extend([0, bytes.len()]);
            at.sort_unstable();
            let pieces: Vec<&[u8]> = at.windows(2).map(|w| &bytes[w[0]..w[1]]).collect();
            prop_assert_eq!(split(&pieces, 9), split(&[&bytes], 9));
        }
    }
}
