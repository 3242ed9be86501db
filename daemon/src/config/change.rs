//! What differs between two configurations.

use super::Config;

/// A key whose value has changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Changed {
    /// `section.key`.
    pub name: String,
    /// Felt at the next start only.
    pub at_start: bool,
}

impl Config {
    /// The keys whose values differ in `other`.
    pub fn differs_in(&self, other: &Self) -> Vec<Changed> {
        // A configuration that was read can be written.
        let [old, new] = [self, other].map(|c| toml::Table::try_from(c).unwrap_or_default());
        let value = |table: &toml::Table, section: &str, key: &str| {
            table.get(section).and_then(|s| s.get(key)).cloned()
        };
        let mut changed = Vec::new();
        for (section, _, keys) in Self::sections() {
            for key in keys {
                if value(&old, section, key.name) != value(&new, section, key.name) {
                    changed.push(Changed {
                        name: format!("{section}.{}", key.name),
                        at_start: key.at_start,
                    });
                }
            }
        }
        changed
    }
}
