//! Records: structs of doubles and counts in the memory of a workspace or of a state, which is an array of doubles.

use super::lanes::Lanes;

/// Number of whole records in some doubles.
const fn count_of<T: Record>(doubles: &[f64]) -> usize {
    const { assert!(align_of::<T>() <= align_of::<f64>() && size_of::<T>().is_multiple_of(size_of::<f64>())) };
    size_of_val(doubles) / size_of::<T>()
}

/// Doubles as records.
pub(crate) fn records<T: Record>(doubles: &[f64]) -> &[T] {
    // SAFETY: a record accepts all bits of these doubles.
    #[allow(unsafe_code)]
    unsafe {
        core::slice::from_raw_parts(doubles.as_ptr().cast(), count_of::<T>(doubles))
    }
}

/// Doubles as records that may be changed.
pub(crate) fn records_mut<T: Record>(doubles: &mut [f64]) -> &mut [T] {
    // SAFETY: a record accepts all bits of these doubles, which no other reference reaches, and leaves none uninitialised.
    #[allow(unsafe_code)]
    unsafe {
        core::slice::from_raw_parts_mut(doubles.as_mut_ptr().cast(), count_of::<T>(doubles))
    }
}

/// A record as doubles.
pub(crate) fn doubles_mut<T: Record>(record: &mut T) -> &mut [f64] {
    const { assert!(align_of::<T>() == align_of::<f64>()) };
    // SAFETY: a record has no padding, and accepts all bits of doubles.
    #[allow(unsafe_code)]
    unsafe {
        core::slice::from_raw_parts_mut((&raw mut *record).cast(), size_of::<T>() / size_of::<f64>())
    }
}

/// Structs that may occupy the doubles of a workspace or a state: [`record`] defines them.
///
/// # Safety
/// All bits are valid and there is no padding.
#[allow(unsafe_code)]
pub(crate) unsafe trait Record: Copy {}

// SAFETY: all bits are numbers.
#[allow(unsafe_code)]
unsafe impl Record for f64 {}

// SAFETY: all bits are numbers.
#[allow(unsafe_code)]
unsafe impl Record for u64 {}

// SAFETY: arrays have no padding.
#[allow(unsafe_code)]
unsafe impl<T: Record, const N: usize> Record for [T; N] {}

// SAFETY: lanes are an array of numbers.
#[allow(unsafe_code)]
unsafe impl<const L: usize> Record for Lanes<L> {}

/// Defines a struct whose fields are records, and which is one therefore. It may have one type as a parameter.
macro_rules! record {
    ($(#[$attribute:meta])* $visibility:vis struct $name:ident $(<$parameter:ident = $default:ty>)? {
        $($(#[$field_attribute:meta])* $field_visibility:vis $field:ident: $type:ty),+ $(,)?
    }) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, Copy)]
        #[repr(C)]
        $visibility struct $name $(<$parameter = $default>)? {
            $($(#[$field_attribute])* $field_visibility $field: $type),+
        }

        // SAFETY: the fields are records whose size is a multiple of their alignment, that of doubles.
        #[allow(unsafe_code)]
        unsafe impl $(<$parameter: $crate::numerics::record::Record>)? $crate::numerics::record::Record
            for $name $(<$parameter>)?
        where
            $($type: $crate::numerics::record::Record),+
        {
        }

        impl $(<$parameter: $crate::numerics::slices::Zero>)? $crate::numerics::slices::Zero for $name $(<$parameter>)? {
            fn zero() -> Self {
                $name { $($field: $crate::numerics::slices::Zero::zero()),+ }
            }
        }
    };
}

pub(crate) use record;
