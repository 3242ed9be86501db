//! What a row of a list asks for: its cells as the options of `mouthpiece export`, read by the same reader as a
//! command line, so that both take the same words and refuse the same.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::builder::ValueHint;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, Args as _, Command, CommandFactory as _, FromArgMatches as _};

use super::read::Cells;
use crate::cli::{BackgroundArg, Cli, ExportArgs, JobsArgs};
use crate::export::sink::Kind;

/// A video that a row asks for.
#[derive(Debug)]
pub struct Request {
    pub args: ExportArgs,
    pub output: PathBuf,
    pub kind: Kind,
    /// What decides the picture: options with their values, in order of their names.
    pub words: Vec<(String, Word)>,
}

/// The value of an option.
#[derive(Clone, Debug, PartialEq)]
pub enum Word {
    Text(String),
    /// What counts is what it holds.
    File(PathBuf),
}

impl Word {
    fn text(&self) -> OsString {
        match self {
            Self::Text(text) => text.into(),
            Self::File(path) => path.into(),
        }
    }
}

/// Reads rows.
pub struct Reader {
    command: Command,
    columns: Vec<String>,
    /// Options of the command line, for all rows.
    given: Vec<(String, Word)>,
    /// What files of rows are relative to.
    folder: PathBuf,
    output_folder: PathBuf,
}

impl Reader {
    /// For the list at `list`; `command_line` is that of this process.
    pub fn new(
        list: &Path,
        output_dir: Option<&Path>,
        command_line: impl IntoIterator<Item = OsString>,
    ) -> anyhow::Result<Self> {
        let folder = list.parent().unwrap_or(Path::new("")).to_path_buf();
        let mut command = ExportArgs::augment_args(Command::new("export").no_binary_name(true));
        command.build();
        let about_lists = JobsArgs::augment_args(Command::new("jobs"));
        let about_lists: Vec<_> = about_lists.get_arguments().map(Arg::get_id).collect();
        let columns = command
            .get_arguments()
            .filter(|arg| !about_lists.contains(&arg.get_id()));
        let columns = columns
            .filter(|arg| !matches!(arg.get_action(), ArgAction::Help | ArgAction::HelpLong));
        let columns: Vec<_> = columns
            .filter_map(|arg| arg.get_long().map(str::to_owned))
            .collect();

        let matches = Cli::command().try_get_matches_from(command_line)?;
        let mut given = Vec::new();
        if let Some(matches) = matches.subcommand_matches("export") {
            for name in &columns {
                let Some(arg) = named(&command, name) else {
                    continue;
                };
                let id = arg.get_id().as_str();
                if matches.value_source(id) != Some(ValueSource::CommandLine) {
                    continue;
                }
                let value = matches.get_raw(id).and_then(|mut raw| raw.next());
                given.push((
                    name.clone(),
                    match value {
                        Some(value) if is_path(arg) => Word::File(value.into()),
                        Some(value) => Word::Text(value.to_string_lossy().into_owned()),
                        None => Word::Text("true".into()),
                    },
                ));
            }
        }
        Ok(Self {
            command,
            columns,
            given,
            output_folder: output_dir.map_or_else(|| folder.clone(), Path::to_path_buf),
            folder,
        })
    }

    /// What rows may say.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// What a row asks for, or why it cannot be meant.
    pub fn read(&mut self, cells: &Cells) -> Result<Request, String> {
        let unsaid = |(name, _): &&(String, Word)| !cells.contains_key(name);
        let mut words: Vec<_> = self.given.iter().filter(unsaid).cloned().collect();
        for (name, value) in cells {
            words.push((name.clone(), self.word(name, value)?));
        }
        words.sort_by(|a, b| a.0.cmp(&b.0));

        let mut line: Vec<OsString> = Vec::new();
        for (name, word) in &words {
            let mut option = OsString::from(format!("--{name}"));
            if takes_value(&self.command, name) {
                option.push("=");
                option.push(word.text());
                line.push(option);
            } else if *word == Word::Text("true".into()) {
                line.push(option);
            }
        }
        let args = self
            .command
            .try_get_matches_from_mut(line)
            .and_then(|matches| ExportArgs::from_arg_matches(&matches))
            .map_err(|error| sentence(&error))?;
        let output = args.output.clone().ok_or("it has no output")?;
        let kind = Kind::of(&output, &args).map_err(|error| error.to_string())?;
        let stdin = args.input.labels.as_deref() == Some(Path::new("-"))
            || args.input.text.text.as_deref() == Some("-");
        if stdin || !kind.stays() {
            return Err("in a list labels, text and output are files or texts; name them instead of a pipe or a device".into());
        }
        words.retain(|(name, _)| name != "output");
        Ok(Request {
            args,
            output,
            kind,
            words,
        })
    }

