//! Reads a list: CSV with a line of column names, or NDJSON with an object a line.
//!
//! Knows the shape of lists and the names of columns, not what the cells mean. A row that cannot be read is kept with
//! its reason: the others are made, and every machine that shares the list counts the same rows.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use csv::{ByteRecord, ReaderBuilder, Trim};
use serde_json::Value;
use thiserror::Error;

/// Longest list: far more rows than a machine can make in a year, and some seconds to read.
const LIST_BYTES_MAX: u64 = 256 * 1024 * 1024;

/// What a row says: an option's name without its dashes, and its value.
pub type Cells = BTreeMap<String, String>;

/// A row of the list, or why it is none.
#[derive(Debug)]
pub struct Row {
    /// Counted from 1.
    pub line: u64,
    pub cells: Result<Cells, String>,
}

/// Why a list was not read.
#[derive(Debug, Error)]
pub enum ListError {
    #[error("{} cannot be read: {source}", path.display())]
    Io {
        path: PathBuf,
        source: std::io::Error,
    },
    #[error("{} is larger than {} MB; cut it into several lists", .0.display(), LIST_BYTES_MAX >> 20)]
    TooLong(PathBuf),
    #[error("{} must end in .csv or .ndjson, so that its kind is known; rename it", .0.display())]
    Kind(PathBuf),
    #[error("{} line 1: {why}", path.display())]
    Header { path: PathBuf, why: String },
    #[error("{} holds no rows; write one for each video", .0.display())]
    Empty(PathBuf),
}

/// Reads the list at `path`, whose columns may be those of `columns`.
pub fn read(path: &Path, columns: &[String]) -> Result<Vec<Row>, ListError> {
    let unread = |source| ListError::Io {
        path: path.to_path_buf(),
        source,
    };
    let ending = path.extension().and_then(|e| e.to_str());
    let ending = ending.map(str::to_ascii_lowercase);
    let size = fs::metadata(path).map_err(unread)?.len();
    if size > LIST_BYTES_MAX {
        return Err(ListError::TooLong(path.to_path_buf()));
    }
    let bytes = fs::read(path).map_err(unread)?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let rows = match ending.as_deref() {
        Some("csv") => csv(bytes, columns).map_err(|why| ListError::Header {
            path: path.to_path_buf(),
            why,
        })?,
        Some("ndjson" | "jsonl") => ndjson(bytes, columns),
        _ => return Err(ListError::Kind(path.to_path_buf())),
    };
    if rows.is_empty() {
        return Err(ListError::Empty(path.to_path_buf()));
    }
    Ok(rows)
}

/// Rows of a CSV; an error is one of its first line, which every row would share.
fn csv(bytes: &[u8], columns: &[String]) -> Result<Vec<Row>, String> {
    let mut reader = ReaderBuilder::new()
        .flexible(true)
        .trim(Trim::All)
        .from_reader(bytes);
    let header = reader.byte_headers().map_err(|e| e.to_string())?;
    let mut names: Vec<String> = Vec::new();
    for name in header {
        let name = column(&String::from_utf8_lossy(name), columns)?;
        if names.contains(&name) {
            return Err(format!("column `{name}` stands there twice; leave one out"));
        }
        names.push(name);
    }
    let mut rows = Vec::new();
    let mut record = ByteRecord::new();
    // In memory nothing but the end stops it.
    while reader.read_byte_record(&mut record).unwrap_or(false) {
        let line = record.position().map_or(0, |start| line(bytes, start));
        rows.push(Row {
            line,
            cells: cells(&record, &names),
        });
    }
    Ok(rows)
}

/// The line of a record's first cell: a position is that of the end of the record before, with empty lines behind it.
fn line(bytes: &[u8], start: &csv::Position) -> u64 {
    let start_byte = usize::try_from(start.byte()).unwrap_or(usize::MAX);
    let rest = bytes.get(start_byte..).unwrap_or_default();
    let ends = rest.iter().take_while(|b| matches!(b, b'\n' | b'\r'));
    start.line() + ends.filter(|b| **b == b'\n').count() as u64
}

fn cells(record: &ByteRecord, names: &[String]) -> Result<Cells, String> {
    let (found, wanted) = (record.len(), names.len());
    if found != wanted {
        return Err(format!(
            "it has {found} cells, and the list {wanted} columns; put cells that hold a comma in double quotes"
        ));
    }
    let mut cells = Cells::new();
    for (name, value) in names.iter().zip(record) {
        let value = std::str::from_utf8(value)
            .map_err(|_| format!("`{name}` is not UTF-8; save the list as UTF-8"))?;
        if !value.is_empty() {
            cells.insert(name.clone(), value.to_owned());
        }
    }
    Ok(cells)
}

fn ndjson(bytes: &[u8], columns: &[String]) -> Vec<Row> {
    let lines = (1..).zip(bytes.split(|b| *b == b'\n'));
    let rows = lines.filter(|(_, line)| !line.trim_ascii().is_empty());
    rows.map(|(line, bytes)| Row {
        line,
        cells: object(bytes, columns),
    })
    .collect()
}

