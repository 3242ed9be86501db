//! The command line: what users script against.
//!
//! Only words and their meaning; the work is in the module of each command's name. Values that
//! need reading (sizes, rates, colours) are in [`values`].

mod config;
mod drive;
mod head;
mod jobs;
mod scene;
mod skin;
mod stage;
mod text;
mod values;
mod wire;

use std::path::PathBuf;

use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum};
use mouthpiece_phonemes::Alphabet;
use mouthpiece_render::{Camera, Tier, View};
use mouthpiece_rig::{Anatomy, TissueModel};
use mouthpiece_speech::State;

use crate::health::Door;

pub use config::{ConfigArgs, ConfigCommand};
pub use drive::{DriveArg, Says};
pub use head::{CalibrateArgs, FitArgs, HeadCommand, InfoArgs, LandmarksArgs};
pub use jobs::JobsArgs;
pub use scene::{BackgroundArg, SceneArgs};
pub use skin::SkinArg;
pub use stage::StageArgs;
pub use text::TextArgs;
pub use values::{Fps, Size};
pub use wire::WireArgs;

/// A real-time, speech-driven talking head: phoneme labels and sound in, a speaking face out.
#[derive(Debug, Parser)]
#[command(
    name = "mouthpiece",
    version,
    max_term_width = 100,
    after_help = "Examples:\n  mouthpiece say --demo\n  mouthpiece export --labels hello.phn --audio hello.wav -o hello.mp4\n\n\
                  Exit status: 0 done, 1 the work failed, 2 wrong usage, 130 stopped by Ctrl-C."
)]
pub struct Cli {
    /// Say more on stderr (-v progress and choices, -vv details); RUST_LOG overrides
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub verbose: u8,
    /// Log lines as JSON, an object a line
    #[arg(long, global = true)]
    pub log_json: bool,
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    Run(RunArgs),
    Say(SayArgs),
    Export(ExportArgs),
    Curves(CurvesArgs),
    Labels(LabelsArgs),
    Still(StillArgs),
    #[command(subcommand)]
    Head(HeadCommand),
    Bench(BenchArgs),
    Doctor(DoctorArgs),
    #[command(
        subcommand,
        after_help = "Examples:\n  mouthpiece config print > kiosk.toml\n  mouthpiece config check kiosk.toml"
    )]
    Config(ConfigCommand),
    #[command(hide = true)]
    SyncTest(SyncTestArgs),
}

/// The daemon: a window, sound and a socket; the face idles alive until something speaks
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  mouthpiece run\n  mouthpiece run --config kiosk.toml\n  mouthpiece run --listen ./face.sock --fullscreen\n  mouthpiece run --listen 127.0.0.1:7716 --listen ws://127.0.0.1:7718\n  mouthpiece run --listen 0.0.0.0:7716 --token-file token.txt"
)]
pub struct RunArgs {
    #[command(flatten)]
    pub wire: WireArgs,
    /// Where health is told (/healthz, /metrics, a page at /): HOST:PORT, or none [default: 127.0.0.1:7717]
    #[arg(long, value_name = "ADDR")]
    pub http: Option<Door>,
    /// For tests: SIGUSR2 loses the graphics device, and the picture flashes with clicks in what is said
    #[arg(long, hide = true)]
    pub test: bool,
    #[command(flatten)]
    pub stage: StageArgs,
}

/// Speak through the running daemon; without one, in a window of its own
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  mouthpiece say --demo\n  mouthpiece say --labels hello.phn --audio hello.wav\n  my-tts --timings | mouthpiece say --labels - --audio hello.wav\n  mouthpiece say --text \"Hello there\" --tts espeak-ng"
)]
pub struct SayArgs {
    #[command(flatten)]
    pub input: InputArgs,
    #[command(flatten)]
    pub wire: WireArgs,
    #[command(flatten)]
    pub stage: StageArgs,
}

/// Who speaks.
#[derive(Clone, Debug, Default, Args)]
pub struct CastArgs {
    /// A head file (.glb) [default: the built-in head]
    #[arg(long, value_name = "F")]
    pub head: Option<PathBuf>,
    /// What moves the skin: springs in one layer, or layered tissue [default: what the head says]
    #[arg(long, value_enum, value_name = "MODEL")]
    pub tissue: Option<TissueArg>,
}

