//! A head as a file: what is written is read again, by us and after other programs, and what is no
//! head is refused in words.
#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on has failed, and says where"
)]

mod like;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use glam::Vec3;
use like::{assert_alike, decorated, reference};
use mouthpiece_rig::{Head, HeadError, Muscle, TissueModel, TissueRecord};
use proptest::prelude::*;

/// Of positions that went through metres and another program's floats, mm.
const CLOSE_MM: f32 = 1e-4;

fn written() -> &'static [u8] {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    BYTES.get_or_init(|| decorated().write())
}

fn scripts() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests")
}

/// Runs another program's script; nothing where it or what it needs is not there.
fn script(program: &str, name: &str, args: &[&Path]) -> Option<std::process::Output> {
    let output = Command::new(program)
        .arg(scripts().join(name))
        .args(args)
        .output();
    match output {
        Ok(output) if output.status.code() != Some(2) => Some(output),
        Ok(output) => {
            eprint!("skipped: {}", String::from_utf8_lossy(&output.stderr));
            None
        }
        Err(error) => {
            eprintln!("skipped: {program} cannot be run: {error}");
            None
        }
    }
}

#[test]
fn what_is_written_is_read_again() {
    let head = decorated();
    let read = Head::read(written()).unwrap();
    assert_alike(&head, &read, 1e-5);
    assert_eq!(head.colour, read.colour);
    assert_eq!(head.skin.mesh.triangles, read.skin.mesh.triangles);
    assert_eq!(head.skin.reference, read.skin.reference);
    assert_alike(
        reference(),
        &Head::read(&reference().write()).unwrap(),
        1e-5,
    );
}

#[test]
fn the_same_head_is_the_same_bytes() {
    assert!(decorated().write() == written());
}

/// Needs node and the npm package gltf-validator (in the folder or in $NODE_PATH).
#[test]
fn khronos_finds_no_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("head.glb");
    std::fs::write(&path, written()).unwrap();
    if let Some(output) = script("node", "gltf_check.mjs", &[&path]) {
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{said}");
        assert!(said.contains("0 errors"), "{said}");
    }
}

/// Needs python3 with numpy; pygltflib and trimesh where they are.
#[test]
fn other_programs_may_save_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("head.glb");
    std::fs::write(&path, written()).unwrap();
    let Some(output) = script("python3", "head_file.py", &[&path, folder.path()]) else {
        return;
    };
    let said = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        panic!("{said}{}", String::from_utf8_lossy(&output.stderr));
    }
    let head = decorated();
    for name in ["pygltflib", "trimesh", "shuffled"] {
        let saved = folder.path().join(name).with_extension("glb");
        if !saved.exists() {
            eprintln!("skipped: {name} is not installed");
            continue;
        }
        let read = Head::load(&saved).unwrap();
        assert_alike(&head, &read, CLOSE_MM);
        assert_eq!(head.colour, read.colour, "{name}");
    }
}

/// Puts other JSON into the file.
fn with_json(change: impl Fn(&str) -> String) -> Vec<u8> {
    let bytes = written();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut json = change(std::str::from_utf8(&bytes[20..20 + length]).unwrap()).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let rest = &bytes[20 + length..];
    let whole = (20 + json.len() + rest.len()) as u32;
    let mut out = bytes[..8].to_vec();
    out.extend(whole.to_le_bytes());
    out.extend((json.len() as u32).to_le_bytes());
    out.extend(&bytes[16..20]);
    out.extend(json);
    out.extend(rest);
    out
}

