//! What is behind the character.

/// What is behind the character.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Background {
    /// Nothing.
    #[default]
    Transparent,
    /// A colour: red, green, blue, alpha, not premultiplied.
    Colour([u8; 4]),
}

impl std::str::FromStr for Background {
    /// What may be written.
    type Err = &'static str;

    fn from_str(word: &str) -> Result<Self, Self::Err> {
        /// What may be written.
        const ALLOWED: &str = "'transparent', 'white', 'black', '#rrggbb' or '#rrggbbaa'";
        let word = match word {
            "transparent" => return Ok(Self::Transparent),
            "white" => "#ffffff",
            "black" => "#000000",
            other => other,
        };
        let hex = word.strip_prefix('#').ok_or(ALLOWED)?;
        if !hex.bytes().all(|digit| digit.is_ascii_hexdigit()) || !matches!(hex.len(), 6 | 8) {
            return Err(ALLOWED);
        }
        let mut colour = [255; 4];
        for (k, channel) in colour.iter_mut().enumerate().take(hex.len() / 2) {
            *channel = u8::from_str_radix(&hex[2 * k..2 * k + 2], 16).map_err(|_| ALLOWED)?;
        }
        Ok(Self::Colour(colour))
    }
}
