//! The kernels of `springs.c`, compiled with the machine's C compiler and run as a process of their own.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{fs, io};

use mouthpiece_rig::SpringPass;

use crate::STRETCH;
use crate::turns::TURN;

/// The kernel there that shares our idea of how nodes are laid out; the others are as they are known.
pub(crate) const OUR_LAYOUT: &str = "C, our layout, AVX-512";

const SOURCE: &str = include_str!("springs.c");
/// Of benches alone; what is in it may be deleted.
const FOLDER: &str = env!("CARGO_TARGET_TMPDIR");

/// What a kernel reached.
pub(crate) struct Figure {
    pub(crate) name: String,
    /// The shortest pass, ns per edge.
    pub(crate) ns: f64,
    /// Of its forces from a plain sum, over the largest force.
    pub(crate) difference: f64,
}

/// The kernels, ready to run on one mesh.
pub(crate) struct Rivals {
    program: PathBuf,
    mesh: PathBuf,
}

impl Rivals {
    /// Compiles them and writes down the mesh of `pass`; an error says why that cannot be.
    pub(crate) fn compile(pass: &SpringPass) -> Result<Self, String> {
        let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
        let folder = Path::new(FOLDER);
        let this = Self {
            program: folder.join("springs-in-c"),
            mesh: folder.join("springs-in-c.mesh"),
        };
        let no = |e: io::Error| format!("{compiler}: {e}");
        fs::create_dir_all(folder).map_err(no)?;
        let mut child = Command::new(&compiler)
            .args(["-O3", "-march=native", "-ffast-math", "-x", "c", "-", "-o"])
            .arg(&this.program)
            .arg("-lm")
            .stdin(Stdio::piped())
            .spawn()
            .map_err(no)?;
        if let Some(mut input) = child.stdin.take() {
            input.write_all(SOURCE.as_bytes()).map_err(no)?;
        }
        let status = child.wait().map_err(no)?;
        if !status.success() {
            return Err(format!("{compiler} ended with {status}"));
        }
        fs::write(&this.mesh, dump(pass)).map_err(no)?;
        Ok(this)
    }

    /// One turn.
    pub(crate) fn measure(&self) -> Result<Vec<Figure>, String> {
        let output = Command::new(&self.program)
            .arg(&self.mesh)
            .arg(TURN.as_millis().to_string())
            .stderr(Stdio::inherit())
            .output()
            .map_err(|e| e.to_string())?;
        if !output.status.success() {
            return Err(format!("they ended with {}", output.status));
        }
        let text = String::from_utf8_lossy(&output.stdout);
        let figure = |line: &str| {
            let mut words = line.split('\t');
            Some(Figure {
                name: words.next()?.into(),
                ns: words.next()?.parse().ok()?,
                difference: words.next()?.parse().ok()?,
            })
        };
        let figures: Option<Vec<Figure>> = text.lines().map(figure).collect();
        figures.ok_or_else(|| format!("their output is unclear: {text}"))
    }
}

/// The mesh in the pass's own order: numbers of nodes and edges, places, ends and lengths at rest of edges.
fn dump(pass: &SpringPass) -> Vec<u8> {
    let places: Vec<_> = pass.places().collect();
    let mut bytes = Vec::new();
    for count in [places.len(), pass.edges().len()] {
        bytes.extend((count as u32).to_ne_bytes());
    }
    for place in &places {
        bytes.extend(place.to_array().iter().flat_map(|x| x.to_ne_bytes()));
    }
    for edge in pass.edges() {
        bytes.extend(edge.iter().flat_map(|v| v.to_ne_bytes()));
    }
    for [a, b] in pass.edges() {
        let rest = places[*a as usize].distance(places[*b as usize]) / STRETCH;
        bytes.extend(rest.to_ne_bytes());
    }
    bytes
}
