//! What our scripts print, as labels: lines of fields that tabs part, times in samples.
//!
//! `rate HZ` comes first; then `phone START END SYMBOL`. `note TEXT` says something to the user.
//! A line of another kind, or one that cannot be read, is a script that does not fit its engine.

use mouthpiece_phonemes::SampleRate;

/// A phone as the engine calls it, times in ticks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    pub symbol: String,
    pub start: i64,
    pub end: i64,
}

/// Reads all rows and notes.
pub fn read(printed: &[u8]) -> Result<(Vec<Row>, Vec<String>), String> {
    let text = String::from_utf8_lossy(printed);
    let (mut rows, mut notes) = (Vec::new(), Vec::new());
    let mut rate = None;
    for line in text.lines() {
        let odd = || format!("it printed `{}`", line.chars().take(60).collect::<String>());
        let fields: Vec<&str> = line.split('\t').collect();
        match fields[..] {
            ["rate", hz] => {
                let hz = hz.parse().map_err(|_| odd())?;
                rate = Some(SampleRate::new(hz).map_err(|e| e.to_string())?);
            }
            ["phone", start, end, symbol] => {
                let ticks = |field: &str| rate?.ticks(field.parse().ok()?);
                rows.push(Row {
                    symbol: symbol.to_owned(),
                    start: ticks(start).ok_or_else(odd)?,
                    end: ticks(end).ok_or_else(odd)?,
                });
            }
            ["note", note] => notes.push(note.to_owned()),
            _ => return Err(odd()),
        }
    }
    Ok((rows, notes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rows_are_read_in_ticks() {
        let (rows, notes) = read("rate\t24000\nphone\t0\t10\tɑː\nnote\tso\n".as_bytes()).unwrap();
        assert_eq!(
            rows,
            [Row {
                symbol: "ɑː".into(),
                start: 0,
                end: 20
            }]
        );
        assert_eq!(notes, ["so"]);
        assert!(read(b"phone\t0\t10\ta").is_err(), "no rate");
        assert!(read(b"Traceback").is_err());
    }

    proptest! {
        #[test]
        fn nothing_printed_makes_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = read(&bytes);
            let _ = read(&[b"rate\t1\nphone\t", &bytes[..]].concat());
        }
    }
}
