//! Times a fit and writes what others need to try the same: `fit_bench DIR` makes a synthetic pair and writes
//! `template.obj`, `scan.obj`, `pairs.csv` (landmarks: template x y z, scan x y z) and `face.csv` into DIR; if `scan.obj`
//! and `pairs.csv` are there already, they are used. The result goes to `fit.obj`, the figures to stdout as JSON.

#[path = "../tests/synthetic/mod.rs"]
#[allow(dead_code, reason = "shared with tests that use all of it")]
mod synthetic;

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use glam::Vec3;
use mouthpiece_shop::closest::Surface;
use mouthpiece_shop::fit::{Options, fit, report::report};
use synthetic::{Faults, Pair, warp};

type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

fn main() -> Result<(), Box<dyn Error>> {
    let dir = std::env::args()
        .nth(1)
        .ok_or("usage: fit_bench DIR [runs]")?;
    let runs: usize = std::env::args().nth(2).map_or(Ok(5), |n| n.parse())?;
    let dir = Path::new(&dir);
    std::fs::create_dir_all(dir)?;
    let faults = Faults {
        noise_mm: 0.15,
        holes: true,
        clumsy_mm: 0.5,
    };
    let mut pair = Pair::new(warp(3), 3, faults);
    if dir.join("scan.obj").exists() && dir.join("pairs.csv").exists() {
        pair.scan = read_obj(&dir.join("scan.obj"))?;
        pair.landmarks = read_pairs(&dir.join("pairs.csv"))?;
    } else {
        write_obj(&dir.join("scan.obj"), &pair.scan.0, &pair.scan.1)?;
        let row =
            |(a, b): &(Vec3, Vec3)| format!("{},{},{},{},{},{}\n", a.x, a.y, a.z, b.x, b.y, b.z);
        std::fs::write(
            dir.join("pairs.csv"),
            pair.landmarks.iter().map(row).collect::<String>(),
        )?;
    }
    write_obj(&dir.join("template.obj"), &pair.positions, &pair.triangles)?;
    let flags = pair
        .freedom
        .iter()
        .zip(&pair.face)
        .map(|(f, on)| format!("{f},{}\n", u8::from(*on)));
    std::fs::write(dir.join("face.csv"), flags.collect::<String>())?;

    let mut best: Option<(f64, f64, _, Surface)> = None;
    for _ in 0..runs.max(1) {
        let begun = Instant::now();
        let scan = Surface::new(&pair.scan.0, &pair.scan.1)?;
        let built = begun.elapsed().as_secs_f64();
        let fitted = fit(
            &pair.template(),
            &scan,
            &pair.landmarks,
            &Options::default(),
        )?;
        let total = begun.elapsed().as_secs_f64();
        if best.as_ref().is_none_or(|b| total < b.0) {
            best = Some((total, built, fitted, scan));
        }
    }
    let (total, built, fitted, scan) = best.ok_or("no run")?;
    write_obj(&dir.join("fit.obj"), &fitted.positions, &pair.triangles)?;
    write_obj(&dir.join("warp.obj"), &fitted.by_landmarks, &pair.triangles)?;
    let judged = report(
        &pair.template(),
        &fitted,
        &scan,
        &pair.landmarks,
        &pair.face,
    )?;
    let off = serde_json::json!({
        "seconds": {"surface": built, "fit": fitted.seconds, "total": total},
        "template": [pair.positions.len(), pair.triangles.len()],
        "scan": [pair.scan.0.len(), pair.scan.1.len()],
        "found": fitted.found, "relaxed": fitted.relaxed, "turned": judged.turned.len(),
        "turned_at": judged.turned.iter().take(20).map(|&f| pair.positions[pair.triangles[f][0] as usize].to_array()).collect::<Vec<_>>(),
        "report": judged,
    });
    println!("{off}");
    Ok(())
}

fn write_obj(
    path: &Path,
    positions: &[Vec3],
    triangles: &[[u32; 3]],
) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    for p in positions {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    Ok(std::fs::write(path, text)?)
}

fn read_obj(path: &Path) -> Result<Mesh, Box<dyn Error>> {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in std::fs::read_to_string(path)?.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let v = words
                    .take(3)
                    .map(str::parse)
                    .collect::<Result<Vec<f32>, _>>()?;
                positions.push(Vec3::from_slice(
                    v.get(..3).ok_or("a vertex of fewer than three numbers")?,
                ));
            }
            Some("f") => {
                let f = words
                    .map(|w| {
                        w.split('/')
                            .next()
                            .unwrap_or("")
                            .parse::<u32>()
                            .map(|i| i - 1)
                    })
                    .collect::<Result<Vec<_>, _>>()?;
                triangles.extend((2..f.len()).map(|i| [f[0], f[i - 1], f[i]]));
            }
            _ => {}
        }
    }
    Ok((positions, triangles))
}

fn read_pairs(path: &Path) -> Result<Vec<(Vec3, Vec3)>, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    text.lines()
        .map(|line| {
            let n = line
                .split(',')
                .map(|w| w.trim().parse())
                .collect::<Result<Vec<f32>, _>>()?;
            let all = n.get(..6).ok_or("a row of fewer than six numbers")?;
            Ok((Vec3::from_slice(&all[..3]), Vec3::from_slice(&all[3..])))
        })
        .collect()
}
