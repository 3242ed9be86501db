//! Every bound of the wire. What goes beyond one is answered with an error message that names it;
//! the connection stays open.

/// Longest line, bytes: 8 s of 48 kHz 16-bit mono sound in base64 fit.
pub const LINE_BYTES_MAX: usize = 1 << 20;
/// Longest line of a client that has not said the token yet: an `auth` fits, and a crowd of strangers
/// holds next to no memory.
pub const STRANGER_LINE_BYTES_MAX: usize = 1024;
/// Longest utterance id, characters.
pub const ID_CHARS_MAX: usize = 64;
/// Longest name of a client, characters.
pub const NAME_CHARS_MAX: usize = 64;
/// Longest symbol of a label, characters: the longest of any alphabet has seven.
pub const SYMBOL_CHARS_MAX: usize = 32;
/// Labels in one `phones` message: minutes of speech.
pub const PHONES_PER_MESSAGE_MAX: usize = 4096;
/// Labels in one utterance.
pub const PHONES_PER_UTTERANCE_MAX: usize = 16_384;
/// Unknown symbols of one utterance that are warned of one by one.
pub const WARNINGS_PER_UTTERANCE_MAX: usize = 20;
/// Longest utterance, seconds: at 48 kHz its sound takes 58 MB.
pub const UTTERANCE_SECONDS_MAX: u32 = 300;
/// Utterances of one connection that are accepted and neither finished nor stopped.
pub const PENDING_MAX: usize = 16;
/// Lines that a connection may send in a second: a label a line, ten times faster than anyone speaks.
/// Who sends more is read more slowly.
pub const LINES_PER_SECOND_MAX: u32 = 1000;
/// Bytes that a connection may send in a second: 40 times the sound that can be heard meanwhile. Who
/// sends more is read more slowly.
pub const BYTES_PER_SECOND_MAX: u32 = 8 << 20;
/// A connection that nothing comes from for so long, with nothing of its own left to say, is closed;
/// a `ping` is enough.
pub const SILENT_SECONDS_MAX: u32 = 600;
/// Seconds that a client may take for its `auth`.
pub const AUTH_SECONDS_MAX: u32 = 10;
/// Sample rates of sound that is sent.
pub const AUDIO_RATE_HZ: std::ops::RangeInclusive<u32> = 8_000..=192_000;
/// Channels of sound that is sent; they are mixed to one.
pub const CHANNELS_MAX: u16 = 8;
/// Longest file path, characters.
pub const PATH_CHARS_MAX: usize = 4096;
/// Longest token of a `ping`, characters.
pub const TOKEN_CHARS_MAX: usize = 64;
/// Muscles in one `express`: more than there are.
pub const MUSCLES_MAX: usize = 128;
/// Longest name of an expression or a muscle, characters.
pub const FACE_NAME_CHARS_MAX: usize = 64;
/// Longest time that a face takes to go over, seconds.
pub const FADE_SECONDS_MAX: f32 = 60.0;
/// Farthest point to look at, mm: far enough to be anywhere.
pub const LOOK_MM_MAX: f32 = 1e6;
/// Longest caption, characters.
pub const CAPTION_CHARS_MAX: usize = 500;
/// Captions of one utterance: a line every two seconds of the longest, at 2 kB each.
pub const CAPTIONS_PER_UTTERANCE_MAX: usize = 160;

/// The bounds that a daemon may set for itself. The session keeps those of messages; who owns the
/// connection keeps time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Longest line, bytes.
    pub line_bytes: usize,
    /// Labels in one message.
    pub phones_per_message: usize,
    /// Labels in one utterance.
    pub phones_per_utterance: usize,
    /// Longest utterance, seconds.
    pub utterance_seconds: u32,
    /// Utterances of one connection that have not ended.
    pub pending: usize,
    /// Whether `begin` may name a sound file of the daemon's machine.
    pub files: bool,
    /// Lines in a second.
    pub lines_per_second: u32,
    /// Bytes in a second.
    pub bytes_per_second: u32,
    /// Longest silence of a connection that waits for nothing, seconds.
    pub silent_seconds: u32,
    /// Longest time until `auth`, seconds.
    pub auth_seconds: u32,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            line_bytes: LINE_BYTES_MAX,
            phones_per_message: PHONES_PER_MESSAGE_MAX,
            phones_per_utterance: PHONES_PER_UTTERANCE_MAX,
            utterance_seconds: UTTERANCE_SECONDS_MAX,
            pending: PENDING_MAX,
            files: true,
            lines_per_second: LINES_PER_SECOND_MAX,
            bytes_per_second: BYTES_PER_SECOND_MAX,
            silent_seconds: SILENT_SECONDS_MAX,
            auth_seconds: AUTH_SECONDS_MAX,
        }
    }
}
