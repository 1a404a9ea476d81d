//! Bytes read one after the other, never beyond their end.

use super::LayeredError;

/// What is left to read of some bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes<'a> {
    left: &'a [u8],
    /// What is being read, for refusals.
    what: &'static str,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(bytes: &'a [u8], what: &'static str) -> Self {
        Self { left: bytes, what }
    }

    /// What is left.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.left
    }

    pub(super) fn is_empty(&self) -> bool {
        self.left.is_empty()
    }

    /// The next `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], LayeredError> {
        let (taken, left) = self
            .left
            .split_at_checked(count)
            .ok_or(LayeredError::CutOff { what: self.what })?;
        self.left = left;
        Ok(taken)
    }

    /// The next `count` bytes as a part to be read on its own.
    pub(super) fn part(&mut self, count: usize, what: &'static str) -> Result<Self, LayeredError> {
        Ok(Self::new(self.take(count)?, what))
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], LayeredError> {
        let cut_off = LayeredError::CutOff { what: self.what };
        let (taken, left) = self.left.split_first_chunk::<N>().ok_or(cut_off)?;
        self.left = left;
        Ok(*taken)
    }

    pub(super) fn byte(&mut self) -> Result<u8, LayeredError> {
        Ok(self.array::<1>()?[0])
    }

    /// Four letters, as formats name their parts.
    pub(super) fn tag(&mut self) -> Result<[u8; 4], LayeredError> {
        self.array()
    }

    pub(super) fn be_u16(&mut self) -> Result<u16, LayeredError> {
        self.array().map(u16::from_be_bytes)
    }

    pub(super) fn be_i16(&mut self) -> Result<i16, LayeredError> {
        self.array().map(i16::from_be_bytes)
    }

    pub(super) fn be_u32(&mut self) -> Result<u32, LayeredError> {
        self.array().map(u32::from_be_bytes)
    }

    pub(super) fn be_i32(&mut self) -> Result<i32, LayeredError> {
        self.array().map(i32::from_be_bytes)
    }

    pub(super) fn be_u64(&mut self) -> Result<u64, LayeredError> {
        self.array().map(u64::from_be_bytes)
    }

    pub(super) fn le_u16(&mut self) -> Result<u16, LayeredError> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn le_i16(&mut self) -> Result<i16, LayeredError> {
        self.array().map(i16::from_le_bytes)
    }

    pub(super) fn le_u32(&mut self) -> Result<u32, LayeredError> {
        self.array().map(u32::from_le_bytes)
    }
}
