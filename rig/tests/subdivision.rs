//! What the drawn surface promises: one surface whatever the tier, closed lips that stay closed, sharp
//! lines where they belong, no cracks, no texture smeared from one island to another.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests")]

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::{Vec2, Vec3, vec2, vec3};
use mouthpiece_rig::{
    Detail, Head, Stencils, Subdivision, SubdivisionError, Topology, fit_control, limit_stencils,
};

const SIDE: u32 = 7;

/// A flat patch of equilateral triangles, SIDE vertices along each side: all inner ones have six
/// neighbours.
fn patch() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let at = |x: u32, y: u32| y * SIDE + x;
    let positions = (0..SIDE * SIDE)
        .map(|i| {
            let (x, y) = ((i % SIDE) as f32, (i / SIDE) as f32);
            vec3(x + 0.5 * y, y * 0.75_f32.sqrt(), 0.0)
        })
        .collect();
    let triangles = (0..SIDE - 1)
        .flat_map(|y| (0..SIDE - 1).map(move |x| (x, y)))
        .flat_map(|(x, y)| {
            let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1));
            [[a, b, c], [b, d, c]]
        })
        .collect();
    (positions, triangles)
}

fn topology(triangles: &[[u32; 3]]) -> Topology<'_> {
    Topology {
        vertex_count: (SIDE * SIDE) as usize,
        triangles,
        ..Topology::default()
    }
}

fn halved(levels: usize) -> Detail<'static> {
    Detail {
        levels,
        ..Detail::default()
    }
}

/// A row by index.
fn row(stencils: &Stencils, number: usize) -> HashMap<u32, f32> {
    stencils.row(number).collect()
}

fn close(a: &HashMap<u32, f32>, b: &HashMap<u32, f32>) -> bool {
    let inside = |a: &HashMap<u32, f32>, b: &HashMap<u32, f32>| {
        a.iter()
            .all(|(i, w)| (w - b.get(i).copied().unwrap_or(0.0)).abs() < 1e-6)
    };
    inside(a, b) && inside(b, a)
}

fn head() -> &'static Head {
    static HEAD: OnceLock<Head> = OnceLock::new();
    HEAD.get_or_init(|| Head::reference().unwrap())
}

/// The vertices of both contact lines: upper, lower.
fn contact_lines(head: &Head) -> [Vec<u32>; 2] {
    let on_crease = |v: &u32| head.skin.creases.iter().flatten().any(|c| c == v);
    [&head.lips.upper, &head.lips.lower].map(|columns| {
        let level = (0..columns[0].len())
            .find(|&level| on_crease(&columns[columns.len() / 2][level]))
            .expect("the contact line is a crease");
        columns.iter().map(|c| c[level]).collect()
    })
}

#[test]
fn a_regular_vertex_has_the_known_limit() {
    let (_, triangles) = patch();
    let limit = limit_stencils(&topology(&triangles)).unwrap();
    let middle = SIDE * SIDE / 2;
    let known = [(middle, 0.5)]
        .into_iter()
        .chain(
            [1, SIDE - 1, SIDE]
                .into_iter()
                .flat_map(|step| [middle + step, middle - step])
                .map(|v| (v, 1.0 / 12.0)),
        )
        .collect();
    let got = row(&limit, middle as usize);
    assert!(close(&got, &known), "{got:?}");
    // A point in the middle of an edge, from the box spline that Loop's surface is where it is regular.
    let drawn = Subdivision::new(&topology(&triangles), &halved(1)).unwrap();
    let edge = (0..drawn.point_count())
        .map(|p| row(drawn.stencils(), p))
        .find(|r| {
            let heavy = |v: u32| r.get(&v).is_some_and(|w| *w > 0.2);
            r.len() == 10 && heavy(middle) && heavy(middle + 1)
        })
        .expect("the edge right of the middle is split");
    let mut weights: Vec<f32> = edge.values().map(|w| w * 192.0).collect();
    weights.sort_by(f32::total_cmp);
    let known = [1.0, 1.0, 3.0, 3.0, 3.0, 3.0, 26.0, 26.0, 63.0, 63.0];
    for (got, known) in weights.iter().zip(known) {
        assert!((got - known).abs() < 1e-3, "{weights:?}");
    }
}

