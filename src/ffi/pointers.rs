//! Conversion of pointers to slices, and of results to status codes.
//!
//! # Safety
//! Each pointer is NULL or valid for its type, times the given number of items, which are not accessed otherwise during the
//! lifetime of the reference. A workspace is valid for its header, and as a whole if this is the header of an initialised one. All
//! bit patterns are valid for these types, also those of memory that the application has not initialised.

use super::{MSLIP_OK, mslip_contact, mslip_element};
use crate::constant_load::contact::Contact;
use crate::constant_load::harmonic_force::{Workspace, workspace_size};
use crate::element::{Directions, Element};
use crate::error::{Error, ensure};
use crate::fourier::workspace::{HEADER, Layout, SamplingSize};
use crate::law::Law;
use core::{ptr, slice};

/// The status of a call.
pub fn call(call: impl FnOnce() -> Result<(), Error>) -> i32 {
    call().map_or_else(Error::code, |()| MSLIP_OK)
}

/// Rejects lengths that exceed the address space.
pub fn check_length<T>(n: usize) -> Result<(), Error> {
    ensure(n <= isize::MAX as usize / size_of::<T>().max(1), Error::BadArraySize)
}

/// Rejects a misaligned pointer; NULL is aligned.
pub fn check_alignment<T>(pointer: *const T) -> Result<(), Error> {
    ensure(pointer.is_aligned(), Error::BadAlignment)
}

/// Rejects NULL.
pub fn not_null<T>(pointer: *const T) -> Result<(), Error> {
    ensure(!pointer.is_null(), Error::NullPointer)
}

/// One item: a contact or parameters.
pub unsafe fn item<'a, T>(pointer: *const T) -> Result<&'a T, Error> {
    check_alignment(pointer)?;
    pointer.as_ref().ok_or(Error::NullPointer)
}

/// Rejects the pointer to an input of n items: it may be NULL only if n is 0.
pub fn check_input<T>(pointer: *const T, n: usize) -> Result<(), Error> {
    check_length::<T>(n)?;
    check_alignment(pointer)?;
    if n == 0 { Ok(()) } else { not_null(pointer) }
}

/// An input of n items.
pub unsafe fn input<'a, T>(pointer: *const T, n: usize) -> Result<&'a [T], Error> {
    check_input(pointer, n)?;
    Ok(if n == 0 { &[] } else { slice::from_raw_parts(pointer, n) })
}

/// A state as an input; not NULL.
pub unsafe fn state_input<'a>(state_length: usize, state: *const f64) -> Result<&'a [f64], Error> {
    not_null(state)?;
    input(state, state_length)
}

/// An output of n items; `None` if it is not requested. It may be uninitialised, and is not read.
pub unsafe fn output<'a, T>(pointer: *mut T, n: usize) -> Result<Option<&'a mut [T]>, Error> {
    check_length::<T>(n)?;
    check_alignment(pointer)?;
    Ok(requested(pointer, n))
}

/// An output of one value; `None` if it is not requested.
pub unsafe fn optional_output<'a, T>(pointer: *mut T) -> Result<Option<&'a mut T>, Error> {
    check_alignment(pointer)?;
    Ok(pointer.as_mut())
}

/// Memory of the given number of doubles to be initialised; not NULL.
pub unsafe fn memory<'a>(length: usize, pointer: *mut f64) -> Result<&'a mut [f64], Error> {
    check_length::<f64>(length)?;
    not_null(pointer)?;
    Ok(output(pointer, length)?.unwrap_or(&mut []))
}

/// Outputs of n doubles each.
pub unsafe fn outputs<'a, const K: usize>(
    pointers: [*mut f64; K],
    n: usize,
) -> Result<[Option<&'a mut [f64]>; K], Error> {
    check_length::<f64>(n)?;
    pointers.iter().try_for_each(|pointer| check_alignment(*pointer))?;
    Ok(pointers.map(|pointer| requested(pointer, n)))
}

