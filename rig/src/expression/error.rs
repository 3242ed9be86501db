//! What can be wrong with expressions and scripts; each error names the file, the line and the mend.

use thiserror::Error;

/// Why an expression or a script was refused.
#[derive(Debug, Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum ExpressionError {
    #[error("cannot read {file}: {source}; check the path and its permissions")]
    Unreadable {
        file: String,
        source: std::io::Error,
    },
    #[error("{file} is no text file of at most {bytes_max} bytes; check that it is the right one")]
    Large { file: String, bytes_max: u64 },
    #[error("{file} ends neither in .json nor in .ron; name it after the form it has")]
    Ending { file: String },
    #[error("{file}, line {line}: {message}")]
    Text {
        file: String,
        line: usize,
        message: String,
    },
    #[error("{0}")]
    Setting(String),
    #[error("{file} has schema {found}, but this version reads 1; take the file of this version")]
    Schema { file: String, found: u32 },
    #[error(
        "there is no expression `{name}`; the nearest is `{nearest}`, and all there are: {known}"
    )]
    Unknown {
        name: String,
        nearest: String,
        known: String,
    },
}
