//! Words of the command line for what has no labels yet: a text, and who says it.

use clap::Args;

use crate::voices::Engine;

/// A text to say.
#[derive(Clone, Debug, Default, Args)]
pub struct TextArgs {
    /// Say this, `-` for standard input: by --tts, or as it is said in the recording --audio
    #[arg(long, value_name = "T", conflicts_with_all = ["labels", "demo"])]
    pub text: Option<String>,
    /// The speech engine of this machine that says it: sound and labels are its own
    #[arg(
        long,
        value_enum,
        value_name = "ENGINE",
        requires = "text",
        conflicts_with = "audio"
    )]
    pub tts: Option<Engine>,
    /// A voice of that engine, by the engine's own name for it; for piper also a model's path
    #[arg(long, value_name = "NAME", requires = "tts")]
    pub voice: Option<String>,
}
