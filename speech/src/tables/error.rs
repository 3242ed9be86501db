//! What can be wrong with a table; each error names the file, the row and the mend.

use thiserror::Error;

/// Why a table was refused.
#[derive(Debug, Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum TableError {
    #[error("cannot read {file}: {source}; check the path and its permissions")]
    Unreadable {
        file: String,
        source: std::io::Error,
    },
    #[error("{file}, line {line}: {message}; see the built-in table for how a row looks")]
    Syntax {
        file: String,
        line: usize,
        message: String,
    },
    #[error("{file}: row `{row}` is not one of TIMIT's 61 phones; rename or remove it")]
    UnknownPhone { file: String, row: String },
    #[error("{file}: there is no row for the phone `{row}`; add one")]
    MissingPhone { file: String, row: &'static str },
    #[error(
        "{file}: row `{row}` names the class `{class}`, which the dominance table does not have; add it there or name another"
    )]
    UnknownClass {
        file: String,
        row: String,
        class: String,
    },
    #[error("{file}: row `{row}`: {field} is {value}, but must lie between {min} and {max}")]
    Range {
        file: String,
        row: String,
        field: String,
        value: f32,
        min: f32,
        max: f32,
    },
    #[error(
        "{file}: row `{row}` gives lips but no jaw_rad, which decides how far the lips must part; add it"
    )]
    LipsWithoutJaw { file: String, row: String },
    #[error(
        "{file}: row `{row}` is of a class that makes contact with the {contact}, but does not ask for it; {mend}"
    )]
    NoContact {
        file: String,
        row: String,
        contact: &'static str,
        mend: &'static str,
    },
    #[error("{file}: row `{row}` has no source; write where its figures come from, or `judgement`")]
    Unsourced { file: String, row: String },
    #[error(
        "{file}: [controls] lists `{name}`, which no head has; see `mouthpiece curves` for the names"
    )]
    UnknownControl { file: String, name: String },
    #[error("{file}: [controls] lists `{name}` twice; a control follows one group")]
    ControlTwice { file: String, name: String },
}