/// A model of the skin's tissue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TissueArg {
    /// The skin's edges and springs to muscle and bone: the default
    Springs,
    /// Skin, fascia and skull in prisms: slower, for comparison
    Layered,
}

impl From<TissueArg> for TissueModel {
    fn from(arg: TissueArg) -> Self {
        match arg {
            TissueArg::Springs => Self::Springs,
            TissueArg::Layered => Self::Layered,
        }
    }
}

/// What is to be said.
#[derive(Clone, Debug, Args)]
pub struct InputArgs {
    /// Phoneme labels (TIMIT: `start end phone` a line), `-` for standard input, `fd:3` for an open descriptor
    #[arg(long, value_name = "F", required_unless_present_any = ["demo", "text"])]
    pub labels: Option<PathBuf>,
    /// The sound that belongs to the labels: a WAV or NIST SPHERE file, `-` and `fd:3` as above
    #[arg(long, value_name = "F")]
    pub audio: Option<PathBuf>,
    /// The sentence that comes with the program, instead of files
    #[arg(long, conflicts_with_all = ["labels", "audio"])]
    pub demo: bool,
    #[command(flatten)]
    pub text: TextArgs,
    /// Format of the labels [default: by their name and content]
    #[arg(long, value_name = "FMT", value_parser = values::label_formats())]
    pub from: Option<String>,
    /// Label times are counted at this rate, where their format counts samples
    #[arg(long, value_name = "HZ", default_value_t = 16_000,
          value_parser = clap::value_parser!(u32).range(1..=768_000))]
    pub label_rate: u32,
    /// Alphabet of the labels, where their format leaves it open [default: by their symbols]
    #[arg(long, value_name = "A", value_parser = values::alphabet())]
    pub alphabet: Option<Alphabet>,
    /// The tier to read of a TextGrid, by its name or its number from 1 [default: phones, else words]
    #[arg(long, value_name = "NAME")]
    pub label_tier: Option<String>,
    /// Pronunciations of words, as in the CMU dictionary, for labels that hold words alone
    #[arg(long, value_name = "F")]
    pub dictionary: Option<PathBuf>,
}

/// What the face shows besides what it says.
#[derive(Clone, Debug, Default, Args)]
pub struct MoodArgs {
    /// Show this expression throughout: happiness, sadness, wink_left … (an unknown name lists all)
    #[arg(long, value_name = "NAME")]
    pub expression: Option<String>,
    /// Lead the face through the expressions of a script, .json or .ron
    #[arg(long, value_name = "F")]
    pub script: Option<PathBuf>,
    /// What the face does while it says nothing, where it has a seed
    #[arg(long, value_enum, default_value_t = StateArg::Idle)]
    pub state: StateArg,
}

/// What a face does while it says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum StateArg {
    /// Nobody is there
    #[default]
    Idle,
    /// Somebody speaks to it
    Listening,
    /// It looks for words
    Thinking,
    /// It has the word
    Speaking,
}

impl From<StateArg> for State {
    fn from(arg: StateArg) -> Self {
        match arg {
            StateArg::Idle => Self::Idle,
            StateArg::Listening => Self::Listening,
            StateArg::Thinking => Self::Thinking,
            StateArg::Speaking => Self::Speaking,
        }
    }
}

