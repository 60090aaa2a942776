//! What the workspaces of both rules of the harmonic force have in common: how large they may be, how they begin, and how they
//! are divided.

use crate::error::Error;
use crate::seal::{Kind, is_of, of_places, of_table, of_whole, seal, whole};

/// Seal of the size, harmonics, samples, and seal of the tables.
pub(crate) const HEADER: usize = 4;

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

    /// Clears memory, has its tables filled, which stand first in it, and writes what a workspace begins with.
    ///
    /// # Errors
    /// `WorkspaceTooShort`, and those of `fill`.
    pub fn begin(
        &self,
        kind: Kind,
        memory: &mut [f64],
        tables: usize,
        fill: impl FnOnce(&mut Parts) -> Result<(), Error>,
    ) -> Result<(), Error> {
        memory.fill(0.0);
        let (header, rest) = memory.split_first_chunk_mut::<HEADER>().ok_or(Error::WorkspaceTooShort)?;
        let tables = rest.get_mut(..tables).ok_or(Error::WorkspaceTooShort)?;
        fill(&mut Parts(tables))?;
        let [harmonics, samples] = [self.harmonics, self.samples].map(of_whole);
        *header = [seal_of_size(kind, harmonics, samples), harmonics, samples, seal_of_tables(tables)];
        Ok(())
    }
}

fn seal_of_size(kind: Kind, harmonics: f64, samples: f64) -> f64 {
    seal(kind, of_places([harmonics, samples].into_iter()))
}

#[inline(always)]
fn seal_of_tables(tables: &[f64]) -> f64 {
    seal(Kind::Table, of_table(tables))
}

/// Whether what a workspace begins with says that it is of that kind.
pub(crate) fn says(kind: Kind, header: &[f64; HEADER]) -> bool {
    let &[first, ..] = header;
    is_of(kind, first)
}

/// A prepared workspace behind its header, once the tables with which that begins are found to be as they were made.
///
/// # Errors
/// `BadWorkspace` for memory that was changed.
#[inline(always)]
pub(crate) fn sealed_parts(workspace: &mut [f64], length: usize, tables: usize) -> Result<Parts<'_>, Error> {
    let (header, rest) = workspace.split_first_chunk_mut::<HEADER>().ok_or(Error::BadWorkspace)?;
    let rest = rest.get_mut(..length.saturating_sub(HEADER)).ok_or(Error::BadWorkspace)?;
    let &mut [.., expected] = header;
    if seal_of_tables(rest.get(..tables).ok_or(Error::BadWorkspace)?).to_bits() != expected.to_bits() {
        return Err(Error::BadWorkspace);
    }
    Ok(Parts(rest))
}

/// Harmonics and samples of a prepared workspace, from what it begins with.
///
/// # Errors
/// `BadWorkspace` for memory that was not initialised, or was changed.
pub(crate) fn read_header(kind: Kind, header: &[f64; HEADER]) -> Result<(usize, usize), Error> {
    let &[first, harmonics, samples, _] = header;
    match (whole(harmonics), whole(samples)) {
        (Some(h), Some(s)) if first.to_bits() == seal_of_size(kind, harmonics, samples).to_bits() => Ok((h, s)),
        _ => Err(Error::BadWorkspace),
    }
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