/// An output of n items whose alignment and length are checked; `None` if it is NULL or empty.
pub unsafe fn requested<'a, T>(pointer: *mut T, n: usize) -> Option<&'a mut [T]> {
    if pointer.is_null() || n == 0 { None } else { Some(slice::from_raw_parts_mut(pointer, n)) }
}

/// An initialised contact.
pub unsafe fn contact<'a>(pointer: *const mslip_contact) -> Result<&'a Contact, Error> {
    let contact = item(pointer.cast::<Contact>())?;
    contact.check().map(|()| contact)
}

/// Sum of all 64-bit words of a contact or an element, which is 0 with its checksum.
pub fn sum<T: Checked>(value: &T) -> u64 {
    // SAFETY: the type consists of whole 64-bit words without padding.
    let words = unsafe { slice::from_raw_parts(ptr::from_ref(value).cast::<u64>(), size_of::<T>() / size_of::<u64>()) };
    words.iter().fold(0, |sum, word| sum.wrapping_add(*word))
}

/// Types that consist of doubles, 64-bit words and pairs of 32-bit words, without padding.
pub trait Checked {}
impl Checked for Contact {}
impl Checked for Element {}

/// An initialised element.
pub unsafe fn element<'a>(pointer: *const mslip_element) -> Result<&'a Element, Error> {
    let element = item(pointer.cast::<Element>())?;
    if element.is_initialised() { Ok(element) } else { Err(Error::BadElement) }
}

/// The items of an input with their places in the outputs that are requested; no items if none is.
pub fn each<T, const K: usize>(
    inputs: impl IntoIterator<Item = T>,
    outputs: [Option<&mut [f64]>; K],
) -> impl Iterator<Item = (T, [Option<&mut f64>; K])> {
    let most = if outputs.iter().any(Option::is_some) { usize::MAX } else { 0 };
    let mut places = outputs.map(|output| output.unwrap_or_default().iter_mut());
    inputs.into_iter().take(most).map(move |input| (input, places.each_mut().map(Iterator::next)))
}

/// Sets a value, if requested.
pub fn set<T>(place: Option<&mut T>, value: impl FnOnce() -> T) {
    if let Some(place) = place {
        *place = value();
    }
}

/// Sets the values that are requested.
pub fn write<const K: usize>(places: [Option<&mut f64>; K], values: [f64; K]) {
    places.into_iter().zip(values).for_each(|(place, value)| set(place, || value));
}

/// Header of a workspace.
pub unsafe fn workspace_header(pointer: *const f64) -> Result<[f64; HEADER], Error> {
    check_alignment(pointer)?;
    not_null(pointer)?;
    Ok(pointer.cast::<[f64; HEADER]>().read())
}

/// An initialised workspace.
#[inline(never)]
pub unsafe fn workspace<'a>(pointer: *mut f64) -> Result<Workspace<'a>, Error> {
    let header = workspace_header(pointer)?;
    let (rule, size, extent) = workspace_size(&header)?;
    Workspace::of_size(rule, size, output(pointer, extent)?.ok_or(Error::BadWorkspace)?)
}

/// Directions and size of a workspace of elements, and its number of doubles, from its header.
pub unsafe fn element_workspace_size(pointer: *const f64) -> Result<(Directions, SamplingSize, usize), Error> {
    let header = workspace_header(pointer)?;
    let read_as = |directions| {
        with_law!(directions, L => {
            let (size, length) = <L as Law>::Workspace::read(&header)?;
            Ok((directions, size, length))
        })
    };
    read_as(Directions::One).or_else(|_: Error| read_as(Directions::Two))
}

/// Evaluates an expression in which `$law` is the law for a number of directions.
macro_rules! with_law {
    ($directions:expr, $law:ident => $result:expr) => {
        match $directions {
            $crate::element::Directions::One => {
                type $law = $crate::one_direction::OneDirection;
                $result
            }
            $crate::element::Directions::Two => {
                type $law = $crate::two_directions::TwoDirections;
                $result
            }
        }
    };
}

pub(super) use with_law;
