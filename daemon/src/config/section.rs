//! A section of the configuration: its keys, each with type, default and documentation in one place.
//!
//! [`section!`] makes a struct that is read strictly (an unknown key is an error) and that knows its
//! documentation while it runs, so that `config print` shows what the source says.

/// A key and what it means, line by line.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    pub name: &'static str,
    pub about: &'static [&'static str],
    /// A change is not felt by a face that lives already.
    pub at_start: bool,
}

/// A part of the file under a `[heading]`.
pub trait Section {
    const ABOUT: &'static [&'static str];
    const KEYS: &'static [Key];
}

/// Whether a key's declaration says so.
pub const fn is_at_start(words: &[&str]) -> bool {
    !words.is_empty()
}

/// Declares a section: `/// what it means` and `key: Type = default,` for each key, or `key: Type =
/// default => at_start,` where a change is felt at the next start only. A key of type `Option` is
/// not set by default.
macro_rules! section {
    (
        $(#[doc = $about:literal])+
        pub struct $name:ident {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($attribute:tt)*)])?
                $key:ident : $type:ty = $default:expr $(=> $at_start:ident)?,
            )+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $name {
            $(
                $(#[doc = $doc])+
                $(#[serde($($attribute)*)])?
                pub $key: $type,
            )+
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($key: $default,)+ }
            }
        }

        impl $crate::config::section::Section for $name {
            const ABOUT: &'static [&'static str] = &[$($about),+];
            const KEYS: &'static [$crate::config::section::Key] = &[
                $($crate::config::section::Key {
                    name: stringify!($key),
                    about: &[$($doc),+],
                    at_start: $crate::config::section::is_at_start(&[$(stringify!($at_start))?]),
                },)+
            ];
        }
    };
}

pub(crate) use section;
