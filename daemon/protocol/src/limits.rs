//! Every bound of the wire. What goes beyond one is answered with an error message that names it;
//! the connection stays open.

/// Longest line, bytes: 8 s of 48 kHz 16-bit mono sound in base64 fit.
pub const LINE_BYTES_MAX: usize = 1 << 20;
/// Longest utterance id, characters.
pub const ID_CHARS_MAX: usize = 64;
/// Labels in one `phones` message: minutes of speech.
pub const PHONES_PER_MESSAGE_MAX: usize = 4096;
/// Labels in one utterance.
pub const PHONES_PER_UTTERANCE_MAX: usize = 16_384;
/// Longest utterance, seconds: at 48 kHz its sound takes 58 MB.
pub const UTTERANCE_SECONDS_MAX: u32 = 300;
/// Utterances of one connection that are accepted and neither finished nor stopped.
pub const PENDING_MAX: usize = 16;
/// Sample rates of sound that is sent.
pub const AUDIO_RATE_HZ: std::ops::RangeInclusive<u32> = 8_000..=192_000;
/// Channels of sound that is sent; they are mixed to one.
pub const CHANNELS_MAX: u16 = 8;
/// Longest file path, characters.
pub const PATH_CHARS_MAX: usize = 4096;
/// Longest token of a `ping`, characters.
pub const TOKEN_CHARS_MAX: usize = 64;

/// The bounds that a daemon may set for itself.
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
        }
    }
}