/// Offline video with sound: the same face faster than real time, the same bytes every time
#[derive(Clone, Debug, Args)]
#[command(
    mut_arg("labels", |arg| arg.required_unless_present("jobs")),
    after_help = "The kind of output goes by the name: OUT.mp4 is H.264 with Opus sound; OUT.webm is VP9 and Opus, with \
                  alpha where the background is transparent (by ffmpeg); OUT-%05d.png or a folder (OUT/) is one picture \
                  a frame; - is raw frames on standard output; /dev/videoN is a v4l2loopback device, in real time \
                  (by ffmpeg).\n\n\
                  Examples:\n  mouthpiece export --labels hello.phn --audio hello.wav -o hello.mp4\n  \
                  mouthpiece export --demo --size 1280x720 --fps 29.97 --expression happiness -o demo.mp4\n  \
                  mouthpiece export --text \"Hello there\" --tts flite --voice rms -o hello.mp4\n  \
                  mouthpiece export --text \"as it is said there\" --audio hello.wav -o hello.mp4\n  \
                  mouthpiece export --demo --background transparent -o demo.webm\n  \
                  mouthpiece export --demo -o - --raw y4m | ffmpeg -i - demo.mkv\n  \
                  mouthpiece export --jobs list.csv --tier low --report report.json"
)]
pub struct ExportArgs {
    #[command(flatten)]
    pub input: InputArgs,
    /// Where to write
    #[arg(short, long, value_name = "OUT", required_unless_present = "jobs")]
    pub output: Option<PathBuf>,
    /// What `-o -` writes
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = RawArg::Rgba)]
    pub raw: RawArg,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480")]
    pub size: Size,
    /// Pictures a second: 30, 23.976, 29.97, 30000/1001
    #[arg(long, value_name = "N", default_value = "30")]
    pub fps: Fps,
    #[command(flatten)]
    pub look: LookArgs,
    #[command(flatten)]
    pub mood: MoodArgs,
    #[command(flatten)]
    pub cast: CastArgs,
    /// Seed of blinks and glances: the same seed, the same video
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Bits a second of the video: 800k, 2M, 2500000 [default: by size and rate]
    #[arg(long, value_name = "B", value_parser = values::bitrate)]
    pub bitrate: Option<u32>,
    /// Encode with the ffmpeg program of this machine instead of the built-in encoder
    #[arg(long)]
    pub via_ffmpeg: bool,
    #[command(flatten)]
    pub list: JobsArgs,
}

/// Raw frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum RawArg {
    /// Four bytes a pixel, rows from the top, no header
    #[default]
    Rgba,
    /// YUV4MPEG2: 4:2:0 in BT.709, with a header that tells size and rate
    Y4m,
}

/// How a picture looks.
#[derive(Clone, Debug, Args)]
pub struct LookArgs {
    /// Quality of the picture
    #[arg(long, value_enum, default_value_t = TierArg::Medium)]
    pub tier: TierArg,
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Where the camera stands
    #[arg(long, value_enum, default_value_t = ViewArg::Front)]
    pub view: ViewArg,
}

/// What speech computed and what the face then did, one row per instant; needs no GPU
#[derive(Debug, Args)]
#[command(
    after_help = "Columns: time_s, one per control, then measured on the simulated head: aperture_mm, width_mm, \
                  protrusion_mm, jaw_rad, lip_teeth_mm.\n\n\
                  Examples:\n  mouthpiece curves --labels hello.phn\n  mouthpiece curves --demo --as arkit --rate 60 -o demo.csv\n  mouthpiece curves --labels hello.phn --audio hello.wav --rate 50 -o hello.json"
)]
pub struct CurvesArgs {
    #[command(flatten)]
    pub input: InputArgs,
    /// Rows a second
    #[arg(long, value_name = "HZ", default_value = "100")]
    pub rate: Fps,
    /// Where to write, .csv or .json [default: CSV on standard output]
    #[arg(short, long, value_name = "F")]
    pub output: Option<PathBuf>,
    /// For another avatar, in its own words, instead of the columns below
    #[arg(long = "as", value_enum, value_name = "SET", conflicts_with = "json")]
    pub avatar: Option<AvatarArg>,
    /// JSON whatever the name
    #[arg(long)]
    pub json: bool,
    /// Seed of blinks and glances; without one the face does nothing but speak
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Know each label only so long before it begins, as a live face may, and say what that changes
    #[arg(long, value_name = "MS", conflicts_with = "seed",
          value_parser = clap::value_parser!(u16).range(0..=5000))]
    pub look_ahead: Option<u16>,
    #[command(flatten)]
    pub mood: MoodArgs,
    #[command(flatten)]
    pub cast: CastArgs,
}

/// What other avatars are driven by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AvatarArg {
    /// ARKit's 52 blend shapes, a CSV as Live Link Face records it (take --rate 60)
    Arkit,
    /// The 15 visemes of Oculus LipSync as weights that add up to 1, CSV
    Oculus,
    /// MPEG-4's facial animation parameters of the mouth, a .fap text
    Fap,
}

