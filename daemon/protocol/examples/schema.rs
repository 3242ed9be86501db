//! Prints the schema of all messages: `cargo run --release -p mouthpiece-protocol --example schema >
//! daemon/protocol/schema.json` renews the file that a test compares.

fn main() -> Result<(), serde_json::Error> {
    print!("{}", mouthpiece_protocol::schema::text()?);
    Ok(())
}