fn refused(bytes: &[u8]) -> String {
    match Head::read(bytes) {
        Ok(_) => panic!("a broken head was read"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn what_is_broken_is_named_with_its_mend() {
    let bytes = written();
    let replaced = |from: &str, to: &str| {
        refused(&with_json(|json| {
            assert!(json.contains(from), "{from}");
            json.replace(from, to)
        }))
    };
    for (said, words) in [
        (refused(b""), ["no binary glTF", "mouthpiece head fit"]),
        (
            refused(b"solid scan\nendsolid"),
            ["no binary glTF", "saved as glTF binary"],
        ),
        (
            refused(&bytes[..16]),
            ["ends in the middle", "copy it again"],
        ),
        (
            refused(&bytes[..bytes.len() / 2]),
            ["ends in the middle", "copy it again"],
        ),
        (
            replaced("\"mouthpiece\":", "\"other\":"),
            ["but no head", "mouthpiece head fit"],
        ),
        (
            replaced("\"schema\":1", "\"schema\":7"),
            ["schema 7", "reads 1"],
        ),
        (
            replaced("\"_SIM\"", "\"_MIS\""),
            ["_SIM: it is missing", "custom attributes"],
        ),
        (
            replaced("\"name\":\"tongue\"", "\"name\":\"lingua\""),
            ["part `tongue`", "missing"],
        ),
        (
            replaced("\"bite\":", "\"byte\":"),
            ["extras", "unknown field `byte`"],
        ),
        (
            replaced("\"radius\":", "\"radius\":-"),
            ["left eye", "radius"],
        ),
        (
            replaced("\"shares\":[0.25,", "\"shares\":[0.75,"),
            ["landmark `prn`", "no triangle"],
        ),
        (
            replaced("\"shares\":[0.2,", "\"shares\":[2.2,"),
            ["muscle Risorius", "a point of its grid"],
        ),
        (
            replaced("\"name\":\"skull\"", "\"name\":\"sku11\""),
            ["node `skull`", "muscles begin on it"],
        ),
        (
            replaced("\"lids\":[{\"hold\":1.0", "\"lids\":[{\"hold\":7.0"),
            ["lids[0]", "hold"],
        ),
        (replaced("\"VEC3\"", "\"VEC2\""), ["node `skin`", "VEC3"]),
    ] {
        for word in words {
            assert!(said.contains(word), "{said:?} does not say {word:?}");
        }
        assert!(!said.contains('\n') && said.len() < 400, "{said}");
    }
}

/// What is said of the reference head after `change`.
fn spoilt(change: impl FnOnce(&mut Head)) -> String {
    let mut head = reference().clone();
    change(&mut head);
    refused(&head.write())
}

#[test]
fn a_spring_without_length_is_refused() {
    let [a, b, _] = reference().skin.mesh.triangles[500];
    let said = spoilt(|head| {
        let positions = &mut head.skin.mesh.positions;
        positions[a as usize] = positions[b as usize];
    });
    assert!(said.contains("no length"), "{said}");
    // Other edges may end there too: one of the two vertices is named in any case.
    let named = |v: u32| {
        said.split(|c: char| !c.is_ascii_digit())
            .any(|w| w == v.to_string())
    };
    assert!(named(a) && named(b), "{a} {b}: {said}");
}

#[test]
fn a_vertex_that_nothing_holds_is_refused() {
    let alone = reference().lips.upper[3][0];
    let said = spoilt(|head| {
        // Only the mesh: a triangle less, or a few, is a hole that many a scan has.
        let skin = &mut head.skin;
        let keeps = |t: &[u32; 3]| !t.contains(&alone);
        let kept: Vec<bool> = skin.mesh.triangles.iter().map(keeps).collect();
        let mut next = kept.iter();
        skin.wedges.retain(|_| *next.next().unwrap());
        skin.mesh.triangles.retain(keeps);
    });
    assert!(said.contains(&format!("vertex {alone}:")), "{said}");
    assert!(said.contains("nothing holds it"), "{said}");
}

#[test]
fn a_muscle_outside_the_skin_is_refused() {
    let spoil = |depth: f32| {
        spoilt(|head| {
            let grid = &mut head.muscles[4];
            grid.muscle = Muscle::Buccinator;
            grid.fibres[1][2].depth = depth;
        })
    };
    for (depth, fault) in [(-0.4, "outside the skin"), (1.6, "in the bone")] {
        let said = spoil(depth);
        assert!(
            said.contains("muscle Buccinator, fibre 1, point 2"),
            "{said}"
        );
        assert!(said.contains(fault), "{said}");
    }
    // A scrap that floats before the cheek, as scans have them, and a muscle painted on it.
    let said = spoilt(|head| {
        let cheek = head.muscles[4].fibres[1][2].at.vertices;
        let skin = &mut head.skin;
        let first = skin.mesh.positions.len() as u32;
        for v in cheek.map(|v| v as usize) {
            let place = skin.mesh.positions[v] + Vec3::new(0.0, 0.0, 40.0);
            skin.mesh.positions.push(place);
            skin.mesh.normals.push(skin.mesh.normals[v]);
            skin.mesh.uvs.push(skin.mesh.uvs[v]);
            skin.mesh.occlusion.push(skin.mesh.occlusion[v]);
            skin.reference.push(skin.reference[v]);
            skin.weight.push(skin.weight[v]);
            skin.vermilion.push(skin.vermilion[v]);
            skin.wet.push(skin.wet[v]);
        }
        let scrap = [first, first + 1, first + 2];
        skin.mesh.triangles.push(scrap);
        skin.wedges.push(cheek.map(|v| skin.mesh.uvs[v as usize]));
        let grid = &mut head.muscles[4];
        grid.muscle = Muscle::Buccinator;
        grid.fibres[1][2].at.vertices = scrap;
    });
    assert!(
        said.contains("muscle Buccinator, fibre 1, point 2"),
        "{said}"
    );
    assert!(said.contains("outside the skin by"), "{said}");
}

#[test]
fn a_fibre_without_length_is_refused() {
    let said = spoilt(|head| {
        let grid = &mut head.muscles[4];
        grid.muscle = Muscle::Buccinator;
        grid.fibres[1][2] = grid.fibres[1][1];
    });
    assert!(said.contains("muscle Buccinator, fibre 1"), "{said}");
    assert!(said.contains("lie on one another"), "{said}");
}

#[test]
fn a_mass_that_cannot_be_is_refused() {
    for mass in ["0.0", "-1.0", "1e-3", "1e9", "1e39"] {
        let said = refused(&with_json(|json| {
            let from = "\"vertex_mass_g\":0.125";
            assert!(json.contains(from));
            json.replace(from, &format!("\"vertex_mass_g\":{mass}"))
        }));
        assert!(said.contains("tissue.vertex_mass_g"), "{mass}: {said}");
    }
}

#[test]
fn a_head_of_before_there_was_a_choice_of_tissue_is_read() {
    let bytes = with_json(|json| {
        let from = json.find(",\"tissue\":").unwrap();
        let to = from + json[from..].find('}').unwrap() + 1;
        format!("{}{}", &json[..from], &json[to..])
    });
    let head = Head::read(&bytes).unwrap();
    assert_eq!(head.tissue, TissueRecord::default());
    assert_eq!(head.tissue.model, TissueModel::Springs);
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let error = Head::load(Path::new("no/such/head.glb")).unwrap_err();
    assert!(matches!(error, HeadError::File { .. }));
    assert!(
        error.to_string().starts_with("no/such/head.glb: "),
        "{error}"
    );
}

#[test]
fn a_vertex_that_is_not_finite_is_refused() {
    let mut head = decorated();
    head.skin.mesh.positions[17] = Vec3::new(0.0, f32::NAN, 0.0);
    let said = refused(&head.write());
    assert!(said.contains("node `skin`, attribute POSITION"), "{said}");
}

#[test]
fn parts_have_names_of_their_own() {
    let head = Head::read(written()).unwrap();
    let names: HashSet<_> = head.parts.iter().map(|p| &p.name).collect();
    assert_eq!(names.len(), head.parts.len());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any bytes are a head or an error, never a panic: cut, overwritten, with numbers changed.
    #[test]
    fn damage_never_panics(
        cut in proptest::option::of(0.0..1.0_f64),
        changes in prop::collection::vec((0.0..1.0_f64, any::<u8>()), 0..12),
    ) {
        let mut bytes = written().to_vec();
        for (place, value) in changes {
            let place = (place * bytes.len() as f64) as usize;
            bytes[place] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate((cut * bytes.len() as f64) as usize);
        }
        if let Err(error) = Head::read(&bytes) {
            prop_assert!(!error.to_string().is_empty());
        }
    }

    /// The same where it hurts most: digits of the JSON.
    #[test]
    fn other_numbers_never_panic(changes in prop::collection::vec((0.0..1.0_f64, 0..10_u8), 1..20)) {
        let bytes = with_json(|json| {
            let mut json = json.as_bytes().to_vec();
            for (place, digit) in &changes {
                let from = (place * json.len() as f64) as usize;
                if let Some(at) = json[from..].iter().position(u8::is_ascii_digit) {
                    json[from + at] = b'0' + digit;
                }
            }
            String::from_utf8(json).unwrap()
        });
        let _ = Head::read(&bytes);
    }
}
