//! The head as data: skin mesh, rigid parts, the bodies they hang on, and where each body is for given controls.

use glam::{Affine3A, Quat, Vec2, Vec3, vec3};

use crate::muscle::Fibre;
use crate::{Control, Controls, KeyFrame};

/// A frame of reference that parts hang on; poses come from [`Head::bodies`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(usize)]
pub enum Body {
    /// Shoulders and the base of the neck: does not move.
    Trunk,
    /// Skull with the upper teeth: turns with the head.
    Skull,
    /// Lower jaw with the lower teeth: turns about the condyles, moves with the skull.
    Mandible,
    /// The subject's left eyeball.
    EyeL,
    /// The subject's right eyeball.
    EyeR,
    /// Back and body of the tongue.
    TongueBody,
    /// Blade and tip of the tongue.
    TongueTip,
}

impl Body {
    /// How many there are.
    pub const COUNT: usize = 7;
}

/// What a part is made of: the renderer picks a shader by it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Material {
    Skin,
    /// Sclera, iris and pupil in one ball; `uv` is the direction from its centre as (yaw, pitch) in
    /// units of the iris radius, so that the iris is the unit disc round (0, 0).
    Eye,
    Teeth,
    Gums,
    Tongue,
    /// Inside of the mouth behind lips and teeth.
    Cavity,
    Hair,
    /// Lashes and brows.
    Lash,
    Cloth,
}

/// A triangle mesh; all per-vertex arrays have the same length.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Rest positions in the head frame, mm.
    pub positions: Vec<Vec3>,
    /// Unit normals at rest.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, 0..1 from the upper left (eyes: see [`Material::Eye`]).
    pub uvs: Vec<Vec2>,
    /// Share of ambient light that reaches the vertex at rest, 0..1.
    pub occlusion: Vec<f32>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A mesh on one or two bodies.
#[derive(Clone, Debug)]
pub struct Part {
    /// Node name, as in a head file: `teeth_upper`, `eye_l`, `tongue` …
    pub name: &'static str,
    /// What it is made of.
    pub material: Material,
    /// Its shape.
    pub mesh: Mesh,
    /// The two bodies it hangs on.
    pub bodies: [Body; 2],
    /// Share of the second body, per vertex.
    pub weight: Vec<f32>,
}

/// The skin: the mesh that the simulation moves.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Shape at rest. `uv` is the cylindrical chart: `u = 0.5 + longitude / 2 pi` (0.5 straight
    /// ahead, growing to the subject's left), `v = (150 - y) / 256` with y in mm.
    pub mesh: Mesh,
    /// Share of the skull against the trunk, per vertex: 1 on the head, falling to 0 down the neck.
    pub weight: Vec<f32>,
    /// 1 on the red of the lips, 0 off it, per vertex.
    pub vermilion: Vec<f32>,
    /// 1 on the wet inner side of lips and lids, 0 on dry skin, per vertex.
    pub wet: Vec<f32>,
}

/// Levels of a lip's column, from the vermilion border over crest, brim and contact line to the
/// inner side: see [`Lips`].
pub const LIP_LEVELS: usize = 7;

/// The skin vertices of both lips as columns from the subject's right corner to the left one; column
/// `i` of the upper lip stands over column `i` of the lower. Level 0 is the vermilion border, 1 the
/// crest, 2 the brim, 3 the contact line, 4 to 6 the inner side. At the corners both share vertices.
#[derive(Clone, Debug, Default)]
pub struct Lips {
    /// Columns of the upper lip.
    pub upper: Vec<[u32; LIP_LEVELS]>,
    /// Columns of the lower lip.
    pub lower: Vec<[u32; LIP_LEVELS]>,
}

/// A skin vertex that an eyelid carries.
#[derive(Clone, Copy, Debug)]
pub struct Lid {
    /// Which.
    pub vertex: u32,
    /// Whether it is of the subject's left eye.
    pub left: bool,
    /// Rotation about the eye's transverse axis that closes it, radians.
    pub turn: f32,
    /// How firmly the lid holds it, 0..1.
    pub hold: f32,
}

/// The reference or any other head, at rest.
#[derive(Clone, Debug)]
pub struct Head {
    /// The skin.
    pub skin: Skin,
    /// Everything rigid: `eye_l`, `eye_r`, `teeth_upper`, `teeth_lower`, `gums_upper`,
    /// `gums_lower`, `tongue`, `cavity`, `hair`, `lashes_l`, `lashes_r`, `cloth`.
    pub parts: Vec<Part>,
    /// Lines on the skin that the colour map is painted by.
    pub features: Vec<Feature>,
    /// The lips' columns.
    pub lips: Lips,
    /// What the lids carry.
    pub lids: Vec<Lid>,
    /// Muscle fibres, left and right.
    pub fibres: Vec<Fibre>,
    /// A point of the axis through the condyles, mm: the axis runs along x.
    pub condyle_axis: Vec3,
    /// What the head turns about.
    pub neck_pivot: Vec3,
    /// Centre of the subject's left eyeball; the right one mirrors it.
    pub eye_centre: Vec3,
    /// Radius of the eyeballs, mm.
    pub eye_radius: f32,
    /// What the tongue's body turns about, and what its blade turns about.
    pub tongue_root: Vec3,
    /// See `tongue_root`.
    pub tongue_blade: Vec3,
}

