//! Workspaces of the harmonic force: their sizes, their headers, and how they are divided.
//!
//! ```text
//! [tag with harmonics, tag with samples],   tables,   scratch memory
//! ```
//!
//! The tables are made once and then only read. A quadrature rule describes them by its [`WorkspaceLayout`].

use crate::error::Error;
use crate::tag::Kind;

/// Two tags; padded so that the tables keep the alignment of the workspace.
pub(super) const HEADER: usize = 4;

/// Numbers in fours.
pub(super) type Blocks = [[f64; 4]];

/// Harmonics H and samples, or nodes, a period.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    pub harmonics: usize,
    pub samples: usize,
}

impl Size {
    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }
}

/// How a rule divides a workspace of some size.
pub(super) trait WorkspaceLayout: Sized {
    /// What tells its workspaces from those of the other rule.
    const KIND: Kind;

    fn of(size: Size) -> Self;

    fn size(&self) -> Size;

    /// How many rows of all orders up to 2H a workspace holds at most.
    fn rows(&self) -> usize;

    /// Doubles of the tables.
    fn tables(&self) -> usize;

    /// Doubles of all, the header included.
    fn length(&self) -> usize;

    /// Makes the tables.
    ///
    /// # Errors
    /// Those of [`Parts::take`].
    fn fill_tables(&self, tables: &mut Parts) -> Result<(), Error>;

    /// # Errors
    /// `BadHarmonics` for none, `BadSamples` for samples <= 2H; both for more than there is any use for.
    fn new(harmonics: usize, samples: usize) -> Result<Self, Error> {
        // Far beyond any use.
        const LARGEST: usize = 1 << 24;
        if !(1..=LARGEST).contains(&harmonics) {
            return Err(Error::BadHarmonics);
        }
        if samples <= 2 * harmonics || samples > LARGEST {
            return Err(Error::BadSamples);
        }
        let layout = Self::of(Size { harmonics, samples });
        // Where addresses have 32 bits even that may be too much: eight tables are more than a workspace holds.
        let numbers = layout.rows().checked_mul(8 * (2 * harmonics + 8));
        if numbers.is_none_or(|numbers| numbers > isize::MAX as usize / 8) {
            return Err(Error::BadSamples);
        }
        Ok(layout)
    }

    /// Initialises a workspace.
    ///
    /// # Errors
    /// `WorkspaceTooShort`, and those of [`WorkspaceLayout::new`].
    fn init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
        let layout = Self::new(harmonics, samples)?;
        let memory = workspace.get_mut(..layout.length()).ok_or(Error::WorkspaceTooShort)?;
        memory.fill(0.0);
        let (header, buffers) = memory.split_first_chunk_mut::<HEADER>().ok_or(Error::WorkspaceTooShort)?;
        let tables = buffers.get_mut(..layout.tables()).ok_or(Error::WorkspaceTooShort)?;
        layout.fill_tables(&mut Parts(tables))?;
        *header = [Self::KIND.tag(harmonics), Kind::Samples.tag(samples), 0.0, 0.0];
        Ok(())
    }

    /// The layout of an initialised workspace, from its header.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised.
    #[inline(always)]
    fn read(&[first, second, ..]: &[f64; HEADER]) -> Result<Self, Error> {
        let (harmonics, samples) = (Self::KIND.count(first), Kind::Samples.count(second));
        Self::new(harmonics.ok_or(Error::BadWorkspace)?, samples.ok_or(Error::BadWorkspace)?)
            .map_err(|_| Error::BadWorkspace)
    }

    /// The layout and the memory behind the header of an initialised workspace.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or is too short.
    #[inline(always)]
    fn open(workspace: &mut [f64]) -> Result<(Self, Parts<'_>), Error> {
        let (header, buffers) = workspace.split_first_chunk_mut::<HEADER>().ok_or(Error::BadWorkspace)?;
        let layout = Self::read(header)?;
        let used = layout.length().saturating_sub(HEADER);
        Ok((layout, Parts(buffers.get_mut(..used).ok_or(Error::BadWorkspace)?)))
    }
}

/// Length of a part of a workspace with what keeps the next part aligned with vector registers.
pub(super) fn padded(length: usize) -> usize {
    (length + 3) & !3
}

/// Divides a slice from its front, in [`padded`] parts.
pub(super) struct Parts<'a>(&'a mut [f64]);

impl<'a> Parts<'a> {
    /// # Errors
    /// `BadWorkspace` if fewer doubles are left.
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
