//! The file: where it is, and what is wrong with it, in one sentence that names the line and the key.

use std::ops::Range;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::Config;
use crate::cli::BackgroundArg;

/// The largest file that is read: hundreds of times what all keys take.
const BYTES_MAX: u64 = 1 << 20;

/// Why a configuration cannot be had.
#[derive(Debug, Error)]
pub enum ConfigError {
    /// The file is not there or cannot be read.
    #[error("{file}: cannot be read ({why}); see an example with `mouthpiece config print`")]
    Read { file: String, why: String },
    /// The file says something that cannot be meant.
    #[error("{file}, line {line}: {key}{why}")]
    Wrong {
        file: String,
        line: usize,
        /// With a colon and a space behind it, or empty.
        key: String,
        why: String,
    },
}

/// The file that is read when none is named, where it is there.
pub fn user_default() -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty());
    let base = folder("XDG_CONFIG_HOME")
        .map(PathBuf::from)
        .or_else(|| folder("HOME").map(|home| Path::new(&home).join(".config")))?;
    let file = base.join("mouthpiece").join("config.toml");
    file.is_file().then_some(file)
}

/// Reads `file`. Files that it names are found from its own folder on.
pub fn read(file: &Path) -> Result<Config, ConfigError> {
    let unreadable = |why: String| ConfigError::Read {
        file: file.display().to_string(),
        why,
    };
    let bytes = std::fs::metadata(file).map_err(|e| unreadable(e.to_string()))?;
    if !bytes.is_file() || bytes.len() > BYTES_MAX {
        return Err(unreadable(format!(
            "it is no file of at most {BYTES_MAX} bytes"
        )));
    }
    let text = std::fs::read_to_string(file).map_err(|e| unreadable(e.to_string()))?;
    let mut config = parse(&text, &file.display().to_string())?;
    let folder = file.parent().unwrap_or(Path::new(""));
    config.find_files_from(folder);
    Ok(config)
}

/// Reads the text of a file that is called `name`.
pub fn parse(text: &str, name: &str) -> Result<Config, ConfigError> {
    toml::from_str(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        let (line, key) = place(text, &span);
        ConfigError::Wrong {
            file: name.to_owned(),
            line,
            why: mend(error.message(), &key),
            key: if key.is_empty() {
                key
            } else {
                format!("{key}: ")
            },
        }
    })
}

impl Config {
    fn find_files_from(&mut self, folder: &Path) {
        // A path that is whole stays as it is.
        let find = |path: &mut PathBuf| *path = folder.join(&*path);
        self.look.head.iter_mut().for_each(find);
        self.look.environment.iter_mut().for_each(find);
        if let BackgroundArg::Picture(path) = &mut self.look.background {
            find(path);
        }
    }
}

/// Line and key (`section.key`) of a place in the text.
fn place(text: &str, span: &Range<usize>) -> (usize, String) {
    let start = (0..=span.start.min(text.len()))
        .rev()
        .find(|at| text.is_char_boundary(*at))
        .unwrap_or(0);
    let before = &text[..start];
    let number = before.matches('\n').count();
    let line = text.lines().nth(number).unwrap_or("").trim();
    let heading = |line: &str| {
        let line = line.trim().strip_prefix('[')?;
        Some(line.split(']').next()?.trim().to_owned())
    };
    if let Some(section) = heading(line) {
        return (number + 1, format!("[{section}]"));
    }
    let section = before.lines().rev().find_map(heading);
    let key = match line.split_once('=') {
        Some((key, _)) => key.trim(),
        None => "",
    };
    let key = match (section, key) {
        (_, "") => String::new(),
        (Some(section), key) => format!("{section}.{key}"),
        (None, key) => key.to_owned(),
    };
    (number + 1, key)
}

/// What toml says, in one line, and what to write instead where it was a word mistyped.
fn mend(message: &str, key: &str) -> String {
    let message = message.split_whitespace().collect::<Vec<_>>().join(" ");
    if !message.starts_with("unknown field") {
        return message;
    }
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let Some((wrong, known)) = quoted.split_first() else {
        return message;
    };
    let what = if key.starts_with('[') {
        "section"
    } else {
        "key"
    };
    let near = known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(wrong, name), name))
        .min()
        .filter(|(distance, _)| *distance <= 3);
    match near {
        Some((_, name)) => format!("there is no such {what}, did you mean {name}?"),
        None => format!("there is no such {what}, there are {}", known.join(", ")),
    }
}
