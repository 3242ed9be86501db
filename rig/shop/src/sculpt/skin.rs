//! The reference skin: the half template with its openings, mirrored, evened out on the mean head (HEADSHOP 3).

use glam::{Vec2, Vec3, vec2};
use mouthpiece_rig::lip_level::CONTACT;
use mouthpiece_rig::{LIP_LEVELS, Lid, Lips, Mesh, Skin, normals};

use super::eyes::Eyes;
use super::half::Half;
use super::mouth::Rows;
use super::target::{BACK, Target, uv_of};
use super::{SculptError, chart, crown, ear, mouth, relax, shapes, sockets};

/// Middle of the left ear on its island and of the island on the texture, and the size of a millimetre on it.
const ISLAND_FROM: Vec2 = vec2(6.5, 7.5);
const ISLAND_AT: Vec2 = vec2(0.945, 0.127);
const ISLAND_MM: Vec2 = vec2(0.68 / 597.0, 0.68 / 256.0);
/// Vertices nearer to the mid plane than this lie on it, mm.
const SEAM_MM: f32 = 0.01;

/// The skin, the lips' columns in it, and the vertices that the lids carry.
pub(super) fn build(target: &Target, eyes: &Eyes) -> Result<(Skin, Lips, Vec<Lid>), SculptError> {
    let mut half = Half::default();
    let mouth = mouth::build(&mut half, target);
    let eye = sockets::eye(&mut half, target, eyes);
    let nostril = sockets::nostril(&mut half, target);
    let ear = ear::build(&mut half, target)?;
    let holes = vec![eye.outline.clone(), nostril, ear];
    let border = chart::build(&mut half, target, &mouth.outline, holes)?;
    crown::build(&mut half, target, &border)?;
    relax::relax(&mut half, target);
    debug_assert!(half.all_used(), "a feature line runs through an opening");
    Ok(mirror(
        &half,
        &mouth.upper,
        &mouth.lower,
        eyes,
        &eye.margins,
    ))
}

/// Both halves, and what refers to vertices by number.
fn mirror(
    half: &Half,
    upper: &Rows,
    lower: &Rows,
    eyes: &Eyes,
    margins: &[Vec<usize>; 2],
) -> (Skin, Lips, Vec<Lid>) {
    let mut vertices = half.vertices.clone();
    for v in &mut vertices {
        if v.position.x.abs() < SEAM_MM {
            v.position.x = 0.0;
            v.chart.x = if v.chart.x > 0.5 * BACK { BACK } else { 0.0 };
        }
    }
    let count = vertices.len();
    let mirror: Vec<usize> = (0..count)
        .map(|i| {
            let mut v = vertices[i];
            if v.position.x == 0.0 {
                return i;
            }
            v.position.x = -v.position.x;
            v.chart.x = -v.chart.x;
            vertices.push(v);
            vertices.len() - 1
        })
        .collect();
    let number = |t: [usize; 3]| t.map(|i| i as u32);
    let turned = |[a, b, c]: [usize; 3]| [mirror[a], mirror[c], mirror[b]];
    let mut triangles: Vec<[u32; 3]> = half.triangles.iter().map(|t| number(*t)).collect();
    triangles.extend(half.triangles.iter().map(|t| number(turned(*t))));
    let uvs: Vec<Vec2> = vertices.iter().map(|v| uv_of(v.chart)).collect();
    let left_wedges = half.triangles.iter().zip(&half.of_ear).map(|(t, &of_ear)| {
        t.map(|i| {
            if of_ear {
                island(half.vertices[i].island)
            } else {
                uvs[i]
            }
        })
    });
    let right_wedges = half.triangles.iter().zip(&half.of_ear).map(|(t, &of_ear)| {
        let other = |uv: Vec2| vec2(1.0 - uv.x, uv.y);
        let [a, b, c] = t.map(|i| match of_ear {
            true => other(island(half.vertices[i].island)),
            false => uvs[mirror[i]],
        });
        across_seam([a, c, b])
    });
    let wedges = left_wedges.chain(right_wedges).collect();
    let columns = |rows: &Rows| -> Vec<[u32; LIP_LEVELS]> {
        let right = rows
            .iter()
            .skip(1)
            .rev()
            .map(|r| r.map(|i| mirror[i] as u32));
        right
            .chain(rows.iter().map(|r| r.map(|i| i as u32)))
            .collect()
    };
    let lips = Lips {
        upper: columns(upper),
        lower: columns(lower),
    };

    let mut positions: Vec<Vec3> = vertices.iter().map(|v| v.position).collect();
    let mut lids = eyes.lids(&positions[..count], &margins[0], &margins[1]);
    let right: Vec<Lid> = lids
        .iter()
        .map(|l| Lid {
            vertex: mirror[l.vertex as usize] as u32,
            left: false,
            ..*l
        })
        .collect();
    lids.extend(right);
    eyes.relax(&mut positions, &mut lids);
    let creases = half
        .creases
        .iter()
        .flat_map(|&[a, b]| [[a, b], [mirror[a], mirror[b]]]);
    let mut creases: Vec<[u32; 2]> = creases.map(|e| e.map(|i| i as u32)).collect();
    for e in &mut creases {
        e.sort_unstable();
    }
    creases.sort_unstable();
    creases.dedup();
    debug_assert!(
        lips.upper
            .iter()
            .all(|c| (c[CONTACT] as usize) < positions.len())
    );
    let skin = Skin {
        weight: positions
            .iter()
            .map(|p| shapes::ramp(-103.0, -74.0, p.y + 0.12 * (p.z - 60.0).min(0.0)))
            .collect(),
        vermilion: vertices.iter().map(|v| v.vermilion).collect(),
        wet: vertices.iter().map(|v| v.wet).collect(),
        wedges,
        creases,
        reference: positions.clone(),
        mesh: Mesh {
            normals: normals(&positions, &triangles),
            uvs,
            occlusion: vertices.iter().map(|v| v.lit).collect(),
            positions,
            triangles,
        },
    };
    (skin, lips, lids)
}

/// Texture coordinates of a place of the left ear.
fn island(place: Option<Vec2>) -> Vec2 {
    let d = (place.unwrap_or_default() - ISLAND_FROM) * ISLAND_MM;
    ISLAND_AT + d * vec2(1.0, -1.0)
}

/// A triangle's texture coordinates, past 1 where it crosses the chart's seam.
fn across_seam(uv: [Vec2; 3]) -> [Vec2; 3] {
    let high = uv[0].x.max(uv[1].x).max(uv[2].x);
    uv.map(|c| if high - c.x > 0.5 { c + Vec2::X } else { c })
}
