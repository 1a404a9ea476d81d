//! A small font of straight strokes: capitals, digits and a few signs.

use crate::math::Point;

/// Each glyph on a grid of 5 x 7 places: strokes separated by spaces, each a row of places "xy".
const GLYPHS: [(char, &str); 51] = [
    ('A', "062046 1434"),
    ('B', "00063645443303 0030414233"),
    ('C', "4130100105163645"),
    ('D', "00062644422000"),
    ('E', "40000646 0333"),
    ('F', "400006 0333"),
    ('G', "41301001051636454323"),
    ('H', "0006 4046 0343"),
    ('I', "2026 1030 1636"),
    ('J', "4045361605"),
    ('K', "0006 400346"),
    ('L', "000646"),
    ('M', "0600234046"),
    ('N', "06004640"),
    ('O', "100105163645413010"),
    ('P', "06003041423303"),
    ('Q', "100105163645413010 3446"),
    ('R', "06003041423303 2346"),
    ('S', "413010010213334445361605"),
    ('T', "0040 2026"),
    ('U', "000516364540"),
    ('V', "002640"),
    ('W', "0016233640"),
    ('X', "0046 4006"),
    ('Y', "002340 2326"),
    ('Z', "00400646"),
    ('0', "100105163645413010 0541"),
    ('1', "112026 1636"),
    ('2', "01103041420646"),
    ('3', "004023334445361605"),
    ('4', "36300444"),
    ('5', "4000023243453606"),
    ('6', "40100105163645443303"),
    ('7', "004016"),
    ('8', "133344453616050413 3342413010010213"),
    ('9', "431302011030414536"),
    ('-', "1333"),
    ('_', "0646"),
    ('.', "2526"),
    (',', "2516"),
    (':', "2122 2526"),
    (';', "2122 2516"),
    ('\'', "2022"),
    ('(', "30121436"),
    (')', "10323416"),
    ('/', "4006"),
    ('%', "4006 0010110100 3545463635"),
    ('+', "1333 2224"),
    ('=', "1232 1434"),
    ('<', "300336"),
    (' ', ""),
];

/// What stands for letters the font does not have: a box.
const UNKNOWN: &str = "0040460600";
/// The distance from one letter to the next, in letter heights.
const ADVANCE: f64 = 1.0;

/// How wide and high words are, in letter heights.
pub(super) fn size(words: &str) -> Point {
    let letters = words.chars().flat_map(char::to_uppercase).count();
    // The last letter ends four sixths into its cell.
    Point::new((letters as f64 * ADVANCE - 2.0 / 6.0).max(0.0), 1.0)
}

/// The strokes of some words, letters one unit high, from the origin down and to the right.
pub(super) fn strokes(words: &str) -> Vec<Vec<Point>> {
    let mut strokes = Vec::new();
    for (k, letter) in words.chars().flat_map(char::to_uppercase).enumerate() {
        let glyph = GLYPHS.iter().find(|(c, _)| *c == letter).map_or(UNKNOWN, |(_, g)| g);
        for stroke in glyph.split_whitespace() {
            let digits: Vec<f64> = stroke.bytes().map(|b| f64::from(b - b'0')).collect();
            strokes.push(
                digits
                    .chunks_exact(2)
                    .map(|xy| Point::new(k as f64 * ADVANCE + xy[0] / 6.0, xy[1] / 6.0))
                    .collect(),
            );
        }
    }
    strokes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_stays_in_its_cell() {
        for (letter, glyph) in GLYPHS {
            assert!(
                glyph.bytes().all(|b| b == b' ' || (b'0'..=b'6').contains(&b)),
                "{letter}"
            );
            for stroke in glyph.split_whitespace() {
                assert!(stroke.len() >= 4 && stroke.len() % 2 == 0, "{letter}");
            }
            assert_eq!(strokes(&letter.to_string()).len(), glyph.split_whitespace().count());
        }
        assert_eq!(strokes("\u{fc}").len(), 1);
    }
}
