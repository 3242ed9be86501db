//! What is done to a head's hair before it is drawn: wide cards are split into narrow ones that do not end
//! together (those of short even hair stay), the cap fades where the skin's own painted roots begin, and short fine hairs grow across the
//! hairline. All from the head's own parts and features, so that fitted heads get it too.
//!
//! Hair that is not made of cards (see the head shop's `hair`) is left as it is.

mod fine;

use fine::{grow_fine, roots, single};
use glam::{Vec2, Vec3, vec2};
use mouthpiece_rig::{Head, Mesh, Part};

use crate::maps::hair::{COLUMNS, DENSE, EVEN, LOOSE};
use crate::maps::hairline::Hairline;
use crate::maps::noise::Dice;
use crate::maps::ramp;

/// Cards wider than this are split, mm.
const WIDE_MM: f32 = 7.0;
/// Into as many at most.
const SPLIT_MAX: usize = 2;
/// Where between crown and edge the cap begins to fade, and how far it has at the edge: 1 is to the roots of its strands.
const CAP_WHOLE: f32 = 0.8;
const CAP_FADE: f32 = 0.62;
/// Least light at the roots of cards, as a share of what the head says is missing there.
const LEAST_LIGHT: f32 = 0.55;
/// Light on the cap, and how much more of it by the head's own: it is seen between the cards.
const CAP_LIGHT: f32 = 0.30;
const CAP_UNEVEN: f32 = 0.62;
/// Which stretch of the strands' map the cap shows from the crown to its edge. Keep in step with shaders/hair.wgsl.
const CAP_ALONG: f32 = 0.42;
/// Shade that hair throws on the skin before it: how much, and where it begins and is deepest, mm within
/// the hairline. Farther in hair is painted on the skin, and dark.
const SHADE: f32 = 0.30;
const SHADE_MM: [f32; 2] = [-9.0, 2.0];
const PAINTED_MM: [f32; 2] = [3.0, 10.0];
/// A ribbon: pairs of vertices from root to tip.
#[derive(Clone, Debug)]
struct Card {
    /// Number of its first vertex and how many pairs it has.
    first: usize,
    pairs: usize,
}

/// The hair as it is drawn, `fine` with single hairs and all bends of the cards: where a pixel is one sample the ones are
/// too thin to be seen, and the others too slight.
pub(crate) fn dressed(head: &Head, part: &Part, fine: bool) -> Mesh {
    let mesh = &part.mesh;
    let cards = cards(mesh);
    if cards.is_empty() {
        return mesh.clone();
    }
    let mut out = Mesh::default();
    let hairline = Hairline::of(head);
    let mut dice = Dice::new(4711);
    // Outermost first, as the cards lie: what is hidden need not be shaded.
    if let Some(hairline) = hairline.as_ref().filter(|_| fine) {
        grow_fine(&mut out, head, hairline, &roots(mesh, &cards), &mut dice);
    }
    for card in &cards {
        if mesh.uvs[card.first].x * COLUMNS as f32 > (DENSE + LOOSE) as f32 {
            if fine {
                single(&mut out, mesh, card, &mut dice);
            }
        } else {
            split(&mut out, mesh, card, fine, &mut dice);
        }
    }
    keep_cap(&mut out, mesh);
    out
}

/// The cards, in the order of the mesh.
fn cards(mesh: &Mesh) -> Vec<Card> {
    let mut cards: Vec<Card> = Vec::new();
    let v = |i: usize| mesh.uvs[i].y;
    let mut i = 0;
    while i + 1 < mesh.uvs.len() {
        if v(i) != 0.0 || v(i + 1) != 0.0 {
            i += 1;
            continue;
        }
        let first = i;
        let mut pairs = 1;
        while first + 2 * pairs + 1 < mesh.uvs.len()
            && v(first + 2 * pairs) > v(first + 2 * pairs - 2)
            && v(first + 2 * pairs) == v(first + 2 * pairs + 1)
        {
            pairs += 1;
        }
        if pairs > 1 {
            cards.push(Card { first, pairs });
        }
        i = first + 2 * pairs;
    }
    cards
}

/// Adds a ribbon's next pair.
fn push_pair(
    out: &mut Mesh,
    left: Vec3,
    right: Vec3,
    normals: [Vec3; 2],
    uv: [Vec2; 2],
    light: f32,
) {
    out.positions.extend([left, right]);
    out.normals.extend(normals);
    out.uvs.extend(uv);
    out.occlusion.extend([light, light]);
}

