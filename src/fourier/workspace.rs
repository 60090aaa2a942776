//! Workspaces of the harmonic force: size, header and layout.
//!
//! ```text
//! [tag with harmonics, tag with samples, tag with periods, 0 | tables | scratch memory]
//! ```
//!
//! The tables are filled once and only read afterwards. Each quadrature rule implements [`WorkspaceLayout`].

use crate::error::Error;
use crate::tag::Kind;

/// Tags at the beginning.
pub(crate) const TAGS: usize = 3;

/// Doubles before the tables: the tags, padded so that the tables keep the alignment of the workspace.
pub(crate) const HEADER: usize = 4;

/// Doubles in blocks of four.
pub(crate) type Blocks = [[f64; 4]];

/// Number of harmonics H, of samples or nodes per period, and of periods walked before the one that counts, 0 for the default.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Size {
    pub harmonics: usize,
    pub samples: usize,
    pub periods: usize,
}

impl Size {
    /// With the default number of periods.
    pub fn new(harmonics: usize, samples: usize) -> Size {
        Size { harmonics, samples, periods: 0 }
    }

    pub fn with_periods(self, periods: usize) -> Size {
        Size { periods, ..self }
    }

    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }
}

/// Layout of the workspace of a quadrature rule.
pub(crate) trait WorkspaceLayout: Sized {
    /// Kind of the tag, which distinguishes the rules.
    const KIND: Kind;

    /// Default number of periods before the one that counts; 1 if the second period is the steady state.
    const PERIODS: usize = 1;

    fn of(size: Size) -> Self;

    fn size(&self) -> Size;

    /// Upper bound on the number of rows over all orders up to 2H.
    fn max_rows(&self) -> usize;

    /// Number of doubles in the tables.
    fn tables_length(&self) -> usize;

    /// Number of doubles in the workspace, including the header.
    fn length(&self) -> usize;

    /// Fills the tables.
    ///
    /// # Errors
    /// Those of [`Parts::take`].
    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error>;

    /// # Errors
    /// `BadHarmonics` unless 1 <= H <= 2^24, `BadSamples` unless 2H < samples <= 2^24, `BadPeriods` for more than 65536 periods.
    fn new(size: Size) -> Result<Self, Error> {
        const LARGEST: usize = 1 << 24;
        const MOST_PERIODS: usize = 1 << 16;
        let Size { harmonics, samples, periods } = size;
        let periods = if periods == 0 { Self::PERIODS } else { periods };
        if !(1..=LARGEST).contains(&harmonics) {
            return Err(Error::BadHarmonics);
        }
        if samples <= 2 * harmonics || samples > LARGEST {
            return Err(Error::BadSamples);
        }
        if periods > MOST_PERIODS {
            return Err(Error::BadPeriods);
        }
        let layout = Self::of(Size { periods, ..size });
        // With 32-bit addresses these sizes may still be too large. The workspace is smaller than eight times `max_rows` rows.
        let doubles = layout.max_rows().checked_mul(8 * (2 * harmonics + 8));
        if doubles.is_none_or(|doubles| doubles > isize::MAX as usize / 8) {
            return Err(Error::BadSamples);
        }
        Ok(layout)
    }

    /// Initialises a workspace.
    ///
    /// # Errors
    /// `WorkspaceTooShort`, and those of [`WorkspaceLayout::new`].
    fn init(size: Size, workspace: &mut [f64]) -> Result<(), Error> {
        let layout = Self::new(size)?;
        let memory = workspace.get_mut(..layout.length()).ok_or(Error::WorkspaceTooShort)?;
        memory.fill(0.0);
        let (header, buffers) = memory.split_first_chunk_mut::<HEADER>().ok_or(Error::WorkspaceTooShort)?;
        let tables = buffers.get_mut(..layout.tables_length()).ok_or(Error::WorkspaceTooShort)?;
        layout.fill_tables(&mut Parts(tables))?;
        let Size { harmonics, samples, periods } = layout.size();
        *header = [Self::KIND.tag(harmonics), Kind::Samples.tag(samples), Kind::Periods.tag(periods), 0.0];
        Ok(())
    }

    /// Layout of an initialised workspace, from its header.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised.
    #[inline(always)]
    fn read(&[first, second, third]: &[f64; TAGS]) -> Result<Self, Error> {
        let counts = (Self::KIND.count(first), Kind::Samples.count(second), Kind::Periods.count(third));
        let (Some(harmonics), Some(samples), Some(periods @ 1..)) = counts else { return Err(Error::BadWorkspace) };
        Self::new(Size { harmonics, samples, periods }).map_err(|_| Error::BadWorkspace)
    }

    /// Layout of an initialised workspace, and the memory behind its header.
    ///
    /// # Errors
    /// `BadWorkspace` if uninitialised or too short.
    #[inline(always)]
    fn open(workspace: &mut [f64]) -> Result<(Self, Parts<'_>), Error> {
        let (header, buffers) = workspace.split_first_chunk_mut::<HEADER>().ok_or(Error::BadWorkspace)?;
        let layout = Self::read(header.first_chunk().ok_or(Error::BadWorkspace)?)?;
        let used = layout.length().saturating_sub(HEADER);
        Ok((layout, Parts(buffers.get_mut(..used).ok_or(Error::BadWorkspace)?)))
    }
}

/// Length of a part of a workspace, rounded up to keep the next part aligned to vector registers.
pub(crate) fn padded(length: usize) -> usize {
    (length + 3) & !3
}

/// Splits [`padded`] parts off the front of a slice.
pub(crate) struct Parts<'a>(&'a mut [f64]);

impl<'a> Parts<'a> {
    #[cfg(test)]
    pub fn of(memory: &'a mut [f64]) -> Parts<'a> {
        Parts(memory)
    }

    /// # Errors
    /// `BadWorkspace` if fewer doubles remain.
    pub fn take(&mut self, length: usize) -> Result<&'a mut [f64], Error> {
        let parts = core::mem::take(&mut self.0).split_at_mut_checked(padded(length));
        let (front, back) = parts.ok_or(Error::BadWorkspace)?;
        self.0 = back;
        front.get_mut(..length).ok_or(Error::BadWorkspace)
    }

    /// # Errors
    /// Those of [`Parts::take`].
    pub fn take_blocks(&mut self, blocks: usize) -> Result<&'a mut Blocks, Error> {
        Ok(self.take(4 * blocks)?.as_chunks_mut().0)
    }
}
