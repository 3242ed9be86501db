//! The .wgsl files and the resolver of their `#include "name"` lines.
//!
//! A file is taken in once, before its first use; that is all the module system the shaders need.

use std::collections::HashSet;

use thiserror::Error;

/// Every shader file by its name without ending.
const FILES: &[(&str, &str)] = &[
    ("anatomy", include_str!("shaders/anatomy.wgsl")),
    ("background", include_str!("shaders/background.wgsl")),
    ("bone", include_str!("shaders/bone.wgsl")),
    ("brow", include_str!("shaders/brow.wgsl")),
    ("cavity", include_str!("shaders/cavity.wgsl")),
    ("cloth", include_str!("shaders/cloth.wgsl")),
    ("eye", include_str!("shaders/eye.wgsl")),
    ("flash", include_str!("shaders/flash.wgsl")),
    ("frame", include_str!("shaders/frame.wgsl")),
    ("gums", include_str!("shaders/gums.wgsl")),
    ("hair", include_str!("shaders/hair.wgsl")),
    ("inside", include_str!("shaders/inside.wgsl")),
    ("lash", include_str!("shaders/lash.wgsl")),
    ("light", include_str!("shaders/light.wgsl")),
    ("mouth", include_str!("shaders/mouth.wgsl")),
    ("muscle", include_str!("shaders/muscle.wgsl")),
    ("noise", include_str!("shaders/noise.wgsl")),
    ("part", include_str!("shaders/part.wgsl")),
    ("picture", include_str!("shaders/picture.wgsl")),
    ("shadow", include_str!("shaders/shadow.wgsl")),
    ("skin", include_str!("shaders/skin.wgsl")),
    (
        "skin_blinn_phong",
        include_str!("shaders/skin_blinn_phong.wgsl"),
    ),
    ("skin_maps", include_str!("shaders/skin_maps.wgsl")),
    ("skin_surface", include_str!("shaders/skin_surface.wgsl")),
    ("spring", include_str!("shaders/spring.wgsl")),
    ("teeth", include_str!("shaders/teeth.wgsl")),
    ("tongue", include_str!("shaders/tongue.wgsl")),
    ("yardstick", include_str!("shaders/yardstick.wgsl")),
];

/// The files that pipelines are made of; the others are only included.
#[cfg(test)]
pub(crate) const ENTRY_FILES: &[&str] = &[
    "background",
    "bone",
    "brow",
    "cavity",
    "cloth",
    "eye",
    "flash",
    "gums",
    "hair",
    "inside",
    "lash",
    "muscle",
    "picture",
    "shadow",
    "skin",
    "skin_blinn_phong",
    "spring",
    "teeth",
    "tongue",
    "yardstick",
];

/// A mistake in the shader files themselves.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum ShaderError {
    /// A name that no file has.
    #[error("shaders/{from}.wgsl includes {name:?}, but there is no shaders/{name}.wgsl")]
    Missing {
        /// The file with the line.
        from: String,
        /// The name in it.
        name: String,
    },
}

/// The text of shader `name` with its includes put in place.
fn resolve(name: &str) -> Result<String, ShaderError> {
    resolve_in(FILES, name)
}

/// Every file's text, resolved, by name.
pub(crate) fn resolve_all() -> Result<Vec<(&'static str, String)>, ShaderError> {
    FILES
        .iter()
        .map(|(name, _)| Ok((*name, resolve(name)?)))
        .collect()
}

fn resolve_in(files: &[(&str, &str)], name: &str) -> Result<String, ShaderError> {
    let mut text = String::new();
    append(files, name, name, &mut HashSet::new(), &mut text)?;
    Ok(text)
}

fn append(
    files: &[(&str, &str)],
    from: &str,
    name: &str,
    taken: &mut HashSet<String>,
    text: &mut String,
) -> Result<(), ShaderError> {
    if !taken.insert(name.to_owned()) {
        return Ok(());
    }
    let Some((_, source)) = files.iter().find(|(n, _)| *n == name) else {
        return Err(ShaderError::Missing {
            from: from.to_owned(),
            name: name.to_owned(),
        });
    };
    for line in source.lines() {
        let included = line
            .strip_prefix("#include \"")
            .and_then(|rest| rest.trim_end().strip_suffix('"'));
        match included {
            Some(included) => append(files, name, included, taken, text)?,
            None => {
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shader_is_valid_through_the_resolver() {
        for name in ENTRY_FILES {
            let text = resolve(name).unwrap();
            let module = naga::front::wgsl::parse_str(&text)
                .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(&text)));
            let mut validator = naga::valid::Validator::new(
                naga::valid::ValidationFlags::all(),
                naga::valid::Capabilities::empty(),
            );
            validator
                .validate(&module)
                .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(&text)));
            assert!(!module.entry_points.is_empty(), "{name} has no entry point");
        }
    }

    #[test]
    fn every_entry_point_is_valid_with_its_constants_filled_in() {
        for name in ENTRY_FILES {
            let text = resolve(name).unwrap();
            let module = naga::front::wgsl::parse_str(&text).unwrap();
            let info = naga::valid::Validator::new(
                naga::valid::ValidationFlags::all(),
                naga::valid::Capabilities::empty(),
            )
            .validate(&module)
            .unwrap();
            for taps in [1.0, 2.0, 9.0] {
                let constants: naga::back::PipelineConstants = [("SHADOW_TAPS".to_owned(), taps)]
                    .into_iter()
                    .filter(|(n, _)| text.contains(n))
                    .collect();
                for entry in &module.entry_points {
                    let stage = Some((entry.stage, entry.name.as_str()));
                    naga::back::pipeline_constants::process_overrides(
                        &module, &info, stage, &constants,
                    )
                    .unwrap_or_else(|e| panic!("{name}, {}: {e:?}", entry.name));
                }
            }
        }
    }

    #[test]
    fn every_file_is_used() {
        let mut used: HashSet<String> = HashSet::new();
        for name in ENTRY_FILES {
            append(FILES, name, name, &mut used, &mut String::new()).unwrap();
        }
        for (name, _) in FILES {
            assert!(used.contains(*name), "shaders/{name}.wgsl is not used");
        }
    }

    #[test]
    fn a_file_included_twice_is_taken_once_and_a_missing_one_is_named() {
        let files = [
            ("a", "#include \"b\"\n#include \"c\"\nA"),
            ("b", "#include \"c\"\nB"),
            ("c", "C"),
        ];
        assert_eq!(resolve_in(&files, "a").unwrap(), "C\nB\nA\n");
        let broken = [("a", "#include \"z\"")];
        let error = resolve_in(&broken, "a").unwrap_err();
        assert_eq!(
            error.to_string(),
            "shaders/a.wgsl includes \"z\", but there is no shaders/z.wgsl"
        );
    }
}