fn object(bytes: &[u8], columns: &[String]) -> Result<Cells, String> {
    let object: serde_json::Map<String, Value> =
        serde_json::from_slice(bytes).map_err(|e| {
            format!("it is no JSON object in one line ({e}); write {{\"labels\": \"a.phn\", \"output\": \"a.mp4\"}}")
        })?;
    let mut cells = Cells::new();
    for (name, value) in object {
        let name = column(&name, columns)?;
        let text = match value {
            Value::Null => continue,
            Value::String(text) => text,
            Value::Bool(_) | Value::Number(_) => value.to_string(),
            Value::Array(_) | Value::Object(_) => {
                return Err(format!(
                    "`{name}` must be a text, a number, true, false or null"
                ));
            }
        };
        if cells.insert(name.clone(), text).is_some() {
            return Err(format!("`{name}` stands there twice; leave one out"));
        }
    }
    Ok(cells)
}

/// The option that a column is named after; `label_rate` is taken for `label-rate`.
fn column(written: &str, columns: &[String]) -> Result<String, String> {
    let name = written.trim().replace('_', "-").to_ascii_lowercase();
    if columns.contains(&name) {
        return Ok(name);
    }
    if name.contains(';') || name.contains('\t') {
        return Err(format!(
            "`{written}` is no column; separate columns by commas"
        ));
    }
    let near = |known: &&String| strsim::jaro_winkler(known, &name);
    let nearest = columns.iter().max_by(|a, b| near(a).total_cmp(&near(b)));
    Err(match nearest.filter(|known| near(known) > 0.8) {
        Some(known) => format!("`{written}` is no column; did you mean `{known}`?"),
        None => format!(
            "`{written}` is no column; columns are named as the options of `mouthpiece export`: labels, audio, output, \
             size …"
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn columns() -> Vec<String> {
        ["labels", "output", "label-rate", "demo"]
            .map(String::from)
            .into()
    }

    fn of(rows: &[Row]) -> Vec<(u64, Vec<(&str, &str)>)> {
        rows.iter()
            .map(|row| {
                let cells = match &row.cells {
                    Ok(cells) => cells
                        .iter()
                        .map(|(a, b)| (a.as_str(), b.as_str()))
                        .collect(),
                    Err(why) => vec![("error", why.as_str())],
                };
                (row.line, cells)
            })
            .collect()
    }

    #[test]
    fn both_kinds_of_list_say_the_same_of_the_same_lines() {
        let of_csv = "labels, Label_Rate,output\n\"a,b.phn\",8000,a.mp4\n\nc.phn,,c.mp4\n";
        let of_ndjson = "\n{\"labels\": \"a,b.phn\", \"label_rate\": 8000, \"output\": \"a.mp4\"}\n\n\
                         {\"labels\": \"c.phn\", \"label-rate\": null, \"output\": \"c.mp4\"}\n";
        let first = vec![
            ("label-rate", "8000"),
            ("labels", "a,b.phn"),
            ("output", "a.mp4"),
        ];
        let wanted = [
            (2, first),
            (4, vec![("labels", "c.phn"), ("output", "c.mp4")]),
        ];
        for end in ["\n", "\r\n"] {
            let with_end = |text: &str| text.replace('\n', end).into_bytes();
            assert_eq!(of(&csv(&with_end(of_csv), &columns()).unwrap()), wanted);
            assert_eq!(of(&ndjson(&with_end(of_ndjson), &columns())), wanted);
        }
    }

    #[test]
    fn what_is_no_column_is_said_with_a_mend() {
        let why = csv(b"lables,output\n", &columns()).unwrap_err();
        assert!(why.contains("did you mean `labels`"), "{why}");
        let why = csv(b"labels;output\n", &columns()).unwrap_err();
        assert!(why.contains("commas"), "{why}");
        let why = csv(b"labels,labels\n", &columns()).unwrap_err();
        assert!(why.contains("twice"), "{why}");
    }

    #[test]
    fn a_broken_row_leaves_the_others() {
        let rows = csv(b"labels,output\na,b\nc\n\xff,d\ne,f\n", &columns()).unwrap();
        let broken: Vec<_> = rows.iter().map(|row| row.cells.is_err()).collect();
        assert_eq!(broken, [false, true, true, false]);
        let rows = ndjson(
            b"{}\n[]\n{\"demo\": [1]}\n{\"nose\": 1}\n{\"demo\": true}\n",
            &columns(),
        );
        let broken: Vec<_> = rows.iter().map(|row| row.cells.is_err()).collect();
        assert_eq!(broken, [false, true, true, true, false]);
    }

    proptest! {
        #[test]
        fn any_bytes_are_rows_or_reasons(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
            let headed = [b"labels,output\n".as_slice(), &bytes].concat();
            for row in csv(&headed, &columns()).unwrap_or_default() {
                prop_assert!(row.line >= 1);
            }
            let _ = csv(&bytes, &columns());
            let _ = ndjson(&bytes, &columns());
        }
    }
}