#[test]
fn weights_are_shares() {
    let drawn = head().subdivision(&halved(2)).unwrap();
    for point in 0..drawn.point_count() {
        let sum: f32 = drawn.stencils().row(point).map(|(_, w)| w).sum();
        assert!((sum - 1.0).abs() < 1e-5, "point {point}: {sum}");
        assert!(drawn.stencils().row(point).all(|(_, w)| w >= 0.0));
    }
}

#[test]
fn a_flat_even_patch_stays_as_it_is() {
    let (positions, triangles) = patch();
    let drawn = Subdivision::new(&topology(&triangles), &halved(2)).unwrap();
    let mut points = vec![Vec3::ZERO; drawn.point_count()];
    drawn.apply(&positions, &mut points);
    // But for the patch's own corners, which the border's curve rounds off.
    for y in 2..SIDE - 2 {
        for x in 2..SIDE - 2 {
            let v = (y * SIDE + x) as usize;
            assert!(points[v].distance(positions[v]) < 1e-5);
        }
    }
    let mut normals = points.clone();
    drawn.normals(&points, &mut normals);
    assert!(normals.iter().all(|n| n.normalize_or_zero().z > 0.999));
}

#[test]
fn all_tiers_draw_points_of_one_surface() {
    let limit = head().skin_limit().unwrap();
    let levels = [0, 1, 2].map(|levels| head().subdivision(&halved(levels)).unwrap());
    let rest = &head().skin.mesh.positions;
    let points = levels.each_ref().map(|drawn| {
        let mut points = vec![Vec3::ZERO; drawn.point_count()];
        drawn.apply(rest, &mut points);
        points
    });
    assert_eq!(points[0].len(), limit.len());
    for coarse in 0..2 {
        for (a, b) in points[coarse].iter().zip(&points[coarse + 1]) {
            assert!(
                a.distance(*b) < 1e-3,
                "{a} at level {coarse}, {b} a level finer"
            );
        }
    }
    // The surface is where a deep subdivision of the control mesh goes.
    for vertex in (0..limit.len()).step_by(50) {
        assert!(close(
            &row(&limit, vertex),
            &row(levels[2].stencils(), vertex)
        ));
    }
}

#[test]
fn a_crease_depends_on_itself_alone_and_a_meeting_of_three_stays() {
    let (_, triangles) = patch();
    let at = |x: u32, y: u32| y * SIDE + x;
    // Along a row of the grid, and from its third vertex one step aside.
    let mut creases: Vec<[u32; 2]> = (0..SIDE - 1).map(|x| [at(x, 3), at(x + 1, 3)]).collect();
    let mesh = Topology {
        creases: &creases,
        ..topology(&triangles)
    };
    let got = row(&limit_stencils(&mesh).unwrap(), at(3, 3) as usize);
    let spline = [
        (at(2, 3), 1.0 / 6.0),
        (at(3, 3), 2.0 / 3.0),
        (at(4, 3), 1.0 / 6.0),
    ];
    assert!(close(&got, &spline.into()), "{got:?}");

    creases.push([at(3, 3), at(3, 4)]);
    let mesh = Topology {
        creases: &creases,
        ..topology(&triangles)
    };
    let limit = limit_stencils(&mesh).unwrap();
    assert!(close(
        &row(&limit, at(3, 3) as usize),
        &[(at(3, 3), 1.0)].into()
    ));
    assert!(
        close(&row(&limit, at(3, 4) as usize), &[(at(3, 4), 1.0)].into()),
        "a crease ends in a corner"
    );
}

#[test]
fn the_border_is_drawn_from_the_border_alone() {
    let (positions, triangles) = patch();
    let drawn = Subdivision::new(&topology(&triangles), &halved(2)).unwrap();
    let edge = |v: u32| {
        [v % SIDE, v / SIDE]
            .iter()
            .any(|c| *c == 0 || *c == SIDE - 1)
    };
    let mut points = vec![Vec3::ZERO; drawn.point_count()];
    drawn.apply(&positions, &mut points);
    let on_border: Vec<usize> = border(&drawn).into_iter().flatten().collect();
    assert_eq!(on_border.len(), 2 * 4 * 4 * (SIDE as usize - 1));
    for point in on_border {
        assert!(drawn.stencils().row(point).all(|(v, _)| edge(v)));
    }
}

