//! Guards the schema in the repository: what the types say, and no less strict than they are.

use serde_json::Value;

/// What is in the repository; nothing where it is not there.
fn read() -> String {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/schema.json");
    std::fs::read_to_string(file).unwrap_or_default()
}

#[test]
fn the_schema_in_the_repository_is_that_of_the_types() {
    let written = read();
    let generated = mouthpiece_protocol::schema::text().unwrap();
    assert!(
        written == generated,
        "renew it: cargo run --release -p mouthpiece-protocol --example schema > daemon/protocol/schema.json"
    );
}

/// A misspelt field of a client is an error, so the schema must say so.
#[test]
fn messages_of_clients_have_no_other_fields() {
    let schema: Value = serde_json::from_str(&read()).unwrap();
    let messages = schema["$defs"]["ClientMessage"]["oneOf"]
        .as_array()
        .unwrap();
    assert!(messages.len() >= 12);
    for message in messages {
        let strict =
            message["additionalProperties"] == false || message["unevaluatedProperties"] == false;
        assert!(strict, "{message}");
    }
}
