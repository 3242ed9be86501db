//! Walks the boxes of an MP4 (ISO/IEC 14496-12) as far as timing goes: which tracks there are, how
//! long each plays and when it starts.
//!
//! Written from the standard and not from the product's muxer, so that both would have to be wrong
//! in the same way. Does not decode anything; fragmented files are not read.

/// Timing of one track.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// `vide` or `soun`.
    pub handler: String,
    /// How long it plays, seconds, edit list applied.
    pub plays_s: f64,
    /// Empty time before it begins, seconds, from the edit list.
    pub starts_s: f64,
    /// What the edit list skips at the front of the media: an encoder's priming.
    pub skips_s: f64,
    /// The sum of all samples' durations, seconds.
    pub media_s: f64,
    /// How many samples (pictures, packets) it has.
    pub samples: u64,
}

/// The tracks of a file.
#[must_use]
pub fn tracks(file: &[u8]) -> Vec<Track> {
    let moov = only(file, b"moov");
    let movie_hz = timescale(only(moov, b"mvhd"));
    children(moov)
        .into_iter()
        .filter(|(kind, _)| *kind == b"trak")
        .map(|(_, trak)| track(trak, movie_hz))
        .collect()
}

/// The track with this handler.
#[must_use]
pub fn track_of(file: &[u8], handler: &str) -> Track {
    let mut found: Vec<_> = tracks(file);
    found.retain(|t| t.handler == handler);
    assert_eq!(found.len(), 1, "tracks of {handler}");
    found.remove(0)
}

fn track(trak: &[u8], movie_hz: f64) -> Track {
    let mdia = only(trak, b"mdia");
    let media_hz = timescale(only(mdia, b"mdhd"));
    let handler = String::from_utf8_lossy(&only(mdia, b"hdlr")[8..12]).into_owned();
    let stbl = only(only(mdia, b"minf"), b"stbl");
    let (samples, ticks) = durations(only(stbl, b"stts"));
    let sizes = u64::from(u32_at(only(stbl, b"stsz"), 8));
    assert_eq!(samples, sizes, "{handler}: stts and stsz count differently");
    let media_s = ticks as f64 / media_hz;
    let mut track = Track {
        handler,
        plays_s: media_s,
        starts_s: 0.0,
        skips_s: 0.0,
        media_s,
        samples,
    };
    if let Some((_, edts)) = children(trak)
        .into_iter()
        .find(|(kind, _)| *kind == b"edts")
    {
        edits(only(edts, b"elst"), movie_hz, media_hz, &mut track);
    }
    track
}

/// Applies an edit list: empty edits delay the start, the first real one says where it begins.
fn edits(elst: &[u8], movie_hz: f64, media_hz: f64, track: &mut Track) {
    let wide = elst[0] == 1;
    let mut plays = 0.0;
    for k in 0..u32_at(elst, 4) as usize {
        let (duration, media_time) = if wide {
            let at = 8 + 20 * k;
            (u64_at(elst, at), u64_at(elst, at + 8).cast_signed())
        } else {
            let at = 8 + 12 * k;
            let time = u32_at(elst, at + 4).cast_signed();
            (u64::from(u32_at(elst, at)), i64::from(time))
        };
        if media_time < 0 {
            assert!(plays == 0.0, "an empty edit in the middle");
            track.starts_s += duration as f64 / movie_hz;
        } else {
            if plays == 0.0 {
                track.skips_s = media_time as f64 / media_hz;
            }
            plays += duration as f64 / movie_hz;
        }
    }
    track.plays_s = plays;
}

/// Count and sum of a time-to-sample box.
fn durations(stts: &[u8]) -> (u64, u64) {
    (0..u32_at(stts, 4) as usize).fold((0, 0), |(samples, ticks), k| {
        let count = u64::from(u32_at(stts, 8 + 8 * k));
        let delta = u64::from(u32_at(stts, 12 + 8 * k));
        (samples + count, ticks + count * delta)
    })
}

/// Ticks a second, of `mvhd` and `mdhd` alike.
fn timescale(header: &[u8]) -> f64 {
    let at = if header[0] == 1 { 20 } else { 12 };
    f64::from(u32_at(header, at))
}

/// The boxes that stand side by side in `bytes`: kind and content. Fails where they do not fill it.
fn children(bytes: &[u8]) -> Vec<(&[u8; 4], &[u8])> {
    let mut found: Vec<(&[u8; 4], &[u8])> = Vec::new();
    let mut rest = bytes;
    while !rest.is_empty() {
        let kind: &[u8; 4] = rest[4..8].try_into().expect("four bytes");
        let (head, size) = match u32_at(rest, 0) {
            0 => (8, rest.len()),
            1 => (
                16,
                usize::try_from(u64_at(rest, 8)).expect("it is in memory"),
            ),
            size => (8, size as usize),
        };
        assert!(
            (head..=rest.len()).contains(&size),
            "box {} of {size} bytes in {} that are left: the file is cut or broken",
            String::from_utf8_lossy(kind),
            rest.len()
        );
        found.push((kind, &rest[head..size]));
        rest = &rest[size..];
    }
    found
}

fn only<'a>(bytes: &'a [u8], kind: &[u8; 4]) -> &'a [u8] {
    let mut found = children(bytes);
    found.retain(|(k, _)| *k == kind);
    assert_eq!(found.len(), 1, "boxes {}", String::from_utf8_lossy(kind));
    found[0].1
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_be_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}