    /// A cell as its option's value.
    fn word(&self, name: &str, value: &str) -> Result<Word, String> {
        let Some(arg) = named(&self.command, name) else {
            return Err(format!("`{name}` is no column"));
        };
        if !arg.get_action().takes_values() {
            return match value.to_ascii_lowercase().as_str() {
                "true" | "yes" | "1" => Ok(Word::Text("true".into())),
                "false" | "no" | "0" => Ok(Word::Text("false".into())),
                _ => Err(format!("`{name}` is true or false, not {value:?}")),
            };
        }
        if name == "output" && value != "-" {
            return Ok(Word::File(self.output_folder.join(value)));
        }
        let path = self.folder.join(value);
        let file = match name {
            "background" => matches!(value.parse(), Ok(BackgroundArg::Picture(_))),
            // A voice is a name, for one engine also a file.
            "voice" => path.is_file(),
            _ => is_path(arg) && value != "-",
        };
        Ok(if file {
            Word::File(path)
        } else {
            Word::Text(value.into())
        })
    }
}

fn named<'a>(command: &'a Command, name: &str) -> Option<&'a Arg> {
    command
        .get_arguments()
        .find(|arg| arg.get_long() == Some(name))
}

fn takes_value(command: &Command, name: &str) -> bool {
    named(command, name).is_some_and(|arg| arg.get_action().takes_values())
}

fn is_path(arg: &Arg) -> bool {
    !matches!(arg.get_value_hint(), ValueHint::Unknown | ValueHint::Other)
}

/// What the reader of command lines complains of, in one line and without its advice on usage.
fn sentence(error: &clap::Error) -> String {
    let text = error.to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    let first = text.split("\n\n").next().unwrap_or(text);
    first.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reader(command_line: &str) -> Reader {
        let words = command_line.split(' ').map(OsString::from);
        Reader::new(Path::new("lists/a.csv"), Some(Path::new("out")), words).unwrap()
    }

    fn cells(pairs: &[(&str, &str)]) -> Cells {
        pairs
            .iter()
            .map(|(a, b)| ((*a).into(), (*b).into()))
            .collect()
    }

    #[test]
    fn a_row_says_what_a_command_line_says_and_overrules_it() {
        let mut reader =
            reader("mouthpiece export --jobs lists/a.csv --size 320x240 --head h.glb --via-ffmpeg");
        let request = reader
            .read(&cells(&[
                ("labels", "a.phn"),
                ("output", "a.mkv"),
                ("size", "64x48"),
                ("background", "wall.png"),
            ]))
            .unwrap();
        assert_eq!(request.args.size.width, 64);
        assert_eq!(request.output, Path::new("out/a.mkv"));
        assert!(request.args.via_ffmpeg);
        let word = |name: &str| {
            request
                .words
                .iter()
                .find(|(n, _)| n == name)
                .map(|(_, word)| word.clone())
        };
        assert_eq!(word("labels"), Some(Word::File("lists/a.phn".into())));
        assert_eq!(word("head"), Some(Word::File("h.glb".into())));
        assert_eq!(
            word("background"),
            Some(Word::File("lists/wall.png".into()))
        );
        assert_eq!(word("output"), None);
        let row = [
            ("labels", "a.phn"),
            ("output", "a.mkv"),
            ("via-ffmpeg", "no"),
        ];
        let why = reader.read(&cells(&row)).unwrap_err();
        assert!(why.contains("is not known"), "{why}");
    }

    #[test]
    fn options_about_lists_are_no_columns_and_the_rest_are() {
        let reader = reader("mouthpiece export --jobs a.csv");
        let has = |name: &str| reader.columns().iter().any(|column| column == name);
        for name in [
            "labels", "audio", "text", "tts", "voice", "output", "fps", "tier", "script", "seed",
            "head", "demo",
        ] {
            assert!(has(name), "{name}");
        }
        for name in [
            "jobs",
            "shard",
            "parallel",
            "report",
            "output-dir",
            "help",
            "verbose",
        ] {
            assert!(!has(name), "{name}");
        }
    }

    #[test]
    fn what_cannot_be_meant_is_one_line() {
        let mut reader = reader("mouthpiece export --jobs a.csv");
        for (row, part) in [
            (
                &[("labels", "a.phn"), ("output", "a.mp4"), ("size", "640")][..],
                "WIDTHxHEIGHT",
            ),
            (&[("labels", "a.phn")], "--output"),
            (&[("output", "a.mp4")], "--labels"),
            (&[("labels", "-"), ("output", "a.mp4")], "pipe"),
            (&[("labels", "a.phn"), ("output", "-")], "pipe"),
            (&[("demo", "perhaps"), ("output", "a.mp4")], "true or false"),
        ] {
            let why = reader.read(&cells(row)).unwrap_err();
            assert!(why.contains(part) && !why.contains('\n'), "{why}");
        }
    }
}
