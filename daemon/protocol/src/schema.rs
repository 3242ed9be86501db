//! All messages as one JSON schema, for those who generate or check clients.

use schemars::{JsonSchema, Schema, SchemaGenerator, generate::SchemaSettings};

use crate::{ClientMessage, DaemonMessage};

/// A line of the wire, either way.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "Mouthpiece")]
#[allow(dead_code, reason = "only its schema is of use")]
enum Message {
    /// What a client sends.
    Client(ClientMessage),
    /// What the daemon sends.
    Daemon(DaemonMessage),
}

/// The schema of a line: `#/$defs/ClientMessage` is what a client sends, `#/$defs/DaemonMessage` what
/// the daemon sends.
#[must_use]
pub fn schema() -> Schema {
    let generator: SchemaGenerator = SchemaSettings::draft2020_12().into_generator();
    generator.into_root_schema_for::<Message>()
}

/// The same as the text of `schema.json`.
///
/// # Errors
/// Never in practice: a schema is JSON.
pub fn text() -> Result<String, serde_json::Error> {
    let mut text = serde_json::to_string_pretty(&schema())?;
    text.push('\n');
    Ok(text)
}
