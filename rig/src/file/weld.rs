//! A node's mesh as it was before it was split: drawn vertices put together by `_SIM`.

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::accessor::{COUNT_MAX, Data};
use super::document::{Document, Node, Primitive};
use super::{ANEW, HeadError, KEEP};
use crate::{Mesh, normals};

/// Copies of one vertex that lie further apart were moved one without the other, mm.
const TORN_MM: f32 = 0.05;

/// A node's mesh, welded; numbers of drawn vertices count through all its primitives.
pub(super) struct Welded<'a> {
    source: Source<'a>,
    /// Which drawn vertex stands for each.
    drawn: Vec<usize>,
    /// The mesh; `uvs` are those of `drawn`.
    pub mesh: Mesh,
    /// Texture coordinates of each triangle's corners.
    pub wedges: Vec<[Vec2; 3]>,
}

/// Where a node's attributes come from.
pub(super) struct Source<'a> {
    pub data: &'a Data<'a>,
    pub name: &'a str,
    pub primitives: &'a [Primitive],
}

/// The node of that name with a mesh; failing that, one whose mesh has the name.
pub(super) fn node<'a>(
    document: &'a Document,
    name: &str,
) -> Result<(usize, &'a [Primitive]), HeadError> {
    let mesh = |node: &Node| document.meshes.get(node.mesh?);
    let nodes = || document.nodes.iter().enumerate();
    let by_name = nodes().find(|(_, n)| n.name.as_deref() == Some(name) && mesh(n).is_some());
    by_name
        .or_else(|| nodes().find(|(_, n)| mesh(n).is_some_and(|m| m.name.as_deref() == Some(name))))
        .and_then(|(i, n)| Some((i, &mesh(n)?.primitives[..])))
        .ok_or_else(|| {
            HeadError::element(
                format!("node `{name}`"),
                "it is missing or has no mesh",
                KEEP,
            )
        })
}

impl Source<'_> {
    fn fault(&self, fault: impl Into<String>, mend: &'static str) -> HeadError {
        HeadError::element(format!("node `{}`", self.name), fault, mend)
    }

    fn element(&self, attribute: &str) -> String {
        format!("node `{}`, attribute {attribute}", self.name)
    }

    /// The attribute of all primitives in one list; nothing where one of them lacks it.
    fn all<const N: usize>(&self, attribute: &str) -> Result<Option<Vec<[f32; N]>>, HeadError> {
        let element = self.element(attribute);
        let mut out = Vec::new();
        for primitive in self.primitives {
            let Some(&index) = primitive.attributes.as_ref().and_then(|a| a.get(attribute)) else {
                return Ok(None);
            };
            let values = self.data.vectors::<N>(index, &element)?;
            if self.count(primitive) != Some(values.len()) {
                let fault = "it has another length than POSITION";
                return Err(HeadError::element(element, fault, ANEW));
            }
            out.extend(values);
            // Many primitives may name the same few numbers.
            if out.len() > COUNT_MAX {
                return Err(self.fault(format!("it has more than {COUNT_MAX} vertices"), ANEW));
            }
        }
        Ok(Some(out))
    }

    /// As [`Self::all`], of an attribute that must be there.
    fn required<const N: usize>(&self, attribute: &str) -> Result<Vec<[f32; N]>, HeadError> {
        self.all(attribute)?
            .ok_or_else(|| HeadError::element(self.element(attribute), "it is missing", KEEP))
    }

    /// How many vertices a primitive says it has.
    fn count(&self, primitive: &Primitive) -> Option<usize> {
        let position = *primitive.attributes.as_ref()?.get("POSITION")?;
        self.data.document.accessors.get(position)?.count
    }

    /// All triangles, as drawn vertices.
    fn triangles(&self) -> Result<Vec<[usize; 3]>, HeadError> {
        let mut out = Vec::new();
        let mut first = 0;
        for primitive in self.primitives {
            let count = self.count(primitive).unwrap_or(0);
            if primitive.mode.is_some_and(|mode| mode != 4) {
                return Err(self.fault("it holds something else than triangles", ANEW));
            }
            let corners: Vec<u32> = match primitive.indices {
                Some(index) => self.data.indices(index, &self.element("indices"))?,
                None => (0..count as u32).collect(),
            };
            if corners.iter().any(|&c| c as usize >= count) {
                return Err(self.fault(format!("a triangle names a vertex beyond {count}"), ANEW));
            }
            let global = |c: u32| first + c as usize;
            out.extend(
                corners
                    .chunks_exact(3)
                    .map(|t| [global(t[0]), global(t[1]), global(t[2])]),
            );
            first += count;
            if out.len() > COUNT_MAX {
                return Err(self.fault(format!("it has more than {COUNT_MAX} triangles"), ANEW));
            }
        }
        Ok(out)
    }
}

