//! LZF, as Krita compresses tiles.
//!
//! A control byte below 32 is followed by one literal more than it says. Of another, the upper three bits are the length of a copy less two, seven of
//! them meaning that a byte with more follows; the lower five and the next byte are the distance less one. Cost linear in what comes out.

/// Fills `out`; `None` if the bytes give more or less, or refer to what is before the first.
pub(super) fn inflate(bytes: &[u8], out: &mut [u8]) -> Option<()> {
    let (mut at, mut filled) = (0, 0);
    while let Some(&control) = bytes.get(at) {
        at += 1;
        let high = usize::from(control & 31) << 8;
        let mut length = usize::from(control >> 5);
        if length == 0 {
            let count = high / 256 + 1;
            let from = bytes.get(at..at + count)?;
            out.get_mut(filled..filled + count)?.copy_from_slice(from);
            (at, filled) = (at + count, filled + count);
            continue;
        }
        if length == 7 {
            length += usize::from(*bytes.get(at)?);
            at += 1;
        }
        let distance = high + usize::from(*bytes.get(at)?) + 1;
        at += 1;
        let start = filled.checked_sub(distance)?;
        let end = filled + length + 2;
        if end > out.len() {
            return None;
        }
        // One by one: a copy may reach into itself, which repeats it.
        for k in filled..end {
            out[k] = out[start + k - filled];
        }
        filled = end;
    }
    (filled == out.len()).then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_copies_and_repetitions() {
        let mut out = [0; 16];
        // "abc", then three from three back, then ten of the last one: 7 + 1 + 2.
        let bytes = [2, b'a', b'b', b'c', 1 << 5, 2, 7 << 5, 1, 0];
        assert_eq!(inflate(&bytes, &mut out), Some(()));
        assert_eq!(&out, b"abcabccccccccccc");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert_eq!(inflate(&[0, b'a'], &mut [0; 2]), None);
        assert_eq!(inflate(&[1, b'a', b'b'], &mut [0; 1]), None);
        assert_eq!(inflate(&[5, b'a'], &mut [0; 6]), None);
        assert_eq!(inflate(&[1 << 5, 0], &mut [0; 3]), None);
        assert_eq!(inflate(&[0, b'a', 7 << 5, 255, 0], &mut [0; 8]), None);
        assert_eq!(inflate(&[0, b'a', 7 << 5], &mut [0; 8]), None);
    }
}
