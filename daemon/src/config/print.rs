//! The whole configuration as a TOML file that says what each key means.

use std::fmt::Write as _;

use super::Config;

/// `config` as text that reads back as the same configuration. Keys that are not set are named in
/// a comment.
pub fn toml(config: &Config) -> anyhow::Result<String> {
    let all = toml::Table::try_from(config)?;
    let mut text = String::new();
    for (name, about, keys) in Config::sections() {
        if !text.is_empty() {
            text.push('\n');
        }
        for line in about {
            writeln!(text, "#{line}")?;
        }
        writeln!(text, "[{name}]")?;
        let section = all.get(name).and_then(toml::Value::as_table);
        for key in keys {
            text.push('\n');
            for line in key.about {
                writeln!(text, "#{line}")?;
            }
            if key.at_start {
                writeln!(text, "# (A change is felt at the next start.)")?;
            }
            match section.and_then(|s| s.get(key.name)) {
                Some(value) => writeln!(text, "{} = {value}", key.name)?,
                None => writeln!(text, "#{} =", key.name)?,
            }
        }
    }
    Ok(text)
}
