//! Workspaces of the harmonic force: how large they may be, how they begin, and how they are divided.
//!
//! ```text
//! [seal of the size, harmonics, samples, seal of the tables],   tables,   scratch memory
//! ```
//!
//! The tables are made once, and found unchanged by every call. A rule says by its [`WorkspaceLayout`] what they are.

use crate::error::Error;
use crate::seal::{Kind, of_places, of_table, of_whole, seal, whole};

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

    /// Prepares a workspace.
    ///
    /// # Errors
    /// `WorkspaceTooShort`, and those of [`WorkspaceLayout::new`].
    fn init(harmonics: usize, samples: usize, workspace: &mut [f64]) -> Result<(), Error> {
        let layout = Self::new(harmonics, samples)?;
        let memory = workspace.get_mut(..layout.length()).ok_or(Error::WorkspaceTooShort)?;
        memory.fill(0.0);
        let (header, rest) = memory.split_first_chunk_mut::<HEADER>().ok_or(Error::WorkspaceTooShort)?;
        let tables = rest.get_mut(..layout.tables()).ok_or(Error::WorkspaceTooShort)?;
        layout.fill_tables(&mut Parts(tables))?;
        let [harmonics, samples] = [harmonics, samples].map(of_whole);
        *header = [seal_of_size(Self::KIND, harmonics, samples), harmonics, samples, seal_of_tables(tables)];
        Ok(())
    }

    /// The layout of a prepared workspace, from what it begins with.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    fn read(header: &[f64; HEADER]) -> Result<Self, Error> {
        let &[first, harmonics, samples, _] = header;
        match (whole(harmonics), whole(samples)) {
            (Some(h), Some(s)) if first.to_bits() == seal_of_size(Self::KIND, harmonics, samples).to_bits() => {
                Self::new(h, s).map_err(|_| Error::BadWorkspace)
            }
            _ => Err(Error::BadWorkspace),
        }
    }

    /// A prepared workspace behind its header, once the tables with which that begins are found to be as they were made.
    ///
    /// # Errors
    /// `BadWorkspace` for memory that was not initialised, or was changed.
    #[inline(always)]
    fn open(workspace: &mut [f64]) -> Result<(Self, Parts<'_>), Error> {
        let (header, rest) = workspace.split_first_chunk_mut::<HEADER>().ok_or(Error::BadWorkspace)?;
        let layout = Self::read(header)?;
        let rest = rest.get_mut(..layout.length().saturating_sub(HEADER)).ok_or(Error::BadWorkspace)?;
        let &mut [.., expected] = header;
        if seal_of_tables(rest.get(..layout.tables()).ok_or(Error::BadWorkspace)?).to_bits() != expected.to_bits() {
            return Err(Error::BadWorkspace);
        }
        Ok((layout, Parts(rest)))
    }
}

fn seal_of_size(kind: Kind, harmonics: f64, samples: f64) -> f64 {
    seal(kind, of_places([harmonics, samples].into_iter()))
}

#[inline(always)]
fn seal_of_tables(tables: &[f64]) -> f64 {
    seal(Kind::Table, of_table(tables))
}

/// Divides a slice from its front.
pub(super) struct Parts<'a>(&'a mut [f64]);

impl<'a> Parts<'a> {
    /// # Errors
    /// `BadWorkspace` where so much is not left.
    pub fn take(&mut self, length: usize) -> Result<&'a mut [f64], Error> {
        let (front, back) = core::mem::take(&mut self.0).split_at_mut_checked(length).ok_or(Error::BadWorkspace)?;
        self.0 = back;
        Ok(front)
    }

    /// # Errors
    /// Those of [`Parts::take`].
    pub fn take_blocks(&mut self, blocks: usize) -> Result<&'a mut Blocks, Error> {
        Ok(self.take(4 * blocks)?.as_chunks_mut().0)
    }
}
