//! Writes the reference head as a file: `cargo run --release --example write_reference -- OUT.glb`.

use std::time::Instant;

use mouthpiece_rig::Head;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args()
        .nth(1)
        .ok_or("say where to write: write_reference OUT.glb")?;
    let started = Instant::now();
    let head = Head::reference()?;
    let built = started.elapsed();
    let bytes = head.write();
    std::fs::write(&path, &bytes)?;
    let started = Instant::now();
    let read = Head::read(&bytes)?;
    println!(
        "{path}: {} bytes, {} skin vertices; built in {built:.1?}, read in {:.1?}",
        bytes.len(),
        read.skin.mesh.positions.len(),
        started.elapsed(),
    );
    Ok(())
}
