//! Sculpts the reference head: `cargo run --release -p mouthpiece-shop --example sculpt > rig/data/head.glb`.
//!
//! With `--calibrate` its mouth is learnt anew (some seconds); else the calibration of the present one is kept, where
//! that one can still be read.

use std::io::Write as _;
use std::sync::Arc;

use mouthpiece_rig::{Calibration, Head};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let kept = Head::reference().map(|head| head.calibration);
    let mut head = mouthpiece_shop::sculpt::reference(kept.unwrap_or_default())?;
    if std::env::args().any(|arg| arg == "--calibrate") {
        head = Head::read(&head.write())?;
        head.calibration = Calibration::fit(&Arc::new(head.clone()));
    }
    std::io::stdout().lock().write_all(&head.write())?;
    Ok(())
}