/// Joins the pairs from vertex `first` on; counter-clockwise from outside.
fn join(out: &mut Mesh, first: usize) {
    let count = out.positions.len();
    for a in (first as u32..count as u32 - 2).step_by(2) {
        out.triangles.push([a, a + 2, a + 3]);
        out.triangles.push([a, a + 3, a + 1]);
    }
}

/// A card, or the narrow ones that stand for it: each shows its part of the column, strays a little and ends where
/// it likes.
fn split(out: &mut Mesh, mesh: &Mesh, card: &Card, fine: bool, dice: &mut Dice) {
    // Every other pair does where a pixel is one sample.
    let drawn = |i: usize| fine || i.is_multiple_of(2) || i + 1 == card.pairs;
    let pair = |i: usize| {
        let at = card.first + 2 * i;
        (mesh.positions[at], mesh.positions[at + 1])
    };
    let width = (0..card.pairs)
        .map(|i| pair(i).0.distance(pair(i).1))
        .fold(0.0, f32::max);
    let mut parts = ((width / WIDE_MM).ceil() as usize).clamp(1, SPLIT_MAX);
    // Even strands have no locks to tell apart.
    if (mesh.uvs[card.first].x * COLUMNS as f32) as usize == EVEN {
        parts = 1;
    }
    let share = 1.0 / parts as f32;
    for part in 0..parts {
        let first = out.positions.len();
        // What they show overlaps, and so do they.
        let wide = if parts > 1 { 0.72 * share } else { 0.5 };
        let middle = if parts > 1 {
            ((part as f32 + 0.5) * share + 0.10 * dice.spread()).clamp(wide, 1.0 - wide)
        } else {
            0.5
        };
        let stray = if parts > 1 { 0.32 * dice.spread() } else { 0.0 };
        let raised = if parts > 1 { 0.5 * dice.spread() } else { 0.0 };
        let longer = if parts > 1 {
            0.68 + 0.32 * dice.roll()
        } else {
            1.0
        };
        let shade = if parts > 1 {
            0.84 + 0.16 * dice.roll()
        } else {
            1.0
        };
        for i in (0..card.pairs).filter(|i| drawn(*i)) {
            let at = card.first + 2 * i;
            let v = mesh.uvs[at].y;
            // The same way, shorter or longer: a place between the card's own pairs, or past the last.
            let place = i as f32 * longer;
            let from = (place as usize).min(card.pairs - 2);
            let t = place - from as f32;
            let (a, b) = (pair(from), pair(from + 1));
            let (left, right) = (a.0.lerp(b.0, t), a.1.lerp(b.1, t));
            let n = card.first + 2 * from;
            let normal =
                |side: usize| mesh.normals[n + side].lerp(mesh.normals[n + 2 + side], t.min(1.0));
            let (nl, nr) = (normal(0), normal(1));
            let across = |s: f32| left.lerp(right, s + stray * v * v);
            let lift = (nl + nr).normalize_or(Vec3::Y) * (raised * v);
            let turned = |s: f32| nl.lerp(nr, s).normalize_or(nl);
            let u = |s: f32| mesh.uvs[at].x + (mesh.uvs[at + 1].x - mesh.uvs[at].x) * s;
            let (low, high) = (middle - wide, middle + wide);
            // Rounded like a lock of its own.
            let round = (right - left).normalize_or_zero() * if parts > 1 { 0.25 } else { 0.0 };
            push_pair(
                out,
                across(low) + lift,
                across(high) + lift,
                [
                    (turned(low) - round).normalize_or(nl),
                    (turned(high) + round).normalize_or(nr),
                ],
                [vec2(u(low), v), vec2(u(high), v)],
                lightened(mesh.occlusion[at]) * shade,
            );
        }
        join(out, first);
    }
}

/// Light scatters on between strands: what lies deep is not black.
fn lightened(occlusion: f32) -> f32 {
    occlusion + (1.0 - occlusion) * LEAST_LIGHT
}

/// The occlusion of each skin vertex, with what the hair before it takes away.
pub(crate) fn shaded_skin(head: &Head) -> Vec<f32> {
    let mesh = &head.skin.mesh;
    let Some(hairline) = Hairline::shown(head) else {
        return mesh.occlusion.clone();
    };
    let shade = |uv: &Vec2| {
        let depth = hairline.depth_mm(*uv);
        SHADE * ramp(SHADE_MM[0], SHADE_MM[1], depth) * ramp(PAINTED_MM[1], PAINTED_MM[0], depth)
    };
    mesh.occlusion
        .iter()
        .zip(&mesh.uvs)
        .map(|(light, uv)| light * (1.0 - shade(uv)))
        .collect()
}