impl<'a> Welded<'a> {
    /// Puts the mesh together; `frame` leads from its frame in metres to the head's in mm.
    pub(super) fn new(
        source: Source<'a>,
        frame: DAffine3,
        count: usize,
    ) -> Result<Self, HeadError> {
        let turn = frame.matrix3.inverse().transpose();
        if !frame.is_finite() || !turn.is_finite() {
            return Err(source.fault("its place in the scene has no size", ANEW));
        }
        let place = |p: [f32; 3]| frame.transform_point3(Vec3::from(p).as_dvec3()).as_vec3();
        let places: Vec<Vec3> = source
            .required("POSITION")?
            .into_iter()
            .map(place)
            .collect();
        let numbers = source.required::<1>("_SIM")?;
        let sim = welded_numbers(&source, &numbers, count)?;
        // Counted through all copies, so that no number in the file takes memory by itself.
        if count == 0 || count > places.len() {
            let fault = format!("{count} vertices are made of {} drawn ones", places.len());
            return Err(source.fault(fault, KEEP));
        }
        let mut drawn = vec![usize::MAX; count];
        for (i, &s) in sim.iter().enumerate() {
            if drawn[s] == usize::MAX {
                drawn[s] = i;
            } else if places[drawn[s]].distance(places[i]) > TORN_MM {
                let fault = format!("vertex {s} lies at two places");
                return Err(source.fault(fault, "close the seams of its texture coordinates"));
            }
        }
        if let Some(s) = drawn.iter().position(|&d| d == usize::MAX) {
            return Err(source.fault(format!("vertex {s} of {count} is missing"), KEEP));
        }
        let corners = source.triangles()?;
        let uvs = source.all::<2>("TEXCOORD_0")?;
        let uvs: Vec<Vec2> = uvs.map_or_else(
            || vec![Vec2::ZERO; places.len()],
            |all| all.into_iter().map(Vec2::from).collect(),
        );
        let mut mesh = Mesh::default();
        let mut wedges = Vec::with_capacity(corners.len());
        for t in corners {
            let [a, b, c] = t.map(|d| sim[d] as u32);
            // Some programs join strips by triangles without area.
            if a != b && b != c && c != a {
                mesh.triangles.push([a, b, c]);
                wedges.push(t.map(|d| uvs[d]));
            }
        }
        mesh.positions = drawn.iter().map(|&d| places[d]).collect();
        mesh.uvs = drawn.iter().map(|&d| uvs[d]).collect();
        mesh.normals = match source.all::<3>("NORMAL")? {
            Some(all) => {
                let unit = |d: &usize| {
                    let normal = turn * Vec3::from(all[*d]).as_dvec3();
                    normal.normalize_or(DVec3::Z).as_vec3()
                };
                drawn.iter().map(unit).collect()
            }
            None => normals(&mesh.positions, &mesh.triangles),
        };
        mesh.occlusion = match source.all::<1>("_OCCLUSION")? {
            Some(all) => drawn.iter().map(|&d| all[d][0]).collect(),
            None => vec![1.0; count],
        };
        Ok(Self {
            source,
            drawn,
            mesh,
            wedges,
        })
    }

    /// An attribute that must be there, per welded vertex.
    pub(super) fn required<const N: usize>(
        &self,
        attribute: &str,
    ) -> Result<Vec<[f32; N]>, HeadError> {
        let all = self.source.required(attribute)?;
        Ok(self.drawn.iter().map(|&d| all[d]).collect())
    }

    /// Single numbers, per welded vertex.
    pub(super) fn scalars(&self, attribute: &str) -> Result<Vec<f32>, HeadError> {
        let all = self.required::<1>(attribute)?;
        Ok(all.into_iter().map(|[x]| x).collect())
    }
}

/// `_SIM` as numbers below `count`.
fn welded_numbers(
    source: &Source<'_>,
    numbers: &[[f32; 1]],
    count: usize,
) -> Result<Vec<usize>, HeadError> {
    let number = |x: f32| {
        let near = x.round();
        // Room for what other programs' arithmetic does to a float.
        let whole = (x - near).abs() < 0.01 && near >= 0.0 && (near as usize) < count;
        whole.then_some(near as usize)
    };
    numbers
        .iter()
        .map(|&[x]| {
            number(x).ok_or_else(|| {
                let fault = format!("{x} is no number of one of its {count} vertices");
                HeadError::element(source.element("_SIM"), fault, ANEW)
            })
        })
        .collect()
}