/// A line on the skin, as points of its chart (`uv`).
#[derive(Clone, Debug)]
pub struct Feature {
    /// `brow_upper_l`, `brow_lower_l`, `hairline`, `lid_crease_l` … and `_r`.
    pub name: &'static str,
    /// Its points in order.
    pub points: Vec<Vec2>,
}

impl Head {
    /// Where each [`Body`] is for `controls`: maps points at rest to the trunk's frame, mm.
    #[must_use]
    pub fn bodies(&self, controls: &Controls) -> [Affine3A; Body::COUNT] {
        let skull = about(
            self.neck_pivot,
            Quat::from_rotation_y(controls[Control::HeadYaw])
                * Quat::from_rotation_x(-controls[Control::HeadPitch])
                * Quat::from_rotation_z(-controls[Control::HeadRoll]),
        );
        let mandible = skull * self.mandible(controls[Control::Jaw]);
        let gaze = Quat::from_rotation_y(controls[Control::GazeYaw])
            * Quat::from_rotation_x(-controls[Control::GazePitch]);
        let [tongue_body, tongue_tip] = self.tongue(controls);
        let mut bodies = [Affine3A::IDENTITY; Body::COUNT];
        bodies[Body::Skull as usize] = skull;
        bodies[Body::Mandible as usize] = mandible;
        bodies[Body::EyeL as usize] = skull * about(self.eye_centre, gaze);
        bodies[Body::EyeR as usize] = skull * about(self.eye_centre * vec3(-1.0, 1.0, 1.0), gaze);
        bodies[Body::TongueBody as usize] = mandible * tongue_body;
        bodies[Body::TongueTip as usize] = mandible * tongue_tip;
        bodies
    }

    /// The mandible in the skull's frame: rotation about the condyles with the forward slide that
    /// goes with it (HABER 4.1).
    #[must_use]
    pub fn mandible(&self, jaw_rad: f32) -> Affine3A {
        let slide = vec3(0.0, -0.3, 1.0) * (jaw_rad * JAW_SLIDE_MM_PER_RAD);
        Affine3A::from_translation(slide) * about(self.condyle_axis, Quat::from_rotation_x(jaw_rad))
    }

    /// Body and tip of the tongue in the mandible's frame: rigid transforms, as HABER 4.1 has them.
    fn tongue(&self, controls: &Controls) -> [Affine3A; 2] {
        let (tip, out, body) = (
            controls[Control::TongueTip],
            controls[Control::TongueOut],
            controls[Control::TongueBody],
        );
        let root = about(self.tongue_root, Quat::from_rotation_x(-0.22 * body));
        let lift = Affine3A::from_translation(vec3(0.0, 5.0 * body, 9.0 * out - 4.0 * body));
        let blade = about(self.tongue_blade, Quat::from_rotation_x(-0.55 * tip));
        let raise = Affine3A::from_translation(vec3(0.0, 3.5 * tip, 2.0 * tip));
        let tongue_body = lift * root;
        [tongue_body, tongue_body * raise * blade]
    }

    /// The head at rest, as a key frame at time 0.
    #[must_use]
    pub fn rest_frame(&self) -> KeyFrame {
        KeyFrame {
            skin: self.skin.mesh.positions.clone(),
            velocity: vec![Vec3::ZERO; self.skin.mesh.positions.len()],
            ..KeyFrame::default()
        }
    }

    /// The named line on the skin, where this head has it.
    #[must_use]
    pub fn feature(&self, name: &str) -> Option<&Feature> {
        self.features.iter().find(|f| f.name == name)
    }
}

/// How far the condyles slide forward as the jaw opens (order of size from Vatikiotis-Bateson and
/// Ostry: translation is linear in rotation; the figure itself is a judgement).
const JAW_SLIDE_MM_PER_RAD: f32 = 14.0;

/// Rotation about a point.
fn about(pivot: Vec3, rotation: Quat) -> Affine3A {
    Affine3A::from_rotation_translation(rotation, pivot - rotation * pivot)
}

/// Unit normals of a mesh, weighted by triangle area.
#[must_use]
pub fn normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let area = (b - a).cross(c - a);
        for &i in t {
            sums[i as usize] += area;
        }
    }
    sums.into_iter().map(|n| n.normalize_or(Vec3::Z)).collect()
}

/// Smooth step from 0 at `from` to 1 at `to`, either way round.
pub(crate) fn ramp(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