/// The cap, with roots to show and fading towards the hairline: there the skin shows painted ones.
fn keep_cap(out: &mut Mesh, mesh: &Mesh) {
    let mut place = vec![u32::MAX; mesh.positions.len()];
    for (i, p) in mesh.positions.iter().enumerate() {
        if mesh.uvs[i].y >= -0.5 {
            continue;
        }
        place[i] = out.positions.len() as u32;
        let down = (-1.0 - mesh.uvs[i].y).clamp(0.0, 1.0);
        let faded = CAP_FADE * ((down - CAP_WHOLE) / (1.0 - CAP_WHOLE)).max(0.0).powi(2);
        out.positions.push(*p);
        out.normals.push(mesh.normals[i]);
        out.uvs.push(vec2(
            mesh.uvs[i].x,
            -1.0 - CAP_ALONG * (down / CAP_WHOLE).min(1.0) - faded,
        ));
        out.occlusion
            .push(CAP_LIGHT + CAP_UNEVEN * mesh.occlusion[i]);
    }
    let kept = mesh.triangles.iter().map(|t| t.map(|i| place[i as usize]));
    out.triangles
        .extend(kept.filter(|t| t.iter().all(|&i| i != u32::MAX)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;
    use mouthpiece_rig::Material;

    fn hair(head: &Head) -> &Part {
        let mut parts = head.parts.iter();
        parts.find(|p| p.material == Material::Hair).unwrap()
    }

    #[test]
    fn wide_cards_are_split_and_fine_hair_grows_at_the_hairline() {
        let head = Head::reference().unwrap();
        let part = hair(&head);
        let mesh = dressed(&head, part, true);
        let count = mesh.positions.len();
        assert!(mesh.triangles.len() > part.mesh.triangles.len());
        // What a picture may cost: see the bench.
        assert!(count < 2 * part.mesh.positions.len(), "{count} vertices");
        assert_eq!(
            [count; 3],
            [mesh.normals.len(), mesh.uvs.len(), mesh.occlusion.len()]
        );
        assert!(
            mesh.triangles
                .iter()
                .flatten()
                .all(|&i| (i as usize) < count)
        );
        assert!(
            mesh.positions
                .iter()
                .chain(&mesh.normals)
                .all(|p| p.is_finite())
        );
        let widest = |m: &Mesh| {
            let cards = cards(m);
            let wide = cards
                .iter()
                .filter(|c| (m.uvs[c.first].x * COLUMNS as f32) as usize != EVEN)
                .map(|c| m.positions[c.first + 2].distance(m.positions[c.first + 3]));
            wide.fold(0.0, f32::max)
        };
        assert!(widest(&mesh) < 0.75 * widest(&part.mesh));
        // Single hairs before the hairline: none in the head's own mesh.
        let fine = mesh.uvs.iter().filter(|uv| uv.x > 1.5).count();
        assert!(fine > 1000, "{fine} vertices of single hairs");
        let coarse = dressed(&head, part, false);
        assert!(coarse.uvs.iter().all(|uv| uv.x < 1.5));
    }

    #[test]
    fn hair_that_is_no_cards_is_left_alone() {
        let head = Head::reference().unwrap();
        let mut part = hair(&head).clone();
        part.mesh = Mesh {
            positions: vec![Vec3::ZERO, vec3(9.0, 0.0, 0.0), vec3(0.0, 9.0, 0.0)],
            normals: vec![Vec3::Z; 3],
            uvs: vec![vec2(0.2, 0.3), vec2(0.4, 0.0), vec2(0.1, 0.7)],
            occlusion: vec![1.0; 3],
            triangles: vec![[0, 1, 2]],
        };
        assert_eq!(dressed(&head, &part, true).triangles, part.mesh.triangles);
    }

    #[test]
    fn hair_shades_the_skin_at_the_hairline_and_nowhere_else() {
        let mut head = Head::reference().unwrap();
        let shaded = shaded_skin(&head);
        let own = &head.skin.mesh.occlusion;
        let darker = |i: &usize| shaded[*i] < own[*i] - 1e-4;
        let count = (0..own.len()).filter(darker).count();
        assert!(count > 50 && count < own.len() / 4, "{count} vertices");
        head.parts.retain(|p| p.material != Material::Hair);
        assert_eq!(shaded_skin(&head), head.skin.mesh.occlusion);
    }
}
