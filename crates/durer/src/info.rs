//! The description of an algorithm: its name, its publication, its cost. Each algorithm's file has
//! one record.

/// In which space an algorithm decides, after Sutherland, Sproull and Schumacker (1974).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Class {
    /// Decides with the geometry's own precision; the result does not depend on pixels.
    ObjectSpace,
    /// Decides per pixel or per scan line.
    ImageSpace,
    /// Orders faces in object space, paints them in image space.
    ListPriority,
}

/// The facts of one published algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Info {
    /// The name used on the command line, e.g. `"cohen-sutherland"`.
    pub name: &'static str,
    /// The name used in prose, e.g. `"Cohen–Sutherland"`.
    pub title: &'static str,
    /// The authors, in the order of the paper.
    pub authors: &'static str,
    /// Year of publication.
    pub year: u16,
    /// Publication.
    pub source: &'static str,
    /// Space in which it decides.
    pub class: Class,
    /// Time and memory, in the usual O-notation, with its letters explained.
    pub cost: &'static str,
    /// Limits, and requirements on the input.
    pub limits: &'static str,
}

/// Declares the closed set of the algorithms of one family as an enum with `ALL`, `name`, `info`,
/// `Display` and `FromStr`; everything that lists algorithms reads `ALL`.
#[macro_export]
#[doc(hidden)]
macro_rules! family {
    ($(#[$meta:meta])* $vis:vis enum $name:ident { $($(#[$vmeta:meta])* $variant:ident => $info:expr),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        $vis enum $name { $($(#[$vmeta])* $variant),+ }

        impl $name {
            /// Every member of the family, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Returns the facts of this algorithm.
            pub const fn info(self) -> &'static $crate::info::Info {
                match self { $(Self::$variant => &$info),+ }
            }

            /// Returns the name used on the command line.
            pub const fn name(self) -> &'static str {
                self.info().name
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl std::str::FromStr for $name {
            type Err = $crate::Error;

            fn from_str(s: &str) -> $crate::Result<Self> {
                Self::ALL.iter().copied().find(|a| a.name() == s).ok_or_else(|| {
                    $crate::Error::parameter(
                        "algorithm",
                        s,
                        concat!("one of the names in ", stringify!($name), "::ALL"),
                    )
                })
            }
        }
    };
}
pub use family;
