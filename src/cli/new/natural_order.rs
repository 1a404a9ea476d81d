//! The order of drawings by the numbers in their names.

use std::path::{Path, PathBuf};

/// A piece of a file's name by which names are sorted: numbers as numbers, so that walk2 comes before walk10.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum NamePiece {
    /// A number, by its digits without leading zeros: longer ones are larger.
    Number(usize, String),
    /// Letters, capital or not.
    Word(String),
}

/// By what drawings are sorted: the pieces of their file's name, then all of the path, so that no two are alike.
pub(super) fn natural_key(path: &Path) -> (Vec<NamePiece>, PathBuf) {
    let stem = path
        .file_stem()
        .map(|stem| stem.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    let letters: Vec<char> = stem.chars().collect();
    let pieces = letters
        .chunk_by(|a, b| a.is_ascii_digit() == b.is_ascii_digit())
        .map(|piece| {
            let word: String = piece.iter().collect();
            if word.starts_with(|c: char| c.is_ascii_digit()) {
                let digits = word.trim_start_matches('0').to_owned();
                NamePiece::Number(digits.len(), digits)
            } else {
                NamePiece::Word(word)
            }
        })
        .collect();
    (pieces, path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_sorted_by_their_numbers() {
        let shell = [
            "walk1.png",
            "walk10.png",
            "walk2.png",
            "Walk03.png",
            "b/walk2.svg",
            "idle.png",
        ];
        let mut paths: Vec<PathBuf> = shell.iter().map(PathBuf::from).collect();
        paths.sort_by_cached_key(|path| natural_key(path));
        let sorted: Vec<&str> = paths.iter().filter_map(|path| path.to_str()).collect();
        assert_eq!(
            sorted,
            [
                "idle.png",
                "walk1.png",
                "b/walk2.svg",
                "walk2.png",
                "Walk03.png",
                "walk10.png"
            ]
        );
    }
}