/// Read a label file, check it, and write it as another
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  mouthpiece labels hello.phn\n  mouthpiece labels hello.phn --json\n  mouthpiece labels hello48k.phn --rate 48000 -o hello.phn\n  \
                  mouthpiece labels hello.TextGrid --label-tier phones --alphabet ipa --to xlabel -o hello.lab"
)]
pub struct LabelsArgs {
    /// The label file, `-` for standard input
    #[arg(value_name = "F")]
    pub file: PathBuf,
    /// Its format [default: by its name and content]
    #[arg(long, value_name = "FMT", value_parser = values::label_formats())]
    pub from: Option<String>,
    /// Alphabet of its phones, where its format leaves it open [default: by its symbols]
    #[arg(long, value_name = "A", value_parser = values::alphabet())]
    pub alphabet: Option<Alphabet>,
    /// The tier to read of a TextGrid, by its name or its number from 1 [default: phones, else words]
    #[arg(long, alias = "tier", value_name = "NAME")]
    pub label_tier: Option<String>,
    /// Pronunciations of words, as in the CMU dictionary, for labels that hold words alone
    #[arg(long, value_name = "F")]
    pub dictionary: Option<PathBuf>,
    /// The format to write [default: TIMIT]
    #[arg(long, value_name = "FMT", value_parser = values::written_formats())]
    pub to: Option<String>,
    /// Times in the file are counted at this rate, where its format counts samples
    #[arg(long, value_name = "HZ", default_value_t = 16_000,
          value_parser = clap::value_parser!(u32).range(1..=768_000))]
    pub rate: u32,
    /// Times in what is written are counted at this rate
    #[arg(long, value_name = "HZ", default_value_t = 16_000,
          value_parser = clap::value_parser!(u32).range(1..=768_000))]
    pub out_rate: u32,
    /// Where to write [default: standard output]
    #[arg(short, long, value_name = "F")]
    pub output: Option<PathBuf>,
    /// Print what was read, and what is odd about it, as JSON
    #[arg(long, conflicts_with = "to")]
    pub json: bool,
}

/// One picture
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  mouthpiece still -o face.png\n  mouthpiece still --phone aa --view 34 --size 800x800 --tier high -o aa.png\n  \
                  mouthpiece still --controls '{\"jaw_rad\": 0.2, \"zygomaticus_major\": 0.8}' -o grin.png\n  \
                  mouthpiece still --show muscles --controls '{\"zygomaticus_major\": 1}' -o muscles.png\n  \
                  mouthpiece still --phone uw --outline uw.json -o uw.png"
)]
pub struct StillArgs {
    /// Control values by name as JSON, or a file with them
    #[arg(long, value_name = "JSON")]
    pub controls: Option<String>,
    /// The mouth of this TIMIT phone, held
    #[arg(long, value_name = "CODE", conflicts_with = "controls")]
    pub phone: Option<String>,
    /// An expression by name: happiness, sadness, wink_left … (an unknown name lists all)
    #[arg(long, value_name = "NAME", conflicts_with_all = ["controls", "phone"])]
    pub expression: Option<String>,
    #[command(flatten)]
    pub look: LookArgs,
    #[command(flatten)]
    pub cast: CastArgs,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480")]
    pub size: Size,
    /// What is shown: the skin, or what lies under it
    #[arg(long, value_enum, default_value_t = ShowArg::Skin)]
    pub show: ShowArg,
    /// Also write where lips, lids and landmarks lie in the picture, as JSON
    ///
    /// Points are [x, y] in pixels from the upper left corner. lips.outer (the border of the red) and lips.inner
    /// (where the lips touch) are closed lines from the subject's right corner over the upper lip to the left one and
    /// back along the lower lip; lids.left and lids.right, the subject's, hold the margins upper and lower; landmarks
    /// holds Farkas's points by name. What nearer skin hides is listed too.
    #[arg(long, value_name = "F.json", verbatim_doc_comment)]
    pub outline: Option<PathBuf>,
    /// Where to write: a .png file
    #[arg(short, long, value_name = "F.png")]
    pub output: PathBuf,
}

/// Speed of each stage on this machine
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  mouthpiece bench\n  mouthpiece bench --json > speed.json")]
pub struct BenchArgs {
    /// Machine-readable output
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub cast: CastArgs,
}

