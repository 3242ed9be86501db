//! The skin as it is drawn: the limit surface of the head's control mesh (see `rig::Subdivision`) as
//! vertex and index buffers, and its points and normals of each frame. A tier may draw fewer of its triangles (`coarse`).

use glam::Vec3;
use mouthpiece_rig::{Detail, Head, Subdivision, SubdivisionError};

use crate::coarse;
use crate::folds::Folds;
use crate::gpu_data::{SkinMoving, SkinStill, unorm};
use crate::hairs;
use crate::maps;
use crate::maps::hairline::Hairline;
use crate::tier::Smoothness;

/// The skin's buffers. Vertices are the subdivision's, points, then copies where the chart is cut; or those of them that
/// coarse triangles use.
#[derive(Debug)]
pub(crate) struct SkinGeometry {
    surface: Subdivision,
    /// Filled anew each frame.
    pub(crate) moving: Vec<SkinMoving>,
    pub(crate) still: Vec<SkinStill>,
    pub(crate) indices: Vec<u32>,
    /// The triangles round the mouth, whose backs show through it.
    pub(crate) inside: Vec<u32>,
    /// The head's own triangles, which are fine enough to cast the skin's soft shadow.
    pub(crate) casting: Vec<u32>,
    control_count: usize,
    /// The point that each drawn vertex is at.
    sources: Vec<u32>,
    points: Vec<Vec3>,
    normals: Vec<Vec3>,
    folds: Folds,
}

impl SkinGeometry {
    pub(crate) fn of(head: &Head, smoothness: Smoothness) -> Result<Self, SubdivisionError> {
        let skin = &head.skin;
        let rest = &skin.mesh.positions;
        let hidden = under_hair(head);
        let surface = head.subdivision(&Detail {
            levels: smoothness.levels,
            bow_mm: smoothness.bow_mm,
            rest,
            hidden: &hidden,
        })?;
        let [weight, vermilion, wet, occlusion] = [
            &skin.weight,
            &skin.vermilion,
            &skin.wet,
            &hairs::shaded_skin(head),
        ]
        .map(|values| surface.spread(values));
        let marks = maps::landmarks::Landmarks::of(head);
        let zones = zones(&surface, rest, &marks);
        let points = surface.point_count();
        let mut sources: Vec<u32> = (0..points as u32)
            .chain(surface.copies().iter().copied())
            .collect();
        let mut still: Vec<SkinStill> = sources
            .iter()
            .zip(surface.uvs())
            .map(|(&point, uv)| {
                let i = point as usize;
                SkinStill {
                    uv: uv.to_array(),
                    shares: [
                        unorm(weight[i]),
                        unorm(vermilion[i]),
                        unorm(wet[i]),
                        unorm(occlusion[i]),
                    ],
                    grain: maps::grain::place(*uv, &marks).to_array(),
                    zones: zones[i],
                }
            })
            .collect();
        let (triangles, inside, casting) = if smoothness.coarse {
            let mut triangles = coarse::triangles(head, &surface, &sources, &still, &marks);
            (sources, still) = coarse::used(&mut triangles, &sources, &still);
            let place = |i: u32| rest.get(sources[i as usize] as usize).copied();
            let inside = inside(&triangles, &marks, place);
            (triangles.clone(), inside, triangles)
        } else {
            // Control triangles do: what is dark and far back needs no finer ones.
            let control = &skin.mesh.triangles;
            let inside = inside(control, &marks, |i| rest.get(i as usize).copied());
            let triangles = surface.triangles().to_vec();
            (triangles, inside, casting(control, &hidden))
        };
        let mut geometry = Self {
            moving: vec![SkinMoving::default(); sources.len()],
            still,
            indices: triangles.into_flattened(),
            inside: inside.into_flattened(),
            casting: casting.into_flattened(),
            control_count: rest.len(),
            sources,
            points: vec![Vec3::ZERO; points],
            normals: vec![Vec3::ZERO; points],
            folds: Folds::of(points, surface.triangles(), surface.copies()),
            surface,
        };
        geometry.set(rest);
        geometry.folds.rest(&geometry.points, &geometry.normals);
        geometry.set(rest);
        Ok(geometry)
    }

