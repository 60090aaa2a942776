//! From pointers to slices, and from results to status codes.

use super::{MSLIP_OK, mslip_contact};
use crate::constant_load::contact::Contact;
use crate::error::Error;
use crate::hbm::{self, Workspace};
use core::{mem, ptr, slice};

pub fn status(result: Result<(), Error>) -> i32 {
    match result {
        Ok(()) => MSLIP_OK,
        Err(error) => error.code(),
    }
}

/// Rejects more items than memory can hold.
#[inline(always)]
pub fn check_length<T>(n: usize) -> Result<(), Error> {
    if n <= isize::MAX as usize / size_of::<T>().max(1) { Ok(()) } else { Err(Error::BadArraySize) }
}

/// Rejects a misaligned pointer; NULL is aligned.
#[inline(always)]
pub fn check_alignment<T>(pointer: *const T) -> Result<(), Error> {
    if pointer.is_aligned() { Ok(()) } else { Err(Error::BadAlignment) }
}

/// One item, a contact or parameters.
///
/// Its contents are unspecified: applications are compiled separately from this archive, so that memory they never wrote holds
/// arbitrary bytes here.
///
/// # Safety
/// `pointer` is NULL or valid for its type, which is not written while the reference lives.
#[inline(always)]
pub unsafe fn item<'a, T>(pointer: *const T) -> Result<&'a T, Error> {
    check_alignment(pointer)?;
    // SAFETY: aligned; valid by the function's contract.
    unsafe { pointer.as_ref() }.ok_or(Error::NullPointer)
}

/// An input of n items.
///
/// # Safety
/// `pointer` is NULL or valid for n items that are not written while the slice lives.
#[inline(always)]
pub unsafe fn input<'a, T>(pointer: *const T, n: usize) -> Result<&'a [T], Error> {
    check_length::<T>(n)?;
    check_alignment(pointer)?;
    if n == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(Error::NullPointer);
    }
    // SAFETY: aligned, not NULL, and not longer than memory; valid by the function's contract.
    Ok(unsafe { slice::from_raw_parts(pointer, n) })
}

/// An input of n items that may be absent.
///
/// # Safety
/// As for an input.
pub unsafe fn optional_input<'a, T>(pointer: *const T, n: usize) -> Result<Option<&'a [T]>, Error> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: by the function's contract.
    unsafe { input(pointer, n) }.map(Some)
}

/// An output of n items; `None` if it is not requested. It may be uninitialised, and is not read.
///
/// # Safety
/// `pointer` is NULL or valid for n items that nobody else uses while the slice lives.
#[inline(always)]
pub unsafe fn output<'a, T>(pointer: *mut T, n: usize) -> Result<Option<&'a mut [T]>, Error> {
    check_length::<T>(n)?;
    check_alignment(pointer)?;
    // SAFETY: not longer than memory, and aligned; valid by the function's contract.
    Ok(unsafe { requested(pointer, n) })
}

/// Outputs of n doubles each.
///
/// # Safety
/// As for one.
#[inline(always)]
pub unsafe fn outputs<'a, const K: usize>(
    pointers: [*mut f64; K],
    n: usize,
) -> Result<[Option<&'a mut [f64]>; K], Error> {
    check_length::<f64>(n)?;
    pointers.iter().try_for_each(|pointer| check_alignment(*pointer))?;
    // SAFETY: as for one.
    Ok(pointers.map(|pointer| unsafe { requested(pointer, n) }))
}

/// # Safety
/// As for an output; aligned, and not longer than memory.
#[inline(always)]
pub unsafe fn requested<'a, T>(pointer: *mut T, n: usize) -> Option<&'a mut [T]> {
    // SAFETY: by the function's contract.
    if pointer.is_null() || n == 0 { None } else { Some(unsafe { slice::from_raw_parts_mut(pointer, n) }) }
}

/// An initialised contact.
///
/// # Safety
/// `pointer` is NULL or valid for a contact.
#[inline(always)]
pub unsafe fn contact<'a>(pointer: *const mslip_contact) -> Result<&'a Contact, Error> {
    // SAFETY: by the function's contract; both types are made of the same doubles and 64-bit words, for which any bits are valid.
    let contact = unsafe { item(pointer.cast::<Contact>()) }?;
    if contact.is_initialised() { Ok(contact) } else { Err(Error::BadContact) }
}

/// Rejects a contact whose contents are not those that were written when it was initialised.
pub fn check_contact(contact: &Contact) -> Result<(), Error> {
    if sum(contact) == 0 { Ok(()) } else { Err(Error::BadContact) }
}

/// A contact as callers hold it, with its checksum: the sum of all words is 0.
impl From<Contact> for mslip_contact {
    fn from(mut contact: Contact) -> mslip_contact {
        contact.checksum = 0;
        contact.checksum = sum(&contact).wrapping_neg();
        // SAFETY: both are the same doubles and words of their size.
        unsafe { mem::transmute(contact) }
    }
}

/// The sum of all words of a contact.
fn sum(contact: &Contact) -> u64 {
    // SAFETY: a contact is made of doubles and words of their size, without gaps.
    let words = unsafe { &*ptr::from_ref(contact).cast::<[u64; size_of::<Contact>() / size_of::<u64>()]>() };
    words.iter().fold(0, |sum, word| sum.wrapping_add(*word))
}

/// Sets item i of an output.
#[inline(always)]
pub fn set(output: &mut Option<&mut [f64]>, i: usize, value: impl FnOnce() -> f64) {
    if let Some(place) = output.as_mut().and_then(|output| output.get_mut(i)) {
        *place = value();
    }
}

/// The header of a workspace.
///
/// # Safety
/// `pointer` is NULL or valid for four doubles.
#[inline(always)]
pub unsafe fn workspace_header(pointer: *const f64) -> Result<[f64; 4], Error> {
    check_alignment(pointer)?;
    if pointer.is_null() {
        return Err(Error::NullPointer);
    }
    // SAFETY: aligned, and valid for four doubles by the function's contract.
    Ok(unsafe { pointer.cast::<[f64; 4]>().read() })
}

/// An initialised workspace.
///
/// # Safety
/// `pointer` is NULL or valid for four doubles, and for a whole workspace if these are the header of one.
#[inline(never)]
pub unsafe fn workspace<'a>(pointer: *mut f64) -> Result<Workspace<'a>, Error> {
    // SAFETY: by the function's contract.
    let header = unsafe { workspace_header(pointer) }?;
    let extent = hbm::workspace_extent(&header)?;
    // SAFETY: the header of a workspace of that extent, by the function's contract.
    Workspace::new(unsafe { output(pointer, extent) }?.ok_or(Error::BadWorkspace)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact as flat, ellipse};

    #[test]
    fn a_check_rejects_a_contact_with_any_changed_bit() {
        for initialised in FLATS.map(flat).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let good = mslip_contact::from(initialised);
            let check = |contact: *const mslip_contact| {
                // SAFETY: a contact.
                unsafe { self::contact(contact) }.and_then(check_contact)
            };
            assert_eq!(check(&raw const good), Ok(()));
            // SAFETY: a contact is as many words.
            let mut words: [u64; size_of::<Contact>() / 8] = unsafe { mem::transmute(good) };
            for place in 0..words.len() {
                for bit in 0..64 {
                    words[place] ^= 1 << bit;
                    assert_eq!(check(words.as_ptr().cast()), Err(Error::BadContact), "{place} {bit}");
                    words[place] ^= 1 << bit;
                }
            }
        }
    }
}
