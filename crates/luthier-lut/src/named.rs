//! Enums whose variants have names in files and on the command line.

use thiserror::Error;

/// A name that no variant has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("unknown {kind} `{name}`; known: {known}")]
pub struct UnknownName {
    /// The enum in words.
    pub kind: &'static str,
    /// The name that was given.
    pub name: String,
    /// The names of the variants.
    pub known: String,
}

/// Declares an enum with a name for every variant, by which files have it (`serde`), messages show it and command lines give it.
///
/// ```
/// luthier_lut::named! {
///     /// The seasons with fruit.
///     pub enum Season("season") {
///         /// June to August.
///         Summer = "summer",
///         /// September to November.
///         Autumn = "autumn",
///     }
/// }
/// assert_eq!(Season::from_name("autumn"), Some(Season::Autumn));
/// assert_eq!("winter".parse::<Season>().unwrap_err().to_string(), "unknown season `winter`; known: summer, autumn");
/// ```
#[macro_export]
macro_rules! named {
    ($(#[$meta:meta])* pub enum $type:ident($kind:literal) { $($(#[$doc:meta])* $variant:ident = $name:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $type { $($(#[$doc])* $variant,)+ }

        impl $type {
            /// The variants in their order.
            pub const ALL: [Self; Self::NAMES.len()] = [$(Self::$variant,)+];

            /// The names of the variants, in their order.
            pub const NAMES: &'static [&'static str] = &[$($name),+];

            /// The name in files, in messages and on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// The variant of a name.
            pub fn from_name(name: &str) -> Option<Self> {
                match name { $($name => Some(Self::$variant),)+ _ => None }
            }
        }

        impl ::std::fmt::Display for $type {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl ::std::str::FromStr for $type {
            type Err = $crate::UnknownName;

            fn from_str(name: &str) -> Result<Self, Self::Err> {
                Self::from_name(name).ok_or_else(|| {
                    $crate::UnknownName { kind: $kind, name: name.to_owned(), known: Self::NAMES.join(", ") }
                })
            }
        }

        impl From<$type> for &'static str {
            fn from(variant: $type) -> Self {
                variant.name()
            }
        }

        impl TryFrom<String> for $type {
            type Error = $crate::UnknownName;

            fn try_from(name: String) -> Result<Self, Self::Error> {
                name.parse()
            }
        }
    };
}