    /// How many vertices the head's skin has.
    pub(crate) fn vertex_count(&self) -> usize {
        self.control_count
    }

    /// The drawn points: those of the head's own vertices come first, in their order.
    pub(crate) fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Their normals, of unit length.
    pub(crate) fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Takes over the positions of the head's vertices. Allocates nothing.
    pub(crate) fn set(&mut self, positions: &[Vec3]) {
        debug_assert_eq!(positions.len(), self.control_count);
        self.surface.apply(positions, &mut self.points);
        self.surface.normals(&self.points, &mut self.normals);
        for normal in &mut self.normals {
            *normal = normal.normalize_or(Vec3::Z);
        }
        self.folds.measure(&self.points, &self.normals);
        for (out, &source) in self.moving.iter_mut().zip(&self.sources) {
            let i = source as usize;
            let (light, convex) = self.folds.at(i);
            *out = SkinMoving {
                position: self.points[i].to_array(),
                normal: self.normals[i].to_array(),
                bend: [unorm(light), unorm(convex), 0, 0],
            };
        }
    }
}

/// The drawn points' shares of the zones of wrinkles.
fn zones(
    surface: &Subdivision,
    rest: &[Vec3],
    marks: &maps::landmarks::Landmarks,
) -> Vec<[[u8; 4]; 2]> {
    let mut points = vec![Vec3::ZERO; surface.point_count()];
    surface.apply(rest, &mut points);
    points
        .iter()
        .map(|p| maps::zones::zones_at(*p, marks).map(|zones| zones.map(unorm)))
        .collect()
}

/// Millimetres within the hairline at which skin is never seen.
const COVERED_MM: f32 = 15.0;

/// Where the skin's back can show through the mouth: the cheeks on both sides of it. Distance from the
/// middle of the mouth, mm: least across, most up and down, most behind.
const CHEEK_ACROSS_MM: f32 = 24.0;
const CHEEK_HEIGHT_MM: f32 = 34.0;
const CHEEK_DEPTH_MM: f32 = 75.0;

/// Those triangles whose corners all lie there.
fn inside(
    triangles: &[[u32; 3]],
    marks: &maps::landmarks::Landmarks,
    place: impl Fn(u32) -> Option<Vec3>,
) -> Vec<[u32; 3]> {
    let near = |&i: &u32| {
        place(i).map(|p| p - marks.mouth).is_some_and(|to| {
            to.x.abs() > CHEEK_ACROSS_MM && to.y.abs() < CHEEK_HEIGHT_MM && -to.z < CHEEK_DEPTH_MM
        })
    };
    let all = triangles.iter().filter(|t| t.iter().all(near));
    all.copied().collect()
}

/// All but what is covered by hair, as it is drawn.
fn casting(triangles: &[[u32; 3]], hidden: &[bool]) -> Vec<[u32; 3]> {
    let seen = |t: &&[u32; 3]| !t.iter().all(|&i| hidden[i as usize]);
    triangles.iter().filter(seen).copied().collect()
}

