//! Loops compiled for the widest registers the machine has.

/// Runs `work`, compiled a second time for processors with AVX2, where there is one; what it calls has to be inlined to
/// profit. The result is the same to the last bit: wider registers do more operations at a time, not others, and the
/// compiler never fuses a multiplication with an addition on its own.
#[inline(always)]
pub(crate) fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}
