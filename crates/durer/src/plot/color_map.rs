//! Colours that represent numbers.

/// A table of colours, interpolated in sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ColorMap {
    /// Dark blue over green to yellow; even steps for the eye, also without colours. Eleven
    /// points near the map of that name by S. van der Walt and N. Smith (2015).
    Viridis,
    /// Sea green over meadows and rock to snow.
    Terrain,
    /// Blue over white to red, for heights around a middle.
    CoolWarm,
    /// Dark to light grey.
    Grey,
}

const VIRIDIS: [[u8; 3]; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];
const TERRAIN: [[u8; 3]; 7] = [
    [46, 107, 92],
    [87, 146, 83],
    [158, 183, 102],
    [214, 196, 135],
    [166, 128, 93],
    [150, 133, 124],
    [247, 247, 247],
];
const COOL_WARM: [[u8; 3]; 5] =
    [[48, 83, 178], [133, 164, 222], [226, 226, 226], [228, 146, 118], [176, 28, 44]];
const GREY: [[u8; 3]; 2] = [[40, 40, 40], [225, 225, 225]];

impl ColorMap {
    /// All colour maps.
    pub const ALL: &'static [Self] = &[Self::Viridis, Self::Terrain, Self::CoolWarm, Self::Grey];

    /// Returns the name used on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Viridis => "viridis",
            Self::Terrain => "terrain",
            Self::CoolWarm => "cool-warm",
            Self::Grey => "grey",
        }
    }

    /// Returns the colour of a number from 0 to 1, sRGB, opaque; numbers beyond are clamped.
    pub fn at(self, part: f64) -> [u8; 4] {
        let table: &[[u8; 3]] = match self {
            Self::Viridis => &VIRIDIS,
            Self::Terrain => &TERRAIN,
            Self::CoolWarm => &COOL_WARM,
            Self::Grey => &GREY,
        };
        let place = part.clamp(0.0, 1.0) * (table.len() - 1) as f64;
        // The cast takes NaN to 0.
        let first = (place as usize).min(table.len() - 2);
        let t = place - first as f64;
        let mix = |k: usize| {
            let (a, b) = (f64::from(table[first][k]), f64::from(table[first + 1][k]));
            (a + (b - a) * t).round() as u8
        };
        [mix(0), mix(1), mix(2), 255]
    }
}

impl std::fmt::Display for ColorMap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for ColorMap {
    type Err = crate::Error;

    fn from_str(s: &str) -> crate::Result<Self> {
        let found = Self::ALL.iter().copied().find(|m| m.name() == s);
        found.ok_or_else(|| {
            crate::Error::parameter("colour map", s, "one of viridis, terrain, cool-warm, grey")
        })
    }
}
