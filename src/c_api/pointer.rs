//! From pointers to slices, and from results to status codes.

use super::{MSLIP_OK, mslip_contact};
use crate::contact::Contact;
use crate::error::Error;
use crate::{between_reversals, harmonic_force};
use core::slice;

pub fn status(result: Result<(), Error>) -> i32 {
    match result {
        Ok(()) => MSLIP_OK,
        Err(error) => error.code(),
    }
}

/// More numbers than memory can hold.
pub fn check_length<T>(n: usize) -> Result<(), Error> {
    if n <= isize::MAX as usize / size_of::<T>().max(1) { Ok(()) } else { Err(Error::BadArraySize) }
}

/// An input of n items.
///
/// # Safety
/// `pointer` is NULL or points to n items that are not written while the slice lives.
pub unsafe fn input<'a, T>(pointer: *const T, n: usize) -> Result<&'a [T], Error> {
    check_length::<T>(n)?;
    if n == 0 {
        Ok(&[])
    } else if pointer.is_null() {
        Err(Error::NullPointer)
    } else {
        Ok(unsafe { slice::from_raw_parts(pointer, n) })
    }
}

/// An output of n items; `None` is not wanted.
///
/// # Safety
/// `pointer` is NULL or points to n items that nobody else uses while the slice lives.
pub unsafe fn output<'a, T>(pointer: *mut T, n: usize) -> Option<&'a mut [T]> {
    if pointer.is_null() || n == 0 || check_length::<T>(n).is_err() {
        None
    } else {
        Some(unsafe { slice::from_raw_parts_mut(pointer, n) })
    }
}

/// A contact that was prepared.
///
/// # Safety
/// `pointer` is NULL or points to a contact.
pub unsafe fn contact<'a>(pointer: *const mslip_contact) -> Result<&'a Contact, Error> {
    let contact = unsafe { pointer.cast::<Contact>().as_ref() }.ok_or(Error::NullPointer)?;
    if contact.is_prepared() { Ok(contact) } else { Err(Error::BadContact) }
}

/// Sets item i of an output.
pub fn set(output: &mut Option<&mut [f64]>, i: usize, value: impl FnOnce() -> f64) {
    if let Some(place) = output.as_mut().and_then(|output| output.get_mut(i)) {
        *place = value();
    }
}

/// A workspace of either rule.
pub enum HarmonicWorkspace<'a> {
    Equidistant(harmonic_force::Workspace<'a>),
    BetweenReversals(between_reversals::Workspace<'a>),
}

impl HarmonicWorkspace<'_> {
    /// 2H + 1.
    #[inline(always)]
    pub fn coefficients(&self) -> usize {
        match self {
            HarmonicWorkspace::Equidistant(workspace) => workspace.coefficients(),
            HarmonicWorkspace::BetweenReversals(workspace) => workspace.coefficients(),
        }
    }
}

/// A workspace that was initialised.
///
/// # Safety
/// `pointer` is NULL or points to three numbers at least, and to a whole workspace where these begin one.
#[inline(always)]
pub unsafe fn workspace<'a>(pointer: *mut f64) -> Result<HarmonicWorkspace<'a>, Error> {
    if pointer.is_null() {
        return Err(Error::NullPointer);
    }
    let header = unsafe { pointer.cast::<[f64; 3]>().read() };
    let whole = |extent: usize| unsafe { output(pointer, extent) }.ok_or(Error::BadWorkspace);
    Ok(match between_reversals::workspace_extent(&header) {
        Some(extent) => HarmonicWorkspace::BetweenReversals(between_reversals::Workspace::new(whole(extent?)?)?),
        None => {
            let extent = harmonic_force::workspace_extent(&header)?;
            HarmonicWorkspace::Equidistant(harmonic_force::Workspace::new(whole(extent)?)?)
        }
    })
}
