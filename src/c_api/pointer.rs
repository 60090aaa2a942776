//! From pointers to slices, and from results to status codes.

use super::widest::on_widest;
use super::{MSLIP_OK, mslip_contact};
use crate::contact::Contact;
use crate::error::Error;
use crate::harmonic_force::{self, Workspace};
use crate::seal;
use core::{mem, ptr, slice};

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

/// Whether a pointer stands where its type may; NULL does.
#[inline(always)]
pub fn check_alignment<T>(pointer: *const T) -> Result<(), Error> {
    if pointer.is_aligned() { Ok(()) } else { Err(Error::BadAlignment) }
}

/// One item, a contact or parameters.
///
/// What it holds may be anything, and is recognised: hosts are compiled apart from this archive, so that memory they never
/// wrote is, here, memory with some bytes or other.
///
/// # Safety
/// `pointer` is NULL or points to what its type says, which is not written while the reference lives.
pub unsafe fn item<'a, T>(pointer: *const T) -> Result<&'a T, Error> {
    check_alignment(pointer)?;
    // SAFETY: aligned; the rest is the caller's word.
    unsafe { pointer.as_ref() }.ok_or(Error::NullPointer)
}

/// An input of n items.
///
/// # Safety
/// `pointer` is NULL or points to n items that are not written while the slice lives.
pub unsafe fn input<'a, T>(pointer: *const T, n: usize) -> Result<&'a [T], Error> {
    check_length::<T>(n)?;
    check_alignment(pointer)?;
    if n == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(Error::NullPointer);
    }
    // SAFETY: aligned, not NULL, and not longer than memory; the rest is the caller's word.
    Ok(unsafe { slice::from_raw_parts(pointer, n) })
}

/// An output of n items; `None` is not wanted. It may never have been written, and is not read.
///
/// # Safety
/// `pointer` is NULL or points to n items that nobody else uses while the slice lives.
#[inline(always)]
pub unsafe fn output<'a, T>(pointer: *mut T, n: usize) -> Result<Option<&'a mut [T]>, Error> {
    check_length::<T>(n)?;
    check_alignment(pointer)?;
    // SAFETY: not longer than memory, and aligned; the rest is the caller's word.
    Ok(unsafe { wanted(pointer, n) })
}

/// Outputs of n numbers each.
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
    Ok(pointers.map(|pointer| unsafe { wanted(pointer, n) }))
}

/// # Safety
/// As for an output; aligned, and not longer than memory.
#[inline(always)]
pub unsafe fn wanted<'a, T>(pointer: *mut T, n: usize) -> Option<&'a mut [T]> {
    // SAFETY: the caller's word.
    if pointer.is_null() || n == 0 { None } else { Some(unsafe { slice::from_raw_parts_mut(pointer, n) }) }
}

/// A contact that was prepared.
///
/// # Safety
/// `pointer` is NULL or points to a contact.
pub unsafe fn contact<'a>(pointer: *const mslip_contact) -> Result<&'a Contact, Error> {
    // SAFETY: the caller's word; both are the same doubles and words of their size, of which any bits will do.
    let contact = unsafe { item(pointer.cast::<Contact>()) }?;
    check_contact(contact)?;
    Ok(contact)
}

/// Whether memory is a contact, as it was written.
pub fn check_contact(contact: &Contact) -> Result<(), Error> {
    if contact.is_prepared() && sum(contact) == 0 { Ok(()) } else { Err(Error::BadContact) }
}

/// A contact as callers hold it, with its seal.
impl From<Contact> for mslip_contact {
    fn from(mut contact: Contact) -> mslip_contact {
        contact.seal = 0;
        contact.seal = sum(&contact).wrapping_neg();
        // SAFETY: both are the same doubles and words of their size.
        unsafe { mem::transmute(contact) }
    }
}

/// The sum of all words of a contact.
fn sum(contact: &Contact) -> u64 {
    // SAFETY: a contact is made of doubles and words of their size, without gaps.
    let words = unsafe { &*ptr::from_ref(contact).cast::<[f64; size_of::<Contact>() / size_of::<f64>()]>() };
    on_widest!(seal::of_table, words: &[f64] => u64)
}

/// Sets item i of an output.
pub fn set(output: &mut Option<&mut [f64]>, i: usize, value: impl FnOnce() -> f64) {
    if let Some(place) = output.as_mut().and_then(|output| output.get_mut(i)) {
        *place = value();
    }
}

/// A workspace that was initialised.
///
/// # Safety
/// `pointer` is NULL or points to four numbers at least, and to a whole workspace where these begin one.
#[inline(always)]
pub unsafe fn workspace<'a>(pointer: *mut f64) -> Result<Workspace<'a>, Error> {
    if pointer.is_null() {
        return Err(Error::NullPointer);
    }
    check_alignment(pointer)?;
    // SAFETY: aligned, and four numbers by the caller's word.
    let header = unsafe { pointer.cast::<[f64; 4]>().read() };
    let extent = harmonic_force::workspace_extent(&header)?;
    // SAFETY: they begin a workspace of that extent, by the caller's word.
    open(unsafe { output(pointer, extent) }?.ok_or(Error::BadWorkspace)?)
}

fn open(workspace: &mut [f64]) -> Result<Workspace<'_>, Error> {
    on_widest!(Workspace::new, workspace: &mut [f64] => Result<Workspace<'_>, Error>)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::{FLATS, contact as flat, ellipse};

    #[test]
    fn a_contact_of_which_any_bit_was_changed_is_refused() {
        for prepared in FLATS.map(flat).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let good = mslip_contact::from(prepared);
            // SAFETY: a contact.
            assert!(unsafe { contact(&raw const good) }.is_ok());
            // SAFETY: a contact is as many words.
            let mut words: [u64; 249] = unsafe { mem::transmute(good) };
            for place in 0..words.len() {
                for bit in 0..64 {
                    words[place] ^= 1 << bit;
                    let bad = words.as_ptr().cast::<mslip_contact>();
                    // SAFETY: as many words as a contact has.
                    assert_eq!(unsafe { contact(bad) }.map(|_| ()), Err(Error::BadContact), "{place} {bit}");
                    words[place] ^= 1 << bit;
                }
            }
        }
    }
}
