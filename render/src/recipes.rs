//! How each pipeline is made: its shader, mesh, culling and depth, and which bind groups it reads.

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mesh {
    Skin,
    Part,
    Brow,
    None,
}

/// How one pipeline is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recipe {
    pub(crate) file: &'static str,
    pub(crate) vertex: &'static str,
    /// None: depth only, for the shadow map.
    pub(crate) fragment: Option<&'static str>,
    pub(crate) mesh: Mesh,
    pub(crate) cull: Option<wgpu::Face>,
    /// Alpha says how many samples are covered.
    pub(crate) strands: bool,
    /// Where a pixel has one sample only, alpha is how much of it is covered.
    pub(crate) blended: bool,
    pub(crate) depth: wgpu::CompareFunction,
}

const fn solid(file: &'static str) -> Recipe {
    Recipe {
        file,
        vertex: "mouth_vertex",
        fragment: Some(file),
        mesh: Mesh::Part,
        cull: Some(wgpu::Face::Back),
        strands: false,
        blended: false,
        depth: wgpu::CompareFunction::Less,
    }
}

const SKIN: Recipe = Recipe {
    vertex: "skin_vertex",
    mesh: Mesh::Skin,
    ..solid("skin")
};
const SKIN_BLINN_PHONG: Recipe = Recipe {
    file: "skin_blinn_phong",
    fragment: Some("skin_blinn_phong"),
    ..SKIN
};
const HAIR: Recipe = Recipe {
    vertex: "hair_vertex",
    strands: true,
    ..solid("hair")
};
const EYE: Recipe = Recipe {
    vertex: "eye_vertex",
    ..solid("eye")
};
const LASH: Recipe = Recipe {
    vertex: "lash_vertex",
    cull: None,
    strands: true,
    blended: true,
    ..solid("lash")
};
const BROW: Recipe = Recipe {
    vertex: "brow_vertex",
    mesh: Mesh::Brow,
    cull: None,
    strands: true,
    ..solid("brow")
};
const CAVITY: Recipe = Recipe {
    cull: None,
    ..solid("cavity")
};
const CLOTH: Recipe = Recipe {
    vertex: "cloth_vertex",
    cull: None,
    ..solid("cloth")
};
const BONE: Recipe = Recipe {
    vertex: "anatomy_vertex",
    cull: None,
    ..solid("bone")
};
const MUSCLE: Recipe = Recipe {
    vertex: "anatomy_vertex",
    ..solid("muscle")
};
const SPRING: Recipe = Recipe {
    vertex: "anatomy_vertex",
    cull: None,
    ..solid("spring")
};
const BACKDROP: Recipe = Recipe {
    vertex: "backdrop_vertex",
    fragment: Some("backdrop"),
    mesh: Mesh::None,
    depth: wgpu::CompareFunction::LessEqual,
    ..solid("background")
};
const PICTURE: Recipe = Recipe {
    file: "picture",
    vertex: "picture_vertex",
    fragment: Some("picture"),
    ..BACKDROP
};
const FLASH: Recipe = Recipe {
    vertex: "flash_vertex",
    mesh: Mesh::None,
    depth: wgpu::CompareFunction::Always,
    ..solid("flash")
};
const INSIDE: Recipe = Recipe {
    vertex: "inside_vertex",
    mesh: Mesh::Skin,
    cull: Some(wgpu::Face::Front),
    ..solid("inside")
};
const SKIN_SHADOW: Recipe = Recipe {
    vertex: "skin_shadow",
    fragment: None,
    mesh: Mesh::Skin,
    ..solid("shadow")
};

const PART_SHADOW: Recipe = Recipe {
    vertex: "part_shadow",
    mesh: Mesh::Part,
    cull: None,
    ..SKIN_SHADOW
};

const YARDSTICK: Recipe = Recipe {
    vertex: "yardstick_vertex",
    mesh: Mesh::Skin,
    ..solid("yardstick")
};
/// Which bind groups a pipeline reads, from 0 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Groups {
    /// The frame.
    Bare,
    /// Frame and the key lamp's shadow.
    Lit,
    /// Frame, shadow and a material's maps.
    Mapped,
    /// Frame, and a picture as if it were a map.
    Hung,
    /// Frame, shadow and the skin's maps.
    Skin,
}

/// Everything that is drawn by a pipeline of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Draw {
    Skin,
    SkinBlinnPhong,
    Hair,
    Eye,
    Teeth,
    Gums,
    Tongue,
    Cavity,
    Lash,
    Brow,
    Cloth,
    Inside,
    SkinShadow,
    Backdrop,
    Picture,
    Flash,
    Bone,
    Muscle,
    Spring,
    PartShadow,
    Yardstick,
}

impl Draw {
    /// What a face with a shut mouth needs, the most work first.
    pub(crate) const FACE: [Self; 7] = [
        Self::Skin,
        Self::Eye,
        Self::Hair,
        Self::Lash,
        Self::Cloth,
        Self::SkinShadow,
        Self::Backdrop,
    ];
    /// What it shows besides where a pixel has several samples.
    pub(crate) const FINE: [Self; 1] = [Self::Brow];
    /// What an open mouth shows besides. The others are made when they are first asked for.
    pub(crate) const MOUTH: [Self; 5] = [
        Self::Teeth,
        Self::Tongue,
        Self::Gums,
        Self::Cavity,
        Self::Inside,
    ];
    pub(crate) const COUNT: usize = Self::Yardstick as usize + 1;

    /// Whether it draws depth as the key lamp sees it, and no colour.
    pub(crate) fn is_shadow(self) -> bool {
        self.recipe().0.fragment.is_none()
    }

    /// What it is to be bound to.
    pub(crate) fn groups(self) -> Groups {
        self.recipe().1
    }

    pub(crate) fn recipe(self) -> (Recipe, Groups) {
        match self {
            Self::Skin => (SKIN, Groups::Skin),
            Self::SkinBlinnPhong => (SKIN_BLINN_PHONG, Groups::Skin),
            Self::Hair => (HAIR, Groups::Mapped),
            Self::Eye => (EYE, Groups::Mapped),
            Self::Teeth => (solid("teeth"), Groups::Lit),
            Self::Gums => (solid("gums"), Groups::Lit),
            Self::Tongue => (solid("tongue"), Groups::Lit),
            Self::Cavity => (CAVITY, Groups::Lit),
            Self::Lash => (LASH, Groups::Lit),
            Self::Brow => (BROW, Groups::Lit),
            Self::Cloth => (CLOTH, Groups::Lit),
            Self::Bone => (BONE, Groups::Lit),
            Self::Muscle => (MUSCLE, Groups::Lit),
            Self::Spring => (SPRING, Groups::Lit),
            Self::Inside => (INSIDE, Groups::Bare),
            Self::SkinShadow => (SKIN_SHADOW, Groups::Bare),
            Self::PartShadow => (PART_SHADOW, Groups::Bare),
            Self::Backdrop => (BACKDROP, Groups::Bare),
            Self::Flash => (FLASH, Groups::Bare),
            Self::Picture => (PICTURE, Groups::Hung),
            Self::Yardstick => (YARDSTICK, Groups::Skin),
        }
    }
}