/// Edges of only one drawn triangle.
fn border(drawn: &Subdivision) -> Vec<[usize; 2]> {
    let points = drawn.point_count();
    let point = |v: u32| match (v as usize).checked_sub(points) {
        Some(copy) => drawn.copies()[copy] as usize,
        None => v as usize,
    };
    let mut uses: HashMap<[usize; 2], usize> = HashMap::new();
    for t in drawn.triangles() {
        for i in 0..3 {
            let (a, b) = (point(t[i]), point(t[(i + 1) % 3]));
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    uses.into_iter()
        .filter(|(_, uses)| *uses == 1)
        .map(|(edge, _)| edge)
        .collect()
}

#[test]
fn no_crack_opens_between_fine_and_coarse() {
    let skin = &head().skin.mesh;
    let rim: Vec<u32> = border(&head().subdivision(&halved(0)).unwrap())
        .into_iter()
        .flatten()
        .map(|v| v as u32)
        .collect();
    let some = head()
        .subdivision(&Detail {
            levels: 2,
            bow_mm: 0.15,
            rest: &skin.positions,
            hidden: &[],
        })
        .unwrap();
    let all = head().subdivision(&halved(2)).unwrap();
    assert!(some.triangles().len() > skin.triangles.len());
    assert!(some.triangles().len() * 2 < all.triangles().len());
    for [a, b] in border(&some) {
        for point in [a, b] {
            let mut of = some.stencils().row(point);
            assert!(
                of.all(|(v, _)| rim.contains(&v)),
                "point {point} lies on a crack"
            );
        }
    }
}

/// A cheap noise in -1..1, the same for the same numbers.
fn noise(seed: u32) -> Vec3 {
    let one = |salt: u32| {
        let mut h = seed.wrapping_mul(0x9E37_79B9) ^ salt.wrapping_mul(0x85EB_CA6B);
        h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
        (h >> 8) as f32 / (1 << 23) as f32 - 1.0
    };
    vec3(one(1), one(2), one(3))
}

/// Points that depend on one contact line alone.
fn drawn_line(drawn: &Subdivision, control: &[Vec3], line: &[u32]) -> Vec<[u32; 3]> {
    let mut points = vec![Vec3::ZERO; drawn.point_count()];
    drawn.apply(control, &mut points);
    let mut of: Vec<[u32; 3]> = (0..points.len())
        .filter(|&p| drawn.stencils().row(p).all(|(v, _)| line.contains(&v)))
        .map(|p| points[p].to_array().map(f32::to_bits))
        .collect();
    of.sort_unstable();
    of
}

#[test]
fn lips_closed_on_the_control_mesh_are_closed_as_drawn() {
    let lines = contact_lines(head());
    for round in 0..3 {
        let mut control = head().skin.mesh.positions.clone();
        for (v, p) in (0..).zip(&mut control) {
            *p += noise(v + 9000 * round) * round as f32;
        }
        for (upper, lower) in lines[0].iter().zip(&lines[1]) {
            control[*lower as usize] = control[*upper as usize];
        }
        for levels in 0..3 {
            let drawn = head().subdivision(&halved(levels)).unwrap();
            let [upper, lower] = lines
                .each_ref()
                .map(|line| drawn_line(&drawn, &control, line));
            assert_eq!(upper.len(), ((lines[0].len() - 1) << levels) + 1);
            assert!(upper == lower, "a gap to the bit at level {levels}");
        }
    }
}

#[test]
fn control_points_are_found_whose_surface_goes_through_the_targets() {
    let limit = head().skin_limit().unwrap();
    let mut drawn = vec![Vec3::ZERO; limit.len()];
    limit.apply(&head().skin.mesh.positions, &mut drawn);
    let targets = &drawn.clone();
    let control = fit_control(&limit, targets);
    limit.apply(&control, &mut drawn);
    let away = |drawn: &[Vec3]| {
        let mut away: Vec<f32> = drawn
            .iter()
            .zip(targets)
            .map(|(a, b)| a.distance(*b))
            .collect();
        away.sort_by(f32::total_cmp);
        [0.5, 0.95, 0.99].map(|share| away[(away.len() as f32 * share) as usize])
    };
    let [half, most, nearly_all] = away(&drawn);
    assert!(
        half < 0.02 && most < 0.12 && nearly_all < 0.25,
        "{half}, {most}, {nearly_all} mm"
    );
    limit.apply(targets, &mut drawn);
    assert!(away(&drawn)[1] > 0.2, "without it the surface shrinks");
    let lines = contact_lines(head());
    for (upper, lower) in lines[0].iter().zip(&lines[1]) {
        assert_eq!(control[*upper as usize], control[*lower as usize]);
    }
}

#[test]
fn no_drawn_triangle_mixes_islands_of_the_texture() {
    let (_, triangles) = patch();
    let place = |v: u32| vec2((v % SIDE) as f32, (v / SIDE) as f32) / SIDE as f32 * 0.4;
    // The upper half of the patch is an island of its own, far off.
    let upper = |t: &[u32; 3]| t.iter().all(|v| v / SIDE >= SIDE / 2);
    let wedges: Vec<[Vec2; 3]> = triangles
        .iter()
        .map(|t| {
            t.map(|v| {
                place(v)
                    + if upper(t) {
                        Vec2::splat(0.5)
                    } else {
                        Vec2::ZERO
                    }
            })
        })
        .collect();
    let mesh = Topology {
        wedges: &wedges,
        ..topology(&triangles)
    };
    let area = |of: &[[Vec2; 3]]| -> f32 {
        of.iter()
            .map(|[a, b, c]| 0.5 * (*b - *a).perp_dot(*c - *a))
            .sum()
    };
    for levels in 0..3 {
        let drawn = Subdivision::new(&mesh, &halved(levels)).unwrap();
        let seam = ((SIDE as usize - 1) << levels) + 1;
        assert_eq!(drawn.copies().len(), seam, "only the seam is split");
        let uvs: Vec<[Vec2; 3]> = drawn
            .triangles()
            .iter()
            .map(|t| t.map(|v| drawn.uvs()[v as usize]))
            .collect();
        for t in &uvs {
            assert!(t.iter().all(|uv| uv.x < 0.45) || t.iter().all(|uv| uv.x >= 0.45));
        }
        assert!((area(&uvs) - area(&wedges)).abs() < 1e-4);
    }
}

#[test]
fn values_spread_between_neighbours_wherever_edges_are_split() {
    let rest = &head().skin.mesh.positions;
    let detail = Detail {
        levels: 2,
        bow_mm: 0.1,
        rest,
        hidden: &[],
    };
    let drawn = head().subdivision(&detail).unwrap();
    let heights: Vec<f32> = rest.iter().map(|p| p.y).collect();
    let spread = drawn.spread(&heights);
    assert_eq!(spread.len(), drawn.point_count());
    assert_eq!(spread[..heights.len()], heights);
    let mut points = vec![Vec3::ZERO; drawn.point_count()];
    drawn.apply(rest, &mut points);
    for (height, point) in spread.iter().zip(&points) {
        assert!((height - point.y).abs() < 5.0, "{height} at {point}");
    }
}

#[test]
fn a_mesh_that_does_not_fit_together_is_refused() {
    let (_, triangles) = patch();
    let far = [[0, SIDE * SIDE]];
    let mesh = Topology {
        creases: &far,
        ..topology(&triangles)
    };
    assert!(matches!(
        Subdivision::new(&mesh, &halved(1)),
        Err(SubdivisionError::Vertex {
            vertex: 49,
            count: 49
        })
    ));
    let mesh = Topology {
        wedges: &[[Vec2::ZERO; 3]],
        ..topology(&triangles)
    };
    assert!(matches!(
        Subdivision::new(&mesh, &halved(1)),
        Err(SubdivisionError::Count { what: "wedges", .. })
    ));
    let nothing = Subdivision::new(&Topology::default(), &halved(2)).unwrap();
    assert_eq!(nothing.vertex_count(), 0);
}
