//! Guards the schema in the repository: what the types say, and no less strict than they are.

use serde_json::Value;

#[test]
fn the_schema_in_the_repository_is_that_of_the_types() {
    let written = include_str!("../schema.json");
    let generated = mouthpiece_protocol::schema::text().unwrap();
    assert!(
        written == generated,
        "renew it: cargo run --release -p mouthpiece-protocol --example schema > daemon/protocol/schema.json"
    );
}

/// A misspelt field of a client is an error, so the schema must say so.
#[test]
fn messages_of_clients_have_no_other_fields() {
    let schema: Value = serde_json::from_str(include_str!("../schema.json")).unwrap();
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
