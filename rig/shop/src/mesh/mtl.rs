//! The materials of an OBJ: their names, colours and pictures (`newmtl`, `Kd`, `map_Kd`).

use super::Side;
use super::builder::{Builder, byte};
use super::error::{Fault, Found};
use super::limits::MAX_SIDE_FILE_BYTES;
use super::picture::Material;
use super::text::{Lines, words};

/// Materials of one scan: no scanner writes more, and a search by name stays quick.
const MAX_MATERIALS: usize = 4096;

/// Adds the materials in `bytes` to `out` and their names to `names`.
pub(crate) fn read(
    bytes: &[u8],
    out: &mut Builder,
    names: &mut Vec<Vec<u8>>,
    side: &dyn Side,
) -> Result<(), Found> {
    if bytes.len() as u64 >= MAX_SIDE_FILE_BYTES {
        return Err(Fault::HugeFile(bytes.len() as u64).into());
    }
    let mut current = None;
    for (_, line) in Lines::new(bytes) {
        let line = line.trim_ascii();
        let mut rest = words(line);
        let key = rest.next().unwrap_or_default();
        let argument = line[key.len()..].trim_ascii();
        match (key, current) {
            (b"newmtl", _) => {
                if out.materials.len() >= MAX_MATERIALS {
                    let found = format!("more than {MAX_MATERIALS} materials");
                    let mend = "bake the scan's colour into one texture";
                    return Err(Fault::Unsupported { found, mend }.into());
                }
                current = Some(out.materials.len());
                out.materials.push(Material::default());
                names.push(argument.to_vec());
            }
            (b"Kd", Some(material)) => {
                let channels: Vec<f64> = rest
                    .filter_map(|w| std::str::from_utf8(w).ok()?.parse().ok())
                    .collect();
                if let [r, g, b] = channels[..] {
                    out.materials[material].solid = [r, g, b].map(byte);
                }
            }
            (b"map_Kd", Some(material)) => {
                let name = String::from_utf8_lossy(file_name(argument));
                out.materials[material].picture = out.picture(&name, side)?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// The file's name after options such as `-s 1 1 1`.
fn file_name(argument: &[u8]) -> &[u8] {
    let mut rest = argument;
    while rest.starts_with(b"-") {
        rest = skip_word(rest);
        // The option's values: numbers, `on` and `off`.
        while let Some(word) = words(rest).next() {
            let text = std::str::from_utf8(word).unwrap_or_default();
            if text.parse::<f64>().is_err() && !matches!(text, "on" | "off") {
                break;
            }
            rest = skip_word(rest);
        }
    }
    rest
}

fn skip_word(text: &[u8]) -> &[u8] {
    let end = text
        .iter()
        .position(u8::is_ascii_whitespace)
        .unwrap_or(text.len());
    text[end..].trim_ascii_start()
}
