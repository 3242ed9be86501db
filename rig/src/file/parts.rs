//! What parts a head must have, and how another program's viewer shows what they are made of.

use super::document::{Material as GltfMaterial, Pbr};
use crate::Material;

/// Name of the skin's node.
pub(super) const SKIN: &str = "skin";

/// Parts without which a head could not speak or would show a hole.
pub(super) const REQUIRED: [&str; 5] = ["eye_l", "eye_r", "teeth_upper", "teeth_lower", "tongue"];
/// Parts that muscles are built over.
pub(super) const BONES: [&str; 2] = ["skull", "mandible"];

/// A glTF material: linear base colour and roughness. Mouthpiece draws by its own shaders instead.
pub(super) fn material(material: Material) -> GltfMaterial {
    let (name, [r, g, b], roughness, double_sided) = match material {
        Material::Skin => ("skin", [0.60, 0.36, 0.27], 0.55, false),
        Material::Eye => ("eye", [0.72, 0.70, 0.67], 0.08, false),
        Material::Teeth => ("teeth", [0.75, 0.70, 0.58], 0.25, false),
        Material::Gums => ("gums", [0.45, 0.13, 0.13], 0.35, false),
        Material::Tongue => ("tongue", [0.47, 0.15, 0.14], 0.40, false),
        Material::Cavity => ("cavity", [0.10, 0.02, 0.02], 0.70, true),
        Material::Hair => ("hair", [0.045, 0.028, 0.018], 0.60, true),
        Material::Lash => ("lash", [0.02, 0.013, 0.01], 0.70, true),
        Material::Cloth => ("cloth", [0.06, 0.07, 0.09], 0.90, true),
        Material::Muscle => ("muscle", [0.30, 0.07, 0.05], 0.45, false),
        Material::Spring => ("spring", [0.50, 0.50, 0.50], 0.90, false),
        Material::Bone => ("bone", [0.72, 0.66, 0.53], 0.70, false),
    };
    GltfMaterial {
        name: Some(name.into()),
        pbr_metallic_roughness: Some(Pbr {
            base_color_factor: Some([r, g, b, 1.0]),
            metallic_factor: Some(0.0),
            roughness_factor: Some(roughness),
            base_color_texture: None,
        }),
        double_sided: double_sided.then_some(true),
    }
}