/// Which skin vertices lie deep under hair: triangles of them need not be drawn.
fn under_hair(head: &Head) -> Vec<bool> {
    let hairline = Hairline::shown(head);
    let depth = |uv: &glam::Vec2| hairline.as_ref().map_or(0.0, |h| h.depth_mm(*uv));
    head.skin
        .mesh
        .uvs
        .iter()
        .map(|uv| depth(uv) > COVERED_MM)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, vec2, vec3};

    /// A strip round the bald back of the head, from u 0.9 over the seam to 0.1.
    fn strip() -> Head {
        let mut head = Head::reference().unwrap();
        head.parts.clear();
        let us = [0.9_f32, 0.97, 1.04, 1.1];
        let place = |u: f32, y: f32| {
            let turn = (u - 0.5) * std::f32::consts::TAU;
            vec3(turn.sin(), y, turn.cos()) * 90.0
        };
        let skin = &mut head.skin;
        let chart = |i: u32| {
            vec2(
                us[i as usize / 2],
                if i.is_multiple_of(2) { 0.5 } else { 0.4 },
            )
        };
        skin.mesh.positions = us
            .iter()
            .flat_map(|&u| [place(u, 0.0), place(u, 0.2)])
            .collect();
        let n = skin.mesh.positions.len();
        skin.mesh.uvs = (0..n as u32)
            .map(|i| vec2(chart(i).x.fract(), chart(i).y))
            .collect();
        skin.mesh.normals = vec![Vec3::Z; n];
        skin.mesh.occlusion = vec![1.0; n];
        (skin.weight, skin.vermilion, skin.wet) = (vec![1.0; n], vec![0.0; n], vec![0.0; n]);
        skin.mesh.triangles = (0..3)
            .flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]])
            .collect();
        // The last quad's chart begins anew: its first two vertices are cut in two.
        let anew = |k: usize| if k < 4 { Vec2::ZERO } else { Vec2::X };
        skin.wedges = (0..6)
            .zip(&skin.mesh.triangles)
            .map(|(k, t)| t.map(|i| chart(i) - anew(k)))
            .collect();
        (skin.creases, head.lips) = (Vec::new(), mouthpiece_rig::Lips::default());
        head
    }

    #[test]
    fn no_drawn_triangle_runs_the_wrong_way_round_the_chart() {
        for levels in 0..3_usize {
            let smoothness = Smoothness {
                levels,
                bow_mm: 0.0,
                coarse: false,
            };
            let geometry = SkinGeometry::of(&strip(), smoothness).unwrap();
            for t in geometry.indices.chunks_exact(3) {
                let u: Vec<f32> = t
                    .iter()
                    .map(|&i| geometry.still[i as usize].uv[0])
                    .collect();
                let span = u.iter().cloned().fold(f32::MIN, f32::max)
                    - u.iter().cloned().fold(f32::MAX, f32::min);
                assert!(span < 0.5, "a triangle spans {span} of the chart");
            }
            let copies = geometry.surface.copies();
            assert_eq!(copies.len(), (1 << levels) + 1, "the cut's vertices");
            for (k, &source) in copies.iter().enumerate() {
                let copy = geometry.moving[geometry.points.len() + k];
                assert_eq!(copy, geometry.moving[source as usize]);
            }
        }
    }

    #[test]
    fn coarse_skin_has_fewer_triangles_of_the_same_places() {
        let head = Head::reference().unwrap();
        let of = |coarse| {
            let smoothness = Smoothness {
                levels: 0,
                bow_mm: 0.0,
                coarse,
            };
            SkinGeometry::of(&head, smoothness).unwrap()
        };
        let (all, some) = (of(false), of(true));
        let (before, after) = (all.indices.len(), some.indices.len());
        assert!(
            after * 10 < before * 7 && after * 4 > before,
            "{after} of {before}"
        );
        assert_eq!(some.moving.len(), some.still.len());
        let lists = [&some.indices, &some.casting, &some.inside];
        let all_of = lists.into_iter().flatten();
        assert!(
            all_of
                .into_iter()
                .all(|&i| (i as usize) < some.moving.len())
        );
        assert!(!some.inside.is_empty());
        for (drawn, &source) in some.moving.iter().zip(&some.sources) {
            assert_eq!(*drawn, all.moving[source as usize]);
        }
    }

    #[test]
    fn the_skin_is_refined_where_it_bows_and_not_under_hair() {
        let head = Head::reference().unwrap();
        let drawn = |bow_mm| {
            let smoothness = Smoothness {
                levels: 1,
                bow_mm,
                coarse: false,
            };
            SkinGeometry::of(&head, smoothness).unwrap().indices.len() / 3
        };
        let control = head.skin.mesh.triangles.len();
        assert!(drawn(0.0) < 4 * control, "hair covers some");
        assert!(drawn(0.1) < drawn(0.0));
        assert!(drawn(0.1) > drawn(1000.0));
    }
}
