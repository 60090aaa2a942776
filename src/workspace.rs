//! What the workspaces of both rules of the harmonic force have in common: how large they may be, how they begin, and how they
//! are divided.

use crate::error::Error;

/// Mark, harmonics and samples.
pub(crate) const HEADER: usize = 3;

/// Numbers in fours.
pub(crate) type Blocks = [[f64; 4]];

/// Harmonics H and samples, or nodes, a period.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Size {
    pub harmonics: usize,
    pub samples: usize,
}

impl Size {
    /// `rows` says how many rows of all orders up to 2H a workspace of that size holds at most.
    ///
    /// # Errors
    /// `BadHarmonics` for none, `BadSamples` for samples <= 2H; both for more than there is any use for.
    pub fn new(harmonics: usize, samples: usize, rows: impl FnOnce(Size) -> usize) -> Result<Size, Error> {
        // Far beyond any use.
        const LARGEST: usize = 1 << 24;
        if !(1..=LARGEST).contains(&harmonics) {
            return Err(Error::BadHarmonics);
        }
        if samples <= 2 * harmonics || samples > LARGEST {
            return Err(Error::BadSamples);
        }
        let size = Size { harmonics, samples };
        // Where addresses have 32 bits even that may be too much: eight tables are more than a workspace holds.
        let numbers = rows(size).checked_mul(8 * (2 * harmonics + 8));
        if numbers.is_none_or(|numbers| numbers > isize::MAX as usize / 8) {
            return Err(Error::BadSamples);
        }
        Ok(size)
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Clears memory, writes what a workspace begins with, and gives the rest.
    pub fn begin<'m>(&self, mark: f64, memory: &'m mut [f64]) -> Result<Parts<'m>, Error> {
        memory.fill(0.0);
        let [first, harmonics, samples, rest @ ..] = memory else { return Err(Error::WorkspaceTooShort) };
        (*first, *harmonics, *samples) = (mark, self.harmonics as f64, self.samples as f64);
        Ok(Parts(rest))
    }
}

/// Harmonics and samples of a prepared workspace, from what it begins with.
///
/// # Errors
/// `BadWorkspace` for memory that was not initialised, or was changed.
pub(crate) fn read_header(mark: f64, header: &[f64; HEADER]) -> Result<(usize, usize), Error> {
    let &[first, harmonics, samples] = header;
    // Compared as doubles: a conversion of what is no number would trap.
    let whole = |value: f64| (1.0..=16_777_216.0).contains(&value) && value.floor() == value;
    if first.to_bits() != mark.to_bits() || !whole(harmonics) || !whole(samples) {
        return Err(Error::BadWorkspace);
    }
    Ok((harmonics as usize, samples as usize))
}

/// Divides a slice from its front.
pub(crate) struct Parts<'a>(pub &'a mut [f64]);

impl<'a> Parts<'a> {
    pub fn take(&mut self, length: usize) -> Result<&'a mut [f64], Error> {
        let (front, back) = core::mem::take(&mut self.0).split_at_mut_checked(length).ok_or(Error::BadWorkspace)?;
        self.0 = back;
        Ok(front)
    }

    pub fn take_blocks(&mut self, blocks: usize) -> Result<&'a mut Blocks, Error> {
        Ok(self.take(4 * blocks)?.as_chunks_mut().0)
    }
}
