//! Fits the reference head's calibration anew and prints it:
//! `cargo run --release -p mouthpiece-rig --example calibrate > rig/data/calibration.json`

use std::sync::Arc;

use mouthpiece_rig::{Calibration, Head};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let head = Arc::new(Head::reference()?);
    println!("{}", serde_json::to_string(&Calibration::fit(&head))?);
    Ok(())
}
