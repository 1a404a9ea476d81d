//! Sine and cosine of many angles at once, with the same bytes on every machine.
//!
//! The C library's functions differ in the last bit from one platform to the next, and are called one angle at a time.
//! These use additions, multiplications and bit operations only, in an order that is fixed, so that a compiler can
//! put several angles into one register and every IEEE 754 machine agrees.
//!
//! 1. The angle is written as `k pi/2 + r` with `|r| <= pi/4`; `pi/2` is subtracted in three parts of 33 bits, so that
//!    `k` times each of the first two is exact (Cody and Waite 1980).
//! 2. Minimax polynomials for sine and cosine on that interval (coefficients of FreeBSD's `k_sin.c` and `k_cos.c`).
//! 3. `k` modulo 4 says which of the two is which, and their signs.
//!
//! Error: below 3e-16 for angles up to [`LARGEST_RAD`]; beyond, [`libm`] takes over one by one.

/// Angles in one call. Four registers of two numbers each, and a few of these blocks in flight, keep a processor busy;
/// the triangles of a mesh are padded to a multiple of it.
pub(crate) const LANES: usize = 32;

/// A value for each of [`LANES`] angles.
pub(crate) type Lanes = [f64; LANES];

/// Up to here `k` has at most 20 bits, and its products with parts of 33 bits are exact.
pub(crate) const LARGEST_RAD: f64 = 1.0e6;

/// Adding and subtracting it rounds to the nearest integer, which is then found in the lowest bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// `pi/2`: two parts with 33 bits each, and the rest.
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];

/// `(sin r - r) / r^3` as a polynomial in `r^2`.
const SINE: [f64; 6] = [
    f64::from_bits(0xBFC5_5555_5555_5549),
    f64::from_bits(0x3F81_1111_1110_F8A6),
    f64::from_bits(0xBF2A_01A0_19C1_61D5),
    f64::from_bits(0x3EC7_1DE3_57B1_FE7D),
    f64::from_bits(0xBE5A_E5E6_8A2B_9CEB),
    f64::from_bits(0x3DE5_D93A_5ACF_D57C),
];

/// `(cos r - 1 + r^2 / 2) / r^4` as a polynomial in `r^2`.
const COSINE: [f64; 6] = [
    f64::from_bits(0x3FA5_5555_5555_554C),
    f64::from_bits(0xBF56_C16C_16C1_5177),
    f64::from_bits(0x3EFA_01A0_19CB_1590),
    f64::from_bits(0xBE92_7E4F_809C_52AD),
    f64::from_bits(0x3E21_EE9E_BDB4_B1C4),
    f64::from_bits(0xBDA8_FAE9_BE88_38D4),
];

/// Sines and cosines of `angles_rad`. Angles that are not finite give NaN.
#[inline(always)]
pub(crate) fn sines_and_cosines(angles_rad: &Lanes, sines: &mut Lanes, cosines: &mut Lanes) {
    // Eight at a time stay in registers from the first step to the last.
    const TOGETHER: usize = 8;
    let mut largest = 0.0_f64;
    for from in (0..LANES).step_by(TOGETHER) {
        for lane in from..from + TOGETHER {
            let (sine, cosine) = reduced(angles_rad[lane]);
            sines[lane] = sine;
            cosines[lane] = cosine;
        }
    }
    for angle_rad in angles_rad {
        // NaN is not smaller than anything, so it has to be let in.
        largest = if angle_rad.abs() <= largest {
            largest
        } else {
            angle_rad.abs()
        };
    }
    let is_plain = largest <= LARGEST_RAD;
    if !is_plain {
        for ((angle_rad, sine), cosine) in angles_rad.iter().zip(sines).zip(cosines) {
            (*sine, *cosine) = libm::sincos(*angle_rad);
        }
    }
}

#[inline(always)]
fn reduced(angle_rad: f64) -> (f64, f64) {
    let shifted = angle_rad * std::f64::consts::FRAC_2_PI + ROUNDER;
    let quarters = shifted - ROUNDER;
    let r = ((angle_rad - quarters * HALF_PI[0]) - quarters * HALF_PI[1]) - quarters * HALF_PI[2];
    let z = r * r;
    let [s0, s1, s2, s3, s4, s5] = SINE;
    let sine = r + r * z * (s0 + z * (s1 + z * (s2 + z * (s3 + z * (s4 + z * s5)))));
    let [c0, c1, c2, c3, c4, c5] = COSINE;
    let cosine = 1.0 - (0.5 * z - z * z * (c0 + z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * c5))))));

    let quarter = shifted.to_bits();
    let swap = 0_u64.wrapping_sub(quarter & 1);
    let sine_sign = (quarter & 2) << 62;
    let cosine_sign = (quarter.wrapping_add(1) & 2) << 62;
    let (s, c) = (sine.to_bits(), cosine.to_bits());
    (
        f64::from_bits(((s & !swap) | (c & swap)) ^ sine_sign),
        f64::from_bits(((c & !swap) | (s & swap)) ^ cosine_sign),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(angle_rad: f64) -> (f64, f64) {
        let (mut sines, mut cosines) = ([0.0; LANES], [0.0; LANES]);
        sines_and_cosines(&[angle_rad; LANES], &mut sines, &mut cosines);
        (sines[LANES - 1], cosines[LANES - 1])
    }

    #[test]
    fn quarter_turns_and_what_is_not_finite() {
        assert_eq!(of(0.0), (0.0, 1.0));
        for (turns, expected) in [
            (0.25, (1.0, 0.0)),
            (0.5, (0.0, -1.0)),
            (-0.25, (-1.0, 0.0)),
            (2.0, (0.0, 1.0)),
        ] {
            let (sine, cosine) = of(std::f64::consts::TAU * turns);
            assert!(
                (sine - expected.0).abs() < 1e-15 && (cosine - expected.1).abs() < 1e-15,
                "{turns}"
            );
        }
        for angle_rad in [f64::NAN, f64::INFINITY] {
            assert!(of(angle_rad).0.is_nan() && of(angle_rad).1.is_nan());
        }
    }

    #[test]
    fn these_bytes_come_out_everywhere() {
        let bits = |(sine, cosine): (f64, f64)| (sine.to_bits(), cosine.to_bits());
        assert_eq!(bits(of(1.0)), (0x3FEA_ED54_8F09_0CEE, 0x3FE1_4A28_0FB5_068C));
        assert_eq!(bits(of(-1.0)), (0xBFEA_ED54_8F09_0CEE, 0x3FE1_4A28_0FB5_068C));
    }

    proptest! {
        #[test]
        fn agrees_with_the_plain_functions(angle_rad in prop_oneof![-8.0..8.0f64, -1e6..1e6f64, -1e12..1e12f64]) {
            let (sine, cosine) = of(angle_rad);
            prop_assert!((sine - libm::sin(angle_rad)).abs() < 3e-16, "{sine}");
            prop_assert!((cosine - libm::cos(angle_rad)).abs() < 3e-16, "{cosine}");
        }
    }
}
