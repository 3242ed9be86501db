//! What each muscle does, as an anatomy text has it: a table for tests of either tissue.

use glam::{Vec3, vec3};
use mouthpiece_rig::{Head, Muscle};

/// The skin vertex that faces forwards or outwards and lies nearest to a place on the reference head.
pub(crate) fn vertex(head: &Head, place: Vec3) -> usize {
    let skin = &head.skin;
    let outer = |i: &usize| {
        skin.wet[*i] == 0.0 && skin.mesh.normals[*i].dot(place - vec3(0.0, place.y, 0.0)) > 0.0
    };
    (0..skin.reference.len())
        .filter(outer)
        .min_by(|a, b| {
            skin.reference[*a]
                .distance(place)
                .total_cmp(&skin.reference[*b].distance(place))
        })
        .unwrap_or(0)
}

/// A muscle, what it moves (a place on the reference head, mm), which way, and by how much at least, mm.
pub(crate) type Deed = (Muscle, &'static str, [f32; 3], [f32; 3], f32);

/// Of the left side; the right one mirrors it.
pub(crate) const DEEDS: [Deed; 31] = [
    (
        Muscle::OrbicularisOrisSuperior,
        "corner of the mouth",
        [27.4, -35.3, 101.9],
        [-1.0, 0.0, 0.0],
        2.0,
    ),
    (
        Muscle::OrbicularisOrisInferior,
        "corner of the mouth",
        [27.4, -35.3, 101.9],
        [-1.0, 0.0, 0.0],
        2.0,
    ),
    (
        Muscle::LevatorLabiiSuperioris,
        "cupid's bow",
        [7.3, -24.2, 117.3],
        [0.0, 1.0, 0.0],
        3.0,
    ),
    (
        Muscle::LevatorLabiiSuperiorisAlaequeNasi,
        "wing of the nose",
        [17.7, -6.0, 109.8],
        [0.0, 1.0, 0.0],
        1.0,
    ),
    (
        Muscle::LevatorLabiiSuperiorisAlaequeNasi,
        "upper lip",
        [12.8, -24.0, 114.0],
        [0.0, 1.0, 0.0],
        1.5,
    ),
    (
        Muscle::LevatorAnguliOris,
        "corner of the mouth",
        [27.4, -35.3, 101.9],
        [0.0, 1.0, 0.0],
        3.0,
    ),
    (
        Muscle::ZygomaticusMajor,
        "corner of the mouth",
        [27.4, -35.3, 101.9],
        [0.6, 0.75, -0.25],
        4.0,
    ),
    (
        Muscle::ZygomaticusMinor,
        "upper lip",
        [18.0, -27.0, 111.0],
        [0.5, 0.85, 0.0],
        2.5,
    ),
    (
        Muscle::Risorius,
        "corner of the mouth",
        [27.4, -35.3, 101.9],
        [1.0, 0.0, 0.0],
        3.0,
    ),
    (
        Muscle::Buccinator,
        "corner of the mouth",
        [27.4, -35.3, 101.9],
        [0.8, 0.0, -0.6],
        2.0,
    ),
    (
        Muscle::DepressorAnguliOris,
        "corner of the mouth",
        [27.4, -35.3, 101.9],
        [0.0, -1.0, 0.0],
        3.0,
    ),
    (
        Muscle::DepressorLabiiInferioris,
        "lower lip",
        [8.0, -43.0, 114.5],
        [0.0, -1.0, 0.0],
        3.0,
    ),
    (
        Muscle::Mentalis,
        "chin",
        [7.0, -63.0, 110.0],
        [0.0, 1.0, 0.0],
        0.7,
    ),
    (
        Muscle::FrontalisInner,
        "head of the brow",
        [14.0, 56.0, 107.0],
        [0.0, 1.0, 0.0],
        4.0,
    ),
    (
        Muscle::FrontalisOuter,
        "tail of the brow",
        [46.0, 57.0, 93.0],
        [0.0, 1.0, 0.0],
        4.0,
    ),
    (
        Muscle::CorrugatorSupercilii,
        "middle of the brow",
        [27.0, 57.0, 104.0],
        [-0.9, -0.4, 0.0],
        2.0,
    ),
    (
        Muscle::Procerus,
        "skin between the brows",
        [5.0, 58.0, 107.5],
        [0.0, -1.0, 0.0],
        2.5,
    ),
    (
        Muscle::DepressorSupercilii,
        "head of the brow",
        [14.0, 58.0, 107.0],
        [-0.2, -1.0, 0.0],
        1.8,
    ),
    (
        Muscle::OrbicularisOculiOrbital,
        "brow",
        [32.0, 57.0, 102.0],
        [0.0, -1.0, 0.0],
        1.5,
    ),
    (
        Muscle::OrbicularisOculiOrbital,
        "cheek under the eye",
        [36.0, 16.0, 94.0],
        [0.0, 1.0, 0.0],
        1.5,
    ),
    (
        Muscle::OrbicularisOculiOrbital,
        "temple beside the eye",
        [56.0, 36.0, 80.0],
        [-1.0, 0.0, 0.0],
        1.5,
    ),
    (
        Muscle::OrbicularisOculiPalpebral,
        "margin of the upper lid",
        [32.0, 41.0, 96.5],
        [0.0, -1.0, 0.0],
        5.0,
    ),
    (
        Muscle::OrbicularisOculiPalpebral,
        "margin of the lower lid",
        [32.0, 29.5, 95.0],
        [0.0, 1.0, 0.0],
        0.5,
    ),
    (
        Muscle::Nasalis,
        "wing of the nose",
        [17.0, 0.0, 110.0],
        [-1.0, 0.3, 0.0],
        0.5,
    ),
    (
        Muscle::DilatorNaris,
        "wing of the nose",
        [17.5, -4.0, 110.0],
        [1.0, 0.0, 0.0],
        0.25,
    ),
    (
        Muscle::DepressorSeptiNasi,
        "septum of the nose",
        [1.0, -7.3, 124.0],
        [0.0, -1.0, 0.0],
        0.6,
    ),
    (
        Muscle::Platysma,
        "skin under the corner of the mouth",
        [31.0, -47.0, 95.0],
        [0.2, -1.0, 0.0],
        1.0,
    ),
    (
        Muscle::Platysma,
        "skin of the jaw",
        [42.0, -50.0, 80.0],
        [0.0, -1.0, 0.0],
        2.0,
    ),
    (
        Muscle::Masseter,
        "side of the jaw",
        [63.0, -22.0, 52.0],
        [1.0, 0.0, 0.4],
        1.2,
    ),
    (
        Muscle::Temporalis,
        "temple",
        [66.0, 52.0, 58.0],
        [1.0, 0.0, 0.4],
        0.8,
    ),
    (
        Muscle::Temporalis,
        "temple, lower",
        [68.0, 40.0, 52.0],
        [1.0, 0.0, 0.4],
        0.4,
    ),
];