/// What this machine has (GPU, sound, display) and what to install
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  mouthpiece doctor\n  mouthpiece doctor --sync")]
pub struct DoctorArgs {
    /// Play clicks with flashes instead, record what the sound server plays, and say by how much the
    /// picture is later than the sound
    #[arg(long)]
    pub sync: bool,
    /// How many of them, one a second
    #[arg(long, value_name = "S", default_value_t = 15, requires = "sync",
          value_parser = clap::value_parser!(u32).range(3..=120))]
    pub seconds: u32,
    /// As `run --audio-device`
    #[arg(long, value_name = "ID", requires = "sync")]
    pub audio_device: Option<String>,
    /// As `run --av-offset`: the offset to be tried
    #[arg(long, value_name = "MS", requires = "sync", allow_negative_numbers = true,
          value_parser = clap::value_parser!(i16).range(-500..=500))]
    pub av_offset: Option<i16>,
    /// Size of the window in pixels
    #[arg(long, value_name = "WxH", requires = "sync")]
    pub size: Option<Size>,
}

/// Clicks with flashes, for recorders of sound and screen to compare (tests/live_sync.py)
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  mouthpiece sync-test 60")]
pub struct SyncTestArgs {
    /// How long
    #[arg(value_parser = clap::value_parser!(u32).range(1..=3600))]
    pub seconds: u32,
    #[command(flatten)]
    pub stage: StageArgs,
}

/// Quality of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TierArg {
    Low,
    Medium,
    High,
}

/// Quality of a live picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LiveTierArg {
    /// The best that this machine draws in time, found while it runs
    Auto,
    Low,
    Medium,
    High,
}

impl LiveTierArg {
    /// The tier, none where it is to be found.
    pub fn fixed(self) -> Option<Tier> {
        match self {
            Self::Auto => None,
            Self::Low => Some(Tier::Low),
            Self::Medium => Some(Tier::Medium),
            Self::High => Some(Tier::High),
        }
    }
}

/// Where the camera stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ViewArg {
    Front,
    Side,
    /// Half way between the two
    #[value(name = "34")]
    ThreeQuarter,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShowArg {
    /// The face
    Skin,
    /// The muscles as they are contracted, on the skull
    Muscles,
    /// Skull, teeth and eyeballs
    Skull,
    /// The springs that hold the skin: to skin (blue pressed, orange stretched), bone (teal) and muscle (red)
    Springs,
}

impl ShowArg {
    /// What takes the skin's place.
    pub fn anatomy(self) -> Option<Anatomy> {
        match self {
            Self::Skin => None,
            Self::Muscles => Some(Anatomy::Muscles),
            Self::Skull => Some(Anatomy::Skull),
            Self::Springs => Some(Anatomy::Springs),
        }
    }
}

/// What was asked for cannot be meant: exit status 2, as for what clap finds itself.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Usage(pub String);

impl TierArg {
    /// The word on the command line.
    pub fn name(self) -> &'static str {
        Tier::from(self).name()
    }
}

impl From<TierArg> for Tier {
    fn from(tier: TierArg) -> Self {
        match tier {
            TierArg::Low => Self::Low,
            TierArg::Medium => Self::Medium,
            TierArg::High => Self::High,
        }
    }
}

impl LookArgs {
    /// How the renderer is to look at the head. Reads the files that are named.
    pub fn view(&self) -> anyhow::Result<View> {
        let view = self.scene.view()?;
        Ok(View {
            camera: match self.view {
                ViewArg::Front => Camera::Front,
                ViewArg::Side => Camera::Side,
                ViewArg::ThreeQuarter => Camera::ThreeQuarter,
            },
            ..view
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_of_commands_is_consistent() {
        use clap::CommandFactory as _;
        Cli::command().debug_assert();
    }

    #[test]
    fn every_command_shows_an_example() {
        use clap::CommandFactory as _;
        let whole = Cli::command();
        let all = whole.get_subcommands().flat_map(|command| {
            let below = command.get_subcommands();
            let itself = (!command.has_subcommands()).then_some(command);
            below.chain(itself)
        });
        for command in all {
            let help = command.get_after_help().map(ToString::to_string);
            assert!(
                help.unwrap_or_default().contains("mouthpiece "),
                "{} has no example",
                command.get_name()
            );
        }
    }
}
