//! Workspaces of the harmonic force: size, header and layout.
//!
//! ```text
//! [tag, harmonics, samples, periods, length, 0, 0, 0 | tables | scratch memory]
//! ```
//!
//! The tables are filled once and only read afterwards. Each quadrature rule implements [`Layout`].

use crate::error::{Error, ensure};
use crate::numerics::record::{Record, records_mut};
use crate::numerics::slices::PanicFreeSlice;
use crate::tag::{Kind, count, stored};

/// Length of the header in doubles: a whole number of vectors, so that the tables are aligned as the workspace is.
pub(crate) const HEADER: usize = 8;

/// Doubles in blocks of four.
pub(crate) type Blocks = [[f64; 4]];

/// Number of harmonics H, of samples or nodes per period, and of periods applied before the returned one, 0 for the default.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SamplingSize {
    pub harmonics: usize,
    pub samples: usize,
    pub periods: usize,
}

impl SamplingSize {
    /// 2H + 1.
    pub fn coefficients(&self) -> usize {
        2 * self.harmonics + 1
    }
}

/// The parts of the workspace of a quadrature rule.
pub(crate) trait Layout<'a>: Sized {
    /// Kind of the tag, which distinguishes the rules.
    const KIND: Kind;

    /// Default number of periods before the returned one; 1 if the second period is the steady state.
    const PERIODS: usize = 1;

    /// Upper bound on the number of rows over all orders up to 2H.
    fn max_rows(size: SamplingSize) -> usize {
        2 * size.samples + 16
    }

    /// Takes the parts.
    fn take(size: SamplingSize, parts: &mut Parts<'a>) -> Self;

    /// Fills the tables, in memory that is all zeros.
    fn fill(&mut self);

    /// Number of doubles in a workspace of a checked size, including the header.
    fn length(size: SamplingSize) -> usize {
        let mut parts = Parts::new(&mut []);
        Self::take(size, &mut parts);
        HEADER + parts.doubles
    }

    /// Number of doubles in a workspace; 0 if the size is not allowed.
    fn length_or_zero(size: SamplingSize) -> usize {
        Self::check_size(size).map_or(0, Self::length)
    }

    /// A size with its number of periods.
    /// Errors: `BadHarmonics` unless 1 <= H <= 2^24, `BadSamples` unless 2H < samples <= 2^24, `BadPeriods` for more than 65536
    /// periods.
    fn check_size(size: SamplingSize) -> Result<SamplingSize, Error> {
        const LARGEST: usize = 1 << 24;
        const MOST_PERIODS: usize = 1 << 16;
        let SamplingSize { harmonics, samples, periods } = size;
        let size = SamplingSize { periods: if periods == 0 { Self::PERIODS } else { periods }, ..size };
        ensure((1..=LARGEST).contains(&harmonics), Error::BadHarmonics)?;
        if samples <= 2 * harmonics || samples > LARGEST {
            return Err(Error::BadSamples);
        }
        if size.periods > MOST_PERIODS {
            return Err(Error::BadPeriods);
        }
        // With 32-bit addresses a workspace of an allowed size may still be too large. Its length is less than eight times
        // `max_rows` rows.
        let doubles = Self::max_rows(size).checked_mul(8 * (2 * harmonics + 8));
        if doubles.is_none_or(|doubles| doubles > isize::MAX as usize / 8) {
            return Err(Error::BadSamples);
        }
        Ok(size)
    }

    /// Initialises a workspace.
    /// Errors: `WorkspaceTooShort`, and those of [`Layout::check_size`].
    fn init(size: SamplingSize, workspace: &'a mut [f64]) -> Result<(), Error> {
        let size = Self::check_size(size)?;
        let length = Self::length(size);
        let memory = workspace.get_mut(..length).ok_or(Error::WorkspaceTooShort)?;
        memory.fill(0.0);
        let (header, buffers) = memory.split_first_chunk_mut::<HEADER>().ok_or(Error::WorkspaceTooShort)?;
        Self::take(size, &mut Parts::new(buffers)).fill();
        let SamplingSize { harmonics, samples, periods } = size;
        let [tag, counts @ ..] = header;
        *tag = Self::KIND.tag();
        counts.copy_from(&[harmonics, samples, periods, length].map(stored));
        Ok(())
    }

    /// Size and number of doubles of an initialised workspace, from its header.
    fn read(&[tag, harmonics, samples, periods, length, ..]: &[f64; HEADER]) -> Result<(SamplingSize, usize), Error> {
        let counts = [harmonics, samples, periods, length].map(count);
        let [Some(harmonics), Some(samples), Some(periods @ 1..), Some(length)] = counts else {
            return Err(Error::BadWorkspace);
        };
        ensure(Self::KIND.is_tag(tag), Error::BadWorkspace)?;
        let size = Self::check_size(SamplingSize { harmonics, samples, periods }).map_err(|_| Error::BadWorkspace)?;
        Ok((size, length))
    }

    /// Opens an initialised workspace.
    /// Errors: `BadWorkspace` if uninitialised or too short.
    fn open(workspace: &'a mut [f64]) -> Result<Self, Error> {
        let (size, _) = Self::read(workspace.first_chunk().ok_or(Error::BadWorkspace)?)?;
        Self::of_size(size, workspace)
    }

    /// A workspace of this size, which was read from its header.
    /// Errors: `BadWorkspace` if too short.
    fn of_size(size: SamplingSize, workspace: &'a mut [f64]) -> Result<Self, Error> {
        let buffers = workspace.get_mut(HEADER..).ok_or(Error::BadWorkspace)?;
        let (length, mut parts) = (buffers.len(), Parts::new(buffers));
        let taken = Self::take(size, &mut parts);
        if parts.doubles <= length { Ok(taken) } else { Err(Error::BadWorkspace) }
    }
}

/// Length of a part of a workspace, rounded up to keep the next part aligned to vector registers.
pub(crate) fn padded(length: usize) -> usize {
    (length + 3) & !3
}

/// Divides the memory of a workspace into [`padded`] parts. Parts that do not fit are empty, but counted, so that the length of a
/// workspace follows from the division of no memory.
pub(crate) struct Parts<'a> {
    memory: &'a mut [f64],
    /// Doubles of all parts so far.
    pub doubles: usize,
}

impl<'a> Parts<'a> {
    pub fn new(memory: &'a mut [f64]) -> Parts<'a> {
        Parts { memory, doubles: 0 }
    }

    pub fn take(&mut self, length: usize) -> &'a mut [f64] {
        let padded = padded(length);
        self.doubles += padded;
        let (front, back) = core::mem::take(&mut self.memory).split_at_mut_checked(padded).unwrap_or_default();
        self.memory = back;
        front.part_mut(..length)
    }

    pub fn take_arrays<const K: usize>(&mut self, length: usize) -> [&'a mut [f64]; K] {
        [(); K].map(|()| self.take(length))
    }

    pub fn take_blocks(&mut self, blocks: usize) -> &'a mut Blocks {
        self.take(4 * blocks).blocks_mut()
    }

    pub fn take_records<T: Record>(&mut self, count: usize) -> &'a mut [T] {
        records_mut(self.take(count * (size_of::<T>() / size_of::<f64>())))
    }
}
